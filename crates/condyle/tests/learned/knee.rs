//! A knee with seven skin markers: calibrated from a standing trial, tracked with six degrees of freedom, learned back.

use condyle::learn::calibration::FreeJoint;
use condyle::learn::coupling::{Groups, LawFunction, Samples, Settings, apply, learn};
use condyle::math::function::FunctionOfSeveral;
use condyle::tracking::{Request, track};
use condyle::{Mode, Model, Motion, Observed, Recording};

/// The markers of a person who stands, in metres: y up, x forward, z right; rolled so that no axis is the laboratory's.
fn standing() -> Recording {
    let markers = [
        ("RGT", [0.02, 0.90, 0.17]),
        ("RLFE", [0.01, 0.48, 0.14]),
        ("RMFE", [0.00, 0.47, 0.05]),
        ("RTT", [0.06, 0.41, 0.10]),
        ("RFH", [-0.03, 0.42, 0.15]),
        ("RMEDMAL", [-0.01, 0.08, 0.06]),
        ("RLATMAL", [-0.03, 0.07, 0.13]),
    ];
    Recording {
        labels: markers.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rate: 100.0,
        times: vec![0.0, 0.01],
        positions: (0..2)
            .flat_map(|_| markers.iter().map(|(_, place)| Observed::from(*place)))
            .collect(),
        ..Recording::default()
    }
}

/// Metres per radian of flexion, adduction, rotation: as large as in Table 1 of Pronost et al. 2010.
const SLOPES: [[f64; 3]; 3] =
    [[0.035, -0.01, 0.006], [0.008, 0.012, -0.004], [0.004, 0.006, 0.015]];
const ANGLES: [&str; 3] = ["knee_r_flexion", "knee_r_adduction", "knee_r_rotation"];
const PLACES: [&str; 3] = ["knee_r_tx", "knee_r_ty", "knee_r_tz"];

/// The knee whose centre travels: laws about where it is while the person stands.
fn true_knee(free: &Model) -> Model {
    let functions: Vec<LawFunction> = PLACES
        .iter()
        .zip(SLOPES)
        .map(|(place, slopes)| {
            let id = free.find_coordinate(place).unwrap();
            let intercept = free.coordinate(id).default[0];
            LawFunction::Several(FunctionOfSeveral::Linear { slopes: slopes.to_vec(), intercept })
        })
        .collect();
    let laws: Vec<(&str, &LawFunction)> = PLACES.iter().copied().zip(&functions).collect();
    apply(free, &ANGLES.map(str::to_owned), None, &laws).unwrap()
}

/// A gait of the true knee, with markers that are off by a sine of their own, so many metres.
fn gait(knee: &Model, trial: usize, artefact: f64) -> Recording {
    let mut motion = Motion::default();
    for frame in 0..80 {
        let t = 0.08 * frame as f64 + trial as f64;
        let mut stored = knee.defaults();
        let mut set = |name: &str, value: f64| {
            let id = knee.find_coordinate(name).unwrap();
            *knee.value_mut(&mut stored, id) += value;
        };
        set("thigh_r_tx", 0.01 * frame as f64);
        set("thigh_r_rz", 0.3 * t.sin());
        set("thigh_r_rx", 0.05 * (1.1 * t).cos());
        set(ANGLES[0], -0.5 - 0.45 * (t + 0.6).sin());
        set(ANGLES[1], 0.06 * (1.9 * t).sin());
        set(ANGLES[2], 0.1 * (2.3 * t).cos());
        motion.times.push(0.01 * frame as f64);
        motion.frames.push(stored);
    }
    let mut recording = motion.virtual_markers(knee, Mode::Open).unwrap();
    let width = recording.labels.len();
    for (place, position) in recording.positions.iter_mut().enumerate() {
        let (frame, marker) = (place / width, place % width);
        if let Some(position) = position.position_mut() {
            for (axis, x) in position.iter_mut().enumerate() {
                let own = 3.7 * marker as f64 + 1.3 * axis as f64 + 11.0 * trial as f64;
                *x += artefact * (0.37 * frame as f64 + own).sin();
            }
        }
    }
    recording
}

#[test]
fn slopes_come_back_from_markers() {
    let free = FreeJoint::knee_pronost2010().model(&standing()).unwrap();
    // While the person stands all angles are 0, and the centre is between the epicondyles.
    for angle in ANGLES {
        let default = free.coordinate(free.find_coordinate(angle).unwrap()).default[0];
        assert!(default.abs() < 1e-12, "{angle}: {default}");
    }
    let knee = true_knee(&free);
    let columns: Vec<String> = ANGLES.iter().chain(&PLACES).map(|c| (*c).to_owned()).collect();
    // No artefact, and 2 mm of one; the issue asks for 10 % without.
    for (artefact, most) in [(0.0, 1e-6), (0.002, 0.1)] {
        let mut samples = Samples { columns: columns.clone(), trials: vec![] };
        for trial in 0..6 {
            let recording = gait(&knee, trial, artefact);
            let tracking = track(&free, &recording, &Request::default(), &mut |_, _| {}).unwrap();
            let rows: Vec<f64> = (0..tracking.answers.len())
                .flat_map(|frame| {
                    let stored = tracking.answers.coordinates(frame);
                    let value =
                        |name: &String| free.value(stored, free.find_coordinate(name).unwrap());
                    columns.iter().map(value).collect::<Vec<_>>()
                })
                .collect();
            samples.add(&format!("gait_{trial}"), Groups::of_name("gait"), &rows, 0);
        }
        let laws = learn(&samples, &[], &[0, 1, 2], &[3, 4, 5], &Settings::default()).unwrap();
        for (law, slopes) in laws.laws.iter().zip(SLOPES) {
            // The slope of flexion is the one that moves the centre by centimetres.
            let relative = (law.coefficients[0] / slopes[0] - 1.0).abs();
            let absolute = (law.coefficients[0] - slopes[0]).abs();
            let holds = relative < most || absolute < 0.04 * artefact.max(1e-6);
            println!("{artefact} {}: {:?} for {slopes:?}", law.dependent, law.coefficients);
            if artefact == 0.0 {
                for (found, truth) in law.coefficients.iter().zip(slopes) {
                    assert!((found / truth - 1.0).abs() < 0.1, "{found} for {truth}");
                }
            }
            assert!(holds || law.dependent != PLACES[0], "{relative} of {}", law.dependent);
            assert!(artefact > 0.0 || law.accepted());
        }
    }
}

#[test]
fn a_missing_landmark_is_told() {
    let mut short = standing();
    short.labels[1] = "LFE".to_owned();
    let error = FreeJoint::knee_pronost2010().model(&short).unwrap_err().to_string();
    assert!(error.contains("shows no `RLFE`"), "{error}");
}
