//! The nearest legal motion: limits are kept in every frame, and what is changed does not change suddenly.
//!
//! Of each frame mₜ the nearest legal pose is p(mₜ). Near one and the same part of a limit it follows the motion
//! continuously, and the answer is xₜ = p(mₜ): a frame that is legal is returned to the bit, one that is not stands on
//! the limit. Where the nearest part of a limit is another one from one frame to the next, as behind a concave corner or
//! opposite to the middle of a cone, p jumps though the motion does not. A jump is where, of a segment in its parent,
//!
//! ```text
//! angle(cₜ₋₁, cₜ)  >  2 max(angle(mₜ₋₁, mₜ)) + v dt         c = m⁻¹ x, the change of the segment's rotation
//! |dₜ - dₜ₋₁|      >  2 max|mₜ - mₜ₋₁| + u dt               d = x - m, that of its place
//! ```
//!
//! with the maxima over the segments that are changed there; a projection to a convex set never exceeds the first terms.
//! Around a jump two branches are followed, each the nearest pose on its own side: one forward from before it, Aₜ, and
//! one backward from behind it, Bₜ. The answer goes from A to B,
//!
//! ```text
//! yₜ = A + s(w) (B - A),  s(w) = w²(3 - 2w),  w from 0 to 1 over n + 1 frames, 1.5 |B - A| / (n + 1) <= v dt
//! xₜ = the legal pose toward yₜ from xₜ₋₁, in steps so small that the nearest legal pose of each is near it
//! ```
//!
//! so that legal frames are touched for at most n/2 frames beside a jump. [`Constrained`] states how many jumps there
//! were and how far the change goes from frame to frame, with and without this.
//!
//! Unlike a sum of squared second differences over the whole motion, this leaves every frame alone that is not beside a
//! jump, and the nearest pose is the nearest one everywhere else.
//!
//! ```
//! use condyle_math::Vec3;
//! use condyle_model::ModelBuilder;
//! use condyle_model::limit::Range;
//! use condyle_motion::Motion;
//! use condyle_track::constrain::{Pace, constrain};
//! // An elbow that bends by at most a radian.
//! let mut b = ModelBuilder::new("arm");
//! let forearm = b.segment("forearm", None);
//! let (_, flexion) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
//! b.coordinate_mut(flexion).range = Range::new(0.0, 1.0);
//! let model = b.build()?;
//! let frames = [0.25, 0.75, 1.25, 0.75].map(|angle| vec![angle]).to_vec();
//! let motion = Motion { times: vec![0.0, 0.01, 0.02, 0.03], frames };
//! let answer = constrain(&model, &motion, Pace::default(), &mut |_| {});
//! assert_eq!(answer.motion.frames, [0.25, 0.75, 1.0, 0.75].map(|angle| vec![angle]));
//! assert_eq!(answer.changed(), 1);
//! # Ok::<(), condyle_diagnostics::Error>(())
//! ```

mod change;
mod figure;
mod seam;

pub use change::{Change, changes};

use condyle_model::Model;
use condyle_motion::Motion;
use figure::Figure;

/// How fast the change of a motion may itself change, beside what the motion does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// v, in radians per second.
    pub turn: f64,
    /// u, in metres per second.
    pub slide: f64,
}

impl Default for Pace {
    /// One turn and one metre per second: 3° and 8 mm per frame at 120 frames per second.
    fn default() -> Self {
        Self { turn: std::f64::consts::TAU, slide: 1.0 }
    }
}

/// A step of the change from one frame to the next: the largest over all segments in their parents.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Step {
    /// Radians.
    pub turn: f64,
    /// Metres.
    pub slide: f64,
}

impl Step {
    fn most(self, other: Self) -> Self {
        Self { turn: self.turn.max(other.turn), slide: self.slide.max(other.slide) }
    }
}

/// What became of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It was legal, and is equal to the bit.
    Kept,
    /// It was not legal: it is the nearest legal pose, or beside a jump a legal one that leads on.
    Moved,
    /// It was legal, and is beside a jump.
    Blended,
    /// No legal pose was found for it.
    Left,
}

/// A motion within limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Constrained {
    /// The motion.
    pub motion: Motion,
    /// For each frame what became of it.
    pub fates: Vec<Fate>,
    /// First and last frame of each part in which the answer goes over from one side of a limit to another.
    pub seams: Vec<[usize; 2]>,
    /// The largest step of the change if each frame were the nearest legal pose by itself.
    pub alone: Step,
    /// The largest step of the change as it is.
    pub step: Step,
    /// The largest step of the change beyond what was allowed there: 0 if every one is within the bound.
    pub beyond: Step,
}

impl Constrained {
    /// In how many frames the answer differs from the motion.
    #[must_use]
    pub fn changed(&self) -> usize {
        self.fates.iter().filter(|fate| matches!(fate, Fate::Moved | Fate::Blended)).count()
    }

    /// The frames for which no legal pose was found.
    pub fn left(&self) -> impl Iterator<Item = usize> {
        let left = self.fates.iter().enumerate().filter(|(_, fate)| **fate == Fate::Left);
        left.map(|(frame, _)| frame)
    }
}

/// The nearest legal motion: within ranges and all limits, loops closed. `progress` is told each frame that is done.
///
/// Frames that have not the model's number of values are [left](Fate::Left) as they are.
#[must_use]
pub fn constrain(
    model: &Model,
    motion: &Motion,
    pace: Pace,
    progress: &mut dyn FnMut(usize),
) -> Constrained {
    let mut figure = Figure::new(model);
    let count = motion.frames.len();
    let mut alone: Vec<Option<Vec<f64>>> = Vec::with_capacity(count);
    let mut fates = Vec::with_capacity(count);
    for (frame, asked) in motion.frames.iter().enumerate() {
        let (nearest, fate) = match figure.nearest(asked) {
            figure::Nearest::Legal => (None, Fate::Kept),
            figure::Nearest::Moved(nearest) => (Some(nearest), Fate::Moved),
            figure::Nearest::Left(nearest) => (nearest, Fate::Left),
        };
        alone.push(nearest);
        fates.push(fate);
        progress(frame);
    }
    let nearest = |frame: usize| alone[frame].as_deref().unwrap_or(&motion.frames[frame]);
    let jumps = seam::jumps(&mut figure, motion, &nearest, pace);
    let first = jumps.steps;
    let (changed, seams) = seam::mend(&mut figure, motion, &nearest, &jumps, pace);
    let mut answer = Motion {
        times: motion.times.clone(),
        frames: (0..count).map(|frame| nearest(frame).to_vec()).collect(),
    };
    let mended = !changed.is_empty();
    for (frame, stored) in changed {
        let same = stored == motion.frames[frame];
        fates[frame] = match fates[frame] {
            Fate::Left if !figure.is_legal(&stored) => Fate::Left,
            Fate::Kept if same => Fate::Kept,
            Fate::Kept => Fate::Blended,
            _ => Fate::Moved,
        };
        answer.frames[frame] = stored;
    }
    let steps = match mended {
        true => {
            seam::jumps(&mut figure, motion, &|frame| answer.frames[frame].as_slice(), pace).steps
        }
        false => first,
    };
    Constrained {
        motion: answer,
        fates,
        seams,
        alone: first.largest,
        step: steps.largest,
        beyond: steps.beyond,
    }
}
