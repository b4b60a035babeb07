//! Model documents: what they say, what is wrong with them, and that writing loses nothing.

#[allow(dead_code, reason = "the model crate's tests use more of it")]
#[path = "../../../condyle-model/tests/random_models/grow.rs"]
mod grow;
mod limits;
mod mirror;
mod numbers;
mod reading;
mod round_trip;
mod shapes;
mod skeletons;
mod templates;
mod wrong;

use condyle_formats::document::{self, Document};
use condyle_formats::{Error, Read};
use condyle_model::{Mode, Model, Pose, Program};

/// Reads a text that includes nothing and knows the law of random models.
fn try_read(text: &str) -> Result<Read<Document>, Error> {
    document::read_with(
        text,
        &mut |_| Err("nothing is included here".to_owned()),
        &grow::registry(),
    )
}

fn read(text: &str) -> Model {
    match try_read(text) {
        Ok(read) => read.value.model,
        Err(errors) => panic!("{}\n{text}", document::render("text", text, &errors)),
    }
}

/// What is said of a text that is wrong.
fn errors(body: &str) -> Vec<String> {
    let text = format!("condyle = 1\nkind = \"model\"\n{body}");
    let errors = try_read(&text).expect_err(body);
    errors.iter().map(ToString::to_string).collect()
}

/// The transforms of all segments in open mode, row by row.
fn pose(model: &Model, stored: &[f64]) -> Vec<[f64; 16]> {
    pose_in(Mode::Open, model, stored)
}

fn pose_in(mode: Mode, model: &Model, stored: &[f64]) -> Vec<[f64; 16]> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, mode, &mut pose).unwrap();
    model.segment_ids().map(|id| pose.segment(id).to_rows()).collect()
}
