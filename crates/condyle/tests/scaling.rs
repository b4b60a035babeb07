//! Models made as large as a person, against persons that are made of known factors.

use condyle::Observed;
use condyle::encode;
use condyle::formats::{Format, LengthUnit, Recording, c3d, document, keypoints, trc};
use condyle::math::{Mat3, Vec3};
use condyle::scaling::{Assumptions, Factor, ScaleError, Scaled, fit};
use condyle::{
    CoordinateId, CoordinateKind, Mode, Model, ModelBuilder, Pose, Program, SegmentId, open,
};
use std::path::{Path, PathBuf};

const KNEE: &str = include_str!("../models/knee.toml");
const LEGS: &str = include_str!("../models/legs.toml");
const ARMS: &str = include_str!("../models/arms.toml");
const SPINE: &str = include_str!("../models/spine.toml");

/// Legs that stand in a room, with groups of sizes.
const PERSON: &str = r#"
condyle = 1
kind = "model"
include = ["legs.toml"]
[joint.room]
type = "free"
segment = "pelvis"
[size]
pelvis = { segments = "pelvis" }
thigh = { segments = ["femur_r", "patella_r"] }
shank = { segments = ["tibia_r", "fibula_r"] }
foot = { segments = ["talus_r", "calcaneus_r", "toes_r"] }
"#;

/// The factors of the person who is made up, in the order of the groups.
const TRUTH: [f64; 4] = [1.0, 1.1, 0.95, 1.05];

fn read(text: &str) -> Model {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let include = &mut |path: &str| {
        std::fs::read_to_string(models.join(path)).map_err(|error| error.to_string())
    };
    document::read(text, include).expect("a model").value.model
}

/// Numbers between -1 and 1: SplitMix64 (Steele, Lea & Flood 2014).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Of variance 1: twelve numbers of variance 1/3 each have the variance 4.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() / 2.0
    }
}

fn pose(model: &Model, stored: &[f64]) -> Pose {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).expect("numbers of this model");
    pose
}

fn places(model: &Model, stored: &[f64]) -> Vec<Vec3> {
    let pose = pose(model, stored);
    let at = |m: &condyle::model::model::Marker| match m.segment {
        Some(id) => pose.segment(id) * m.point,
        None => m.point,
    };
    model.markers().iter().map(at).collect()
}

/// A recording of the model's markers, moved by what `noise` says.
fn recording(
    model: &Model,
    stored: &[f64],
    frames: usize,
    mut noise: impl FnMut() -> f64,
) -> Recording {
    let places = places(model, stored);
    let positions = (0..frames).flat_map(|_| places.clone());
    let positions = positions.map(|p| p.to_array().map(|x| x + noise()).into());
    Recording {
        labels: model.markers().iter().map(|m| m.name.clone()).collect(),
        rate: 100.0,
        times: (0..frames).map(|f| f as f64 / 100.0).collect(),
        positions: positions.collect(),
        units: LengthUnit::Metre,
        confidences: None,
    }
}

/// The made up person and how it stands.
fn person() -> (Model, Model, Vec<f64>) {
    let model = read(PERSON);
    let mut factors = vec![1.0; model.segments().len()];
    for (group, factor) in model.size_groups().iter().zip(TRUTH) {
        group.segments.iter().for_each(|id| factors[id.index()] = factor);
    }
    let person = model.scaled(&factors);
    let mut stored = model.defaults();
    let stands = [
        ("hip_flexion_r", 0.2),
        ("hip_flexion_l", 0.05),
        ("hip_adduction_r", -0.1),
        ("knee_angle_r", 0.3),
        ("knee_angle_l", 0.25),
        ("ankle_angle_r", 0.1),
        ("mtp_angle_r", 0.05),
    ];
    for (name, angle) in stands {
        let id = model.find_coordinate(name).expect(name);
        *model.value_mut(&mut stored, id) = angle;
    }
    (model, person, stored)
}

