//! What a tracking says of its own trustworthiness, on generated data: angles beyond a range that is a
//! circle, coordinates that nothing determines, markers that are never seen.

use condyle::formats::{Format, sto};
use condyle::math::Vec3;
use condyle::tracking::{JumpCause, Request, Tracking, track};
use condyle::{Mode, Model, ModelBuilder, Motion, Observed, Range, Recording};
use condyle::{check, encode};
use std::f64::consts::PI;

/// An arm that turns about z, and a hand that turns about it, each with three markers.
fn arm() -> Model {
    let mut b = ModelBuilder::new("arm");
    let arm = b.segment("arm", None);
    let (_, turn) = b.hinge("shoulder", arm, "turn", Vec3::Z);
    // As files give it.
    b.coordinate_mut(turn).range = Range::new(-PI, PI);
    let hand = b.segment("hand", Some(arm));
    b.place_joint(hand, Vec3::new(0.6, 0.0, 0.0));
    b.hinge("wrist", hand, "bend", Vec3::Y);
    for (side, segment) in [("arm", arm), ("hand", hand)] {
        for (name, at) in [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)] {
            b.marker(&format!("{side}_{name}"), Some(segment), at * 0.1);
        }
    }
    b.build().unwrap()
}

/// What is seen of a motion of both angles; some markers are missing in some frames.
fn seen(
    frames: usize,
    angles: impl Fn(usize) -> [f64; 2],
    hidden: impl Fn(usize, &str) -> bool,
) -> Recording {
    let motion = Motion {
        times: (0..frames).map(|frame| frame as f64 / 100.0).collect(),
        frames: (0..frames).map(|frame| angles(frame).to_vec()).collect(),
    };
    let mut recording = motion.virtual_markers(&arm(), Mode::Open).unwrap();
    let width = recording.labels.len();
    for (place, seen) in recording.positions.iter_mut().enumerate() {
        if hidden(place / width, &recording.labels[place % width]) {
            *seen = Observed::MISSING;
        }
    }
    recording
}

fn tracked(recording: &Recording, request: &Request) -> Tracking {
    track(&arm(), recording, request, &mut |_, _| {}).unwrap()
}

fn value<'a>(remarks: &'a [(String, String)], key: &str) -> Option<&'a str> {
    remarks.iter().find(|(k, _)| k == key).map(|(_, value)| &**value)
}

#[test]
fn an_angle_beyond_a_circle_is_said_and_no_check_finds_fault_with_it() {
    // From 0 to 5 rad in steps of 0.05: past π, by more than a half turn.
    let recording = seen(101, |frame| [0.05 * frame as f64, 0.2], |_, _| false);
    let tracking = tracked(&recording, &Request::default());
    let model = arm();
    let report = tracking.report(&model);
    let [beyond] = &report.beyond_range[..] else { panic!("{:?}", report.beyond_range) };
    assert_eq!((&*beyond.coordinate, beyond.range), ("turn", [-PI, PI]));
    assert!((beyond.values[1] - 5.0).abs() < 1e-4, "{:?}", beyond.values);
    // 3.15 is frame 63.
    assert_eq!(beyond.frames, 101 - 63);
    assert!(tracking.at_limits(&model).is_empty());
    assert!(report.mostly_at_limit.is_empty() && report.jumps.is_empty());
    let remarks = tracking.remarks(&model);
    assert_eq!(
        remarks,
        [("beyond_range".to_owned(), value(&remarks, "beyond_range").unwrap().to_owned())]
    );
    let said = value(&remarks, "beyond_range").unwrap();
    // 5 rad are 286.5 degrees.
    assert!(said.starts_with("turn (0 to 286.5 deg; range -180 to 180 deg"), "{said}");
    let format = Format::of_ending("mot").unwrap();
    let bytes =
        encode::motion(format, &model, &tracking.motion(), "walk", None, &remarks).unwrap().value;
    let read = sto::from_bytes(&bytes).unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    assert_eq!(read.value.header_value("beyond_range"), Some(said));
    let checked = check::motion::check(&model, &read.value);
    assert!(checked.holds(), "{:?}", checked.findings);
    // A CSV is read by programs that know no comments.
    let csv = Format::of_ending("csv").unwrap();
    let bytes = encode::motion(csv, &model, &tracking.motion(), "walk", None, &remarks).unwrap();
    assert!(bytes.value.starts_with(b"time,turn,bend\n"));
}

#[test]
fn markers_that_no_frame_shows_are_left_out_and_named() {
    let hidden = |_, label: &str| label.starts_with("hand");
    let recording = seen(20, |frame| [0.01 * frame as f64, 0.2], hidden);
    let weights = vec![("arm_z".to_owned(), 0.0)];
    let tracking = tracked(&recording, &Request { weights, ..Request::default() });
    assert_eq!(tracking.markers, ["arm_x", "arm_y"]);
    assert_eq!(tracking.unused.never_seen, ["hand_x", "hand_y", "hand_z"]);
    assert_eq!(tracking.unused.without_weight, ["arm_z"]);
    let model = arm();
    assert_eq!(tracking.report(&model).unmoved, ["bend"]);
    let remarks = tracking.remarks(&model);
    assert_eq!(value(&remarks, "no_marker_moves"), Some("bend"));
    assert_eq!(value(&remarks, "not_determined"), None);
}

#[test]
fn a_time_range_decides_what_is_never_seen() {
    let hidden = |frame: usize, label: &str| label == "hand_x" && frame < 10;
    let recording = seen(20, |frame| [0.01 * frame as f64, 0.2], hidden);
    let in_time = |range| {
        let tracking = tracked(&recording, &Request { time_range: range, ..Request::default() });
        tracking.unused.never_seen
    };
    assert!(in_time(None).is_empty());
    assert_eq!(in_time(Some([0.0, 0.095])), ["hand_x"]);
}

#[test]
fn a_recording_that_shows_nothing_has_frames_without_markers() {
    let recording = seen(3, |_| [0.1, 0.2], |_, _| true);
    let tracking = tracked(&recording, &Request::default());
    assert_eq!(tracking.summary().failed.len(), 3);
    assert!(tracking.unused.never_seen.is_empty());
}

#[test]
fn a_coordinate_that_loses_its_markers_for_a_while_is_named_with_its_shares() {
    // The hand is hidden in 40 of 100 frames, in which it rests at 0, and is at 1.6 rad afterwards.
    let hidden = |frame: usize, label: &str| label.starts_with("hand") && (30..70).contains(&frame);
    let bend = |frame: usize| if frame < 50 { 0.1 } else { 1.6 };
    let recording = seen(100, |frame| [0.01 * frame as f64, bend(frame)], hidden);
    let tracking = tracked(&recording, &Request::default());
    let model = arm();
    let remarks = tracking.remarks(&model);
    assert_eq!(value(&remarks, "not_determined"), Some("bend (held 40 %)"));
    let [jump] = &tracking.jumps[..] else { panic!("{:?}", tracking.jumps) };
    assert_eq!((jump.frame, &*jump.segment), (70, "hand"));
    // The arm has turned by 0.01 rad about another axis meanwhile.
    assert!((jump.turn - 1.6).abs() < 0.01, "{jump}");
    let labels = ["hand_x", "hand_y", "hand_z"].map(str::to_owned).to_vec();
    assert_eq!(jump.cause, JumpCause::Missing(labels));
}
