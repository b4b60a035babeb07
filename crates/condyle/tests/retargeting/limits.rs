//! A motion that leaves the limits of the target and comes back.

use crate::{angle, carried, places};
use condyle::retargeting::Options;
use condyle::{Mode, Model, Motion, Pose, Program, open};

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

#[test]
fn a_motion_that_comes_back_inside_its_limits_is_followed_again() {
    let human = open::model("human".as_ref()).unwrap().value;
    let source = motion(&human);
    let [free, held] = [false, true].map(|limits| {
        carried(&human, &source, &human, Options { limits, ..Options::default() }).motion
    });
    let program = Program::compile(&human);
    let mut pose = Pose::new(&program);
    let mut legal = |stored: &[f64]| {
        program.evaluate(stored, Mode::Open, &mut pose).unwrap();
        let inside = human.coordinate_ids().all(|id| {
            let (lower, upper) = human.coordinate(id).range.bounds();
            let place = human.stored_range(id);
            // Fingers, which nothing asks for, rest at their bounds.
            place.len() != 1
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
    let (a, b) = (places(&human, &free), places(&human, &held));
    let (mut before, mut outside, mut after) = (0, 0, 0);
    for (frame, stored) in free.frames.iter().enumerate() {
        if !legal(stored) {
            outside += 1;
            continue;
        }
        if outside == 0 {
            before += 1
        } else {
            after += 1
        }
        for pair in segments.windows(2).filter(|pair| pair[1] != segments[bones.len()]) {
            let [free, held] = [&a[frame], &b[frame]].map(|all| all[pair[1]] - all[pair[0]]);
            let off = angle(free, held);
            assert!(off < 0.5, "frame {frame}, from segment {}: {off} degrees", pair[0]);
        }
    }
    // Bumps last from frame 30 to 66; their first and last frames are still inside.
    assert!(before >= 25 && outside >= 15 && after >= 40, "{before} {outside} {after}");
}
