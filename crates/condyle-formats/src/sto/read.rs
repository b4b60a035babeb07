//! Reading: names, rows and cells of several numbers.

use std::collections::HashMap;

use super::header;
use crate::text::{Line, check_size, last_line, lines, number, read_decoded};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_motion::Table;

/// How cells are separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Delimiter {
    Tab,
    Comma,
    Space,
}

impl Delimiter {
    fn of(names: &str) -> Self {
        if names.trim().contains('\t') {
            Self::Tab
        } else if names.contains(',') {
            Self::Comma
        } else {
            Self::Space
        }
    }

    /// The cells of a line, without blank ones at its end.
    fn cells(self, line: &str) -> Vec<&str> {
        let mut cells: Vec<&str> = match self {
            Self::Tab => line.split('\t').map(str::trim).collect(),
            Self::Comma => line.split(',').map(str::trim).collect(),
            Self::Space => line.split_whitespace().collect(),
        };
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }
}

/// Reads a table from text; see [the module](super) for what is accepted.
///
/// # Errors
///
/// `sto/empty`, `sto/no-endheader`, `sto/no-names`, `sto/no-time`, `sto/duplicate-column`,
/// `sto/cell` (with line and column), `sto/cell-width`, `sto/too-many-cells`, `sto/short-rows`,
/// `sto/time`.
///
/// ```
/// use condyle_formats::{AngleUnit, sto};
/// let text = "Coordinates\ninDegrees=yes\nendheader\ntime\tknee\n0.0\t-5.5\n0.1\t\n";
/// let table = sto::read(text)?.value;
/// assert_eq!(table.angle_unit, AngleUnit::Degrees);
/// assert_eq!(table.value(0, 0), Some(-5.5));
/// assert!(table.value(1, 0).is_some_and(f64::is_nan));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(text: &str) -> Result<Read<Table>, Error> {
    check_size(text.len())?;
    let mut warnings = Warnings::default();
    let mut lines = lines(text);
    let header = header::read(&mut lines, &mut warnings)?;
    let mut lines = lines.filter(|line| !line.is_blank());
    let Some(names_line) = lines.next() else {
        return Err(Error::new("sto/no-names", "the file ends after `endheader`")
            .at(last_line(text))
            .with_help("a line of names must follow: `time` and one name for each column"));
    };
    let delimiter = Delimiter::of(names_line.text);
    let mut names = delimiter.cells(names_line.text);
    let timed = names.first().is_some_and(|name| name.eq_ignore_ascii_case("time"));
    if timed {
        names.remove(0);
    } else if header.range.is_none() {
        return Err(Error::new("sto/no-time", "the first column is not `time`")
            .at(names_line.place())
            .with_help("the line after `endheader` must name the columns, `time` first"));
    }
    if let Some(declared) = header.columns
        && declared != (names.len() + usize::from(timed)) as f64
    {
        warnings.push(
            Diagnostic::warning(
                "sto/column-count",
                format!(
                    "the header states {declared} columns, but {} are named",
                    names.len() + usize::from(timed)
                ),
            )
            .at(names_line.place())
            .with_help("the names are used"),
        );
    }
    let names = distinct(&names, names_line, &mut warnings)?;
    let mut rows = Rows {
        delimiter,
        timed,
        names: &names,
        widths: Vec::new(),
        room: text.len() + 100_000,
        times: Vec::new(),
        values: Vec::new(),
    };
    for line in lines {
        rows.add(line, &mut warnings)?;
    }
    let Rows { widths, mut times, values, .. } = rows;
    if times.is_empty() {
        warnings.push(Diagnostic::warning("sto/no-rows", "the table has no rows"));
    }
    if let Some(declared) = header.rows
        && declared != times.len() as f64
    {
        warnings.push(
            Diagnostic::warning(
                "sto/row-count",
                format!("the header states {declared} rows, but {} follow", times.len()),
            )
            .at(names_line.place())
            .with_help("the rows are used"),
        );
    }
    if let (false, Some([start, end])) = (timed, header.range) {
        spread(&mut times, start, end, &mut warnings);
    }
    let columns = widen(&names, &widths, names_line.place(), &mut warnings)?;
    let table = Table {
        name: header.name,
        columns,
        times,
        values,
        angle_unit: header.angle_unit,
        header: header.pairs,
    };
    Ok(Read { value: table, warnings: warnings.finish() })
}

