//! Any bytes as the recording of an arm: it is tracked, or refused with a reason, in bounded time; no panic,
//! and numbers that are numbers.
#![no_main]

use condyle::tracking::{Request, track};
use condyle::{Model, ModelBuilder, Range, math::Vec3};
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
    let (_, flexion) = b.hinge("elbow", fore, "flexion", Vec3::Z);
    b.coordinate_mut(flexion).range = Range::new(0.0, 2.5);
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
    let robust = data.len() % 2 == 1;
    let request = Request { threads: Some(1), robust, ..Request::default() };
    let Ok(tracking) = track(&ARM, &recording, &request, &mut |_, _| {}) else { return };
    for answer in tracking.answers.iter() {
        assert!(answer.coordinates.iter().all(|x| x.is_finite()), "{answer:?}");
        let errors = answer.marker_errors.iter();
        assert!(errors.clone().all(|e| e.is_nan() || *e >= 0.0));
        if answer.status.is_solved() {
            assert!(answer.objective.is_finite());
        }
    }
    assert_eq!(tracking.answers.len(), tracking.motion().frames.len());
    let _ = tracking.report(&ARM);
});
