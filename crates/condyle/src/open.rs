//! Files by path, with errors and warnings that carry the path.

use crate::shipped;
use condyle_diagnostics::{Diagnostic, Error, Place, Read, nearest};
use condyle_formats::document::{self, Document};
use condyle_formats::opensim::{model as osim, setup};
use condyle_formats::{csv, sto, trc};
use condyle_model::Model;
use condyle_motion::{Recording, Table};
use std::fmt;
use std::path::{Path, PathBuf};

/// A file that could not be used.
#[derive(Debug)]
pub struct OpenError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub cause: Cause,
}

/// Why a file could not be used.
#[derive(Debug)]
#[non_exhaustive]
pub enum Cause {
    /// The system would not give it.
    Io(std::io::Error),
    /// Its content is wrong, perhaps in several places.
    Content {
        /// What is wrong.
        error: Error,
        /// The text, of a document that people write.
        text: Option<String>,
    },
    /// Its ending names no format that fits.
    Format {
        /// What was wanted, such as "a model".
        wanted: &'static str,
        /// The endings that would do.
        known: &'static str,
    },
    /// It is no file, and a word that might be the name of a shipped model, but none has it.
    Unknown,
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match &self.cause {
            Cause::Io(error) => {
                write!(f, "{path}: {error}")?;
                let name = self.path.to_str().and_then(|path| path.strip_suffix(".toml"));
                match name.filter(|name| shipped::text(name).is_some()) {
                    Some(name) => write!(f, " (`{name}` without an ending is a shipped model)"),
                    None => Ok(()),
                }
            }
            Cause::Content { error, .. } => {
                let lines: Vec<String> = error.iter().map(|e| located(&self.path, e)).collect();
                f.write_str(&lines.join("\n"))
            }
            Cause::Format { wanted, known } => {
                write!(f, "{path}: the ending names no format for {wanted} (known are {known})")
            }
            Cause::Unknown => {
                let near = self.path.to_str().and_then(|name| nearest(name, shipped::names()));
                let help = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
                let names: Vec<&str> = shipped::names().collect();
                let names = names.join(", ");
                write!(
                    f,
                    "`{path}` is neither a file nor a shipped model ({help}shipped are {names})"
                )
            }
        }
    }
}

impl std::error::Error for OpenError {}

/// A diagnostic as compilers print it: `file:line:column: message (help)`.
pub fn located(path: &Path, said: &Diagnostic) -> String {
    let place = match said.place {
        Some(p) if p.line > 0 && p.column > 0 => format!(":{}:{}", p.line, p.column),
        Some(p) if p.line > 0 => format!(":{}", p.line),
        Some(p) => p.byte.map_or(String::new(), |byte| format!(": byte {byte}")),
        None => String::new(),
    };
    format!("{}{place}: {}", path.display(), said.sentence())
}

/// The largest file that is read, in bytes.
const LARGEST: u64 = 1 << 30;

fn bytes(path: &Path) -> Result<Vec<u8>, OpenError> {
    let fail = |error| OpenError { path: path.to_owned(), cause: Cause::Io(error) };
    let size = std::fs::metadata(path).map_err(fail)?.len();
    if size > LARGEST {
        let error = Error::new("file/size", format!("the file has {size} bytes"))
            .with_help(format!("at most {LARGEST} are read"));
        return Err(OpenError {
            path: path.to_owned(),
            cause: Cause::Content { error, text: None },
        });
    }
    std::fs::read(path).map_err(fail)
}

fn read_with<T>(
    path: &Path,
    reader: impl FnOnce(&[u8]) -> Result<Read<T>, Error>,
) -> Result<Read<T>, OpenError> {
    let content =
        |error| OpenError { path: path.to_owned(), cause: Cause::Content { error, text: None } };
    reader(&bytes(path)?).map_err(content)
}

