//! OpenSim's XML files.

pub mod model;
pub mod setup;
