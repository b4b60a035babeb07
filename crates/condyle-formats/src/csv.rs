//! CSV tables.
//!
//! Written: a line of names, `time` first, then rows; numbers with the shortest decimals that read
//! back the same, blank cells for NaN, names quoted where necessary. Read: the same, with commas,
//! semicolons or tabs, quotes, and lines that start with `#` before the names (`# key=value`
//! is kept). CSV has no field for a unit: angles are in radians as a rule
//! ([`AngleUnit::RadiansAsRule`]), unless a line `# inDegrees=yes` or `# inDegrees=no` states it. Lines `# Units=m` and
//! `# upkeep=what was done` are written where a table says so, and stand before the names. Words for a missing value are NaN
//! ([`cell`](crate::text::cell)).

use std::fmt::Write as _;

use crate::text::{
    self, Line, check_size, decimal, lines, number, plain, read_decoded, with_comma,
};
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_motion::{AngleUnit, Table};

/// Reads a table.
///
/// Where the first column is not `time`, every column is data and the times are the numbers of
/// the rows, counted from 0, with the warning `csv/no-time`.
///
/// # Errors
///
/// `csv/empty`, `csv/quote`, `csv/no-names`, `csv/name`, `csv/cell` (with
/// line and column), `csv/too-many-cells`, `csv/short-rows`, `csv/time`.
///
/// ```
/// use condyle_formats::csv;
/// let read = csv::read("qx,qy,qz,qw\n0,0,0.6,0.8\n")?;
/// assert_eq!(read.value.columns, ["qx", "qy", "qz", "qw"]);
/// assert_eq!(read.value.row(0), [0.0, 0.0, 0.6, 0.8]);
/// assert!(read.warned("csv/no-time"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(text: &str) -> Result<Read<Table>, Error> {
    check_size(text.len())?;
    let mut warnings = Warnings::default();
    let mut table = Table { angle_unit: AngleUnit::RadiansAsRule, ..Table::default() };
    let mut lines = lines(text).filter(|line| !line.is_blank());
    let names_line = loop {
        let Some(line) = lines.next() else {
            return Err(Error::new("csv/empty", "there is no line of names")
                .at(Place::at_line(1))
                .with_help("the first line must name the columns"));
        };
        let Some(remark) = line.text.trim_start().strip_prefix('#') else { break line };
        if let Some((key, value)) = remark.split_once('=') {
            let (key, value) = (key.trim(), value.trim());
            match (key.to_ascii_lowercase().as_str(), value.to_ascii_lowercase().as_str()) {
                ("indegrees", "yes" | "true" | "1") => table.angle_unit = AngleUnit::Degrees,
                ("indegrees", "no" | "false" | "0") => table.angle_unit = AngleUnit::Radians,
                _ => table.header.push((key.to_owned(), value.to_owned())),
            }
        }
    };
    let delimiter = delimiter_of(names_line.text);
    let mut names = cells(names_line, delimiter)?;
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    if names.iter().all(|name| number(name).is_some()) {
        return Err(Error::new("csv/no-names", "the first line holds numbers, not names")
            .at(names_line.place())
            .with_help("the first line must name the columns"));
    }
    let timed = names.first().is_some_and(|name| name.eq_ignore_ascii_case("time"));
    if timed {
        names.remove(0);
    } else {
        warnings.push(
            Diagnostic::warning("csv/no-time", "the first column is not `time`")
                .at(names_line.place())
                .with_help("rows are numbered instead"),
        );
    }
    check_names(&names, names_line)?;
    table.columns = distinct(&names, names_line, &mut warnings);
    let room = text.len() + 100_000;
    for line in lines {
        if table.values.len() + table.columns.len() > room {
            return Err(Error::new("csv/short-rows", "most rows end long before the last column")
                .at(line.place()));
        }
        add_row(&mut table, line, delimiter, timed, &mut warnings)?;
    }
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

