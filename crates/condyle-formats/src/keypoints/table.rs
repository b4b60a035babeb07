//! Keypoints in tables: a row a frame, or a row a point.

use super::raw::{Person, Raw};
use crate::csv::{cells, delimiter_of};
use crate::text::{self, Line, lines};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_motion::keypoint::{LIMBS, canonical};

/// What the columns of a point end in, after a sign: place, then confidence.
const AXES: [&[&str]; 4] = [
    &["x", "tx", "px"],
    &["y", "ty", "py"],
    &["z", "tz", "pz"],
    &["c", "conf", "confidence", "score", "visibility", "likelihood", "v", "presence", "p"],
];
const TIMES: [&str; 5] = ["time", "timestamp", "time_s", "seconds", "t"];
const FRAMES: [&str; 5] = ["frame", "frame_id", "frame_index", "frame_number", "image_id"];
const WHO: [&str; 6] = ["person", "person_id", "track_id", "subject", "id", "name"];
const WHICH: [&str; 7] =
    ["keypoint", "landmark", "joint", "bodypart", "part", "marker", "keypoint_name"];

/// Which column is what.
#[derive(Debug, Default)]
struct Columns {
    time: Option<usize>,
    frame: Option<usize>,
    person: Option<usize>,
    /// The name of the point, in a table with a row a point.
    which: Option<usize>,
    /// Name, columns of x, y, z, and of the confidence.
    points: Vec<(String, [usize; 3], Option<usize>)>,
}

/// The line of names and all after it.
fn head(text: &str) -> Option<(Line<'_>, impl Iterator<Item = Line<'_>>)> {
    let mut rest =
        lines(text).filter(|line| !line.is_blank() && !line.text.trim_start().starts_with('#'));
    rest.next().map(|first| (first, rest))
}

impl Columns {
    fn of(names: &[String]) -> Self {
        let lower: Vec<String> = names.iter().map(|name| name.trim().to_lowercase()).collect();
        let one = |known: &[&str]| lower.iter().position(|name| known.contains(&name.as_str()));
        let mut found = Self {
            time: one(&TIMES),
            frame: one(&FRAMES),
            person: one(&WHO),
            which: one(&WHICH),
            points: vec![],
        };
        // Four numbers are a quaternion.
        if let (Some(_), Some(x), Some(y), Some(z), None) =
            (found.which, one(AXES[0]), one(AXES[1]), one(AXES[2]), one(&["w"]))
        {
            found.points.push((String::new(), [x, y, z], one(AXES[3])));
            return found;
        }
        found.which = None;
        // Base names in the order of their first columns.
        let mut bases: Vec<(&str, [Option<usize>; 4])> = vec![];
        for (index, name) in lower.iter().enumerate() {
            let Some((at, sign)) = name.char_indices().rfind(|(_, c)| !c.is_alphanumeric()) else {
                continue;
            };
            let ending = &name[at + sign.len_utf8()..];
            let Some(axis) = AXES.iter().position(|ends| ends.contains(&ending)) else { continue };
            // Lower case may be longer: the name itself is cut by its own sign.
            let original = names[index].trim();
            let Some(cut) = original.rfind(|c: char| !c.is_alphanumeric()) else { continue };
            let base = &original[..cut];
            match bases.iter_mut().find(|(known, _)| *known == base) {
                Some((_, columns)) => columns[axis] = columns[axis].or(Some(index)),
                None => {
                    let mut columns = [None; 4];
                    columns[axis] = Some(index);
                    bases.push((base, columns));
                }
            }
            if bases.len() > MOST_POINTS {
                break;
            }
        }
        for (base, columns) in bases {
            if let ([Some(x), Some(y), Some(z), c], false) = (columns, base.is_empty()) {
                found.points.push((base.to_owned(), [x, y, z], c));
            }
        }
        found
    }

    fn are_keypoints(&self) -> bool {
        let has = |limb: &str| self.points.iter().any(|(n, ..)| canonical(n) == Some(limb));
        self.which.is_some() || LIMBS.iter().all(|limb| has(limb))
    }
}

/// More points than that nobody has.
const MOST_POINTS: usize = 2000;

/// Whether the names of the columns are those of keypoints.
pub(super) fn is_keypoints(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let start = start.trim_start_matches('\u{feff}');
    let Some((first, _)) = head(start) else { return false };
    let names = cells(first, delimiter_of(first.text));
    names.is_ok_and(|names| Columns::of(&names).are_keypoints())
}

