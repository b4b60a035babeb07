//! Any bytes as a marker recording: no panic, a table that fits, and a second reading that
//! agrees with the first.
#![no_main]

use condyle_formats::{LengthUnit, trc};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = trc::from_bytes(data) else { return };
    let recording = read.value;
    assert!(recording.frames() > 0 && !recording.labels.is_empty());
    assert_eq!(recording.positions.len(), recording.frames() * recording.labels.len());
    let missing: usize = recording.gaps().iter().map(|gap| gap.frames).sum();
    assert_eq!(missing, recording.missing());
    if recording.units == LengthUnit::Metre && recording.rate > 0.0 {
        let text = trc::write(&recording, "fuzz.trc").expect("what was read can be written");
        let again = trc::read(&text).expect("what was written can be read").value;
        assert_eq!(again, recording);
    }
});
