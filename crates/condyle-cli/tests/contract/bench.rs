//! `condyle bench`.

use super::{Folder, leg, number};

#[test]
fn counts_are_the_models_and_times_are_plausible() {
    let folder = Folder::with_leg("bench");
    let answer = folder.condyle(&["bench", "leg.osim", "--json"]).json();
    // thigh, shank, foot and toes.
    assert_eq!(answer["segments"], 4);
    // Twelve numbers of eight bytes for every segment at the least.
    assert!(number(&answer["bytes_per_pose"]) >= 4.0 * 12.0 * 8.0);
    // No machine poses four segments in less than one multiplication or more than a millisecond.
    for key in ["pose_ns", "batched_pose_ns", "pose_with_jacobian_ns"] {
        assert!((0.3..1e6).contains(&number(&answer[key])), "{key}: {}", answer[key]);
    }
    assert!(number(&answer["pose_with_jacobian_ns"]) > 0.5 * number(&answer["pose_ns"]));
}

#[test]
fn frames_of_a_recording_are_timed_one_by_one() {
    let folder = Folder::with_leg("bench-stream");
    folder.write("walk.trc", leg::trc(12, |_, _| true));
    let answer = folder.condyle(&["bench", "leg.osim", "walk.trc", "--json"]).json();
    let stream = &answer["stream"];
    assert_eq!(stream["frames"], 12);
    let [mean, worst] = ["mean_ms", "worst_ms"].map(|key| number(&stream[key]));
    assert!(0.0 < mean && mean <= worst && worst < 1e3, "{stream}");
    assert!((1.0..12.0).contains(&number(&stream["worst_frame"])));
    let text = folder.condyle(&["bench", "leg.osim", "walk.trc"]).expect(0);
    assert!(text.contains("  12 frames one by one: "), "{text}");
}
