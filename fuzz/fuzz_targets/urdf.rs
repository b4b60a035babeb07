//! Any bytes as a robot description: no panic, a model that can be posed, and one that is written and read again.
#![no_main]

use condyle_formats::urdf;
use condyle_model::{Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = urdf::from_bytes(data) else { return };
    let model = read.value;
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&model.defaults(), Mode::Posed, &mut pose).expect("defaults fit the program");
    if model.segments().len() < 50 {
        let written = urdf::written(&model);
        let again = urdf::from_bytes(written.text.as_bytes()).expect("what is written is read");
        assert!(again.value.segments().len() >= model.segments().len());
    }
});
