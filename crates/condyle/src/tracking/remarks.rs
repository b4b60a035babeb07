//! What a motion's file says of how far its columns can be trusted.

use super::{Determination, Tracking};
use crate::check::circles;
use condyle_model::{CoordinateId, Model};

/// A rotation without ends whose continuous angle leaves the range that its file gives.
#[derive(Clone, Debug, PartialEq)]
pub struct BeyondRange {
    /// Its key in the model.
    pub coordinate: String,
    /// The range of the file, in radians.
    pub range: [f64; 2],
    /// The least and the greatest value of the motion, in radians.
    pub values: [f64; 2],
    /// Frames beyond the range.
    pub frames: usize,
}

/// The longest line of names, in characters: OpenSim's reader recurses over the letters of a line.
const WIDTH: usize = 100;

impl Tracking {
    /// The rotations without ends that leave the clamped range of their file: q and q + 2π are the same
    /// posture, and the motion has the one that continues the frame before.
    pub fn beyond_range(&self, model: &Model) -> Vec<BeyondRange> {
        let beyond = |id: CoordinateId| {
            let (lower, upper) = model.coordinate(id).range.bounds();
            let mut values = [f64::INFINITY, f64::NEG_INFINITY];
            let mut frames = 0;
            for frame in 0..self.answers.len() {
                let value = model.value(self.answers.coordinates(frame), id);
                values = [values[0].min(value), values[1].max(value)];
                frames += usize::from(value < lower - 1e-9 || value > upper + 1e-9);
            }
            (frames > 0).then(|| BeyondRange {
                coordinate: model.coordinate_key(id),
                range: [lower, upper],
                values,
                frames,
            })
        };
        circles(model).into_iter().filter_map(beyond).collect()
    }

    /// What the header of a motion's file says: keys and values, in lines of at most 100 characters.
    ///
    /// `not_determined` has the coordinates that the markers determine in less than 90 % of the frames,
    /// each with its shares, `no_marker_moves` those that keep their rest, and `beyond_range` the rotations
    /// without ends that leave the range of their file. A list that goes on does so under `key_2`, `key_3`.
    /// There is nothing where every coordinate is determined.
    pub fn remarks(&self, model: &Model) -> Vec<(String, String)> {
        let percent = |share: f64| (100.0 * share).round().max(1.0);
        let unmoved: Vec<String> =
            self.unmoved.iter().map(|&id| model.coordinate_key(id)).collect();
        let all = self.determination(model);
        let unsure = all.iter().filter(|d| !d.is_sure() && !unmoved.contains(&d.coordinate));
        let unsure = unsure.map(|d| {
            let Determination { held, at_limit, weak, .. } = *d;
            let shares = [("held", held - at_limit), ("at a limit", at_limit), ("weak", weak)];
            let shares = shares.iter().filter(|(_, share)| *share > 1e-9);
            let shares = shares.map(|(kind, share)| format!("{kind} {} %", percent(*share)));
            format!("{} ({})", d.coordinate, shares.collect::<Vec<_>>().join(", "))
        });
        let beyond = self.beyond_range(model).into_iter().map(|beyond| {
            let degrees = |values: [f64; 2]| {
                let [a, b] = values.map(|value| (10.0 * value.to_degrees()).round() / 10.0);
                format!("{a} to {b} deg")
            };
            let (values, range) = (degrees(beyond.values), degrees(beyond.range));
            format!("{} ({values}; range {range}; a turn more is the same)", beyond.coordinate)
        });
        [
            ("not_determined", unsure.collect()),
            ("no_marker_moves", unmoved.clone()),
            ("beyond_range", beyond.collect()),
        ]
        .into_iter()
        .flat_map(|(key, names)| lines(key, names))
        .collect()
    }
}

/// A list over as many lines as it takes.
fn lines(key: &str, names: Vec<String>) -> Vec<(String, String)> {
    let mut lines: Vec<(String, String)> = vec![];
    for name in names {
        match lines.last_mut() {
            Some((key, line)) if key.len() + line.len() + name.len() + 3 <= WIDTH => {
                line.push_str(", ");
                line.push_str(&name);
            }
            Some(_) => lines.push((format!("{key}_{}", lines.len() + 1), name)),
            None => lines.push((key.to_owned(), name)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_goes_on_under_further_keys() {
        let names: Vec<String> = (0..40).map(|i| format!("coordinate_{i:02}")).collect();
        let lines = lines("held", names.clone());
        assert!(lines.iter().all(|(key, value)| key.len() + 1 + value.len() <= WIDTH));
        assert_eq!((&*lines[0].0, &*lines[1].0), ("held", "held_2"));
        let back: Vec<String> =
            lines.iter().flat_map(|(_, v)| v.split(", ").map(str::to_owned)).collect();
        assert_eq!(back, names);
    }
}
