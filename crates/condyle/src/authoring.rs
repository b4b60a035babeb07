//! A model document edited in its file: one number changes, every other byte stays, and nothing is written that could
//! not be read again.
//!
//! An [`Authoring`] holds a document as it was read last, with all texts that it includes. Before it writes, it looks
//! whether a file was changed by another program meanwhile, and then writes nothing. What is written can be undone: the
//! file gets back the bytes that it had. Of a model in [`crate::shipped`] the first edit makes a file of the
//! user's, which includes the model and gives anew what was changed.
//!
//! ```
//! use condyle::authoring::Authoring;
//! use condyle::formats::document::edit::Step;
//! let folder = std::env::temp_dir().join(format!("condyle-authoring-{}", std::process::id()));
//! std::fs::create_dir_all(&folder)?;
//! let file = folder.join("leg.toml");
//! let text = "condyle = 1\nkind = \"model\"\n[segment.shank]\nat = [0, -0.420, 0] # Dumas 2007\n";
//! std::fs::write(&file, text)?;
//!
//! let mut leg = Authoring::open(&file)?;
//! let path = ["segment", "shank", "at"].map(|key| Step::Key(key.to_owned()));
//! let path = [&path[..], &[Step::Index(1)]].concat();
//! assert!(leg.question(&path, None).is_none()); // a plain number
//! leg.set(&path, -0.43, None)?;
//! assert_eq!(std::fs::read_to_string(&file)?, text.replace("-0.420", "-0.43"));
//! leg.undo()?;
//! assert_eq!(std::fs::read_to_string(&file)?, text);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod whole;

use crate::open::{Cause, OpenError, beside, included};
use crate::shipped;
use condyle_diagnostics::Error;
use condyle_formats::document::edit::{Edited, Editing, Origin, Refused, Step, WayKind, shown};
use condyle_formats::document::render;
use condyle_formats::text::utf8;
use std::fmt;
use std::path::{Path, PathBuf};

/// How many edits can be undone.
const MOST: usize = 1000;
/// How far two values are apart that are the same, relative to them.
const SAME: f64 = 1e-12;

/// What is wrong with a text, as it is shown to its author.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1; 0 where none is to blame.
    pub line: usize,
    /// The column, counted from 1; 0 where none is to blame.
    pub column: usize,
    /// What is wrong, and what would be right.
    pub text: String,
    /// All that is wrong, each with its line of the text and a caret.
    pub excerpt: String,
}

impl Fault {
    /// The first of several errors in a text, with all of them shown.
    fn of(file: &Path, text: &str, error: &Error) -> Self {
        let first = error.iter().next();
        let place = first.and_then(|first| first.place);
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let all: Vec<_> = error.iter().cloned().collect();
        Self {
            file: file.to_owned(),
            line: place.map_or(0, |place| place.line),
            column: place.map_or(0, |place| place.column),
            text: first.map_or(String::new(), |first| first.sentence()),
            excerpt: render(&name, text, &all),
        }
    }
}

/// Why nothing was written.
#[derive(Debug)]
#[non_exhaustive]
pub enum AuthoringError {
    /// Another program changed this file since it was read; [`Authoring::reload`] reads it.
    Changed(PathBuf),
    /// The document could not be read any more.
    Fault(Fault),
    /// What was asked for cannot be done; a sentence.
    Impossible(String),
    /// The system would not read or write this file.
    Io(PathBuf, std::io::Error),
}

impl fmt::Display for AuthoringError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Changed(file) => {
                write!(f, "{} was changed by another program: nothing was written", file.display())
            }
            Self::Fault(fault) => write!(f, "nothing was written: {}", fault.text),
            Self::Impossible(why) => f.write_str(why),
            Self::Io(file, error) => write!(f, "{}: {error}", file.display()),
        }
    }
}

impl std::error::Error for AuthoringError {}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1.
    pub line: usize,
    /// What stood there.
    pub old: String,
    /// What stands there now.
    pub new: String,
    /// The paths of the mirrored side that follow.
    pub mirrored: Vec<Vec<Step>>,
}

/// An edit that can be undone.
#[derive(Clone, Debug)]
struct Past {
    files: Vec<Turned>,
    line: usize,
}

/// A file with other bytes than before.
#[derive(Clone, Debug)]
struct Turned {
    file: PathBuf,
    /// What was in it; `None` if it was not there.
    before: Option<String>,
    after: String,
}

impl Turned {
    fn reversed(&self) -> Self {
        let before = Some(self.after.clone());
        Self { file: self.file.clone(), before, after: self.before.clone().unwrap_or_default() }
    }
}

