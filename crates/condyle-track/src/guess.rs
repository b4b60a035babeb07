//! Where to begin when nothing is known: the whole model at quarter turns, then each limb.

use crate::answer::{FrameAnswer, better};
use crate::target::{Markers, Placed};
use crate::tracker::{FIXED, Scratch, Tracker};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, JointSetId, Model};
use std::f64::consts::FRAC_PI_2;

/// At most so many angles are tried at all quarter turns.
const MOST_TURNED: usize = 3;

/// How many of a limb's quarter turns are solved.
const LIMB_GUESSES: usize = 3;

/// A limb fits where its markers, and all so far, are no more than so many times (squared) as far off as those
/// before it, and 3 mm.
const FITS: f64 = 1.5;
const FITS_FLOOR: f64 = 1e-5;
/// Beyond so many times (squared) the distance of all markers a limb is odd.
const ODD: f64 = 4.0;
/// Closer than 10 mm RMS a limb in a wrong minimum stands out, and is tried on its own.
const CLOSE: f64 = 1e-4;
/// Two orientations whose markers are as far off, but for this share, are the same.
const SAME: f64 = 1e-9;
/// So many markers of a segment say how it is turned.
const TURNED_BY: usize = 3;

/// A joint between some of the markers and the others.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    joint_set: JointSetId,
    /// At most three rotations: where each is stored, and its bounds.
    rotations: Vec<(usize, f64, f64)>,
    /// Where a quaternion is stored.
    ball: Option<usize>,
    /// The groups of markers that it moves.
    groups: Vec<usize>,
    /// Those of them that no limb farther out moves, if there are any.
    direct: Vec<usize>,
}

impl Limb {
    /// The limbs of a model, from the root outwards: those that move most groups first.
    pub(crate) fn of(
        model: &Model,
        markers: &Markers,
        unknowns: &[u32],
        stored: &[Option<(usize, f64, f64)>],
    ) -> Vec<Self> {
        let mut limbs: Vec<Self> = vec![];
        for id in model.coordinate_ids() {
            let unknown = unknowns[model.tangent_range(id).start];
            let kind = model.coordinate(id).kind;
            if unknown == FIXED
                || !matches!(kind, CoordinateKind::Rotation | CoordinateKind::Orientation)
            {
                continue;
            }
            let moved = |group: &usize| {
                markers.groups[*group].entries.iter().any(|(other, _)| *other == unknown)
            };
            let groups: Vec<usize> = (0..markers.groups.len()).filter(moved).collect();
            if groups.is_empty() || groups.len() == markers.groups.len() {
                continue;
            }
            let joint_set = model.coordinate(id).joint_set;
            let own = limbs.iter().position(|limb| limb.joint_set == joint_set);
            let own = own.unwrap_or_else(|| {
                limbs.push(Self {
                    joint_set,
                    rotations: vec![],
                    ball: None,
                    groups: vec![],
                    direct: vec![],
                });
                limbs.len() - 1
            });
            let limb = &mut limbs[own];
            match stored[unknown as usize] {
                None => limb.ball = limb.ball.or(Some(model.stored_range(id).start)),
                Some(rotation) if limb.rotations.len() < MOST_TURNED => {
                    limb.rotations.push(rotation);
                }
                Some(_) => continue,
            }
            limb.groups.extend(groups);
        }
        for limb in &mut limbs {
            limb.groups.sort_unstable();
            limb.groups.dedup();
        }
        limbs.sort_by_key(|limb| std::cmp::Reverse(limb.groups.len()));
        for i in 0..limbs.len() {
            let (limb, farther) = limbs[i..].split_first_mut().expect("it is one of them");
            let direct = |g: &usize| !farther.iter().any(|limb| limb.groups.contains(g));
            limb.direct = limb.groups.iter().copied().filter(direct).collect();
        }
        limbs
    }

    /// A posture with the limb at all other quarter turns, or as near to them as its ranges allow.
    fn turned(&self, stored: &[f64]) -> Vec<Vec<f64>> {
        let mut turned = vec![];
        if let Some(place) = self.ball {
            let own: [f64; 4] = [0, 1, 2, 3].map(|i| stored[place + i]);
            for combination in 1..QUARTERS {
                let mut stored = stored.to_vec();
                let other = Quat::from(own) * quarter_turns(combination);
                stored[place..place + 4].copy_from_slice(&other.to_array());
                turned.push(stored);
            }
        }
        let mut combined = vec![stored.to_vec()];
        for &(place, lower, upper) in &self.rotations {
            // Half a turn either way is not the same where there are ends.
            let last = if lower.is_finite() && upper.is_finite() { 2 } else { 1 };
            let mut values: Vec<f64> = vec![];
            for quarters in [0, 1, 2, -1, -2].into_iter().filter(|q| *q >= -last) {
                let value = stored[place] + f64::from(quarters) * FRAC_PI_2;
                let value = value.max(lower).min(upper);
                if !values.contains(&value) {
                    values.push(value);
                }
            }
            let with = |value: &f64, stored: &Vec<f64>| {
                let mut stored = stored.clone();
                stored[place] = *value;
                stored
            };
            combined = values.iter().flat_map(|v| combined.iter().map(|s| with(v, s))).collect();
        }
        turned.extend(combined.into_iter().skip(1));
        turned
    }
}

