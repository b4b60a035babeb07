//! Animations: keys of nodes, and their values at any time.
//!
//! Between the keys at times a and b, with u = (t - a)/(b - a) and d = b - a:
//!
//! - LINEAR: p(t) = (1 - u)·pa + u·pb; a rotation goes along the shorter arc at constant speed;
//! - STEP: p(t) = pa;
//! - CUBICSPLINE: p(t) = (2u³ - 3u² + 1)·pa + d(u³ - 2u² + u)·out_a + (3u² - 2u³)·pb + d(u³ - u²)·in_b; a
//!   rotation is normalised.
//!
//! Before the first key and after the last, their values hold.

use super::accessor::{Accessors, Numbers};
use super::json::Item;
use super::scene::LocalPose;
use condyle_diagnostics::{Diagnostic, Error, Warnings};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// How a channel goes from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Between {
    Linear,
    Step,
    Cubic,
}

/// What a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Path {
    Translation,
    Rotation,
    Scale,
}

/// The keys of one property of one node.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    pub(crate) node: usize,
    pub(crate) path: Path,
    pub(crate) between: Between,
    /// Rising.
    pub(crate) times: Rc<Vec<f64>>,
    /// For each time its place among the keys of `values`.
    keys: Rc<Vec<usize>>,
    values: Rc<Numbers>,
}

/// An animation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clip {
    pub(crate) channels: Vec<Channel>,
}

impl Channel {
    /// A channel with a value at each of these times, linear between them; of a clock times, and the numbers of their keys.
    #[cfg(feature = "fbx")]
    pub(crate) fn sampled(
        node: usize,
        path: Path,
        (times, keys): (&Rc<Vec<f64>>, &Rc<Vec<usize>>),
        values: Vec<f64>,
    ) -> Self {
        let width = if path == Path::Rotation { 4 } else { 3 };
        let values = Rc::new(Numbers { values, width });
        let (times, keys) = (Rc::clone(times), Rc::clone(keys));
        Self { node, path, between: Between::Linear, times, keys, values }
    }

    /// Its value at a time: three numbers or a unit quaternion.
    pub(super) fn at(&self, time: f64) -> [f64; 4] {
        let after = self.times.partition_point(|t| *t <= time);
        let (Some(last), key) = (self.times.len().checked_sub(1), after.saturating_sub(1)) else {
            return [0.0; 4];
        };
        let settled = |value| if self.path == Path::Rotation { unit(value) } else { value };
        if after == 0 || key >= last || self.between == Between::Step {
            return settled(self.key(key, 1));
        }
        let (a, b) = (self.times[key], self.times[key + 1]);
        let d = b - a;
        let u = (time - a) / d;
        let (pa, pb) = (self.key(key, 1), self.key(key + 1, 1));
        if self.between == Between::Linear {
            return match self.path {
                Path::Rotation => slerp(unit(pa), unit(pb), u),
                _ => std::array::from_fn(|i| pa[i] + u * (pb[i] - pa[i])),
            };
        }
        let (out, into) = (self.key(key, 2), self.key(key + 1, 0));
        let (u2, u3) = (u * u, u * u * u);
        settled(std::array::from_fn(|i| {
            (2.0 * u3 - 3.0 * u2 + 1.0) * pa[i]
                + d * (u3 - 2.0 * u2 + u) * out[i]
                + (3.0 * u2 - 2.0 * u3) * pb[i]
                + d * (u3 - u2) * into[i]
        }))
    }

    /// The value of a key (part 1), or for splines its tangents (parts 0 and 2).
    fn key(&self, key: usize, part: usize) -> [f64; 4] {
        let key = self.keys.get(key).copied().unwrap_or(0);
        let element = if self.between == Between::Cubic { 3 * key + part } else { key };
        let width = self.values.width;
        let numbers = self.values.values.get(element * width..).unwrap_or_default();
        std::array::from_fn(
            |i| if i < width { numbers.get(i).copied().unwrap_or(0.0) } else { 0.0 },
        )
    }

    /// Whether it has the same value at every key, to single precision and a little more.
    pub(crate) fn is_still(&self) -> bool {
        let first = self.key(0, 1);
        let least = 2e-6 * first.iter().fold(0.0, |most: f64, x| most.max(x.abs())) + 1e-7;
        let near = |a: [f64; 4]| a.iter().zip(first).all(|(a, b)| (a - b).abs() <= least);
        let tangent = |key, part| self.key(key, part).iter().all(|x| x.abs() <= least);
        (0..self.times.len()).all(|key| {
            near(self.key(key, 1))
                && (self.between != Between::Cubic || tangent(key, 0) && tangent(key, 2))
        })
    }
}

