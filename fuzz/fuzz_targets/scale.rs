//! Any bytes as a static trial: the model is scaled, or refused with a reason; no panic, and lengths that are
//! lengths.
#![no_main]

use condyle::scaling::{Assumptions, fit};
use condyle::{Model, ModelBuilder, math::Vec3};
use condyle_formats::trc;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// Longer recordings are as the short ones.
const MOST_FRAMES: usize = 12;
const MOST_LABELS: usize = 12;

static ARM: LazyLock<Model> = LazyLock::new(|| {
    let mut b = ModelBuilder::new("arm");
    let upper = b.segment("upper", None);
    b.ball_joint("shoulder", upper);
    let fore = b.segment("fore", Some(upper));
    b.place_joint(fore, Vec3::new(0.0, -0.3, 0.0));
    b.hinge("elbow", fore, "flexion", Vec3::Z);
    b.size_group("upper", vec![upper]);
    b.size_group("fore", vec![fore]);
    for (name, at) in
        [("A", [0.02, -0.05, 0.01]), ("B", [0.0, -0.2, 0.03]), ("C", [0.03, -0.28, 0.0])]
    {
        b.marker(name, Some(upper), at.into());
    }
    for (name, at) in [("D", [0.03, -0.05, 0.0]), ("E", [0.0, -0.2, 0.02])] {
        b.marker(name, Some(fore), at.into());
    }
    b.build().expect("an arm")
});

fuzz_target!(|data: &[u8]| {
    let Ok(read) = trc::from_bytes(data) else { return };
    let recording = read.value;
    if recording.frames() > MOST_FRAMES || recording.labels.len() > MOST_LABELS {
        return;
    }
    match fit(&ARM, &recording, &Assumptions::default()) {
        Ok(scaled) => {
            assert!(scaled.posture.iter().all(|x| x.is_finite()));
            for factor in scaled.groups.iter().chain([&scaled.body]) {
                assert!(factor.factor.is_finite() && factor.factor > 0.0, "{factor:?}");
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