/// How many combinations of quarter turns about three axes there are.
const QUARTERS: usize = 64;

/// Quarter turns about Y, X and Z, a digit each.
fn quarter_turns(combination: usize) -> Quat {
    let turn =
        |axis, quarters: usize| Quat::from_axis_angle(axis, (quarters % 4) as f64 * FRAC_PI_2);
    turn(Vec3::Y, combination) * turn(Vec3::X, combination / 4) * turn(Vec3::Z, combination / 16)
}

impl Tracker {
    /// The mean squared distance of the markers of which the group counts, none if none is seen.
    fn mean(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        stored: &[f64],
        counts: impl Fn(Option<usize>) -> bool,
    ) -> Option<f64> {
        let pose = scratch.buffers.pose_at(self, stored)?;
        let (mut sum, mut total) = (0.0, 0.0);
        for (marker, seen) in self.markers.placed.iter().zip(seen) {
            if let (true, Some(seen)) = (counts(marker.group), seen) {
                sum += marker.weight * (marker.at(pose) - Vec3::from(*seen)).norm_squared();
                total += marker.weight;
            }
        }
        (total > 0.0).then(|| sum / total)
    }

    /// The most promising of a limb's other quarter turns, judged by some groups of markers.
    fn best_turned(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        limb: usize,
        groups: &[usize],
        stored: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut guesses = vec![];
        for stored in self.limbs[limb].turned(stored) {
            let own = |group: Option<usize>| group.is_some_and(|g| groups.contains(&g));
            if let Some(off) = self.mean(scratch, seen, &stored, own) {
                guesses.push((off, stored));
            }
        }
        guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
        guesses.truncate(LIMB_GUESSES);
        guesses.into_iter().map(|(_, stored)| stored).collect()
    }

    /// A limb at other quarter turns, the most promising first; none where its markers fit as well as all
    /// do on average.
    pub(crate) fn limb_guesses(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        limb: usize,
        answer: &FrameAnswer,
    ) -> Vec<Vec<f64>> {
        let groups = &self.limbs[limb].groups;
        let of_limb = |group: Option<usize>| group.is_some_and(|g| groups.contains(&g));
        let own = self.mean(scratch, seen, &answer.coordinates, of_limb);
        match own.zip(self.mean(scratch, seen, &answer.coordinates, |_| true)) {
            Some((own, all)) if own >= all => {
                self.best_turned(scratch, seen, limb, groups, &answer.coordinates)
            }
            _ => vec![],
        }
    }