impl Clip {
    /// Reads an animation.
    ///
    /// # Errors
    /// `glb/json`, `glb/reference`, `glb/keys` where values and times are not of one number, `glb/time` where times go
    /// back; what [`Accessors::numbers`] finds.
    pub(super) fn read(
        item: &Item<'_>,
        nodes: usize,
        accessors: &mut Accessors<'_, '_, '_>,
        warnings: &mut Warnings,
    ) -> Result<Self, Error> {
        let mut clocks = HashMap::new();
        let mut place_of = HashMap::new();
        let mut channels: Vec<Channel> = vec![];
        for channel in item.list("channels")? {
            let target = channel.need("target")?;
            let path = match target.text("path").unwrap_or("") {
                "translation" => Path::Translation,
                "rotation" => Path::Rotation,
                "scale" => Path::Scale,
                other => {
                    warnings.add("glb/channel", || {
                        let message = format!("{} moves `{other}`", channel.shown());
                        Diagnostic::warning("glb/channel", message)
                            .with_help("translations, rotations and scales are read")
                    });
                    continue;
                }
            };
            // What an extension says instead of a node.
            let Some(node) = target.index_below("node", nodes, "node")? else { continue };
            let sampler = item.element("samplers", channel.need("sampler")?.index()?)?;
            let between = match sampler.text("interpolation").unwrap_or("LINEAR") {
                "LINEAR" => Between::Linear,
                "STEP" => Between::Step,
                "CUBICSPLINE" => Between::Cubic,
                other => {
                    let message = format!("{} interpolates by `{other}`", sampler.shown());
                    return Err(Error::new("glb/interpolation", message)
                        .with_help("known are LINEAR, STEP and CUBICSPLINE"));
                }
            };
            let input = sampler.need("input")?.index()?;
            let (times, keys, all) = match clocks.get(&input) {
                Some(clock) => clock,
                None => {
                    let times = accessors.numbers(input)?;
                    let clock = clock(&times, &sampler, warnings)?;
                    clocks.entry(input).or_insert(clock)
                }
            };
            let values = accessors.numbers(sampler.need("output")?.index()?)?;
            let width = if path == Path::Rotation { 4 } else { 3 };
            let needed = if between == Between::Cubic { 3 * all } else { *all };
            if values.width != width || values.count() != needed {
                let message = format!(
                    "{} has {all} times and {} values of {} numbers",
                    sampler.shown(),
                    values.count(),
                    values.width
                );
                return Err(Error::new("glb/keys", message)
                    .with_help(format!("expected are {needed} of {width} numbers")));
            }
            if times.is_empty() {
                continue;
            }
            let (times, keys) = (Rc::clone(times), Rc::clone(keys));
            let made = Channel { node, path, between, times, keys, values };
            check_rotation(&made, &channel, warnings);
            match place_of.get(&(node, path)).and_then(|place: &usize| channels.get_mut(*place)) {
                Some(first) => {
                    warnings.add("glb/channel", || {
                        let message =
                            format!("{} moves what another moves already", channel.shown());
                        Diagnostic::warning("glb/channel", message).with_help("the last counts")
                    });
                    *first = made;
                }
                None => {
                    place_of.insert((node, path), channels.len());
                    channels.push(made);
                }
            }
        }
        Ok(Self { channels })
    }

    /// Where each node is at a time, from where it is at rest.
    pub(super) fn pose(&self, time: f64, locals: &mut [LocalPose]) {
        for channel in &self.channels {
            let [x, y, z, w] = channel.at(time);
            let Some(local) = locals.get_mut(channel.node) else { continue };
            match channel.path {
                Path::Translation => local.translation = [x, y, z],
                Path::Rotation => local.rotation = [x, y, z, w],
                Path::Scale => local.scale = [x, y, z],
            }
        }
    }

    /// The longest time between frames where a curve or a step is sampled, in seconds.
    const STEP: f64 = 1.0 / 60.0;

