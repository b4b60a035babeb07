//! Where the joints of a body are at rest, which files of poses do not say.

use super::tree::Tree;
use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_math::Vec3;
use condyle_model::{Facing, Model, UpAxis};

use crate::skeleton::{Bone, Freedom, FreedomKind, Skeleton};

/// Without these joints nothing is posed.
const NEEDED: [&str; 13] = [
    "pelvis",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
];

/// The joints of a body at rest: y up, looking along +z, the arms stretched out to the sides, the left one along
/// +x. Metres.
///
/// ```
/// use condyle_formats::smpl::Rest;
/// use condyle_math::Vec3;
/// let rest = Rest::new("one", vec![("pelvis".to_owned(), Vec3::Y)]);
/// assert_eq!(rest.joint("pelvis"), Some(Vec3::Y));
/// assert_eq!(rest.joint("jaw"), None);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    name: String,
    joints: Vec<Joint>,
    /// Whether places are those of a body of SMPL, from whose origin the pelvis is moved.
    body: bool,
}

/// One joint, and how each number of the shape moves it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) place: Vec3,
    pub(super) shape: Vec<Vec3>,
}

impl Rest {
    /// Places of joints by their names in a [`Tree`], as some model has them that `name` tells.
    #[must_use]
    pub fn new(name: &str, joints: Vec<(String, Vec3)>) -> Self {
        let joint = |(name, place)| Joint { name, place, shape: vec![] };
        let joints = joints.into_iter().map(joint).collect();
        Self { name: name.to_owned(), joints, body: false }
    }

    pub(super) fn of_body(joints: Vec<Joint>) -> Self {
        Self { name: "the body".to_owned(), joints, body: true }
    }

    /// Whose places they are.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether they are those of a body of SMPL, so that the place of the pelvis is known, too.
    #[must_use]
    pub fn is_body(&self) -> bool {
        self.body
    }

    /// How many numbers a shape has; 0 if it changes nothing.
    #[must_use]
    pub fn shapes(&self) -> usize {
        self.joints.iter().map(|joint| joint.shape.len()).max().unwrap_or(0)
    }

    /// Where a joint is, of the mean shape.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<Vec3> {
        self.joints.iter().find(|joint| joint.name == name).map(|joint| joint.place)
    }

    /// Where a joint is in a shape.
    fn shaped(&self, name: &str, betas: &[f64]) -> Option<Vec3> {
        let joint = self.joints.iter().find(|joint| joint.name == name)?;
        let steps = joint.shape.iter().zip(betas).map(|(step, beta)| *step * *beta);
        Some(steps.fold(joint.place, |place, step| place + step))
            .filter(|place| place.to_array().iter().all(|x| x.is_finite()))
    }

    /// The largest tree of which it has all joints; the trunk and the limbs where it has more of none.
    #[must_use]
    pub fn tree(&self) -> Tree {
        let has = |tree: &Tree| tree.joints().iter().all(|(name, _)| self.joint(name).is_some());
        Tree::ALL.into_iter().rev().find(has).unwrap_or(Tree::Body)
    }

    /// Places of all joints of a tree. Those that are not known are put evenly between their neighbours, or,
    /// where a limb ends, where they are in an adult's body; their names are told.
    pub(super) fn places(
        &self,
        tree: Tree,
        betas: &[f64],
    ) -> Result<(Vec<Vec3>, Vec<String>), Error> {
        let joints = tree.joints();
        let known: Vec<Option<Vec3>> =
            joints.iter().map(|(name, _)| self.shaped(name, betas)).collect();
        let missing: Vec<&str> = joints
            .iter()
            .zip(&known)
            .filter(|((name, _), place)| place.is_none() && NEEDED.contains(&name.as_str()))
            .map(|((name, _), _)| name.as_str())
            .collect();
        if !missing.is_empty() {
            let message = format!("{} has no {}", self.name, missing.join(", "));
            let help =
                "give a body of SMPL (.npz), or a model whose bones have names that are known";
            return Err(Error::new("smpl/rest", message).with_help(help));
        }
        let mut places: Vec<Vec3> = Vec::with_capacity(joints.len());
        let mut guessed = vec![];
        for (index, (name, parent)) in joints.iter().enumerate() {
            let from = parent.and_then(|p| places.get(p)).copied().unwrap_or(Vec3::ZERO);
            let place = known.get(index).copied().flatten().unwrap_or_else(|| {
                guessed.push(name.clone());
                match next_known(&joints, &known, index) {
                    Some((steps, end)) => from + (end - from) * (1.0 / (steps + 1) as f64),
                    None => from + usual(name),
                }
            });
            places.push(place);
        }
        Ok((places, guessed))
    }

    /// The skeleton of a tree with these places, standing on the ground, and the places.
    pub(super) fn skeleton(
        &self,
        tree: Tree,
        betas: &[f64],
    ) -> Result<(Skeleton, Vec<Vec3>, Option<Diagnostic>), Error> {
        let (places, guessed) = self.places(tree, betas)?;
        let pelvis = places.first().copied().unwrap_or(Vec3::ZERO);
        let lowest = places.iter().map(|place| place.y).fold(f64::INFINITY, f64::min);
        let mut bones: Vec<Bone> = Vec::with_capacity(places.len());
        for ((name, parent), place) in tree.joints().iter().zip(&places) {
            let from = parent.and_then(|parent| places.get(parent));
            let mut bone = Bone::at(name, *parent, from.map_or(Vec3::ZERO, |from| *place - *from));
            if parent.is_none() {
                bone.freedoms =
                    Vec3::UNITS.map(|axis| Freedom::new(FreedomKind::Move(axis))).to_vec();
                if let Some(height) = bone.freedoms.get_mut(1) {
                    height.default[0] = pelvis.y - lowest;
                }
            }
            bone.freedoms.push(Freedom::new(FreedomKind::Ball));
            bones.push(bone);
        }
        let said = (!guessed.is_empty()).then(|| {
            let message = format!(
                "{} has no {}: they are put between their neighbours, or where limbs of adults have them",
                self.name,
                condyle_diagnostics::listed(&guessed)
            );
            Diagnostic::warning("smpl/joints", message)
        });
        let skeleton =
            Skeleton { up: UpAxis::Y, facing: Facing::PlusZ, bones, ..Skeleton::default() };
        Ok((skeleton, places, said))
    }

    /// The body as a model that stands on the ground, with all joints of the largest tree that it has.
    ///
    /// # Errors
    /// `smpl/rest` where joints of the limbs are not known.
    pub fn model(&self) -> Result<Read<Model>, Error> {
        let (skeleton, _, said) = self.skeleton(self.tree(), &[])?;
        let mut read = skeleton.build()?;
        read.warnings.extend(said);
        Ok(read)
    }
}

