//! Model documents: what they say, what is wrong with them, and that writing loses nothing.

#[path = "../../../condyle-model/tests/random_models/grow.rs"]
mod grow;
mod mirror;
mod reading;
mod round_trip;
mod wrong;

use condyle_formats::document::{self, Document};
use condyle_formats::{Diagnostic, Read};
use condyle_model::{Mode, Model, Pose, Program};

/// Reads a text that includes nothing.
fn try_read(text: &str) -> Result<Read<Document>, Vec<Diagnostic>> {
    document::read(text, &mut |_| Err("nothing is included here".to_owned()))
}

fn read(text: &str) -> Model {
    match try_read(text) {
        Ok(read) => read.value.model,
        Err(errors) => panic!("{}\n{text}", document::render("text", text, &errors)),
    }
}

/// The transforms of all segments, row by row.
fn pose(model: &Model, stored: &[f64]) -> Vec<[f64; 16]> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    model.segment_ids().map(|id| pose.segment(id).to_rows()).collect()
}
