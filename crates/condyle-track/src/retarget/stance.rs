//! How a figure stands, and the anatomical frames of its parts there.

use super::body::{Finger, Part, Side};
use super::{Humanoid, Posed};
use crate::target::rotation_of;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::{Pose, UpAxis};
use condyle_motion::Motion;
use std::collections::BTreeMap;

/// A figure in a posture in which it stands.
#[derive(Clone, Debug)]
pub(super) struct Stance {
    /// The axes of the body in the world: forward, up, right.
    pub axes: Mat3,
    /// The same, on the axes of the world that are next to them: what the figure's world is turned by.
    pub heading: Mat3,
    /// For each part its anatomical frame in its segment.
    pub frames: BTreeMap<Part, Mat3>,
    /// Where the parts are, in metres.
    pub points: BTreeMap<Part, Vec3>,
    /// The sum of the lengths of thigh and shank, both sides' mean; of a figure without legs the height
    /// of its chest above its pelvis.
    pub leg: f64,
    /// The height of the ankles above the ground.
    pub ankle: f64,
    /// For each side how much the line from ankle to ball rises, in radians.
    pub slopes: BTreeMap<Side, f64>,
}

/// The axis that points up.
pub(super) fn up_of(up: UpAxis) -> Vec3 {
    match up {
        UpAxis::Y => Vec3::Y,
        UpAxis::Z => Vec3::Z,
    }
}

/// Heading is taken for an axis of the world within this cosine (20 degrees).
const ON_AXIS: f64 = 0.94;

/// What speaks for a figure that stands: 1 each for a trunk that is upright, and for legs that hang.
const STANDS: f64 = 0.6;

impl Stance {
    /// The posture of the defaults.
    pub(super) fn of_defaults(
        figure: Humanoid<'_>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self, Error> {
        let mut posed = Posed::new(figure.model);
        let pose = posed.at(&figure.model.defaults())?;
        if upright(figure, pose) < STANDS {
            let message = format!(
                "model `{}` does not stand where all coordinates rest",
                figure.model.name()
            );
            warnings.push(Diagnostic::warning("retarget/rest", message).with_help(
                "frames of parts are taken from that posture all the same, so what is upright may lean",
            ));
        }
        Self::of_pose(figure, pose)
    }

