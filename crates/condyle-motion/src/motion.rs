//! The coordinates of a model over time, to and from tables.

use crate::columns::{cells, columns, coordinate_name};
use crate::{AngleUnit, Table};
use condyle_diagnostics::{Diagnostic, listed};
use condyle_model::{CoordinateId, CoordinateKind, Mode, Model, Pose, Program};

/// Stored numbers of all coordinates of one model, frame by frame, in radians and metres.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Motion {
    /// Seconds, one for each frame.
    pub times: Vec<f64>,
    /// For each frame the stored numbers of all coordinates, in the model's order.
    pub frames: Vec<Vec<f64>>,
}

/// Cells of coordinates that hold no number.
pub const BLANK: &str = "motion/blank";

impl Motion {
    /// A motion from a table whose columns are named after coordinates.
    ///
    /// Degrees are converted for rotations only, and only where the table states degrees.
    /// Coordinates without a column keep their defaults; columns that match no coordinate are
    /// reported.
    pub fn from_table(model: &Model, table: &Table) -> (Self, Vec<Diagnostic>) {
        let mut warnings = vec![];
        let mut used = vec![false; table.columns.len()];
        let mut absent = vec![];
        let cells = cells(model, table);
        for cell in &cells {
            match cell.column {
                Some(column) => used[column] = true,
                None if cell.part == 0 => {
                    absent.push(columns(model, cell.coordinate).swap_remove(0))
                }
                None => {}
            }
        }
        if !absent.is_empty() {
            warnings.push(
                Diagnostic::warning("motion/absent", format!("no column for {}", listed(&absent)))
                    .with_help("these coordinates keep their defaults"),
            );
        }
        let extra: Vec<String> = table
            .columns
            .iter()
            .zip(used)
            .filter(|(column, used)| !used && coordinate_name(column).is_some())
            .map(|(column, _)| column.clone())
            .collect();
        if !extra.is_empty() {
            let message = format!("the model has no coordinate for {}", listed(&extra));
            warnings.push(
                Diagnostic::warning("motion/extra", message).with_help("these columns are ignored"),
            );
        }
        let defaults = model.defaults();
        let mut gaps = 0;
        let frames = (0..table.rows())
            .map(|row| {
                let mut stored = defaults.clone();
                for cell in &cells {
                    let Some(column) = cell.column else { continue };
                    match table.value(row, column) {
                        Some(value) if value.is_finite() => {
                            stored[cell.place] = value * cell.factor
                        }
                        _ => gaps += 1,
                    }
                }
                stored
            })
            .collect();
        if gaps > 0 {
            warnings.push(
                Diagnostic::warning(BLANK, format!("{gaps} cells hold no number"))
                    .with_help("the coordinates keep their defaults there"),
            );
        }
        (Self { times: table.times.clone(), frames }, warnings)
    }

    /// A table of the motion, coupled coordinates included, rotations in degrees.
    ///
    /// Coordinates that are neither rotations nor translations are written without conversion, as
    /// OpenSim expects.
    pub fn to_table(&self, model: &Model, name: &str) -> Table {
        let ids: Vec<CoordinateId> = model.coordinate_ids().collect();
        let mut values = Vec::with_capacity(self.frames.len() * model.stored_len());
        for frame in &self.frames {
            for &id in &ids {
                let rotation = model.coordinate(id).kind == CoordinateKind::Rotation;
                let factor = if rotation { 1f64.to_degrees() } else { 1.0 };
                values.extend(frame[model.stored_range(id)].iter().map(|v| v * factor));
            }
        }
        Table {
            name: name.to_owned(),
            columns: ids.iter().flat_map(|&id| columns(model, id)).collect(),
            times: self.times.clone(),
            values,
            angle_unit: AngleUnit::Degrees,
            header: vec![],
        }
    }

    /// Replaces requested by effective coordinates, frame by frame.
    pub fn make_effective(&mut self, program: &Program, mode: Mode) {
        let mut pose = Pose::new(program);
        for frame in &mut self.frames {
            if program.evaluate(frame, mode, &mut pose).is_ok() {
                frame.copy_from_slice(pose.effective());
            }
        }
    }
}
