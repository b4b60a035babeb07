//! A model that looks along another axis of its world.

use super::{Condition, Facing, Model, UpAxis};
use crate::component::PortType;
use condyle_math::{Affine, Quat, Vec3};

impl Model {
    /// The model in a world turned about the vertical, so that at rest it looks along `facing`.
    ///
    /// Coordinates mean what they did: each pose is that of the model, turned as a whole. The same model is returned where
    /// it looks there already, and where a component measures against the axes of the world, whose values would change.
    /// Where z is up, directions are turned as [`Facing`] says: one that is to look along +z looks against y.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::{Facing, ModelBuilder};
    /// let mut b = ModelBuilder::new("nose");
    /// let head = b.segment("head", None);
    /// b.place_joint(head, Vec3::new(0.1, 1.6, 0.0));
    /// b.facing(Facing::PlusX);
    /// let turned = b.build()?.looking(Facing::PlusZ);
    /// let place = turned.segments()[0].joint_in_parent.translation;
    /// assert!((place - Vec3::new(0.0, 1.6, 0.1)).norm() < 1e-15);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    #[must_use]
    pub fn looking(&self, facing: Facing) -> Self {
        let mut model = self.clone();
        if self.facing == facing || self.measures_the_world() {
            return model;
        }
        let up = match self.up {
            UpAxis::Y => Vec3::Y,
            UpAxis::Z => Vec3::Z,
        };
        let (from, to) = (self.facing.ahead(self.up), facing.ahead(self.up));
        let angle = up.dot(from.cross(to)).atan2(from.dot(to));
        let turn = Quat::from_axis_angle(up, angle).to_mat3();
        let whole = Affine::from_rotation(turn);
        model.facing = facing;
        for segment in model.segments.iter_mut().filter(|segment| segment.parent.is_none()) {
            segment.joint_in_parent = whole * segment.joint_in_parent;
        }
        for marker in model.markers.iter_mut().filter(|marker| marker.segment.is_none()) {
            marker.point = turn * marker.point;
        }
        for closure in &mut model.closures {
            match &mut closure.condition {
                Condition::Points { at } | Condition::Distance { at, .. } => {
                    for (_, point) in at.iter_mut().filter(|(segment, _)| segment.is_none()) {
                        *point = turn * *point;
                    }
                }
                Condition::Frames { at } => {
                    for (_, frame) in at.iter_mut().filter(|(segment, _)| segment.is_none()) {
                        *frame = whole * *frame;
                    }
                }
                Condition::Coupling { .. } => {}
            }
        }
        model
    }

    /// Whether a component measures a segment against the world.
    fn measures_the_world(&self) -> bool {
        self.components.iter().any(|component| {
            let mut ports = component.law.kind().ports.iter();
            ports.any(|port| port.takes == PortType::Segment && !component.law.has(port))
        })
    }
}
