//! Long files in parts, so that their text is never in memory as a whole.
//!
//! A part is the head of the file followed by some of its rows, the first of them the last row of the part
//! before, and is read by the reader of the whole format. That means the same as reading all at once only
//! where no part gives rise to a warning of its own; where one does, the file is read as a whole.

use super::{Cause, OpenError, ending, failed};
use condyle_diagnostics::{Diagnostic, Read, Severity};
use condyle_formats::text::number;
use condyle_formats::{Content, ContentKind, Format, Id};
use condyle_model::Model;
use condyle_motion::columns::check_single;
use condyle_motion::{AngleUnit, Motion, Recording};
use std::fs::File;
use std::io::{BufRead, BufReader, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Files of fewer bytes are read at once.
const LONG: u64 = 16 << 20;

/// How many bytes of rows make a part.
const PART: usize = 4 << 20;

/// The longest head in bytes, and the longest line of a file.
const LONGEST: usize = 1 << 20;

/// A file that is read part by part.
#[derive(Debug)]
struct Parts {
    path: PathBuf,
    format: &'static Format,
    reader: BufReader<File>,
    head: Vec<u8>,
    /// How many rows the head states.
    stated: Option<f64>,
    /// The last row of the part before.
    last: Vec<u8>,
    /// How many rows came so far.
    rows: usize,
}

impl Parts {
    /// `None` of a file that is read at once: a short one, a pipe, a format that is not made of rows, an
    /// unusual head.
    fn open(path: &Path) -> Option<Self> {
        let format = Format::of_ending(&ending(path))
            .filter(|format| matches!(format.id, Id::Trc | Id::Mot | Id::Sto | Id::Csv))?;
        // A pipe is not opened here: who writes into it would find its reader gone.
        let known = std::fs::metadata(path).ok()?;
        if !known.is_file() || known.len() < LONG {
            return None;
        }
        let file = File::open(path).ok()?;
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let head = head(format.id, &mut reader)?;
        let stated = stated(format.id, &head);
        super::source::list(path);
        let path = path.to_owned();
        Some(Self { path, format, reader, head, stated, last: vec![], rows: 0 })
    }

    /// The next part, with how many rows at its beginning were in the part before; `None` at the end.
    fn next(&mut self) -> Option<Result<(Read<Content>, usize), OpenError>> {
        let known = usize::from(!self.last.is_empty());
        let mut rows = std::mem::take(&mut self.last);
        let mut count = 0;
        let start = rows.len();
        while rows.len() - start < PART {
            let before = rows.len();
            match read_line(&mut self.reader, &mut rows) {
                Ok(0) => break,
                Ok(_) => {}
                Err(error) => return Some(Err(failed(&self.path, Cause::Io(error)))),
            }
            let line = rows.get(before..).unwrap_or_default();
            if line.iter().all(u8::is_ascii_whitespace) {
                rows.truncate(before);
                continue;
            }
            self.last.clear();
            self.last.extend_from_slice(line);
            count += 1;
        }
        if count == 0 {
            return None;
        }
        self.rows += count;
        if !self.last.ends_with(b"\n") {
            self.last.push(b'\n');
        }
        let mut text = with_rows(self.format.id, &self.head, known + count);
        text.append(&mut rows);
        let read = self.format.read(&text, &mut |_| Err(String::new()));
        Some(
            read.map(|read| (read, known))
                .map_err(|error| failed(&self.path, Cause::Content { error, text: None })),
        )
    }

    /// Whether the head states as many rows as there were.
    fn is_complete(&self) -> bool {
        self.stated.is_none_or(|stated| stated == self.rows as f64)
    }
}

/// Appends a line; one that is too long is an error.
fn read_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> std::io::Result<usize> {
    let most = LONGEST as u64;
    let count = std::io::Read::take(&mut *reader, most).read_until(b'\n', line)?;
    match count < LONGEST {
        true => Ok(count),
        false => Err(std::io::Error::other("a line is too long")),
    }
}

/// The lines before the first row.
fn head(id: Id, reader: &mut impl BufRead) -> Option<Vec<u8>> {
    let mut head = vec![];
    let mut names_next = false;
    while head.len() < LONGEST {
        let before = head.len();
        if read_line(reader, &mut head).ok()? == 0 {
            return None;
        }
        let line = head.get(before..)?;
        if line.starts_with(b"\xff\xfe") || line.starts_with(b"\xfe\xff") || line.contains(&0) {
            return None;
        }
        let text = String::from_utf8_lossy(line);
        let text = text.trim();
        let starts =
            |word: &str| text.get(..word.len()).is_some_and(|t| t.eq_ignore_ascii_case(word));
        match id {
            Id::Trc if names_next => {
                // The line of axes.
                let axes = text
                    .split_whitespace()
                    .all(|cell| cell.starts_with(['X', 'Y', 'Z', 'x', 'y', 'z']));
                return (axes && !text.is_empty()).then_some(head);
            }
            Id::Trc => names_next = starts("frame#"),
            _ if text.is_empty() => {}
            Id::Csv if text.starts_with('#') => {}
            Id::Csv => return starts("time").then_some(head),
            _ if names_next => return starts("time").then_some(head),
            _ => names_next = text.eq_ignore_ascii_case("endheader"),
        }
    }
    None
}

/// The key of a line of a head of tables that states the number of rows, with what separates it.
fn row_key(line: &str) -> Option<(&str, &str)> {
    let keys = ["nrows=", "datarows "];
    let key = keys
        .iter()
        .find(|key| line.get(..key.len()).is_some_and(|l| l.eq_ignore_ascii_case(key)))?;
    line.split_at_checked(key.len())
}

/// Where a recording states the number of its frames: the line, and the cell in it.
fn frame_cell(lines: &[&str]) -> Option<(usize, usize)> {
    let is_key = |cell: &str| cell.trim().eq_ignore_ascii_case("numframes");
    let line = lines.iter().position(|line| line.split('\t').any(is_key))?;
    Some((line + 1, lines.get(line)?.split('\t').position(is_key)?))
}

fn stated(id: Id, head: &[u8]) -> Option<f64> {
    let text = String::from_utf8_lossy(head);
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    match id {
        Id::Trc => {
            let (line, cell) = frame_cell(&lines)?;
            number(lines.get(line)?.split('\t').nth(cell)?)
        }
        _ => lines.iter().rev().find_map(|line| number(row_key(line.trim())?.1)),
    }
}

/// A head that states this number of rows, where it states any.
fn with_rows(id: Id, head: &[u8], rows: usize) -> Vec<u8> {
    let text = String::from_utf8_lossy(head);
    if matches!(text, std::borrow::Cow::Owned(_)) {
        // Another encoding: the head stays as it is.
        return head.to_vec();
    }
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let cell = (id == Id::Trc).then(|| frame_cell(&lines)).flatten();
    let mut stated = Vec::with_capacity(head.len() + PART + LONGEST);
    for (index, line) in lines.iter().enumerate() {
        match (cell, row_key(line.trim())) {
            (Some((at, cell)), _) if at == index => {
                let mut cells: Vec<String> = line.split('\t').map(str::to_owned).collect();
                if let Some(cell) = cells.get_mut(cell) {
                    *cell = rows.to_string();
                }
                stated.extend_from_slice(cells.join("\t").as_bytes());
            }
            (None, Some((key, _))) if id != Id::Trc => {
                stated.extend_from_slice(format!("{key}{rows}\n").as_bytes());
            }
            _ => stated.extend_from_slice(line.as_bytes()),
        }
    }
    stated
}

/// Whether two lists of warnings say the same, wherever.
fn same(a: &[Diagnostic], b: &[Diagnostic]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.code == b.code && a.message == b.message)
}

