//! Reading: names, rows and cells of several numbers.

use super::header;
use crate::text::{
    self, Line, Lines, Row, cell, check_size, is_blank, last_line, lines, read_decoded, unquoted,
    with_comma,
};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_motion::Table;

/// How cells are separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Delimiter {
    Tab,
    Semicolon,
    Comma,
    Space,
}

impl Delimiter {
    fn of(names: &str) -> Self {
        if names.trim().contains('\t') {
            Self::Tab
        } else if names.contains(';') {
            Self::Semicolon
        } else if names.contains(',') {
            Self::Comma
        } else {
            Self::Space
        }
    }

    /// The cells of a line, without blank ones at its end.
    fn cells(self, line: &str) -> Vec<&str> {
        let mut cells: Vec<&str> = match self {
            Self::Tab => line.split('\t').map(unquoted).collect(),
            Self::Semicolon => line.split(';').map(unquoted).collect(),
            Self::Comma => line.split(',').map(unquoted).collect(),
            Self::Space => line.split_whitespace().map(unquoted).collect(),
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
/// `sto/empty`, `sto/no-endheader`, `sto/no-names`, `sto/no-time`,
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
    read_rows(text, true)
}

/// As [`read`]; `fast` reads rows of plain numbers at once, which changes nothing but the time it takes.
fn read_rows(text: &str, fast: bool) -> Result<Read<Table>, Error> {
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
    if names.len() > 1 && names.iter().all(|name| cell(name).or_else(|| with_comma(name)).is_some())
    {
        return Err(Error::new(
            "sto/no-names",
            "the line after `endheader` holds numbers, not names",
        )
        .at(names_line.place())
        .with_help("a line of names must come first: `time` and one name for each column"));
    }
    let is_time = |name: &&str| {
        let bare = name.split(['(', '[', ' ']).next().unwrap_or(name);
        bare.eq_ignore_ascii_case("time")
    };
    // The name of the first column is left out, or all names are one for each cell after it.
    let blank = names.first().is_some_and(|name| name.is_empty());
    let nameless = !blank
        && !names.first().is_some_and(is_time)
        && header.range.is_none()
        && lines.clone().next().is_some_and(|row| {
            let cells = delimiter.cells(row.text);
            delimiter != Delimiter::Space && cells.len() == names.len() + 1
        });
    let timed = names.first().is_some_and(is_time) || blank || nameless;
    if names.first().is_some_and(is_time) || blank {
        names.remove(0);
    }
    if blank || nameless {
        let said = Diagnostic::warning("sto/no-time", "the first column has no name");
        warnings.push(said.at(names_line.place()).with_help("its numbers are taken as the times"));
    }
    if !timed && header.range.is_none() {
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
    let names = distinct(&names, names_line, &mut warnings);
    // Headers of OpenSim's tools are sentences with commas.
    let cells = text.get(names_line.start + names_line.text.len()..).unwrap_or_default();
    let mut rows = Rows {
        delimiter,
        timed,
        names: &names,
        decimal_comma: decimal_comma(&header, delimiter, cells.contains(','), lines.clone()),
        widths: Vec::new(),
        room: text.len() + 100_000,
        times: Vec::new(),
        values: Vec::new(),
    };
    if let Some(first) = lines.next() {
        let mut lines = Lines::from_line(text, first);
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
    let Rows { widths, mut times, values, decimal_comma, .. } = rows;
    if decimal_comma {
        let said = Diagnostic::warning("sto/decimal-comma", "the decimal separator is a comma");
        warnings.push(said.at(names_line.place()));
    }
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
    let columns = widen(&names, &widths, names_line, &mut warnings);
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

/// Whether commas are decimal separators, not those between the numbers of a cell: they are in the times,
/// or in cells of single numbers.
fn decimal_comma<'a>(
    header: &header::Header,
    delimiter: Delimiter,
    any_comma: bool,
    mut rows: impl Iterator<Item = Line<'a>>,
) -> bool {
    if delimiter == Delimiter::Comma {
        return false;
    }
    let kind = header.pairs.iter().find(|(key, _)| key.eq_ignore_ascii_case("datatype"));
    let vectors = kind.is_some_and(|(_, kind)| !kind.eq_ignore_ascii_case("double"));
    let mut commas = false;
    if !any_comma {
        return false;
    }
    let all_single =
        |cells: &[&str]| cells.iter().all(|cell| !cell.contains(',') || with_comma(cell).is_some());
    // The first times may be whole numbers.
    let contradicted = rows.any(|row| {
        let cells = delimiter.cells(row.text);
        commas |= cells.iter().any(|cell| cell.contains(','));
        !all_single(&cells)
    });
    commas && !contradicted && !vectors
}

/// The names, of equal ones all but the first with `#2` and so on after it; a column without one is named
/// by its number.
fn distinct(names: &[&str], line: Line<'_>, warnings: &mut Warnings) -> Vec<String> {
    let named: Vec<String> = names
        .iter()
        .enumerate()
        .map(|(index, name)| {
            if !name.is_empty() {
                return (*name).to_owned();
            }
            let number = index + 2;
            warnings.add("sto/unnamed", || {
                Diagnostic::warning("sto/unnamed", format!("column {number} has no name"))
                    .at(line.place())
                    .with_help(format!("it is called `column_{number}`"))
            });
            format!("column_{number}")
        })
        .collect();
    text::distinct(named.iter().map(String::as_str), |index, other| {
        let name = named.get(index).map_or("", String::as_str);
        warnings.add(DUPLICATE, || {
            Diagnostic::warning(DUPLICATE, format!("two columns are called `{name}`"))
                .at(line.place())
                .with_help(format!("the later one, column {}, is read as `{other}`", index + 2))
        });
    })
}

/// Two columns with one name.
const DUPLICATE: &str = "sto/duplicate-column";

/// The rows read so far.
struct Rows<'n> {
    delimiter: Delimiter,
    timed: bool,
    names: &'n [String],
    /// Whether a comma is a decimal separator.
    decimal_comma: bool,
    /// Numbers per cell, by column; found in the first row.
    widths: Vec<usize>,
    /// How many values the size of the text allows for.
    room: usize,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Rows<'_> {
    /// Adds the next line if it is a complete row of plain numbers between tabs, of which nothing is to be
    /// said; where the line after it begins.
    fn add_plain(&mut self, lines: &Lines<'_>, row: &mut Row) -> Option<usize> {
        // The first row tells how many numbers a cell holds.
        let single = self.widths.len() == self.names.len() && self.values.len() >= self.names.len();
        if self.delimiter != Delimiter::Tab
            || !self.timed
            || !single
            || self.values.len() != self.times.len() * self.names.len()
        {
            return None;
        }
        let expected = self.names.len() + 1;
        let (text, start) = lines.rest();
        let end = row.read(text, start, expected + 8)?;
        let (used, surplus) = row.cells().split_at_checked(expected)?;
        let (time, values) = used.split_first()?;
        let later = self.times.last().is_some_and(|last| time > last);
        // Blank cells at the end of a row are worth a warning.
        let whole = values.last().is_some_and(|last| !is_blank(*last));
        if !time.is_finite() || !later || !whole || !surplus.iter().all(|cell| is_blank(*cell)) {
            return None;
        }
        self.times.push(*time);
        self.values.extend(values.iter().map(|v| if v.is_nan() { f64::NAN } else { *v }));
        Some(end)
    }

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
            if cell.is_empty() || (*width > 1 && is_missing(cell)) {
                self.values.extend(std::iter::repeat_n(f64::NAN, *width));
                continue;
            }
            let before = self.values.len();
            for part in self.parts(cell).collect::<Vec<_>>() {
                let value = self.number(part).ok_or_else(|| not_a_number(line, part, name))?;
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
        let most = if self.decimal_comma { 1 } else { usize::MAX };
        cell.trim_start_matches(['~', '[', '(']).trim_end_matches([']', ')']).splitn(most, ',')
    }

    fn number(&self, text: &str) -> Option<f64> {
        cell(text).or_else(|| with_comma(text).filter(|_| self.decimal_comma))
    }

    fn time(&self, line: Line<'_>, cell: &str, warnings: &mut Warnings) -> Result<f64, Error> {
        let time = match self.number(cell) {
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

/// Whether a cell says that its value is missing.
fn is_missing(text: &str) -> bool {
    cell(text).is_some_and(f64::is_nan)
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
    line: Line<'_>,
    warnings: &mut Warnings,
) -> Vec<String> {
    if widths.iter().all(|width| *width == 1) {
        return names.to_vec();
    }
    let mut columns = Vec::with_capacity(widths.iter().sum());
    for (name, width) in names.iter().zip(widths) {
        if *width == 1 {
            columns.push(name.clone());
        } else {
            columns.extend((1..=*width).map(|part| format!("{name}_{part}")));
        }
    }
    warnings.push(
        Diagnostic::warning("sto/vector-cells", "cells hold several numbers")
            .at(line.place())
            .with_help("they are read as columns `name_1`, `name_2`, ..., in the file's order"),
    );
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    distinct(&columns, line, warnings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The slow way knows every spelling; the fast one must give the same, warnings and errors included.
        #[test]
        fn fast_and_slow_rows_are_the_same(
            cells in prop::collection::vec(
                prop::sample::select(vec!["1", "-2.5", "", "NaN", "3e2", "0.1234567890123456789", " 7 ", "x", "1,5"]), 12),
            times in prop::collection::vec(prop::sample::select(vec!["0", "0.01", "0.02", "", "nan"]), 4),
            ends in prop::collection::vec(
                prop::sample::select(vec!["\n", "\r\n", "\t\n", "\r", "\n\n", "\t5\n"]), 4),
        ) {
            let mut text = "walk\nendheader\ntime\ta\tb\tc\n".to_owned();
            for (row, end) in ends.iter().enumerate() {
                text.push_str(&format!("{}\t{}{end}", times[row], cells[3 * row..3 * row + 3].join("\t")));
            }
            let [fast, slow] = [true, false].map(|fast| read_rows(&text, fast));
            match (fast, slow) {
                // What is not a number does not equal itself.
                (Ok(fast), Ok(slow)) => prop_assert_eq!(format!("{fast:?}"), format!("{slow:?}")),
                (Err(fast), Err(slow)) => prop_assert_eq!(fast, slow),
                (fast, slow) => prop_assert!(false, "{:?} {:?}", fast, slow),
            }
        }
    }
}
