//! Write, read: the same, to the precision of the format, for every format that is both read and written.
//!
//! `docs/formats.md` has the table of precisions; they are asserted here.

use condyle::encode;
use condyle::formats::skeleton::Assumed;
use condyle::formats::{Content, FORMATS, Format, Id, LengthUnit, asf, c3d, document, exchange};
use condyle::math::{Affine, Mat3, Quat, Vec3};
use condyle::model::UpAxis;
use condyle::model::model::Facing;
use condyle::{
    AngleUnit, Animation, CoordinateKind, Mode, Model, ModelBuilder, Motion, Observed, Pose,
    Program, Range, Recording, Table,
};
use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

/// Numbers from -1 to 1, always the same.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // Knuth's MMIX generator.
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn turn(&mut self) -> Quat {
        Quat::from([self.next(), self.next(), self.next(), self.next() + 1.5]).normalized()
    }
}

const FRAMES: usize = 40;
const RATE: f64 = 50.0;

/// A tree of hinges and a slider in frames that are turned against each other; with a free root it can walk off.
fn figure(numbers: &mut Numbers, free: bool) -> Model {
    let mut b = ModelBuilder::new("figure");
    // As animation programs have it, so that nothing is turned on the way.
    b.facing(Facing::PlusZ);
    let mut parents = vec![];
    for (index, parent) in [None, Some(0), Some(1), Some(0), Some(3)].into_iter().enumerate() {
        let segment =
            b.segment(&format!("part{index}"), parent.map(|parent: usize| parents[parent]));
        parents.push(segment);
        let end = |n: &mut Numbers| Affine::new(n.turn().to_mat3(), n.vector() * 0.3);
        b.place_joint_frames(segment, end(numbers), end(numbers));
        if index == 0 && free {
            let set = b.joint_set("root");
            let orientation = b.coordinate(set, "orientation", CoordinateKind::Orientation);
            let mut factors = vec![];
            for (name, axis) in ["tx", "ty", "tz"].into_iter().zip(Vec3::UNITS) {
                let along = b.coordinate(set, name, CoordinateKind::Translation);
                factors.push(b.translate(set, name, along, axis));
            }
            factors.push(b.ball(set, "ball", orientation));
            let all = b.product(set, "all", factors);
            b.output(set, segment, all);
        } else if index == 4 {
            let set = b.joint_set("slides");
            let along = b.coordinate(set, "slides", CoordinateKind::Translation);
            let step = b.translate(set, "along", along, numbers.turn().to_mat3() * Vec3::X);
            b.output(set, segment, step);
        } else {
            let name = format!("turns{index}");
            let (_, id) = b.hinge(&name, segment, &name, numbers.turn().to_mat3() * Vec3::X);
            b.coordinate_mut(id).range =
                Range { lower: Some(-2.0), upper: Some(2.0), enforced: true };
        }
    }
    b.build().expect("a tree")
}

fn motion(numbers: &mut Numbers, model: &Model) -> Motion {
    let mut frames = vec![];
    for _ in 0..FRAMES {
        let step: Vec<f64> = (0..model.tangent_len()).map(|_| numbers.next()).collect();
        let mut frame = model.defaults();
        model.retract(&model.defaults(), &step, &mut frame);
        frames.push(frame);
    }
    Motion { times: (0..FRAMES).map(|frame| frame as f64 / RATE).collect(), frames }
}

/// The transforms of these segments in a frame.
fn places(model: &Model, program: &Program, stored: &[f64], names: &[String]) -> Vec<Affine> {
    let mut pose = Pose::new(program);
    program.evaluate(stored, Mode::Open, &mut pose).expect("its own numbers");
    let find = |name: &String| model.find_segment(name).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    names.iter().map(|name| pose.segment(find(name))).collect()
}

