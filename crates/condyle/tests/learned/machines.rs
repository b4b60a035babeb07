//! Screw and bolt, a pair of gears, a bow compass (Pronost et al. 2010, 4.3): their markers are anywhere on them, their axes
//! oblique to all frames and unknown. What is learned back is known to 1e-9.

use condyle::formats::document::goals;
use condyle::learn::calibration::{Cluster, Screw};
use condyle::learn::coupling::{Groups, LawFunction, Laws, Samples, Settings, apply, learn};
use condyle::math::{Affine, Quat, Vec3};
use condyle::{CoordinateKind, ModelBuilder, Observed, Recording, posing};

/// A turn about an oblique line through a point, and a step along it.
fn about(axis: Vec3, through: Vec3, angle: f64, along: f64) -> Affine {
    let axis = axis.normalized();
    let turn = Affine::from_rotation(Quat::from_axis_angle(axis, angle).to_mat3());
    Affine::from_translation(through + axis * along) * turn * Affine::from_translation(-through)
}

/// A frame that lies anyhow.
fn anyhow(seed: f64) -> Affine {
    let turn = Quat::exp(Vec3::new(seed.sin(), (2.0 * seed).cos(), (3.0 * seed).sin()) * 1.3);
    let place = Vec3::new((5.0 * seed).cos(), (7.0 * seed).sin(), 0.3 * seed.cos());
    Affine::from_translation(place) * Affine::from_rotation(turn.to_mat3())
}

/// The markers of bodies whose places in the laboratory are given frame by frame; those of a body lie anywhere on it.
fn recorded(bodies: &[Vec<Affine>]) -> Recording {
    let marker = |body: usize, k: usize| {
        let t = 1.7 * body as f64 + 2.3 * k as f64;
        Vec3::new(0.08 * t.sin(), 0.06 * (1.9 * t).cos(), 0.07 * (2.7 * t + 1.0).sin())
    };
    let frames = bodies[0].len();
    let labels = (0..bodies.len()).flat_map(|body| (0..4).map(move |k| format!("{body}-{k}")));
    let mut positions = vec![];
    for frame in 0..frames {
        for (body, places) in bodies.iter().enumerate() {
            positions.extend(
                (0..4).map(|k| Observed::from((places[frame] * marker(body, k)).to_array())),
            );
        }
    }
    Recording {
        labels: labels.collect(),
        rate: 100.0,
        times: (0..frames).map(|frame| 0.01 * frame as f64).collect(),
        positions,
        ..Recording::default()
    }
}