/// A long motion, part by part; see [`motion_parts`].
#[derive(Debug)]
pub struct MotionParts<'m> {
    model: &'m Model,
    parts: Parts,
    frames: usize,
}

impl MotionParts<'_> {
    /// How many frames there are in all.
    pub fn frames(&self) -> usize {
        self.frames
    }
}

impl Iterator for MotionParts<'_> {
    type Item = Result<Motion, OpenError>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.parts.next()?.map(|(read, known)| part_of_motion(self.model, read, known).value))
    }
}

fn part_of_motion(model: &Model, read: Read<Content>, known: usize) -> Read<Motion> {
    let Read { value, mut warnings } = read;
    let Content::Table(table) = value else { return Read::clean(Motion::default()) };
    let (mut motion, said) = Motion::from_table(model, &table);
    warnings.extend(said);
    motion.times.drain(..known);
    motion.frames.drain(..known);
    Read { value: motion, warnings }
}

/// A long motion of a model that is read part by part, after one pass in which all of it was checked.
///
/// `None` where it must be read as a whole, by [`motion`](super::motion): a short file, a pipe, one that
/// does not state the unit of its angles, one of whose rows is worth a warning.
///
/// # Errors
/// As [`content`](super::content).
pub fn motion_parts<'m>(
    path: &Path,
    model: &'m Model,
) -> Result<Option<Read<MotionParts<'m>>>, OpenError> {
    let Some(mut parts) = Parts::open(path) else { return Ok(None) };
    let mut warnings: Option<Vec<Diagnostic>> = None;
    let mut guessed = false;
    let start = parts.reader.stream_position().map_err(|e| failed(path, Cause::Io(e)))?;
    while let Some(part) = parts.next() {
        // Reading the whole says where in the file the error is.
        let Ok((read, known)) = part else { return Ok(None) };
        let stated = matches!(&read.value, Content::Table(table) if check_single(model, table).is_ok()
        && match table.angle_unit {
            AngleUnit::Degrees | AngleUnit::Radians => true,
            AngleUnit::RadiansAsRule => {
                let said = table.clone().settle_angles(Some(model), None);
                guessed |= said.as_ref().is_ok_and(|said| !said.is_empty());
                said.is_ok_and(|said| said.iter().all(|s| s.severity == Severity::Note))
            }
            AngleUnit::Unstated => false,
        });
        let read = part_of_motion(model, read, known);
        let like_the_first = warnings.get_or_insert_with(|| read.warnings.clone());
        if !stated || !same(like_the_first, &read.warnings) || read.warned(condyle_motion::BLANK) {
            return Ok(None);
        }
    }
    if !parts.is_complete() {
        return Ok(None);
    }
    let frames = std::mem::take(&mut parts.rows);
    parts.last.clear();
    let back = parts.reader.seek(SeekFrom::Start(start));
    back.map_err(|error| failed(path, Cause::Io(error)))?;
    let value = MotionParts { model, parts, frames };
    let mut warnings = warnings.unwrap_or_default();
    if guessed {
        let message = "the unit of angles is not stated: taken as radians, as in all CSV";
        warnings.push(Diagnostic::note("motion/angle-unit", message));
    }
    Ok(Some(Read { value, warnings }))
}

