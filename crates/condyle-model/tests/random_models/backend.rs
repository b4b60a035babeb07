//! What evaluates models, and the program over each kind of number.

#[path = "../../../condyle-math/tests/lanes/eight.rs"]
mod eight;

use condyle_math::{Affine, Dual, Scalar};
use condyle_model::{Mode, Model, Pose, Program};
use eight::Eight;
use std::marker::PhantomData;

/// The pose of a model at one list of stored numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Posed {
    /// The transforms of all segments in the world.
    pub(crate) segments: Vec<Affine>,
    /// The effective stored numbers of all coordinates.
    pub(crate) effective: Vec<f64>,
    /// The limit rows.
    pub(crate) rows: Vec<f64>,
    /// Angles and gaps of all contacts.
    pub(crate) contacts: Vec<f64>,
}

/// What evaluates models.
pub(crate) trait Backend {
    /// The poses of a model, one for each list of stored numbers.
    fn poses(&self, model: &Model, mode: Mode, requested: &[Vec<f64>]) -> Vec<Posed>;
}

/// The program over one kind of number.
pub(crate) struct ProgramOver<S>(PhantomData<S>);

/// Plain numbers.
pub(crate) const PLAIN: ProgramOver<f64> = ProgramOver(PhantomData);
/// Numbers with derivatives.
pub(crate) const DUAL: ProgramOver<Dual<1>> = ProgramOver(PhantomData);
/// Eight postures at once.
pub(crate) const EIGHT: ProgramOver<Eight> = ProgramOver(PhantomData);

/// A number that holds those of one posture or of several.
trait Numbers: Scalar {
    const POSTURES: usize;
    fn of(postures: impl Fn(usize) -> f64) -> Self;
    fn at(self, posture: usize) -> f64;
}

impl Numbers for f64 {
    const POSTURES: usize = 1;
    fn of(postures: impl Fn(usize) -> f64) -> Self {
        postures(0)
    }
    fn at(self, _: usize) -> f64 {
        self
    }
}

impl Numbers for Dual<1> {
    const POSTURES: usize = 1;
    fn of(postures: impl Fn(usize) -> f64) -> Self {
        Self { value: postures(0), partials: [0.7] }
    }
    fn at(self, _: usize) -> f64 {
        self.value
    }
}

impl Numbers for Eight {
    const POSTURES: usize = 8;
    fn of(postures: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(postures))
    }
    fn at(self, posture: usize) -> f64 {
        self.0[posture]
    }
}

impl<S: Numbers> Backend for ProgramOver<S> {
    fn poses(&self, model: &Model, mode: Mode, requested: &[Vec<f64>]) -> Vec<Posed> {
        let program = Program::compile(model);
        let mut pose = Pose::<S>::new(&program);
        let mut all = Vec::with_capacity(requested.len());
        for together in requested.chunks(S::POSTURES) {
            // Of a list that does not fill the lanes the last posture fills them.
            let at = |posture: usize| &together[posture.min(together.len() - 1)];
            let numbers = (0..program.stored_len()).map(|i| S::of(|posture| at(posture)[i]));
            let numbers: Vec<S> = numbers.collect();
            program.evaluate(&numbers, mode, &mut pose).expect("buffers of this program");
            for posture in 0..together.len() {
                let number = |x: S| x.at(posture);
                let rows = (0..program.limit_row_len()).map(|row| number(pose.limit_row(row)));
                let contacts = (0..program.contacts().len()).filter_map(|i| pose.contact(i));
                all.push(Posed {
                    segments: pose
                        .segments()
                        .iter()
                        .map(|t| Affine::from_columns(t.to_columns().map(number)))
                        .collect(),
                    effective: pose.effective().iter().copied().map(number).collect(),
                    rows: rows.collect(),
                    contacts: contacts
                        .flat_map(|report| [report.angles, report.gaps].concat())
                        .map(number)
                        .collect(),
                });
            }
        }
        all
    }
}
