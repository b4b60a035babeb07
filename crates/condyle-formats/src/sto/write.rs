//! Writing: the header OpenSim writes and reads, version 1.

use crate::text::{decimal, plain};
use condyle_diagnostics::Error;
use condyle_motion::{AngleUnit, Table};

/// Header keys that the writer sets itself, or that would be wrong for what it writes.
const OWN_KEYS: [&str; 11] = [
    "version",
    "nrows",
    "ncolumns",
    "indegrees",
    "name",
    "datatype",
    "datacolumns",
    "datarows",
    "otherdata",
    "range",
    "endheader",
];

/// Writes a table as `.mot` or `.sto`, which share one grammar.
///
/// Numbers have the shortest decimals that read back as the same; NaN is `nan`. An unstated angle
/// unit omits `inDegrees`; OpenSim then takes the rotations as radians.
///
/// # Errors
///
/// `sto/shape` if columns, times and values do not fit together, `sto/no-names` if a column has
/// no name.
///
/// ```
/// use condyle_formats::{AngleUnit, Table, sto};
/// let table = Table {
///     name: "Coordinates".into(),
///     columns: vec!["knee_angle_r".into()],
///     times: vec![0.0, 0.01],
///     values: vec![-5.5, -5.25],
///     angle_unit: AngleUnit::Degrees,
///     header: vec![],
/// };
/// assert_eq!(
///     sto::write(&table)?,
///     "Coordinates\nversion=1\nnRows=2\nnColumns=2\ninDegrees=yes\nendheader\n\
///      time\tknee_angle_r\n0\t-5.5\n0.01\t-5.25\n",
/// );
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(table: &Table) -> Result<String, Error> {
    if let Some(mismatch) = table.mismatch() {
        return Err(Error::new("sto/shape", mismatch));
    }
    Ok(head(table, table.rows())? + &rows(table))
}

/// The lines before the rows, for a table that will have so many of them.
///
/// # Errors
///
/// `sto/no-names` if a column has no name.
pub fn head(table: &Table, rows: usize) -> Result<String, Error> {
    if let Some(blank) = table.columns.iter().position(|column| plain(column).is_empty()) {
        return Err(Error::new("sto/no-names", format!("column {} has no name", blank + 2)));
    }
    let name = title(&table.name);
    let mut text =
        format!("{name}\nversion=1\nnRows={rows}\nnColumns={}\n", table.columns.len() + 1);
    match table.angle_unit {
        AngleUnit::Degrees => text.push_str("inDegrees=yes\n"),
        AngleUnit::Radians => text.push_str("inDegrees=no\n"),
        AngleUnit::RadiansAsRule | AngleUnit::Unstated => {}
    }
    for (key, value) in &table.header {
        let key = plain(key).replace('=', "_");
        if !key.is_empty() && !OWN_KEYS.iter().any(|own| key.eq_ignore_ascii_case(own)) {
            text.push_str(&format!("{key}={}\n", plain(value)));
        }
    }
    text.push_str("endheader\ntime");
    for column in &table.columns {
        text.push('\t');
        text.push_str(&plain(column));
    }
    text.push('\n');
    Ok(text)
}

/// The rows of a table, which may be some of many.
pub fn rows(table: &Table) -> String {
    let mut text = String::new();
    for (row, time) in table.times.iter().enumerate() {
        text.push_str(&decimal(*time));
        for value in table.row(row) {
            text.push('\t');
            text.push_str(&decimal(*value));
        }
        text.push('\n');
    }
    text
}

/// The title as a line that no reader mistakes for a key; OpenSim needs one.
fn title(name: &str) -> String {
    let title = plain(name).replace('=', "_");
    let first = title.split_whitespace().next().unwrap_or_default().to_ascii_lowercase();
    if title.is_empty() {
        "table".to_owned()
    } else if OWN_KEYS.contains(&first.as_str()) || title.to_lowercase().contains("angles are in") {
        format!("_{title}")
    } else {
        title
    }
}
