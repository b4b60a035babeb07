//! A motion of one figure for another: what the limbs of the first point at, those of the second do.
//!
//! Both figures are given as a [`Model`] and a [`Body`], which says which segment is which part of a human.
//! Nothing else is told: no offsets, no pairs of axes. The steps:
//!
//! 1. **Rest** ([`stance`](self)). In a posture in which each figure stands (its defaults; where these are no
//!    posture of a standing figure, the frame of the motion that is most like one) every part gets an
//!    *anatomical frame* from the places of joints: of pelvis, spine, head and collar bones the axes of the body
//!    (forward, up, right); of a limb the line from joint to joint, and across it the direction that would
//!    point up (arms) or forward (legs) if the limb were brought to the side (or down) along the shortest arc.
//!    So T, A and hanging arms have the same frames. The hand has its own from the knuckles where they are known,
//!    the foot from where it points on the ground. With S the frame in the source's segment and T that in the
//!    target's,
//!
//!    ```text
//!    R_target(t) = W · R_source(t) · S · T⁻¹,       W from the source's up and facing to the target's
//!    ```
//!
//!    Feet and hands that a recording has turned over, by half a turn about their length, are turned back first
//!    (`overturned`), with a warning.
//! 2. **Question.** For each frame the target should meet, weighted, lines from joint to joint
//!    ([`DirectionTarget`](crate::DirectionTarget): upper arm, forearm, thigh, shank, foot, and the trunk from
//!    between the hips to the neck), orientations (strong for pelvis, chest, head and feet; weak for
//!    limbs, where they only tell the twist: a bent elbow or knee tells it better), and a place between the
//!    hips
//!
//!    ```text
//!    p(t) = s · W (p_source(t) - up · a_source) + up · a_target,      s = leg_target / leg_source
//!    ```
//!
//!    with a the height of an ankle above the ground where the figure stands.
//! 3. **Frames**, each solved from the one before by [`Tracker`](crate::Tracker), the first by way from rest.
//!    The model's couplings, loops and posture terms hold, and its limits if [`Options::limits`] asks for them.
//! 4. **Feet** ([`standing`]). Where ankle or toes stand in the source, those of the target should move no
//!    more than the source's scaled (or not at all, [`Options::pin_feet`]); what they would have to be moved
//!    for that fades in and out, and all frames are solved again with these places beside the rest.
//!
//! What came out is measured in a [`Report`].

mod body;
mod contact;
mod feet;
mod held;
mod measure;
mod overturned;
mod question;
mod sampled;
mod stance;

pub use body::{Anchor, Body, Finger, Part, Side};
pub use contact::standing;
pub use measure::{Fit, Report, Sliding};

use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::{Mode, Model, Pose, Program};
use condyle_motion::Motion;
use sampled::Sampled;
use stance::Stance;

/// How a motion is carried over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Options {
    /// Hold the target to its limits.
    pub limits: bool,
    /// Feet that stand do not move.
    pub pin_feet: bool,
}

/// A model and which of its segments are which parts.
#[derive(Clone, Copy, Debug)]
pub struct Humanoid<'m> {
    /// The model.
    pub model: &'m Model,
    /// Its parts.
    pub body: &'m Body,
}

/// A motion that was carried over.
#[derive(Clone, Debug)]
pub struct Retargeted {
    /// The target's motion, at the source's times.
    pub motion: Motion,
    /// How near it comes.
    pub report: Report,
    /// What was assumed.
    pub warnings: Vec<Diagnostic>,
}

/// The motion of `source` for `target`. `progress` is called with each frame that is done; every frame is
/// solved twice where feet stand.
///
/// # Errors
/// `retarget/parts` where the figures do not have in common what says how they stand: a pelvis or chest, and
/// two thighs or two upper arms. `retarget/frames` for a motion without frames.
pub fn retarget(
    source: Humanoid<'_>,
    motion: &Motion,
    target: Humanoid<'_>,
    options: Options,
    progress: &mut dyn FnMut(),
) -> Result<Retargeted, Error> {
    if motion.frames.is_empty() {
        return Err(Error::new("retarget/frames", "the motion has no frames"));
    }
    let mut warnings = vec![];
    let from = Stance::of_motion(source, motion, &mut warnings)?;
    let to = Stance::of_defaults(target, &mut warnings)?;
    let necks = [source, target].iter().all(|figure| figure.body.get(Part::Neck).is_some());
    let mut sampled = Sampled::new(source, motion, &from, &to, necks)?;
    overturned::turn_back(&mut sampled, &mut warnings);
    sampled.settle_soles(&from, &to);
    let plan = question::Plan::new(source, target, &from, &to, &sampled);
    let free = plan.solve(target, options, None, None, &motion.times, progress);
    let feet = feet::feet(target, &sampled, &free, options);
    let motion = match feet {
        Some(feet) => {
            plan.solve(target, options, Some(&feet), Some(&free), &sampled.times, progress)
        }
        None => free,
    };
    let report = measure::report(target, &plan, &sampled, &motion, options);
    Ok(Retargeted { motion, report, warnings })
}

/// A model posed for what is measured on it.
struct Posed {
    program: Program,
    pose: Pose,
}

impl Posed {
    fn new(model: &Model) -> Self {
        let program = Program::compile(model);
        let pose = Pose::new(&program);
        Self { program, pose }
    }

    /// Poses it as it is told, without limits.
    fn at(&mut self, stored: &[f64]) -> Result<&Pose, Error> {
        match self.program.evaluate(stored, Mode::Open, &mut self.pose) {
            Ok(()) => Ok(&self.pose),
            Err(error) => Err(Error::new("retarget/frames", error.to_string())),
        }
    }
}
