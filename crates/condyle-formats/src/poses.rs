//! Poses in JSON: the values of some coordinates, by name.
//!
//! ```text
//! file  = pose | [ pose, … ]
//! pose  = { "coordinate": value, … }
//! value = number (radians or metres) | "number unit" | [x, y, z, w] of an orientation
//! unit  = "deg" | "rad" of an angle; "m" | "cm" | "mm" | "in" | "ft" of a length
//! ```
//!
//! Coordinates that a pose does not name keep their defaults. Poses with a `"time": seconds` each are key
//! poses, between which a motion goes ([`Poses::keys`]); `"between": "linear"` or `"spline"` says how coordinates
//! leave a pose.

use crate::text::{number, utf8};
use crate::{Diagnostic, Error, LengthUnit, Place, Read};
use condyle_diagnostics::Warnings;
use condyle_model::{CoordinateKind, Model};
use condyle_motion::{Interpolation, Keys, Motion};
use serde_json::Value;

/// Poses by the names of coordinates, before a model says what these are.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Poses {
    poses: Vec<Vec<(String, Value)>>,
    listed: bool,
}

/// The poses of a model.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Resolved {
    /// One frame for each pose; its time is its number.
    pub motion: Motion,
    /// For each pose and coordinate, whether the pose names it.
    pub named: Vec<Vec<bool>>,
}

/// Reads one pose or a list of them.
///
/// # Errors
/// `poses/syntax` if it is no JSON, `poses/shape` if it is neither.
///
/// ```
/// use condyle_formats::poses;
/// use condyle_model::ModelBuilder;
/// # use condyle_math::Vec3;
/// # let mut b = ModelBuilder::new("arm");
/// # let forearm = b.segment("forearm", None);
/// # b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// # let model = b.build()?;
/// let poses = poses::read(br#"[{}, {"flexion": 1.5}]"#)?.value.resolve(&model)?;
/// assert_eq!(poses.motion.frames, [[0.0], [1.5]]);
/// assert_eq!(poses.named, [[false], [true]]);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Read<Poses>, Error> {
    let value = serde_json::from_str(utf8(bytes)?).map_err(|error| {
        Error::new("poses/syntax", error.to_string()).at(Place::at(error.line(), error.column()))
    })?;
    let (list, listed) = match value {
        Value::Array(list) => (list, true),
        one => (vec![one], false),
    };
    let mut poses = Poses { poses: vec![], listed };
    for (index, pose) in list.into_iter().enumerate() {
        let Value::Object(entries) = pose else {
            let message = r#"a pose is an object such as {"knee_angle_r": 0.5}"#;
            return Err(Error::new("poses/shape", format!("{}{message}", poses.place(index))));
        };
        poses.poses.push(entries.into_iter().collect());
    }
    Ok(Read::clean(poses))
}

impl Poses {
    fn place(&self, index: usize) -> String {
        if self.listed { format!("pose {index}: ") } else { String::new() }
    }

    /// The poses of a model.
    ///
    /// # Errors
    /// Names that the model does not have or that are ambiguous, and values that are no numbers.
    pub fn resolve(&self, model: &Model) -> Result<Resolved, Error> {
        let mut resolved = Resolved::default();
        for (index, entries) in self.poses.iter().enumerate() {
            let entries = entries.iter();
            let (stored, named) =
                pose(model, entries).map_err(|error| self.located(index, error))?;
            resolved.motion.times.push(index as f64);
            resolved.motion.frames.push(stored);
            resolved.named.push(named);
        }
        Ok(resolved)
    }

