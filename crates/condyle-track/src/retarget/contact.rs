//! When a point of a foot stands.

use condyle_math::Vec3;
use std::ops::Range;

/// A point that stands is less than this above its lowest, in metres.
const LOW: f64 = 0.03;
/// And slower than this, in metres per second.
const SLOW: f64 = 0.15;
/// For at least this long, in seconds.
const LONG: f64 = 0.1;
/// Speeds are taken over this long at least, in seconds: shorter and they are noise.
const OVER: f64 = 0.03;
/// The lowest is the height that this share of frames is below, so that one bad frame does not lift all.
const LOWEST: f64 = 0.02;

/// The runs of frames in which a point stands: less than 3 cm above its lowest and slower than 0.15 m/s for
/// at least 0.1 s.
///
/// `points` are in metres, one for each time in seconds; `up` is of length 1.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_track::retarget::standing;
/// // Stands for half a second, then is lifted at 1 m/s.
/// let times: Vec<f64> = (0..100).map(|frame| f64::from(frame) * 0.01).collect();
/// let points: Vec<Vec3> = times.iter().map(|t| Vec3::Y * (t - 0.5).max(0.0)).collect();
/// let stands = standing(&points, &times, Vec3::Y);
/// assert_eq!(stands.len(), 1);
/// assert!(stands[0].start == 0 && (48..52).contains(&stands[0].end));
/// ```
pub fn standing(points: &[Vec3], times: &[f64], up: Vec3) -> Vec<Range<usize>> {
    let count = points.len().min(times.len());
    let mut heights: Vec<f64> = points.iter().map(|point| point.dot(up)).collect();
    let of = heights.clone();
    heights.sort_by(f64::total_cmp);
    let Some(&lowest) = heights.get((count as f64 * LOWEST) as usize) else { return vec![] };
    let mut stands = vec![];
    let mut begun: Option<usize> = None;
    let (mut before, mut after) = (0, 0);
    for frame in 0..=count {
        let stands_now = frame < count && {
            while before + 1 < frame && times[frame] - times[before + 1] >= 0.5 * OVER {
                before += 1;
            }
            after = after.max(frame);
            while after + 1 < count && times[after] - times[frame] < 0.5 * OVER {
                after += 1;
            }
            let span = times[after] - times[before];
            let speed =
                if span > 0.0 { (points[after] - points[before]).norm() / span } else { 0.0 };
            of[frame] < lowest + LOW && speed < SLOW
        };
        match (stands_now, begun) {
            (true, None) => begun = Some(frame),
            (false, Some(start)) => {
                begun = None;
                if times[frame - 1] - times[start] >= LONG {
                    stands.push(start..frame);
                }
            }
            _ => {}
        }
    }
    stands
}
