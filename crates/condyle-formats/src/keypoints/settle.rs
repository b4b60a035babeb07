//! Axes, unit, rate and confidences of keypoints, and the recording that they are.

use super::raw::Raw;
use crate::skeleton::Assumed;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::UpAxis;
use condyle_motion::keypoint::canonical;
use condyle_motion::{LengthUnit, Observed, Recording};
use std::collections::HashMap;

/// Frames per second where nothing says it: what most cameras do.
const RATE: f64 = 30.0;
/// A leg from hip over knee to ankle, in metres, of the man of 1.75 m.
const LEG: f64 = 0.84;
/// The legs of people, in metres, from small children on.
const LEGS: std::ops::Range<f64> = 0.4..1.3;
/// Share of the height that must lie along one axis.
const UPRIGHT: f64 = 0.7;

/// The recording, y up and in metres.
pub(super) fn settled(
    raw: Raw,
    size: usize,
    assumed: &Assumed,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Recording, Error> {
    let (frames, width) = (raw.times.len(), raw.labels.len());
    let cells = frames.saturating_mul(width);
    // A position with its confidence takes 32 bytes; most files have 20 letters or more for each.
    if cells > size / 4 + 2_000_000 {
        let message = format!("{frames} frames of {width} points are far more than the file holds");
        return Err(Error::new("keypoints/size", message));
    }
    let mut positions = vec![Observed::MISSING; cells];
    let mut confidences = vec![0.0; if raw.weighed { cells } else { 0 }];
    let most = raw.points.iter().map(|p| p.confidence).filter(|c| c.is_finite());
    let most = most.fold(1.0, f64::max);
    // Scores of some networks go a little beyond 1; far beyond, they are of another scale.
    let scale = if most > 1.5 { 1.0 / most } else { 1.0 };
    if scale < 1.0 {
        let message = format!("confidences go up to {most:.4}, and are divided by it");
        warnings.push(Diagnostic::warning("keypoints/confidence", message));
    }
    for point in &raw.points {
        let confidence = (point.confidence * scale).min(1.0);
        let seen = confidence > 0.0 && point.at.iter().all(|x| x.is_finite());
        let place = point.frame * width + point.label;
        if seen && let Some(position) = positions.get_mut(place) {
            *position = Observed::from(point.at);
            if let Some(known) = confidences.get_mut(place) {
                *known = confidence;
            }
        }
    }
    let (times, rate) = times(&raw, warnings);
    let mut recording = Recording {
        labels: labels(&raw),
        rate,
        times,
        positions,
        units: LengthUnit::Metre,
        confidences: raw.weighed.then_some(confidences),
    };
    let bodies = bodies(&raw);
    let axes = up(&recording, &bodies, assumed, warnings);
    for position in recording.positions.iter_mut().filter_map(Observed::position_mut) {
        *position = axes.turned(*position);
    }
    let (metres, unit) = unit(&recording, &bodies, assumed, warnings);
    for position in recording.positions.iter_mut().filter_map(Observed::position_mut) {
        *position = position.map(|x| x * metres);
    }
    recording.units = unit;
    Ok(recording)
}

/// The labels: with the person before a colon where there are several.
fn labels(raw: &Raw) -> Vec<String> {
    let several = raw.people.len() > 1;
    let name = |(who, name): &(usize, String)| match several {
        true => format!("{}:{name}", raw.people.get(*who).map_or("", String::as_str)),
        false => name.clone(),
    };
    let labels: Vec<String> = raw.labels.iter().map(name).collect();
    crate::text::distinct(labels.iter().map(String::as_str), |_, _| {})
}

/// Seconds, and frames a second.
fn times(raw: &Raw, warnings: &mut Vec<Diagnostic>) -> (Vec<f64>, f64) {
    let span = |times: &[f64]| match times {
        [first, .., last] if last > first => Some((times.len() - 1) as f64 / (last - first)),
        _ => None,
    };
    if raw.in_seconds {
        return (raw.times.clone(), raw.rate.or(span(&raw.times)).unwrap_or(RATE));
    }
    let rate = raw.rate.unwrap_or_else(|| {
        if raw.times.len() > 1 {
            let message = format!("the file does not say when its frames are: {RATE} a second");
            let help = "add a column `time` in seconds, or a key `fps`";
            warnings.push(Diagnostic::warning("keypoints/rate", message).with_help(help));
        }
        RATE
    });
    let first = raw.times.first().copied().unwrap_or_default();
    (raw.times.iter().map(|number| (number - first) / rate).collect(), rate)
}

/// The labels of one person by what they are.
type Body = HashMap<&'static str, usize>;

fn bodies(raw: &Raw) -> Vec<Body> {
    let mut bodies = vec![Body::new(); raw.people.len()];
    for (label, (who, name)) in raw.labels.iter().enumerate() {
        if let (Some(body), Some(part)) = (bodies.get_mut(*who), canonical(name)) {
            body.entry(part).or_insert(label);
        }
    }
    bodies
}

/// At most so many frames are looked at.
const LOOKED_AT: usize = 301;

fn sampled(recording: &Recording) -> impl Iterator<Item = usize> {
    (0..recording.frames()).step_by(recording.frames().div_ceil(LOOKED_AT).max(1))
}

/// An axis of a file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Up {
    axis: usize,
    negative: bool,
}

impl Up {
    /// A position with y up, turned about one axis.
    fn turned(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match (self.axis, self.negative) {
            (1, false) => [x, y, z],
            (1, true) => [x, -y, -z],
            (2, false) => [x, z, -y],
            (2, true) => [x, -z, y],
            (_, false) => [-y, x, z],
            (_, true) => [y, -x, z],
        }
    }

