//! A table over time: columns and their extremes.

use crate::output::columns;
use condyle::formats::{AngleUnit, Table};
use serde_json::{Value, json};

/// How many columns are listed in text output.
const MOST_LISTED: usize = 40;

fn unit(table: &Table) -> &'static str {
    match table.angle_unit {
        AngleUnit::Degrees => "degrees",
        AngleUnit::Radians => "radians",
        AngleUnit::RadiansAsRule | AngleUnit::Unstated => "unstated",
    }
}

/// The least and the greatest number of a column; `None` if it has no number.
fn extremes(table: &Table, column: usize) -> Option<[f64; 2]> {
    table.series(column).filter(|v| !v.is_nan()).fold(None, |found, v| match found {
        None => Some([v, v]),
        Some([low, high]) => Some([f64::min(low, v), f64::max(high, v)]),
    })
}

pub(super) fn to_json(table: &Table) -> Value {
    json!({
        "kind": "table",
        "name": table.name,
        "rows": table.rows(),
        "columns": table.columns,
        "ranges": (0..table.columns.len()).map(|c| extremes(table, c)).collect::<Vec<_>>(),
        "angle_unit": unit(table),
        "time": [table.times.first(), table.times.last()],
    })
}

pub(super) fn to_text(table: &Table) -> String {
    let mut text = "table over time\n".to_owned();
    let angles = match table.angle_unit {
        AngleUnit::RadiansAsRule | AngleUnit::Unstated => "unit of angles not stated".to_owned(),
        _ => format!("angles in {}", unit(table)),
    };
    let span = match table.times[..] {
        [] => String::new(),
        [first, ..] => format!(" from {first} to {} s", table.times.last().unwrap_or(&first)),
    };
    text.push_str(&format!(
        "{} rows{span}, {} columns, {angles}\n",
        table.rows(),
        table.columns.len()
    ));
    let shown = table.columns.len().min(MOST_LISTED);
    if shown == 0 {
        return text;
    }
    text.push_str("\ncolumns: least and greatest value, as in the file\n");
    let rows: Vec<Vec<String>> = (0..shown)
        .map(|column| {
            let cells = extremes(table, column)
                .map_or(["-".to_owned(), "-".to_owned()], |range| range.map(|v| format!("{v:.6}")));
            let [low, high] = cells;
            vec![table.columns[column].clone(), low, high]
        })
        .collect();
    text.push_str(&columns(&rows));
    if table.columns.len() > shown {
        text.push_str(&format!("  and {} more\n", table.columns.len() - shown));
    }
    text
}