/// Writes files; if one cannot be written, those before it get back what they had.
fn write_all(files: &[Turned]) -> Result<(), AuthoringError> {
    for (index, Turned { file, before, after }) in files.iter().enumerate() {
        let Err(error) = whole::write(file, after.as_bytes(), before.is_none()) else { continue };
        for Turned { file, before, .. } in files.iter().take(index) {
            if let Some(before) = before {
                // The first error is the one to tell.
                let _ = whole::write(file, before.as_bytes(), false);
            }
        }
        return Err(AuthoringError::Io(file.clone(), error));
    }
    Ok(())
}

/// A model document that is edited in its file.
#[derive(Debug)]
pub struct Authoring {
    path: PathBuf,
    /// The shipped model that the file will include, if it is not there yet.
    shipped: Option<String>,
    editing: Editing,
    done: Vec<Past>,
    undone: Vec<Past>,
}

/// The texts of a document as they are on disk.
fn read(path: &Path, text: &str) -> Result<Editing, Error> {
    let title = path.file_name().unwrap_or_default().to_string_lossy();
    // What is read of another format cannot be edited as a document.
    let owned = |name: &str| {
        let file = beside(path, name);
        file.is_file() && file.extension().is_some_and(|ending| ending == "toml")
    };
    Editing::read(&title, text, &mut |name| included(path, name), &owned)
}

fn text_of(path: &Path) -> Result<String, OpenError> {
    let fail = |cause| OpenError { path: path.to_owned(), cause };
    let bytes = std::fs::read(path).map_err(|error| fail(Cause::Io(error)))?;
    let text = utf8(&bytes).map_err(|error| fail(Cause::Content { error, text: None }))?;
    Ok(text.to_owned())
}

/// The text of a file that includes a shipped model and changes nothing.
fn including(name: &str, text: &str) -> String {
    let head = |key: &str| {
        let line = text.lines().find(|line| {
            line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='))
        });
        line.map_or(String::new(), |line| format!("{line}\n"))
    };
    let head: String = ["name", "up", "facing", "angles"].iter().map(|key| head(key)).collect();
    format!("condyle = 1\nkind = \"model\"\n{head}include = [\"{name}\"]\n")
}

/// A file name that is free, for what is changed of a shipped model.
fn free(folder: &Path, name: &str) -> PathBuf {
    let first = folder.join(format!("{name}-edited.toml"));
    let more = (2..10_000).map(|number| folder.join(format!("{name}-edited-{number}.toml")));
    std::iter::once(first.clone()).chain(more).find(|path| !path.exists()).unwrap_or(first)
}

