//! Recordings of inertial sensors: orientations over time.

use crate::Table;
use condyle_diagnostics::{Diagnostic, Error, Read, listed};
use condyle_math::Quat;

/// Orientations of sensors in the world, frame by frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orientations {
    /// Names of the sensors; no two are the same.
    pub labels: Vec<String>,
    /// Frames per second; 0 where the file does not say.
    pub rate: f64,
    /// Seconds, one per frame, never falling.
    pub times: Vec<f64>,
    /// Row by row, one per frame and sensor: unit quaternions that take the sensor's axes to the
    /// world's; `None` where the sensor has no value.
    pub rotations: Vec<Option<Quat>>,
}

impl Orientations {
    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// A sensor's orientation in a frame.
    #[must_use]
    pub fn rotation(&self, frame: usize, sensor: usize) -> Option<Quat> {
        let inside = sensor < self.labels.len();
        inside.then(|| self.rotations.get(frame * self.labels.len() + sensor).copied())??
    }

    /// The orientations in a table of quaternions, as OpenSim's `.sto` files of inertial sensors have
    /// them: four columns `NAME_1` to `NAME_4` for each sensor, which are w, x, y, z.
    ///
    /// Quaternions are brought to length 1; one that is blank or 0 is missing, with a warning.
    ///
    /// # Errors
    /// `orientations/columns` if no sensor has all of its four columns, `orientations/other` if the
    /// table's header names another type of cells.
    ///
    /// ```
    /// use condyle_motion::{Orientations, Table};
    /// let half = 0.5f64.sqrt();
    /// let table = Table {
    ///     columns: [1, 2, 3, 4].map(|part| format!("femur_r_imu_{part}")).to_vec(),
    ///     times: vec![0.0],
    ///     values: vec![half, half, 0.0, 0.0],
    ///     header: vec![("DataType".into(), "Quaternion".into()), ("DataRate".into(), "100".into())],
    ///     ..Table::default()
    /// };
    /// let read = Orientations::from_table(&table)?.value;
    /// assert_eq!((read.labels[0].as_str(), read.rate), ("femur_r_imu", 100.0));
    /// // A quarter turn about x.
    /// let turn = read.rotation(0, 0).unwrap().log();
    /// assert!((turn.x - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn from_table(table: &Table) -> Result<Read<Self>, Error> {
        if let Some(other) =
            table.header_value("DataType").filter(|t| !t.eq_ignore_ascii_case("quaternion"))
        {
            let message = format!("the cells of the table are of the type {other}");
            let help = "give a table of quaternions";
            return Err(Error::new("orientations/other", message).with_help(help));
        }
        let column = |label: &str, part: usize| {
            let name = format!("{label}_{part}");
            table.columns.iter().position(|column| *column == name)
        };
        let mut sensors: Vec<(&str, [usize; 4])> = vec![];
        for label in table.columns.iter().filter_map(|c| c.strip_suffix("_1")) {
            let found = [1, 2, 3, 4].map(|part| column(label, part));
            if let [Some(w), Some(x), Some(y), Some(z)] = found {
                sensors.push((label, [x, y, z, w]));
            }
        }
        if sensors.is_empty() {
            let message = format!("no sensor has four columns among {}", listed(&table.columns));
            let help = "a sensor `pelvis_imu` has the columns `pelvis_imu_1` to `pelvis_imu_4`";
            return Err(Error::new("orientations/columns", message).with_help(help));
        }
        let mut missing = 0;
        let mut rotations = Vec::with_capacity(table.rows() * sensors.len());
        for row in (0..table.rows()).map(|row| table.row(row)) {
            for (_, columns) in &sensors {
                let q = columns.map(|column| row[column]);
                let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
                let seen = length.is_finite() && length > 1e-9;
                missing += usize::from(!seen);
                rotations.push(seen.then(|| Quat::from(q).normalized()));
            }
        }
        let warnings = match missing {
            0 => vec![],
            _ => vec![Diagnostic::warning(
                "orientations/missing",
                format!("{missing} quaternions are blank or 0"),
            )],
        };
        let rate = table.header_value("DataRate").and_then(|rate| rate.trim().parse().ok());
        let value = Self {
            labels: sensors.iter().map(|(label, _)| (*label).to_owned()).collect(),
            rate: rate.unwrap_or(0.0),
            times: table.times.clone(),
            rotations,
        };
        Ok(Read { value, warnings })
    }
}
