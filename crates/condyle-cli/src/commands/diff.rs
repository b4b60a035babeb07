//! `condyle diff`.

use super::Outcome;
use crate::failure::Failure;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Diff {}

impl Diff {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        Ok(Outcome::Done)
    }
}