    /// The key poses of a model: each has a `time` in seconds, later than that of the one before.
    ///
    /// # Errors
    /// As [`Poses::resolve`]; `poses/time` where a time is missing, no number, or not after the one before;
    /// `poses/between` where the way to the next pose is not known.
    ///
    /// ```
    /// use condyle_formats::poses;
    /// use condyle_model::ModelBuilder;
    /// # use condyle_math::Vec3;
    /// # let mut b = ModelBuilder::new("arm");
    /// # let forearm = b.segment("forearm", None);
    /// # b.hinge("elbow", forearm, "flexion", Vec3::Z);
    /// # let model = b.build()?;
    /// let text = br#"[{"time": 0, "flexion": 0.5}, {"time": 0.4, "flexion": 1.5}]"#;
    /// let keys = poses::read(text)?.value.keys(&model)?;
    /// assert_eq!(keys.times, [0.0, 0.4]);
    /// let twice = poses::read(br#"[{"time": 1}, {"time": 1}]"#)?.value.keys(&model);
    /// let said = "pose 1: the time 1 is also that of pose 0 (give each pose a later time)";
    /// assert_eq!(twice.unwrap_err().to_string(), said);
    /// # Ok::<(), condyle_formats::Error>(())
    /// ```
    pub fn keys(&self, model: &Model) -> Result<Keys, Error> {
        let mut keys = Keys::default();
        for (index, entries) in self.poses.iter().enumerate() {
            let wrong = |message: String, help: &str| {
                self.located(index, Error::new("poses/time", message).with_help(help))
            };
            let time = match entries.iter().find(|(key, _)| key == TIME).map(|(_, v)| v) {
                None => return Err(wrong("it has no `time`".into(), "give seconds")),
                Some(value) => match value.as_f64() {
                    Some(time) => time,
                    None => return Err(wrong(format!("`time` is {value}"), "give seconds")),
                },
            };
            if let Some(&before) = keys.times.last()
                && time <= before
            {
                let message = if time == before {
                    format!("the time {time} is also that of pose {}", index - 1)
                } else {
                    format!("the time {time} is before that of pose {}, {before}", index - 1)
                };
                return Err(wrong(message, "give each pose a later time"));
            }
            let leave = match entries.iter().find(|(key, _)| key == BETWEEN).map(|(_, v)| v) {
                None => None,
                Some(way) => match way.as_str() {
                    Some("linear") => Some(Interpolation::Linear),
                    Some("spline") => Some(Interpolation::Spline),
                    _ => {
                        let error = Error::new("poses/between", format!("`between` is {way}"))
                            .with_help("give \"linear\" or \"spline\"");
                        return Err(self.located(index, error));
                    }
                },
            };
            keys.leave.push(leave);
            let entries = entries.iter().filter(|(key, _)| key != TIME && key != BETWEEN);
            let (stored, named) =
                pose(model, entries).map_err(|error| self.located(index, error))?;
            keys.times.push(time);
            keys.frames.push(stored);
            keys.named.push(named);
        }
        Ok(keys)
    }

    /// What is odd about the values of a model: angles of more than a turn, which may be degrees, and
    /// orientations that are not of length 1, which are brought to it.
    #[must_use]
    pub fn remarks(&self, model: &Model) -> Vec<Diagnostic> {
        let mut warnings = Warnings::default();
        for (index, entries) in self.poses.iter().enumerate() {
            for (key, value) in entries {
                let Ok(id) = model.find_coordinate(key) else { continue };
                let kind = model.coordinate(id).kind;
                let place = self.place(index);
                if let (CoordinateKind::Rotation, Some(angle)) = (kind, value.as_f64())
                    && angle.abs() > std::f64::consts::TAU
                {
                    warnings.add("poses/angle", || {
                        let degrees = angle.to_degrees();
                        let message =
                            format!("{place}`{key}` is {angle} rad, which is {degrees:.0}°");
                        let help = format!("write \"{angle} deg\" if degrees are meant");
                        Diagnostic::warning("poses/angle", message).with_help(help)
                    });
                }
                if let (CoordinateKind::Orientation, Some(list)) = (kind, value.as_array()) {
                    let q: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
                    let length = length(&q);
                    if (length - 1.0).abs() > 1e-3 {
                        warnings.add("poses/orientation", || {
                            let message = format!("{place}`{key}` has length {length:.6}, not 1");
                            let help = "it is brought to length 1; the order is x, y, z, w";
                            Diagnostic::warning("poses/orientation", message).with_help(help)
                        });
                    }
                }
            }
        }
        warnings.finish()
    }

    /// Whether these are key poses: a list in which each has a time.
    #[must_use]
    pub fn are_keys(&self) -> bool {
        let timed = |pose: &Vec<(String, Value)>| pose.iter().any(|(key, _)| key == TIME);
        self.listed && !self.poses.is_empty() && self.poses.iter().all(timed)
    }

    fn located(&self, index: usize, error: Error) -> Error {
        let said = error.into_diagnostics().swap_remove(0);
        let message = format!("{}{}", self.place(index), said.message);
        Error::from(Diagnostic { message, ..said })
    }
}

/// The key of a time among those of coordinates.
const TIME: &str = "time";
/// The key of the way to the next pose.
const BETWEEN: &str = "between";