#[test]
fn one_factor_multiplies_every_place_of_the_shipped_models() {
    let mut dice = Dice(11);
    for text in [SPINE, LEGS, ARMS, KNEE] {
        let model = read(text);
        assert_eq!(model.scaled(&vec![1.0; model.segments().len()]), model);
        let larger = model.scaled(&vec![0.7; model.segments().len()]);
        for _ in 0..40 {
            let stored: Vec<f64> = model.defaults().iter().map(|q| q + 0.4 * dice.next()).collect();
            let [before, after] = [&model, &larger].map(|m| pose(m, &stored));
            for id in model.segment_ids() {
                let root = root(&model, id);
                let seen = |pose: &Pose| {
                    let (own, from) = (pose.segment(id), pose.segment(root));
                    (own.linear, own.translation - from.translation)
                };
                let ((turn, place), (turn_after, place_after)) = (seen(&before), seen(&after));
                assert!((place_after - place * 0.7).norm() < 1e-12, "{} {id:?}", model.name());
                let off = |a: Mat3, b: Mat3| (a.x - b.x).norm() + (a.y - b.y).norm();
                assert!(off(turn, turn_after) < 1e-12, "{} {id:?}", model.name());
            }
        }
    }
}

fn root(model: &Model, id: SegmentId) -> SegmentId {
    let mut here = id;
    while let Some(parent) = model.segment(here).parent {
        here = parent;
    }
    here
}

#[test]
fn exact_markers_give_the_factors_back() {
    let (model, person, stored) = person();
    let trial = recording(&person, &stored, 1, || 0.0);
    // So weak a prior moves nothing: it pulls by 1/100² where the markers pull by 1/0.015².
    let assumed = Assumptions { group_spread: 100.0, ..Assumptions::default() };
    let scaled = fit(&model, &trial, &assumed).expect("a person");
    for (found, truth) in scaled.groups.iter().zip(TRUTH) {
        assert!((found.factor / truth - 1.0).abs() < 1e-4, "{found:?} {truth}");
    }
    assert!(scaled.rms_before > 0.005 && scaled.rms_after < 1e-5, "{scaled:?}");
    assert_eq!(scaled.warnings, []);
    lands(&scaled, &trial);
    let longest = |name: &str| scaled.groups.iter().find(|g| g.name == name).expect(name).length;
    // The ankle below the knee is 0.419 m down (491 less 72), 1.9 mm behind and 1.5 mm beside the middle of the tibia,
    // whose own joint is 23 mm to the medial side (legs.toml, parts/knee-human.toml).
    assert!((longest("shank") - Vec3::new(0.0019, 0.419, 0.0245).norm()).abs() < 1e-3);
}

#[test]
fn a_trial_scales_alike_from_trc_and_from_c3d() {
    let (model, person, stored) = person();
    let mut dice = Dice(4);
    let mut trial = recording(&person, &stored, 30, || 1e-4 * dice.normal());
    // C3D holds millimetres in 32 bits: with such numbers both files hold the same places.
    trial.units = LengthUnit::Millimetre;
    for place in trial.positions.iter_mut().filter_map(Observed::position_mut).flatten() {
        *place = LengthUnit::Millimetre.to_metres(f64::from((*place * 1e3) as f32));
    }
    let written = |ending: &str| {
        let format = Format::of_ending(ending).expect("a format");
        encode::recording(format, &trial, "static").expect("markers")
    };
    let of_trc = trc::from_bytes(&written("trc")).expect("a TRC").value;
    let of_c3d = c3d::from_bytes(&written("c3d")).expect("a C3D").value.recording;
    let assumed = Assumptions { group_spread: 100.0, ..Assumptions::default() };
    let [one, other] =
        [of_trc, of_c3d].map(|trial| fit(&model, &trial, &assumed).expect("a person"));
    assert_eq!(one.model, other.model);
    assert_eq!((&one.body, &one.groups), (&other.body, &other.groups));
    for (found, truth) in other.groups.iter().zip(TRUTH) {
        // Medians of 30 frames that are off by 0.1 mm are off by 0.02 mm: 5e-4 of the 40 mm that a foot's markers span.
        assert!((found.factor / truth - 1.0).abs() < 5e-4, "{found:?} {truth}");
    }
}

/// Every marker is where it was seen, in the posture that was found.
#[track_caller]
fn lands(scaled: &Scaled, trial: &Recording) {
    let found = places(&scaled.model, &scaled.posture);
    for (label, name) in trial.labels.iter().enumerate() {
        let index = scaled.model.markers().iter().position(|m| m.name == *name).expect(name);
        let seen = trial.position(0, label).expect("it is seen");
        assert!((found[index] - Vec3::from(seen)).norm() < 1e-12, "{name}");
    }
}

