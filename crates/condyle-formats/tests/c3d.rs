//! C3D: files made here, whose numbers follow from how they are made, and real ones where they are at hand.

mod c3d_build;

use c3d_build::{Build, Processor};
use condyle_formats::{Content, Format, Id, LengthUnit, Observed, Read, Recording, Severity, c3d};
use proptest::prelude::*;

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

fn read(build: &Build) -> Read<c3d::Trial> {
    c3d::from_bytes(&build.bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// Coordinates are steps times the scale, in millimetres.
#[test]
fn all_processors_and_storages_give_the_same() {
    for processor in [Processor::Intel, Processor::Dec, Processor::Mips] {
        for real in [true, false] {
            let found = read(&Build::new(processor, real));
            assert!(found.warnings.is_empty(), "{:?}", found.warnings);
            let trial = found.value;
            assert_eq!(trial.recording.labels, ["A", "B", "C"]);
            assert_eq!(trial.recording.times, [0.0, 0.02]);
            assert_eq!(trial.recording.position(0, 0), Some([0.025, 0.05, 0.075]));
            assert_eq!(trial.recording.position(1, 2), Some([0.525, 0.55, 0.575]));
            assert_eq!(trial.storage.whole, !real);
        }
    }
}

#[test]
fn ways_of_saying_missing() {
    for (word, real) in [(-1.0, false), (-16512.0, false), (-1.0, true)] {
        let mut build = Build::new(Processor::Intel, real);
        build.numbers[3] = word;
        let trial = read(&build).value;
        assert_eq!(trial.recording.position(0, 0), None, "{word}");
        assert_eq!(trial.residual(0, 0), None);
        assert_eq!(trial.recording.missing(), 1);
    }
    for wrong in [f32::NAN, f32::INFINITY] {
        let mut build = Build::new(Processor::Intel, true);
        build.numbers[1] = wrong;
        assert_eq!(read(&build).value.recording.missing(), 1);
        // A word that is no number says nothing of the marker.
        let mut build = Build::new(Processor::Intel, true);
        build.numbers[3] = f32::NAN;
        assert_eq!(read(&build).value.recording.missing(), 0);
    }
    let mut build = Build::new(Processor::Intel, true);
    build.numbers[..3].fill(0.0);
    let mut recording = read(&build).value.recording;
    assert_eq!(recording.position(0, 0), Some([0.0; 3]));
    recording.settle_zeros(condyle_motion::Zeros::Told);
    assert_eq!(recording.position(0, 0), None);
}

/// 1503 = 5·256 + 223: cameras 1 and 3, and 223 steps of 0.0232 mm are 5.17 mm.
#[test]
fn residuals_and_cameras_share_a_word() {
    for real in [true, false] {
        let mut build = Build::new(Processor::Intel, real);
        build.without("SCALE");
        build.scale = 0.0232;
        build.float(1, "SCALE", if real { -0.0232 } else { 0.0232 });
        build.numbers[3] = 1503.0;
        let trial = read(&build).value;
        assert_eq!(trial.cameras(0, 0), 5);
        let residual = trial.residual(0, 0).unwrap();
        assert!((residual - 0.001 * 223.0 * 0.0232).abs() < 1e-9, "{residual}");
    }
}

#[test]
fn a_file_that_is_cut_off_gives_the_frames_that_are_there() {
    let recording = Recording {
        times: (0..40).map(|i| f64::from(i) / 100.0).collect(),
        positions: vec![Observed::from([0.1, 0.9, 0.2]); 80],
        ..recording()
    };
    let bytes = c3d::write(&c3d::Trial::of(recording)).unwrap();
    let data = bytes.len() - (40usize * 32).next_multiple_of(512);
    let read = c3d::from_bytes(&bytes[..data + 10 * 32 + 5]).unwrap();
    assert_eq!(read.value.recording.frames(), 10);
    assert!(read.warned("c3d/truncated"));
    let error = c3d::from_bytes(&bytes[..data + 31]).unwrap_err();
    assert_eq!(error.code(), "c3d/truncated");
    for cut in 0..data {
        // No panic, and no frames from nowhere.
        assert!(c3d::from_bytes(&bytes[..cut]).is_err(), "{cut}");
    }
}

/// Scales of the wrong sign or zero, and counts that are wrong, are told by the length of the file.
#[test]
fn the_length_of_the_file_decides() {
    let long = |processor, real| {
        let mut build = Build::new(processor, real);
        build.numbers = build.numbers.repeat(40);
        build.frames = [1, 80];
        build.without("FRAMES");
        build
    };
    for real in [true, false] {
        for scale in [0.0, if real { 0.25 } else { -0.25 }] {
            let mut build = long(Processor::Intel, real);
            build.without("SCALE");
            build.float(1, "SCALE", scale);
            let mut bytes = build.bytes();
            bytes[12..16].copy_from_slice(&scale.to_le_bytes());
            let found = c3d::from_bytes(&bytes).unwrap();
            assert_eq!(found.value.storage.whole, !real, "{scale}");
            assert_eq!(found.value.recording.frames(), 80);
            assert!(found.warned("c3d/scale"), "{:?}", found.warnings);
        }
        let mut build = long(Processor::Mips, real);
        build.without("USED");
        build.word(1, "USED", 4);
        let found = read(&build);
        assert_eq!(found.value.recording.labels, ["A", "B", "C"]);
        assert!(found.warned("c3d/counts"));
        let mut build = long(Processor::Dec, real);
        build.frames = [1, 3000];
        let found = read(&build);
        assert!(found.value.recording.frames() >= 80 && found.warned("c3d/truncated"));
        build.frames = [0, 0];
        build.points = 3;
        assert!(read(&build).value.recording.frames() >= 1);
    }
}

/// A first frame so late that 32 bits do not hold the last one is no frame's number.
#[test]
fn frames_that_cannot_be_counted_are_counted_from_one() {
    let mut build = Build::new(Processor::Intel, true);
    build.words(5, "ACTUAL_START_FIELD", &[-1, -1]);
    let found = read(&build);
    assert!(found.warned("c3d/first-frame"), "{:?}", found.warnings);
    assert_eq!((found.value.first_frame, found.value.recording.times[0]), (1, 0.0));
    let again = c3d::from_bytes(&c3d::write(&found.value).unwrap()).unwrap();
    assert_eq!(again.value.recording.frames(), found.value.recording.frames());
}

#[test]
fn many_points_and_many_frames() {
    let labels: Vec<String> = (0..600).map(|i| format!("marker_{i}")).collect();
    let wide = Recording {
        labels: labels.clone(),
        rate: 100.0,
        times: vec![0.0],
        positions: (0..600).map(|i| Observed::from([0.001 * f64::from(i), 1.0, 0.0])).collect(),
        units: LengthUnit::Millimetre,
        ..Recording::default()
    };
    let bytes = c3d::write(&c3d::Trial::of(wide)).unwrap();
    let trial = c3d::from_bytes(&bytes).unwrap().value;
    assert_eq!(trial.recording.labels, labels);
    assert!(trial.parameters.get("POINT", "LABELS3").is_some());

    let count = 70_000i32;
    let long = Recording {
        labels: vec!["A".into()],
        rate: 1000.0,
        times: (0..count).map(|i| f64::from(i) / 1000.0).collect(),
        positions: (0..count).map(|i| Observed::from([1e-6 * f64::from(i), 1.0, 0.0])).collect(),
        units: LengthUnit::Millimetre,
        ..Recording::default()
    };
    let mut bytes = c3d::write(&c3d::Trial::of(long)).unwrap();
    let found = c3d::from_bytes(&bytes).unwrap();
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert_eq!(found.value.recording.frames(), count as usize);
    // Without the numbers that are long enough, the length of the file tells.
    for name in [&b"LONG_FRAMES"[..], b"ACTUAL_END_FIELD"] {
        let at = bytes.windows(name.len()).position(|w| w == name).unwrap();
        bytes[at] = b'X';
    }
    let found = c3d::from_bytes(&bytes).unwrap();
    assert_eq!(found.value.recording.frames(), count as usize);
    assert!(found.warned("c3d/frames"));
}

/// (stored - offset) · scale · scale of all: (65535 - 32768) · 0.5 · 2 = 32767.
#[test]
fn analog_numbers_are_scaled_with_and_without_a_sign() {
    for (format, stored, offset, value) in [
        ("UNSIGNED", 65535.0, 32768, 32767.0),
        ("SIGNED", -5.0, 10, -15.0),
        ("UNSIGNED", 0.0, 32768, -32768.0),
    ] {
        let mut build = Build::new(Processor::Intel, false);
        build.analog = 4;
        build.samples = 2;
        build.numbers = [vec![1.0; 12], vec![stored; 4]].concat().repeat(2);
        build.word(2, "USED", 2);
        build.text(2, "LABELS", &["Fx", "Fz"]);
        build.text(2, "UNITS", &["N", "N"]);
        build.text(2, "FORMAT", &[format]);
        build.floats(2, "SCALE", &[2], &[0.5, 0.5]);
        build.words(2, "OFFSET", &[offset, offset]);
        build.float(2, "GEN_SCALE", 2.0);
        build.float(2, "RATE", 100.0);
        let found = read(&build);
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        let trial = found.value;
        assert_eq!((trial.analog.samples(), trial.analog.rate), (4, 100.0));
        assert_eq!(trial.analog.value(3, 1), Some(value), "{format}");
        assert_eq!(trial.analog.to_table(0.0).times, [0.0, 0.01, 0.02, 0.03]);
        let again = c3d::from_bytes(&c3d::write(&trial).unwrap()).unwrap().value;
        assert_eq!(again.analog, trial.analog);
    }
}

#[test]
fn up_is_told_by_platforms_and_screens() {
    // x, y, z of the first point are 25, 50 and 75 mm.
    for (screen, place) in [
        ("+Z", [0.025, 0.075, -0.050]),
        ("+Y", [0.025, 0.050, 0.075]),
        ("+X", [-0.050, 0.025, 0.075]),
        // Markers are not below their floor.
        ("-Z", [0.025, 0.075, -0.050]),
    ] {
        let mut build = Build::new(Processor::Intel, true);
        build.text(1, "Y_SCREEN", &[screen]);
        let found = read(&build);
        assert_eq!(found.value.recording.position(0, 0), Some(place), "{screen}");
        assert!(found.warnings.iter().all(|said| said.severity == Severity::Note), "{screen}");
        let again = c3d::from_bytes(&c3d::write(&found.value).unwrap()).unwrap().value;
        assert_eq!(again.recording, found.value.recording);
    }
    let mut build = Build::new(Processor::Intel, true);
    build.text(1, "Y_SCREEN", &["+Y"]);
    build.word(3, "USED", 1);
    build.words(3, "TYPE", &[2]);
    build.floats(
        3,
        "CORNERS",
        &[3, 4, 1],
        &[0., 0., 0., 400., 0., 0., 400., 600., 0., 0., 600., 0.],
    );
    build.floats(3, "ORIGIN", &[3, 1], &[0.0, 0.0, -40.0]);
    build.words(3, "CHANNEL", &[1, 2, 3, 4, 5, 6]);
    let trial = read(&build).value;
    assert_eq!(trial.up, c3d::Up::Z);
    let platform = &trial.platforms()[0];
    assert_eq!(platform.corners[2], [0.4, 0.0, -0.6]);
    assert_eq!((platform.kind, &platform.channels[..]), (2, &[0, 1, 2, 3, 4, 5][..]));
    assert_eq!(platform.origin, [0.0, 0.0, -0.04]);
}

#[test]
fn units_are_stated_or_told_by_size() {
    let mut build = Build::new(Processor::Intel, true);
    build.without("UNITS");
    // 100 times as large: the points of a frame span 20 m in millimetres.
    build.numbers.iter_mut().for_each(|x| *x *= 10.0);
    let found = read(&build);
    assert_eq!(found.value.recording.units, LengthUnit::Millimetre);
    assert!(found.warned("c3d/unit"));
    build.text(1, "UNITS", &["MM"]);
    assert!(!read(&build).warned("c3d/unit"));
    let mut build = Build::new(Processor::Intel, true);
    build.without("UNITS");
    build.numbers.iter_mut().for_each(|x| *x *= 0.1);
    assert_eq!(c3d::from_bytes(&build.bytes()).unwrap_err().code(), "c3d/unit");
}

#[test]
fn labels_that_are_missing_or_equal_and_points_that_are_no_markers() {
    let mut build = Build::new(Processor::Intel, true);
    build.without("LABELS");
    build.text(1, "LABELS", &["Anna:KNEE", "Anna:KNEE"]);
    let found = read(&build);
    assert_eq!(found.value.recording.labels, ["Anna:KNEE", "Anna:KNEE#2", "unnamed"]);
    assert!(found.warned("c3d/duplicate-name") && found.warned("c3d/unnamed"));

    let mut build = Build::new(Processor::Intel, true);
    build.text(1, "ANGLES", &["B"]);
    build.text(1, "ANGLE_UNITS", &["deg"]);
    let trial = read(&build).value;
    assert_eq!(trial.recording.labels, ["A", "C"]);
    assert_eq!(trial.others[0].unit, "deg");
    assert_eq!(trial.others[0].value(0), Some([125.0, 150.0, 175.0]));
    let all = trial.all_points();
    assert_eq!(all.labels, ["A", "B", "C"]);
    assert_eq!(all.position(0, 1), Some([0.125, 0.150, 0.175]));
    let table = trial.to_table();
    assert_eq!(&table.row(0)[3..6], [125.0, 150.0, 175.0]);
    let again = c3d::from_bytes(&c3d::write(&trial).unwrap()).unwrap().value;
    assert_eq!(again.others, trial.others);
}

#[test]
fn events_of_the_group_are_minutes_and_seconds() {
    let mut build = Build::new(Processor::Dec, true);
    build.word(4, "USED", 2);
    build.text(4, "LABELS", &["Foot Off", "Foot Strike"]);
    build.text(4, "CONTEXTS", &["Left", "Right"]);
    build.floats(4, "TIMES", &[2, 2], &[1.0, 2.5, 0.0, 1.25]);
    let trial = read(&build).value;
    let found: Vec<_> = trial.events().into_iter().map(|e| (e.time, e.context, e.label)).collect();
    let expected = [(1.25, "Right", "Foot Strike"), (62.5, "Left", "Foot Off")];
    assert_eq!(found, expected.map(|(t, c, l)| (t, c.to_owned(), l.to_owned())));
    let again = c3d::from_bytes(&c3d::write(&trial).unwrap()).unwrap().value;
    assert_eq!(again.events(), trial.events());
}

/// Where the way to the next parameter is wrong, the next one is found by its looks.
#[test]
fn a_broken_chain_of_parameters_is_mended() {
    let build = Build::new(Processor::Intel, true);
    let bytes = build.bytes();
    let at = bytes.windows(5).position(|w| w == b"UNITS").unwrap() + 5;
    for wrong in [[0xff, 0x7f], [3, 0], [60, 0]] {
        let mut broken = bytes.clone();
        broken[at..at + 2].copy_from_slice(&wrong);
        let found = c3d::from_bytes(&broken).unwrap();
        assert_eq!(found.value.recording.labels, ["A", "B", "C"], "{wrong:?}");
        assert_eq!(found.value.recording.rate, 50.0);
        assert_eq!(found.value.parameters.number("POINT", "SCALE"), Some(-0.25), "{wrong:?}");
        assert!(found.warned("c3d/chain"), "{wrong:?}");
    }
}

#[test]
fn what_is_no_c3d_is_refused() {
    for bytes in [&b""[..], b"P", b"\x02Q123", b"PathFileType\t4"] {
        assert_eq!(c3d::from_bytes(bytes).unwrap_err().code(), "c3d/not-c3d");
    }
}

#[test]
fn what_cannot_be_written_is_refused() {
    let mut trial = c3d::Trial::of(recording());
    trial.recording.labels[0] = "x".repeat(128);
    assert_eq!(c3d::write(&trial).unwrap_err().code(), "c3d/label");
    let mut trial = c3d::Trial::of(recording());
    trial.columns.pop();
    assert_eq!(c3d::write(&trial).unwrap_err().code(), "c3d/shape");
    for first_frame in [0, u32::MAX as usize] {
        let trial = c3d::Trial { first_frame, ..c3d::Trial::of(recording()) };
        assert_eq!(c3d::write(&trial).unwrap_err().code(), "c3d/too-large");
    }
    let empty = Recording { times: vec![], positions: vec![], ..recording() };
    assert_eq!(c3d::write(&c3d::Trial::of(empty)).unwrap_err().code(), "c3d/shape");
}

proptest! {
    /// Damaged files give errors or trials whose parts fit together, and what can be written is read again.
    #[test]
    fn damage_does_no_harm(
        which in 0..6usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        early in prop::collection::vec((0..1100usize, any::<u8>()), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let processor = [Processor::Intel, Processor::Dec, Processor::Mips][which % 3];
        let mut build = Build::new(processor, which < 3);
        build.analog = 2;
        build.numbers = [vec![1.0; 12], vec![5.0; 2]].concat().repeat(2);
        build.text(1, "ANGLES", &["B"]);
        build.word(2, "USED", 2);
        build.words(2, "OFFSET", &[1, 2]);
        build.floats(4, "TIMES", &[2, 1], &[0.0, 1.0]);
        build.words(5, "ACTUAL_START_FIELD", &[1, 0]);
        let mut bytes = build.bytes();
        for (place, value) in changes {
            let at = place.index(bytes.len());
            bytes[at] = value;
        }
        for (at, value) in early {
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let Ok(read) = c3d::from_bytes(&bytes) else { return Ok(()) };
        let trial = read.value;
        prop_assert_eq!(trial.recording.mismatch(), None);
        prop_assert_eq!(trial.words.len(), trial.recording.positions.len());
        let _ = (trial.events(), trial.platforms(), trial.to_table(), trial.analog.to_table(0.0));
        let Ok(written) = c3d::write(&trial) else { return Ok(()) };
        let again = c3d::from_bytes(&written);
        let again = again.map_err(|error| TestCaseError::fail(error.to_string()))?.value;
        prop_assert_eq!(&again.recording.labels, &trial.recording.labels);
        prop_assert_eq!(again.recording.frames(), trial.recording.frames());
        prop_assert_eq!(again.analog.stored.len(), trial.analog.stored.len());
        prop_assert_eq!(again.others.len(), trial.others.len());
    }
}
