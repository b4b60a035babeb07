//! What is not moved: joints that lie between parts without being one.
//!
//! Skeletons have bones that lead from the pelvis to a hip, from a neck to another, or hold a chain of offsets. Where
//! such a bone turned, the joint beyond it would be elsewhere, and limbs could point where they should although the
//! figure is bent in a place where no one is. A bone that turns about its own length (the half of a forearm
//! that turns with the hand) moves no joint and is left free. Only the root may change its place, and nothing its
//! size.

use super::body::Part;
use super::{Humanoid, Posed};
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, JointSetId, SegmentId};
use std::collections::BTreeSet;

/// A bone may turn where that moves the next joint by less than this share of how far it is.
const LEVER: f64 = 0.3;
/// How far a coordinate is moved to see what it moves, in radians.
const NUDGE: f64 = 1e-4;

/// The coordinates that stay at their defaults.
pub(super) fn held(target: Humanoid<'_>) -> Vec<CoordinateId> {
    let Humanoid { model, body } = target;
    let counted = |part: &Part| !part.is_tip() || matches!(part, Part::Ankle(_));
    let parts: Vec<SegmentId> =
        body.parts().filter(|(part, _)| counted(part)).map(|(_, anchor)| anchor.segment).collect();
    let moving: BTreeSet<JointSetId> =
        parts.iter().filter_map(|id| model.segment(*id).joint_set).collect();
    let root = body.get(Part::Pelvis).or_else(|| body.get(Part::Chest)).map(|a| a.segment);
    // From the pelvis to the world: the first that can be moved about stays free, and what is above it not.
    let places = |set: JointSetId| {
        let mut own = model.coordinates_of(set);
        own.any(|id| model.coordinate(id).kind == CoordinateKind::Translation)
    };
    let mut above = vec![];
    let mut here = root;
    while let Some(id) = here {
        above.extend(model.segment(id).joint_set);
        here = model.segment(id).parent;
    }
    let carrier = above.iter().position(|set| places(*set));
    let carriers = &above[..carrier.map_or(0, |carrier| carrier + 1)];
    let mut posed = Posed::new(model);
    let mut held = vec![];
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let set = coordinate.joint_set;
        let stays = match coordinate.kind {
            CoordinateKind::Translation => carriers.last() != Some(&set),
            CoordinateKind::Rotation | CoordinateKind::Orientation => {
                !moving.contains(&set)
                    && !carriers.contains(&set)
                    && moves_joints(target, &parts, &mut posed, id)
            }
            _ => true,
        };
        if stays {
            held.push(id);
        }
    }
    held
}

/// Whether a coordinate moves the nearest joint beyond it much.
fn moves_joints(
    target: Humanoid<'_>,
    parts: &[SegmentId],
    posed: &mut Posed,
    id: CoordinateId,
) -> bool {
    let Humanoid { model, body } = target;
    let set = model.coordinate(id).joint_set;
    let joint = |id: SegmentId| model.segment(id).joint_in_segment.translation;
    let outputs: Vec<SegmentId> = model.outputs_of(set).map(|(segment, _)| segment).collect();
    let beyond = |part: SegmentId| model.path_to_root(part).any(|up| outputs.contains(&up));
    let anchors: Vec<(SegmentId, Vec3)> = body
        .parts()
        .filter(|(_, anchor)| parts.contains(&anchor.segment) && beyond(anchor.segment))
        .map(|(_, anchor)| (anchor.segment, joint(anchor.segment)))
        .collect();
    let defaults = model.defaults();
    let Ok(pose) = posed.at(&defaults) else { return true };
    let Some(first) = outputs.first() else { return true };
    let own = pose.segment(*first) * joint(*first);
    let at = |(segment, point): (SegmentId, Vec3), pose: &condyle_model::Pose| {
        pose.segment(segment) * point
    };
    let distance = |anchor: &(SegmentId, Vec3)| (at(*anchor, pose) - own).norm();
    let nearest = anchors
        .iter()
        .filter(|anchor| distance(anchor) > 1e-4)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .copied();
    let Some(nearest) = nearest else { return false };
    let (before, far) = (at(nearest, pose), distance(&nearest));
    model.tangent_range(id).any(|direction| {
        let mut step = vec![0.0; model.tangent_len()];
        let mut moved = defaults.clone();
        step[direction] = NUDGE;
        model.retract(&defaults, &step, &mut moved);
        posed.at(&moved).is_ok_and(|pose| (at(nearest, pose) - before).norm() > LEVER * NUDGE * far)
    })
}