impl Authoring {
    /// Opens a model document, or the name of a shipped model.
    ///
    /// # Errors
    /// As [`open::model`](crate::open::model) of a document.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        Self::open_in(path, Path::new("."))
    }

    /// Opens a model document, or the name of a shipped model, of which edits go to a new file in this folder.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_in(path: &Path, folder: &Path) -> Result<Self, OpenError> {
        let (path, text, shipped) = match shipped::asked_for(path) {
            Some(name) => {
                let unknown = || OpenError { path: path.to_owned(), cause: Cause::Unknown };
                let text = including(name, shipped::text(name).ok_or_else(unknown)?);
                (free(folder, name), text, Some(name.to_owned()))
            }
            None => (path.to_owned(), text_of(path)?, None),
        };
        let editing = read(&path, &text).map_err(|error| OpenError {
            path: path.clone(),
            cause: Cause::Content { error, text: Some(text) },
        })?;
        Ok(Self { path, shipped, editing, done: vec![], undone: vec![] })
    }

    /// The document as it was read last.
    #[must_use]
    pub fn editing(&self) -> &Editing {
        &self.editing
    }

    /// The file of the document; of a shipped model the one that the first edit makes.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the file is there, which that of a shipped model is after the first edit.
    #[must_use]
    pub fn is_file(&self) -> bool {
        self.shipped.is_none()
    }

    /// The files of the document: its own, if it is there, and those that it names and that are not shipped.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let sources = self.editing.sources().iter();
        let files = sources.filter(|source| !source.name.is_empty() || self.is_file());
        files.map(|source| self.file(&source.name)).filter(|file| file.is_file()).collect()
    }

    /// The file of one of the document's texts.
    #[must_use]
    pub fn file(&self, name: &str) -> PathBuf {
        if name.is_empty() { self.path.clone() } else { beside(&self.path, name) }
    }

    /// What has to be asked before a number is changed, for it is not a plain number of the document's own file:
    /// what will be written where. `None` if there is nothing to ask.
    #[must_use]
    pub fn question(&self, path: &[Step], way: Option<WayKind>) -> Option<String> {
        let editable = self.editing.find(path)?;
        let chosen = match way {
            None => editable.ways.first()?,
            Some(kind) => editable.ways.iter().find(|way| way.kind == kind)?,
        };
        let mirrored = self.editing.is_mirrored(path);
        if editable.origin == Origin::Plain && !mirrored {
            return None;
        }
        let mut sentence = String::new();
        if mirrored {
            let (this, that) = (shown(path), shown(&editable.path));
            sentence
                .push_str(&format!("`{this}` is the mirror image of `{that}`, which changes: "));
        }
        if let Some(name) = &self.shipped {
            let file = self.path.display();
            sentence.push_str(&format!("makes {file}, which includes the shipped `{name}`; "));
        }
        sentence.push_str(&chosen.sentence);
        Some(sentence)
    }

    /// Gives a number another value, in its unit, and writes it; by its first way if none is named.
    ///
    /// # Errors
    /// [`AuthoringError`]: nothing was written.
    pub fn set(
        &mut self,
        path: &[Step],
        value: f64,
        way: Option<WayKind>,
    ) -> Result<Written, AuthoringError> {
        self.set_all(&[(path.to_vec(), value)], way)
    }

    /// Gives several numbers other values at once, such as those of a point; numbers that have these values already
    /// are left as they are. All of it is one edit to undo, and is told by its first change.
    ///
    /// # Errors
    /// [`AuthoringError`]: nothing was written.
    pub fn set_all(
        &mut self,
        values: &[(Vec<Step>, f64)],
        way: Option<WayKind>,
    ) -> Result<Written, AuthoringError> {
        self.check()?;
        let mut all: Option<Edited> = None;
        for (path, value) in values {
            let now = all.as_ref().map_or(&self.editing, |edited| &edited.next);
            let found = now.find(path);
            let same = found.is_some_and(|found| (found.value - value).abs() <= SAME * value.abs());
            if same && values.len() > 1 {
                continue;
            }
            // What the first of them copied into the document is a plain number there.
            let offered = |kind: &WayKind| {
                found.is_none_or(|found| found.ways.iter().any(|way| way.kind == *kind))
            };
            let way = if all.is_some() { way.filter(offered) } else { way };
            let edited = now.set(path, *value, way).map_err(|why| self.refused(why))?;
            all = Some(match all.take() {
                None => edited,
                Some(mut before) => {
                    before.mirrored.extend(edited.mirrored);
                    Edited { next: edited.next, ..before }
                }
            });
        }
        let nothing = || AuthoringError::Impossible("these are the values already".to_owned());
        self.write(all.ok_or_else(nothing)?)
    }

    /// Gives a key of the document itself a value as TOML writes it, such as a wire of a component.
    ///
    /// # Errors
    /// [`AuthoringError`]: nothing was written.
    pub fn put(&mut self, path: &[String], value: &str) -> Result<Written, AuthoringError> {
        self.check()?;
        let edited = self.editing.put(path, value).map_err(|why| self.refused(why))?;
        self.write(edited)
    }

    /// Adds keys to a table of the document itself, such as a new segment or component.
    ///
    /// # Errors
    /// [`AuthoringError`]: nothing was written.
    pub fn put_all(
        &mut self,
        table: &[String],
        keys: &[(String, String)],
    ) -> Result<Written, AuthoringError> {
        self.check()?;
        let edited = self.editing.put_all(table, keys).map_err(|why| self.refused(why))?;
        self.write(edited)
    }

    fn refused(&self, why: Refused) -> AuthoringError {
        match why {
            Refused::Fault { error, file, text } => {
                // Errors of included texts are placed in the document itself.
                let shown = if file.is_empty() { &text } else { self.editing.text() };
                AuthoringError::Fault(Fault::of(&self.path, shown, &error))
            }
            why => AuthoringError::Impossible(why.to_string()),
        }
    }

    /// That no file was changed since it was read.
    fn check(&self) -> Result<(), AuthoringError> {
        if !self.is_file() && self.path.exists() {
            return Err(AuthoringError::Changed(self.path.clone()));
        }
        for source in self.editing.sources() {
            let file = self.file(&source.name);
            if (source.name.is_empty() && !self.is_file()) || !source.owned {
                continue;
            }
            match std::fs::read(&file) {
                Ok(bytes) if bytes == source.text.as_bytes() => {}
                Ok(_) => return Err(AuthoringError::Changed(file)),
                Err(error) => return Err(AuthoringError::Io(file, error)),
            }
        }
        Ok(())
    }

    fn write(&mut self, edited: Edited) -> Result<Written, AuthoringError> {
        let mut files = vec![];
        for source in edited.next.sources() {
            let own = source.name.is_empty();
            let old = self.editing.source(&source.name).map(|source| source.text.clone());
            let absent = own && !self.is_file();
            if absent || old.as_ref() != Some(&source.text) {
                let before = if absent { None } else { old };
                let (file, after) = (self.file(&source.name), source.text.clone());
                files.push(Turned { file, before, after });
            }
        }
        write_all(&files)?;
        self.editing = edited.next;
        self.shipped = None;
        if self.done.len() >= MOST {
            self.done.remove(0);
        }
        let (change, line) = (edited.change, edited.line);
        self.done.push(Past { files, line });
        self.undone.clear();
        let file = self.file(&change.file);
        Ok(Written { file, line, old: change.old, new: change.new, mirrored: edited.mirrored })
    }

    /// Whether there is an edit to undo, and one to do again.
    #[must_use]
    pub fn history(&self) -> (bool, bool) {
        (!self.done.is_empty(), !self.undone.is_empty())
    }

    /// Gives the file of the last edit the bytes that it had before. A file that the edit made stays, for another program
    /// may have it open; it then includes the shipped model and changes nothing.
    ///
    /// # Errors
    /// [`AuthoringError::Changed`] if the file is not as the edit left it.
    pub fn undo(&mut self) -> Result<Written, AuthoringError> {
        let Some(past) = self.done.last().cloned() else {
            return Err(AuthoringError::Impossible("there is nothing to undo".to_owned()));
        };
        let mut past = past;
        for turned in &mut past.files {
            turned.before.get_or_insert_with(|| self.unchanged_text());
        }
        let back = past.files.iter().map(Turned::reversed).collect();
        let written = self.turn(back, past.line)?;
        self.done.pop();
        self.undone.push(past);
        Ok(written)
    }

    /// Makes the last edit that was undone again.
    ///
    /// # Errors
    /// [`AuthoringError::Changed`] if the file is not as undoing left it.
    pub fn redo(&mut self) -> Result<Written, AuthoringError> {
        let Some(past) = self.undone.last().cloned() else {
            return Err(AuthoringError::Impossible("there is nothing to do again".to_owned()));
        };
        let written = self.turn(past.files.clone(), past.line)?;
        self.undone.pop();
        self.done.push(past);
        Ok(written)
    }

    /// What the file of a shipped model has without any change.
    fn unchanged_text(&self) -> String {
        let wanted = self.editing.sources().get(1).map_or("", |source| &source.name);
        including(wanted, shipped::text(wanted).unwrap_or_default())
    }

    /// Writes other bytes into files that have these.
    fn turn(&mut self, files: Vec<Turned>, line: usize) -> Result<Written, AuthoringError> {
        for Turned { file, before, .. } in &files {
            let found = std::fs::read(file).map_err(|e| AuthoringError::Io(file.clone(), e))?;
            if Some(found.as_slice()) != before.as_ref().map(|text| text.as_bytes()) {
                return Err(AuthoringError::Changed(file.clone()));
            }
        }
        write_all(&files)?;
        if let Err(fault) = self.reload() {
            // An included text was changed meanwhile: back to what was there.
            write_all(&files.iter().map(Turned::reversed).collect::<Vec<_>>())?;
            return Err(AuthoringError::Fault(fault));
        }
        let (mut file, mut old, mut new) = (self.path.clone(), String::new(), String::new());
        if let Some(first) = files.into_iter().next() {
            (file, old, new) = (first.file, first.before.unwrap_or_default(), first.after);
        }
        Ok(Written { file, line, old, new, mirrored: vec![] })
    }

    /// Reads the files anew; whether any of them changed. After a fault the document stays as it was read before.
    ///
    /// # Errors
    /// What is wrong with the files as they are now.
    pub fn reload(&mut self) -> Result<bool, Fault> {
        let text = match self.is_file() {
            true => text_of(&self.path).map_err(|error| Fault {
                file: self.path.clone(),
                line: 0,
                column: 0,
                text: error.to_string(),
                excerpt: String::new(),
            })?,
            false => self.editing.text().to_owned(),
        };
        let next = read(&self.path, &text).map_err(|error| Fault::of(&self.path, &text, &error))?;
        let changed = next.sources() != self.editing.sources();
        if changed {
            self.editing = next;
        }
        Ok(changed)
    }
}
