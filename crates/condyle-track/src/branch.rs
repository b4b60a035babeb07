//! Other numbers for the same posture: whole turns, and the second solution of three angles.
//!
//! A rotation q and q + 2π are one posture unless something reads q as a length (a screw, a spline). Three
//! angles of one joint name a rotation twice: `(q₁ + π, s - q₂, q₃ + π)` with s = π where the first and
//! the third axis differ (Cardan), 0 where they are the same (Euler). Which coordinates are such is not
//! read off the components but tried: at several postures all that is tracked must stay where it is.

use crate::target::Targets;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Law, Mode, Model, Pose, Program, SegmentId};
use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A range that spans this much, 359°, has no ends where whole turns are the same posture.
const CIRCLE: f64 = 359.0 * PI / 180.0;

/// The ends of a range that spans this much, 270°, are near each other where whole turns are the same posture.
const WIDE: f64 = 1.5 * PI;

/// At how many postures is tried.
const TRIES: usize = 6;

/// Two numbers for one posture may differ by rounding.
const SAME: f64 = 1e-9;

/// How far a limb is raised from a pole to see where it could go, in radians.
const RAISED: f64 = 0.05;

/// Three rotations of a joint that name each posture twice.
#[derive(Clone, Debug, PartialEq)]
struct Twin {
    /// Where they are stored: the first, the middle and the third.
    places: [usize; 3],
    /// q₂ of the other is `sum` - q₂.
    sum: f64,
}

/// Which coordinates have other numbers for the same posture.
#[derive(Clone, Debug, Default)]
pub(crate) struct Branches {
    /// Where the rotations are stored of which whole turns are the same posture.
    circles: Vec<usize>,
    /// Where those are stored of which the two ends are near each other.
    wide: Vec<usize>,
    twins: Vec<Twin>,
    /// Pairs of rotations of which the first tells nothing where the second is at its lower bound: a direction, and how
    /// far something is raised in it.
    poles: Vec<[usize; 2]>,
}

/// Where a coordinate of one number is stored, and its bounds.
pub(crate) type Bounded = (usize, f64, f64);

