//! Values between frames: at a time, at another rate, in an interval of time.

use crate::Motion;
use condyle_model::Model;

/// Two frames around a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// The frame at the time or before it.
    pub before: usize,
    /// The frame at the time or after it.
    pub after: usize,
    /// From 0 at the frame before to 1 at the frame after.
    pub share: f64,
}

/// The frames around a time; a frame whose time is within `tolerance` seconds is used alone.
/// `None` outside of the times by more than that. `times` must not decrease.
///
/// ```
/// use condyle_motion::between;
/// let at = between(&[0.0, 0.1, 0.2], 0.125, 1e-6).unwrap();
/// assert_eq!((at.before, at.after), (1, 2));
/// assert!((at.share - 0.25).abs() < 1e-12);
/// assert_eq!(between(&[0.0, 0.1], 0.3, 1e-6), None);
/// ```
#[must_use]
pub fn between(times: &[f64], time: f64, tolerance: f64) -> Option<Between> {
    let last = times.len().checked_sub(1)?;
    if !(times[0] - tolerance..=times[last] + tolerance).contains(&time) {
        return None;
    }
    let after = times.partition_point(|&t| t < time).min(last);
    let before = after.saturating_sub(1);
    let away = |frame: usize| (times[frame] - time).abs();
    let nearest = if away(before) < away(after) { before } else { after };
    if away(nearest) <= tolerance {
        return Some(Between { before: nearest, after: nearest, share: 0.0 });
    }
    let share = (time - times[before]) / (times[after] - times[before]);
    Some(Between { before, after, share })
}

/// A frame this close to a time, in seconds, is used without interpolation.
const SAME_TIME: f64 = 1e-9;

impl Motion {
    /// The stored numbers of all coordinates at a time: linear between frames, along the shortest
    /// arc for orientations. `None` outside of the motion.
    #[must_use]
    pub fn at(&self, model: &Model, time: f64) -> Option<Vec<f64>> {
        let Between { before, after, share } = between(&self.times, time, SAME_TIME)?;
        let mut stored = self.frames[before].clone();
        if share > 0.0 {
            model.interpolate(&self.frames[before], &self.frames[after], share, &mut stored);
        }
        Some(stored)
    }

    /// The same motion at `rate` frames a second from its first time on.
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::ModelBuilder;
    /// use condyle_motion::Motion;
    /// let mut b = ModelBuilder::new("arm");
    /// let forearm = b.segment("forearm", None);
    /// b.hinge("elbow", forearm, "flexion", Vec3::Z);
    /// let model = b.build()?;
    /// let motion = Motion { times: vec![0.0, 1.0], frames: vec![vec![0.0], vec![2.0]] };
    /// assert_eq!(motion.resampled(&model, 4.0).frames, [[0.0], [0.5], [1.0], [1.5], [2.0]]);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    #[must_use]
    pub fn resampled(&self, model: &Model, rate: f64) -> Self {
        let (first, last) = match self.times[..] {
            [first, .., last] if rate > 0.0 && rate.is_finite() => (first, last),
            _ => return self.clone(),
        };
        let count = ((last - first) * rate + SAME_TIME).floor() as usize;
        let times = (0..=count).map(|frame| first + frame as f64 / rate);
        let frames = times.filter_map(|time| Some((time, self.at(model, time)?)));
        let (times, frames) = frames.unzip();
        Self { times, frames }
    }

    /// The frames from `first` to `last` seconds, both included.
    #[must_use]
    pub fn cropped(&self, first: f64, last: f64) -> Self {
        let times = self.times.iter().zip(&self.frames);
        let within =
            times.filter(|(time, _)| (first - SAME_TIME..=last + SAME_TIME).contains(*time));
        let (times, frames) = within.map(|(time, frame)| (*time, frame.clone())).unzip();
        Self { times, frames }
    }
}
