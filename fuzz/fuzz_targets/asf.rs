//! Any bytes as a skeleton of Acclaim, and behind a line `@@@@` as a take of it: no panic, frames that fit.
#![no_main]

use condyle_formats::{asf, skeleton::Assumed};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let cut = data.windows(4).position(|four| four == b"@@@@").unwrap_or(data.len());
    let (skeleton, take) = data.split_at(cut);
    let assumed = Assumed::default();
    let Ok(model) = asf::read(skeleton, &assumed) else { return };
    let take = take.get(4..).unwrap_or_default();
    let Ok(read) = asf::with_skeleton(take, skeleton, &assumed) else { return };
    assert_eq!(read.value.model, model.value);
    let frames = &read.value.motion.frames;
    assert!(!frames.is_empty() && frames.len() == read.value.motion.times.len());
    assert!(frames.iter().all(|frame| frame.len() == model.value.stored_len()));
});
