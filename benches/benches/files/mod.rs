//! Models and recordings from files, for the benches that accept them.
#![allow(dead_code, reason = "each bench takes what it needs")]

use condyle::formats::Recording;
use condyle::formats::opensim::setup::IkSetup;
use condyle_model::Model;
use std::path::Path;

/// The model in a file; ends the program with a message if it cannot be read.
pub(crate) fn model(path: &Path) -> Model {
    condyle::open::model(path).map_or_else(|error| quit(&error.to_string()), |read| read.value)
}

/// The recording in a file; ends the program with a message if it cannot be read.
pub(crate) fn recording(path: &Path) -> Recording {
    condyle::open::recording(path).map_or_else(|error| quit(&error.to_string()), |read| read.value)
}

/// The setup in a file; ends the program with a message if it cannot be read.
pub(crate) fn setup(path: &Path) -> IkSetup {
    condyle::open::setup(path).map_or_else(|error| quit(&error.to_string()), |read| read.value)
}

/// Ends the program with a message.
pub(crate) fn quit(message: &str) -> ! {
    eprintln!("error: {message}");
    std::process::exit(2)
}