/// The next joint outwards whose place is known, with how many steps it is away.
fn next_known(
    joints: &[(String, Option<usize>)],
    known: &[Option<Vec3>],
    from: usize,
) -> Option<(usize, Vec3)> {
    let mut at = from;
    for steps in 1..joints.len() {
        // Of several children the first whose place is known, else the first.
        let children =
            || (0..joints.len()).filter(|i| joints.get(*i).is_some_and(|j| j.1 == Some(at)));
        if let Some(place) = children().find_map(|child| known.get(child).copied().flatten()) {
            return Some((steps, place));
        }
        at = children().next()?;
    }
    None
}

/// From its parent to a joint at the end of a limb, in metres, in a figure of ordinary size. Fingers: lengths
/// of bones by Buryanov and Kotiuk 2010, knuckles behind a carpus of 30 mm.
fn usual(name: &str) -> Vec3 {
    let side = if name.starts_with("right") { -1.0 } else { 1.0 };
    let rest = name.split_once('_').map_or(name, |(_, rest)| rest);
    // Bones from the wrist to the knuckle, then those of the finger; how far ahead the knuckle is.
    let (knuckle, ahead, bones) = match rest.trim_end_matches(|c: char| c.is_ascii_digit()) {
        "index" => (0.098, 0.025, [0.0398, 0.0224]),
        "middle" => (0.095, 0.003, [0.0446, 0.0263]),
        "ring" => (0.088, -0.017, [0.0414, 0.0257]),
        "pinky" => (0.084, -0.037, [0.0327, 0.0181]),
        "thumb" => (0.025, 0.025, [0.0462, 0.0316]),
        "hand" => (0.09, 0.0, [0.0; 2]),
        "foot" => return Vec3::new(0.0, -0.06, 0.13),
        "eye_smplhf" => return Vec3::new(side * 0.032, 0.06, 0.08),
        _ if name == "jaw" => return Vec3::new(0.0, 0.0, 0.02),
        _ if name == "head" => return Vec3::new(0.0, 0.09, 0.0),
        _ => return Vec3::new(0.0, 0.05, 0.0),
    };
    match rest.as_bytes().last() {
        Some(b'2') => Vec3::new(side * bones[0], 0.0, 0.0),
        Some(b'3') => Vec3::new(side * bones[1], 0.0, 0.0),
        _ => Vec3::new(side * knuckle, 0.0, ahead),
    }
}
