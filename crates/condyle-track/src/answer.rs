//! What comes out of a frame.

/// How a frame ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameStatus {
    /// The minimum was found.
    Solved,
    /// The solver stopped before it was sure; the posture is the best it met.
    Uncertain,
    /// A loop, or the range of a coupled coordinate, could not be met.
    Infeasible,
    /// No marker with a positive weight was seen; the posture is that of the start, unless other targets
    /// say where to go.
    NoMarkers,
}

impl FrameStatus {
    /// Whether the answer can be used as it is.
    pub fn is_solved(self) -> bool {
        self == Self::Solved
    }

    /// The word for it in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Uncertain => "uncertain",
            Self::Infeasible => "infeasible",
            Self::NoMarkers => "no markers",
        }
    }
}

/// The posture of one frame, and how near it comes to the markers.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameAnswer {
    /// The stored numbers of all coordinates, coupled ones as their leaders determine them.
    pub coordinates: Vec<f64>,
    /// F in m², without the prior.
    pub objective: f64,
    /// P in m²: what posture targets add to what is minimised.
    pub posture: f64,
    /// Σ w |e|² in m².
    pub weighted_squares: f64,
    /// Distance of each marker target in metres; NaN where the marker is not seen or has no weight.
    pub marker_errors: Vec<f64>,
    /// Largest loop error in metres or radians.
    pub closure_error: f64,
    /// How it ended.
    pub status: FrameStatus,
    /// Iterations of the solver, all starts together.
    pub iterations: u32,
}

impl FrameAnswer {
    /// A posture that nothing is known about yet: where a solve begins.
    pub fn start(coordinates: &[f64]) -> Self {
        Self {
            coordinates: coordinates.to_vec(),
            objective: 0.0,
            posture: 0.0,
            weighted_squares: 0.0,
            marker_errors: vec![],
            closure_error: 0.0,
            status: FrameStatus::NoMarkers,
            iterations: 0,
        }
    }

    /// F + P: what answers are compared by.
    pub fn minimised(&self) -> f64 {
        self.objective + self.posture
    }

    /// Root mean square of the marker errors in metres, unweighted; 0 without markers.
    pub fn rms(&self) -> f64 {
        let seen = self.marker_errors.iter().filter(|e| e.is_finite());
        let (sum, n) = seen.fold((0.0, 0), |(sum, n), e| (sum + e * e, n + 1));
        if n == 0 { 0.0 } else { (sum / f64::from(n)).sqrt() }
    }

    /// Largest marker error in metres.
    pub fn max(&self) -> f64 {
        self.marker_errors.iter().copied().filter(|e| e.is_finite()).fold(0.0, f64::max)
    }
}

/// Whether an answer beats another: met constraints first, then a clearly lower F + P.
pub(crate) fn better(a: &FrameAnswer, b: &FrameAnswer) -> bool {
    let broken = |answer: &FrameAnswer| answer.status == FrameStatus::Infeasible;
    match (broken(a), broken(b)) {
        (false, true) => true,
        (true, false) => false,
        _ => a.minimised() < b.minimised() * (1.0 - 1e-6) - 1e-15,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_compared_by_all_that_is_minimised() {
        let of = |objective, posture| FrameAnswer { objective, posture, ..FrameAnswer::start(&[]) };
        assert!(better(&of(2e-6, 1e-6), &of(1e-6, 3e-6)));
        assert!(!better(&of(1e-6, 3e-6), &of(2e-6, 1e-6)));
        let broken = FrameAnswer { status: FrameStatus::Infeasible, ..of(0.0, 0.0) };
        assert!(better(&of(1e-6, 0.0), &broken));
    }
}