#[test]
fn noise_moves_the_factors_as_far_as_the_spread_says() {
    let (model, person, stored) = person();
    let frames = 81;
    let sigma = 0.002;
    for seed in 0..3 {
        let mut dice = Dice(seed);
        let trial = recording(&person, &stored, frames, || sigma * dice.normal());
        // A median of n normal numbers has the standard deviation √(π/2n)·σ.
        let spread = sigma * (std::f64::consts::FRAC_PI_2 / frames as f64).sqrt();
        let assumed = Assumptions {
            marker_spread: spread,
            group_spread: 100.0,
            keep_markers: true,
            ..Assumptions::default()
        };
        let scaled = fit(&model, &trial, &assumed).expect("a person");
        for (Factor { name, factor, spread, .. }, truth) in scaled.groups.iter().zip(TRUTH) {
            let off = (factor / truth).ln();
            // Four times in 15000 beyond 4 standard deviations.
            assert!(off.abs() < 4.0 * spread, "seed {seed} {name}: {off}, spread {spread}");
            assert!(*spread < 0.005, "seed {seed} {name}: {spread}");
        }
        // Kept where the larger bones have them.
        assert!(scaled.markers.iter().all(|m| m.moved == 0.0));
    }
}

/// Three rods in the world, a group each, the third without markers.
fn rods() -> (Model, Recording) {
    let mut b = ModelBuilder::new("rods");
    let along = [0.1, 0.25, 0.4];
    for (name, axis) in [("a", Vec3::X), ("b", Vec3::Y), ("c", Vec3::Z)] {
        let rod = b.segment(name, None);
        b.size_group(name, vec![rod]);
        if name != "c" {
            for (i, x) in along.iter().enumerate() {
                b.marker(&format!("{name}{i}"), Some(rod), axis * *x);
            }
        }
    }
    let model = b.build().expect("rods");
    let trial = recording(&model.scaled(&[1.2, 0.9, 1.0]), &[], 1, || 0.0);
    (model, trial)
}

#[test]
fn groups_are_drawn_to_the_body_as_far_as_the_spreads_say() {
    let (model, trial) = rods();
    let assumed = Assumptions::default();
    let scaled = fit(&model, &trial, &assumed).expect("rods");
    // A slow twin: the cost as a sum, lowered along one logarithm after the other.
    let squares: f64 = [0.1f64, 0.25, 0.4].iter().map(|x| x * x).sum();
    let cost = |x: &[f64; 4]| {
        let [s, a, b, c] = *x;
        let rod = |log: f64, truth: f64| squares * ((log.exp() - truth) / 0.015).powi(2);
        let pull = |log: f64| ((log - s) / 0.08).powi(2);
        rod(a, 1.2) + rod(b, 0.9) + pull(a) + pull(b) + pull(c)
    };
    let mut x = [0.0; 4];
    let mut step = 0.1;
    while step > 1e-10 {
        let mut better = false;
        for i in 0..4 {
            for sign in [1.0, -1.0] {
                let mut there = x;
                there[i] += sign * step;
                if cost(&there) < cost(&x) {
                    (x, better) = (there, true);
                }
            }
        }
        if !better {
            step *= 0.5;
        }
    }
    let found: Vec<&Factor> = std::iter::once(&scaled.body).chain(&scaled.groups).collect();
    for (factor, expected) in found.iter().zip(x) {
        assert!((factor.factor.ln() - expected).abs() < 1e-6, "{factor:?} {expected}");
    }
    // Without markers: the body's factor, known as well as the body's and 8 % more.
    let [body, .., third] = found[..] else { panic!("four factors") };
    assert!((body.factor - third.factor).abs() < 1e-7);
    assert!((third.spread - body.spread.hypot(0.08)).abs() < 1e-6);
}

#[test]
fn a_marker_that_means_something_else_counts_less() {
    let (model, mut trial) = rods();
    // The marker at 0.25 of the first rod was stuck on 0.3 m too far out.
    trial.positions[1] = [1.2 * 0.25 + 0.3, 0.0, 0.0].into();
    let assumed = Assumptions { group_spread: 100.0, ..Assumptions::default() };
    let scaled = fit(&model, &trial, &assumed).expect("rods");
    // Least squares in closed form, with weights (30 mm/e)^2 beyond 30 mm that are found by turns.
    let (along, seen) = ([0.1f64, 0.25, 0.4], [0.12f64, 0.6, 0.48]);
    let weighed = |weights: [f64; 3]| {
        let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| weights[i] * f(i)).sum::<f64>();
        sum(&|i| along[i] * seen[i]) / sum(&|i| along[i] * along[i])
    };
    let alike = weighed([1.0; 3]);
    let mut factor = alike;
    for _ in 0..200 {
        factor = weighed([0, 1, 2].map(|i| {
            let error = (factor * along[i] - seen[i]).abs();
            if error > 0.03 { (0.03 / error).powi(2) } else { 1.0 }
        }));
    }
    assert!((alike - 1.2).abs() > 0.3 && (factor - 1.2).abs() < 0.01, "{alike} {factor}");
    // Rounds end where no weight changes by 0.001, which moves the factor by 0.001·0.25·0.3/0.17.
    assert!((scaled.groups[0].factor - factor).abs() < 5e-4, "{:?} {factor}", scaled.groups[0]);
    let far = scaled.warnings.iter().filter(|w| w.code == "scale/far");
    assert_eq!(far.count(), 1, "{:?}", scaled.warnings);
}

