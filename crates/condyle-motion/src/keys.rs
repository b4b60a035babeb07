//! Key poses: a motion between poses at given times.

use crate::Motion;
use condyle_diagnostics::Error;
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, Model};

/// The most frames that a motion between key poses may have.
const MOST_FRAMES: f64 = 1e6;
/// How far from a whole number of frames the last key may be, and still get a frame.
const WHOLE: f64 = 1e-6;

/// Poses at given times, each of some coordinates.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Keys {
    /// Seconds, each above the one before.
    pub times: Vec<f64>,
    /// For each key the stored numbers of all coordinates.
    pub frames: Vec<Vec<f64>>,
    /// For each key and coordinate whether the key says something about it.
    pub named: Vec<Vec<bool>>,
    /// For each key how coordinates of one number leave it; `None`, and what is missing at the end of the list, is
    /// the way that is asked for of all.
    pub leave: Vec<Option<Interpolation>>,
}

/// How coordinates of one number go from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// On a straight line.
    Linear,
    /// On a smooth curve that goes up or down only where the keys do (Fritsch & Butland 1984), so that
    /// between two keys it stays between their values.
    #[default]
    Spline,
}

impl Keys {
    /// The motion at so many frames a second, from the first key to the last.
    ///
    /// A coordinate goes between those keys that name it, and stays where it is before the first and
    /// after the last of them; one that no key names is at the value that the keys hold for it, its
    /// default. Orientations turn about one axis from key to key, the shorter way, at constant speed.
    ///
    /// # Errors
    /// `keys/none` without keys, `keys/rate` if the rate is no positive number or gives more than a million
    /// frames, `keys/times` if times do not rise.
    ///
    /// ```
    /// use condyle_motion::{Interpolation, Keys};
    /// # use condyle_math::Vec3;
    /// # use condyle_model::ModelBuilder;
    /// # let mut b = ModelBuilder::new("arm");
    /// # let forearm = b.segment("forearm", None);
    /// # b.hinge("elbow", forearm, "flexion", Vec3::Z);
    /// # let model = b.build()?;
    /// let named = vec![vec![true]; 2];
    /// let keys = Keys { times: vec![0.0, 1.0], frames: vec![vec![0.0], vec![2.0]], named, leave: vec![] };
    /// let motion = keys.sample(&model, 4.0, Interpolation::Spline)?;
    /// // A smooth step, 3 t² - 2 t³, at a quarter of the way.
    /// assert_eq!(motion.frames[1], [2.0 * (3.0 / 16.0 - 2.0 / 64.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sample(
        &self,
        model: &Model,
        rate: f64,
        between: Interpolation,
    ) -> Result<Motion, Error> {
        let (Some(&first), Some(&last)) = (self.times.first(), self.times.last()) else {
            return Err(Error::new("keys/none", "there are no key poses"));
        };
        let frames = ((last - first) * rate + WHOLE).floor();
        if !(rate > 0.0 && rate.is_finite() && frames < MOST_FRAMES) {
            let message = format!("{rate} frames a second from {first} to {last} s");
            return Err(Error::new("keys/rate", message).with_help("give a rate such as 60"));
        }
        let at = |frame: usize| {
            let time = first + frame as f64 / rate;
            // The last key itself where rounding alone is between.
            if (last - time) * rate < WHOLE { last } else { time }
        };
        self.at(model, (0..=frames as usize).map(at).collect(), between)
    }

    /// The motion at given times in seconds, in any order.
    ///
    /// # Errors
    /// `keys/none` without keys, `keys/times` if times of keys do not rise.
    pub fn at(
        &self,
        model: &Model,
        times: Vec<f64>,
        between: Interpolation,
    ) -> Result<Motion, Error> {
        let Some(first) = self.frames.first() else {
            return Err(Error::new("keys/none", "there are no key poses"));
        };
        if !self.times.windows(2).all(|pair| pair[0] < pair[1]) {
            return Err(Error::new("keys/times", "the times of the key poses do not rise"));
        }
        let mut motion = Motion { frames: vec![first.clone(); times.len()], times };
        for id in model.coordinate_ids() {
            let keys: Vec<usize> =
                (0..self.times.len()).filter(|&key| self.named[key][id.index()]).collect();
            if !keys.is_empty() {
                self.fill(model, id, &keys, between, &mut motion);
            }
        }
        Ok(motion)
    }

    /// Fills one coordinate, from the keys that name it.
    fn fill(
        &self,
        model: &Model,
        id: CoordinateId,
        keys: &[usize],
        between: Interpolation,
        motion: &mut Motion,
    ) {
        let place = model.stored_range(id);
        let times: Vec<f64> = keys.iter().map(|&key| self.times[key]).collect();
        let values: Vec<f64> = keys.iter().map(|&key| self.frames[key][place.start]).collect();
        let slopes = slopes(&times, &values);
        let leave = |key: usize| self.leave.get(key).copied().flatten().unwrap_or(between);
        for (time, frame) in motion.times.iter().zip(&mut motion.frames) {
            let after = times.partition_point(|key| key <= time);
            if after == 0 || after == keys.len() {
                let key = keys[after.saturating_sub(1)];
                frame[place.clone()].copy_from_slice(&self.frames[key][place.clone()]);
                continue;
            }
            let (a, b) = (after - 1, after);
            let width = times[b] - times[a];
            let share = (time - times[a]) / width;
            if place.len() > 1 {
                let [from, to] = [a, b].map(|i| {
                    let stored = &self.frames[keys[i]];
                    Quat::from(std::array::from_fn::<f64, 4, _>(|i| stored[place.start + i]))
                });
                frame[place.clone()].copy_from_slice(&turned(from, to, share).to_array());
                continue;
            }
            frame[place.start] = match leave(keys[a]) {
                Interpolation::Spline => {
                    let ends = [slopes[a] * width, slopes[b] * width];
                    hermite([values[a], values[b]], ends, share)
                }
                Interpolation::Linear => values[a] + (values[b] - values[a]) * share,
            };
        }
    }
}

