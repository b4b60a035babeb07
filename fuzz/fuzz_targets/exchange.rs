//! Any bytes as a resolved model: no panic, and a model that is read is written and read again alike.
#![no_main]

use condyle_formats::exchange;
use condyle_model::{Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = exchange::read(data) else { return };
    let model = read.value;
    let text = exchange::write(&model);
    let again = exchange::read(text.as_bytes()).expect("what was written is read").value;
    assert!(exchange::write(&again) == text);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    for mode in [Mode::Open, Mode::Posed] {
        program.evaluate(&model.defaults(), mode, &mut pose).expect("made for this program");
    }
});
