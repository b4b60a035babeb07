//! How far each coordinate of an answer can be trusted.
//!
//! With the Hessian H of all that is minimised and H_data that of what was measured, over the unknowns that
//! are not at a bound,
//!
//! ```text
//! share_i = (H⁻¹ H_data)_ii                  how much of a coordinate comes from the data, 0 to 1
//! sd_i²   = 2 σ² (Σ w² / Σ w) / Σ w · (H⁻¹)_ii     its variance at marker noise σ = 2 mm
//! ```

use crate::answer::FrameAnswer;
use crate::problem::Frame;
use crate::target;
use crate::tracker::{FIXED, Scratch, Tracker};
use condyle_model::{CoordinateId, CoordinateKind};
use condyle_solve::cholesky;
use condyle_solve::least_squares::{LocalModel, Problem};

/// How far a coordinate can be trusted in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trust {
    /// The markers say where it is.
    Determined,
    /// They say so, but at 2 mm of noise its standard deviation exceeds 5° or 1 cm.
    Weak,
    /// Less than half of it comes from the markers: it is locked, moves none of them, or is where the
    /// posture of the model puts it.
    Held,
    /// It is held at a bound that the markers push it against.
    AtLimit,
}

/// Noise of a marker, in metres.
const NOISE: f64 = 0.002;
/// The standard deviation from which on a coordinate is weak: radians (and other numbers), metres.
const WEAK_ANGLE: f64 = 5.0 * std::f64::consts::PI / 180.0;
const WEAK_LENGTH: f64 = 0.01;
/// A bound presses where to leave it would lower F by more than this share.
const PRESSING: f64 = 1e-4;
/// Loops count as much as so many times all markers together.
const LOOP: f64 = 1e4;

impl Tracker {
    /// How far each coordinate of an answer can be trusted; arguments as for
    /// [`Tracker::solve_into`].
    ///
    /// # Panics
    /// If the answer has not as many coordinates as the model stores.
    pub fn trust(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        answer: &FrameAnswer,
    ) -> Vec<Trust> {
        let n = self.unknown_len();
        let buffers = &mut scratch.buffers;
        buffers.current.copy_from_slice(&answer.coordinates);
        buffers.tangent.fill(0.0);
        let mut frame = Frame { tracker: self, seen, index: frame, buffers };
        frame.weigh();
        let mut values = vec![0.0; frame.buffers.closures.len()];
        let loops = if self.targets.close_exactly() { values.len() } else { 0 };
        let mut rows = vec![0.0; self.limit_rows];
        frame.evaluate(&vec![0.0; n], &mut values[..loops], &mut rows);
        frame.accept();
        let mut part = |assumed| {
            let mut local = scratch.solver.local().clone();
            local.curved = false;
            local.hessian.fill(0.0);
            local.gradient.fill(0.0);
            local.equality_rows.fill(0.0);
            target::linearise_part(&mut frame, &mut local, assumed);
            local
        };
        let (data, assumed) = (part(false), part(true));
        let weights = &frame.buffers.weights;
        let total = frame.buffers.total_weight;
        let squares: f64 = weights.iter().map(|w| w * w).sum();
        let variance =
            if total > 0.0 { 2.0 * NOISE * NOISE * squares / (total * total) } else { 0.0 };
        let unknowns = self.trust_of_unknowns(&data, &assumed, answer, loops, variance);
        let of = |id: CoordinateId| {
            let directions = self.part.coordinate_directions(&self.model, id).iter();
            let own = self.model.tangent_range(id);
            let coupled = self.model.coordinate(id).follows.is_some();
            let leaders = directions.map(|&(d, _)| d as usize).filter(|_| coupled);
            let trust = leaders.chain(own.filter(|_| !coupled)).map(|d| match self.unknowns[d] {
                FIXED => Trust::Held,
                unknown => unknowns[unknown as usize],
            });
            trust.max().unwrap_or(Trust::Held)
        };
        self.model.coordinate_ids().map(of).collect()
    }