    /// The times of frames: those of all keys; where they are a part of an even grid, the grid; and more where curves
    /// and steps would be lost between them. At most `most`, evenly then, with the warning `glb/frames`.
    ///
    /// Beside them the times at which the channels are asked. Keys have 32 bits: one that means a time of the grid is up to
    /// 3e-8 of it away, where something that moves is elsewhere, and a step has not yet happened.
    pub(super) fn times(&self, most: usize, warnings: &mut Warnings) -> (Vec<f64>, Vec<f64>) {
        let mut keys: Vec<f64> = vec![];
        let mut known = HashSet::new();
        for channel in &self.channels {
            if known.insert(Rc::as_ptr(&channel.times)) {
                keys.extend(channel.times.iter());
            }
        }
        keys.sort_by(f64::total_cmp);
        keys.dedup_by(|b, a| *b - *a < 1e-6);
        let (Some(&first), Some(&last)) = (keys.first(), keys.last()) else {
            return (vec![], vec![]);
        };
        let mut asked = None;
        let bends = self.channels.iter().any(|c| c.between != Between::Linear && c.times.len() > 1);
        let mut times = match grid(&keys) {
            Some(steps) => {
                let part = (last - first) / steps as f64;
                let finer = if bends { (part / Self::STEP - 1e-3).ceil().max(1.0) } else { 1.0 };
                let count = steps.saturating_mul(finer as usize);
                if count < most {
                    let grid = even(first, last, count);
                    asked = Some(at_keys(&grid, &keys, 0.002 * part + 2e-7 * last.abs()));
                    grid
                } else {
                    keys
                }
            }
            None => {
                warnings.push(
                    Diagnostic::warning("glb/uneven", "keys are at uneven times")
                        .with_help("frames are at all of them: resample for a constant rate"),
                );
                keys
            }
        };
        if bends && grid(&times).is_none() && times.len() < most {
            times = finer(&times, Self::STEP, most);
            asked = None;
        }
        if times.len() > most {
            let message = format!("the keys of all nodes are at {} times", times.len());
            warnings.push(
                Diagnostic::warning("glb/frames", message)
                    .with_help(format!("sampled evenly in {most} frames")),
            );
            times = even(first, last, most.saturating_sub(1));
            asked = None;
        }
        let asked = asked.unwrap_or_else(|| times.clone());
        (times, asked)
    }
}

/// Each time, or the key that is within `near` of it. Both rise.
fn at_keys(times: &[f64], keys: &[f64], near: f64) -> Vec<f64> {
    let mut key = 0;
    let at = |time: &f64| {
        while keys.get(key).is_some_and(|key| *key < time - near) {
            key += 1;
        }
        keys.get(key).copied().filter(|key| *key <= time + near).unwrap_or(*time)
    };
    times.iter().map(at).collect()
}

/// Times and so many equal steps between them.
fn even(first: f64, last: f64, steps: usize) -> Vec<f64> {
    let part = (last - first) / steps.max(1) as f64;
    (0..=steps).map(|step| if step == steps { last } else { first + part * step as f64 }).collect()
}

/// How many equal steps lead from the first time to the last so that all others are on one; none if there is no such
/// number.
fn grid(keys: &[f64]) -> Option<usize> {
    let (first, last) = (*keys.first()?, *keys.last()?);
    let least = keys.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    if keys.len() < 2 {
        return Some(0);
    }
    // Times in 32 bits are known to 6e-8 of their size; so is the least step, and the number of steps that follows from it.
    let even = |steps: f64| {
        let part = (last - first) / steps;
        let near = 0.002 * part + 2e-7 * last.abs();
        let off =
            |time: &f64| ((time - first) / part - ((time - first) / part).round()).abs() * part;
        steps < 1e7 && keys.iter().all(|time| off(time) <= near)
    };
    let candidates = [(keys.len() - 1) as f64, ((last - first) / least).round()];
    candidates.into_iter().find(|steps| even(*steps)).map(|steps| steps as usize)
}

/// Times with others between them, so that none is farther than `step` from the next.
fn finer(times: &[f64], step: f64, most: usize) -> Vec<f64> {
    let mut all = vec![];
    for pair in times.windows(2) {
        let parts = ((pair[1] - pair[0]) / step - 1e-3).ceil().max(1.0);
        if all.len() as f64 + parts > most as f64 {
            return times.to_vec();
        }
        all.extend(
            (0..parts as usize).map(|part| pair[0] + (pair[1] - pair[0]) * part as f64 / parts),
        );
    }
    all.extend(times.last());
    all
}

