//! Output of results.

mod destination;
mod temporary;

use crate::failure::Failure;
use crate::screen::shown;
use condyle::open;
use destination::{Destination, Identity};
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use temporary::Temporary;

/// Something being written to a path, or to standard output for `-`.
///
/// A file is written under another name in the same folder and takes its place when finished, so that
/// there is never half of one; if it is dropped before, the old file stays. Its mode is kept and links to
/// it stay links. A file of several names is overwritten when finished, and what is no file, such as a
/// device or a pipe, is written to as the bytes come.
#[derive(Debug)]
pub(crate) struct Output {
    path: PathBuf,
    sink: Sink,
    /// Whether who reads standard output wants no more.
    closed: bool,
}

#[derive(Debug)]
enum Sink {
    Standard,
    StandardError,
    Through(File),
    Replaced { temporary: Temporary, place: PathBuf, shared: bool },
}

impl Output {
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let fail = |error: io::Error| Failure::new(format!("{}: {error}", path.display()));
        check_unread([path])?;
        let sink = match destination(path).map_err(fail)? {
            Destination::Standard => Sink::Standard,
            Destination::StandardError => Sink::StandardError,
            Destination::Descriptor(place) => {
                Sink::Through(OpenOptions::new().append(true).open(place).map_err(fail)?)
            }
            Destination::Device(place) => {
                Sink::Through(OpenOptions::new().write(true).open(place).map_err(fail)?)
            }
            Destination::File { place, existing } => replaced(path, place, existing)?,
        };
        Ok(Self { path: path.to_owned(), sink, closed: false })
    }

    /// Whether nobody reads what is still to come.
    pub(crate) fn is_closed(&self) -> bool {
        self.closed
    }

    /// Puts what was written in its place.
    pub(crate) fn finish(mut self) -> Result<(), Failure> {
        let done = self.flush().and_then(|()| match self.sink {
            Sink::Replaced { temporary, place, shared: true } => temporary.copy_to(&place),
            Sink::Replaced { temporary, place, shared: false } => temporary.rename_to(&place),
            _ => Ok(()),
        });
        done.map_err(|error| not_written(&self.path, error))
    }
}

/// The failure of a write to a path.
pub(crate) fn not_written(path: &Path, error: io::Error) -> Failure {
    let name = match path == Path::new("-") {
        true => "standard output".to_owned(),
        false => path.display().to_string(),
    };
    Failure::new(format!("{name}: {error}"))
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.closed {
            return Ok(bytes.len());
        }
        let written = match &mut self.sink {
            Sink::Standard => io::stdout().write(bytes),
            Sink::StandardError => io::stderr().write(bytes),
            Sink::Through(file) => file.write(bytes),
            Sink::Replaced { temporary, .. } => temporary.write(bytes),
        };
        match written {
            Err(error) if self.is_standard() && error.kind() == io::ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(bytes.len())
            }
            written => written,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Standard if !self.closed => match io::stdout().flush() {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                    self.closed = true;
                    Ok(())
                }
                flushed => flushed,
            },
            _ => Ok(()),
        }
    }
}

impl Output {
    fn is_standard(&self) -> bool {
        matches!(self.sink, Sink::Standard)
    }
}

/// Whether a path leads to standard output.
pub(crate) fn is_standard(path: &Path) -> bool {
    matches!(destination(path), Ok(Destination::Standard))
}

/// Whether a path leads to what is no file: standard output or input, a pipe or a device.
pub(crate) fn is_stream(path: &Path) -> bool {
    !matches!(destination(path), Ok(Destination::File { .. }) | Err(_))
}

fn destination(path: &Path) -> io::Result<Destination> {
    if path == Path::new("-") { Ok(Destination::Standard) } else { Destination::of(path) }
}

