//! Tables over time: motions, forces, errors, independent of file formats.

use crate::columns::coordinate_name;

/// The unit of a table's rotational columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AngleUnit {
    /// The file states degrees, or has the old header that implies them.
    Degrees,
    /// The file states radians.
    Radians,
    /// The file does not state it, and is of a format that this program writes in radians: CSV.
    RadiansAsRule,
    /// The file does not state it.
    #[default]
    Unstated,
}

impl AngleUnit {
    /// Its name in a sentence.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Degrees => "degrees",
            Self::Radians => "radians",
            Self::RadiansAsRule | Self::Unstated => "no unit of angles",
        }
    }
}

/// Columns of numbers over time.
///
/// Nothing is converted: only with a model is it known which columns are rotations, so
/// [`angle_unit`](Self::angle_unit) gives their unit and the caller converts them.
///
/// ```
/// use condyle_motion::{AngleUnit, Table};
/// let table = Table {
///     name: "walk".into(),
///     columns: vec!["/jointset/knee_r/knee_angle_r/value".into(), "pelvis_tx".into()],
///     times: vec![0.0, 0.01],
///     values: vec![-5.0, 0.60, -6.0, 0.61],
///     angle_unit: AngleUnit::Degrees,
///     header: Vec::new(),
/// };
/// assert_eq!(table.column("knee_angle_r"), Some(0));
/// assert_eq!(table.value(1, 0), Some(-6.0));
/// assert_eq!(table.series(1).collect::<Vec<_>>(), [0.60, 0.61]);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// The title in the file; may be empty.
    pub name: String,
    /// Names of the columns, without that of time; no two are the same.
    pub columns: Vec<String>,
    /// Seconds, one per row, never decreasing.
    pub times: Vec<f64>,
    /// Row by row, one per time and column, as in the file; NaN where a cell was blank.
    pub values: Vec<f64>,
    /// The unit of the rotational columns.
    pub angle_unit: AngleUnit,
    /// Other keys and values of the file's header, in order.
    pub header: Vec<(String, String)>,
}

impl Table {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.times.len()
    }

    /// One row, in the order of the columns; empty if there is no such row.
    #[must_use]
    pub fn row(&self, row: usize) -> &[f64] {
        let width = self.columns.len();
        row.checked_mul(width)
            .and_then(|start| self.values.get(start..start.checked_add(width)?))
            .unwrap_or_default()
    }

    /// One cell; `None` if there is no such row or column.
    #[must_use]
    pub fn value(&self, row: usize, column: usize) -> Option<f64> {
        self.row(row).get(column).copied()
    }

    /// One column from the first row to the last; empty if there is no such column.
    pub fn series(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.rows()).filter_map(move |row| self.value(row, column))
    }

    /// Index of a column, by its whole name or by that of the coordinate whose value it holds.
    ///
    /// A whole name takes precedence. A coordinate that two columns hold (one name in two joints)
    /// is found only by its whole name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        if let Some(exact) = self.columns.iter().position(|c| c == name) {
            return Some(exact);
        }
        let mut found = self
            .columns
            .iter()
            .enumerate()
            .filter(|(_, column)| coordinate_name(column) == Some(name));
        match (found.next(), found.next()) {
            (Some((index, _)), None) => Some(index),
            _ => None,
        }
    }

    /// The value of a header key, ignoring case.
    #[must_use]
    pub fn header_value(&self, key: &str) -> Option<&str> {
        self.header.iter().find(|(k, _)| k.eq_ignore_ascii_case(key)).map(|(_, v)| v.as_str())
    }

    /// Why the fields are inconsistent, if they are.
    #[must_use]
    pub fn mismatch(&self) -> Option<String> {
        let (rows, columns) = (self.rows(), self.columns.len());
        (rows.checked_mul(columns) != Some(self.values.len())).then(|| {
            format!(
                "{rows} rows of {columns} columns need {} values, found {}",
                rows.saturating_mul(columns),
                self.values.len()
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(columns: &[&str]) -> Table {
        Table { columns: columns.iter().map(|c| (*c).to_owned()).collect(), ..Default::default() }
    }

    #[test]
    fn whole_names_win_and_ambiguous_ones_are_not_guessed() {
        let table = named(&["/jointset/a/flexion/value", "flexion", "/jointset/b/tilt/value"]);
        assert_eq!(table.column("flexion"), Some(1));
        assert_eq!(table.column("tilt"), Some(2));
        assert_eq!(table.column("/jointset/a/flexion/value"), Some(0));
        let twice = named(&["/jointset/a/flexion/value", "/jointset/b/flexion/value"]);
        assert_eq!(twice.column("flexion"), None);
        assert_eq!(twice.column("speed"), None);
    }

    #[test]
    fn no_such_cell() {
        let table = Table { times: vec![0.0], values: vec![1.0], ..named(&["a"]) };
        assert_eq!(table.value(0, 0), Some(1.0));
        assert_eq!(table.value(0, 1), None);
        assert_eq!(table.value(1, 0), None);
        assert_eq!(table.series(3).count(), 0);
    }
}