/// Times that rise, the place of each among the keys, and how many keys there are.
type Clock = (Rc<Vec<f64>>, Rc<Vec<usize>>, usize);

/// Of several keys at one time the last counts.
fn clock(numbers: &Numbers, sampler: &Item<'_>, warnings: &mut Warnings) -> Result<Clock, Error> {
    if numbers.width != 1 {
        let message = format!("the times of {} are no single numbers", sampler.shown());
        return Err(Error::new("glb/keys", message));
    }
    let (mut times, mut keys): (Vec<f64>, Vec<usize>) = (vec![], vec![]);
    for (key, &time) in numbers.values.iter().enumerate() {
        match times.last() {
            Some(last) if time < *last => {
                let message = format!("{}: time {key} is {time}, after {last}", sampler.shown());
                return Err(Error::new("glb/time", message).with_help("times of keys rise"));
            }
            Some(last) if time == *last => {
                warnings.add("glb/time", || {
                    let message =
                        format!("{}: keys {} and {key} are at {time} s", sampler.shown(), key - 1);
                    Diagnostic::warning("glb/time", message).with_help("the last counts")
                });
                times.pop();
                keys.pop();
            }
            _ => {}
        }
        times.push(time);
        keys.push(key);
    }
    Ok((Rc::new(times), Rc::new(keys), numbers.count()))
}

/// Tells of rotations whose length is not 1.
fn check_rotation(made: &Channel, channel: &Item<'_>, warnings: &mut Warnings) {
    if made.path != Path::Rotation {
        return;
    }
    let length = |key| made.key(key, 1).iter().map(|x| x * x).sum::<f64>().sqrt();
    // Normalised bytes are known to 1/127.
    let off = (0..made.times.len()).find(|key| (length(*key) - 1.0).abs() > 0.02);
    if let Some(key) = off {
        let message =
            format!("{}: the rotation of key {key} has length {:.4}", channel.shown(), length(key));
        let help = "rotations are unit quaternions: it is normalised, and one without length turns nothing";
        warnings.push(Diagnostic::warning("glb/rotation", message).with_help(help));
    }
}

/// The quaternion of length 1; one without length turns nothing.
fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 1e-9 { q.map(|x| x / length) } else { [0.0, 0.0, 0.0, 1.0] }
}

/// On the shorter arc from a to b.
fn slerp(a: [f64; 4], b: [f64; 4], u: f64) -> [f64; 4] {
    let dot: f64 = (0..4).map(|i| a[i] * b[i]).sum();
    let b = if dot < 0.0 { b.map(|x| -x) } else { b };
    let dot = dot.abs();
    // The angle by its sine too: the cosine of a small one tells nothing.
    let sine = (0..4).map(|i| (b[i] - dot * a[i]).powi(2)).sum::<f64>().sqrt();
    let angle = sine.atan2(dot);
    let mix = |x: f64, y: f64| unit(std::array::from_fn(|i| x * a[i] + y * b[i]));
    if angle < 1e-9 { mix(1.0 - u, u) } else { mix(((1.0 - u) * angle).sin(), (u * angle).sin()) }
}

#[cfg(test)]
mod tests {
    use super::{at_keys, grid};

    #[test]
    fn even_times_are_found_in_single_precision() {
        // Five minutes at 120 Hz, rounded to 32 bits: the steps differ by up to 4e-3 of their size.
        let times: Vec<f64> = (0..36_000).map(|k| f64::from(k as f32 / 120.0)).collect();
        assert_eq!(grid(&times), Some(35_999));
        // Keys of several nodes that are on one grid of 24 Hz, not at all of its times.
        let some: Vec<f64> = [0, 1, 5, 6, 48].map(|k| f64::from(k as f32 / 24.0)).to_vec();
        assert_eq!(grid(&some), Some(48));
        assert_eq!(grid(&[0.0, 0.1, 0.2001, 0.3345]), None);
        assert_eq!(grid(&[0.5]), Some(0));
    }

    #[test]
    fn frames_are_asked_for_at_the_keys_that_mean_them() {
        assert_eq!(
            at_keys(&[0.0, 0.1, 0.2, 0.3], &[0.0, 0.1 + 3e-9, 0.3 - 2e-9], 1e-8),
            [0.0, 0.1 + 3e-9, 0.2, 0.3 - 2e-9]
        );
    }
}
