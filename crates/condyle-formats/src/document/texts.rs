//! The texts of a document, places in them, and the errors and warnings about them.

use super::findings::Findings;
use condyle_diagnostics::{Diagnostic, Error, Place, Severity};

/// How many errors are kept; more than that have a common cause.
const MOST_ERRORS: usize = 50;

/// A place: the number of its text, and the byte where it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Spot {
    pub(super) file: u32,
    /// The [`Context`] in which it is read, counted from 1; 0 for the text as it stands.
    pub(super) context: u32,
    pub(super) start: usize,
}

impl Spot {
    pub(super) fn new(file: u32, start: usize) -> Self {
        Self { file, context: 0, start }
    }

    pub(super) fn within(self, context: u32) -> Self {
        Self { context, ..self }
    }
}

/// The other place of what a template gives.
#[derive(Clone, Debug)]
pub(super) enum Context {
    /// A part of a template, for one of its instances.
    Instance {
        template: String,
        name: String,
        /// The place of the instance.
        at: Spot,
        /// How many instances the template has.
        of: usize,
    },
    /// A value that an instance gives for a parameter.
    Parameter {
        template: String,
        name: String,
        /// Where the template uses it.
        at: Spot,
    },
}

/// A name in a document, and its place.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) spot: Spot,
}

/// The unit of a document's angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Angles {
    Degrees,
    #[default]
    Radians,
}

/// One text: the document itself, or one that it includes.
struct File {
    name: String,
    text: String,
    line_starts: Vec<usize>,
    /// The line that includes it, in the document itself.
    included_at: Option<Spot>,
    angles: Angles,
}

/// All texts of a document, with the errors and warnings about them.
pub(super) struct Texts {
    files: Vec<File>,
    contexts: Vec<Context>,
    errors: Findings,
    warnings: Findings,
}

impl Default for Texts {
    fn default() -> Self {
        let (errors, warnings) = (Findings::new(MOST_ERRORS), Findings::new(usize::MAX));
        Self { files: vec![], contexts: vec![], errors, warnings }
    }
}

impl Texts {
    /// Adds a text and returns its number.
    pub(super) fn add(&mut self, name: &str, text: &str, included_at: Option<Spot>) -> u32 {
        let breaks = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        self.files.push(File {
            name: name.to_owned(),
            text: text.to_owned(),
            line_starts: std::iter::once(0).chain(breaks).collect(),
            included_at,
            angles: Angles::Radians,
        });
        self.files.len() as u32 - 1
    }

    /// The path of the text in which a spot is; empty for the document itself.
    pub(super) fn path(&self, spot: Spot) -> &str {
        self.files.get(spot.file as usize).map_or("", |file| &file.name)
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.files.iter().any(|f| f.name == name)
    }

    pub(super) fn len(&self) -> usize {
        self.files.len()
    }

    pub(super) fn set_angles(&mut self, file: u32, angles: Angles) {
        self.files[file as usize].angles = angles;
    }

    /// Adds a context and returns its number.
    pub(super) fn add_context(&mut self, context: Context) -> u32 {
        self.contexts.push(context);
        self.contexts.len() as u32
    }

    pub(super) fn context(&self, spot: Spot) -> Option<&Context> {
        context(&self.contexts, spot)
    }

    /// The unit of angles at a spot. A value that is given to a template has the template's.
    pub(super) fn angles(&self, spot: Spot) -> Angles {
        let file = match context(&self.contexts, spot) {
            Some(Context::Parameter { at, .. }) => at.file,
            _ => spot.file,
        };
        self.files[file as usize].angles
    }

    /// A diagnostic about a spot. In an included text, it is placed at the line that includes it.
    pub(super) fn said(
        &self,
        spot: Spot,
        severity: Severity,
        code: &'static str,
        message: String,
    ) -> Diagnostic {
        said(&self.files, spot, severity, code, message)
    }

    /// The place of a spot in the document itself. In an included text that is the line that includes
    /// it, and the place there is given beside it, as `file:line:column: `.
    pub(super) fn origin(&self, spot: Spot) -> (Place, String) {
        origin(&self.files, spot)
    }