/// How one body moves in another, by their markers alone: clusters as they are in the first frame.
fn relative(recording: &Recording, child: usize, parent: usize) -> Vec<Affine> {
    let first = Recording {
        times: recording.times[..1].to_vec(),
        positions: recording.positions[..recording.labels.len()].to_vec(),
        ..recording.clone()
    };
    let cluster = |body: usize| {
        let labels: Vec<String> = (0..4).map(|k| format!("{body}-{k}")).collect();
        Cluster::standing(&first, &labels.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let (child, parent) = (cluster(child), cluster(parent));
    (0..recording.frames())
        .map(|frame| {
            let [child, parent] = [&child, &parent].map(|c| c.pose(recording, frame).unwrap().0);
            parent.rigid_inverse() * child
        })
        .collect()
}

/// Laws of columns over three trials; the first column controls.
fn laws(columns: &[&str], trials: &[Vec<Vec<f64>>]) -> Laws {
    let names = columns.iter().map(|c| (*c).to_owned()).collect();
    let mut samples = Samples { columns: names, trials: vec![] };
    for (number, trial) in trials.iter().enumerate() {
        let rows: Vec<f64> =
            (0..trial[0].len()).flat_map(|row| trial.iter().map(move |c| c[row])).collect();
        samples.add(&format!("turn_{number}"), Groups::of_name("turn"), &rows, 0);
    }
    let follow: Vec<usize> = (1..columns.len()).collect();
    learn(&samples, &[], &[0], &follow, &Settings::default()).unwrap()
}

/// What is turned in a trial, in radians from its first frame.
fn turned(trial: usize) -> Vec<f64> {
    (0..60).map(|i| f64::from(i) * (0.05 + 0.02 * trial as f64)).collect()
}

#[test]
fn the_pitch_of_a_screw() {
    let pitch = 0.00175 / std::f64::consts::TAU;
    let axis = Vec3::new(0.3, -0.8, 0.52);
    let trials: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|trial| {
            let angles = turned(trial);
            // The screw itself is carried about.
            let screw: Vec<Affine> =
                (0..angles.len()).map(|i| anyhow(0.01 * i as f64 + trial as f64)).collect();
            let bolt = screw.iter().zip(&angles).map(|(screw, angle)| {
                *screw * about(axis, Vec3::new(0.1, 0.2, -0.3), *angle, pitch * angle) * anyhow(0.4)
            });
            let recording = recorded(&[screw.clone(), bolt.collect()]);
            let found = Screw::of(&relative(&recording, 1, 0)).unwrap();
            assert!(found.rms < 1e-12 && found.wobble < 1e-12, "{found:?}");
            vec![found.angles, found.slides]
        })
        .collect();
    let laws = laws(&["turn", "along"], &trials);
    let found = laws.laws[0].coefficients[0];
    // The direction of the axis, and with it the signs of both, is free; their ratio is not.
    assert!((found - pitch).abs() < 1e-9 * 1.0 && (found / pitch - 1.0).abs() < 1e-9, "{found}");
    assert!(laws.laws[0].accepted());
}

#[test]
fn the_ratio_of_gears() {
    let ratio = -17.0 / 41.0;
    let axes = [Vec3::new(0.2, 0.9, -0.1), Vec3::new(-0.7, 0.4, 0.6)];
    let centres = [Vec3::new(0.05, 0.0, 0.1), Vec3::new(-0.1, 0.2, 0.0)];
    let trials: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|trial| {
            let angles = turned(trial);
            let case: Vec<Affine> = (0..angles.len()).map(|i| anyhow(0.02 * i as f64)).collect();
            let gear = |k: usize, ratio: f64| -> Vec<Affine> {
                let both = case.iter().zip(&angles);
                both.map(|(case, angle)| {
                    *case * about(axes[k], centres[k], ratio * angle, 0.0) * anyhow(k as f64 + 0.3)
                })
                .collect()
            };
            let recording = recorded(&[case.clone(), gear(0, 1.0), gear(1, ratio)]);
            [1, 2]
                .map(|gear| {
                    let found = Screw::of(&relative(&recording, gear, 0)).unwrap();
                    assert!(found.slides.iter().all(|s| (s - found.slides[0]).abs() < 1e-12));
                    // The sign of an axis is a convention; the frames of clusters are those of the laboratory in frame 0.
                    let way = (case[0].linear * axes[gear - 1]).dot(found.axis_in_parent);
                    found.angles.iter().map(|angle| angle * way.signum()).collect()
                })
                .to_vec()
        })
        .collect();
    let laws = laws(&["powered", "next"], &trials);
    let found = laws.laws[0].coefficients[0];
    assert!((found - ratio).abs() < 1e-9, "{found}");
    assert!(laws.laws[0].intercept.abs() < 1e-9);
}

