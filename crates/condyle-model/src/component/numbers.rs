//! Smooth functions from a few numbers to a few, evaluated over any scalar.

use condyle_math::{Dual, Lane, Scalar};
use std::any::TypeId;

/// The most inputs and outputs of such a function.
pub(crate) const MOST_NUMBERS: usize = 4;

/// A dual number with a derivative for every input.
pub(crate) type NumberDual = Dual<MOST_NUMBERS>;

/// A smooth function from at most [`MOST_NUMBERS`] numbers to as many: the inputs are those of its ports,
/// an orientation as x, y, z, w.
pub(crate) trait Numbers {
    /// The outputs; inputs and outputs that it does not have are 0 and are not read.
    fn values<S: Scalar>(&self, inputs: [S; MOST_NUMBERS]) -> [S; MOST_NUMBERS];
}

/// [`Numbers`] without the choice of a scalar.
pub(crate) trait ErasedNumbers {
    fn at(&self, inputs: [f64; MOST_NUMBERS]) -> [f64; MOST_NUMBERS];
    fn dual_at(&self, inputs: [NumberDual; MOST_NUMBERS]) -> [NumberDual; MOST_NUMBERS];
}

impl<N: Numbers> ErasedNumbers for N {
    fn at(&self, inputs: [f64; MOST_NUMBERS]) -> [f64; MOST_NUMBERS] {
        self.values(inputs)
    }

    fn dual_at(&self, inputs: [NumberDual; MOST_NUMBERS]) -> [NumberDual; MOST_NUMBERS] {
        self.values(inputs)
    }
}

impl dyn ErasedNumbers + '_ {
    /// The outputs over any scalar, lane by lane.
    pub(crate) fn values<S: Scalar>(&self, inputs: [S; MOST_NUMBERS]) -> [S; MOST_NUMBERS] {
        S::lane_by_lane(inputs, |inputs| self.in_lane(inputs))
    }

    fn in_lane<L: Lane>(&self, inputs: [L; MOST_NUMBERS]) -> [L; MOST_NUMBERS] {
        // Without derivatives the plain evaluation is enough.
        if TypeId::of::<L>() == TypeId::of::<f64>() {
            return self.at(inputs.map(Lane::value)).map(L::from_f64);
        }
        // The function is known on `NumberDual` only: its partial derivatives are applied to the inputs by
        // the chain rule. Exact for dual numbers, which are of first order.
        let duals = std::array::from_fn(|i| NumberDual::variable(inputs[i].value(), i));
        self.dual_at(duals).map(|output| {
            let slopes = inputs.iter().zip(output.partials);
            slopes.fold(L::from_f64(output.value), |sum, (x, p)| sum + x.chain(|_| (0.0, p)))
        })
    }
}