    /// The posture of the defaults, or where that is none of a standing figure the frame of the motion that
    /// is most like one.
    pub(super) fn of_motion(
        figure: Humanoid<'_>,
        motion: &Motion,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self, Error> {
        let mut posed = Posed::new(figure.model);
        let defaults = figure.model.defaults();
        if upright(figure, posed.at(&defaults)?) >= STANDS {
            return Self::of_pose(figure, posed.at(&defaults)?);
        }
        let step = motion.frames.len().div_ceil(2000).max(1);
        let mut best = (f64::NEG_INFINITY, 0);
        for (number, frame) in motion.frames.iter().enumerate().step_by(step) {
            let score = upright(figure, posed.at(frame)?);
            if score > best.0 {
                best = (score, number);
            }
        }
        let (name, frame) = (figure.model.name(), best.1);
        let message = format!("model `{name}` does not stand where all coordinates rest");
        let help = format!(
            "frame {frame} of its motion, where it is most upright, is taken for how it stands"
        );
        warnings.push(Diagnostic::warning("retarget/rest", message).with_help(help));
        let mut stance = Self::of_pose(figure, posed.at(&motion.frames[frame])?)?;
        let up = up_of(figure.model.up());
        let forward = figure.model.facing().ahead(figure.model.up());
        stance.heading = Mat3::from_columns(forward, up, forward.cross(up));
        Ok(stance)
    }

    fn of_pose(figure: Humanoid<'_>, pose: &Pose) -> Result<Self, Error> {
        let Humanoid { model, body } = figure;
        let up = up_of(model.up());
        let points: BTreeMap<Part, Vec3> = body
            .parts()
            .filter_map(|(part, _)| Some((part, body.start(part)?.placed(pose))))
            .collect();
        let across = |part: fn(Side) -> Part| {
            let [left, right] = Side::BOTH.map(|side| points.get(&part(side)).copied());
            let across = right? - left?;
            let level = across - up * up.dot(across);
            (level.norm() > 1e-6).then(|| unit(level))
        };
        let right = across(Part::Thigh).or_else(|| across(Part::UpperArm)).ok_or_else(|| {
            let name = model.name();
            let message =
                format!("model `{name}` has no two thighs or upper arms that tell its sides");
            Error::new("retarget/parts", message)
        })?;
        if body.get(Part::Pelvis).is_none() && body.get(Part::Chest).is_none() {
            let message = format!("model `{}` has neither a pelvis nor a chest", model.name());
            return Err(Error::new("retarget/parts", message));
        }
        let forward = up.cross(right);
        let axes = Mat3::from_columns(forward, up, right);
        let snapped = Vec3::UNITS
            .iter()
            .flat_map(|axis| [*axis, -*axis])
            .find(|axis| axis.dot(forward) > ON_AXIS);
        let ahead = snapped.unwrap_or(forward);
        let heading = Mat3::from_columns(ahead, up, ahead.cross(up));
        let between = |a: Part, b: Part| Some((*points.get(&a)? - *points.get(&b)?).norm());
        let legs: Vec<f64> = Side::BOTH
            .iter()
            .filter_map(|&side| {
                let thigh = between(Part::Thigh(side), Part::Shank(side))?;
                Some(thigh + between(Part::Shank(side), Part::Foot(side)).unwrap_or(0.0))
            })
            .collect();
        let leg = match legs.len() {
            0 => between(Part::Chest, Part::Pelvis).filter(|d| *d > 1e-6).unwrap_or(1.0),
            count => legs.iter().sum::<f64>() / count as f64,
        };
        let slope = |side: &Side| {
            let foot = Part::Foot(*side);
            let along = body.end(foot)?.placed(pose) - *points.get(&foot)?;
            (along.norm() > 1e-9).then(|| (*side, unit(along).dot(up).asin()))
        };
        let slopes = Side::BOTH.iter().filter_map(slope).collect();
        let mut stance =
            Self { axes, heading, frames: BTreeMap::new(), ankle: 0.0, slopes, points, leg };
        stance.ankle = stance.ankle_height(up);
        stance.frames = stance.anatomical(figure, pose);
        Ok(stance)
    }

    /// The height of the ankles above 0 if the feet stand about there, else above the lowest point of a foot.
    fn ankle_height(&self, up: Vec3) -> f64 {
        let heights = |parts: &[fn(Side) -> Part]| {
            let all = parts.iter().flat_map(|part| Side::BOTH.map(part));
            let all: Vec<f64> =
                all.filter_map(|part| Some(self.points.get(&part)?.dot(up))).collect();
            all
        };
        let ankles = heights(&[Part::Foot]);
        let Some(ankle) = ankles.iter().copied().reduce(f64::min) else { return 0.0 };
        // A sole is about 2 cm below the joints of the toes.
        let sole = heights(&[Part::Ball, Part::Toes, Part::ToeTip]);
        let lowest = sole.into_iter().chain(ankles).fold(f64::INFINITY, f64::min);
        let share = lowest / self.leg;
        if (-0.02..0.15).contains(&share) { ankle } else { ankle - lowest + 0.02 * self.leg }
    }

    /// The anatomical frames of all parts, in their segments.
    fn anatomical(&self, figure: Humanoid<'_>, pose: &Pose) -> BTreeMap<Part, Mat3> {
        let body = figure.body;
        let [forward, up, right] = [self.axes.x, self.axes.y, self.axes.z];
        let line = |part: Part| {
            let along = body.end(part)?.placed(pose) - *self.points.get(&part)?;
            (along.norm() > 1e-9).then(|| unit(along))
        };
        let mut world: BTreeMap<Part, Mat3> = BTreeMap::new();
        for (part, _) in body.parts().filter(|(part, _)| !part.is_tip()) {
            world.insert(part, self.axes);
        }
        for side in Side::BOTH {
            // Arms to the side and legs down, part after part along the shortest arcs.
            let outward = right * side.sign();
            let arm = [Part::UpperArm(side), Part::Forearm(side), Part::Hand(side)];
            let mut turned = limb(&arm, line, outward, up, &mut world);
            if let Some(hand) = self.hand(side, line(Part::Hand(side))) {
                world.insert(Part::Hand(side), hand);
                turned = hand.y;
            }
            for finger in Finger::ALL {
                for joint in 0..3 {
                    let part = Part::Finger(side, finger, joint);
                    if let (true, Some(along)) = (world.contains_key(&part), line(part)) {
                        world.insert(part, across(along, turned));
                    }
                }
            }
            limb(&[Part::Thigh(side), Part::Shank(side)], line, -up, forward, &mut world);
            let mut ahead = forward;
            for part in [Part::Foot(side), Part::Toes(side)] {
                if let Some(along) = line(part) {
                    let level = along - up * up.dot(along);
                    if level.norm() > 0.3 {
                        ahead = unit(level);
                    }
                }
                if world.contains_key(&part) {
                    world.insert(part, across(ahead, up));
                }
            }
        }
        let own = |(part, frame): (Part, Mat3)| {
            let segment = body.get(part)?.segment;
            Some((part, rotation_of(pose.segment(segment).linear).transpose() * frame))
        };
        world.into_iter().filter_map(own).collect()
    }

    /// The frame of a hand from its knuckles: along it, and out of its back.
    fn hand(&self, side: Side, along: Option<Vec3>) -> Option<Mat3> {
        let knuckle = |finger| self.points.get(&Part::Finger(side, finger, 0)).copied();
        let index = knuckle(Finger::Index)?;
        let little = knuckle(Finger::Little).or_else(|| knuckle(Finger::Ring))?;
        let along = match along {
            Some(along) => along,
            None => unit((index + little) * 0.5 - *self.points.get(&Part::Hand(side))?),
        };
        let back = along.cross(index - little) * side.sign();
        (back.norm() > 1e-6).then(|| across(along, back))
    }
}

/// How much a figure stands: the least of the cosines of trunk, thighs and shanks with upright.
fn upright(figure: Humanoid<'_>, pose: &Pose) -> f64 {
    let up = up_of(figure.model.up());
    let place = |part: Part| Some(figure.body.start(part)?.placed(pose));
    let cosine = |from: Option<Vec3>, to: Option<Vec3>| {
        let along = to? - from?;
        (along.norm() > 1e-9).then(|| unit(along).dot(up))
    };
    let middle =
        |part: fn(Side) -> Part| Some((place(part(Side::Left))? + place(part(Side::Right))?) * 0.5);
    let top = place(Part::Neck).or_else(|| middle(Part::UpperArm)).or_else(|| place(Part::Head));
    let low = middle(Part::Thigh).or_else(|| place(Part::Pelvis));
    let mut all = vec![cosine(low, top)];
    for side in Side::BOTH {
        all.push(cosine(place(Part::Shank(side)), place(Part::Thigh(side))));
        all.push(cosine(place(Part::Foot(side)), place(Part::Shank(side))));
    }
    all.into_iter().flatten().fold(1.0, f64::min)
}

/// A vector of length 1.
pub(super) fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.norm().max(1e-300))
}

