//! One scalar to several: yᵢ = fᵢ(x) (Shao & Ng-Thow-Hing 2003, section 4.2).

use super::Signal;
use condyle_math::function::Function;

/// One scalar that drives several: for example a flexion angle that moves the tibia by three
/// functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The argument.
    pub input: Signal,
    /// One function for each output.
    pub functions: Vec<Function>,
}
