//! A motion that leaves the limits of the target and comes back.

use crate::{angle, carried, places};
use condyle::model::CoordinateKind;
use condyle::retargeting::Options;
use condyle::{Mode, Model, Motion, Pose, Program, open};
use std::f64::consts::TAU;

/// The man's own motion: limbs swing, and in the middle elbow, knee, forearm and foot turn further than anyone's.
fn motion(model: &Model) -> Motion {
    // Name, middle, swing, and what is added at the worst; degrees.
    let moved = [
        ("shoulder_elevation_r", 60.0, 20.0, 120.0),
        ("shoulder_plane_r", 40.0, 10.0, 0.0),
        ("elbow_flex_r", 70.0, 20.0, -130.0),
        ("pro_sup_r", 90.0, 15.0, 190.0),
        ("shoulder_elevation_l", 50.0, 20.0, 0.0),
        ("shoulder_plane_l", 30.0, 10.0, 0.0),
        ("elbow_flex_l", 60.0, 20.0, 0.0),
        ("pro_sup_l", 90.0, 10.0, 0.0),
        ("hip_flexion_l", 20.0, 20.0, 0.0),
        ("hip_flexion_r", 20.0, -20.0, 0.0),
        ("knee_angle_l", 40.0, 15.0, -110.0),
        ("knee_angle_r", 40.0, -15.0, 0.0),
        ("ankle_angle_l", 0.0, 8.0, 0.0),
        ("subtalar_angle_l", 5.0, 5.0, 90.0),
    ];
    let mut motion = Motion::default();
    for frame in 0..120 {
        let t = f64::from(frame) / 60.0;
        // From 0.5 s to 1.1 s, 1 at its middle.
        let worst = match (t - 0.5) / 0.6 {
            share if (0.0..1.0).contains(&share) => (std::f64::consts::PI * share).sin().powi(2),
            _ => 0.0,
        };
        let mut stored = model.defaults();
        for (number, (name, middle, swing, more)) in moved.iter().enumerate() {
            let id = model.find_coordinate(name).unwrap();
            let degrees: f64 = middle + swing * (4.0 * t + number as f64).sin() + more * worst;
            *model.value_mut(&mut stored, id) = degrees.to_radians();
        }
        motion.times.push(t);
        motion.frames.push(stored);
    }
    motion
}

/// Without whole turns: the free answer may have gone round.
fn unwound(model: &Model, stored: &[f64]) -> Vec<f64> {
    let mut stored = stored.to_vec();
    for id in model.coordinate_ids() {
        if model.coordinate(id).kind == CoordinateKind::Rotation {
            let value = model.value_mut(&mut stored, id);
            *value -= (*value / TAU).round() * TAU;
        }
    }
    stored
}

/// Compares the answers with and without limits in the frames in which the free one keeps to them: how many of these are
/// before the first that does not, how many do not, and how many are after it.
fn compared(human: &Model, source: &Motion) -> [usize; 3] {
    let [free, held] = [false, true].map(|limits| {
        carried(human, source, human, Options { limits, ..Options::default() }).motion
    });
    let program = Program::compile(human);
    let mut pose = Pose::new(&program);
    let mut legal = |stored: &[f64]| {
        program.evaluate(&unwound(human, stored), Mode::Open, &mut pose).unwrap();
        let inside = human.coordinate_ids().all(|id| {
            let (lower, upper) = human.coordinate(id).range.bounds();
            human.stored_range(id).len() != 1
                || (lower - 1e-6..=upper + 1e-6).contains(&human.value(pose.effective(), id))
        });
        inside && (0..program.limit_row_len()).all(|row| pose.limit_row(row) > -1e-6)
    };
    let bones = ["humerus", "ulna", "hand", "femur", "tibia", "talus"];
    let segments: Vec<usize> = ["l", "r"]
        .iter()
        .flat_map(|side| bones.map(|bone| format!("{bone}_{side}")))
        .map(|name| human.find_segment(&name).unwrap().index())
        .collect();
    let (a, b) = (places(human, &free), places(human, &held));
    let mut counts = [0; 3];
    for (frame, stored) in free.frames.iter().enumerate() {
        if !legal(stored) {
            counts[1] += 1;
            continue;
        }
        counts[if counts[1] == 0 { 0 } else { 2 }] += 1;
        for side in segments.chunks(bones.len()) {
            for pair in side.windows(2) {
                let [free, held] = [&a[frame], &b[frame]].map(|all| all[pair[1]] - all[pair[0]]);
                let off = angle(free, held);
                assert!(off < 0.5, "frame {frame}, from segment {}: {off} degrees", pair[0]);
            }
        }
    }
    counts
}

