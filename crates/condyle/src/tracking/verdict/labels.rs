//! Which label belongs to which marker, by where they are.

use super::{Trial, mean, places};
use crate::tracking::Variant;
use condyle_diagnostics::Diagnostic;
use condyle_math::{Mat3, Vec3};
use condyle_track::FrameAnswer;
use condyle_track::robust::assign;

/// Two labels may be exchanged where that leaves less than this share of their squared errors, these are
/// more than the second share of those of all labels, and those of all such pairs more than the third.
const EXCHANGED: f64 = 0.3;
const LEAST: f64 = 0.1;
const FAR_OFF: f64 = 0.4;
/// Rounds of tracking and assigning labels anew.
const ROUNDS: usize = 5;
/// Of the frames one in so many is looked at in these rounds.
const EVERY: usize = 3;
/// Directions that a body with unknown labels may face.
const HEADINGS: u32 = 8;

impl Trial<'_> {
    /// Labels assigned anew to the markers that they are nearest to, in a few rounds; the best of some
    /// beginnings, with the RMS of the frames.
    ///
    /// Rounds look at every third frame, and after the first each goes on from the posture before: where
    /// nothing is known a frame costs twenty times as much.
    pub(super) fn permuted(&mut self) -> Option<(Variant, f64)> {
        let frames: Vec<usize> = (0..self.numbers.len()).step_by(EVERY).collect();
        let mut best: Option<(Variant, f64)> = None;
        for beginning in self.beginnings() {
            let mut predicted = beginning;
            let mut order: Vec<usize> = vec![];
            let mut answers: Vec<Option<FrameAnswer>> = vec![None; self.numbers.len()];
            for _ in 0..ROUNDS {
                let assigned = self.assigned(&predicted);
                if assigned == order {
                    break;
                }
                order = assigned;
                let variant = self.permutation(&order);
                let changed = variant.of(&self.sample);
                let mut rms = 0.0;
                for &frame in &frames {
                    let answer = match answers[frame].take() {
                        Some(before) => self.solved_from(&changed, frame, before),
                        None => self.solved(&changed, frame),
                    };
                    rms += answer.rms() / frames.len() as f64;
                    predicted[frame] = places(self.tracker, &answer.coordinates, &mut self.pose)?;
                    answers[frame] = Some(answer);
                }
                // Frames that are not looked at have no say in the next round.
                let looked = |(frame, points): (usize, &mut Vec<Vec3>)| {
                    if !frames.contains(&frame) {
                        points.clear();
                    }
                };
                predicted.iter_mut().enumerate().for_each(looked);
                if best.as_ref().is_none_or(|(_, least)| rms < *least) {
                    best = Some((variant, rms));
                }
            }
        }
        let (variant, _) = best?;
        let changed = variant.of(&self.sample);
        let rms = mean((0..self.numbers.len()).map(|frame| self.solved(&changed, frame).rms()));
        Some((variant, rms))
    }

    /// Where the markers may be in each frame whatever their labels say: as tracked, and as at rest
    /// about the middle of those seen, turned about the upward axis.
    fn beginnings(&mut self) -> Vec<Vec<Vec<Vec3>>> {
        let mut beginnings: Vec<_> = self.tracked().into_iter().collect();
        let up = [Vec3::X, Vec3::Y, Vec3::Z][self.up()];
        let middle = |points: &mut dyn Iterator<Item = Vec3>| {
            let (sum, n) = points.fold((Vec3::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
            sum * (1.0 / f64::max(n, 1.0))
        };
        let at_rest = middle(&mut self.places.iter().copied());
        let turned = (0..HEADINGS).map(|heading| {
            let angle = std::f64::consts::TAU * f64::from(heading) / f64::from(HEADINGS);
            let turn = Mat3::rotation_about(up, angle.sin_cos());
            let in_frame = |frame: usize| {
                let row = self.sample.frame(frame);
                let seen = self.labels.iter().filter_map(|&label| row.get(label)?.position());
                let there = middle(&mut seen.map(Vec3::from));
                self.places.iter().map(|&p| turn * (p - at_rest) + there).collect::<Vec<_>>()
            };
            (0..self.numbers.len()).map(in_frame).collect::<Vec<_>>()
        });
        let mut turned: Vec<_> = turned.map(|t| (self.cost(&t, &self.assigned(&t)), t)).collect();
        turned.sort_by(|a, b| a.0.total_cmp(&b.0));
        beginnings.extend(turned.into_iter().take(2).map(|(_, points)| points));
        beginnings
    }

    /// Mean squared distances between each marker, at its place in each frame, and each label.
    fn costs(&self, points: &[Vec<Vec3>]) -> Vec<f64> {
        let n = self.labels.len();
        let mut costs = vec![0.0; n * n];
        for (marker, row) in costs.chunks_exact_mut(n.max(1)).enumerate() {
            for (cost, &label) in row.iter_mut().zip(self.labels) {
                let off = |(frame, points): (usize, &Vec<Vec3>)| {
                    let seen = self.sample.position(frame, label)?;
                    Some((*points.get(marker)? - Vec3::from(seen)).norm_squared())
                };
                *cost = mean(points.iter().enumerate().filter_map(off));
            }
        }
        costs
    }

    /// For each marker target the one whose label it gets.
    fn assigned(&self, points: &[Vec<Vec3>]) -> Vec<usize> {
        let (costs, n) = (self.costs(points), self.labels.len());
        let assigned = assign(n, n, |marker, label| costs[marker * n + label]);
        assigned.unwrap_or_else(|| (0..n).collect())
    }

    fn cost(&self, points: &[Vec<Vec3>], order: &[usize]) -> f64 {
        let (costs, n) = (self.costs(points), self.labels.len());
        order.iter().enumerate().map(|(marker, label)| costs[marker * n + label]).sum()
    }

    fn permutation(&self, order: &[usize]) -> Variant {
        let mut from: Vec<usize> = (0..self.sample.labels.len()).collect();
        for (&label, &other) in self.labels.iter().zip(order) {
            from[label] = self.labels[other];
        }
        Variant::Permuted(from)
    }

    /// A warning about pairs of labels that fit far better with their names exchanged, throughout.
    pub(super) fn exchanged(&mut self) -> Option<Diagnostic> {
        let tracked = self.tracked()?;
        let (costs, n) = (self.costs(&tracked), self.labels.len());
        let all: f64 = (0..n).map(|i| costs[i * n + i]).sum();
        let (mut pairs, mut off) = (vec![], 0.0);
        for a in 0..n {
            for b in a + 1..n {
                let before = costs[a * n + a] + costs[b * n + b];
                let after = costs[a * n + b] + costs[b * n + a];
                if after < EXCHANGED * before && before > LEAST * all {
                    off += before;
                    let label = |marker: usize| &self.sample.labels[self.labels[marker]];
                    pairs.push(format!("`{}` and `{}`", label(a), label(b)));
                }
            }
        }
        let message = format!("labels may be exchanged throughout: {}", pairs.join(", "));
        (off > FAR_OFF * all).then(|| Diagnostic::warning("track/exchanged", message))
    }

    /// Where the markers are in each frame as tracked.
    fn tracked(&mut self) -> Option<Vec<Vec<Vec3>>> {
        let of = |a: &FrameAnswer| places(self.tracker, &a.coordinates, &mut self.pose);
        self.answers.iter().map(of).collect()
    }
}