/// A long recording of which every part reads without a warning; `None` of any other.
pub(super) fn recording(path: &Path) -> Option<Recording> {
    let mut parts =
        Parts::open(path).filter(|parts| parts.format.reads.contains(&ContentKind::Recording))?;
    let mut whole: Option<Recording> = None;
    let size = parts.reader.get_ref().metadata().ok()?.len();
    while let Some(part) = parts.next() {
        let (Read { value: Content::Recording(mut part), warnings }, known) = part.ok()? else {
            return None;
        };
        let width = part.labels.len();
        if !warnings.is_empty() {
            return None;
        }
        let Some(whole) = &mut whole else {
            // A position takes six bytes at least.
            let most = size / (6 * width.max(1) as u64) + 1;
            let stated = parts.stated.filter(|stated| *stated >= 0.0 && *stated <= most as f64)?;
            let frames = stated as usize;
            part.positions.reserve_exact((frames * width).saturating_sub(part.positions.len()));
            part.times.reserve_exact(frames.saturating_sub(part.times.len()));
            whole = Some(part);
            continue;
        };
        if part.labels != whole.labels || part.units != whole.units || part.rate != whole.rate {
            return None;
        }
        whole.times.extend_from_slice(part.times.get(known..)?);
        whole.positions.extend_from_slice(part.positions.get(known * width..)?);
    }
    whole.filter(|_| parts.is_complete())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, id: Id) -> Option<Vec<u8>> {
        head(id, &mut text.as_bytes())
    }

    #[test]
    fn heads_end_before_the_first_row() {
        let trc = "PathFileType\t4\nDataRate\tNumFrames\tUnits\n100\t7\tmm\nFrame#\tTime\tA\n\t\tX1\tY1\tZ1\n";
        let found = read(&format!("{trc}\n1\t0\t1\t2\t3\n"), Id::Trc).unwrap();
        assert_eq!(found, trc.as_bytes());
        assert_eq!(stated(Id::Trc, &found), Some(7.0));
        let changed = String::from_utf8(with_rows(Id::Trc, &found, 12)).unwrap();
        assert_eq!(changed, trc.replace("\t7\t", "\t12\t"));
        let mot = "walk\nnRows=7\ninDegrees=yes\nendheader\n\ntime\ta\n";
        let found = read(&format!("{mot}0\t1\n"), Id::Mot).unwrap();
        assert_eq!((found.as_slice(), stated(Id::Mot, &found)), (mot.as_bytes(), Some(7.0)));
        let changed = String::from_utf8(with_rows(Id::Mot, &found, 12)).unwrap();
        assert_eq!(changed, mot.replace("nRows=7", "nRows=12"));
        // Rows without times are spread over all of the file.
        assert_eq!(read("walk\nendheader\na\tb\n0\t1\n", Id::Mot), None);
        assert_eq!(read("# inDegrees=yes\ntime,a\n0,1\n", Id::Csv).unwrap().len(), 23);
    }
}