#[test]
fn a_motion_that_comes_back_inside_its_limits_is_followed_again() {
    let human = open::model("human".as_ref()).unwrap().value;
    let [before, outside, after] = compared(&human, &motion(&human));
    // Bumps last from frame 30 to 66; their first and last frames are still inside.
    assert!(before >= 25 && outside >= 15 && after >= 40, "{before} {outside} {after}");
}

#[test]
fn a_motion_that_comes_back_at_the_other_end_of_a_range_is_followed_there() {
    // The arm hangs, ten degrees from the body, and goes round: by 190 degrees of its plane of elevation, of which those
    // from 150 to 210 are outside; 210 is -150 again. Where it begins is on the other side of hanging than where the
    // defaults lead, and an arm that hangs is at a bound and has no plane.
    let human = open::model("human".as_ref()).unwrap().value;
    let mut source = Motion::default();
    for frame in 0..100 {
        let t = f64::from(frame) / 60.0;
        let mut stored = human.defaults();
        let round = 190.0 * (1.2 * t - 0.5).clamp(0.0, 1.0);
        for (name, degrees) in [
            ("shoulder_elevation_r", 10.0),
            ("shoulder_plane_r", 100.0 + round),
            ("shoulder_rotation_r", -20.0),
            ("elbow_flex_r", 60.0),
            ("pro_sup_r", 90.0),
            ("shoulder_elevation_l", 20.0),
            ("elbow_flex_l", 60.0),
            ("pro_sup_l", 90.0),
            ("hip_flexion_l", 20.0),
            ("hip_flexion_r", 20.0),
            ("knee_angle_l", 30.0),
            ("knee_angle_r", 30.0),
        ] {
            let id = human.find_coordinate(name).unwrap();
            *human.value_mut(&mut stored, id) = f64::to_radians(degrees);
        }
        source.times.push(t);
        source.frames.push(stored);
    }
    let [before, outside, after] = compared(&human, &source);
    assert!(before >= 25 && outside >= 5 && after >= 25, "{before} {outside} {after}");
}

#[test]
fn an_elbow_that_goes_all_the_way_round_is_followed_where_it_comes_back() {
    // No elbow does that; a limb that is led frame by frame stops at the end of its range and stays there when
    // the motion comes in at the other end: what the motion is without limits shows the way.
    let human = open::model("human".as_ref()).unwrap().value;
    let mut source = Motion::default();
    for frame in 0..80 {
        let mut stored = human.defaults();
        // Between frames 15 and 55.
        let share = ((f64::from(frame) - 15.0) / 40.0).clamp(0.0, 1.0);
        for (name, degrees) in [
            ("shoulder_elevation_r", 50.0),
            ("shoulder_plane_r", 40.0),
            ("shoulder_rotation_r", -10.0),
            ("elbow_flex_r", 70.0),
            ("pro_sup_r", 80.0),
            ("shoulder_elevation_l", 20.0),
            ("elbow_flex_l", 60.0),
            ("pro_sup_l", 90.0),
            ("hip_flexion_l", 20.0),
            ("hip_flexion_r", 20.0),
            ("knee_angle_l", 30.0),
            ("knee_angle_r", 30.0),
        ] {
            let id = human.find_coordinate(name).unwrap();
            let whole = if name == "elbow_flex_r" { 360.0 * share } else { 0.0 };
            *human.value_mut(&mut stored, id) = f64::to_radians(degrees + whole);
        }
        source.times.push(f64::from(frame) / 60.0);
        source.frames.push(stored);
    }
    let [before, outside, after] = compared(&human, &source);
    assert!(before >= 15 && outside >= 10 && after >= 25, "{before} {outside} {after}");
}
