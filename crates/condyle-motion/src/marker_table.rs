//! Markers in a table: three columns for each.

use crate::recording::Observed;
use crate::{LengthUnit, Recording, Table};
use condyle_diagnostics::{Diagnostic, Error, Read, listed};

/// What the columns of one marker end in, in lower case: the first style that fits three columns is taken.
const STYLES: [[&str; 3]; 9] = [
    ["_tx", "_ty", "_tz"],
    ["_px", "_py", "_pz"],
    ["_x", "_y", "_z"],
    [".x", ".y", ".z"],
    [":x", ":y", ":z"],
    ["/x", "/y", "/z"],
    [" x", " y", " z"],
    ["-x", "-y", "-z"],
    ["_1", "_2", "_3"],
];

impl Recording {
    /// The unit in which positions of this size were written, as far as it can be told: `positions` are
    /// as in a file.
    ///
    /// A body spans 1 to 2.5 m and a hand 0.1 to 0.25 m, so up to 3 are metres and from 260 on
    /// millimetres. Between them are bodies in centimetres and hands in millimetres.
    #[must_use]
    pub fn unit_by_size(&self) -> Option<LengthUnit> {
        match self.extent().unwrap_or_else(|| self.reach()) {
            size if size > 260.0 => Some(LengthUnit::Millimetre),
            size if size <= 3.0 => Some(LengthUnit::Metre),
            _ => None,
        }
    }

    /// The markers of a table with three columns for each: `name_tx`, `name_ty`, `name_tz`, or with the
    /// endings `_x`, `.x`, `:x`, `_1` and so on, as cells of vectors have them.
    ///
    /// The unit is that of the header (`Units=mm`); without one it is told by the size of the data
    /// ([`Recording::unit_by_size`]), with a warning. Other columns are named in a warning.
    ///
    /// # Errors
    /// `markers/columns` if no marker has all of its three columns, `markers/unit` if the unit is not
    /// stated and cannot be told.
    ///
    /// ```
    /// use condyle_motion::{LengthUnit, Recording, Table};
    /// let table = Table {
    ///     columns: ["LASI_tx", "LASI_ty", "LASI_tz"].map(str::to_owned).to_vec(),
    ///     times: vec![0.0],
    ///     values: vec![100.0, 900.0, -120.0],
    ///     header: vec![("Units".into(), "mm".into())],
    ///     ..Table::default()
    /// };
    /// let recording = Recording::from_table(&table)?.value;
    /// assert_eq!(recording.labels, ["LASI"]);
    /// assert_eq!(recording.position(0, 0), Some([0.1, 0.9, -0.12]));
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn from_table(table: &Table) -> Result<Read<Self>, Error> {
        let mut used = vec![false; table.columns.len()];
        let mut markers: Vec<(&str, [usize; 3])> = vec![];
        for (index, name) in table.columns.iter().enumerate() {
            if let Some((label, columns)) = marker_at(table, index, name)
                && columns.iter().all(|&column| !used[column])
            {
                columns.iter().for_each(|&column| used[column] = true);
                markers.push((label, columns));
            }
        }
        if markers.is_empty() {
            let message = format!("no marker has three columns among {}", listed(&table.columns));
            let help = "a marker `LASI` has the columns LASI_tx, LASI_ty and LASI_tz";
            return Err(Error::new("markers/columns", message).with_help(help));
        }
        let mut warnings = vec![];
        let others: Vec<&String> =
            table.columns.iter().zip(&used).filter(|(_, used)| !**used).map(|(c, _)| c).collect();
        if !others.is_empty() {
            let message = format!("no markers: {}", listed(others));
            let said = Diagnostic::warning("markers/other-columns", message);
            warnings.push(said.with_help("these columns are ignored"));
        }
        let place = |row: usize, columns: &[usize; 3]| {
            let position = columns.map(|column| table.value(row, column).unwrap_or(f64::NAN));
            let finite = position.iter().all(|x| x.is_finite());
            Observed::from(finite.then_some(position))
        };
        let rows = 0..table.rows();
        let positions =
            rows.flat_map(|row| markers.iter().map(move |(_, columns)| place(row, columns)));
        let stated = table.header_value("DataRate").and_then(|rate| rate.trim().parse().ok());
        let mut recording = Self {
            labels: markers.iter().map(|(label, _)| (*label).to_owned()).collect(),
            rate: stated.unwrap_or_else(|| crate::virtual_markers::rate(&table.times)),
            times: table.times.clone(),
            positions: positions.collect(),
            units: LengthUnit::Metre,
            confidences: None,
        };
        let unit = table.header_value("Units").and_then(LengthUnit::from_name);
        let unit = match unit {
            Some(unit) => unit,
            None => {
                let size = recording.extent().unwrap_or_else(|| recording.reach());
                let span = format!("no unit of length is stated, and the markers span {size:.4}");
                let help = "write a line `Units=mm` into the header";
                let unit = recording.unit_by_size();
                let error =
                    || Error::new("markers/unit", format!("{span}, which does not tell it"));
                let unit = unit.ok_or_else(|| error().with_help(help))?;
                let message = format!("{span}: taken as {}", unit.name());
                warnings.push(Diagnostic::warning("markers/unit", message).with_help(help));
                unit
            }
        };
        for position in recording.positions.iter_mut().filter_map(Observed::position_mut) {
            *position = position.map(|x| unit.to_metres(x));
        }
        recording.units = unit;
        Ok(Read { value: recording, warnings })
    }
}

