//! Reading: rows, units and times.

use super::header::{self, Delimiter, Header};
use super::layout::{Layout, median_step};
use crate::text::{
    Line, Lines, Row, cell, check_size, is_blank, last_line, lines, read_decoded, with_comma,
};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_motion::{LengthUnit, Observed, Recording};

/// Reads a recording from text; see [the module](super) for what is accepted.
///
/// # Errors
///
/// `trc/empty`, `trc/not-trc`, `trc/truncated`, `trc/keys`, `trc/labels`, `trc/no-rows`,
/// `trc/cell` (a cell that is not a number, with line and column), `trc/too-many-cells`,
/// `trc/short-rows`, `trc/time`, `trc/rate` (times that contradict the rate), `trc/unit` (none is stated,
/// and the size of the data does not tell it).
///
/// ```
/// let text = "PathFileType\t4\t(X/Y/Z)\twalk.trc
/// DataRate\tNumFrames\tNumMarkers\tUnits
/// 100\t2\t2\tmm
/// Frame#\tTime\tLASI\t\t\tRASI
/// \t\tX1\tY1\tZ1\tX2\tY2\tZ2
/// 1\t0.00\t10\t900\t120\t\t\t
/// 2\t0.01\t11\t900\t120\t12\t901\t-118
/// ";
/// let walk = condyle_formats::trc::read(text)?.value;
/// assert_eq!(walk.labels, ["LASI", "RASI"]);
/// assert_eq!(walk.position(0, 0), Some([0.010, 0.900, 0.120]));
/// assert_eq!(walk.position(0, 1), None);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(text: &str) -> Result<Read<Recording>, Error> {
    read_rows(text, true)
}

/// As [`read`]; `fast` reads rows of plain numbers at once, which changes nothing but the time it takes.
fn read_rows(text: &str, fast: bool) -> Result<Read<Recording>, Error> {
    check_size(text.len())?;
    let mut warnings = Warnings::default();
    let mut lines = lines(text).peekable();
    let header = header::read(&mut lines, &mut warnings)?;
    let layout = Layout::find(&header, lines.clone(), &mut warnings);
    let mut rows = Rows {
        header: &header,
        layout,
        // Every marker in a row takes three separators; only rows that end early take fewer.
        room: text.len() + 100_000,
        nameless: 0,
        decimal_commas: false,
        frame_span: [f64::NAN; 2],
        times: Vec::new(),
        positions: Vec::new(),
    };
    if let Some(first) = lines.peek() {
        let mut lines = Lines::from_line(text, *first);
        let mut row = Row::default();
        loop {
            if let Some(end) = fast.then(|| rows.add_plain(&lines, &mut row)).flatten() {
                lines.skip_to(end);
                continue;
            }
            let Some(line) = lines.next() else { break };
            if !line.is_blank() {
                rows.add(line, &mut warnings)?;
            }
        }
    }
    if rows.decimal_commas {
        let said = Diagnostic::warning("trc/decimal-comma", "the decimal separator is a comma");
        warnings.push(said.at(header.values));
    }
    let Rows { times, mut positions, frame_span, .. } = rows;
    if times.is_empty() {
        return Err(Error::new("trc/no-rows", "there are marker names, but no frames")
            .at(last_line(text))
            .with_help("rows of frame, time and positions must follow the names"));
    }
    if let Some(declared) = header.frames
        && declared != times.len() as f64
    {
        warnings.push(
            Diagnostic::warning(
                "trc/frame-count",
                format!("NumFrames is {declared}, but {} rows follow", times.len()),
            )
            .at(header.values)
            .with_help("the rows are used"),
        );
    }
    let rate = rate(&header, &times, frame_span, &mut warnings)?;
    let labels = header.labels;
    let mut recording = Recording { labels, rate, times, ..Recording::default() };
    recording.positions = std::mem::take(&mut positions);
    convert(&mut recording, header.unit, header.values, &mut warnings)?;
    Ok(Read { value: recording, warnings: warnings.finish() })
}

/// Reads a recording from bytes in UTF-8, UTF-16 or, as a last resort, Latin-1.
///
/// # Errors
///
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Recording>, Error> {
    read_decoded(bytes, read)
}

/// The rows read so far, in the unit of the file.
struct Rows<'h> {
    header: &'h Header,
    layout: Layout,
    /// How many positions the size of the text allows for.
    room: usize,
    /// Cells of markers without a name, after all others, as far as rows had them.
    nameless: usize,
    /// Whether a comma was a decimal separator.
    decimal_commas: bool,
    /// The numbers of the first and the last frame.
    frame_span: [f64; 2],
    times: Vec<f64>,
    positions: Vec<Observed>,
}