    /// The line of a spot, with its file where that is an included one.
    pub(super) fn line(&self, spot: Spot) -> String {
        line(&self.files, spot)
    }

    pub(super) fn push(&mut self, spot: Spot, error: Diagnostic) {
        let context = context(&self.contexts, spot);
        self.errors.add(spot, error.code, context, || error);
    }

    pub(super) fn error(
        &mut self,
        spot: Spot,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.error_with(spot, code, || (message.into(), help.into()));
    }

    /// An error whose message and help are computed only if it is kept.
    pub(super) fn error_with<M: Into<String>>(
        &mut self,
        spot: Spot,
        code: &'static str,
        say: impl FnOnce() -> (M, String),
    ) {
        let context = context(&self.contexts, spot);
        self.errors.add(spot, code, context, || {
            let (message, help) = say();
            said(&self.files, spot, Severity::Error, code, message.into()).with_help(help)
        });
    }

    pub(super) fn warn(&mut self, spot: Spot, warning: Diagnostic) {
        let context = context(&self.contexts, spot);
        self.warnings.add(spot, warning.code, context, || warning);
    }

    pub(super) fn count(&self) -> usize {
        self.errors.count()
    }

    pub(super) fn failed(&self) -> bool {
        self.count() > 0
    }

    /// The warnings, or all errors in the order of the text.
    pub(super) fn finish(self) -> Result<Vec<Diagnostic>, Error> {
        let Self { files, contexts, errors, warnings } = self;
        let beside = |spot| beside(&files, &contexts, spot);
        let (mut errors, surplus) = errors.finish(beside);
        errors.sort_by_key(|e| e.place.map_or(u64::MAX, |p| p.byte.unwrap_or(0)));
        if surplus > 0 {
            let message = format!("and {surplus} more errors");
            errors.push(Diagnostic::error("document/more", message));
        }
        let warnings = warnings.finish(beside).0;
        Error::of(errors).map_or(Ok(warnings), Err)
    }
}

fn context(contexts: &[Context], spot: Spot) -> Option<&Context> {
    contexts.get((spot.context as usize).checked_sub(1)?)
}

fn place(files: &[File], spot: Spot) -> Place {
    let file = &files[spot.file as usize];
    let mut start = spot.start.min(file.text.len());
    while !file.text.is_char_boundary(start) {
        start -= 1;
    }
    let line = file.line_starts.partition_point(|&s| s <= start);
    let from = file.line_starts[line - 1];
    let column = file.text[from..start].chars().count() + 1;
    Place { line, column, byte: Some(start as u64) }
}

/// The line of a spot, with its file where that is an included one.
fn line(files: &[File], spot: Spot) -> String {
    let line = place(files, spot).line;
    let file = &files[spot.file as usize];
    match file.included_at {
        None => format!("line {line}"),
        Some(_) => format!("{}:{line}", file.name),
    }
}

fn said(
    files: &[File],
    spot: Spot,
    severity: Severity,
    code: &'static str,
    message: String,
) -> Diagnostic {
    let (place, included) = origin(files, spot);
    Diagnostic::new(severity, code, included + &message).at(place)
}

fn origin(files: &[File], spot: Spot) -> (Place, String) {
    let file = &files[spot.file as usize];
    let own = place(files, spot);
    match file.included_at {
        None => (own, String::new()),
        Some(at) => {
            let Place { line, column, .. } = own;
            (place(files, at), format!("{}:{line}:{column}: ", file.name))
        }
    }
}

/// What is added to a message: the other place of its spot.
fn beside(files: &[File], contexts: &[Context], spot: Spot) -> String {
    match context(contexts, spot) {
        None => String::new(),
        Some(Context::Instance { template, name, at, .. }) => {
            let line = line(files, *at);
            format!(", in instance `{name}` of template `{template}` ({line})")
        }
        Some(Context::Parameter { template, name, at }) => {
            let line = line(files, *at);
            format!(", which is `{name}` of template `{template}` ({line})")
        }
    }
}
