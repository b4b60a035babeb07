//! Quaternions in the columns of a table.

use crate::frames::Orientated;
use condyle_diagnostics::{Diagnostic, Error, listed};
use condyle_math::Quat;
use condyle_motion::Table;

/// The names of the columns.
pub const COMPONENTS: [&str; 4] = ["qx", "qy", "qz", "qw"];

/// Where a table has the columns [`COMPONENTS`], in any order and in any case; `None` if one is missing.
#[must_use]
pub fn in_table(table: &Table) -> Option<[usize; 4]> {
    let mut found = [0; 4];
    for (place, name) in found.iter_mut().zip(COMPONENTS) {
        let is = |column: &String| column.trim().eq_ignore_ascii_case(name);
        *place = table.columns.iter().position(is)?;
    }
    Some(found)
}

/// The rotations in the columns qx, qy, qz, qw of a table, brought to length 1. Rows that are blank are missing, and those
/// that are no rotation unusable.
///
/// # Errors
/// `rotations/columns` if the table lacks one of the columns.
///
/// ```
/// use condyle_learn::rotations::of_table;
/// use condyle_motion::Table;
/// let table = Table {
///     columns: ["qw", "qx", "qy", "qz"].map(str::to_owned).to_vec(),
///     times: vec![0.0, 1.0, 2.0],
///     // A quarter turn about x, no rotation, the quarter turn again, twice as long.
///     values: vec![0.6, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.2, 1.6, 0.0, 0.0],
///     ..Table::default()
/// };
/// let found = of_table(&table)?;
/// assert_eq!((found.frames.as_slice(), found.unusable.as_slice(), found.scaled), (&[0, 2][..], &[1][..], 1));
/// assert!((found.rotations[0].x - 0.8).abs() < 1e-15);
/// assert!(found.rotations[0].angle_to(found.rotations[1]) < 1e-7);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn of_table(table: &Table) -> Result<Orientated, Error> {
    let Some(columns) = in_table(table) else {
        let message = format!("no columns qx, qy, qz, qw among {}", listed(&table.columns));
        return Err(Diagnostic::error("rotations/columns", message)
            .with_help("a table of rotations has these four, in any order")
            .into());
    };
    let mut said = Orientated::default();
    for row in 0..table.rows() {
        let cells = table.row(row);
        let q = columns.map(|column| cells.get(column).copied().unwrap_or(f64::NAN));
        if q.iter().all(|v| v.is_nan()) {
            said.missing += 1;
        } else {
            said.push(row, Quat::from(q));
        }
    }
    Ok(said)
}