fn farthest(a: &[Affine], b: &[Affine]) -> f64 {
    let numbers = |all: &[Affine]| -> Vec<f64> {
        all.iter().flat_map(|t| t.to_rows().into_iter().take(12)).collect()
    };
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn names(model: &Model) -> Vec<String> {
    model.segments().iter().map(|segment| segment.name.clone()).collect()
}

fn read(format: &Format, bytes: &[u8], assumed: &Assumed) -> Content {
    let sniffed = Format::of_bytes(bytes).map(|found| found.id);
    // MOT and STO look alike.
    assert!(sniffed == Some(format.id) || format.id == Id::Sto, "{sniffed:?} for {}", format.name);
    let read = format.read_with(bytes, &mut |_| Err("alone".to_owned()), assumed);
    read.unwrap_or_else(|error| panic!("{}: {error}", format.name)).value
}

fn model_of(content: Content) -> Model {
    match content {
        Content::Model(model) => model,
        Content::Document(document) => document.model,
        other => panic!("{other:?}"),
    }
}

/// How far segments are off after a model was written and read, at poses given by the names of coordinates.
fn model_off(format: &Format) -> f64 {
    let mut numbers = Numbers(7);
    let model = figure(&mut numbers, false);
    let bytes = match format.id {
        Id::Document => document::write(&model).into_bytes(),
        Id::Poses => exchange::write(&model).into_bytes(),
        _ => encode::model(format, &model).expect("it is plain").value,
    };
    let again = model_of(read(format, &bytes, &Assumed::default()));
    if format.id == Id::Poses {
        // Every field, to the last bit, but that a component that was called as its coordinate has got a name of its own.
        assert_eq!(again.segments(), model.segments());
        assert_eq!(again.coordinates(), model.coordinates());
        let laws = |m: &Model| -> Vec<_> {
            m.components().iter().map(|c| (c.law.clone(), c.inputs.clone())).collect()
        };
        assert_eq!(laws(&again), laws(&model));
        let bytes = exchange::write(&again).into_bytes();
        assert!(model_of(read(format, &bytes, &Assumed::default())) == again);
    }
    let (one, two) = (Program::compile(&model), Program::compile(&again));
    let names = names(&model);
    let mut off: f64 = 0.0;
    for frame in motion(&mut numbers, &model).frames {
        let mut same = again.defaults();
        for id in model.coordinate_ids() {
            let name = &model.coordinate(id).name;
            let found = again.coordinate_ids().find(|id| &again.coordinate(*id).name == name);
            let found = found.or_else(|| {
                again
                    .coordinate_ids()
                    .find(|id| again.coordinate_key(*id).starts_with(name.as_str()))
            });
            let found = found.unwrap_or_else(|| panic!("{}: no coordinate {name}", format.name));
            *again.value_mut(&mut same, found) = model.value(&frame, id);
        }
        let ours = places(&model, &one, &frame, &names);
        // Robots stand on z: the whole figure is turned by a quarter.
        let turned = again.up() == UpAxis::Z;
        let back = Affine::from_rotation(Mat3::rotation_x(if turned { -FRAC_PI_2 } else { 0.0 }));
        let theirs = places(&again, &two, &same, &names);
        let theirs: Vec<Affine> = theirs.into_iter().map(|place| back * place).collect();
        off = off.max(farthest(&ours, &theirs));
    }
    off
}

/// How far joints are off in any frame after a motion was written as a skeleton and read.
fn animation_off(format: &Format) -> f64 {
    let mut numbers = Numbers(11);
    let model = figure(&mut numbers, true);
    let motion = motion(&mut numbers, &model);
    let unit = 0.01;
    let bytes = match format.id {
        Id::Glb => encode::scene(&model, &motion, Mode::Open, None).expect("it is plain").value,
        _ => encode::skeleton(format, &model, &motion, Mode::Open, unit).expect("plain").value,
    };
    let assumed = Assumed { metres_per_unit: Some(unit), ..Assumed::default() };
    let assumed = if format.id == Id::Glb { Assumed::default() } else { assumed };
    let Content::Animation(again) = read(format, &bytes, &assumed) else {
        panic!("{}", format.name)
    };
    let Animation { model: bones, motion: moved } = *again;
    assert_eq!(moved.frames.len(), FRAMES, "{}", format.name);
    for (a, b) in moved.times.iter().zip(&motion.times) {
        assert!((a - b).abs() < 1e-6, "{}: frame at {a} for {b}", format.name);
    }
    let (one, two) = (Program::compile(&model), Program::compile(&bones));
    let names = names(&model);
    let joints = |model: &Model, places: &[Affine]| -> Vec<Vec3> {
        let centre = |name: &String, place: &Affine| {
            let id = model.find_segment(name).expect("of these");
            // Nodes of glTF are segments, joints of BVH are where segments turn.
            let joint = model.segment(id).joint_in_segment.translation;
            *place * if format.id == Id::Glb { Vec3::ZERO } else { joint }
        };
        names.iter().zip(places).map(|(name, place)| centre(name, place)).collect()
    };
    let mut off: f64 = 0.0;
    for (ours, theirs) in motion.frames.iter().zip(&moved.frames) {
        let a = joints(&model, &places(&model, &one, ours, &names));
        let b = joints(&bones, &places(&bones, &two, theirs, &names));
        off = a.iter().zip(&b).map(|(a, b)| (*a - *b).norm()).fold(off, f64::max);
    }
    off
}

/// Positions as a recorder has them: floats in millimetres; some are missing.
fn recording(numbers: &mut Numbers, units: LengthUnit) -> Recording {
    let labels: Vec<String> = ["RASI", "LASI", "a b", "Ä"].map(str::to_owned).into();
    let mut positions = vec![];
    for index in 0..FRAMES * labels.len() {
        let mut place = || (numbers.next() as f32) * 1000.0;
        let place = [place(), place(), place()].map(|x| units.to_metres(f64::from(x)));
        positions.push(if index % 7 == 3 { Observed::MISSING } else { Observed::from(place) });
    }
    let times = (0..FRAMES).map(|frame| frame as f64 / RATE).collect();
    Recording { labels, rate: RATE, times, positions, units, confidences: None }
}

fn table(numbers: &mut Numbers, angle_unit: AngleUnit) -> Table {
    let columns = ["pelvis_tx", "knee_angle_r", "/jointset/a/b/value"].map(str::to_owned).to_vec();
    let mut values: Vec<f64> = (0..FRAMES * 3).map(|_| numbers.next() * 100.0).collect();
    values[5] = f64::NAN;
    values[6..9].copy_from_slice(&[1e-300, -0.1 - 0.2, 1e15]);
    let times = (0..FRAMES).map(|frame| frame as f64 / RATE).collect();
    Table { columns, times, values, angle_unit, ..Table::default() }
}

fn assert_same_tables(a: &Table, b: &Table, name: &str) {
    let bits = |table: &Table| -> Vec<u64> {
        let all = table.times.iter().chain(&table.values);
        all.map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() }).collect()
    };
    assert_eq!((&a.columns, bits(a)), (&b.columns, bits(b)), "{name}");
}