/// Reads a table.
pub(super) fn read(text: &str) -> Result<Read<Raw>, Error> {
    let Some((first, rest)) = head(text) else {
        return Err(Error::new("keypoints/shape", "there is no line of names"));
    };
    let delimiter = delimiter_of(first.text);
    let names = cells(first, delimiter)?;
    let columns = Columns::of(&names);
    if columns.points.is_empty() {
        let help = "a point `nose` has the columns nose_x, nose_y and nose_z; or the columns keypoint, x, y, z";
        return Err(Error::new("keypoints/shape", "no point has all of its columns")
            .at(first.place())
            .with_help(help));
    }
    let mut raw = Raw::default();
    raw.in_seconds = columns.time.is_some();
    let mut warnings = Warnings::default();
    let mut frame = Frame::default();
    for (row, line) in rest.enumerate() {
        let cells = cells(line, delimiter)?;
        let number = |column: usize| cells.get(column).and_then(|cell| text::cell(cell.trim()));
        let at = columns.time.or(columns.frame).map(number);
        let key = match at {
            Some(found) => found.filter(|key| key.is_finite()).ok_or_else(|| {
                Error::new("keypoints/time", "the row has no time or frame").at(line.place())
            })?,
            None if columns.which.is_some() => {
                return Err(Error::new("keypoints/time", "no column says which frame a row is of")
                    .at(first.place())
                    .with_help("add a column `frame` or `time`"));
            }
            None => row as f64,
        };
        if frame.key.is_some_and(|known| known != key) {
            frame.end(&mut raw).map_err(|error| error.at(line.place()))?;
        }
        frame.key = Some(key);
        let who = columns.person.and_then(|column| cells.get(column)).map(|cell| cell.trim());
        let who = who.filter(|cell| !cell.is_empty() && *cell != "-1").map(|cell| {
            let digits = cell.chars().all(|c| c.is_ascii_digit() || c == '.');
            if digits { format!("person{cell}") } else { cell.replace(':', "-") }
        });
        for (name, place, confidence) in &columns.points {
            let name = match columns.which.and_then(|column| cells.get(column)) {
                Some(cell) => cell.trim().to_owned(),
                None => name.clone(),
            };
            if name.is_empty() {
                warnings.add("keypoints/name", || {
                    Diagnostic::warning("keypoints/name", "a point without a name is left out")
                        .at(line.place())
                });
                continue;
            }
            let at = place.map(|column| number(column).unwrap_or(f64::NAN));
            let sure = confidence.map(|column| number(column).unwrap_or(0.0));
            frame.person(who.as_deref()).points.push((name, at, sure));
        }
    }
    frame.end(&mut raw)?;
    if raw.points.is_empty() {
        return Err(Error::new("keypoints/shape", "the table has no rows"));
    }
    Ok(Read { value: numbered(raw), warnings: warnings.finish() })
}

/// The rows of one frame.
#[derive(Default)]
struct Frame {
    key: Option<f64>,
    people: Vec<Person>,
}

impl Frame {
    fn person(&mut self, name: Option<&str>) -> &mut Person {
        let known = self.people.iter().position(|person| person.name.as_deref() == name);
        let index = known.unwrap_or_else(|| {
            self.people.push(Person { name: name.map(str::to_owned), points: vec![] });
            self.people.len() - 1
        });
        &mut self.people[index]
    }

    fn end(&mut self, raw: &mut Raw) -> Result<(), Error> {
        match self.key.take() {
            Some(key) => raw.add_frame(key, std::mem::take(&mut self.people)),
            None => Ok(()),
        }
    }
}

/// Points that are numbered get the names of their set.
fn numbered(mut raw: Raw) -> Raw {
    let numbers: Option<Vec<usize>> =
        raw.labels.iter().map(|(_, name)| name.parse().ok()).collect();
    let Some(numbers) = numbers else { return raw };
    let count = numbers.iter().max().map_or(0, |most| most.saturating_add(1));
    if let Ok(names) = raw.names_of(count) {
        for ((_, label), number) in raw.labels.iter_mut().zip(numbers) {
            *label = names[number].to_owned();
        }
    }
    raw
}
