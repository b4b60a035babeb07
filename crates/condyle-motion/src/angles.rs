//! The unit of angles that a table does not state.

use crate::columns::cells;
use crate::{AngleUnit, Table};
use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::{CoordinateKind, Model, Range};
use std::f64::consts::{PI, TAU};

/// How a unit is stated.
const HELP: &str = "state it: `--angles deg` or `--angles rad`, or a line `inDegrees=yes` or `inDegrees=no` in the header";

/// Values beyond a range by more than this, in radians, are no angle of that joint.
const BEYOND: f64 = 1.0;

/// The largest angle of a table, where it is, and whether joints can have such angles in radians.
struct Largest {
    size: f64,
    column: usize,
    time: f64,
    /// Whether one of the angles, if in radians, is far beyond the range of its coordinate.
    beyond: bool,
}

impl Table {
    /// Decides the unit of rotations where the table does not state it: as it is `told`, else by the size
    /// of the largest angle A of the table.
    ///
    /// ```text
    /// A > 3π             degrees
    /// π < A ≤ 3π         degrees, if in radians it were far beyond the ranges; else it cannot be told
    /// A ≤ π              radians, unless some were far beyond the ranges: then it cannot be told
    /// ```
    ///
    /// A CSV is in radians up to 3π, as this program writes it, which is a note. There only angles whose ranges are
    /// kept and narrower than a turn are asked, if there are any that are not 0: what turns on without an end exceeds 3π in
    /// radians too.
    ///
    /// Joints turn by less than π, so that in radians more than 3π (540°) does not occur, and between them
    /// are turns of the whole body in radians as well as small motions in degrees. Of the smallest
    /// motions radians are assumed, as OpenSim does of all that state no unit; far is 1 rad. With a model
    /// the angles are the columns of its rotations; without one all columns that are no lengths by
    /// their names. Every guess is a warning. A table without angles, or with zeros only, stays as it is.
    ///
    /// # Errors
    /// `motion/angle-unit` where it cannot be told.
    ///
    /// ```
    /// use condyle_motion::{AngleUnit, Table};
    /// let mut table = Table {
    ///     columns: vec!["knee_angle_r".into()],
    ///     times: vec![0.0, 0.1],
    ///     values: vec![5.0, 62.0],
    ///     ..Table::default()
    /// };
    /// assert_eq!(table.settle_angles(None, None)?.len(), 1);
    /// assert_eq!(table.angle_unit, AngleUnit::Degrees);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn settle_angles(
        &mut self,
        model: Option<&Model>,
        told: Option<AngleUnit>,
    ) -> Result<Vec<Diagnostic>, Error> {
        if let Some(told) = told {
            let stated = matches!(self.angle_unit, AngleUnit::Degrees | AngleUnit::Radians);
            let other = stated && self.angle_unit != told;
            let said = || {
                let message = format!("the file states {}", self.angle_unit.name());
                let help = format!("read in {}, as told", told.name());
                Diagnostic::warning("motion/angle-unit", message).with_help(help)
            };
            let said = other.then(said);
            self.angle_unit = told;
            return Ok(said.into_iter().collect());
        }
        let rule = self.angle_unit == AngleUnit::RadiansAsRule;
        if !rule && self.angle_unit != AngleUnit::Unstated {
            return Ok(vec![]);
        }
        let with_ends =
            if rule && model.is_some() { self.largest_angle(model, true) } else { None };
        let Some(largest) = with_ends.or_else(|| self.largest_angle(model, false)) else {
            return Ok(vec![]);
        };
        let Largest { size, column, time, beyond } = largest;
        let column = &self.columns[column];
        let what = format!(
            "the unit of angles is not stated, and the largest is {size:.4} (`{column}` at {time} s)"
        );
        let unit = match (size, beyond) {
            (size, _) if size > 3.0 * PI => AngleUnit::Degrees,
            _ if rule => {
                self.angle_unit = AngleUnit::Radians;
                let message = "the unit of angles is not stated: taken as radians, as in all CSV";
                return Ok(vec![Diagnostic::note("motion/angle-unit", message).with_help(HELP)]);
            }
            (size, true) if size > PI => AngleUnit::Degrees,
            (size, false) if size <= PI => AngleUnit::Radians,
            _ => {
                let message = format!("{what}, which may be degrees or radians");
                return Err(Error::new("motion/angle-unit", message).with_help(HELP));
            }
        };
        self.angle_unit = unit;
        let message = format!("{what}: taken as {}", unit.name());
        Ok(vec![Diagnostic::warning("motion/angle-unit", message).with_help(HELP)])
    }

    /// The largest of the angles, or of those `with_ends` only: with a range narrower than a turn that is kept; `None` if all
    /// are 0.
    fn largest_angle(&self, model: Option<&Model>, with_ends: bool) -> Option<Largest> {
        // Columns of angles, each with its range.
        let angles: Vec<(usize, [f64; 2])> = match model {
            Some(model) => {
                let turns = cells(model, self).into_iter().filter_map(|cell| {
                    let coordinate = model.coordinate(cell.coordinate);
                    let rotation = coordinate.kind == CoordinateKind::Rotation;
                    let Range { lower, upper, enforced } = coordinate.range;
                    let range =
                        [lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY)];
                    let ends = enforced && range[1] - range[0] <= TAU;
                    let asked = rotation && (ends || !with_ends);
                    Some((cell.column.filter(|_| asked)?, range))
                });
                turns.collect()
            }
            None => {
                let columns = self.columns.iter().enumerate();
                let angles = columns.filter(|(_, name)| !is_length(name));
                angles.map(|(column, _)| (column, [f64::NEG_INFINITY, f64::INFINITY])).collect()
            }
        };
        let mut largest: Option<Largest> = None;
        let mut beyond = false;
        for (row, &time) in self.times.iter().enumerate() {
            let values = self.row(row);
            for &(column, [low, high]) in &angles {
                let Some(value) = values.get(column).filter(|v| v.is_finite()) else { continue };
                beyond |= *value < low - BEYOND || *value > high + BEYOND;
                if value.abs() > largest.as_ref().map_or(0.0, |l| l.size) {
                    largest = Some(Largest { size: value.abs(), column, time, beyond: false });
                }
            }
        }
        largest.map(|largest| Largest { beyond, ..largest })
    }
}

