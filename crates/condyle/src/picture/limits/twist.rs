//! How far a bone may twist where it points now: arcs about its tip, with the present twist.

use super::super::marks::line;
use super::{fan, value};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_render::{Line, Scene, palette, shape};
use std::f64::consts::{PI, TAU};

/// Pieces of an arc are at most so long, in radians.
const PIECE: f64 = 0.07;
/// Twists that are asked for where they are allowed, and halvings of a step between: to a thousandth of a degree.
const ASKED: usize = 72;
const HALVINGS: usize = 13;

/// The shortest swing from one direction to another, both of length 1; of opposite ones any.
fn shortest(from: Vec3, to: Vec3) -> Quat {
    let across = from.cross(to);
    let axis = if across.norm() > 1e-9 { across.normalized() } else { shape::across(from)[0] };
    Quat::from_axis_angle(axis, across.norm().atan2(from.dot(to)))
}

/// A rotation as a shortest swing and a twist before it about the bone.
pub(super) struct Twist {
    pub(super) bone: Vec3,
    swing: Quat,
    /// In radians, from -π to π.
    now: f64,
}

impl Twist {
    /// The twist of a rotation about a bone of length 1.
    pub(super) fn of(bone: Vec3, rotation: Mat3) -> Self {
        let to = rotation * bone;
        let swing = shortest(bone, to);
        let [side, _] = shape::across(bone);
        let left = swing.to_mat3().transpose() * rotation * side;
        Self { bone, swing, now: bone.dot(side.cross(left)).atan2(side.dot(left)) }
    }

    /// The rotation with another twist.
    pub(super) fn with(&self, twist: f64) -> Quat {
        self.swing * Quat::from_axis_angle(self.bone, twist)
    }

    /// The twists at which a signed distance is not negative, as pieces of the turn.
    pub(super) fn spans(&self, distance: &dyn Fn(Quat) -> f64) -> Vec<[f64; 2]> {
        let step = TAU / ASKED as f64;
        let allowed = |twist: f64| distance(self.with(twist)) >= 0.0;
        let asked: Vec<bool> = (0..ASKED).map(|i| allowed(step * i as f64 - PI)).collect();
        // From a twist that is not allowed on, so that no piece is cut.
        let Some(first) = asked.iter().position(|allowed| !allowed) else {
            return vec![[-PI, PI]];
        };
        let mut spans = vec![];
        let mut open = None;
        for i in first..first + ASKED {
            let start = step * i as f64 - PI;
            let (here, next) = (asked[i % ASKED], asked[(i + 1) % ASKED]);
            if here == next {
                continue;
            }
            let (mut low, mut high) = (0.0, step);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if allowed(start + middle) == here { low = middle } else { high = middle }
            }
            let end = start + 0.5 * (low + high);
            match open.take() {
                None => open = Some(end),
                Some(from) => spans.push([from, end]),
            }
        }
        spans
    }

    /// Draws pieces of the turn about the tip of the bone; `turned` takes directions to the world.
    pub(super) fn draw(
        &self,
        turned: &dyn Fn(Vec3) -> Vec3,
        tip: Vec3,
        radius: f64,
        spans: &[[f64; 2]],
        scene: &mut Scene,
    ) {
        let [side, _] = shape::across(self.bone);
        let at = |twist: f64| tip + turned(self.with(twist).to_mat3() * side) * radius;
        for [low, high] in spans {
            let pieces = ((high - low) / PIECE).ceil().max(1.0);
            let path: Vec<Vec3> =
                (0..=pieces as usize).map(|i| at(low + (high - low) * i as f64 / pieces)).collect();
            scene.surfaces.push(fan(tip, &path, palette::LIMIT));
            if high - low < TAU - 1e-6 {
                for end in [path[0], path[path.len() - 1]] {
                    let ray = line(vec![tip, end], 1.0, palette::LIMIT);
                    scene.lines.push(Line { opacity: 0.7, ..ray });
                }
            }
            scene.lines.push(line(path, 1.5, palette::LIMIT));
        }
        scene.lines.push(value(tip, at(self.now)));
    }
}
