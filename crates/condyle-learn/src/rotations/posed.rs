//! Segments of a model that is posed by a motion.

use crate::frames::Orientated;
use condyle_diagnostics::Error;
use condyle_math::{Mat3, Quat};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};
use condyle_motion::Motion;

/// A segment, and the one in which it is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The segment whose rotation is meant.
    pub child: SegmentId,
    /// The one in whose axes; `None` is the world.
    pub reference: Option<SegmentId>,
}

impl Pair {
    /// A joint by the name of its segment, or of a joint set that moves one segment; seen in the segment's
    /// parent, or in another by its name.
    ///
    /// # Errors
    /// An unknown name, with the nearest; `rotations/joint` for a joint set that moves several segments, and for a
    /// segment seen in itself.
    pub fn named(model: &Model, joint: &str, reference: Option<&str>) -> Result<Self, Error> {
        let child = match model.find_segment(joint) {
            Ok(segment) => segment,
            Err(unknown) => {
                let mut sets = model.joint_set_ids();
                let set = sets.find(|set| model.joint_sets()[set.index()].name == joint);
                let moved: Vec<SegmentId> =
                    set.map_or(vec![], |set| model.outputs_of(set).map(|(s, _)| s).collect());
                match moved[..] {
                    [] => return Err(unknown),
                    [one] => one,
                    _ => {
                        let names: Vec<&str> =
                            moved.iter().map(|s| model.segment(*s).name.as_str()).collect();
                        let message = format!("the joint set `{joint}` moves several segments");
                        let help = format!("name one of them: {}", names.join(", "));
                        return Err(Error::new("rotations/joint", message).with_help(help));
                    }
                }
            }
        };
        let reference = match reference {
            Some(name) => Some(model.find_segment(name)?),
            None => model.segment(child).parent,
        };
        if reference == Some(child) {
            let message = format!("the segment `{joint}` is seen in itself");
            let help = "name another segment as the reference";
            return Err(Error::new("rotations/joint", message).with_help(help));
        }
        Ok(Self { child, reference })
    }
}

/// The rotations of segments in others over a motion, one result for each pair; limits are not applied.
///
/// A frame in which a segment is scaled or sheared has the rotation of its axes made perpendicular, x first.
///
/// # Errors
/// Those of the model's evaluation: a frame of the wrong length.
///
/// ```
/// use condyle_learn::rotations::{Pair, segments};
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_motion::Motion;
/// let mut b = ModelBuilder::new("arm");
/// let upper = b.segment("upper", None);
/// let lower = b.segment("lower", Some(upper));
/// b.hinge("shoulder", upper, "lift", Vec3::Z);
/// b.hinge("elbow", lower, "flexion", Vec3::X);
/// let model = b.build()?;
/// let motion = Motion { times: vec![0.0], frames: vec![vec![0.7, 0.3]] };
/// let pair = Pair::named(&model, "elbow", None)?;
/// let found = segments(&model, &motion, &[pair])?;
/// assert!((found[0].rotations[0].log().x - 0.3).abs() < 1e-12);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn segments(model: &Model, motion: &Motion, pairs: &[Pair]) -> Result<Vec<Orientated>, Error> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut found = vec![Orientated::default(); pairs.len()];
    for (number, frame) in motion.frames.iter().enumerate() {
        program
            .evaluate(frame, Mode::Open, &mut pose)
            .map_err(|error| Error::new("rotations/frame", error.to_string()))?;
        for (pair, said) in pairs.iter().zip(&mut found) {
            let child = turned(pose.segment(pair.child).linear);
            let reference = pair.reference.map(|s| turned(pose.segment(s).linear));
            said.push(number, reference.map_or(child, |r| r.conjugate() * child));
        }
    }
    Ok(found)
}

/// The rotation of axes that may be scaled or sheared; not finite where they are flat.
fn turned(linear: Mat3) -> Quat {
    let x = linear.x.normalized();
    let z = x.cross(linear.y).normalized();
    Quat::from_mat3(Mat3::from_columns(x, z.cross(x), z))
}
