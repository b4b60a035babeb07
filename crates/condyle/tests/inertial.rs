//! A public recording of inertial sensors on a swinging leg, on a public model: skipped where the
//! data are absent.

use condyle::math::{Quat, Vec3};
use condyle::motion::Orientations;
use condyle::tracking::{OrientationTarget, Rules, Stream, Targets, Tracker};
use condyle::{Mode, Pose, open};
use std::path::{Path, PathBuf};

fn data() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !path.is_dir() {
        eprintln!("skipped: {} is not there", path.display());
        return None;
    }
    Some(path)
}

/// The rotation of the femur in the pelvis in each frame, from its rotation in the first.
fn swings(in_world: &[[Quat; 2]]) -> Vec<f64> {
    let femur_in_pelvis = |[pelvis, femur]: [Quat; 2]| pelvis.conjugate() * femur;
    let first = femur_in_pelvis(in_world[0]);
    // Seen from the pelvis, so that how the sensors sit on the bones does not matter.
    in_world.iter().map(|&both| femur_in_pelvis(both).angle_to(first)).collect()
}

#[test]
fn a_leg_that_swings_turns_in_its_hip_as_its_sensors_do() {
    let Some(data) = data() else { return };
    let table = open::table(&data.join("hip/imu_RHJC_swinger.sto")).unwrap().value;
    let recording = Orientations::from_table(&table).unwrap().value;
    let model = open::model(&data.join("models/osim/Rajagopal2015.osim")).unwrap().value;
    // The sensors' world has z up, the model's y.
    let world_of_sensors = Quat::from_axis_angle(Vec3::X, -std::f64::consts::FRAC_PI_2);
    let (orientations, warnings) =
        OrientationTarget::of_recording(&model, &recording, world_of_sensors, 1e-2);
    assert_eq!((orientations.len(), warnings.len()), (recording.labels.len(), 0), "{warnings:?}");
    let names = ["pelvis", "femur_r"];
    let segments = names.map(|name| model.find_segment(name).unwrap());
    // The hip is a ball: without limits, and without the shank, which turns in more ways than its
    // hinge can follow, nothing keeps it from its sensors.
    let orientations = orientations.into_iter().filter(|t| segments.contains(&t.segment)).collect();
    let targets = Targets { orientations, ..Targets::default() };
    let tracker = Tracker::new(model, targets, Rules { limits: false, ..Rules::default() });
    let program = tracker.program().clone();
    let mut pose = Pose::new(&program);
    let mut stream = Stream::new(tracker);
    let sensors = names.map(|name| {
        recording.labels.iter().position(|label| label.starts_with(name)).expect("a sensor")
    });
    let (mut measured, mut found) = (vec![], vec![]);
    for frame in 0..recording.frames() {
        let answer = stream.next(&[]);
        assert!(answer.status.is_solved(), "frame {frame}: {:?}", answer.status);
        program.evaluate(&answer.coordinates, Mode::Open, &mut pose).unwrap();
        found.push(segments.map(|segment| Quat::from_mat3(pose.segment(segment).linear)));
        measured.push(sensors.map(|sensor| recording.rotation(frame, sensor).unwrap()));
    }
    let (measured, found) = (swings(&measured), swings(&found));
    let most = measured.iter().fold(0.0, |m: f64, x| m.max(*x)).to_degrees();
    let squares: f64 = measured.iter().zip(&found).map(|(a, b)| (a - b).powi(2)).sum();
    let rms = (squares / measured.len() as f64).sqrt().to_degrees();
    eprintln!("{} frames, the hip turns by up to {most:.1}°, RMS {rms:.2}° off", measured.len());
    assert!(most > 30.0 && rms < 0.01, "{most}, {rms}");
}

#[test]
fn a_public_file_of_quaternions_is_read_as_it_stands() {
    let Some(data) = data() else { return };
    let table = open::table(&data.join("sto/orientation_quats.sto")).unwrap().value;
    let recording = Orientations::from_table(&table).unwrap().value;
    assert_eq!((recording.labels.len(), recording.rate), (7, 100.0));
    assert_eq!(recording.labels[0], "pelvis_imu");
    // The file's first cell: w, x, y, z of the pelvis.
    let [w, x, y, z] =
        [0.5064886386335554, 0.4915562864138964, -0.5355653906346357, 0.4636932052300068];
    let read = recording.rotation(0, 0).unwrap();
    assert!(read.angle_to(Quat::from([x, y, z, w])) < 1e-12, "{read:?}");
}