    fn trust_of_unknowns(
        &self,
        data: &LocalModel,
        assumed: &LocalModel,
        answer: &FrameAnswer,
        loops: usize,
        variance: f64,
    ) -> Vec<Trust> {
        let n = self.unknown_len();
        let mut trust = vec![Trust::Held; n];
        let mut free = vec![];
        for unknown in 0..n {
            let pushed = data.gradient[unknown] + assumed.gradient[unknown];
            let diagonal = data.hessian[unknown * n + unknown];
            let (below, above) = match self.stored[unknown] {
                Some((place, lower, upper)) => {
                    let q = answer.coordinates[place];
                    (q <= lower, q >= upper)
                }
                None => (false, false),
            };
            let outwards = (below && pushed > 0.0) || (above && pushed < 0.0);
            if outwards && pushed * pushed > PRESSING * 2.0 * diagonal * answer.minimised() {
                trust[unknown] = Trust::AtLimit;
            } else if !(below || above) && diagonal > 0.0 {
                free.push(unknown);
            }
        }
        let m = free.len();
        let lower = |matrix: &[f64], i: usize, j: usize| matrix[i.max(j) * n + i.min(j)];
        let largest = free.iter().map(|&i| lower(&data.hessian, i, i)).fold(0.0, f64::max);
        // What rounding cannot tell from nothing is not data.
        let ridge = 1e-12 * largest + 1e-30;
        let mut rest = vec![0.0; m * m];
        let mut all = vec![0.0; m * m];
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                let mut measured = lower(&data.hessian, i, j);
                for row in data.equality_rows.chunks_exact(n.max(1)).take(loops) {
                    measured += LOOP * largest * row[i] * row[j];
                }
                rest[a * m + b] = lower(&assumed.hessian, i, j) + if a == b { ridge } else { 0.0 };
                all[a * m + b] = measured + rest[a * m + b];
            }
        }
        if cholesky::factor(&mut all, m).is_err() {
            free.iter().for_each(|&i| trust[i] = Trust::Weak);
            return trust;
        }
        // H⁻¹ = L⁻ᵀ L⁻¹, of which few entries are needed: what is assumed ties few unknowns.
        let mut inverse = vec![0.0; m * m];
        cholesky::invert_lower(&all, m, &mut inverse);
        let entry = |a: usize, b: usize| -> f64 {
            (a.max(b)..m).map(|k| inverse[k * m + a] * inverse[k * m + b]).sum()
        };
        for (a, &unknown) in free.iter().enumerate() {
            let tied = (0..m).filter(|&b| rest[a * m + b] != 0.0);
            let held: f64 = tied.map(|b| entry(a, b) * rest[a * m + b]).sum();
            let deviation = (variance * entry(a, a)).sqrt();
            let most = match self.model.coordinate(self.coordinates[unknown]).kind {
                CoordinateKind::Translation => WEAK_LENGTH,
                _ => WEAK_ANGLE,
            };
            trust[unknown] = match 1.0 - held {
                share if share.is_nan() || share < 0.5 => Trust::Held,
                _ if deviation > most => Trust::Weak,
                _ => Trust::Determined,
            };
        }
        trust
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MarkerTarget, PostureTarget, Rules, Targets};
    use condyle_math::Vec3;
    use condyle_model::ModelBuilder;

    /// A hinge with a marker at some distance, and another that moves none.
    fn trust(stiffness: Option<f64>, range: Option<f64>, distance: f64) -> Vec<Trust> {
        let mut b = ModelBuilder::new("arm");
        let first = b.segment("first", None);
        let (_, root) = b.hinge("pin", first, "first", Vec3::Z);
        let second = b.segment("second", Some(first));
        b.hinge("idle", second, "idle", Vec3::Z);
        b.marker("tip", Some(first), Vec3::new(distance, 0.0, 0.0));
        if let Some(upper) = range {
            b.coordinate_mut(root).range = condyle_model::Range::new(-1.0, upper);
        }
        let mut targets = Targets {
            markers: vec![MarkerTarget { marker: 0, weight: 1.0 }],
            ..Targets::default()
        };
        let stiff = stiffness.map(|stiffness| PostureTarget {
            terms: vec![(root, 1.0)],
            rest: 0.0,
            stiffness,
        });
        targets.postures.extend(stiff);
        let tracker = Tracker::new(b.build().unwrap(), targets, Rules::default());
        let mut scratch = Scratch::new(&tracker);
        let seen = [Some([distance * 0.5f64.cos(), distance * 0.5f64.sin(), 0.0])];
        let start = tracker.model().defaults();
        let answer = tracker.solve_frame(&mut scratch, &seen, 0, &start);
        tracker.trust(&mut scratch, &seen, 0, &answer)
    }

    #[test]
    fn a_coordinate_is_as_sure_as_its_lever_is_long() {
        // At 2 mm a lever of 1 m gives 0.11°, one of 10 mm gives 11°; the second hinge moves nothing.
        assert_eq!(trust(None, None, 1.0), [Trust::Determined, Trust::Held]);
        assert_eq!(trust(None, None, 0.01), [Trust::Weak, Trust::Held]);
        // H_data is 2 l², that of the posture 2 k: half of it comes from the data at k = l².
        assert_eq!(trust(Some(0.9), None, 1.0)[0], Trust::Determined);
        assert_eq!(trust(Some(1.1), None, 1.0)[0], Trust::Held);
        // The marker is at half a radian.
        assert_eq!(trust(None, Some(0.4), 1.0)[0], Trust::AtLimit);
    }
}