impl Branches {
    /// Tries the rotations among the unknowns; a range that is a circle loses its ends.
    pub(crate) fn find(
        model: &Model,
        program: &Program,
        targets: &Targets,
        stored: &mut [Option<Bounded>],
    ) -> Self {
        // A value that a coordinate should have, or rest at, tells its other numbers apart.
        let wanted = targets.coordinates.iter().map(|t| t.coordinate);
        let resting = targets.postures.iter().flat_map(|t| t.terms.iter().map(|(id, _)| *id));
        let told_apart: Vec<_> = wanted.chain(resting).collect();
        let mut same = Comparison::new(model, program, targets);
        let (mut branches, mut triple) = (Self::default(), vec![]);
        for id in model.coordinate_ids() {
            let place = model.stored_range(id).start;
            let unknown = stored.iter_mut().flatten().find(|(stored, ..)| *stored == place);
            let Some((_, lower, upper)) = unknown else { continue };
            if model.coordinate(id).kind != CoordinateKind::Rotation {
                continue;
            }
            triple.push((place, model.coordinate(id).joint_set, told_apart.contains(&id)));
            let span = *upper - *lower;
            if span < WIDE || !same.holds((*lower, *upper), |q| vec![(place, q[place] + TAU)]) {
                continue;
            }
            if span < CIRCLE {
                branches.wide.push(place);
            } else {
                (*lower, *upper) = (f64::NEG_INFINITY, f64::INFINITY);
                if !told_apart.contains(&id) {
                    branches.circles.push(place);
                }
            }
        }
        for three in triple.windows(3) {
            let [a, b, c] = [three[0], three[1], three[2]];
            if a.1 != b.1 || b.1 != c.1 || a.2 || b.2 || c.2 {
                continue;
            }
            let [a, b, c] = [a.0, b.0, c.0];
            let orders = [[a, b, c], [b, a, c], [a, c, b]];
            let found = orders.iter().flat_map(|&places| [PI, 0.0].map(|sum| Twin { places, sum }));
            let holds = |twin: &Twin, same: &mut Comparison<'_>| {
                same.holds((f64::NEG_INFINITY, f64::INFINITY), |q| twin.of(q).to_vec())
            };
            branches.twins.extend(found.into_iter().find(|twin| holds(twin, &mut same)));
        }
        for [(around, set, _), (raised, other, _)] in pairs(&triple) {
            let bound = stored.iter().flatten().find(|(place, ..)| *place == raised);
            if let (true, Some(&(_, lower, _))) = (set == other, bound)
                && lower.is_finite()
                && same.is_pole(around, raised, lower)
            {
                branches.poles.push([around, raised]);
            }
        }
        branches
    }

    /// Of all numbers for a posture those nearest to `to` that are within the bounds; whether they
    /// are others than before.
    pub(crate) fn bring_near(
        &self,
        stored: &mut [f64],
        to: &[f64],
        bounds: &[Option<Bounded>],
    ) -> bool {
        let mut changed = false;
        for &place in &self.circles {
            let turns = ((stored[place] - to[place]) / TAU).round();
            if turns != 0.0 {
                stored[place] -= turns * TAU;
                changed = true;
            }
        }
        for twin in &self.twins {
            let other = self.turned_near(twin.of(stored), to);
            let away = |values: [(usize, f64); 3]| -> f64 {
                values.iter().map(|&(place, q)| (q - to[place]).powi(2)).sum()
            };
            let own = twin.places.map(|place| (place, stored[place]));
            if away(other) < away(own) - SAME && legal(&other, bounds) {
                other.iter().for_each(|&(place, q)| stored[place] = q);
                changed = true;
            }
        }
        changed
    }

    /// Names postures by angles that are in the model's ranges, where those at hand are not and the other three of the
    /// joint are; whether any were changed. Ranges count whether limits hold or not.
    pub(crate) fn bring_inside(&self, stored: &mut [f64], model: &Model) -> bool {
        let range = |place: usize| {
            let own = |id: &CoordinateId| model.stored_range(*id).start == place;
            let id = model.coordinate_ids().find(own)?;
            Some(model.coordinate(id).range.bounds())
        };
        let inside = |values: &[(usize, f64)]| {
            values.iter().all(|&(place, q)| range(place).is_none_or(|(l, u)| (l..=u).contains(&q)))
        };
        let mut changed = false;
        for twin in &self.twins {
            if inside(&twin.places.map(|place| (place, stored[place]))) {
                continue;
            }
            let other = twin.of(stored).map(|(place, q)| {
                let turned = [0.0, -TAU, TAU].map(|turn| (place, q + turn));
                turned.into_iter().find(|value| inside(&[*value])).unwrap_or((place, q))
            });
            if inside(&other) {
                other.iter().for_each(|&(place, q)| stored[place] = q);
                changed = true;
            }
        }
        changed
    }

    /// Where else a limb could go that is not raised at all: a little in each other quarter of the directions in which it
    /// could be. There the direction has no gradient, so that no descent leads away from the bound.
    pub(crate) fn off_poles<'a>(
        &'a self,
        stored: &'a [f64],
        bounds: &'a [Option<Bounded>],
    ) -> impl Iterator<Item = [(usize, f64); 2]> + 'a {
        let bound = move |place: usize| bounds.iter().flatten().find(move |(p, ..)| *p == place);
        let low = move |&&[_, raised]: &&[usize; 2]| {
            bound(raised).is_some_and(|&(_, lower, _)| stored[raised] <= lower)
        };
        let quarters = [FRAC_PI_2, PI, -FRAC_PI_2];
        self.poles.iter().filter(low).flat_map(move |&[around, raised]| {
            quarters.into_iter().filter_map(move |quarter| {
                let inside = |q: &f64| bound(around).is_none_or(|&(_, l, u)| (l..=u).contains(q));
                let turned = [0.0, -TAU, TAU].map(|turn| stored[around] + quarter + turn);
                let q = turned.into_iter().find(inside)?;
                Some([(around, q), (raised, stored[raised] + RAISED)])
            })
        })
    }

    /// Where else a joint could be that is at a bound: at its other three angles, or at the other end of an
    /// angle whose two ends are near each other.
    pub(crate) fn across_bounds<'a>(
        &'a self,
        stored: &'a [f64],
        bounds: &'a [Option<Bounded>],
    ) -> impl Iterator<Item = [(usize, f64); 3]> + 'a {
        let bound = move |place: usize| bounds.iter().flatten().find(move |(p, ..)| *p == place);
        let at_bound = move |&place: &usize| {
            bound(place).is_some_and(|&(p, lower, upper)| stored[p] <= lower || stored[p] >= upper)
        };
        let twins = self.twins.iter().filter(move |twin| twin.places.iter().any(at_bound));
        let others = twins.filter_map(move |twin| {
            // By whole turns into the bounds.
            let fitted = twin.of(stored).map(|(place, q)| {
                let turns = [0.0, -TAU, TAU].map(|turn| q + turn);
                let inside = |q: &f64| bound(place).is_none_or(|&(_, l, u)| (l..=u).contains(q));
                (place, turns.into_iter().find(inside).unwrap_or(q))
            });
            legal(&fitted, bounds).then_some(fitted)
        });
        let wide = self.wide.iter().copied().filter(at_bound);
        let ends = wide.filter_map(move |place| {
            let &(_, lower, upper) = bound(place)?;
            Some([(place, if stored[place] <= lower { upper } else { lower }); 3])
        });
        others.chain(ends)
    }

    fn turned_near(&self, values: [(usize, f64); 3], to: &[f64]) -> [(usize, f64); 3] {
        values.map(|(place, q)| {
            let turns = ((q - to[place]) / TAU).round() * TAU;
            (place, if self.circles.contains(&place) { q - turns } else { q })
        })
    }
}

