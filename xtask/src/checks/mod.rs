//! The checks, one file each, in the order in which CI runs them: quick ones first.

mod architecture;
mod browser;
mod clippy;
mod deny;
mod doc;
mod evaluator;
mod exchange;
mod fmt;
mod fuzz;
mod instructions;
mod outside;
mod page;
mod test;

use crate::outcome::{Context, Outcome};

/// A check by name.
pub(crate) struct Check {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    /// What it ensures.
    pub(crate) what: &'static str,
    /// Runs it.
    pub(crate) run: fn(&Context) -> Outcome,
}

/// All checks.
pub(crate) const CHECKS: &[Check] = &[
    Check { name: "fmt", what: "the code is formatted", run: fmt::run },
    Check {
        name: "architecture",
        what: "the map is true, the floors hold",
        run: architecture::run,
    },
    Check {
        name: "deny",
        what: "licences, sources, doubles and known faults of dependencies",
        run: deny::run,
    },
    Check { name: "clippy", what: "no warning in any target", run: clippy::run },
    Check { name: "doc", what: "the documentation builds without a warning", run: doc::run },
    Check { name: "test", what: "the README's test command", run: test::run },
    Check {
        name: "exchange",
        what: "an independent evaluator agrees on every pose",
        run: exchange::run,
    },
    Check {
        name: "outside",
        what: "what a user builds: features, a program, the browser",
        run: outside::run,
    },
    Check { name: "page", what: "the built page is of its sources, and light", run: page::run },
    Check {
        name: "evaluator",
        what: "the page's WebAssembly poses as the library does",
        run: evaluator::run,
    },
    Check { name: "browser", what: "the page in a real browser", run: browser::run },
    Check { name: "fuzz", what: "the fuzz targets build and take their seeds", run: fuzz::run },
    Check {
        name: "instructions",
        what: "kernels take no more than before",
        run: instructions::run,
    },
];
