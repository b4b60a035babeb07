//! C3D: files made here, whose numbers follow from how they are made, and real ones where they are at hand.

use condyle_formats::{Content, Format, Id, LengthUnit, Observed, Recording, c3d};

fn recording() -> Recording {
    let place = |i: usize| {
        let x = i as f64;
        Observed::from([0.001 * x, 0.9 + 0.002 * x, -0.12])
    };
    let mut positions: Vec<Observed> = (0..6).map(place).collect();
    positions[3] = Observed::MISSING;
    Recording {
        labels: vec!["LASI".into(), "RASI".into()],
        rate: 100.0,
        times: vec![0.0, 0.01, 0.02],
        positions,
        units: LengthUnit::Metre,
        confidences: None,
    }
}

/// Floats keep 24 bits: a coordinate below 1 m is off by less than 1 m / 2^24.
#[test]
fn a_recording_is_written_in_millimetres_and_read_back() {
    let recording = recording();
    let bytes = c3d::write(&c3d::Trial::of(recording.clone())).unwrap();
    let read = c3d::from_bytes(&bytes).unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let found = read.value.recording;
    assert_eq!(found.units, LengthUnit::Millimetre);
    assert_eq!((&found.labels, &found.times), (&recording.labels, &recording.times));
    for (a, b) in recording.positions.iter().zip(&found.positions) {
        match (a.position(), b.position()) {
            (Some(a), Some(b)) => {
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 6e-8), "{a:?} {b:?}")
            }
            (a, b) => assert_eq!(a, b),
        }
    }
    let format = Format::of_bytes(&bytes).unwrap();
    assert_eq!(format.id, Id::C3d);
    let content = format.read(&bytes, &mut |_| Err(String::new())).unwrap().value;
    assert!(matches!(content, Content::Trial(_)));
}

/// What was written once is written the same again.
#[test]
fn read_write_read_is_equal() {
    let first = c3d::from_bytes(&c3d::write(&c3d::Trial::of(recording())).unwrap()).unwrap().value;
    let again = c3d::write(&first).unwrap();
    assert_eq!(c3d::from_bytes(&again).unwrap().value, first);
}