/// The stored numbers of one pose, and which coordinates it names.
fn pose<'p>(
    model: &Model,
    entries: impl Iterator<Item = &'p (String, Value)>,
) -> Result<(Vec<f64>, Vec<bool>), Error> {
    let mut stored = model.defaults();
    let mut named = vec![false; model.coordinates().len()];
    for (key, value) in entries {
        let id = model.find_coordinate(key).map_err(|error| match key.as_str() {
            TIME => error.with_help("times are read with --rate, as key poses"),
            _ => error,
        })?;
        named[id.index()] = true;
        let place = model.stored_range(id);
        let kind = model.coordinate(id).kind;
        stored[place].copy_from_slice(&numbers(key, value, kind)?);
    }
    Ok((stored, named))
}

/// Writes one pose, coordinates that follow others left out.
///
/// Numbers are written so that reading gives the same bits; what is no finite number is left out.
///
/// # Panics
/// If `stored` has not as many numbers as the model stores.
#[must_use]
pub fn write(model: &Model, stored: &[f64]) -> String {
    let keys = model.coordinate_keys();
    let free = model.coordinate_ids().filter(|&id| model.coordinate(id).follows.is_none());
    let lines = free.filter_map(|id| {
        let numbers = &stored[model.stored_range(id)];
        let value = match numbers {
            [one] => Value::from(*one),
            several => Value::from(several),
        };
        let finite = numbers.iter().all(|v| v.is_finite());
        finite.then(|| format!("  {}: {value}", Value::from(keys[id.index()].as_str())))
    });
    format!("{{\n{}\n}}\n", lines.collect::<Vec<_>>().join(",\n"))
}

/// The stored numbers of a coordinate: one, or four of an orientation.
fn numbers(key: &str, value: &Value, kind: CoordinateKind) -> Result<Vec<f64>, Error> {
    if kind == CoordinateKind::Orientation {
        let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
        let q: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
        let length = length(&q);
        return match (list.len(), q.len()) {
            (4, 4) if length > SHORTEST && length.is_finite() => Ok(q),
            (4, 4) => {
                let message = format!("the orientation `{key}` has length {length}, not 1");
                Err(Error::new("poses/orientation", message))
            }
            (count, _) => {
                let message = format!("`{key}` is an orientation: give [x, y, z, w]");
                let error = Error::new("poses/orientation", message);
                Err(match value.is_array() {
                    true => error.with_help(format!("four numbers, not {count} values")),
                    false => error,
                })
            }
        };
    }
    if let Some(text) = value.as_str() {
        return with_unit(key, text, kind).map(|v| vec![v]);
    }
    let message = || format!("`{key}` is {value}, not a number (radians or metres)");
    value.as_f64().map(|v| vec![v]).ok_or_else(|| Error::new("poses/number", message()))
}

/// Orientations of a smaller length have no direction.
const SHORTEST: f64 = 1e-9;