#[test]
fn confidences_weigh_frames_and_markers() {
    let (model, one) = rods();
    // Five frames. The third marker of the first rod is 20 mm too far out, and half as sure; its first is wrong by a metre in
    // three frames of five, of which the reader of the estimator's file is told that they are hardly sure.
    let width = one.labels.len();
    let mut trial = Recording { times: (0..5).map(f64::from).collect(), ..one.clone() };
    trial.positions = (0..5).flat_map(|_| one.positions.clone()).collect();
    let mut confidences = vec![1.0; 5 * width];
    for frame in 0..5 {
        trial.positions[frame * width + 2] = [1.2 * 0.4 + 0.02, 0.0, 0.0].into();
        confidences[frame * width + 2] = 0.5;
        if frame < 3 {
            trial.positions[frame * width] = [1.12, 0.0, 0.0].into();
            confidences[frame * width] = 0.04;
        }
    }
    trial.confidences = Some(confidences);
    let assumed = Assumptions { group_spread: 100.0, ..Assumptions::default() };
    let scaled = fit(&model, &trial, &assumed).expect("rods");
    // Least squares with the squares of the confidences as weights. The first marker counts by the frames that are left.
    let (along, seen) = ([0.1f64, 0.25, 0.4], [0.12f64, 0.3, 0.5]);
    let weighed = |weights: [f64; 3]| {
        let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| weights[i] * f(i)).sum::<f64>();
        sum(&|i| along[i] * seen[i]) / sum(&|i| along[i] * along[i])
    };
    let (expected, alike) = (weighed([1.0, 1.0, 0.25]), weighed([1.0; 3]));
    assert!((alike - expected).abs() > 0.01);
    assert!((scaled.groups[0].factor - expected).abs() < 1e-5, "{:?} {expected}", scaled.groups[0]);
    // Sure enough to be believed of its place: a quarter is the least.
    assert!(scaled.markers.iter().all(|marker| (marker.moved - marker.error).abs() < 1e-9));
    trial.confidences.iter_mut().flatten().for_each(|c| *c = c.min(0.4));
    let unsure = fit(&model, &trial, &assumed).expect("rods");
    assert!(unsure.markers.iter().all(|marker| marker.moved == 0.0), "{:?}", unsure.markers);
}

/// Where people are seen by estimators: the man's keypoints in a posture, metres, y up.
fn seen(person: &Model, stored: &[f64]) -> impl Fn(&str) -> [f64; 3] {
    let at = places(person, stored);
    let names: Vec<String> = person.markers().iter().map(|m| m.name.clone()).collect();
    move |point: &str| {
        let name = format!("keypoint.{point}");
        at[names.iter().position(|own| *own == name).expect(point)].to_array()
    }
}

const COCO: [&str; 17] = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
];

const BODY_25: [&str; 25] = [
    "nose",
    "neck",
    "right_shoulder",
    "right_elbow",
    "right_wrist",
    "left_shoulder",
    "left_elbow",
    "left_wrist",
    "mid_hip",
    "right_hip",
    "right_knee",
    "right_ankle",
    "left_hip",
    "left_knee",
    "left_ankle",
    "right_eye",
    "left_eye",
    "right_ear",
    "left_ear",
    "left_big_toe",
    "left_small_toe",
    "left_heel",
    "right_big_toe",
    "right_small_toe",
    "right_heel",
];

/// Beside the points of COCO.
const HALPE: [&str; 9] = [
    "head_top",
    "neck",
    "mid_hip",
    "left_big_toe",
    "right_big_toe",
    "left_small_toe",
    "right_small_toe",
    "left_heel",
    "right_heel",
];

