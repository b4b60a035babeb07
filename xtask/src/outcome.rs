//! The input of a check and its result.

use std::path::PathBuf;

/// The input of every check.
pub(crate) struct Context {
    /// The root of the workspace.
    pub(crate) root: PathBuf,
    /// Whether committed answers are rewritten instead of compared.
    pub(crate) bless: bool,
    /// Set where a check is itself under test: the folder to build in. The output of other programs
    /// is then captured for the result instead of shown, as an intended failure would be misleading
    /// in the output of a test run.
    pub(crate) trial: Option<PathBuf>,
}

/// How a check ended.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// Nothing is wrong.
    Passed,
    /// What is wrong.
    Failed(String),
    /// Why the check could not be made.
    Skipped(String),
}

impl From<Result<(), String>> for Outcome {
    fn from(result: Result<(), String>) -> Self {
        result.map_or_else(Self::Failed, |()| Self::Passed)
    }
}

impl From<Vec<String>> for Outcome {
    /// From a list of findings: an empty list is a pass.
    fn from(findings: Vec<String>) -> Self {
        match findings[..] {
            [] => Self::Passed,
            _ => Self::Failed(format!("\n   {}", findings.join("\n   "))),
        }
    }
}
