//! Which joint of a target is meant, and where its landmarks are.

use super::Landmarks;
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};

/// What moves the joint's centre along an axis of the law's parent.
#[derive(Clone, Debug, PartialEq)]
pub enum Along {
    /// A coordinate that follows by a law; its whole name, or its end.
    Follows(String),
    /// Nothing: it stays here (metres).
    Fixed(f64),
}

/// Where a law's landmarks are and which of its names are which angle and which translation.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFrame {
    /// In the axes in which the law's translations are.
    pub landmarks: Landmarks,
    /// The order of the rotations.
    pub order: EulerOrder,
    /// Their names, in that order.
    pub angles: [String; 3],
    /// The translations along x, y and z.
    pub centre: [Along; 3],
}

/// Where a landmark of a target is.
#[derive(Clone, Debug, PartialEq)]
pub enum LandmarkPlace {
    /// At a marker, or else at the origin of a segment, of that name.
    Named(String),
    /// In the parent's axes (metres).
    InParent(Vec3),
    /// A step along the axes of the world from the origin of a segment, while the target is in its zero posture (metres).
    Near {
        /// The segment.
        segment: String,
        /// The step.
        by: Vec3,
    },
}

/// A joint of a target.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetJoint {
    /// The segment that the joint moves, or the joint.
    pub joint: String,
    /// Origin, medial and lateral end.
    pub places: [LandmarkPlace; 3],
    /// Whether it is on the left.
    pub left: bool,
    /// The posture in which the law's angles are 0: what is not at its default, one number in radians or metres, or an orientation x, y, z, w.
    pub zero: Vec<(String, Vec<f64>)>,
    /// The target's names for controls of other joints.
    pub drivers: Vec<(String, String)>,
    /// The joint stays where the target has it while the law's angles are 0.
    pub holds: bool,
}

/// A joint of a target as it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// The segment that moves.
    pub segment: SegmentId,
    /// The landmarks in its parent.
    pub landmarks: Landmarks,
    /// The orientation of the segment in its parent.
    pub at_zero: Mat3,
    /// Where its joint is in its parent.
    pub centre: Vec3,
    /// The parent in the world in the zero posture.
    pub parent: Affine,
}

impl TargetJoint {
    /// The target's name for a control of another joint: its own, unless `drivers` says another.
    #[must_use]
    pub fn driver(&self, control: &str) -> String {
        let named = self.drivers.iter().find(|(law, _)| law == control);
        named.map_or(control, |(_, own)| own).to_owned()
    }

    /// Where the joint is in a model in its zero posture.
    ///
    /// # Errors
    /// Names that the model does not have, with the nearest; `transfer/joint` where a joint moves several segments.
    pub fn find(&self, model: &Model) -> Result<Standing, Error> {
        let sets = model.joint_set_ids();
        let of_set = sets.filter(|id| model.joint_sets()[id.index()].name == self.joint);
        let moved: Vec<SegmentId> =
            of_set.flat_map(|id| model.outputs_of(id).map(|(segment, _)| segment)).collect();
        let segment = match (model.find_segment(&self.joint), &moved[..]) {
            (Ok(segment), _) => segment,
            (Err(_), [segment]) => *segment,
            (Err(error), []) => return Err(error),
            (Err(_), several) => {
                let names: Vec<_> =
                    several.iter().map(|id| model.segment(*id).name.clone()).collect();
                let message = format!("`{}` moves several segments", self.joint);
                return Err(Error::new("transfer/joint", message)
                    .with_help(format!("name one of them: {}", names.join(", "))));
            }
        };
        let mut stored = model.defaults();
        for (name, values) in &self.zero {
            let range = model.stored_range(model.find_coordinate(name)?);
            let wanted = range.len();
            match stored.get_mut(range) {
                Some(own) if own.len() == values.len() => own.copy_from_slice(values),
                _ => {
                    let message = format!("`zero` has {} numbers for `{name}`", values.len());
                    let help = format!("give {wanted}: an angle, or an orientation x, y, z, w");
                    return Err(Error::new("transfer/zero", message).with_help(help));
                }
            }
        }
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        program
            .evaluate(&stored, Mode::Open, &mut pose)
            .map_err(|error| Error::new("transfer/posture", error.to_string()))?;
        let parent = model.segment(segment).parent;
        let world = pose.frame(parent);
        let back = world.linear.inverse();
        let inside = |point: Vec3| back * (point - world.translation);
        let place = |place: &LandmarkPlace| -> Result<Vec3, Error> {
            Ok(match place {
                LandmarkPlace::InParent(point) => *point,
                LandmarkPlace::Named(name) => {
                    match model.markers().iter().find(|marker| marker.name == *name) {
                        Some(marker) => inside(pose.frame(marker.segment) * marker.point),
                        None => inside(pose.segment(model.find_segment(name)?).translation),
                    }
                }
                LandmarkPlace::Near { segment, by } => {
                    inside(pose.segment(model.find_segment(segment)?).translation + *by)
                }
            })
        };
        let [origin, medial, lateral] = &self.places;
        let landmarks = Landmarks {
            origin: place(origin)?,
            medial: place(medial)?,
            lateral: place(lateral)?,
            left: self.left,
        };
        let local = pose.segment_in_parent(model, segment);
        Ok(Standing {
            segment,
            landmarks,
            at_zero: upright(local.linear),
            centre: local * model.segment(segment).joint_in_segment.translation,
            parent: world,
        })
    }
}

/// The rotation of a transform that may also enlarge.
pub(super) fn upright(linear: Mat3) -> Mat3 {
    let x = (linear * Vec3::X).normalized();
    let y = linear * Vec3::Y;
    let y = (y - x * x.dot(y)).normalized();
    Mat3::from_columns(x, y, x.cross(y))
}