/// Reads a table from bytes in UTF-8, UTF-16 or, as a last resort, Latin-1.
///
/// # Errors
///
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Table>, Error> {
    read_decoded(bytes, read)
}

/// The names, if no two are the same; a column without one is named by its number.
fn distinct(names: &[&str], line: Line<'_>, warnings: &mut Warnings) -> Result<Vec<String>, Error> {
    let mut columns: HashMap<String, usize> = HashMap::with_capacity(names.len());
    let mut distinct = Vec::with_capacity(names.len());
    for (index, name) in names.iter().enumerate() {
        let number = index + 2;
        let name = if name.is_empty() {
            warnings.add("sto/unnamed", || {
                Diagnostic::warning("sto/unnamed", format!("column {number} has no name"))
                    .at(line.place())
                    .with_help(format!("it is called `column_{number}`"))
            });
            format!("column_{number}")
        } else {
            (*name).to_owned()
        };
        if let Some(first) = columns.insert(name.clone(), number) {
            return Err(Error::new(
                "sto/duplicate-column",
                format!("columns {first} and {number} are both called `{name}`"),
            )
            .at(line.place())
            .with_help("rename one of them"));
        }
        distinct.push(name);
    }
    Ok(distinct)
}

/// The rows read so far.
struct Rows<'n> {
    delimiter: Delimiter,
    timed: bool,
    names: &'n [String],
    /// Numbers per cell, by column; found in the first row.
    widths: Vec<usize>,
    /// How many values the size of the text allows for.
    room: usize,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Rows<'_> {
    fn add(&mut self, line: Line<'_>, warnings: &mut Warnings) -> Result<(), Error> {
        let expected = self.names.len() + usize::from(self.timed);
        let mut cells = self.delimiter.cells(line.text);
        if cells.len() != expected {
            // A row re-typed by hand, or names and rows written by different programs.
            let words = Delimiter::Space.cells(line.text);
            if words.len() == expected {
                cells = words;
            }
        }
        if let Some(extra) = cells.get(expected) {
            return Err(Error::new("sto/too-many-cells", "the row has too many cells")
                .at(line.place_of(extra))
                .with_help(format!("expected {expected}, found {}", cells.len())));
        }
        if cells.len() < expected {
            warnings.add("sto/short-row", || {
                Diagnostic::warning("sto/short-row", "the row ends early")
                    .at(line.place())
                    .with_help(format!(
                        "expected {expected} cells, found {}; the rest is NaN",
                        cells.len()
                    ))
            });
        }
        if self.widths.is_empty() {
            let cells = cells.iter().skip(usize::from(self.timed));
            self.widths = cells.map(|cell| self.parts(cell).count()).collect();
            self.widths.resize(self.names.len(), 1);
        }
        let total: usize = self.widths.iter().sum();
        if self.values.len() + total > self.room {
            return Err(Error::new("sto/short-rows", "most rows end long before the last column")
                .at(line.place())
                .with_help(format!("{expected} columns are named; are the rows complete?")));
        }
        let mut cells = cells.into_iter();
        let time = match self.timed.then(|| cells.next().unwrap_or_default()) {
            Some(cell) => self.time(line, cell, warnings)?,
            None => self.times.len() as f64,
        };
        self.times.push(time);
        for (name, width) in self.names.iter().zip(&self.widths) {
            let cell = cells.next().unwrap_or_default();
            if cell.is_empty() {
                self.values.extend(std::iter::repeat_n(f64::NAN, *width));
                continue;
            }
            let before = self.values.len();
            for part in self.parts(cell).collect::<Vec<_>>() {
                let value = number(part).ok_or_else(|| not_a_number(line, part, name))?;
                self.values.push(value);
            }
            let found = self.values.len() - before;
            if found != *width {
                return Err(Error::new(
                    "sto/cell-width",
                    format!("a cell of `{name}` holds {found} numbers"),
                )
                .at(line.place_of(cell))
                .with_help(format!("its first row holds {width}")));
            }
        }
        Ok(())
    }

    /// The numbers of a cell; a vector's are separated by commas.
    fn parts<'c>(&self, cell: &'c str) -> impl Iterator<Item = &'c str> + use<'c> {
        // Where commas separate cells, none is left inside one.
        cell.trim_start_matches(['~', '[', '(']).trim_end_matches([']', ')']).split(',')
    }

    fn time(&self, line: Line<'_>, cell: &str, warnings: &mut Warnings) -> Result<f64, Error> {
        let time = match number(cell) {
            Some(time) if time.is_finite() => time,
            None if !cell.is_empty() => return Err(not_a_number(line, cell, "time")),
            _ => {
                return Err(Error::new("sto/time", "the row has no time")
                    .at(line.place())
                    .with_help("write the seconds in the first cell"));
            }
        };
        match self.times.last() {
            Some(last) if time < *last => {
                Err(Error::new("sto/time", format!("time goes back from {last} s to {time} s"))
                    .at(line.place_of(cell))
                    .with_help("does the file hold two motions? split it"))
            }
            Some(last) if time == *last => {
                warnings.add("sto/same-time", || {
                    Diagnostic::warning("sto/same-time", format!("time {time} s is repeated"))
                        .at(line.place_of(cell))
                });
                Ok(time)
            }
            _ => Ok(time),
        }
    }
}

