//! What a check is given and what it answers.

use std::path::PathBuf;

/// What every check is given.
pub(crate) struct Context {
    /// The root of the workspace.
    pub(crate) root: PathBuf,
    /// Whether committed answers are to be written anew instead of compared.
    pub(crate) bless: bool,
}

/// How a check ended.
pub(crate) enum Outcome {
    Passed,
    Failed(String),
    Skipped(String),
}

impl From<Result<(), String>> for Outcome {
    fn from(result: Result<(), String>) -> Self {
        result.map_or_else(Self::Failed, |()| Self::Passed)
    }
}
