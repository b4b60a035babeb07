//! The marker recording that a motion would give.

use crate::{LengthUnit, Motion, Observed, Recording, Table};
use condyle_model::{Mode, Model, Pose, Program, SizeMismatch};

impl Motion {
    /// The model's markers along the motion, written to files in millimetres; a marker whose
    /// position is not finite is missing.
    ///
    /// # Errors
    /// [`SizeMismatch`] if a frame is not one of this model.
    pub fn virtual_markers(&self, model: &Model, mode: Mode) -> Result<Recording, SizeMismatch> {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        let mut positions = Vec::with_capacity(self.frames.len() * model.markers().len());
        for frame in &self.frames {
            program.evaluate(frame, mode, &mut pose)?;
            positions.extend(model.markers().iter().map(|marker| {
                let point = (pose.frame(marker.segment) * marker.point).to_array();
                Observed::from(point.iter().all(|x| x.is_finite()).then_some(point))
            }));
        }
        Ok(Recording {
            labels: model.markers().iter().map(|m| m.name.clone()).collect(),
            rate: rate(&self.times),
            times: self.times.clone(),
            positions,
            units: LengthUnit::Millimetre,
            confidences: None,
        })
    }
}

impl Recording {
    /// Three columns for each marker, in metres; NaN where it was not seen.
    #[must_use]
    pub fn to_table(&self) -> Table {
        let axes = ["x", "y", "z"];
        let columns = self.labels.iter().flat_map(|l| axes.map(|axis| format!("{l}.{axis}")));
        let values = self.positions.iter().flat_map(|p| p.position().unwrap_or([f64::NAN; 3]));
        Table {
            columns: columns.collect(),
            times: self.times.clone(),
            values: values.collect(),
            ..Table::default()
        }
    }
}

/// Frames per second of evenly spaced times, rounded to the usual precision of such rates.
pub(crate) fn rate(times: &[f64]) -> f64 {
    match times {
        [first, .., last] if last > first => {
            let rate = (times.len() - 1) as f64 / (last - first);
            (rate * 1e6).round() / 1e6
        }
        _ => 100.0,
    }
}
