//! Any bytes as a C3D file: no panic, parts that fit together, and a second reading of what was written that
//! agrees with the first.
#![no_main]

use condyle_formats::c3d;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = c3d::from_bytes(data) else { return };
    let trial = read.value;
    let recording = &trial.recording;
    assert!(recording.frames() > 0);
    assert_eq!(recording.mismatch(), None);
    assert_eq!(trial.words.len(), recording.positions.len());
    assert_eq!(trial.columns.len(), recording.labels.len() + trial.others.len());
    let per_frame = trial.analog.channels.len() * trial.analog.per_frame;
    assert_eq!(trial.analog.stored.len(), per_frame * recording.frames());
    let _ = (trial.events(), trial.platforms(), trial.to_table());
    // Names of more than 127 bytes and parameters of more than 130 kB cannot be written.
    let Ok(bytes) = c3d::write(&trial) else { return };
    let again = c3d::from_bytes(&bytes).expect("what was written can be read").value;
    assert_eq!(again.recording.labels, recording.labels);
    assert_eq!(again.recording.frames(), recording.frames());
    assert_eq!(again.analog.stored.len(), trial.analog.stored.len());
    assert_eq!(again.others.len(), trial.others.len());
});