/// The marker whose first column this is, and all three of its columns.
fn marker_at<'t>(table: &'t Table, index: usize, name: &'t str) -> Option<(&'t str, [usize; 3])> {
    STYLES.iter().find_map(|style| {
        let label = name.get(..name.len().checked_sub(style[0].len())?)?;
        let ending = |column: &str, ending: &str| {
            let rest = column.get(..label.len()).filter(|start| *start == label);
            rest.is_some() && column[label.len()..].eq_ignore_ascii_case(ending)
        };
        let find = |end: &str| table.columns.iter().position(|column| ending(column, end));
        (!label.is_empty() && ending(name, style[0])).then_some(())?;
        // A fourth number is that of a quaternion.
        if style[0] == "_1" && find("_4").is_some() {
            return None;
        }
        Some((label, [index, find(style[1])?, find(style[2])?]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(ends: [&str; 3], values: &[f64], header: &[(&str, &str)]) -> Table {
        let names =
            ["LASI", "knee_1"].iter().flat_map(|name| ends.map(|end| format!("{name}{end}")));
        Table {
            columns: names.chain(["force".to_owned()]).collect(),
            times: vec![0.0],
            values: [values, &[7.0]].concat(),
            header: header.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect(),
            ..Table::default()
        }
    }

    #[test]
    fn three_columns_make_a_marker_in_every_style() {
        for style in STYLES.iter().chain([&["_TX", "_TY", "_TZ"], &[".X", ".Y", ".Z"]]) {
            let values = [1.0, 2.0, 3.0, 1.5, f64::NAN, 3.5];
            let read = Recording::from_table(&table(*style, &values, &[])).unwrap();
            assert_eq!(read.value.labels, ["LASI", "knee_1"], "{style:?}");
            assert_eq!(read.value.position(0, 0), Some([1.0, 2.0, 3.0]), "{style:?}");
            assert_eq!(read.value.position(0, 1), None, "{style:?}");
            let codes: Vec<_> = read.warnings.iter().map(|d| d.code).collect();
            assert_eq!(codes, ["markers/other-columns", "markers/unit"], "{style:?}");
        }
        assert!(Recording::from_table(&table(["_a", "_b", "_c"], &[0.0; 6], &[])).is_err());
    }

    #[test]
    fn the_unit_is_that_of_the_header_or_told_by_size() {
        let read = |size: f64, header: &[(&str, &str)]| {
            let values = [0.0, 0.0, 0.0, 0.0, size, 0.0];
            Recording::from_table(&table(["_tx", "_ty", "_tz"], &values, header))
                .map(|read| (read.value.units, read.value.extent().unwrap()))
                .map_err(|error| error.code().to_owned())
        };
        assert_eq!(read(1700.0, &[]), Ok((LengthUnit::Millimetre, 1.7)));
        assert_eq!(read(1.7, &[]), Ok((LengthUnit::Metre, 1.7)));
        assert_eq!(read(170.0, &[]), Err("markers/unit".into()));
        assert_eq!(read(170.0, &[("Units", "mm")]), Ok((LengthUnit::Millimetre, 0.17)));
    }
}
