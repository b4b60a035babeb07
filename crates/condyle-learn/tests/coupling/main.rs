//! Laws from generated coordinates whose truth is known: how often intervals hold it, what is accepted, and numbers of other
//! programs.

mod noise;
mod numbers;
mod trials;
