//! `condyle info`.

use super::Outcome;
use crate::failure::Failure;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Info {}

impl Info {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        Ok(Outcome::Done)
    }
}