#[test]
fn every_format_that_is_read_and_written_gives_back_what_was_written() {
    let both = FORMATS.iter().filter(|f| !f.reads.is_empty() && !f.writes.is_empty());
    let mut seen = 0;
    for format in both {
        seen += 1;
        let name = format.name;
        let mut numbers = Numbers(3);
        match format.id {
            // Documents have angles and quaternions for matrices.
            Id::Document | Id::Poses | Id::OpenSim | Id::Urdf => {
                let off = model_off(format);
                println!("{name}: transforms are off by {off:.1e}");
                assert!(off < 1e-12, "{name}: {off}");
            }
            Id::Glb | Id::Bvh => {
                // Floats of 32 bits: half a unit in the last place of each number of three bones of up to 1 m is 6e-8 of it.
                // Six decimals of a degree and of a centimetre, along the same.
                let most = if format.id == Id::Glb { 5e-7 } else { 1e-7 };
                let off = animation_off(format);
                println!("{name}: joints are off by {off:.1e} m");
                assert!(off < most, "{name}: {off}");
            }
            Id::Mot | Id::Sto | Id::Csv => {
                let unit = if format.id == Id::Csv {
                    AngleUnit::RadiansAsRule
                } else {
                    AngleUnit::Degrees
                };
                let table = table(&mut numbers, unit);
                let bytes = encode::table(format, &table).expect("a table");
                let Content::Table(again) = read(format, &bytes, &Assumed::default()) else {
                    panic!("{name}")
                };
                assert_same_tables(&again, &table, name);
                assert_eq!(again.angle_unit, unit, "{name}");
                if format.id == Id::Csv {
                    let recording = recording(&mut numbers, LengthUnit::Metre);
                    let bytes = encode::recording(format, &recording, "a.csv").expect("markers");
                    let Content::Table(again) = read(format, &bytes, &Assumed::default()) else {
                        panic!("{name}")
                    };
                    assert_same_tables(&again, &recording.to_table(), name);
                }
            }
            Id::Trc | Id::C3d => {
                // C3D files are written in millimetres.
                let of_trc = (format.id == Id::Trc).then_some(LengthUnit::Metre);
                for units in of_trc.into_iter().chain([LengthUnit::Millimetre]) {
                    let recording = recording(&mut numbers, units);
                    let bytes = encode::recording(format, &recording, "a").expect("markers");
                    let again = match read(format, &bytes, &Assumed::default()) {
                        Content::Recording(again) => again,
                        Content::Trial(trial) => trial.recording,
                        other => panic!("{other:?}"),
                    };
                    assert_eq!(again.units, units, "{name}");
                    assert_eq!(again.positions, recording.positions, "{name}");
                    assert_eq!(again.labels, recording.labels, "{name}");
                    assert_eq!(again.rate, recording.rate, "{name}");
                }
            }
            // A take is written beside a skeleton: the tests below.
            Id::Amc => {}
            other => panic!("no test writes and reads {other:?}"),
        }
    }
    assert!(seen >= 12, "{seen} formats of all features");
}

