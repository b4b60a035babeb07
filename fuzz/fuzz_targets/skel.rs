//! Any bytes as a skeleton of the course CSE 169: no panic, defaults within limits.
#![no_main]

use condyle_formats::{skel, skeleton::Assumed};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = skel::read(data, &Assumed::default()) else { return };
    for coordinate in read.value.coordinates() {
        assert_eq!(coordinate.range.nearest(coordinate.default[0]), coordinate.default[0]);
    }
});