impl Twin {
    /// The other three angles.
    fn of(&self, stored: &[f64]) -> [(usize, f64); 3] {
        let [a, b, c] = self.places;
        [(a, stored[a] + PI), (b, self.sum - stored[b]), (c, stored[c] + PI)]
    }
}

/// All pairs of different ones that are at most two apart, in both orders.
fn pairs<T: Copy>(all: &[T]) -> impl Iterator<Item = [T; 2]> + '_ {
    (1..=2).flat_map(move |apart| {
        let both = all.iter().zip(all.iter().skip(apart));
        both.flat_map(|(a, b)| [[*a, *b], [*b, *a]])
    })
}

fn legal(values: &[(usize, f64)], bounds: &[Option<Bounded>]) -> bool {
    values.iter().all(|&(place, q)| {
        let bound = bounds.iter().flatten().find(|(p, ..)| *p == place);
        bound.is_none_or(|&(_, lower, upper)| (lower..=upper).contains(&q))
    })
}

/// Compares what is tracked at two lists of numbers.
struct Comparison<'a> {
    model: &'a Model,
    program: Cow<'a, Program>,
    /// The segments between which limits measure: where these are alike, so is what limits say, and none is asked.
    measured: Vec<SegmentId>,
    targets: &'a Targets,
    poses: [Pose; 2],
    closures: [ClosureRows; 2],
    dice: u64,
}

impl<'a> Comparison<'a> {
    fn new(model: &'a Model, program: &'a Program, targets: &'a Targets) -> Self {
        let (mut program, mut measured) = (Cow::Borrowed(program), vec![]);
        if !program.measured_limit_rows().is_empty() {
            let measures =
                |law: &Law| matches!(law, Law::RelativeOrientation(_) | Law::RelativePosition(_));
            let components = model.components().iter().filter(|c| measures(&c.law));
            measured =
                components.flat_map(|c| c.inputs.iter().filter_map(|i| i.segment())).collect();
            program = Cow::Owned(Program::compile_unmeasured(model));
        }
        let poses = [Pose::new(&program), Pose::new(&program)];
        let closures = [ClosureRows::new(model), ClosureRows::new(model)];
        Self { model, program, measured, targets, poses, closures, dice: 1 }
    }

