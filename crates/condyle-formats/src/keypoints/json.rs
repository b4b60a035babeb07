//! Keypoints in JSON, as the tools lay it out.

use super::raw::{Named, Person, Raw};
use super::sets::KeypointSet;
use condyle_diagnostics::{Diagnostic, Error, Place, Read};
use serde_json::{Map, Value};

/// The words that tell keypoints from other JSON.
pub(super) const KEYS: [&str; 14] = [
    "pose_keypoints_3d",
    "pose_keypoints_2d",
    "keypoints_3d",
    "keypoints3D",
    "keypoints",
    "keypoint_scores",
    "instance_info",
    "people",
    "instances",
    "landmarks",
    "world_landmarks",
    "pose_world_landmarks",
    "poseWorldLandmarks",
    "worldLandmarks",
];

/// The people of a frame.
const PEOPLE: [&str; 6] = ["people", "persons", "instances", "predictions", "bodies", "detections"];
/// The points of a person, those with depth first.
const POINTS: [&str; 10] = [
    "pose_keypoints_3d",
    "keypoints_3d",
    "keypoints3D",
    "pose_world_landmarks",
    "poseWorldLandmarks",
    "world_landmarks",
    "worldLandmarks",
    "keypoints",
    "landmarks",
    "joints",
];
/// The confidences of points that do not carry them.
const SCORES: [&str; 5] =
    ["keypoint_scores", "keypoints_scores", "scores", "confidences", "confidence"];
/// The confidence of one point.
const SCORE: [&str; 7] =
    ["score", "confidence", "visibility", "c", "conf", "likelihood", "presence"];
/// Lists of frames.
const FRAMES: [&str; 4] = ["frames", "instance_info", "data", "annotations"];
const RATES: [&str; 5] = ["fps", "rate", "frame_rate", "framerate", "frameRate"];
const NAMES: [&str; 4] = ["names", "keypoint_names", "keypoints_names", "joint_names"];

/// Reads a document, or a document a line.
pub(super) fn read(text: &str) -> Result<Read<Raw>, Error> {
    let mut reader = Reader::default();
    let whole: Result<Value, _> = serde_json::from_str(text);
    match whole {
        Ok(value) => reader.document(&value)?,
        Err(error) => {
            // Lines are tried where the first one is whole.
            let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
            if serde_json::from_str::<Value>(first).is_err() || error.line() < 2 {
                return Err(syntax(&error, error.line()));
            }
            for (number, line) in text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty()) {
                let value: Value =
                    serde_json::from_str(line).map_err(|error| syntax(&error, number + 1))?;
                reader.frame(&value)?;
            }
        }
    }
    reader.finish()
}

fn syntax(error: &serde_json::Error, line: usize) -> Error {
    Error::new("keypoints/syntax", error.to_string()).at(Place::at(line, error.column()))
}

#[derive(Default)]
struct Reader {
    raw: Raw,
    /// Names of points in lists, where the file gives them.
    names: Vec<String>,
    /// Frames that say when they are, and all.
    timed: usize,
    frames: usize,
    /// People without any point, and points without depth.
    flat: bool,
}

/// The first of these keys that an object has.
fn any<'v>(object: &'v Map<String, Value>, keys: &[&str]) -> Option<&'v Value> {
    keys.iter().find_map(|key| object.get(*key))
}

impl Reader {
    fn document(&mut self, value: &Value) -> Result<(), Error> {
        match value {
            Value::Array(frames) => self.list(frames),
            Value::Object(object) => {
                self.raw.rate = any(object, &RATES).and_then(Value::as_f64).filter(|r| *r > 0.0);
                self.header(object);
                if let Some(frames) = any(object, &FRAMES).and_then(Value::as_array) {
                    return self.list(frames);
                }
                // Frames by their numbers.
                let mut numbered: Vec<(f64, &Value)> = object
                    .iter()
                    .filter_map(|(key, value)| Some((key.parse::<f64>().ok()?, value)))
                    .collect();
                if numbered.is_empty() || numbered.len() < object.len() {
                    return self.frame(value);
                }
                numbered.sort_by(|a, b| a.0.total_cmp(&b.0));
                numbered.into_iter().try_for_each(|(_, frame)| self.frame(frame))
            }
            _ => Err(shape("it is neither an object nor a list")),
        }
    }

    /// Names of points and of their set.
    fn header(&mut self, object: &Map<String, Value>) {
        let meta = object.get("meta_info").and_then(Value::as_object);
        let places = [Some(object), meta];
        for place in places.into_iter().flatten() {
            if let Some(list) = any(place, &NAMES).and_then(Value::as_array) {
                self.names = list.iter().filter_map(Value::as_str).map(str::to_owned).collect();
            }
            if let Some(by_number) = place.get("keypoint_id2name").and_then(Value::as_object) {
                let mut list: Vec<(usize, &str)> = by_number
                    .iter()
                    .filter_map(|(key, name)| Some((key.parse().ok()?, name.as_str()?)))
                    .collect();
                list.sort_unstable();
                self.names = list.into_iter().map(|(_, name)| name.to_owned()).collect();
            }
            let said = ["set", "keypoint_set", "dataset_name", "dataset", "format"];
            if let Some(set) = any(place, &said).and_then(Value::as_str) {
                self.raw.set = KeypointSet::named(set, 17);
            }
        }
    }

