//! Where a limit rests on few samples.

use crate::limits::{Field, State, uniform};
use condyle_math::Quat;

/// A part of the inside that is far from all samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thin {
    /// Its middle.
    pub centre: Quat,
    /// The angle from there to the nearest sample, in radians.
    pub radius: f64,
    /// Its volume as a share of all rotations.
    pub share: f64,
    /// Whether it is a hole, which is not called valid.
    pub hole: bool,
}

/// The holes of a field, then the thin regions: what is called valid farther from all samples than `from`, in radians; the
/// largest first, `most` of each.
#[must_use]
pub fn thin(field: &Field, from: f64, most: usize) -> Vec<Thin> {
    let hole = |hole: &crate::limits::field::Hole| Thin {
        centre: hole.centre,
        radius: hole.radius,
        share: hole.share,
        hole: true,
    };
    let mut found: Vec<Thin> = field.learned().holes.iter().take(most).map(hole).collect();
    let count = 60_000;
    let mut far: Vec<(Quat, f64)> = uniform(count)
        .filter(|q| field.state(*q).0 == State::Valid)
        .filter_map(|q| {
            let angle = field.evidence(q).angle;
            (angle > from).then_some((q, angle))
        })
        .collect();
    far.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut regions: Vec<Thin> = vec![];
    for (q, angle) in far {
        let near = regions.iter_mut().find(|r| r.centre.angle_to(q) < r.radius + from);
        match near {
            Some(region) => region.share += 1.0 / count as f64,
            None => regions.push(Thin {
                centre: q,
                radius: angle,
                share: 1.0 / count as f64,
                hole: false,
            }),
        }
    }
    regions.sort_by(|a, b| b.share.total_cmp(&a.share));
    found.extend(regions.into_iter().take(most));
    found
}
