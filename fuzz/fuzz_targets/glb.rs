//! Any bytes as glTF: no panic, a model that can be posed in every frame, and the same motion after it was put back.
#![no_main]

use condyle_formats::glb::{self, Old, Options};
use condyle_model::{Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut beside = |_: &str| Ok(vec![0u8; 64]);
    let options = Options::default();
    let Ok(read) = glb::read(data, &options, &mut beside) else { return };
    let (model, motion) = (read.value.model, read.value.motion);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    assert_eq!(motion.times.len(), motion.frames.len());
    assert!(motion.times.windows(2).all(|pair| pair[0] <= pair[1]), "times rise");
    for frame in motion.frames.iter().take(8) {
        assert!(frame.iter().all(|value| value.is_finite()), "frames are numbers");
        program.evaluate(frame, Mode::Open, &mut pose).expect("a frame has the model's numbers");
    }
    if let Ok(covers) = glb::covers(data, &options, &mut beside) {
        for cover in covers.value {
            assert_eq!(cover.mesh.positions.len(), cover.weights.len());
            assert!(
                cover
                    .joints
                    .iter()
                    .flatten()
                    .all(|joint| usize::from(*joint) < cover.carriers.len().max(1))
            );
        }
    }
    let found = glb::node_motion(data, &options, &mut beside, &motion);
    let tracks = found.expect("it was read before");
    let Ok(file) = glb::reanimate(data, &tracks, Old::Replaced) else { return };
    let again = glb::read(&file.value, &options, &mut beside).expect("what was written is read");
    // A node that stands still is not animated any more, and may be none of the figure's then.
    assert!(again.value.model.segments().len() <= model.segments().len());
});