#[test]
fn keypoints_give_the_factors_of_limbs_back() {
    let human = open::model("human".as_ref()).expect("shipped").value;
    // Of the joints between which keypoints are; a taller body around them.
    let truth = [("thigh", 1.1), ("shank", 0.96), ("upper_arm", 1.08), ("forearm", 0.95)];
    let mut factors = vec![1.04; human.segments().len()];
    for group in human.size_groups() {
        if let Some((_, factor)) = truth.iter().find(|(name, _)| *name == group.name) {
            group.segments.iter().for_each(|id| factors[id.index()] = *factor);
        }
    }
    let person = human.scaled(&factors);
    let mut stored = human.defaults();
    for (name, degrees) in [
        ("elbow_flex_r", 20.0),
        ("elbow_flex_l", 15.0),
        ("shoulder_elevation_r", 25.0),
        ("shoulder_elevation_l", 20.0),
        ("knee_angle_r", 8.0),
        ("knee_angle_l", 5.0),
        ("hip_flexion_r", 6.0),
    ] {
        let id = human.find_coordinate(name).expect(name);
        *human.value_mut(&mut stored, id) = f64::to_radians(degrees);
    }
    let at = seen(&person, &stored);
    let number = |x: f64| format!("{x:?}");
    let named = COCO.map(|point| {
        let [x, y, z] = at(point);
        format!("\"{point}\": [{x:?}, {y:?}, {z:?}, 0.9]")
    });
    let coco = format!("[{{\"keypoints\": {{{}}}}}]", named.join(", "));
    let listed: Vec<String> =
        BODY_25.iter().flat_map(|point| at(point).into_iter().chain([0.9]).map(number)).collect();
    let body = format!("{{\"people\": [{{\"pose_keypoints_3d\": [{}]}}]}}", listed.join(", "));
    let halpe: Vec<&str> = COCO.into_iter().chain(HALPE).collect();
    let head =
        halpe.iter().flat_map(|p| ["x", "y", "z", "score"].map(|part| format!("{p}_{part}")));
    let cells = halpe.iter().flat_map(|p| at(p).into_iter().chain([0.9]).map(number));
    let row = |cells: Vec<String>| cells.join(",");
    let halpe = format!("{}\n{}\n", row(head.collect()), row(cells.collect()));
    let [coco, body, halpe] = [coco, body, halpe]
        .map(|text| keypoints::from_bytes(text.as_bytes()).expect("a set of keypoints").value);
    // Each set by its own layout gives the same places.
    let coco_labels: Vec<&str> = coco.labels.iter().map(String::as_str).collect();
    for (set, points) in [(&coco, &coco_labels[..]), (&body, &BODY_25[..])] {
        for (index, point) in points.iter().enumerate() {
            let other = halpe.marker(point).expect(point);
            assert_eq!(set.position(0, index), halpe.position(0, other), "{point}");
        }
    }
    assert_eq!([coco.labels.len(), body.labels.len(), halpe.labels.len()], [17, 25, 26]);
    // So weak a prior leaves limbs to their points: it draws by 1/1² to 1.04 where points draw by 1/s². Each point is known to
    // 0.015 m / 0.9, so a bone of 0.25 m between two of them to s = 0.094, both sides together to 0.067: at most 0.13·s² = 0.0006,
    // and what the man's posture terms ask for, which is measured: together 0.004.
    let assumed = Assumptions { group_spread: 1.0, ..Assumptions::default() };
    for (set, trial) in [("COCO-17", coco), ("Halpe-26", halpe)] {
        let scaled = fit(&human, &trial, &assumed).expect(set);
        for (name, factor) in truth.into_iter().chain([("pelvis", 1.04), ("trunk", 1.04)]) {
            let found = scaled.groups.iter().find(|group| group.name == name).expect(name);
            assert!((found.factor / factor - 1.0).abs() < 0.005, "{set}: {found:?} {factor}");
        }
        assert!(scaled.rms_after < 0.002, "{set}: {}", scaled.rms_after);
    }
}