    fn list(&mut self, frames: &[Value]) -> Result<(), Error> {
        frames.iter().try_for_each(|frame| self.frame(frame))
    }

    fn frame(&mut self, value: &Value) -> Result<(), Error> {
        let number = self.frames;
        self.frames += 1;
        let located = |error: Error| -> Error {
            let said = error.into_diagnostics().swap_remove(0);
            Error::from(Diagnostic { message: format!("frame {number}: {}", said.message), ..said })
        };
        let mut people = vec![];
        let mut time = None;
        match value {
            Value::Array(list) => {
                // A list of people, or the points of one.
                let one = list.iter().all(|point| self.is_point(point));
                let each: &[Value] = if one { std::slice::from_ref(value) } else { list };
                for person in each {
                    people.extend(self.person(person).map_err(located)?);
                }
            }
            Value::Object(object) => {
                time = when(object);
                match any(object, &PEOPLE).and_then(Value::as_array) {
                    Some(list) => {
                        for person in list {
                            people.extend(self.person(person).map_err(located)?);
                        }
                    }
                    None => people.extend(self.person(value).map_err(located)?),
                }
            }
            _ => return Err(located(shape("a frame is an object or a list"))),
        }
        self.timed += usize::from(time.is_some());
        let time = match time {
            Some(seconds) if self.timed == self.frames => {
                self.raw.in_seconds = true;
                seconds
            }
            _ if self.raw.in_seconds => {
                return Err(located(Error::new("keypoints/time", "it does not say when it is")));
            }
            _ => number as f64,
        };
        self.raw.add_frame(time, people)
    }

    fn is_point(&self, value: &Value) -> bool {
        let numbers = |list: &[Value]| list.iter().all(|v| v.is_number() || v.is_null());
        value.as_array().is_some_and(|list| (3..=4).contains(&list.len()) && numbers(list))
    }

    /// A person; none where nothing was found.
    fn person(&mut self, value: &Value) -> Result<Option<Person>, Error> {
        let (points, scores, name) = match value {
            Value::Object(object) => {
                let is_filled = |key: &&str| {
                    object.get(*key).is_some_and(|v| match v {
                        Value::Array(list) => !list.is_empty(),
                        other => other.is_object(),
                    })
                };
                let Some(key) = POINTS.iter().find(|key| is_filled(key)) else {
                    let flat = object.get("pose_keypoints_2d").and_then(Value::as_array);
                    self.flat |= flat.is_some_and(|list| !list.is_empty());
                    return Ok(None);
                };
                let scores = any(object, &SCORES).and_then(Value::as_array);
                let id = any(
                    object,
                    &["person_id", "track_id", "instance_id", "id", "idx", "name", "subject"],
                );
                (object.get(*key), scores, id.and_then(name_of))
            }
            list => (Some(list), None, None),
        };
        let Some(points) = points else { return Ok(None) };
        let points = self.points(points, scores)?;
        Ok((!points.is_empty()).then_some(Person { name, points }))
    }

    fn points(&mut self, value: &Value, scores: Option<&Vec<Value>>) -> Result<Vec<Named>, Error> {
        let score = |index: usize| scores.and_then(|list| list.get(index)).and_then(Value::as_f64);
        match value {
            Value::Object(by_name) => {
                let mut points = vec![];
                for (name, point) in by_name {
                    points.extend(self.point(name, point, None)?);
                }
                Ok(points)
            }
            Value::Array(list) => match list.first() {
                // A person in a list of its own.
                Some(Value::Array(inner)) if inner.first().is_some_and(Value::is_array) => {
                    self.points(&list[0], scores.and_then(|s| s.first()?.as_array()).or(scores))
                }
                Some(Value::Array(_)) => {
                    let names = self.list_names(list.len())?;
                    let mut points = vec![];
                    for (index, (point, name)) in list.iter().zip(&names).enumerate() {
                        points.extend(self.point(name, point, score(index))?);
                    }
                    Ok(points)
                }
                Some(Value::Object(_)) => {
                    let named = |point: &Value| {
                        let key = ["name", "part", "keypoint", "joint", "label"];
                        any(point.as_object()?, &key)?.as_str().map(str::to_owned)
                    };
                    let names: Option<Vec<String>> = list.iter().map(named).collect();
                    let names = match names {
                        Some(names) => names,
                        None => self.list_names(list.len())?,
                    };
                    let mut points = vec![];
                    for (index, (point, name)) in list.iter().zip(&names).enumerate() {
                        points.extend(self.point(name, point, score(index))?);
                    }
                    Ok(points)
                }
                Some(_) => self.flat_list(list, scores.is_some(), &score),
                None => Ok(vec![]),
            },
            _ => Err(shape("its points are neither a list nor an object")),
        }
    }