    fn name(self) -> String {
        format!("{}{}", if self.negative { "-" } else { "+" }, ["x", "y", "z"][self.axis % 3])
    }
}

/// The axis from the ankles to the shoulders.
fn up(
    recording: &Recording,
    bodies: &[Body],
    assumed: &Assumed,
    warnings: &mut Vec<Diagnostic>,
) -> Up {
    if let Some(up) = assumed.up {
        return Up { axis: if up == UpAxis::Y { 1 } else { 2 }, negative: false };
    }
    let mut sum = [0.0; 3];
    let mut heights = 0.0;
    for frame in sampled(recording) {
        for body in bodies {
            let middle = |parts: [&str; 2]| -> Option<[f64; 3]> {
                let [a, b] = parts.map(|part| recording.position(frame, *body.get(part)?));
                let (a, b) = (a?, b?);
                Some([0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis])))
            };
            let top = middle(["left_shoulder", "right_shoulder"]);
            let bottom = middle(["left_ankle", "right_ankle"])
                .or_else(|| middle(["left_knee", "right_knee"]))
                .or_else(|| middle(["left_hip", "right_hip"]));
            let (Some(top), Some(bottom)) = (top, bottom) else { continue };
            let off = [0, 1, 2].map(|axis| top[axis] - bottom[axis]);
            let height = off.iter().map(|x| x * x).sum::<f64>().sqrt();
            if height > 0.0 && height.is_finite() {
                sum = [0, 1, 2].map(|axis| sum[axis] + off[axis] / height);
                heights += 1.0;
            }
        }
    }
    let axis = (0..3).max_by(|a, b| sum[*a].abs().total_cmp(&sum[*b].abs())).unwrap_or(1);
    let help = "give the axis that points up with --up-axis (y or z)";
    if sum[axis].abs() < UPRIGHT * heights || heights == 0.0 {
        let message = "people do not stand along one axis: y is taken to point up";
        warnings.push(Diagnostic::warning("keypoints/up", message).with_help(help));
        return Up { axis: 1, negative: false };
    }
    let up = Up { axis, negative: sum[axis] < 0.0 };
    if up != (Up { axis: 1, negative: false }) {
        let message =
            format!("shoulders are above ankles along {}: turned so that y points up", up.name());
        warnings.push(Diagnostic::warning("keypoints/up", message).with_help(help));
    }
    up
}

/// Metres in one unit of the file, and the unit's name.
fn unit(
    recording: &Recording,
    bodies: &[Body],
    assumed: &Assumed,
    warnings: &mut Vec<Diagnostic>,
) -> (f64, LengthUnit) {
    let named = |metres: f64| {
        let all = [LengthUnit::Millimetre, LengthUnit::Centimetre, LengthUnit::Metre];
        all.into_iter().find(|unit| (unit.to_metres(1.0) - metres).abs() < 1e-12 * metres)
    };
    if let Some(metres) = assumed.metres_per_unit {
        return (metres, named(metres).unwrap_or(LengthUnit::Metre));
    }
    let mut legs: Vec<f64> = vec![];
    for frame in sampled(recording) {
        for body in bodies {
            for side in ["left", "right"] {
                let at = |part: &str| {
                    let key = canonical(&format!("{side}_{part}"))?;
                    recording.position(frame, *body.get(key)?)
                };
                let far = |a: [f64; 3], b: [f64; 3]| {
                    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
                };
                if let (Some(hip), Some(knee), Some(ankle)) = (at("hip"), at("knee"), at("ankle")) {
                    legs.push(far(hip, knee) + far(knee, ankle));
                }
            }
        }
    }
    legs.retain(|leg| leg.is_finite() && *leg > 0.0);
    legs.sort_by(f64::total_cmp);
    let help = "give it with --length-unit (m, cm, mm, or metres in a unit)";
    let mut warn = |message: String| {
        warnings.push(Diagnostic::warning("keypoints/unit", message).with_help(help));
    };
    let Some(&leg) = legs.get(legs.len() / 2) else {
        let unit = recording.unit_by_size().unwrap_or(LengthUnit::Metre);
        warn(format!(
            "the unit of length is not stated, and no leg tells it: read as {}",
            unit.name()
        ));
        return (unit.to_metres(1.0), unit);
    };
    let units = [LengthUnit::Metre, LengthUnit::Centimetre, LengthUnit::Millimetre];
    match units.into_iter().find(|unit| LEGS.contains(&unit.to_metres(leg))) {
        Some(unit) => {
            let message = format!(
                "the unit of length is not stated: legs of {leg:.4} are those of people in {}",
                unit.name()
            );
            warn(message);
            (unit.to_metres(1.0), unit)
        }
        None => {
            warn(format!("legs of {leg:.4} are those of people in no unit: brought to {LEG} m"));
            (LEG / leg, LengthUnit::Metre)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_turned_and_not_mirrored() {
        for axis in 0..3 {
            for negative in [false, true] {
                let up = Up { axis, negative };
                let mut along = [0.0; 3];
                along[axis] = if negative { -1.0 } else { 1.0 };
                assert_eq!(up.turned(along).map(|x| x + 0.0), [0.0, 1.0, 0.0], "{}", up.name());
                let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                    .map(|unit| condyle_math::Vec3::from(up.turned(unit)));
                assert_eq!(a.cross(b).dot(c), 1.0, "{}", up.name());
            }
        }
    }
}