fn not_a_number(line: Line<'_>, cell: &str, column: &str) -> Error {
    let clipped: String = cell.chars().take(40).collect();
    Error::new("sto/cell", format!("`{clipped}` in column `{column}` is not a number"))
        .at(line.place_of(cell))
        .with_help("expected a number; a missing value is a blank cell or `nan`")
}

/// Evenly spaced times for a SIMM file without a time column.
fn spread(times: &mut [f64], start: f64, end: f64, warnings: &mut Warnings) {
    let last = times.len().saturating_sub(1).max(1) as f64;
    for (row, time) in times.iter_mut().enumerate() {
        *time = start + (end - start) * (row as f64 / last);
    }
    warnings.push(
        Diagnostic::warning("sto/even-times", "there is no column `time`")
            .with_help(format!("rows are spread evenly over the range, {start} s to {end} s")),
    );
}

/// The names of the columns after cells of several numbers were split.
fn widen(
    names: &[String],
    widths: &[usize],
    place: Place,
    warnings: &mut Warnings,
) -> Result<Vec<String>, Error> {
    if widths.iter().all(|width| *width == 1) {
        return Ok(names.to_vec());
    }
    let mut columns = Vec::with_capacity(widths.iter().sum());
    for (name, width) in names.iter().zip(widths) {
        if *width == 1 {
            columns.push(name.clone());
        } else {
            columns.extend((1..=*width).map(|part| format!("{name}_{part}")));
        }
    }
    let mut seen = HashMap::with_capacity(columns.len());
    for (index, column) in columns.iter().enumerate() {
        if let Some(first) = seen.insert(column.as_str(), index) {
            return Err(Error::new(
                "sto/duplicate-column",
                format!("columns {} and {} would both be called `{column}`", first + 2, index + 2),
            )
            .at(place)
            .with_help("cells of several numbers become columns `name_1`, `name_2`, ..."));
        }
    }
    warnings.push(
        Diagnostic::warning("sto/vector-cells", "cells hold several numbers")
            .at(place)
            .with_help("they are read as columns `name_1`, `name_2`, ..., in the file's order"),
    );
    Ok(columns)
}
