//! Proof that all that a replacement allows is inside the field, and shrinking until it is.
//!
//! What is allowed is covered by cells of swing (θ_y, θ_z) and twist. A rotation of a cell is no farther from that at its middle
//! than ½·√(e_y² + e_z²) + ½·e_τ for edges e, since the exponential map does not lengthen. So a cell is inside if the distance
//! at its middle is more than that; where it is not, the cell is cut in eight, down to half a degree. The spline's slope may be a
//! little more than 1 where kinks are rounded: radii count by a tenth more.

use super::law::hinges;
use super::{ConeTwist, Law, Parted, ReachCone};
use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;

/// The smallest edge of a cell, in radians.
const SMALLEST: f64 = 0.6 * PI / 180.0;
const SLOPE: f64 = 1.1;
/// Cells that are looked at before a search gives up; far more than any limit needs.
const MOST_CELLS: usize = 4_000_000;

/// Swing and twist of the middle of a cell and half of its edges.
#[derive(Clone, Copy)]
struct Cell {
    middle: [f64; 3],
    half: [f64; 3],
}

impl Cell {
    fn reach(&self) -> [f64; 2] {
        [self.half[0].hypot(self.half[1]), self.half[2]]
    }
}

/// Middles of cells that may hold something outside, at most `most` of them; the box is ± `half` in swing and twist.
fn outside(
    half: [f64; 3],
    distance: &dyn Fn([f64; 3]) -> f64,
    touches: &dyn Fn([f64; 3], [f64; 2]) -> bool,
    most: usize,
) -> Vec<[f64; 3]> {
    let mut stack = vec![Cell { middle: [0.0; 3], half }];
    let (mut found, mut looked) = (vec![], 0);
    while let Some(cell) = stack.pop() {
        looked += 1;
        let [swing, twist] = cell.reach();
        if !touches(cell.middle, [swing, twist]) {
            continue;
        }
        if looked > MOST_CELLS {
            found.push(cell.middle);
            return found;
        }
        if distance(cell.middle) > SLOPE * (swing + twist) {
            continue;
        }
        let edges = cell.half.map(|h| 2.0 * h > SMALLEST);
        if edges == [false; 3] {
            found.push(cell.middle);
            if found.len() >= most {
                return found;
            }
            continue;
        }
        let ends = |i: usize| -> &[f64] { if edges[i] { &[-0.5, 0.5] } else { &[0.0] } };
        let size: [f64; 3] =
            std::array::from_fn(|i| if edges[i] { 0.5 * cell.half[i] } else { cell.half[i] });
        for y in ends(0) {
            for z in ends(1) {
                for t in ends(2) {
                    let by = [*y, *z, *t];
                    let middle = std::array::from_fn(|i| cell.middle[i] + by[i] * cell.half[i]);
                    stack.push(Cell { middle, half: size });
                }
            }
        }
    }
    found
}

/// Whether all that a cone allows is proved to be inside.
pub(super) fn proved(cone: &ConeTwist, distance: &dyn Fn(Quat) -> f64) -> bool {
    let frame = cone.in_reference();
    let back = cone.in_child.conjugate();
    let at = |[y, z, t]: [f64; 3]| distance(frame * Parted::joined([y, z], t) * back);
    let [a, b] = cone.swing;
    let (law, twist) = (cone.law, cone.twist);
    let half = match law {
        Law::MujocoBall => [a.min(PI); 3],
        Law::MujocoHinges => [(a + b).min(PI), (a + b).min(PI), PI],
        // Between the axes a pyramid goes farther than along them.
        Law::JoltPyramid | Law::PhysxPyramid => [1.5 * a.max(b), 1.5 * a.max(b), twist],
        _ => [a, b, twist],
    };
    let half = [half[0].min(PI), half[1].min(PI), half[2]];
    let touches = |[y, z, t]: [f64; 3], [swing, turn]: [f64; 2]| {
        if y.hypot(z) > PI + swing {
            return false;
        }
        let q = Parted::joined([y, z], t);
        match law {
            Law::MujocoBall => 2.0 * q.vector().norm().atan2(q.w.abs()) <= a + swing + turn,
            Law::MujocoHinges => {
                let [y, z, x] = hinges(q);
                let room = (swing + turn) / b.cos().max(0.1);
                y.abs() <= a + room && z.abs() <= b + swing + turn && x.abs() <= twist + room
            }
            _ => {
                let more = 1.0 + 1.2 * swing / a.min(b);
                let most = 179.9f64.to_radians();
                let wide = [a, b].map(|h| (more * h).min(most));
                law.allows(q, wide, twist + turn)
            }
        }
    };
    outside(half, &at, &touches, 1).is_empty()
}

/// The cone, shrunk until it is proved to be inside, then each number grown as far as that stays.
pub(super) fn shrunk(cone: &ConeTwist, distance: &dyn Fn(Quat) -> f64) -> Option<ConeTwist> {
    let scaled =
        |by: f64| ConeTwist { swing: cone.swing.map(|a| a * by), twist: cone.twist * by, ..*cone };
    let least = 0.05;
    if proved(cone, distance) {
        return Some(grown(cone, distance));
    }
    let (mut good, mut bad) = (least, 1.0);
    if !proved(&scaled(good), distance) {
        return None;
    }
    for _ in 0..8 {
        let middle = 0.5 * (good + bad);
        if proved(&scaled(middle), distance) { good = middle } else { bad = middle }
    }
    Some(grown(&scaled(good), distance))
}

fn grown(cone: &ConeTwist, distance: &dyn Fn(Quat) -> f64) -> ConeTwist {
    let most = cone.law.most();
    let mut kept = *cone;
    for number in 0..3 {
        let with = |cone: &ConeTwist, by: f64| {
            let mut next = *cone;
            let value = match number {
                2 => &mut next.twist,
                n => &mut next.swing[n],
            };
            *value = (*value * by).min(most[number]);
            next
        };
        let (mut good, mut bad) = (1.0, 1.4);
        for _ in 0..6 {
            let middle = 0.5 * (good + bad);
            if proved(&with(&kept, middle), distance) { good = middle } else { bad = middle }
        }
        kept = with(&kept, good);
    }
    kept
}

/// Swing and twist of what a reach cone allows and may be outside: in its own frame, x along the bone.
pub(super) fn beyond(
    cone: &ReachCone,
    frame: Quat,
    distance: &dyn Fn(Quat) -> f64,
) -> Vec<[f64; 3]> {
    let back = frame.conjugate();
    let whole = cone.middle * frame;
    let at = |[y, z, t]: [f64; 3]| distance(whole * Parted::joined([y, z], t) * back);
    let touches = |[y, z, t]: [f64; 3], [swing, turn]: [f64; 2]| {
        if y.hypot(z) > PI + swing {
            return false;
        }
        let direction = frame.to_mat3() * (Quat::exp(Vec3::new(0.0, y, z)).to_mat3() * Vec3::X);
        if cone.cone.distance(direction).0 < -swing {
            return false;
        }
        cone.cone.twist_bounds(direction).is_none_or(|([low, high], slopes)| {
            let [below, above] = slopes.map(|slope| 1.5 * slope.norm() * swing + turn);
            low - below <= t && t <= high + above
        })
    };
    let reach = cone.cone.boundary().map(|v| {
        let rest = cone.cone.rest().normalized();
        rest.cross(v).norm().atan2(rest.dot(v))
    });
    let swing = reach.fold(0.0, f64::max);
    outside([swing, swing, PI], &at, &touches, 400)
}
