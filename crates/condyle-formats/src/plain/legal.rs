//! Legal poses of a model, spread over its ranges.

use super::Tree;
use condyle_math::{Quat, Vec3};
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program};

/// Poses whose coordinates are legal, always the same ones.
#[derive(Debug)]
pub struct Legal<'m> {
    model: &'m Model,
    program: Program,
    pose: Pose,
    state: u64,
}

impl<'m> Legal<'m> {
    /// The poses that this seed begins.
    pub fn new(model: &'m Model, seed: u64) -> Self {
        let program = Program::compile(model);
        let pose = Pose::new(&program);
        Self { model, program, pose, state: seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D }
    }

    /// A number from 0 to 1 (xorshift64*).
    fn share(&mut self) -> f64 {
        self.state = self.state.max(1);
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        (self.state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The interval of a coordinate of one number that is looked at: its range; where it has none, a quarter
    /// turn, half a metre or 1 about its default.
    pub fn interval(model: &Model, id: condyle_model::CoordinateId) -> (f64, f64) {
        let coordinate = model.coordinate(id);
        let default = coordinate.default[0];
        let reach = match coordinate.kind {
            CoordinateKind::Rotation | CoordinateKind::Orientation => std::f64::consts::FRAC_PI_2,
            CoordinateKind::Translation | CoordinateKind::Scale => 0.5,
            CoordinateKind::Other => 1.0,
        };
        let lower = coordinate
            .range
            .lower
            .unwrap_or_else(|| coordinate.range.upper.map_or(default, |u| u.min(default)) - reach);
        let upper = coordinate.range.upper.unwrap_or_else(|| lower.max(default) + reach);
        // Files give ranges of many turns and metres where they mean none.
        let wide = if coordinate.kind == CoordinateKind::Rotation {
            2.0 * std::f64::consts::PI
        } else {
            20.0
        };
        (
            lower.clamp(default.min(0.0) - wide, default.max(0.0) + wide),
            upper.clamp(default.min(0.0) - wide, default.max(0.0) + wide),
        )
    }

    /// The default pose: its stored numbers, and the pose itself.
    pub fn rest(&mut self) -> (Vec<f64>, &Pose) {
        let stored = self.model.defaults();
        self.settle(&stored)
    }

    /// The next pose: its effective stored numbers, and the pose at them.
    pub fn next_pose(&mut self) -> (Vec<f64>, &Pose) {
        let mut stored = self.model.defaults();
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            if coordinate.locked || coordinate.follows.is_some() {
                continue;
            }
            let place = self.model.stored_range(id);
            if coordinate.kind == CoordinateKind::Orientation {
                let turn = [0; 3].map(|_| 1.4 * self.share() - 0.7);
                let turned = Quat::exp(Vec3::from(turn)).normalized();
                stored[place].copy_from_slice(&turned.to_array());
                continue;
            }
            let (lower, upper) = Self::interval(self.model, id);
            let share = self.share();
            stored[place.start] = lower + (upper - lower) * share;
        }
        self.settle(&stored)
    }

    fn settle(&mut self, stored: &[f64]) -> (Vec<f64>, &Pose) {
        let posed = self.program.evaluate(stored, Mode::Posed, &mut self.pose);
        debug_assert!(posed.is_ok(), "stored numbers have the model's length");
        let effective = self.pose.effective().to_vec();
        let open = self.program.evaluate(&effective, Mode::Open, &mut self.pose);
        debug_assert!(open.is_ok(), "stored numbers have the model's length");
        (self.pose.effective().to_vec(), &self.pose)
    }

    /// Whether limits of these components hold at the pose that was made last: those that posed mode cannot keep,
    /// since they are on what several segments make together.
    pub fn keeps(&self, components: &[ComponentId]) -> bool {
        let bounds = self.program.bounds().iter().filter(|b| components.contains(&b.component));
        bounds.flat_map(|b| b.rows.clone()).all(|row| self.pose.limit_row(row) >= -1e-9)
    }

    /// The values of a tree at the next pose.
    pub fn next_values(&mut self, tree: &Tree) -> Vec<f64> {
        let model = self.model;
        let (stored, pose) = self.next_pose();
        let variables = tree.variables_at(model, &stored);
        tree.values_at(model, pose, &variables)
    }
}