/// Whether a column holds no angle, by its name: a translation, part of a quaternion, a speed, or a force.
///
/// ```
/// use condyle_motion::columns::is_length;
/// assert!(is_length("pelvis_tx") && !is_length("knee_angle_r"));
/// ```
#[must_use]
pub fn is_length(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let bare =
        lower.strip_suffix("/value").or_else(|| lower.strip_suffix("|value")).unwrap_or(&lower);
    let endings = [
        "_tx", "_ty", "_tz", "/tx", "/ty", "/tz", ".qx", ".qy", ".qz", ".qw", "_vx", "_vy", "_vz",
        "_px", "_py", "_pz", "_fx", "_fy", "_fz", "/speed", "|speed", "_u", "_force", "_moment",
    ];
    ["tx", "ty", "tz", "qx", "qy", "qz", "qw"].contains(&bare)
        || endings.iter().any(|ending| bare.ends_with(ending))
        || lower.contains("force")
        || lower.contains("translation")
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::ModelBuilder;

    fn table(columns: &[&str], values: &[f64]) -> Table {
        Table {
            columns: columns.iter().map(|c| (*c).to_owned()).collect(),
            times: vec![0.0],
            values: values.to_vec(),
            ..Table::default()
        }
    }

    #[test]
    fn sizes_that_tell_the_unit_and_sizes_that_do_not() {
        // 3π is 9.42.
        for (angle, unit) in [
            (9.5, Some(AngleUnit::Degrees)),
            (-120.0, Some(AngleUnit::Degrees)),
            (9.3, None),
            (3.2, None),
            (-3.1, Some(AngleUnit::Radians)),
            (0.01, Some(AngleUnit::Radians)),
        ] {
            // A length in millimetres and a force are no angles.
            let mut table =
                table(&["knee", "pelvis_tx", "ground_force_vx"], &[angle, 900.0, 800.0]);
            let said = table.settle_angles(None, None);
            assert_eq!(said.as_ref().map(Vec::len).ok(), unit.map(|_| 1), "{angle}");
            assert_eq!(table.angle_unit, unit.unwrap_or_default(), "{angle}");
        }
        let mut nothing = table(&["knee", "pelvis_ty"], &[0.0, 900.0]);
        assert_eq!(nothing.settle_angles(None, None).unwrap(), []);
        let mut told = table(&["knee"], &[5.0]);
        assert_eq!(told.settle_angles(None, Some(AngleUnit::Degrees)).unwrap(), []);
        assert_eq!(told.angle_unit, AngleUnit::Degrees);
        // What the file states counts, whatever the size.
        assert_eq!(told.settle_angles(None, None).unwrap(), []);
        assert_eq!(told.settle_angles(None, Some(AngleUnit::Radians)).unwrap().len(), 1);
        let csv =
            |angle| Table { angle_unit: AngleUnit::RadiansAsRule, ..table(&["knee"], &[angle]) };
        for (angle, unit) in [(5.0, AngleUnit::Radians), (60.0, AngleUnit::Degrees)] {
            let mut csv = csv(angle);
            assert_eq!(csv.settle_angles(None, None).unwrap().len(), 1);
            assert_eq!(csv.angle_unit, unit);
        }
    }

    #[test]
    fn ranges_tell_what_the_size_does_not() {
        let mut b = ModelBuilder::new("leg");
        let shank = b.segment("shank", None);
        let (_, angle) = b.hinge("knee", shank, "angle", Vec3::Z);
        b.coordinate_mut(angle).range = Range::new(-2.0, 0.2);
        let model = b.build().unwrap();
        // 5 rad are 4.8 rad beyond the range; 1.5 rad are 1.3 beyond it, but small for degrees.
        for (angle, unit) in
            [(5.0, Some(AngleUnit::Degrees)), (1.5, None), (1.1, Some(AngleUnit::Radians))]
        {
            let mut table = table(&["angle", "total"], &[angle, 500.0]);
            assert_eq!(table.settle_angles(Some(&model), None).is_ok(), unit.is_some(), "{angle}");
            assert_eq!(table.angle_unit, unit.unwrap_or_default(), "{angle}");
        }
    }

    #[test]
    fn what_turns_without_an_end_tells_no_unit_of_a_csv() {
        let mut b = ModelBuilder::new("dancer");
        let body = b.segment("body", None);
        let shank = b.segment("shank", Some(body));
        b.hinge("ground", body, "heading", Vec3::Y);
        let (_, knee) = b.hinge("knee", shank, "angle", Vec3::Z);
        b.coordinate_mut(knee).range = Range::new(-2.0, 0.2);
        let model = b.build().unwrap();
        // Two turns, 4π, beside a knee bent by 1.2 rad, or by 69 degrees; a knee that stays at 0 tells nothing.
        for (angle, unit) in
            [(-1.2, AngleUnit::Radians), (-69.0, AngleUnit::Degrees), (0.0, AngleUnit::Degrees)]
        {
            let mut csv = Table {
                angle_unit: AngleUnit::RadiansAsRule,
                ..table(&["heading", "angle"], &[4.0 * PI, angle])
            };
            assert_eq!(csv.settle_angles(Some(&model), None).unwrap().len(), 1);
            assert_eq!(csv.angle_unit, unit, "{angle}");
        }
    }
}
