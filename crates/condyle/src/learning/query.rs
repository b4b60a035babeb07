//! What a limit of any method says of rotations.

use condyle_learn::limits::dependent::{Dependence, Driver};
use condyle_learn::limits::herda2003::{LearnedSpheres, judge};
use condyle_learn::limits::{LearnedLimit, State};
use condyle_math::Quat;

/// A limit as files hold it.
#[derive(Clone, Debug)]
pub enum Limit {
    /// A signed distance to the closing of a cloud.
    Field(Box<LearnedLimit>),
    /// Spheres in the vector part of quaternions.
    Spheres(Box<LearnedSpheres>),
}

/// What a limit says of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answered {
    /// Whether it is possible; spheres know no holes.
    pub state: State,
    /// The signed distance to the boundary in radians, positive inside; `None` where the method finds none.
    pub distance: Option<f64>,
    /// The nearest valid rotation, itself if it is valid; `None` where the method finds none.
    pub nearest: Option<Quat>,
    /// The angle to the nearest sample, in radians.
    pub evidence: f64,
    /// How many samples are within two spacings of that one, where the method counts them.
    pub count: Option<u32>,
}

impl Limit {
    /// What it depends on.
    #[must_use]
    pub fn dependence(&self) -> Option<&Dependence> {
        match self {
            Self::Field(limit) => limit.dependence(),
            Self::Spheres(_) => None,
        }
    }

    /// What it says of a rotation, which is brought to length 1; `None` for what is none: not finite, or of length 0.
    ///
    /// q and -q have the same answer.
    #[must_use]
    pub fn answer(&self, q: Quat) -> Option<Answered> {
        self.answer_given(q, None)
    }

    /// The same at a value of what the limit depends on, if it depends on anything.
    #[must_use]
    pub fn answer_given(&self, q: Quat, driver: Option<Driver>) -> Option<Answered> {
        let length = q.dot(q).sqrt();
        if !(length.is_finite() && length > 1e-9) {
            return None;
        }
        let q = q.normalized();
        match self {
            Self::Field(limit) if driver.is_some() && limit.dependence().is_some() => {
                let answer = limit.given()?.answer(q, driver?);
                Some(Answered {
                    state: answer.state,
                    distance: Some(answer.distance),
                    nearest: Some(answer.nearest),
                    evidence: answer.evidence,
                    count: None,
                })
            }
            Self::Field(limit) => {
                let answer = limit.field().answer(q);
                Some(Answered {
                    state: answer.state,
                    distance: Some(answer.distance),
                    nearest: Some(answer.nearest),
                    evidence: answer.evidence.angle,
                    count: Some(answer.evidence.count),
                })
            }
            Self::Spheres(spheres) => {
                let judged = judge(&spheres.limit, q);
                let reference = spheres.limit.chart.reference();
                let near = |q: Quat| if q.dot(reference) < 0.0 { -q } else { q };
                Some(Answered {
                    state: if judged.valid { State::Valid } else { State::Invalid },
                    distance: judged.distance,
                    nearest: judged.nearest.map(near),
                    evidence: spheres.nearest_sample(q),
                    count: None,
                })
            }
        }
    }
}
