//! Any bytes as a skeleton with motion: no panic, frames that fit the model, and what is written is read again
//! with as many joints and frames.
#![no_main]

use condyle_formats::bvh;
use condyle_model::Mode;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = bvh::from_bytes(data) else { return };
    let found = read.value;
    assert!(found.motion.frames.iter().all(|frame| frame.len() == found.model.stored_len()));
    assert_eq!(found.motion.frames.len(), found.motion.times.len());
    let Ok(text) = bvh::write(&found.model, &found.motion, Mode::Open, 0.01) else { return };
    let again = bvh::from_bytes(text.value.as_bytes()).expect("what was written can be read").value;
    assert_eq!(again.model.segments().len(), found.model.segments().len());
});