/// The ending of a path in lower case, without its dot.
pub fn ending(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn wrong<T>(path: &Path, wanted: &'static str, known: &'static str) -> Result<T, OpenError> {
    Err(OpenError { path: path.to_owned(), cause: Cause::Format { wanted, known } })
}

/// Opens a model of any format. Where there is no such file, the name of a [`shipped`] model does.
///
/// # Errors
/// [`OpenError`] with the path, and the line where there is one.
pub fn model(path: &Path) -> Result<Read<Model>, OpenError> {
    match ending(path).as_str() {
        "" if shipped::asked_for(path).is_some() => {
            Ok(document(path)?.map(|document| document.model))
        }
        "osim" | "xml" => read_with(path, osim::read),
        "toml" => Ok(document(path)?.map(|document| document.model)),
        _ => wrong(path, "a model", ".osim, .toml"),
    }
}

/// Opens a model document with all that it includes, from their places relative to it. Where there
/// is no such file, the name of a [`shipped`] model does.
///
/// # Errors
/// [`OpenError`] with the path and everything that is wrong.
pub fn document(path: &Path) -> Result<Read<Document>, OpenError> {
    if let Some(name) = shipped::asked_for(path) {
        return shipped::read(name);
    }
    let text = utf8(path)?;
    let mut include = |name: &str| {
        utf8(&beside(path, name)).map_err(|error| match error.cause {
            Cause::Io(error) => error.to_string(),
            Cause::Content { error, .. } => error.to_string(),
            _ => "it is no text".to_owned(),
        })
    };
    document::read(&text, &mut include).map_err(|error| OpenError {
        path: path.to_owned(),
        cause: Cause::Content { error, text: Some(text) },
    })
}

/// A text in UTF-8, without the mark that some editors put in front.
fn utf8(path: &Path) -> Result<String, OpenError> {
    match String::from_utf8(bytes(path)?) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            let before = &error.as_bytes()[..valid];
            let line = before.iter().filter(|b| **b == b'\n').count() + 1;
            let error = Error::new("toml/utf-8", "the text is not UTF-8")
                .at(Place::at_line(line))
                .with_help("save it as UTF-8");
            Err(OpenError { path: path.to_owned(), cause: Cause::Content { error, text: None } })
        }
    }
}

/// Opens a marker recording of any format.
///
/// # Errors
/// [`OpenError`] with the path, and the line where there is one.
pub fn recording(path: &Path) -> Result<Read<Recording>, OpenError> {
    match ending(path).as_str() {
        "trc" => read_with(path, trc::from_bytes),
        _ => wrong(path, "a marker recording", ".trc"),
    }
}

/// Opens a table over time, such as a motion.
///
/// # Errors
/// [`OpenError`] with the path, and the line where there is one.
pub fn table(path: &Path) -> Result<Read<Table>, OpenError> {
    match ending(path).as_str() {
        "mot" | "sto" => read_with(path, sto::from_bytes),
        "csv" => read_with(path, csv::from_bytes),
        _ => wrong(path, "a motion", ".mot, .sto, .csv"),
    }
}

/// Opens a setup of OpenSim's inverse kinematics, with its task set if that has a file of its own.
///
/// # Errors
/// [`OpenError`] with the path, and the line where there is one.
pub fn ik_setup(path: &Path) -> Result<Read<setup::IkSetup>, OpenError> {
    if ending(path) == "toml" {
        return wrong(path, "a tracking setup", ".xml");
    }
    let mut read = read_with(path, setup::from_bytes)?;
    if let setup::IkTasks::File(name) = &read.value.tasks {
        let tasks_path = beside(path, name);
        let tasks = read_with(&tasks_path, setup::tasks_from_bytes)?;
        read.warnings.extend(tasks.warnings);
        read.value.tasks = setup::IkTasks::Inline(tasks.value);
    }
    Ok(read)
}

/// A path that a file gives, from the file's own place.
pub fn beside(file: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    file.parent().unwrap_or(Path::new("")).join(name)
}
