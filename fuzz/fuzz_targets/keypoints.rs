//! Any bytes as keypoints, JSON or a table: no panic, parts that fit together, confidences from 0 to 1.
#![no_main]

use condyle_formats::keypoints;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let _ = (keypoints::is_json(data), keypoints::is_table(data));
    let Ok(read) = keypoints::from_bytes(data) else { return };
    let recording = read.value;
    assert_eq!(recording.mismatch(), None);
    assert!(recording.times.windows(2).all(|pair| pair[0] <= pair[1]), "times rise");
    for frame in 0..recording.frames() {
        for label in 0..recording.labels.len() {
            assert!((0.0..=1.0).contains(&recording.confidence(frame, label)));
        }
    }
});
