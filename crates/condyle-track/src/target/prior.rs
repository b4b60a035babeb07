//! The pull of every unknown number towards its default, which decides where nothing else does.

use super::Target;
use crate::problem::Frame;
use condyle_solve::least_squares::LocalModel;

/// Weight of the pull of every unknown towards its default, m² per rad² (or per m²).
///
/// With 35 unknowns a radian off their defaults it adds 4e-12 m² to F, where a mean marker error of
/// 2 mm makes 4e-6; a direction that the markers feel by a tenth of a millimetre per radian moves by
/// 1e-5 rad.
pub const PRIOR: f64 = 1e-13;

/// The prior; a quaternion has none, only the ridge of its Hessian.
pub(super) struct Prior;

impl Target for Prior {
    fn value(&self, frame: &mut Frame<'_>) -> f64 {
        let (tracker, stored) = (frame.tracker, frame.buffers.pose.effective());
        let mut sum = 0.0;
        for &(place, ..) in tracker.stored.iter().flatten() {
            let off = stored[place] - tracker.defaults[place];
            sum += off * off;
        }
        PRIOR * sum
    }

    fn linearise(&self, frame: &mut Frame<'_>, local: &mut LocalModel) {
        let (tracker, stored) = (frame.tracker, frame.buffers.pose.effective());
        let n = tracker.unknown_len();
        for (unknown, place) in tracker.stored.iter().enumerate() {
            local.hessian[unknown * n + unknown] += 2.0 * PRIOR;
            if let Some((place, ..)) = *place {
                let off = stored[place] - tracker.defaults[place];
                local.gradient[unknown] += 2.0 * PRIOR * off;
            }
        }
    }
}
