//! What arms take from recordings, and how it becomes another person's.

use crate::calibration::{Cluster, FreeJoint};
use crate::coupling::{LawFunction, Laws, Samples, Settings, SizeRatios, learn, scaled};
use condyle_diagnostics::Error;
use condyle_model::component::Region;
use condyle_motion::Recording;

/// Where the centre of a joint is, as learned from frames: by the law and on the mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Centre {
    /// The place along x, y and z of the parent as a function of the angles, in metres.
    pub laws: [LawFunction; 3],
    /// The mean place over the frames.
    pub mean: [f64; 3],
    /// The constant place that leaves the least at the markers of these frames, where that was asked.
    pub best: Option<[f64; 3]>,
    /// Where the angles were.
    pub region: Region,
    /// How many frames it was learned from.
    pub frames: usize,
}

/// Lengths of a person's thigh by which laws are scaled, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// From the parent's origin (the great trochanter) to the lateral end of the joint's axis.
    pub length: f64,
    /// From the medial to the lateral end.
    pub width: f64,
}

impl Centre {
    /// Learned from samples with the three angles in the columns 0 to 2 and the three places in the columns 3 to 5.
    ///
    /// # Errors
    /// Those of [`learn`]; `arms/columns` where there are fewer than six columns.
    pub fn of(samples: &Samples, settings: &Settings) -> Result<Self, Error> {
        if samples.columns.len() < 6 {
            let message = format!("{} columns are no six coordinates", samples.columns.len());
            return Err(Error::new("arms/columns", message));
        }
        let laws = learn(samples, &[], &[0, 1, 2], &[3, 4, 5], settings)?;
        let frames = samples.frames();
        let mean = [3, 4, 5].map(|c| samples.column(c).iter().sum::<f64>() / frames.max(1) as f64);
        Self::from_laws(&laws, mean)
    }

    /// From laws of the three places in their order.
    ///
    /// # Errors
    /// `arms/columns` where there are not three laws.
    pub fn from_laws(laws: &Laws, mean: [f64; 3]) -> Result<Self, Error> {
        let functions: Vec<LawFunction> =
            laws.laws.iter().map(|law| law.function.clone()).collect();
        let functions = <[LawFunction; 3]>::try_from(functions).map_err(|given| {
            Error::new("arms/columns", format!("{} laws are no three places", given.len()))
        })?;
        Ok(Self {
            laws: functions,
            mean,
            best: None,
            region: laws.region.clone(),
            frames: laws.frames(),
        })
    }

    /// The places where all angles are 0: c₄ of the paper.
    #[must_use]
    pub fn at_zero(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.laws[axis].value(&[0.0; 3]))
    }

    /// The centre of a person whose places are so many times as far along x, y and z. The angles at which it was learned stay.
    #[must_use]
    pub fn scaled(&self, factors: [f64; 3]) -> Self {
        let axis = |k: usize| scaled(&self.laws[k], factors[k]);
        Self {
            laws: [axis(0), axis(1), axis(2)],
            mean: [0, 1, 2].map(|k| self.mean[k] * factors[k]),
            best: self.best.map(|best| [0, 1, 2].map(|k| best[k] * factors[k])),
            ..self.clone()
        }
    }
}

impl Sizes {
    /// How much larger another person is.
    ///
    /// ```
    /// use condyle_learn::arms::Sizes;
    /// use condyle_learn::coupling::ScaleRule;
    /// let [one, other] = [Sizes { length: 0.4, width: 0.1 }, Sizes { length: 0.44, width: 0.09 }];
    /// let factors = one.ratios_to(other).factors(ScaleRule::PerAxis);
    /// assert!((factors[0] - 1.0).abs() < 1e-12 && (factors[1] - 1.1).abs() < 1e-12);
    /// assert!((factors[2] - 0.9).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn ratios_to(self, other: Self) -> SizeRatios {
        SizeRatios { along: other.length / self.length, across: other.width / self.width }
    }

    /// The sizes of a person from a standing trial; `None` where it does not show the marker at the parent's origin and both ends.
    #[must_use]
    pub fn of(joint: &FreeJoint, standing: &Recording) -> Option<Self> {
        let place = |label: &str| Cluster::standing(standing, &[label]).point(label);
        let [medial, lateral] = [place(&joint.ends[0])?, place(&joint.ends[1])?];
        let top = place(&joint.origin)?;
        Some(Self { length: (top - lateral).norm(), width: (medial - lateral).norm() })
    }
}