/// The wheel's turn drives both legs, the rod, and the wheel's own way along the rod; then the leg distance is solved for by
/// turning the wheel.
#[test]
fn the_bow_compass() {
    let [leg_1, leg_2, rod, along, offset] = [0.031, -0.029, -0.007, 0.0007, 0.012];
    let hinge = Vec3::new(0.2, 0.5, 0.84).normalized();
    let shift = Vec3::new(0.03, -0.02, 0.01);
    let trials: Vec<Vec<Vec<f64>>> = (0..3)
        .map(|trial| {
            let wheel = turned(trial);
            let head: Vec<Affine> = (0..wheel.len()).map(|i| anyhow(0.013 * i as f64)).collect();
            let body = |axis: Vec3, of: f64, slide: [f64; 2], seed: f64| -> Vec<Affine> {
                let both = head.iter().zip(&wheel);
                both.map(|(head, r)| {
                    *head * about(axis, shift, of * r, slide[0] * r + slide[1]) * anyhow(seed)
                })
                .collect()
            };
            let bodies = [
                head.clone(),
                body(Vec3::new(0.9, -0.1, 0.3), 1.0, [along, offset], 0.1),
                body(hinge, leg_1, [0.0; 2], 0.2),
                body(hinge, leg_2, [0.0; 2], 0.3),
                body(Vec3::new(-0.2, 0.95, 0.1), rod, [0.0; 2], 0.4),
            ];
            let recording = recorded(&bodies);
            let axes = [Vec3::new(0.9, -0.1, 0.3), hinge, hinge, Vec3::new(-0.2, 0.95, 0.1)];
            let found: Vec<(Screw, f64)> = (1..5)
                .map(|k| {
                    let screw = Screw::of(&relative(&recording, k, 0)).unwrap();
                    let way = (head[0].linear * axes[k - 1]).dot(screw.axis_in_parent).signum();
                    (screw, way)
                })
                .collect();
            let turn = |k: usize| -> Vec<f64> {
                found[k].0.angles.iter().map(|angle| angle * found[k].1).collect()
            };
            let way = &found[0];
            let first = way.0.slides[0];
            let slide = way.0.slides.iter().map(|s| (s - first) * way.1 + offset).collect();
            vec![turn(0), turn(1), turn(2), turn(3), slide]
        })
        .collect();
    let laws = laws(&["R", "leg_1", "leg_2", "rod", "T"], &trials);
    for (law, truth) in laws.laws.iter().zip([leg_1, leg_2, rod, along]) {
        assert!(
            (law.coefficients[0] - truth).abs() < 1e-9,
            "{}: {}",
            law.dependent,
            law.coefficients[0]
        );
    }
    assert!((laws.laws[3].intercept - offset).abs() < 1e-9);
    // The compass as a model: legs of 0.15 m, closed where both angles are 0.
    let mut b = ModelBuilder::new("compass");
    let set = b.joint_set("compass");
    let wheel = b.coordinate(set, "R", CoordinateKind::Rotation);
    for (k, name) in ["leg_1", "leg_2"].into_iter().enumerate() {
        let leg = b.segment(name, None);
        let angle = b.coordinate(set, name, CoordinateKind::Rotation);
        let turn = b.rotate(set, &format!("{name}_turn"), angle, Vec3::Z);
        b.output(set, leg, turn);
        b.marker(["tip_1", "tip_2"][k], Some(leg), Vec3::new(0.0, -0.15, 0.0));
    }
    let free = b.build().unwrap();
    let functions: Vec<(&str, &LawFunction)> =
        laws.laws[..2].iter().map(|law| (law.dependent.as_str(), &law.function)).collect();
    let compass = apply(&free, &laws.controls, Some(&laws.region), &functions).unwrap();
    let asked = 0.06;
    let text = format!(
        "condyle = 1\nkind = \"goals\"\n[distance.tips]\npoints = [\"tip_1\", \"tip_2\"]\ndistance = {asked}\n"
    );
    let list = goals::read(&text, &mut |_| Err("it stands alone".into())).unwrap().value;
    // From the middle of what was turned: at 0 the legs are closed, where both ways are alike.
    let mut rest = compass.defaults();
    *compass.value_mut(&mut rest, wheel) = 3.0;
    let posed = posing::pose(&compass, &list, Some(&rest)).unwrap();
    assert!(posed.answer.is_met());
    // 2 L sin((α₁ - α₂)·R/2) = d.
    let analytic = 2.0 * (asked / 0.3f64).asin() / (leg_1 - leg_2);
    let solved = compass.value(&posed.answer.coordinates, wheel);
    assert!((solved - analytic).abs() < 1e-6 * analytic, "{solved}, {analytic}");
}