const SKELETON: &str = ":version 1.10\n:name Anna\n:units\n mass 1.0\n length 0.45\n angle deg\n\
    :root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 1 2 3\n orientation 0 0 0\n:bonedata\n\
    begin\n id 1\n name thigh\n direction 0 -1 0\n length 2\n axis 10 20 30 ZXY\n dof rx ry tz l\nend\n\
    begin\n id 2\n name shank\n direction 0 -1 0\n length 3\n axis 0 0 0 XYZ\n dof rz rx\nend\n\
    begin\n id 3\n name sole\n direction 0 0 1\n length 1\n axis 0 0 0 XYZ\nend\n\
    :hierarchy\nbegin\n root thigh\n thigh shank\n shank sole\nend\n";

#[test]
fn a_take_comes_back_in_the_order_of_its_skeleton() {
    let assumed = Assumed { rate: Some(RATE), ..Assumed::default() };
    for skeleton in [SKELETON.to_owned(), SKELETON.replace("deg", "rad").replace("0.45", "1.0")] {
        let model = asf::read(skeleton.as_bytes(), &assumed).expect("a skeleton").value;
        let mut numbers = Numbers(5);
        let mut moves = motion(&mut numbers, &model);
        // A gap of one frame is kept.
        moves.times.iter_mut().skip(20).for_each(|time| *time += 1.0 / RATE);
        let take = asf::write(&moves, skeleton.as_bytes(), &assumed).expect("its own motion");
        assert!(take.warned("amc/rate"), "50 frames a second are not stated");
        let rows: Vec<&str> = take.value.lines().skip(2).take(4).collect();
        let counts: Vec<usize> = rows.iter().map(|row| row.split(' ').count()).collect();
        assert_eq!(rows[0], "1");
        assert!(
            rows[1].starts_with("root ")
                && rows[2].starts_with("thigh ")
                && rows[3].starts_with("shank ")
        );
        assert_eq!(counts, [1, 7, 5, 3], "a number for each dof; none for the sole");
        let again = asf::with_skeleton(take.value.as_bytes(), skeleton.as_bytes(), &assumed);
        let again = again.unwrap_or_else(|error| panic!("{error}")).value;
        assert_eq!(again.model, model);
        assert_eq!(again.motion.frames.len(), FRAMES);
        for (a, b) in again.motion.times.iter().zip(&moves.times) {
            assert!((a - b).abs() < 1e-9, "{a} for {b}");
        }
        for (a, b) in again.motion.frames.concat().iter().zip(moves.frames.concat()) {
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(0.1), "{a} for {b}");
        }
    }
    let assumed = Assumed::default();
    let empty = asf::write(&Motion::default(), SKELETON.as_bytes(), &assumed);
    assert_eq!(empty.unwrap_err().code(), "amc/no-frame");
    let other = Motion { times: vec![0.0], frames: vec![vec![0.0; 3]] };
    assert_eq!(asf::write(&other, SKELETON.as_bytes(), &assumed).unwrap_err().code(), "amc/width");
}