/// The line on which a row of a table stands, rows counted from 0 and lines from 1.
///
/// ```
/// use condyle_formats::csv::line_of_row;
/// let text = b"# a remark\nqx,qy,qz,qw\n0,0,0,1\n\n0,0,0,0\n";
/// assert_eq!(line_of_row(text, 1), Some(5));
/// assert_eq!(line_of_row(text, 2), None);
/// ```
#[must_use]
pub fn line_of_row(bytes: &[u8], row: usize) -> Option<usize> {
    let read = text::decode(bytes).ok()?;
    let mut lines = lines(&read.value).filter(|line| !line.is_blank());
    lines.by_ref().find(|line| !line.text.trim_start().starts_with('#'))?;
    lines.nth(row).map(|line| line.number)
}

/// Writes a table: `time`, then its columns, after a comment line if its angles are in degrees.
///
/// # Errors
///
/// `csv/shape` if columns, times and values do not fit together.
///
/// ```
/// use condyle_formats::{Table, csv};
/// let table = Table {
///     columns: vec!["knee".into()],
///     times: vec![0.0, 0.5],
///     values: vec![1.25, f64::NAN],
///     ..Table::default()
/// };
/// assert_eq!(csv::write(&table)?, "time,knee\n0,1.25\n0.5,\n");
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(table: &Table) -> Result<String, Error> {
    if let Some(mismatch) = table.mismatch() {
        return Err(Error::new("csv/shape", mismatch));
    }
    Ok(head(table) + &rows(table))
}

/// The lines before the rows.
pub fn head(table: &Table) -> String {
    let mut text = match table.angle_unit {
        AngleUnit::Degrees => "# inDegrees=yes\n".to_owned(),
        _ => String::new(),
    };
    for (key, value) in &table.header {
        // Most programs take the first line for names, so that only what changes the meaning of numbers stands before.
        if ["units", "upkeep"].iter().any(|said| said.eq_ignore_ascii_case(key)) {
            text.push_str(&format!("# {}={}\n", plain(key), plain(value)));
        }
    }
    text.push_str("time");
    for column in &table.columns {
        text.push(',');
        text.push_str(&quoted(column));
    }
    text.push('\n');
    text
}

/// The rows of a table, which may be some of many.
pub fn rows(table: &Table) -> String {
    let mut text = String::new();
    for (row, time) in table.times.iter().enumerate() {
        text.push_str(&decimal(*time));
        for value in table.row(row) {
            text.push(',');
            if !value.is_nan() {
                text.push_str(&decimal(*value));
            }
        }
        text.push('\n');
    }
    text
}

/// Writes the error of each marker: rows of time in seconds, marker, and error in metres, under the
/// names `time,marker,error_m`.
///
/// ```
/// use condyle_formats::csv;
/// let text = csv::write_marker_errors([(0.0, "LASI", 0.0125), (0.0, "a,b", 0.5)]);
/// assert_eq!(text, "time,marker,error_m\n0,LASI,0.0125\n0,\"a,b\",0.5\n");
/// ```
pub fn write_marker_errors<'a>(errors: impl IntoIterator<Item = (f64, &'a str, f64)>) -> String {
    let mut text = "time,marker,error_m\n".to_owned();
    for (time, marker, error) in errors {
        let error = if error.is_nan() { String::new() } else { decimal(error) };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{},{},{error}", decimal(time), quoted(marker));
    }
    text
}

/// A name as one cell; line ends become spaces, as one row is one line.
fn quoted(name: &str) -> String {
    let name = name.replace(['\r', '\n'], " ");
    if name.contains([',', ';', '\t', '"', '#']) || name.trim() != name || name.is_empty() {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name
    }
}