#[test]
fn markers_that_move_are_left_out() {
    let (model, mut trial) = rods();
    let one = trial.positions.clone();
    trial.positions = (0..60).flat_map(|_| one.clone()).collect();
    trial.times = (0..60).map(f64::from).collect();
    for frame in 0..60 {
        // The first sways by 30 mm, the second is wrong in one frame.
        if let Some(p) = trial.positions[frame * one.len()].position_mut() {
            p[2] += [-0.03, 0.0, 0.03][frame % 3];
        }
    }
    trial.positions[1] = [3.0, 3.0, 3.0].into();
    trial.positions[one.len() + 2] = Observed::MISSING;
    // So weak a prior pulls by a hundred-millionth of what the markers do.
    let assumed = Assumptions { group_spread: 100.0, ..Assumptions::default() };
    let scaled = fit(&model, &trial, &assumed).expect("rods");
    assert_eq!(scaled.unused, ["a0"]);
    let said: Vec<&str> = scaled.warnings.iter().map(|w| w.message.as_str()).collect();
    assert_eq!(said, ["1 markers move: `a0 by 30 mm`"]);
    assert!((scaled.groups[0].factor - 1.2).abs() < 1e-6, "{:?}", scaled.groups[0]);
}

#[test]
fn what_cannot_be_scaled_is_refused() {
    let (model, trial) = rods();
    let mut few = trial.clone();
    few.labels = ["a0", "a1", "x", "y", "z", "w"].map(str::to_owned).to_vec();
    let ScaleError::TooFewMarkers { usable, moving, .. } =
        fit(&model, &few, &Assumptions::default()).expect_err("two markers")
    else {
        panic!("another error")
    };
    assert_eq!((usable, moving), (vec!["a0".to_owned(), "a1".to_owned()], vec![]));
    few.labels = ["p", "q", "x", "y", "z", "w"].map(str::to_owned).to_vec();
    let said = fit(&model, &few, &Assumptions::default()).expect_err("strangers").to_string();
    assert!(said.starts_with("model and recording share no marker"), "{said}");
    let bare = ModelBuilder::new("bare").build().expect("nothing");
    let said = fit(&bare, &trial, &Assumptions::default()).expect_err("no markers").to_string();
    assert!(said.starts_with("the model has no markers"), "{said}");
}

#[test]
fn a_wrong_unit_ends_at_a_bound_and_is_said() {
    let (model, mut trial) = rods();
    trial
        .positions
        .iter_mut()
        .filter_map(Observed::position_mut)
        .flatten()
        .for_each(|x| *x *= 1000.0);
    let scaled = fit(&model, &trial, &Assumptions::default()).expect("rods");
    assert!((scaled.body.factor - 2.0).abs() < 1e-9, "{:?}", scaled.body);
    assert!(scaled.warnings.iter().any(|w| w.code == "scale/bound"), "{:?}", scaled.warnings);
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

#[test]
fn one_factor_multiplies_every_place_of_published_models() {
    let Some(data) = data() else { return };
    let mut dice = Dice(5);
    let k = 1.2;
    let mut models = 0;
    for entry in std::fs::read_dir(data.join("models/osim")).expect("models") {
        let path = entry.expect("a model").path();
        let Ok(read) = open::model(&path) else { continue };
        let model = read.value;
        let larger = model.scaled(&vec![k; model.segments().len()]);
        // Distances between two bones are given k times as large, those in the room as they are.
        let between = |id: CoordinateId| {
            let set = model.coordinate(id).joint_set;
            let moved = model.segments().iter().filter(|s| s.joint_set == Some(set));
            model.coordinate(id).kind == CoordinateKind::Translation
                && moved.clone().count() > 0
                && moved.clone().all(|s| s.parent.is_some())
        };
        for _ in 0..10 {
            let small: Vec<f64> = model.defaults().iter().map(|q| q + 0.3 * dice.next()).collect();
            let mut large = small.clone();
            for id in model.coordinate_ids().filter(|&id| between(id)) {
                *model.value_mut(&mut large, id) *= k;
            }
            let (before, after) = (pose(&model, &small), pose(&larger, &large));
            for id in model.segment_ids() {
                let root = root(&model, id);
                let seen = |pose: &Pose| {
                    let (own, from) = (pose.segment(id), pose.segment(root));
                    let back = from.linear.transpose();
                    (back * own.linear, back * (own.translation - from.translation))
                };
                let ((turn, place), (turn_after, place_after)) = (seen(&before), seen(&after));
                let name = &model.segment(id).name;
                let off = (place_after - place * k).norm();
                assert!(off < 1e-9 * (1.0 + place.norm()), "{} {name}: {off}", path.display());
                let off = (turn.x - turn_after.x).norm() + (turn.y - turn_after.y).norm();
                assert!(off < 1e-9, "{} {name}: {off}", path.display());
            }
        }
        models += 1;
    }
    assert!(models > 15, "{models} models");
}
