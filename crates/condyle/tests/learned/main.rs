//! Laws learned from markers that are generated: machines whose coefficients are known, and a knee.

mod arms;
mod functional;
mod knee;
mod machines;
mod opensim;
mod study;
