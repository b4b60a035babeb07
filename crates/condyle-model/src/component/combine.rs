//! Several scalars to one: y = f(x₁, …, xₙ).

use super::Signal;
use condyle_math::function::FunctionOfSeveral;

/// One scalar as a function of several: for example the flexion of a vertebra from the three angles
/// of the trunk.
#[derive(Clone, Debug, PartialEq)]
pub struct Combine {
    /// The arguments, as many as the function takes.
    pub inputs: Vec<Signal>,
    /// The function.
    pub function: FunctionOfSeveral,
}
