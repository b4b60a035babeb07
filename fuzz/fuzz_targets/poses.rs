//! Any bytes as poses: no panic, and poses of a model that fit it; key poses, and the motion between them.
#![no_main]

use condyle_formats::poses;
use condyle_math::Vec3;
use condyle_model::ModelBuilder;
use condyle_motion::Interpolation;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = poses::read(data) else { return };
    let mut b = ModelBuilder::new("arm");
    let upper = b.segment("upper", None);
    b.ball_joint("shoulder", upper);
    let fore = b.segment("fore", Some(upper));
    b.hinge("elbow", fore, "flexion", Vec3::Z);
    let model = b.build().expect("a ball and a hinge");
    if let Ok(poses) = read.value.resolve(&model) {
        assert!(poses.motion.frames.iter().all(|frame| frame.len() == model.stored_len()));
        assert_eq!(poses.named.len(), poses.motion.frames.len());
    }
    if let Ok(keys) = read.value.keys(&model)
        && keys
            .times
            .last()
            .zip(keys.times.first())
            .is_some_and(|(last, first)| last - first < 100.0)
        && let Ok(motion) = keys.sample(&model, 10.0, Interpolation::Spline)
    {
        assert!(motion.frames.iter().all(|frame| frame.len() == model.stored_len()));
        assert!(motion.times.windows(2).all(|pair| pair[0] <= pair[1]));
    }
});