impl Rows<'_> {
    /// Adds the next line if it is a complete row of plain numbers between tabs, of which nothing is to be
    /// said; where the line after it begins.
    fn add_plain(&mut self, lines: &Lines<'_>, row: &mut Row) -> Option<usize> {
        if self.header.delimiter.is_some() {
            return None;
        }
        let markers = self.header.labels.len();
        let expected = self.layout.first + 3 * markers;
        let (text, start) = lines.rest();
        // A few more tabs than cells end many rows.
        let end = row.read(text, start, expected + 8)?;
        let cells = row.cells();
        let (used, surplus) = cells.split_at_checked(expected)?;
        if expected < 2 || !surplus.iter().all(|cell| is_blank(*cell)) {
            return None;
        }
        let time = *used.get(self.layout.time)?;
        let later = self.times.last().is_none_or(|last| time > *last);
        if !time.is_finite() || !later {
            return None;
        }
        let positions = used.get(self.layout.first..)?.as_chunks::<3>().0;
        // Markers of which one or two cells are blank are worth a warning.
        let partly = |p: &[f64; 3]| {
            let blank = p.iter().filter(|x| is_blank(**x)).count();
            blank == 1 || blank == 2
        };
        let odd = |p: &[f64; 3]| p.iter().any(|x| x.is_nan()) && partly(p);
        if positions.iter().any(odd) {
            return None;
        }
        if let Some(frame) = self.layout.time.checked_sub(1).and_then(|at| used.get(at))
            && !is_blank(*frame)
        {
            let [first, last] = &mut self.frame_span;
            *first = if first.is_nan() { *frame } else { *first };
            *last = *frame;
        }
        self.times.push(time);
        self.positions.extend(positions.iter().map(|p| {
            let seen = p.iter().all(|x| x.is_finite());
            Observed::from(if seen { *p } else { [f64::NAN; 3] })
        }));
        Some(end)
    }

    fn add(&mut self, line: Line<'_>, warnings: &mut Warnings) -> Result<(), Error> {
        let delimiter = self.header.delimiter.unwrap_or_else(|| Delimiter::of(line.text));
        let mut cells = delimiter.cells(line.text);
        let markers = self.header.labels.len();
        let expected = self.layout.first + 3 * markers;
        let complete = cells.len() >= expected;
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        let surplus = cells.len().saturating_sub(expected);
        if surplus > self.nameless && surplus.is_multiple_of(3) {
            self.nameless = surplus;
            warnings.add("trc/nameless", || {
                let message = format!("markers without a name in the rows: {}", surplus / 3);
                Diagnostic::warning("trc/nameless", message)
                    .at(line.place_of(cells[expected]))
                    .with_help("those after the last name were skipped")
            });
        }
        let nameless = self.nameless;
        if surplus > nameless {
            return Err(Error::new("trc/too-many-cells", "the row has too many cells")
                .at(line.place_of(cells[expected + nameless]))
                .with_help(format!(
                    "expected at most {} for {markers} markers, found {}",
                    expected + nameless,
                    cells.len()
                )));
        }
        let at = |index: usize| cells.get(index).copied().unwrap_or_default();
        let frame = self.layout.time.checked_sub(1).map_or("", at);
        let time = self.time(line, frame, at(self.layout.time), warnings)?;
        if self.positions.len() + markers > self.room {
            return Err(Error::new("trc/short-rows", "most rows end long before the last marker")
                .at(line.place())
                .with_help(format!("{markers} markers are named; are the rows complete?")));
        }
        if !complete {
            let unseen = markers - cells.len().saturating_sub(self.layout.first) / 3;
            if delimiter == Delimiter::Space {
                warnings.add("trc/space-gaps", || {
                    Diagnostic::warning("trc/space-gaps", "a row without tabs has too few cells")
                        .at(line.place())
                        .with_help(
                            "which markers are missing is unknown; the last ones are assumed",
                        )
                });
            }
            warnings.add("trc/short-row", || {
                Diagnostic::warning("trc/short-row", "the row ends early")
                    .at(line.place())
                    .with_help(format!(
                        "expected {expected} cells, found {}; markers missing at its end: {unseen}",
                        cells.len()
                    ))
            });
        }
        self.times.push(time);
        for marker in 0..markers {
            let position = self.position(line, &cells, marker, warnings)?;
            self.positions.push(position.into());
        }
        Ok(())
    }

    /// The number in a cell.
    fn number(&mut self, text: &str) -> Option<f64> {
        let plain = cell(text);
        if plain.is_some() || self.header.delimiter == Some(Delimiter::Comma) {
            return plain;
        }
        let value = with_comma(text)?;
        self.decimal_commas = true;
        Some(value)
    }

    fn time(
        &mut self,
        line: Line<'_>,
        frame: &str,
        time: &str,
        warnings: &mut Warnings,
    ) -> Result<f64, Error> {
        if !frame.is_empty() {
            let number = self.number(frame);
            let number = number.ok_or_else(|| not_a_number(line, frame, "the frame's number"))?;
            let [first, last] = &mut self.frame_span;
            *first = if first.is_nan() { number } else { *first };
            *last = number;
        }
        let seconds = if time.is_empty() { None } else { Some(time) };
        let seconds = match seconds.map(|cell| (cell, self.number(cell))) {
            Some((_, Some(seconds))) if seconds.is_finite() => seconds,
            Some((cell, None)) => return Err(not_a_number(line, cell, "the frame's time")),
            _ => {
                return Err(Error::new("trc/time", "the row has no time")
                    .at(line.place())
                    .with_help(if self.layout.time == 1 {
                        "write the seconds in the second cell"
                    } else {
                        "write the seconds under `Time`"
                    }));
            }
        };
        match self.times.last() {
            Some(last) if seconds < *last => {
                Err(Error::new("trc/time", format!("time goes back from {last} s to {seconds} s"))
                    .at(line.place_of(time))
                    .with_help("does the file hold two recordings? split it"))
            }
            Some(last) if seconds == *last => {
                warnings.add("trc/same-time", || {
                    Diagnostic::warning("trc/same-time", format!("time {seconds} s is repeated"))
                        .at(line.place_of(time))
                });
                Ok(seconds)
            }
            _ => Ok(seconds),
        }
    }

    fn position(
        &mut self,
        line: Line<'_>,
        cells: &[&str],
        marker: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<[f64; 3]>, Error> {
        let mut position = [f64::NAN; 3];
        let mut blank = 0;
        for (axis, coordinate) in position.iter_mut().enumerate() {
            match cells.get(self.layout.first + 3 * marker + axis).filter(|cell| !cell.is_empty()) {
                None => blank += 1,
                Some(cell) => {
                    *coordinate = self.number(cell).ok_or_else(|| {
                        let label = self.header.labels.get(marker);
                        let label = label.map_or("", String::as_str);
                        not_a_number(line, cell, &format!("a coordinate of `{label}`"))
                    })?;
                }
            }
        }
        if blank == 1 || blank == 2 {
            warnings.add("trc/part-blank", || {
                let label = self.header.labels.get(marker).map_or("", String::as_str);
                Diagnostic::warning("trc/part-blank", format!("`{label}` has {blank} blank cells"))
                    .at(line.place())
                    .with_help("the marker is taken as missing")
            });
        }
        let seen = position.iter().all(|x| x.is_finite());
        Ok(seen.then_some(position))
    }
}

