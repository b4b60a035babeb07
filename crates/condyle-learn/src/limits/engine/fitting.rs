//! The cone with twist that is nearest to a field.
//!
//! Seven numbers: the middle (three), the turn of the frame about the bone, two half-angles, half of the twist's range. What is
//! made least is a count of rotations judged wrongly, which has no slope, so that it is searched by simplices (Nelder &
//! Mead 1965), begun at the mean and at the deepest rotation and begun again about what was found.

use super::cone_twist::along;
use super::region::Place;
use super::{ConeTwist, Law, Parted, Region, inside};
use crate::limits::principal::principal;
use condyle_math::{Quat, Vec3};
use std::f64::consts::PI;
use std::fmt;

/// What is wanted of a replacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Aim {
    /// False accepts and false rejects together as few as can be, by Haar's measure.
    #[default]
    Closest,
    /// No false accept at all, and as few false rejects as then can be.
    Inside,
}

/// Why a field cannot be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngineError {
    /// The bone's direction is zero or not finite.
    NoBone,
    /// Nothing is inside.
    Nothing,
    /// No cone was found that is inside the field.
    NoneInside,
    /// The number of directions is not from 6 to 256.
    Directions,
}

impl fmt::Display for EngineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoBone => "the bone's direction is zero; give its direction in the child",
            Self::Nothing => "the limit allows too little to be replaced: less than 1 of 50 000 rotations",
            Self::NoneInside => {
                "no cone was found in which all is valid: the limit is thinner than 2 degrees where one \
                 would be"
            }
            Self::Directions => "give from 6 to 256 directions",
        })
    }
}

impl std::error::Error for EngineError {}

/// A false accept counts as so many false rejects where none is wanted; what is left of them is shrunk away.
pub(super) const DEAR: f64 = 25.0;
/// Where none is wanted, what is nearer to the boundary than this counts as outside, in radians: what the proof needs.
pub(super) const ROOM: f64 = 0.014;

/// The numbers that are searched, and the simplex's first edges.
const NUMBERS: usize = 7;

/// The cone with twist of a law that is nearest to a region, for a bone along `bone` in the child.
///
/// `from` is where to begin, such as the fit of another law; without it at the mean and at the deepest rotation.
///
/// # Errors
/// [`EngineError`].
///
/// ```
/// use condyle_learn::limits::engine::{Aim, Law, Loss, Parted, Region, cone_twist};
/// use condyle_math::{Quat, Vec3};
/// // Turns that swing the x axis by up to 50 degrees and twist about it by up to 30: the ellipse is a circle.
/// let [swing, twist] = [50f64, 30.0].map(f64::to_radians);
/// let distance = |q: Quat| {
///     let parted = Parted::of(q);
///     let [y, z] = parted.vector();
///     (swing - y.hypot(z)).min(twist - parted.twist.abs())
/// };
/// let region = Region::new(&distance);
/// let found = cone_twist(&region, &distance, Vec3::X, Law::Angle, Aim::Closest, None)?;
/// assert!(found.swing.iter().all(|a| (a - swing).abs() < 0.02));
/// assert!((found.twist - twist).abs() < 0.02);
/// assert!(found.middle.angle_to(Quat::IDENTITY) < 0.03);
/// assert!(Loss::of(&region, |q| found.allows(q)).both() < 0.04);
/// # Ok::<(), condyle_learn::limits::engine::EngineError>(())
/// ```
pub fn cone_twist(
    region: &Region,
    distance: &dyn Fn(Quat) -> f64,
    bone: Vec3,
    law: Law,
    aim: Aim,
    from: Option<&ConeTwist>,
) -> Result<ConeTwist, EngineError> {
    if !(bone.norm() > 1e-9 && bone.norm().is_finite()) {
        return Err(EngineError::NoBone);
    }
    let inside: Vec<Quat> =
        region.fitted.iter().filter(|p| p.distance >= 0.0).map(|p| p.rotation).collect();
    if inside.len() < 20 {
        return Err(EngineError::Nothing);
    }
    let starts = match from {
        Some(from) => vec![ConeTwist { law, ..*from }],
        None => {
            let deepest = begun(&inside, region.deepest.1, bone, law);
            // Of a region that is no cone at all the spread says little: what fits about the deepest rotation, to be grown.
            let depth = region.deepest.0.max(0.02);
            let small = clamped(ConeTwist { swing: [depth; 2], twist: 0.7 * depth, ..deepest });
            vec![begun(&inside, mean(&inside), bone, law), deepest, small]
        }
    };
    // Where no false accept is wanted they become dear step by step: a cliff at once would hold the search where it begins.
    let steps: &[(f64, f64)] = match aim {
        Aim::Closest => &[(0.2, 1.0), (0.08, 1.0), (0.03, 1.0)],
        Aim::Inside => &[(0.2, 2.0), (0.1, 6.0), (0.06, DEAR), (0.04, 4.0 * DEAR)],
    };
    let mut best: Option<(f64, ConeTwist)> = None;
    for start in &starts {
        let mut found = (f64::INFINITY, *start);
        for (edge, dear) in steps {
            let cost = |cone: &ConeTwist| cost(&region.fitted, cone, *dear, aim);
            found = searched(&found.1, *edge, 130, &cost);
        }
        if best.as_ref().is_none_or(|(least, _)| found.0 < *least) {
            best = Some(found);
        }
    }
    let (_, found) = best.ok_or(EngineError::Nothing)?;
    match aim {
        Aim::Closest => Ok(found),
        Aim::Inside => inside::shrunk(&found, distance).ok_or(EngineError::NoneInside),
    }
}