    /// A list of numbers: x, y, z and the confidence, one point after the other.
    fn flat_list(
        &mut self,
        list: &[Value],
        scored: bool,
        score: &dyn Fn(usize) -> Option<f64>,
    ) -> Result<Vec<Named>, Error> {
        let known =
            |count: usize| self.names.len() == count || KeypointSet::of_size(count).is_some();
        let fits = |width: usize| list.len().is_multiple_of(width) && known(list.len() / width);
        let width = match (fits(4), fits(3)) {
            (true, _) => 4,
            (false, true) if scored => 3,
            (false, true) => return Err(two_dimensional()),
            _ => {
                let message = format!("a list of {} numbers is no whole set of points", list.len());
                let help = "each has x, y, z and its confidence";
                return Err(Error::new("keypoints/set", message).with_help(help));
            }
        };
        let names = self.list_names(list.len() / width)?;
        let numbers = |chunk: &[Value]| -> Vec<f64> {
            chunk.iter().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
        };
        let points = list.chunks_exact(width).zip(names).enumerate();
        Ok(points
            .map(|(index, (chunk, name))| {
                let p = numbers(chunk);
                (name, [p[0], p[1], p[2]], p.get(3).copied().or_else(|| score(index)))
            })
            .collect())
    }

    fn list_names(&mut self, count: usize) -> Result<Vec<String>, Error> {
        if self.names.len() == count {
            return Ok(self.names.clone());
        }
        Ok(self.raw.names_of(count)?.iter().map(|name| (*name).to_owned()).collect())
    }

    /// One point; none for one that is null.
    fn point(
        &mut self,
        name: &str,
        value: &Value,
        score: Option<f64>,
    ) -> Result<Option<Named>, Error> {
        let number = |value: &Value| -> Result<f64, Error> {
            match value {
                Value::Null => Ok(f64::NAN),
                other => other.as_f64().ok_or_else(|| {
                    Error::new("keypoints/number", format!("`{name}` has {other} for a number"))
                }),
            }
        };
        match value {
            Value::Null => Ok(None),
            Value::Array(list) => match &list[..] {
                [_, _] => Err(two_dimensional()),
                [x, y, z, rest @ ..] => {
                    let own = rest.first().and_then(Value::as_f64);
                    let at = [number(x)?, number(y)?, number(z)?];
                    Ok(Some((name.to_owned(), at, own.or(score))))
                }
                _ => Err(shape("a point has x, y and z")),
            },
            Value::Object(point) => {
                let axis = |lower: &str, upper: &str| {
                    point.get(lower).or_else(|| point.get(upper)).map(number).transpose()
                };
                let (x, y, z) = (axis("x", "X")?, axis("y", "Y")?, axis("z", "Z")?);
                let own = any(point, &SCORE).and_then(Value::as_f64);
                match (x, y, z) {
                    (Some(x), Some(y), Some(z)) => {
                        Ok(Some((name.to_owned(), [x, y, z], own.or(score))))
                    }
                    (Some(_), Some(_), None) => Err(two_dimensional()),
                    _ => Err(shape("a point has x, y and z")),
                }
            }
            other => {
                Err(Error::new("keypoints/number", format!("`{name}` is {other}, not a point")))
            }
        }
    }

    fn finish(self) -> Result<Read<Raw>, Error> {
        if self.raw.points.is_empty() {
            if self.flat {
                return Err(two_dimensional());
            }
            return Err(shape("no frame has points of a person"));
        }
        let mut warnings = vec![];
        if self.flat {
            let message = "some people have points without depth alone: they are left out";
            warnings.push(Diagnostic::warning("keypoints/two-dimensional", message));
        }
        if let (Some(set), true) = (self.raw.set, self.names.is_empty()) {
            let message = format!("points without names are those of {}", set.name);
            warnings.push(Diagnostic::note("keypoints/set", message));
        }
        Ok(Read { value: self.raw, warnings })
    }
}

/// What a person is called: OpenPose writes `[-1]` for one that has no name.
fn name_of(value: &Value) -> Option<String> {
    match value {
        Value::String(name) => Some(name.replace(':', "-")),
        Value::Number(id) if id.as_f64()? >= 0.0 => Some(format!("person{id}")),
        Value::Array(list) => match &list[..] {
            [one] if !one.is_array() => name_of(one),
            _ => None,
        },
        _ => None,
    }
}

/// When a frame is, in seconds, if it says so.
fn when(frame: &Map<String, Value>) -> Option<f64> {
    let seconds = any(frame, &["time", "timestamp", "time_s", "t"]).and_then(Value::as_f64);
    let thousandths = any(frame, &["timestamp_ms", "time_ms"]).and_then(Value::as_f64);
    seconds.or(thousandths.map(|ms| 1e-3 * ms))
}

fn shape(what: &str) -> Error {
    Error::new("keypoints/shape", what).with_help(
        "known are OpenPose's `people`, MMPose's `instance_info`, and lists of frames with `keypoints`",
    )
}

fn two_dimensional() -> Error {
    let message = "points have x and y alone, and nothing says how far away they are";
    Error::new("keypoints/two-dimensional", message)
        .with_help("triangulate two cameras, or lift them to three dimensions, first")
}
