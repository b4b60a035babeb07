//! Poses in JSON: the values of some coordinates, by name.
//!
//! ```text
//! file  = pose | [ pose, … ]
//! pose  = { "coordinate": value, … }
//! value = number (radians or metres) | [x, y, z, w] of an orientation
//! ```
//!
//! Coordinates that a pose does not name keep their defaults.

use crate::text::utf8;
use crate::{Diagnostic, Error, Place, Read};
use condyle_model::{CoordinateKind, Model};
use condyle_motion::Motion;
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
            let mut stored = model.defaults();
            let mut named = vec![false; model.coordinates().len()];
            for (key, value) in entries {
                let located = |error: Error| {
                    let said = error.into_diagnostics().swap_remove(0);
                    let message = format!("{}{}", self.place(index), said.message);
                    Error::from(Diagnostic { message, ..said })
                };
                let id = model.find_coordinate(key).map_err(located)?;
                named[id.index()] = true;
                let place = model.stored_range(id);
                let orientation = model.coordinate(id).kind == CoordinateKind::Orientation;
                let numbers = numbers(key, value, orientation).map_err(located)?;
                stored[place].copy_from_slice(&numbers);
            }
            resolved.motion.times.push(index as f64);
            resolved.motion.frames.push(stored);
            resolved.named.push(named);
        }
        Ok(resolved)
    }
}

/// The stored numbers of a coordinate: one, or four of an orientation.
fn numbers(key: &str, value: &Value, orientation: bool) -> Result<Vec<f64>, Error> {
    if orientation {
        let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
        let q: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
        return match q.len() == 4 && q.iter().any(|v| *v != 0.0) {
            true => Ok(q),
            false => {
                let message = format!("`{key}` is an orientation: give [x, y, z, w]");
                Err(Error::new("poses/orientation", message))
            }
        };
    }
    let message = || format!("`{key}` is {value}, not a number (radians or metres)");
    value.as_f64().map(|v| vec![v]).ok_or_else(|| Error::new("poses/number", message()))
}