/// The separator that occurs most outside quotes in the line of names.
pub(crate) fn delimiter_of(names: &str) -> char {
    let mut counts = [(',', 0), (';', 0), ('\t', 0)];
    let mut inside = false;
    for c in names.chars() {
        inside ^= c == '"';
        for (delimiter, count) in &mut counts {
            *count += usize::from(!inside && c == *delimiter);
        }
    }
    // Of equal counts the first separator, a comma, wins.
    counts.iter().rev().max_by_key(|(_, count)| *count).map_or(',', |(delimiter, _)| *delimiter)
}

/// The cells of a line, unquoted; those without quotes are trimmed.
pub(crate) fn cells(line: Line<'_>, delimiter: char) -> Result<Vec<String>, Error> {
    let mut cells = Vec::new();
    let mut rest = line.text;
    loop {
        let body = rest.trim_start_matches(' ');
        let Some(mut inner) = body.strip_prefix('"') else {
            let (cell, tail) = match rest.split_once(delimiter) {
                Some((cell, tail)) => (cell, Some(tail)),
                None => (rest, None),
            };
            cells.push(cell.trim().to_owned());
            match tail {
                Some(tail) => rest = tail,
                None => return Ok(cells),
            }
            continue;
        };
        let mut cell = String::new();
        loop {
            let Some((part, tail)) = inner.split_once('"') else {
                return Err(Error::new("csv/quote", "a quoted cell does not end on its line")
                    .at(line.place_of(body))
                    .with_help("close it with `\"`; a quote inside is written `\"\"`"));
            };
            cell.push_str(part);
            inner = tail;
            match inner.strip_prefix('"') {
                Some(tail) => {
                    cell.push('"');
                    inner = tail;
                }
                None => break,
            }
        }
        cells.push(cell);
        let after = inner.trim_start_matches(' ');
        match after.strip_prefix(delimiter) {
            Some(tail) => rest = tail,
            None if after.is_empty() => return Ok(cells),
            None => {
                return Err(Error::new("csv/quote", "text follows a quoted cell")
                    .at(line.place_of(after))
                    .with_help(format!("expected `{delimiter}` or the end of the line")));
            }
        }
    }
}

/// The maximum length of a column's name, in characters.
const MOST_LETTERS: usize = 1000;

fn check_names(names: &[String], line: Line<'_>) -> Result<(), Error> {
    for (index, name) in names.iter().enumerate() {
        let letters = name.chars().count();
        if letters > MOST_LETTERS || name.contains('\0') {
            return Err(Error::new(
                "csv/name",
                format!("the name of column {} has {letters} letters or is binary", index + 1),
            )
            .at(line.place())
            .with_help("is this a table? the first line must name the columns"));
        }
    }
    Ok(())
}

/// The names, of equal ones all but the first with `#2` and so on after it.
fn distinct(names: &[String], line: Line<'_>, warnings: &mut Warnings) -> Vec<String> {
    text::distinct(names.iter().map(String::as_str), |index, other| {
        let name = names.get(index).map_or("", String::as_str);
        warnings.add("csv/duplicate-column", || {
            let message = format!("two columns are called `{name}`");
            Diagnostic::warning("csv/duplicate-column", message)
                .at(line.place())
                .with_help(format!("the later one is read as `{other}`"))
        });
    })
}