fn length(q: &[f64]) -> f64 {
    q.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The number of a text such as `90 deg` or `12 mm`, in radians or metres.
fn with_unit(key: &str, text: &str, kind: CoordinateKind) -> Result<f64, Error> {
    let text = text.trim();
    let end = text.find(|c: char| c.is_alphabetic() && !"eE".contains(c) || "°\"".contains(c));
    let (digits, unit) = text.split_at(end.unwrap_or(text.len()));
    let unit = unit.trim().trim_end_matches('.').to_lowercase();
    let wrong = |help: &str| {
        let message = format!("`{key}` is `{text}`");
        Err(Error::new("poses/number", message).with_help(help))
    };
    let Some(number) = number(digits).filter(|v| v.is_finite()) else {
        return wrong("give a number, or a text such as \"90 deg\" or \"12 mm\"");
    };
    match kind {
        CoordinateKind::Rotation => match unit.as_str() {
            "deg" | "degree" | "degrees" | "°" => Ok(number.to_radians()),
            "rad" | "radian" | "radians" => Ok(number),
            _ => wrong("it is an angle: give \"90 deg\" or \"1.5 rad\", or a number in radians"),
        },
        CoordinateKind::Translation => match LengthUnit::from_name(&unit) {
            Some(unit) => Ok(unit.to_metres(number)),
            None => wrong("it is a length: give \"12 mm\" or \"0.012 m\", or a number in metres"),
        },
        _ => wrong("it has no unit: give a number"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::ModelBuilder;

    fn model() -> Model {
        let mut b = ModelBuilder::new("arm");
        let [forearm, hand] = ["forearm", "hand"].map(|name| b.segment(name, None));
        let (set, _) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
        b.coordinate(set, "slide", CoordinateKind::Translation);
        b.ball_joint("wrist", hand);
        b.build().unwrap()
    }

    fn resolved(text: &str) -> Result<(Vec<f64>, Vec<&'static str>), String> {
        let (model, poses) = (model(), read(text.as_bytes()).unwrap().value);
        let said = poses.remarks(&model).iter().map(|d| d.code).collect();
        let resolved = poses.resolve(&model).map_err(|error| error.to_string())?;
        Ok((resolved.motion.frames.concat(), said))
    }

    #[test]
    fn numbers_are_read_to_the_last_bit() {
        let model = model();
        // The first two are read off by one unit in the last place where digits are summed up in f64.
        for number in [-0.428_749_999_999_999_96, 1.832_595_714_594_046_1, 0.1, 1e-300] {
            let mut stored = model.defaults();
            stored[0] = number;
            let again = read(write(&model, &stored).as_bytes()).unwrap().value;
            assert_eq!(again.resolve(&model).unwrap().motion.frames[0][0], number);
        }
    }

    #[test]
    fn a_key_may_say_how_it_is_left() {
        let text =
            br#"[{"time": 0, "between": "linear"}, {"time": 1, "between": "spline"}, {"time": 2}]"#;
        let poses = read(text).unwrap().value;
        assert!(poses.are_keys());
        let ways = [Some(Interpolation::Linear), Some(Interpolation::Spline), None];
        assert_eq!(poses.keys(&model()).unwrap().leave, ways);
        for way in ["1", "\"cubic\"", "null"] {
            let text = format!("[{{\"time\": 0, \"between\": {way}}}]");
            let said = read(text.as_bytes()).unwrap().value.keys(&model()).unwrap_err();
            assert_eq!(said.code(), "poses/between");
        }
        for none in ["[]", "{\"time\": 1}", "[{\"time\": 1}, {}]"] {
            assert!(!read(none.as_bytes()).unwrap().value.are_keys(), "{none}");
        }
    }

    #[test]
    fn texts_have_units() {
        for (value, radians) in [
            ("\"90 deg\"", std::f64::consts::FRAC_PI_2),
            ("\"-180°\"", -std::f64::consts::PI),
            ("\"1.5 rad\"", 1.5),
            ("\"1e-1 Radians\"", 0.1),
            ("1.5", 1.5),
        ] {
            let (stored, said) = resolved(&format!("{{\"flexion\": {value}}}")).unwrap();
            assert_eq!((stored[0], said), (radians, vec![]), "{value}");
        }
        for (value, metres) in [("\"12 mm\"", 0.012), ("\"1.2cm\"", 0.012), ("\"2 m\"", 2.0)] {
            assert_eq!(
                resolved(&format!("{{\"slide\": {value}}}")).unwrap().0[1],
                metres,
                "{value}"
            );
        }
        for wrong in [
            r#"{"flexion": "90"}"#,
            r#"{"flexion": "90 mm"}"#,
            r#"{"flexion": "deg"}"#,
            r#"{"flexion": "1 2 deg"}"#,
            r#"{"flexion": "inf deg"}"#,
            r#"{"slide": "3 deg"}"#,
            r#"{"slide": ""}"#,
        ] {
            assert!(resolved(wrong).unwrap_err().contains("give"), "{wrong}");
        }
    }

    #[test]
    fn large_angles_and_lengths_of_orientations_are_remarked() {
        let (stored, said) = resolved(r#"{"flexion": 90}"#).unwrap();
        assert_eq!((stored[0], said), (90.0, vec!["poses/angle"]));
        // More than a turn is meant where the unit is written.
        assert_eq!(resolved(r#"{"flexion": "720 deg"}"#).unwrap().1, [""; 0]);
        let wrist = |q: &str| resolved(&format!("{{\"orientation\": {q}}}"));
        assert_eq!(wrist("[0, 0, 0.6, 0.8]").unwrap().1, [""; 0]);
        assert_eq!(wrist("[0, 0, 6, 8]").unwrap().1, ["poses/orientation"]);
        for wrong in [
            "[0, 0, 1]",
            "[0, 0, 0, 0, 1]",
            "[0, 0, 0, 0]",
            "[0, 0, 0, \"1\"]",
            "1",
            "[0,0,0,1,\"x\"]",
        ] {
            assert!(wrist(wrong).is_err(), "{wrong}");
        }
    }
}