/// The frame whose first axis is along a line, and whose second is as near to `up` as can be.
pub(super) fn across(along: Vec3, up: Vec3) -> Mat3 {
    let mut level = up - along * along.dot(up);
    if level.norm() < 1e-6 {
        let other = Vec3::UNITS
            .into_iter()
            .min_by(|a, b| along.dot(*a).abs().total_cmp(&along.dot(*b).abs()));
        let other = other.unwrap_or(Vec3::X);
        level = other - along * along.dot(other);
    }
    let second = unit(level);
    Mat3::from_columns(along, second, along.cross(second))
}

/// The rotation along the shortest arc from one direction to another, of opposite ones about any axis.
pub(super) fn arc(from: Vec3, to: Vec3) -> Mat3 {
    let axis = from.cross(to);
    let (sine, cosine) = (axis.norm(), from.dot(to));
    if sine < 1e-12 {
        let turn = if cosine > 0.0 { 0.0 } else { std::f64::consts::PI };
        return Quat::from_axis_angle(across(from, Vec3::Y).y, turn).to_mat3();
    }
    Quat::from_axis_angle(axis * (1.0 / sine), sine.atan2(cosine)).to_mat3()
}

/// The frames of a limb that would be straight along `straight`, its second axes along `second`; the second
/// axis of its last part.
fn limb(
    parts: &[Part],
    line: impl Fn(Part) -> Option<Vec3>,
    straight: Vec3,
    second: Vec3,
    world: &mut BTreeMap<Part, Mat3>,
) -> Vec3 {
    let mut turned = Mat3::IDENTITY;
    let mut along = straight;
    for &part in parts {
        if !world.contains_key(&part) {
            continue;
        }
        // A part without an end goes on as the one before it.
        along = line(part).unwrap_or(along);
        turned = arc(turned * along, straight) * turned;
        world.insert(part, across(along, turned.transpose() * second));
    }
    turned.transpose() * second
}
