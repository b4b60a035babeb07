//! Code shared by the benches: models and recordings with invented numbers, a clock, and tables.
//!
//! Every bench prints its figures beside a bound that is measured in the same run, so that a busy
//! machine affects both. Regressions are detected not by time but by a count of instructions: see
//! `cargo xtask instructions` and [`kernels`].

pub mod arguments;
pub mod bare_products;
pub mod chain;
pub mod clock;
pub mod full_body;
pub mod joints;
pub mod kernels;
pub mod limits;
pub mod random;
pub mod shoulder;
pub mod table;
pub mod walk;
