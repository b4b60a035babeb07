//! Several scalars to one: y = f(x₁, …, xₙ).

use super::Source;
use condyle_math::function::FunctionOfSeveral;

/// One number that follows several: a vertebra's flexion from the three angles of the trunk.
#[derive(Clone, Debug, PartialEq)]
pub struct Combine {
    /// The arguments, as many as the function takes.
    pub inputs: Vec<Source>,
    /// The function.
    pub function: FunctionOfSeveral,
}