/// Rotations judged wrongly.
fn cost(places: &[Place], cone: &ConeTwist, dear: f64, aim: Aim) -> f64 {
    let room = if aim == Aim::Inside { ROOM } else { 0.0 };
    let asked = cone.asked();
    let mut sum = 0.0;
    for place in places {
        match (asked(place.rotation), place.distance >= room) {
            (true, false) => sum += dear * place.weight,
            (false, true) => sum += place.weight,
            _ => {}
        }
    }
    sum
}

fn mean(rotations: &[Quat]) -> Quat {
    let mut sums = [[0.0; 4]; 4];
    for q in rotations.iter().map(|q| q.to_array()) {
        for i in 0..4 {
            for j in 0..4 {
                sums[i][j] += q[i] * q[j];
            }
        }
    }
    Quat::from(principal(sums).1[0]).normalized()
}

/// A first cone about a middle: axes and half-angles by the spread of swings and twists.
fn begun(inside: &[Quat], middle: Quat, bone: Vec3, law: Law) -> ConeTwist {
    let frame = along(bone);
    let back = (middle * frame).conjugate();
    let mut sums = [[0.0; 2]; 2];
    let mut twists = 0.0;
    for q in inside {
        let parted = Parted::of(back * *q * frame);
        let v = parted.vector();
        for i in 0..2 {
            for j in 0..2 {
                sums[i][j] += v[i] * v[j];
            }
        }
        twists += parted.twist * parted.twist;
    }
    let count = inside.len() as f64;
    let (values, axes) = principal(sums);
    // An even ellipse has half of its half-axis as deviation, an even range its half over √3.
    let [a, b] = values.map(|v| 2.0 * (v / count).max(0.0).sqrt());
    let roll = axes[0][1].atan2(axes[0][0]);
    let in_child = frame * Quat::from_axis_angle(Vec3::X, roll);
    let cone =
        ConeTwist { law, middle, in_child, swing: [a, b], twist: (3.0 * twists / count).sqrt() };
    clamped(cone)
}

fn clamped(cone: ConeTwist) -> ConeTwist {
    let least = 0.5f64.to_radians();
    let [a, b, t] = cone.law.most();
    let [y, z] = cone.swing;
    ConeTwist {
        swing: [y.clamp(least, a), z.clamp(least, b)],
        twist: cone.twist.clamp(least, t),
        ..cone
    }
}

fn moved(cone: &ConeTwist, by: [f64; NUMBERS]) -> ConeTwist {
    let [x, y, z, roll, a, b, t] = by;
    let turn = Quat::from_axis_angle(Vec3::X, roll);
    clamped(ConeTwist {
        law: cone.law,
        middle: (cone.middle * Quat::exp(Vec3::new(x, y, z))).normalized(),
        in_child: (cone.in_child * turn).normalized(),
        swing: [cone.swing[0] + a, cone.swing[1] + b],
        twist: cone.twist + t,
    })
}

/// Nelder and Mead's search about a cone, with a first simplex of so large an edge.
fn searched(
    about: &ConeTwist,
    edge: f64,
    steps: usize,
    cost: &dyn Fn(&ConeTwist) -> f64,
) -> (f64, ConeTwist) {
    type Point = [f64; NUMBERS];
    let used = |i: usize| match about.law {
        // A ball knows neither a roll, nor a second half-angle, nor a twist.
        Law::MujocoBall => i < 3 || i == 4,
        _ => true,
    };
    let at = |p: &Point| cost(&moved(about, *p));
    let mut simplex: Vec<(f64, Point)> = vec![(at(&[0.0; NUMBERS]), [0.0; NUMBERS])];
    for i in (0..NUMBERS).filter(|i| used(*i)) {
        let mut p = [0.0; NUMBERS];
        // Half-angles shrink first: what reaches π cannot grow.
        p[i] = if i >= 4 { -edge } else { edge };
        simplex.push((at(&p), p));
    }
    let mixed = |p: &Point, q: &Point, t: f64| -> Point {
        std::array::from_fn(|i| p[i] + t * (q[i] - p[i]))
    };
    for _ in 0..steps {
        simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
        let last = simplex.len() - 1;
        let mut centre = [0.0; NUMBERS];
        for (_, p) in &simplex[..last] {
            for i in 0..NUMBERS {
                centre[i] += p[i] / last as f64;
            }
        }
        let (worst, least, second) = (simplex[last], simplex[0].0, simplex[last - 1].0);
        let try_at = |t: f64| {
            let p = mixed(&centre, &worst.1, t);
            (at(&p), p)
        };
        let reflected = try_at(-1.0);
        if reflected.0 < least {
            let farther = try_at(-2.0);
            simplex[last] = if farther.0 < reflected.0 { farther } else { reflected };
        } else if reflected.0 < second {
            simplex[last] = reflected;
        } else {
            let nearer = if reflected.0 < worst.0 { try_at(-0.5) } else { try_at(0.5) };
            if nearer.0 < worst.0.min(reflected.0) {
                simplex[last] = nearer;
            } else {
                let first = simplex[0].1;
                for (value, p) in &mut simplex[1..] {
                    *p = mixed(&first, p, 0.5);
                    *value = at(p);
                }
            }
        }
        let size = simplex.iter().flat_map(|(_, p)| p).fold(0.0f64, |m, c| m.max(c.abs()));
        let spread = simplex[1..]
            .iter()
            .flat_map(|(_, p)| p.iter().zip(&simplex[0].1).map(|(a, b)| (a - b).abs()))
            .fold(0.0f64, f64::max);
        if spread < 2e-4 || size > PI {
            break;
        }
    }
    simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
    (simplex[0].0, moved(about, simplex[0].1))
}