fn not_a_number(line: Line<'_>, cell: &str, what: &str) -> Error {
    let help = format!("expected {what}; a missing value is a blank cell");
    let clipped: String = cell.chars().take(40).collect();
    Error::new("trc/cell", format!("`{clipped}` is not a number"))
        .at(line.place_of(cell))
        .with_help(help)
}

/// The rate of the header; that of the times where it has none, or where they disagree, with a warning.
///
/// # Errors
/// Where times and rate are 25 times apart or more and the numbers of frames do not explain it, as where
/// times are frames or milliseconds; where time stands still.
fn rate(
    header: &Header,
    times: &[f64],
    [first, last]: [f64; 2],
    warnings: &mut Warnings,
) -> Result<f64, Error> {
    let Some(step) = median_step(times) else {
        if let (Some(time), true) = (times.first(), times.len() > 2) {
            let message = format!("all {} rows have the time {time} s", times.len());
            let error = Error::new("trc/time", message).at(header.values);
            return Err(error.with_help("write the seconds of each row under `Time`"));
        }
        return Ok(header.rate.unwrap_or(0.0));
    };
    // Of the whole trial: more digits than a step has.
    let span = times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0);
    let mean = (times.len() - 1) as f64 / span;
    let measured = if (0.9..1.1).contains(&(mean * step)) { mean } else { 1.0 / step };
    let Some(declared) = header.rate else { return Ok(measured) };
    let ratio = declared * step;
    let per_row = (last - first) / (times.len() - 1) as f64;
    // By the median where frames are left out, by the mean where times have few digits.
    if [ratio, declared / mean].iter().any(|ratio| (0.95..1.05).contains(ratio)) {
        return Ok(declared);
    }
    if per_row > 1.0 && (0.95..1.05).contains(&(ratio / per_row)) {
        // Every so many frames only.
        return Ok(measured);
    }
    let message = format!("DataRate is {declared} Hz, but the times give {measured:.3} Hz");
    let other = header.other_rates.iter().find(|rate| (0.95..1.05).contains(&(**rate * step)));
    let frames = step == 1.0 && ratio >= 5.0;
    if other.is_none() && (frames || !(0.04..25.0).contains(&ratio)) {
        let like = match (step, ratio) {
            (1.0, _) => "they look like the numbers of frames",
            (_, r) if (950.0..1050.0).contains(&r) => "they look like milliseconds",
            (_, r) if (0.95e6..1.05e6).contains(&r) => "they look like microseconds",
            _ => "which of the two is right?",
        };
        let error = Error::new("trc/rate", message).at(header.values);
        return Err(error.with_help(format!("{like}: write seconds, or the rate that is meant")));
    }
    let help = match other {
        Some(_) => "the times are used: they have another of the header's rates",
        None => "the times are used",
    };
    warnings.push(Diagnostic::warning("trc/rate", message).with_help(help));
    Ok(measured)
}

