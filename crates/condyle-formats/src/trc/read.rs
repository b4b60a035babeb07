//! Reading: rows, units and times.

use super::header::{self, Delimiter, Header};
use crate::text::{Line, check_size, last_line, lines, number, read_decoded};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_motion::{LengthUnit, Observed, Recording};

/// Options that a TRC file itself cannot state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dialect {
    /// Whether a marker at exactly `0 0 0` was not seen.
    pub zero_is_missing: bool,
}

/// Reads a recording from text; see [the module](super) for what is accepted.
///
/// # Errors
///
/// `trc/empty`, `trc/not-trc`, `trc/truncated`, `trc/keys`, `trc/labels`, `trc/no-rows`,
/// `trc/cell` (a cell that is not a number, with line and column), `trc/too-many-cells`,
/// `trc/short-rows`, `trc/time`.
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
    read_with(text, Dialect::default())
}

/// Reads a recording from bytes in UTF-8, UTF-16 or, as a last resort, Latin-1.
///
/// # Errors
///
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Recording>, Error> {
    read_decoded(bytes, read)
}

/// Reads a recording with options.
///
/// # Errors
///
/// As [`read`].
pub fn read_with(text: &str, options: Dialect) -> Result<Read<Recording>, Error> {
    check_size(text.len())?;
    let mut warnings = Warnings::default();
    let mut lines = lines(text).peekable();
    let header = header::read(&mut lines, &mut warnings)?;
    let mut rows = Rows {
        header: &header,
        options,
        // Every marker in a row takes three separators; only rows that end early take fewer.
        room: text.len() + 100_000,
        nameless: None,
        times: Vec::new(),
        positions: Vec::new(),
    };
    for line in lines.filter(|line| !line.is_blank()) {
        rows.add(line, &mut warnings)?;
    }
    let Rows { times, mut positions, .. } = rows;
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
    let rate = rate(header.rate, &times, &mut warnings);
    let labels = header.labels;
    let mut recording =
        Recording { labels, rate, times, positions: Vec::new(), units: LengthUnit::Metre };
    recording.positions = std::mem::take(&mut positions);
    convert(&mut recording, header.unit, header.values, &mut warnings);
    Ok(Read { value: recording, warnings: warnings.finish() })
}

/// The rows read so far, in the unit of the file.
struct Rows<'h> {
    header: &'h Header,
    options: Dialect,
    /// How many positions the size of the text allows for.
    room: usize,
    /// Cells of markers without a name, after all others; found in the first row.
    nameless: Option<usize>,
    times: Vec<f64>,
    positions: Vec<Observed>,
}

impl Rows<'_> {
    fn add(&mut self, line: Line<'_>, warnings: &mut Warnings) -> Result<(), Error> {
        let delimiter = Delimiter::of(line.text);
        let mut cells = delimiter.cells(line.text);
        let complete = cells.len() >= 2 + 3 * self.header.labels.len();
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        let markers = self.header.labels.len();
        let expected = 2 + 3 * markers;
        let surplus = cells.len().saturating_sub(expected);
        let nameless = *self.nameless.get_or_insert_with(|| {
            let nameless = if surplus.is_multiple_of(3) { surplus } else { 0 };
            if nameless > 0 {
                warnings.add("trc/nameless", || {
                    let count = nameless / 3;
                    let markers = format!("markers without a name in the rows: {count}");
                    Diagnostic::warning("trc/nameless", markers)
                        .at(line.place_of(cells[expected]))
                        .with_help("those after the last name were skipped")
                });
            }
            nameless
        });
        if surplus > nameless {
            return Err(Error::new("trc/too-many-cells", "the row has too many cells")
                .at(line.place_of(cells[expected + nameless]))
                .with_help(format!(
                    "expected at most {} for {markers} markers, found {}",
                    expected + nameless,
                    cells.len()
                )));
        }
        let cell = |index: usize| cells.get(index).copied().unwrap_or_default();
        let time = self.time(line, cell(0), cell(1), warnings)?;
        if self.positions.len() + markers > self.room {
            return Err(Error::new("trc/short-rows", "most rows end long before the last marker")
                .at(line.place())
                .with_help(format!("{markers} markers are named; are the rows complete?")));
        }
        if !complete {
            let unseen = markers - cells.len().saturating_sub(2) / 3;
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

    fn time(
        &self,
        line: Line<'_>,
        frame: &str,
        time: &str,
        warnings: &mut Warnings,
    ) -> Result<f64, Error> {
        if !frame.is_empty() && number(frame).is_none() {
            return Err(not_a_number(line, frame, "the frame's number"));
        }
        let seconds = if time.is_empty() { None } else { Some(time) };
        let seconds = match seconds.map(|cell| (cell, number(cell))) {
            Some((_, Some(seconds))) if seconds.is_finite() => seconds,
            Some((cell, None)) => return Err(not_a_number(line, cell, "the frame's time")),
            _ => {
                return Err(Error::new("trc/time", "the row has no time")
                    .at(line.place())
                    .with_help("write the seconds in the second cell"));
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
        &self,
        line: Line<'_>,
        cells: &[&str],
        marker: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<[f64; 3]>, Error> {
        let mut position = [f64::NAN; 3];
        let mut blank = 0;
        for (axis, coordinate) in position.iter_mut().enumerate() {
            match cells.get(2 + 3 * marker + axis).filter(|cell| !cell.is_empty()) {
                None => blank += 1,
                Some(cell) => {
                    *coordinate = number(cell).ok_or_else(|| {
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
        let seen = position.iter().all(|x| x.is_finite())
            && !(self.options.zero_is_missing && position == [0.0; 3]);
        Ok(seen.then_some(position))
    }
}

fn not_a_number(line: Line<'_>, cell: &str, what: &str) -> Error {
    let help = if cell.contains(',') && number(&cell.replace(',', ".")).is_some() {
        format!("write {}: the decimal separator is a point", cell.replace(',', "."))
    } else {
        format!("expected {what}; a missing value is a blank cell")
    };
    let clipped: String = cell.chars().take(40).collect();
    Error::new("trc/cell", format!("`{clipped}` is not a number"))
        .at(line.place_of(cell))
        .with_help(help)
}

/// The rate of the header, or of the times where it has none; a warning where they disagree.
fn rate(declared: Option<f64>, times: &[f64], warnings: &mut Warnings) -> f64 {
    let span = match times {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    let measured = (span > 0.0 && span.is_finite()).then(|| (times.len() - 1) as f64 / span);
    if let (Some(declared), Some(measured)) = (declared, measured)
        && !(0.95..1.05).contains(&(declared / measured))
    {
        warnings.push(
            Diagnostic::warning(
                "trc/rate",
                format!("DataRate is {declared} Hz, but the times give {measured:.3} Hz"),
            )
            .with_help("the times are used"),
        );
    }
    declared.or(measured).unwrap_or(0.0)
}

/// Converts positions to metres, with a guessed unit where the file states none.
fn convert(
    recording: &mut Recording,
    unit: Option<LengthUnit>,
    header: Place,
    warnings: &mut Warnings,
) {
    let unit = unit.unwrap_or_else(|| {
        // A person's markers span 1 to 3 m, one arm's half a metre.
        let size = recording.extent().unwrap_or_else(|| recording.reach());
        let unit = match size {
            size if size > 250.0 => LengthUnit::Millimetre,
            size if size > 10.0 => LengthUnit::Centimetre,
            _ => LengthUnit::Metre,
        };
        let message = format!("the markers span {size:.4} units, taken as {}", unit.name());
        warnings.push(Diagnostic::warning("trc/unit", message).at(header));
        unit
    });
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
}