    /// A number from 0 to 1: SplitMix64 (Steele, Lea & Flood 2014).
    fn random(&mut self) -> f64 {
        self.dice = self.dice.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.dice;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Whether numbers changed like this are the same posture, wherever it is tried: rotations anywhere
    /// within half a turn, those that change anywhere within the range given.
    fn holds(&mut self, range: (f64, f64), changed: impl Fn(&[f64]) -> Vec<(usize, f64)>) -> bool {
        let (lower, upper) = (range.0.max(-PI), range.1.min(PI));
        (0..TRIES).all(|_| {
            let mut at = self.model.defaults();
            for id in self.model.coordinate_ids() {
                if self.model.coordinate(id).kind == CoordinateKind::Rotation {
                    at[self.model.stored_range(id).start] += PI * (2.0 * self.random() - 1.0);
                }
            }
            for (place, _) in changed(&at) {
                at[place] = lower + (upper - lower) * self.random();
            }
            let changes = changed(&at);
            let mut other = at.clone();
            changes.iter().for_each(|&(place, q)| other[place] = q);
            self.same(&at, &other, &changes)
        })
    }

    /// Whether a rotation turns a segment that should have an orientation, but not where another one is at its bound,
    /// whatever all others are.
    fn is_pole(&mut self, around: usize, raised: usize, lower: f64) -> bool {
        let segments: Vec<SegmentId> =
            self.targets.orientations.iter().map(|t| t.segment).collect();
        let mut still = vec![true; segments.len()];
        for _ in 0..TRIES {
            let mut at = self.model.defaults();
            for id in self.model.coordinate_ids() {
                if self.model.coordinate(id).kind == CoordinateKind::Rotation {
                    at[self.model.stored_range(id).start] += 0.5 * (2.0 * self.random() - 1.0);
                }
            }
            let turn = 1.0 + self.random();
            let mut turned = |height: f64| -> Option<Vec<f64>> {
                let mut other = at.clone();
                (at[raised], other[raised]) = (height, height);
                other[around] += turn;
                for (stored, pose) in [&at, &other].into_iter().zip(&mut self.poses) {
                    self.program.evaluate(stored, Mode::Open, pose).ok()?;
                }
                let [p, q] = &self.poses;
                let off = segments.iter().map(|&segment| {
                    let [p, q] = [p, q].map(|pose| pose.segment(segment).linear);
                    [p.x - q.x, p.y - q.y, p.z - q.z]
                        .iter()
                        .map(|off| off.norm())
                        .fold(0.0, f64::max)
                });
                Some(off.collect())
            };
            let (Some(low), Some(high)) = (turned(lower), turned(lower + 0.7)) else {
                return false;
            };
            for (still, (low, high)) in still.iter_mut().zip(low.iter().zip(&high)) {
                *still &= *low <= SAME && *high > 0.05;
            }
            if !still.contains(&true) {
                return false;
            }
        }
        true
    }

    fn same(&mut self, a: &[f64], b: &[f64], changes: &[(usize, f64)]) -> bool {
        let Self { model, program, measured, targets, poses, closures, .. } = self;
        for ((stored, pose), closures) in [a, b].iter().zip(&mut *poses).zip(&mut *closures) {
            if program.evaluate(stored, Mode::Open, pose).is_err() {
                return false;
            }
            closures.update(model, program, pose, None);
        }
        let [p, q] = &*poses;
        let close = |x: f64, y: f64| (x - y).abs() <= SAME;
        let mut markers = targets.markers.iter().filter(|t| t.weight > 0.0);
        let segments = targets.orientations.iter().map(|t| t.segment);
        let mut places = measured.iter();
        markers.all(|target| {
            let marker = &model.markers()[target.marker];
            let [p, q] = [p, q].map(|pose| pose.frame(marker.segment) * marker.point);
            (p - q).norm() <= SAME
        }) && segments.into_iter().all(|segment| {
            let [p, q] = [p, q].map(|pose| pose.segment(segment).linear);
            [(p.x - q.x), (p.y - q.y), (p.z - q.z)].iter().all(|off| off.norm() <= SAME)
        }) && places.all(|segment| {
            let [p, q] = [p, q].map(|pose| pose.segment(*segment));
            let off = [p.linear.x - q.linear.x, p.linear.y - q.linear.y, p.linear.z - q.linear.z];
            off.iter().all(|off| off.norm() <= SAME)
                && (p.translation - q.translation).norm() <= SAME
        }) && (0..program.limit_row_len()).all(|row| close(p.limit_row(row), q.limit_row(row)))
            && closures[0].residuals.iter().zip(&closures[1].residuals).all(|(x, y)| close(*x, *y))
            && p.effective().iter().zip(q.effective()).enumerate().all(|(place, (x, y))| {
                close(*x, *y) || changes.iter().any(|(changed, _)| *changed == place)
            })
    }
}