/// Converts positions to metres, with a guessed unit where the file states none.
///
/// # Errors
/// Where the unit is not stated and the size does not tell it.
fn convert(
    recording: &mut Recording,
    unit: Option<LengthUnit>,
    header: Place,
    warnings: &mut Warnings,
) -> Result<(), Error> {
    let unit = match unit {
        Some(unit) => unit,
        None => {
            let size = recording.extent().unwrap_or_else(|| recording.reach());
            let unit = recording.unit_by_size().ok_or_else(|| {
                let message =
                    format!("there is no unit of length, and a span of {size:.4} does not tell it");
                let help = "it may be a body in cm or a hand in mm: write the unit under `Units`";
                Error::new("trc/unit", message).at(header).with_help(help)
            })?;
            let message = format!("the markers span {size:.4} units, taken as {}", unit.name());
            warnings.push(Diagnostic::warning("trc/unit", message).at(header));
            unit
        }
    };
    for position in recording.positions.iter_mut().filter_map(Observed::position_mut) {
        *position = position.map(|x| unit.to_metres(x));
    }
    recording.units = unit;
    let suspicious = match recording.extent() {
        Some(extent) if extent > 100.0 || (extent > 0.0 && extent < 0.01) => {
            Some(format!("the markers of a frame span {extent:.4e} m"))
        }
        None if recording.reach() > 100.0 => {
            Some(format!("the markers are {:.4e} m away", recording.reach()))
        }
        _ => None,
    };
    if let Some(message) = suspicious {
        warnings.push(
            Diagnostic::warning("trc/size", message)
                .at(header)
                .with_help(format!("is the unit `{}` right?", unit.name())),
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEAD: &str = "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n100\t3\t2\tmm\n\
                        Frame#\tTime\tLASI\t\t\tRASI\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";

    proptest! {
        /// The slow way knows every spelling; the fast one must give the same, warnings and errors included.
        #[test]
        fn fast_and_slow_rows_are_the_same(
            cells in prop::collection::vec(
                prop::sample::select(vec!["1", "-2.5", "", "NaN", "3e2", "0.1234567890123456789", " 7 ", "x", "1e400"]), 18),
            ends in prop::collection::vec(
                prop::sample::select(vec!["\n", "\r\n", "\t\n", "\r", "\n\n", "\t\t\t5\n"]), 3),
        ) {
            let mut text = HEAD.to_owned();
            for (row, end) in ends.iter().enumerate() {
                let cells = cells[6 * row..6 * row + 6].join("\t");
                text.push_str(&format!("{}\t{}\t{cells}{end}", row + 1, row as f64 / 100.0));
            }
            let [fast, slow] = [true, false].map(|fast| read_rows(&text, fast));
            match (fast, slow) {
                (Ok(fast), Ok(slow)) => prop_assert_eq!(fast, slow),
                (Err(fast), Err(slow)) => prop_assert_eq!(fast, slow),
                (fast, slow) => prop_assert!(false, "{:?} {:?}", fast, slow),
            }
        }
    }
}