fn add_row(
    table: &mut Table,
    line: Line<'_>,
    delimiter: char,
    timed: bool,
    warnings: &mut Warnings,
) -> Result<(), Error> {
    let mut cells = cells(line, delimiter)?;
    let expected = table.columns.len() + usize::from(timed);
    while cells.len() > expected && cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    if cells.len() > expected {
        return Err(Error::new("csv/too-many-cells", "the row has too many cells")
            .at(line.place())
            .with_help(format!("expected {expected}, found {}", cells.len())));
    }
    if cells.len() < expected {
        warnings.add("csv/short-row", || {
            Diagnostic::warning("csv/short-row", "the row ends early").at(line.place()).with_help(
                format!("expected {expected} cells, found {}; the rest is NaN", cells.len()),
            )
        });
    }
    // A comma inside a cell is not what separates them: it can only be the decimal separator.
    let mut commas = 0;
    let mut value = |index: usize, column: &str| match cells.get(index).map(|cell| cell.trim()) {
        None | Some("") => Ok(f64::NAN),
        Some(cell) => {
            let found = text::cell(cell).or_else(|| with_comma(cell).inspect(|_| commas += 1));
            found.ok_or_else(|| {
                let clipped: String = cell.chars().take(40).collect();
                let place = line.text.find(cell).and_then(|at| line.text.get(at..));
                Error::new("csv/cell", format!("`{clipped}` in column `{column}` is not a number"))
                    .at(place.map_or_else(|| line.place(), |part| line.place_of(part)))
                    .with_help("expected a number, or a blank cell")
            })
        }
    };
    let time = if timed { value(0, "time")? } else { table.times.len() as f64 };
    if !time.is_finite() {
        return Err(Error::new("csv/time", "the row has no time").at(line.place()));
    }
    if let Some(last) = table.times.last() {
        if time < *last {
            let message = format!("time goes back from {last} s to {time} s");
            return Err(Error::new("csv/time", message).at(line.place()));
        }
        if time == *last {
            warnings.add("csv/same-time", || {
                Diagnostic::warning("csv/same-time", format!("time {time} s is repeated"))
                    .at(line.place())
            });
        }
    }
    for (index, column) in table.columns.iter().enumerate() {
        table.values.push(value(index + usize::from(timed), column)?);
    }
    table.times.push(time);
    if commas > 0 {
        warnings.add("csv/decimal-comma", || {
            Diagnostic::warning("csv/decimal-comma", "the decimal separator is a comma")
                .at(line.place())
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_and_separators() {
        let read = read("time;\"a;\"\"b\"\"\"; c \n0;1;2\n").unwrap();
        assert_eq!(read.value.columns, ["a;\"b\"", "c"]);
        assert_eq!(read.value.row(0), [1.0, 2.0]);
        assert!(read.warnings.is_empty());
    }

    #[test]
    fn decimal_commas_where_they_cannot_be_mistaken() {
        let read = read("time;a\n0,5;-1,25\n").unwrap();
        assert_eq!((read.value.times[0], read.value.values[0]), (0.5, -1.25));
        assert!(read.warned("csv/decimal-comma"));
        assert_eq!(super::read("time;a\n0;1,000,000\n").unwrap_err().code(), "csv/cell");
    }

    #[test]
    fn remarks_are_kept() {
        let read = read("# inDegrees=yes\n# subject=7\ntime,a\n0,1\n").unwrap();
        assert_eq!(read.value.angle_unit, AngleUnit::Degrees);
        assert_eq!(read.value.header_value("Subject"), Some("7"));
    }

    #[test]
    fn faults_are_placed() {
        for (text, said) in [
            ("", "line 1: there is no line of names (the first line must name the columns)"),
            ("time,a\n0,abc\n", "line 2, column 3: `abc` in column `a` is not a number"),
            ("time,a\n0,1,2\n", "line 2: the row has too many cells (expected 2, found 3)"),
            ("0,1\n", "line 1: the first line holds numbers"),
            ("time,a\n1,1\n0,1\n", "line 3: time goes back from 1 s to 0 s"),
            ("time,a\0b\n", "line 1: the name of column 1 has 3 letters or is binary"),
            ("time,\"a\n", "line 1, column 6: a quoted cell does not end on its line"),
            ("time,\"a\"b\n", "line 1, column 9: text follows a quoted cell"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.starts_with(said), "{text:?}: {error}");
        }
    }

    #[test]
    fn a_short_row_is_nan() {
        let read = read("time,a,b\n0,1\n").unwrap();
        assert!(read.warned("csv/short-row"));
        assert!(read.value.value(0, 1).unwrap().is_nan());
    }
}
