//! `condyle bench`.

use super::{Folder, number};

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
