//! What comes out.

/// The pose found, and what each goal lacks.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The stored numbers of all coordinates, coupled ones as their leaders determine them.
    pub coordinates: Vec<f64>,
    /// What each goal lacks, in their order.
    pub misses: Vec<Miss>,
    /// R in m²: how far the pose is from rest, by the measure of [`super::Rest`].
    pub rest: f64,
    /// Largest loop error in metres or radians.
    pub closure_error: f64,
    /// What each coordinate follows from, in the model's order.
    pub by: Vec<By>,
    /// How many starts were descended from.
    pub starts: u32,
    /// Iterations of the solver, all descents together.
    pub iterations: u32,
}

/// What a goal lacks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The length of the residual, metres or radians; 0 on the right side of a plane.
    pub off: f64,
    /// Whether it is an angle.
    pub angle: bool,
    /// Whether it has a weight, so that it need not be met.
    pub weighted: bool,
}

impl Miss {
    /// Whether the goal is met to [`super::MET`].
    pub fn is_met(&self) -> bool {
        self.off <= super::MET
    }
}

/// What the value of a coordinate follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// From goals, loops and limits alone.
    Goals,
    /// From goals together with others, among which rest chooses.
    Shared,
    /// From rest: goals say nothing about it, or less than a hundredth.
    Rest,
    /// It is at a bound, or at a limit, against which goals push it.
    Limit,
    /// It is held or locked.
    Held,
    /// It follows other coordinates.
    Follows,
}

impl By {
    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Goals => "goals",
            Self::Shared => "shared",
            Self::Rest => "rest",
            Self::Limit => "limit",
            Self::Held => "held",
            Self::Follows => "follows",
        }
    }
}

impl Answer {
    /// Whether all goals without a weight are met and loops are closed, to [`super::MET`].
    pub fn is_met(&self) -> bool {
        self.closure_error <= super::MET && self.misses.iter().all(|m| m.weighted || m.is_met())
    }

    /// Σ r² over the goals without a weight: what is least where they cannot be met.
    pub(super) fn missed(&self) -> f64 {
        self.misses.iter().filter(|m| !m.weighted).map(|m| m.off * m.off).sum()
    }
}
