//! `condyle demo`.

use super::Outcome;
use crate::failure::Failure;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Demo {}

impl Demo {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        Ok(Outcome::Done)
    }
}
