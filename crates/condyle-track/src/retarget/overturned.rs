//! Feet and hands that a recording turned over: by half a turn about their own length.
//!
//! Programs that fit a skeleton to markers sometimes find a foot with its sole up, or a hand with its palm where the back
//! should be, and stay there to the end: the few markers of such a part lie near a line, about which they tell little.
//! No joint turns that far. Followed, such a part drags knees and elbows to their limits; so it is turned back, which
//! leaves the line from ankle to ball, or from wrist to knuckles, where it is.
//!
//! What is looked at is the twist of the part against the one before it: with R the frame in which a straight limb would
//! carry it and A its own, the rotation A Rᵀ is a swing and a twist φ about the part's length,
//!
//! ```text
//! φ = 2 atan2(q · a, w),      (q, w) the quaternion of A Rᵀ, a the first axis of A
//! ```

use super::body::{Finger, Part, Side};
use super::sampled::Sampled;
use condyle_diagnostics::Diagnostic;
use condyle_math::{Mat3, Quat, Vec3};
use std::f64::consts::PI;

/// A foot that is twisted by more than this is turned over: people reach less than 45 degrees, with the knee's turn 90.
const FOOT: f64 = 120.0 * PI / 180.0;
/// A hand that is: from where palms face down in a T people turn forearms by about 90 degrees either way.
const HAND: f64 = 135.0 * PI / 180.0;
/// One that was turned over is so until its twist is less than this.
const BACK: f64 = 60.0 * PI / 180.0;

/// Turns back what is turned over, with all parts beyond it.
pub(super) fn turn_back(sampled: &mut Sampled, warnings: &mut Vec<Diagnostic>) {
    // Where a straight leg points down and its second axis forward, the foot points forward and its second axis up.
    let foot = Mat3::from_columns(Vec3::Y, -Vec3::X, Vec3::Z);
    for side in Side::BOTH {
        let legs = [Part::Shank(side), Part::Foot(side)];
        settle(sampled, legs, &[Part::Toes(side)], foot, FOOT, warnings);
        let fingers: Vec<Part> = Finger::ALL
            .into_iter()
            .flat_map(|finger| (0..3).map(move |joint| Part::Finger(side, finger, joint)))
            .collect();
        let arms = [Part::Forearm(side), Part::Hand(side)];
        settle(sampled, arms, &fingers, Mat3::IDENTITY, HAND, warnings);
    }
}

fn settle(
    sampled: &mut Sampled,
    [before, part]: [Part; 2],
    beyond: &[Part],
    carried: Mat3,
    most: f64,
    warnings: &mut Vec<Diagnostic>,
) {
    let (Some(carriers), Some(own)) = (sampled.turned.get(&before), sampled.turned.get(&part))
    else {
        return;
    };
    let mut over = vec![false; own.len()];
    let mut now = false;
    for ((over, carrier), own) in over.iter_mut().zip(carriers).zip(own) {
        let twist = twist(*own * (*carrier * carried).transpose(), own.x);
        now = twist.abs() > if now { BACK } else { most };
        *over = now;
    }
    let Some(first) = over.iter().position(|over| *over) else { return };
    // About the line to the next joint where it is known, else about the frame's own first axis.
    let about: Vec<Vec3> = match sampled.lines.get(&part) {
        Some(lines) => lines.clone(),
        None => own.iter().map(|axes| axes.x).collect(),
    };
    let half: Vec<Option<Mat3>> = over
        .iter()
        .zip(&about)
        .map(|(over, axis)| {
            let usable = *over && axis.is_finite() && axis.norm() > 0.5;
            usable.then(|| Quat::from_axis_angle(*axis, PI).to_mat3())
        })
        .collect();
    for moved in std::iter::once(&part).chain(beyond) {
        for (frame, half) in half.iter().enumerate() {
            let Some(half) = half else { continue };
            if let Some(axes) = sampled.turned.get_mut(moved).and_then(|all| all.get_mut(frame)) {
                *axes = *half * *axes;
            }
            // The part's own line is the axis; those beyond it turn.
            if *moved != part
                && let Some(line) = sampled.lines.get_mut(moved).and_then(|all| all.get_mut(frame))
            {
                *line = *half * *line;
            }
        }
    }
    let count = half.iter().flatten().count();
    let message = format!(
        "`{}` is turned over in {count} of {} frames of the source, first in frame {first}",
        part.name(),
        over.len()
    );
    warnings.push(Diagnostic::warning("retarget/turned-over", message).with_help(
        "no joint turns that far: there it is turned back by half a turn about its own length",
    ));
}

/// How far a rotation turns about an axis that it leaves nearly where it is, from -π to π.
fn twist(rotation: Mat3, axis: Vec3) -> f64 {
    let turn = Quat::from_mat3(rotation);
    let angle = 2.0 * turn.vector().dot(axis).atan2(turn.w);
    angle - (angle / (2.0 * PI)).round() * 2.0 * PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_twist_of_a_swing_and_a_twist_is_the_twist() {
        // A swing is about an axis across the line, so the product has the twist's angle by construction.
        for degrees in [-179.0_f64, -100.0, -30.0, 0.0, 45.0, 120.0, 179.0] {
            let line = Vec3::X;
            let swing = Quat::from_axis_angle(Vec3::new(0.0, 0.6, 0.8), 0.9);
            let own = Quat::from_axis_angle(line, degrees.to_radians());
            let rotation = swing * own;
            let found = twist(rotation.to_mat3(), swing.to_mat3() * line).to_degrees();
            assert!((found - degrees).abs() < 1e-9, "{degrees}: {found}");
        }
    }
}
