//! Where to begin when nothing is known: the whole model at quarter turns, then each limb.

use crate::answer::FrameAnswer;
use crate::target::Markers;
use crate::tracker::{FIXED, Scratch, Tracker};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, JointSetId, Model};
use std::f64::consts::{FRAC_PI_2, TAU};

/// At most so many angles are tried at all quarter turns.
const MOST_TURNED: u32 = 3;

/// How many of a limb's quarter turns are solved.
const LIMB_GUESSES: usize = 3;

/// A joint between some of the markers and the others.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    joint_set: JointSetId,
    /// At most three rotations: where each is stored, and its bounds.
    rotations: Vec<(usize, f64, f64)>,
    /// The groups of markers that it moves.
    groups: Vec<usize>,
}

impl Limb {
    /// The limbs of a model, from the root outwards.
    pub(crate) fn of(
        model: &Model,
        markers: &Markers,
        unknowns: &[u32],
        stored: &[Option<(usize, f64, f64)>],
    ) -> Vec<Self> {
        let mut limbs: Vec<Self> = vec![];
        for id in model.coordinate_ids() {
            let unknown = unknowns[model.tangent_range(id).start];
            if unknown == FIXED || model.coordinate(id).kind != CoordinateKind::Rotation {
                continue;
            }
            let Some(rotation) = stored[unknown as usize] else { continue };
            let moved = |group: &usize| {
                markers.groups[*group].entries.iter().any(|(other, _)| *other == unknown)
            };
            let groups: Vec<usize> = (0..markers.groups.len()).filter(moved).collect();
            if groups.is_empty() || groups.len() == markers.groups.len() {
                continue;
            }
            let joint_set = model.coordinate(id).joint_set;
            match limbs.iter_mut().find(|limb| limb.joint_set == joint_set) {
                Some(limb) if limb.rotations.len() < MOST_TURNED as usize => {
                    limb.rotations.push(rotation);
                    limb.groups.extend(groups);
                }
                Some(_) => {}
                None => limbs.push(Self { joint_set, rotations: vec![rotation], groups }),
            }
        }
        for limb in &mut limbs {
            limb.groups.sort_unstable();
            limb.groups.dedup();
        }
        limbs
    }
}

impl Tracker {
    /// A limb at other quarter turns, the most promising first; none where its markers fit as well as all
    /// do on average.
    pub(crate) fn limb_guesses(
        &self,
        scratch: &mut Scratch,
        seen: &[Option<[f64; 3]>],
        limb: usize,
        answer: &FrameAnswer,
    ) -> Vec<Vec<f64>> {
        let limb = &self.limbs[limb];
        let mean = |scratch: &mut Scratch, stored: &[f64], all: bool| -> Option<f64> {
            let pose = scratch.buffers.pose_at(self, stored)?;
            let (mut sum, mut total) = (0.0, 0.0);
            for (marker, seen) in self.markers.placed.iter().zip(seen) {
                let counts = all || marker.group.is_some_and(|g| limb.groups.contains(&g));
                if let (true, Some(seen)) = (counts, seen) {
                    sum += marker.weight * (marker.at(pose) - Vec3::from(*seen)).norm_squared();
                    total += marker.weight;
                }
            }
            (total > 0.0).then(|| sum / total)
        };
        let own = mean(scratch, &answer.coordinates, false);
        let Some((own, all)) = own.zip(mean(scratch, &answer.coordinates, true)) else {
            return vec![];
        };
        if own < all {
            return vec![];
        }
        let mut guesses = vec![];
        for combination in 1..4usize.pow(limb.rotations.len() as u32) {
            let mut stored = answer.coordinates.clone();
            let mut digits = combination;
            let mut legal = true;
            for &(place, lower, upper) in &limb.rotations {
                let turned = stored[place] + (digits % 4) as f64 * FRAC_PI_2;
                let inside =
                    [turned, turned - TAU].into_iter().find(|q| (lower..=upper).contains(q));
                legal &= inside.is_some();
                stored[place] = inside.unwrap_or(stored[place]);
                digits /= 4;
            }
            if legal && let Some(off) = mean(scratch, &stored, false) {
                guesses.push((off, stored));
            }
        }
        guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
        guesses.truncate(LIMB_GUESSES);
        guesses.into_iter().map(|(_, stored)| stored).collect()
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
        let turns = 4usize.pow(digits.min(MOST_TURNED));
        for combination in 0..turns {
            let mut stored = self.defaults.clone();
            let mut digits = combination;
            let mut legal = true;
            for &id in &self.root_rotations {
                let place = self.model.stored_range(id);
                if self.model.coordinate(id).kind == CoordinateKind::Orientation {
                    // Three digits turn it about each axis in turn.
                    let turn = |axis, quarters: usize| {
                        Quat::from_axis_angle(axis, quarters as f64 * FRAC_PI_2)
                    };
                    let turned = turn(Vec3::Y, digits % 4)
                        * turn(Vec3::X, digits / 4 % 4)
                        * turn(Vec3::Z, digits / 16 % 4);
                    digits /= 64;
                    stored[place].copy_from_slice(&turned.to_array());
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
        guesses.dedup_by(|a, b| a.1 == b.1);
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
