//! The baseline of Herda et al. 2003: against a slow restatement in NumPy, on objects whose shape is known,
//! and where it is known to fail.

mod failures;
mod objects;
mod restatement;
#[allow(dead_code, reason = "the example uses the rest")]
mod shapes;