/// A temporary file for a place, with the mode of the file that is there.
fn replaced(path: &Path, place: PathBuf, existing: Option<Metadata>) -> Result<Sink, Failure> {
    let fail =
        |what: &str, error: io::Error| Failure::new(format!("{}: {what}: {error}", path.display()));
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .map_err(|error| fail(&format!("the folder {}", folder.display()), error))?;
    }
    if existing.is_some() {
        // Who may not write to a file may not replace it either.
        OpenOptions::new()
            .write(true)
            .open(&place)
            .map_err(|error| fail("the file cannot be written to", error))?;
    }
    let temporary = Temporary::beside(&place, existing.as_ref()).map_err(|error| {
        let folder = temporary::folder_of(&place);
        fail(&format!("no file can be made in the folder {}", folder.display()), error)
    })?;
    let shared = existing.is_some_and(|known| destination::names(&known) > 1);
    Ok(Sink::Replaced { temporary, place, shared })
}

/// Writes all of an [`Output`].
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut output = Output::create(path)?;
    output.write_all(bytes).map_err(|error| not_written(path, error))?;
    output.finish()
}

/// Refuses to write to a file that is read in the same call, or to one file twice.
pub(crate) fn check_distinct(inputs: &[&Path], outputs: &[&Path]) -> Result<(), Failure> {
    let inputs = identified(inputs.iter().copied());
    let mut seen: Vec<(Identity, &Path)> = vec![];
    for path in outputs.iter().filter(|path| !is_stream(path)) {
        let Some(identity) = Identity::of(path) else { continue };
        refuse_input(path, &identity, &inputs)?;
        if let Some((_, other)) = seen.iter().find(|(other, _)| *other == identity) {
            return Err(Failure::new(format!(
                "{}: two results would be written to this file ({}): give each a place of its own",
                path.display(),
                other.display()
            )));
        }
        seen.push((identity, path));
    }
    Ok(())
}

/// Refuses to write to a file that was read, were it one that another names.
pub(crate) fn check_unread<'a>(outputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    let read = open::files_read();
    let inputs = identified(read.iter().map(PathBuf::as_path));
    for path in outputs {
        if let Some(identity) = Identity::of(path) {
            refuse_input(path, &identity, &inputs)?;
        }
    }
    Ok(())
}

fn identified<'a>(inputs: impl Iterator<Item = &'a Path>) -> Vec<(Identity, &'a Path)> {
    inputs.filter_map(|path| Some((Identity::of_input(path)?, path))).collect()
}

fn refuse_input(
    path: &Path,
    identity: &Identity,
    inputs: &[(Identity, &Path)],
) -> Result<(), Failure> {
    match inputs.iter().find(|(input, _)| input == identity) {
        None => Ok(()),
        Some((_, input)) => Err(Failure::new(format!(
            "{}: this file is also an input ({}): give another place to write to",
            path.display(),
            input.display()
        ))),
    }
}

/// Writes text for people to standard output; a closed pipe is no error.
pub(crate) fn print(text: &[u8]) -> Result<(), Failure> {
    write(Path::new("-"), shown(&String::from_utf8_lossy(text)).as_bytes())
}

/// Prints one JSON document.
pub(crate) fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    write(Path::new("-"), format!("{value}\n").as_bytes())
}

/// A table whose columns are as wide as their widest cell; numbers to the right.
pub(crate) fn columns(rows: &[Vec<String>]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| {
        rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let numeric = |s: &str| s.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '∞');
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).map(|(cell, &w)| {
            let pad = " ".repeat(w - cell.chars().count());
            if numeric(cell) { format!("{pad}{cell}") } else { format!("{cell}{pad}") }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        text.push_str("  ");
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// How many names a line holds.
const FEW: usize = 6;

/// The first of some names, and how many more there are.
pub(crate) fn few(names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(FEW);
    let mut list = names.take(FEW).collect::<Vec<_>>().join(", ");
    if more > 0 {
        list.push_str(&format!(" and {more} more"));
    }
    list
}

/// A head and names after it, in lines of at most 96 characters; further lines are indented.
pub(crate) fn wrapped(head: &str, names: &[&str]) -> String {
    const WIDTH: usize = 96;
    let mut text = format!("  {head}");
    let mut used = text.chars().count();
    for name in names {
        let length = name.chars().count() + 1;
        if used + length > WIDTH && used > 4 {
            text.push_str("\n   ");
            used = 3;
        }
        text.push(' ');
        text.push_str(name);
        used += length;
    }
    text.push('\n');
    text
}