/// The folder of shared data beside the repository; `None` where it is absent.
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

/// The rows of a take: words, and numbers by their values.
fn rows(take: &str) -> Vec<(String, Vec<f64>)> {
    let lines = take.lines().map(str::trim).filter(|line| !line.starts_with([':', '#']));
    let row = |line: &str| {
        let mut words = line.split_whitespace();
        let first = words.next().unwrap_or_default().to_owned();
        (first, words.map(|word| word.parse().expect("a number")).collect())
    };
    lines.filter(|line| !line.is_empty()).map(row).collect()
}

#[test]
fn a_published_take_is_written_with_its_own_numbers() {
    let Some(folder) = data() else { return };
    let file = |name: &str| std::fs::read(folder.join("shoulder/cmu01").join(name)).expect(name);
    let (skeleton, take) = (file("01.asf"), file("01_03.amc"));
    let assumed = Assumed::default();
    let read = asf::with_skeleton(&take, &skeleton, &assumed).expect("published").value;
    let written = asf::write(&read.motion, &skeleton, &assumed).expect("its own").value;
    let (theirs, ours) = (rows(&String::from_utf8(take).expect("ASCII")), rows(&written));
    let mut theirs: Vec<_> = theirs.split(|(first, _)| first.parse::<u32>().is_ok()).collect();
    let ours: Vec<_> = ours.split(|(first, _)| first.parse::<u32>().is_ok()).collect();
    theirs.retain(|frame| !frame.is_empty());
    let mut compared = 0;
    for (theirs, ours) in theirs.iter().zip(ours.iter().skip(1)) {
        assert_eq!(theirs.len(), ours.len(), "rows of a frame");
        for (name, numbers) in theirs.iter() {
            let (_, own) = ours.iter().find(|(own, _)| own == name).expect(name);
            assert_eq!(own, numbers, "{name}");
            compared += numbers.len();
        }
    }
    assert_eq!(compared, theirs.len() * 62, "62 numbers a frame");
    println!("{compared} numbers are those of the published take");
}

#[test]
fn real_recordings_and_tables_come_back() {
    let Some(folder) = data() else { return };
    let file = |name: &str| std::fs::read(folder.join(name)).expect(name);
    for name in ["hip/right_hip_functional.c3d", "c3d/s02_dec_int.c3d", "c3d/s02_sgi_real.c3d"] {
        let trial = c3d::from_bytes(&file(name)).expect(name).value;
        let again = c3d::from_bytes(&c3d::write(&trial).expect(name)).expect(name).value;
        assert_eq!(again.recording, trial.recording, "{name}");
        assert_eq!((again.analog, again.others), (trial.analog, trial.others), "{name}");
    }
    for name in ["knee/opencap4/squats1_ik.mot", "sto/sampleOutputs.sto"] {
        let format = Format::of_ending("mot").expect("a table");
        let Content::Table(table) = read(format, &file(name), &Assumed::default()) else {
            panic!("{name}")
        };
        let bytes = encode::table(format, &table).expect(name);
        let Content::Table(again) = read(format, &bytes, &Assumed::default()) else {
            panic!("{name}")
        };
        assert_same_tables(&again, &table, name);
    }
}