    /// The limb of which the markers are farthest off compared with all, if any is much; and how much (squared).
    pub(crate) fn odd_limb(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        stored: &[f64],
    ) -> Option<(usize, f64)> {
        let all = self.mean(scratch, seen, stored, |_| true)? + FITS_FLOOR;
        let ratio = |(i, limb): (usize, &Limb)| {
            let own = |group: Option<usize>| group.is_some_and(|g| limb.direct.contains(&g));
            self.mean(scratch, seen, stored, own).map(|own| (i, own / all))
        };
        let ratios = self.limbs.iter().enumerate().filter_map(ratio);
        ratios.filter(|(_, ratio)| *ratio > ODD).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Tries an odd limb at other quarter turns; whether one is better.
    pub(crate) fn try_odd_limb(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        limb: usize,
        answer: &mut FrameAnswer,
    ) -> bool {
        let groups = &self.limbs[limb].direct;
        let mut found = false;
        for guess in self.best_turned(scratch, seen, limb, groups, &answer.coordinates) {
            let mut again = self.solve_frame(scratch, seen, frame, &guess);
            let numbers = &mut again.coordinates;
            self.branches.bring_near(numbers, &answer.coordinates, &self.stored);
            again.iterations += answer.iterations;
            if self.replaces(&again, answer) {
                (*answer, found) = (again, true);
            } else {
                answer.iterations = again.iterations;
            }
        }
        found
    }

    /// A posture that is built from the root outwards, to begin a descent with, unless `start` fits closely:
    /// first the markers that no limb moves, from `start` if there are too few, then those of one limb after
    /// another, each at the best of its quarter turns. Markers farther out cannot lead an inner joint astray.
    pub(crate) fn outward(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        frame: usize,
        start: &FrameAnswer,
    ) -> Option<FrameAnswer> {
        let groups_of = |limbs: &[Limb], group: Option<usize>| {
            group.is_some_and(|g| limbs.iter().any(|limb| limb.groups.contains(&g)))
        };
        let shown = |hidden: &[Limb]| -> Vec<Option<[f64; 3]>> {
            let markers = self.markers.placed.iter().zip(seen);
            markers.map(|(m, seen)| seen.filter(|_| !groups_of(hidden, m.group))).collect()
        };
        if self.limbs.is_empty() || start.minimised() < CLOSE {
            return None;
        }
        let mut now = shown(&self.limbs);
        let mut answer = start.clone();
        let counts = |(marker, seen): (&Placed, &Option<_>)| marker.weight > 0.0 && seen.is_some();
        if self.markers.placed.iter().zip(&now).filter(|&pair| counts(pair)).count() >= TURNED_BY {
            let mut best: Option<FrameAnswer> = None;
            for guess in self.first_guesses(scratch, &now, TURNED_BY) {
                let one = self.solve_frame(scratch, &now, frame, &guess);
                if best.as_ref().is_none_or(|best| better(&one, best)) {
                    best = Some(one);
                }
            }
            answer = best?;
        }
        for (limb, hidden) in (1..=self.limbs.len()).enumerate() {
            let (before, hidden) = (now, &self.limbs[hidden..]);
            now = shown(hidden);
            let groups = &self.limbs[limb].direct;
            let own = |group: Option<usize>| group.is_some_and(|g| groups.contains(&g));
            let mut best = self.solve_frame(scratch, &now, frame, &answer.coordinates);
            let Some(off) = self.mean(scratch, &now, &best.coordinates, own) else { continue };
            let all = self.mean(scratch, &now, &best.coordinates, |_| true).unwrap_or(off);
            let others = self.mean(scratch, &before, &answer.coordinates, |_| true).unwrap_or(0.0);
            if off.max(all) > FITS * others + FITS_FLOOR {
                let guesses = self.best_turned(scratch, &now, limb, groups, &answer.coordinates);
                for guess in guesses {
                    let one = self.solve_frame(scratch, &now, frame, &guess);
                    if better(&one, &best) {
                        best = one;
                    }
                }
            }
            answer = best;
        }
        Some(answer)
    }

    /// Rough first guesses for a frame about which nothing is known, the most promising first.
    ///
    /// The coordinates that turn the whole model are tried at every combination of quarter turns
    /// that their ranges allow; each is judged by the markers' distances after both clouds are
    /// moved to their centroids. The defaults are always among the guesses.
    pub(crate) fn first_guesses(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        most: usize,
    ) -> Vec<Vec<f64>> {
        let mut guesses = vec![(f64::INFINITY, self.defaults.clone())];
        let digits = |&id: &CoordinateId| self.model.tangent_range(id).len() as u32;
        let digits: u32 = self.root_rotations.iter().map(digits).sum();
        let turns = 4usize.pow(digits.min(MOST_TURNED as u32));
        for combination in 0..turns {
            let mut stored = self.defaults.clone();
            let mut digits = combination;
            let mut legal = true;
            for &id in &self.root_rotations {
                let place = self.model.stored_range(id);
                if self.model.coordinate(id).kind == CoordinateKind::Orientation {
                    // Three digits turn it about each axis in turn.
                    stored[place].copy_from_slice(&quarter_turns(digits).to_array());
                    digits /= QUARTERS;
                    continue;
                }
                let quarter = (digits % 4) as f64;
                digits /= 4;
                let value = (quarter - if quarter == 3.0 { 4.0 } else { 0.0 }) * FRAC_PI_2;
                stored[place.start] += value;
                let range = self.model.coordinate(id).range;
                legal &= !self.rules.limits
                    || value == 0.0
                    || range.distance(stored[place.start]) >= 0.0;
            }
            if legal && let Some(spread) = self.spread(scratch, seen, &mut stored) {
                guesses.push((spread, stored));
            }
        }
        guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Three angles name most orientations twice; of these the one nearer to the defaults is tried.
        guesses.dedup_by(|later, kept| {
            let same = later.0 - kept.0 <= SAME * kept.0;
            if same && self.away(&later.1) < self.away(&kept.1) {
                std::mem::swap(later, kept);
            }
            same
        });
        guesses.truncate(most.max(1));
        guesses.into_iter().map(|(_, stored)| stored).collect()
    }

    /// Squared distance between the model's and the recorded markers, each about their centroid.
    fn spread(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        stored: &mut [f64],
    ) -> Option<f64> {
        self.hold(stored);
        let pose = scratch.buffers.pose_at(self, stored)?;
        let seen = || {
            let markers = self.markers.placed.iter().zip(seen);
            markers.filter_map(|(marker, seen)| {
                Some((marker.weight, marker.at(pose) - Vec3::from((*seen)?)))
            })
        };
        let (mut total, mut between) = (0.0, Vec3::ZERO);
        for (weight, off) in seen() {
            between += off * weight;
            total += weight;
        }
        if total <= 0.0 {
            return None;
        }
        let between = between * (1.0 / total);
        let mut sum = 0.0;
        for (weight, off) in seen() {
            sum += weight * (off - between).norm_squared();
        }
        Some(sum)
    }
}