/// The orientation at a share of the shortest way.
fn turned(from: Quat, to: Quat, share: f64) -> Quat {
    let [from, to] = [from, to].map(Quat::normalized);
    let turn: Vec3 = (from.conjugate() * to).log();
    (from * Quat::exp(turn * share)).normalized()
}

/// The cubic with these values and slopes at 0 and 1; within the values, which rounding might leave.
fn hermite([a, b]: [f64; 2], [slope, next]: [f64; 2], t: f64) -> f64 {
    let (square, cube) = (t * t, t * t * t);
    let rise = 3.0 * square - 2.0 * cube;
    let value = a + (b - a) * rise + slope * (t - 2.0 * square + cube) + next * (cube - square);
    value.max(a.min(b)).min(a.max(b))
}

/// Slopes at the keys for which the cubics between them go up or down only where the keys do.
///
/// Inside, the weighted harmonic mean of Fritsch & Butland 1984 of the slopes d₁ and d₂ on both sides,
/// over h₁ and h₂ seconds: (w₁ + w₂) / (w₁/d₁ + w₂/d₂) with w₁ = 2 h₂ + h₁ and w₂ = h₂ + 2 h₁; 0 at a
/// highest or lowest key. At the ends 0: a motion begins and ends at rest.
fn slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let count = times.len();
    let mut slopes = vec![0.0; count];
    for i in 1..count.saturating_sub(1) {
        let [h1, h2] = [i, i + 1].map(|k| times[k] - times[k - 1]);
        let [d1, d2] = [i, i + 1].map(|k| (values[k] - values[k - 1]) / (times[k] - times[k - 1]));
        if d1 * d2 > 0.0 {
            let (w1, w2) = (2.0 * h2 + h1, h2 + 2.0 * h1);
            slopes[i] = (w1 + w2) / (w1 / d1 + w2 / d2);
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_model::{CoordinateKind, ModelBuilder};

    /// A hinge, a slide and a ball.
    fn model() -> Model {
        let mut b = ModelBuilder::new("joints");
        let hinged = b.segment("hinged", None);
        b.hinge("hinge", hinged, "angle", Vec3::Z);
        let slid = b.segment("slid", Some(hinged));
        let set = b.joint_set("slide");
        let shift = b.coordinate(set, "shift", CoordinateKind::Translation);
        let motion = b.translate(set, "move", shift, Vec3::X);
        b.output(set, slid, motion);
        let ball = b.segment("ball", Some(slid));
        b.ball_joint("socket", ball);
        b.build().unwrap()
    }

    /// Time, angle, shift, and turn about x; each but the time may be missing.
    type Key = (f64, Option<f64>, Option<f64>, Option<f64>);

    fn keys(list: &[Key]) -> Keys {
        let mut keys = Keys::default();
        for &(time, angle, shift, turn) in list {
            let q = Quat::from_axis_angle(Vec3::X, turn.unwrap_or(0.0)).to_array();
            let numbers = [&[angle.unwrap_or(0.0), shift.unwrap_or(0.0)], &q[..]].concat();
            keys.times.push(time);
            keys.frames.push(numbers);
            keys.named.push(vec![angle.is_some(), shift.is_some(), turn.is_some()]);
        }
        keys
    }

    #[test]
    fn lines_and_arcs_between_uneven_keys() {
        let list = [
            (1.0, Some(0.0), Some(0.5), Some(3.0)),
            (1.25, None, None, Some(-3.0)),
            (1.5, Some(1.0), None, None),
            (3.0, Some(-2.0), None, Some(-2.0)),
        ];
        let motion = keys(&list).sample(&model(), 8.0, Interpolation::Linear).unwrap();
        assert_eq!(motion.times.len(), 17);
        for (time, frame) in motion.times.iter().zip(&motion.frames) {
            let angle = if *time < 1.5 { 2.0 * (time - 1.0) } else { 1.0 - 2.0 * (time - 1.5) };
            assert!((frame[0] - angle).abs() < 1e-14, "{time}: {frame:?}");
            // One key: constant.
            assert_eq!(frame[1], 0.5);
            // From 3 to -3 the shorter way is through half a turn: 2π - 6 in a quarter of a second.
            let turn = if *time < 1.25 {
                3.0 + 4.0 * (time - 1.0) * (2.0 * std::f64::consts::PI - 6.0)
            } else {
                -3.0 + (time - 1.25) / 1.75
            };
            let q = Quat::from(std::array::from_fn::<f64, 4, _>(|i| frame[2 + i]));
            assert!(q.angle_to(Quat::from_axis_angle(Vec3::X, turn)) < 1e-7, "{time}: {frame:?}");
        }
    }

    #[test]
    fn splines_meet_the_keys_and_never_leave_them() {
        let list = [(0.0, 0.0), (0.5, 1.0), (0.75, 1.0), (2.0, 3.0), (2.25, 3.1), (3.0, -1.0)];
        let all = list.map(|(time, angle)| (time, Some(angle), None, None));
        let motion = keys(&all).sample(&model(), 100.0, Interpolation::Spline).unwrap();
        let at = |time: f64| motion.frames[(time * 100.0).round() as usize][0];
        for pair in list.windows(2) {
            let [(from, a), (to, b)] = pair else { unreachable!() };
            assert!((at(*from) - a).abs() < 1e-12 && (at(*to) - b).abs() < 1e-12);
            for (time, frame) in motion.times.iter().zip(&motion.frames) {
                if (from..=to).contains(&time) {
                    assert!(a.min(*b) <= frame[0] && frame[0] <= a.max(*b), "{time}");
                }
            }
        }
        // The first stretch begins and ends at rest: a smooth step, 3 t² - 2 t³.
        let t: f64 = 0.4;
        assert!((at(0.2) - (3.0 * t * t - 2.0 * t * t * t)).abs() < 1e-12);
        // At 2 s the slopes on both sides are 1.6 over 1.25 s and 0.4 over 0.25 s.
        let (w1, w2) = (2.0 * 0.25 + 1.25, 0.25 + 2.0 * 1.25);
        let slope = (w1 + w2) / (w1 / 1.6 + w2 / 0.4);
        let fine = keys(&all).sample(&model(), 10000.0, Interpolation::Spline).unwrap();
        let quotient = (fine.frames[20001][0] - fine.frames[19999][0]) * 5000.0;
        // The cubics have other second derivatives: of the order of their jump times 1e-4.
        assert!((quotient - slope).abs() < 1e-3, "{quotient} {slope}");
    }

    #[test]
    fn a_key_says_how_it_is_left_and_any_time_may_be_asked() {
        let list = [(0.0, 0.0), (1.0, 1.0), (2.0, 3.0)].map(|(t, a)| (t, Some(a), None, None));
        let mut keys = keys(&list);
        keys.leave = vec![Some(Interpolation::Linear)];
        let motion = keys.at(&model(), vec![5.0, 0.25, 1.5, -1.0], Interpolation::Spline).unwrap();
        let angles: Vec<f64> = motion.frames.iter().map(|frame| frame[0]).collect();
        // Between the last two: slope w₁ + w₂ over w₁/1 + w₂/2 with w₁ = w₂ = 3 at 1 s, so 4/3, and 0 at 2 s.
        // The cubic at its middle: the mean of the ends and an eighth of the difference of the slopes.
        let middle = 2.0 + (4.0 / 3.0) / 8.0;
        for (angle, expected) in angles.iter().zip([3.0, 0.25, middle, 0.0]) {
            assert!((angle - expected).abs() < 1e-14, "{angles:?}");
        }
    }

    #[test]
    fn one_key_is_one_frame_and_wrong_rates_and_times_are_said() {
        let one = keys(&[(2.0, Some(0.3), None, None)]);
        let motion = one.sample(&model(), 60.0, Interpolation::Spline).unwrap();
        assert_eq!((motion.times, motion.frames[0][0]), (vec![2.0], 0.3));
        // The last key has a frame although 0.1 · 3 is not 0.3.
        let short = keys(&[(0.0, Some(0.0), None, None), (0.1 * 3.0, Some(1.0), None, None)]);
        let motion = short.sample(&model(), 10.0, Interpolation::Linear).unwrap();
        assert_eq!((motion.frames.len(), motion.frames[3][0]), (4, 1.0));
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            assert_eq!(
                short.sample(&model(), rate, Interpolation::Linear).unwrap_err().code(),
                "keys/rate"
            );
        }
        let none = Keys::default().sample(&model(), 60.0, Interpolation::Linear);
        assert_eq!(none.unwrap_err().code(), "keys/none");
        let back = keys(&[(1.0, None, None, None), (1.0, None, None, None)]);
        let back = back.sample(&model(), 60.0, Interpolation::Linear);
        assert_eq!(back.unwrap_err().code(), "keys/times");
    }
}
