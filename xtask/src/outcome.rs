//! What a check is given and what it answers.

use std::path::PathBuf;

/// What every check is given.
pub(crate) struct Context {
    /// The root of the workspace.
    pub(crate) root: PathBuf,
    /// Whether committed answers are to be written anew instead of compared.
    pub(crate) bless: bool,
    /// Set where a check is itself under test: the folder to build in. What other programs say is
    /// then kept for the answer instead of shown, as a planted failure among the messages of a
    /// test run would mislead.
    pub(crate) trial: Option<PathBuf>,
}

/// How a check ended.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// All is as it should be.
    Passed,
    /// What is not.
    Failed(String),
    /// Why nothing could be said.
    Skipped(String),
}

impl From<Result<(), String>> for Outcome {
    fn from(result: Result<(), String>) -> Self {
        result.map_or_else(Self::Failed, |()| Self::Passed)
    }
}

impl From<Vec<String>> for Outcome {
    /// A list of findings: none is a pass.
    fn from(findings: Vec<String>) -> Self {
        match findings[..] {
            [] => Self::Passed,
            _ => Self::Failed(format!("\n   {}", findings.join("\n   "))),
        }
    }
}
