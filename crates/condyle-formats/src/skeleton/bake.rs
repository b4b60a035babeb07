//! Posed models as plain bones: whatever the joints are, each bone is turned and placed in its parent.

use super::Place;
use condyle_diagnostics::{Diagnostic, Error, listed};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};

/// One bone of a model at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainBone {
    /// The segment.
    pub segment: SegmentId,
    /// Its parent among the bones, which stands before it.
    pub parent: Option<usize>,
    /// Its joint at rest, as seen from the joint of its parent, along the axes of the world; from the
    /// world's origin where it has no parent. Metres.
    pub offset: Vec3,
    /// Its joint in the segment's own frame, in metres.
    pub joint: Vec3,
    /// Where it turns to, at rest: the segment's own axes in the world.
    pub rest: Mat3,
}

/// A model as plain bones that are rigid and have the axes of the world at rest.
///
/// Rest is the model at its defaults. The joint of every bone is exactly where the model has it in every
/// frame, also where bones are stretched: only the flesh around it is then not. A bone's own axes are those of
/// the world at rest, so its rotation is the identity there, and is relative to its parent's: with R the
/// rotation nearest to the segment's transform in the world and R₀ that at rest,
/// `B = R·R₀ᵀ`, `rotation = B_parentᵀ·B`, `translation = B_parentᵀ·(joint - joint_parent)`.
///
/// ```
/// use condyle_formats::skeleton::PlainBones;
/// use condyle_math::{Affine, Mat3, Vec3};
/// use condyle_model::{Mode, ModelBuilder};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.place_joint(forearm, Vec3::Y);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let mut bones = PlainBones::new(&model, Mode::Open)?;
/// let mut locals = vec![];
/// bones.pose(&[0.5], &mut locals)?;
/// assert_eq!(locals[0].translation, Vec3::Y);
/// assert!((locals[0].linear.x.y - 0.5f64.sin()).abs() < 1e-15);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
#[derive(Debug)]
pub struct PlainBones<'m> {
    model: &'m Model,
    program: Program,
    pose: Pose,
    mode: Mode,
    bones: Vec<PlainBone>,
    /// Turn and joint of each bone in the world.
    world: Vec<(Mat3, Vec3)>,
    /// For each bone the largest strain that was left out.
    strain: Vec<f64>,
}

/// Less than single precision can tell.
const LEAST_STRAIN: f64 = 1e-7;

impl<'m> PlainBones<'m> {
    /// The bones of a model. In posed mode limits hold.
    ///
    /// # Errors
    /// What evaluating the defaults gives.
    pub fn new(model: &'m Model, mode: Mode) -> Result<Self, Error> {
        let program = Program::compile(model);
        let pose = Pose::new(&program);
        let order = model.parents_first();
        let mut place = vec![0usize; order.len()];
        for (bone, id) in order.iter().enumerate() {
            place[id.index()] = bone;
        }
        let bones: Vec<PlainBone> = order
            .iter()
            .map(|&segment| PlainBone {
                segment,
                parent: model.segment(segment).parent.map(|parent| place[parent.index()]),
                offset: Vec3::ZERO,
                joint: model.segment(segment).joint_in_segment.translation,
                rest: Mat3::IDENTITY,
            })
            .collect();
        let (world, strain) = (vec![], vec![0.0; bones.len()]);
        let mut own = Self { model, program, pose, mode, bones, world, strain };
        own.evaluate(&model.defaults())?;
        for index in 0..own.bones.len() {
            let (turn, joint) = own.world[index];
            let parent = own.bones[index].parent.map_or(Vec3::ZERO, |parent| own.world[parent].1);
            own.bones[index].rest = turn;
            own.bones[index].offset = joint - parent;
        }
        own.strain.fill(0.0);
        Ok(own)
    }

    /// The bones, each after its parent.
    #[must_use]
    pub fn bones(&self) -> &[PlainBone] {
        &self.bones
    }

    /// A point of a segment's own frame as seen from the joint of its bone, along the bone's axes.
    #[must_use]
    pub fn point(&self, bone: usize, point: Vec3) -> Vec3 {
        self.bones.get(bone).map_or(point, |bone| bone.rest * (point - bone.joint))
    }

    /// The transforms of all bones in their parents, which replace what is in `locals`: a rotation and a
    /// translation each.
    ///
    /// # Errors
    /// `skeleton/size` if a frame has not the model's number of values.
    pub fn pose(&mut self, stored: &[f64], locals: &mut Vec<Affine>) -> Result<(), Error> {
        self.evaluate(stored)?;
        locals.clear();
        for (bone, (turn, joint)) in self.bones.iter().zip(&self.world) {
            let own = *turn * bone.rest.transpose();
            let (base, from) = match bone.parent {
                Some(parent) => {
                    let (turn, joint) = self.world[parent];
                    (turn * self.bones[parent].rest.transpose(), joint)
                }
                None => (Mat3::IDENTITY, Vec3::ZERO),
            };
            let back = base.transpose();
            locals.push(Affine::new(back * own, back * (*joint - from)));
        }
        Ok(())
    }

    /// Turns and joints of all segments in the world.
    fn evaluate(&mut self, stored: &[f64]) -> Result<(), Error> {
        self.program
            .evaluate(stored, self.mode, &mut self.pose)
            .map_err(|error| Error::new("skeleton/size", error.to_string()))?;
        self.world.clear();
        for (bone, worst) in self.bones.iter().zip(&mut self.strain) {
            let segment = self.pose.segment(bone.segment);
            let (turn, strain) = Place::turn(segment.linear);
            *worst = worst.max(strain);
            self.world.push((turn, segment * bone.joint));
        }
        Ok(())
    }

    /// The effective values of all coordinates in the frame that was posed last.
    #[must_use]
    pub fn effective(&self) -> &[f64] {
        self.pose.effective()
    }

    /// What was left out so far: bones that were stretched, shrunk or sheared.
    #[must_use]
    pub fn lost(&self) -> Option<Diagnostic> {
        let all = self.bones.iter().zip(&self.strain);
        let lost = all.filter(|(_, strain)| **strain > LEAST_STRAIN);
        let names: Vec<&str> =
            lost.clone().map(|(bone, _)| self.model.segment(bone.segment).name.as_str()).collect();
        let (worst, strain) = lost.max_by(|a, b| a.1.total_cmp(b.1))?;
        let message = format!(
            "sizes and shears of bones are left out: {}; at worst, in `{}`, points are off by {:.2} % of \
             their distance from the joint",
            listed(&names),
            self.model.segment(worst.segment).name,
            100.0 * strain,
        );
        Some(Diagnostic::warning("skeleton/strain", message).with_help("all joints are in place"))
    }
}
