//! Any bytes as FBX: no panic, a model that can be posed in every frame.
#![no_main]

use condyle_formats::fbx;
use condyle_model::{Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = fbx::from_bytes(data) else { return };
    let (model, motion) = (read.value.model, read.value.motion);
    assert_eq!(motion.times.len(), motion.frames.len());
    assert!(motion.times.windows(2).all(|pair| pair[0] <= pair[1]), "times rise");
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    for frame in motion.frames.iter().take(8) {
        assert!(frame.iter().all(|value| value.is_finite()), "frames are numbers");
        program.evaluate(frame, Mode::Open, &mut pose).expect("a frame has the model's numbers");
    }
});
