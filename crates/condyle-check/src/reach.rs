//! The values that the scalars of a model take while their leaders vary over their ranges.
//!
//! Scalar laws are few and small, so they are evaluated here one by one, in order of dependency, at
//! samples of the leaders: every sample is a value that the model really takes, and with a single
//! leader the leader's value that causes it is known.

use super::real_range;
use condyle_model::component::{Law, Signal};
use condyle_model::{CoordinateId, CoordinateKind, Model};
use std::cell::Cell;
use std::collections::HashMap;

/// Samples of a range with one leader.
const STEPS: usize = 240;

/// Samples with several leaders.
const SEVERAL: usize = 4096;

/// A scalar with more leaders than this is not sampled, and its leaders beyond are not named.
const MOST_LEADERS: usize = 32;

/// The most scalars that are computed in total: a few seconds. Real models need far fewer.
const BUDGET: usize = 20_000_000;

/// The scalars of a model, in an order in which they can be computed.
pub(super) struct Reach<'m> {
    model: &'m Model,
    /// Followers and outputs of components, each after what it reads.
    order: Vec<Signal>,
    place: HashMap<Signal, usize>,
    /// For each of them the free coordinates that determine it.
    leaders: Vec<Vec<CoordinateId>>,
    left: Cell<usize>,
}

/// The values that a scalar took.
pub(super) struct Taken {
    /// The coordinates that lead it, followers not among them.
    pub(super) leaders: Vec<CoordinateId>,
    /// The leaders' values and the scalar's own, sample by sample.
    pub(super) samples: Vec<(Vec<f64>, f64)>,
}

impl Taken {
    /// The sample with the least and that with the greatest value.
    pub(super) fn extremes(&self) -> Option<[&(Vec<f64>, f64); 2]> {
        let least = self.samples.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let greatest = self.samples.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some([least, greatest])
    }
}

/// What a scalar reads: nothing for a coordinate that is free, or for what is no law of scalars.
fn reads(model: &Model, source: Signal) -> Vec<Signal> {
    match source {
        Signal::Coordinate(id) => model.coordinate(id).follows.into_iter().collect(),
        Signal::Output(id, _) => {
            let component = &model.components()[id.index()];
            match component.law {
                // In open mode the driver of a bound does not matter.
                Law::Depend(_) => component.values().take(1).collect(),
                _ => component.values().collect(),
            }
        }
        Signal::Segment(_) => vec![],
    }
}

impl<'m> Reach<'m> {
    pub(super) fn new(model: &'m Model) -> Self {
        let mut wanted: Vec<Signal> = model.coordinate_ids().map(Signal::Coordinate).collect();
        wanted.extend(model.components().iter().flat_map(|component| component.values()));
        let mut reach = Self {
            model,
            order: vec![],
            place: HashMap::new(),
            leaders: vec![],
            left: Cell::new(BUDGET),
        };
        // Depth first with a stack: a scalar is computed after all its inputs.
        let mut seen = std::collections::HashSet::new();
        let mut stack: Vec<(Signal, bool)> = vec![];
        for source in wanted {
            stack.push((source, false));
            while let Some((source, ready)) = stack.pop() {
                if ready {
                    let leaders = reach.leaders_of(source);
                    reach.place.insert(source, reach.order.len());
                    reach.order.push(source);
                    reach.leaders.push(leaders);
                } else if seen.insert(source) {
                    stack.push((source, true));
                    stack.extend(reads(model, source).into_iter().map(|s| (s, false)));
                }
            }
        }
        reach
    }

    /// The leaders of a scalar, from those of what it reads.
    fn leaders_of(&self, source: Signal) -> Vec<CoordinateId> {
        let reads = reads(self.model, source);
        if let (Signal::Coordinate(id), []) = (source, &reads[..]) {
            return vec![id];
        }
        let mut leaders: Vec<CoordinateId> =
            reads.into_iter().flat_map(|read| self.leaders(read).iter().copied()).collect();
        leaders.sort_unstable();
        leaders.dedup();
        leaders.truncate(MOST_LEADERS + 1);
        leaders
    }

    /// The free coordinates that determine a scalar, in the model's order.
    pub(super) fn leaders(&self, source: Signal) -> &[CoordinateId] {
        self.place.get(&source).map_or(&[], |&place| &self.leaders[place])
    }

    /// Whether everything requested could be sampled.
    pub(super) fn finished(&self) -> bool {
        self.left.get() > 0
    }

    /// All that must be computed before a scalar, and itself, in order.
    fn plan(&self, source: Signal) -> Vec<Signal> {
        let mut seen = std::collections::HashSet::from([source]);
        let mut open = vec![source];
        while let Some(next) = open.pop() {
            open.extend(reads(self.model, next).into_iter().filter(|&s| seen.insert(s)));
        }
        let mut plan: Vec<Signal> = seen.into_iter().collect();
        plan.sort_by_key(|source| self.place.get(source));
        plan
    }

    fn run(&self, plan: &[Signal], leader: impl Fn(CoordinateId) -> f64) -> f64 {
        let mut values: HashMap<Signal, f64> = HashMap::with_capacity(plan.len());
        let mut last = f64::NAN;
        for &source in plan {
            let of = |source: Signal| values.get(&source).copied().unwrap_or(f64::NAN);
            last = match source {
                Signal::Coordinate(id) => match self.model.coordinate(id).follows {
                    Some(follows) => of(follows),
                    None => leader(id),
                },
                Signal::Output(id, output) => {
                    let component = &self.model.components()[id.index()];
                    let input = |k: usize| component.inputs.get(k).map_or(f64::NAN, |&s| of(s));
                    match &component.law {
                        Law::Map(map) => map
                            .functions
                            .get(output as usize)
                            .map_or(f64::NAN, |f| f.value_and_slope(input(0)).0),
                        // In open mode a limit passes what it bounds: each of these is taken.
                        Law::Cone(_) => component
                            .at("angles")
                            .get(output as usize)
                            .map_or(f64::NAN, |&angle| of(angle)),
                        law if law.bounds() => input(output as usize),
                        law => law.several().map_or(f64::NAN, |function| {
                            function.apply_to(component.inputs.iter().map(|&s| of(s)))
                        }),
                    }
                }
                Signal::Segment(_) => f64::NAN,
            };
            values.insert(source, last);
        }
        last
    }

    /// A scalar where every coordinate has its default.
    pub(super) fn at_rest(&self, source: Signal) -> f64 {
        self.run(&self.plan(source), |id| self.model.coordinate(id).default[0])
    }

    /// The values of a scalar while its leaders run through their declared ranges, locked ones
    /// at their defaults; `None` if a leader has no range or the law is not one of scalars.
    pub(super) fn taken(&self, source: Signal) -> Option<Taken> {
        let leaders = self.leaders(source);
        if leaders.len() > MOST_LEADERS || !self.finished() {
            return None;
        }
        let mut ranges = vec![];
        for &id in leaders {
            let coordinate = self.model.coordinate(id);
            if coordinate.kind == CoordinateKind::Orientation {
                return None;
            }
            ranges.push(if coordinate.locked {
                (coordinate.default[0], coordinate.default[0])
            } else {
                real_range(self.model, id)?
            });
        }
        let plan = self.plan(source);
        let moving = ranges.iter().filter(|(lower, upper)| lower < upper).count();
        let count = match moving {
            0 => 1,
            1 => STEPS + 1,
            _ => SEVERAL,
        };
        let cost = plan.len().saturating_mul(count + 1);
        self.left.set(self.left.get().saturating_sub(cost));
        if !self.finished() {
            return None;
        }
        let mut samples = Vec::with_capacity(count);
        let mut place = HashMap::new();
        for index in 0..count {
            let values: Vec<f64> = ranges
                .iter()
                .enumerate()
                .map(|(which, &(lower, upper))| {
                    let part = match moving {
                        1 => index as f64 / STEPS as f64,
                        _ => corner_or_inside(index, which),
                    };
                    lower + part * (upper - lower)
                })
                .collect();
            place.clear();
            place.extend(leaders.iter().copied().zip(values.iter().copied()));
            let value = self.run(&plan, |id| place.get(&id).copied().unwrap_or(f64::NAN));
            if !value.is_finite() {
                return None;
            }
            samples.push((values, value));
        }
        Some(Taken { leaders: leaders.to_vec(), samples })
    }
}

/// The first half of the samples are corners of the box, the other half lie inside it (the
/// fractional parts of multiples of irrational numbers fill it evenly).
fn corner_or_inside(index: usize, which: usize) -> f64 {
    if index < SEVERAL / 2 {
        return if which < 32 { (index >> which & 1) as f64 } else { (index & 1) as f64 };
    }
    let step = (2.0 + 3.0 * which as f64).sqrt();
    (index as f64 * step).fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::component::JointCone;
    use condyle_model::component::Swinging;
    use condyle_model::limit::{Cone, ConePoint, Projection};
    use condyle_model::{ModelBuilder, Range};

    #[test]
    fn a_cone_takes_what_its_angles_take() {
        let mut b = ModelBuilder::new("hip");
        let set = b.joint_set("hip");
        let bounds = [[-0.3, 1.9], [-0.5, 0.4], [-0.6, 0.7]];
        let angles: Vec<CoordinateId> = bounds
            .iter()
            .enumerate()
            .map(|(i, [low, high])| {
                let id = b.coordinate(set, &format!("angle_{i}"), CoordinateKind::Rotation);
                b.coordinate_mut(id).range = Range::new(*low, *high);
                id
            })
            .collect();
        let corner = |x: f64, z: f64| ConePoint { direction: Vec3::new(x, -1.0, z), twist: None };
        let corners = vec![corner(0.2, 0.2), corner(-0.2, 0.2), corner(0.0, -0.2)];
        let cone = Cone::new(-Vec3::Y, None, corners, 0, Projection::Nearest).unwrap();
        let sources = angles.iter().map(|&angle| angle.into()).collect();
        let of = Swinging::Angles([Vec3::Z, Vec3::X, Vec3::Y]);
        let held = b.component(set, "held", Law::Cone(JointCone { of, cone }), sources);
        let Signal::Output(id, _) = held else { panic!("a component has outputs") };
        for output in 0..3 {
            b.rotate(set, "turn", Signal::Output(id, output), Vec3::X);
        }
        let model = b.build().unwrap();
        let reach = Reach::new(&model);
        for (output, [low, high]) in bounds.into_iter().enumerate() {
            // The cone is narrower than the ranges, which tracking does not know.
            let taken = reach.taken(Signal::Output(id, output as u32)).unwrap();
            let [least, greatest] = taken.extremes().unwrap();
            let off = (least.1 - low).abs().max((greatest.1 - high).abs());
            assert!(off < 1e-15, "angle {output}: {off}");
            assert_eq!(taken.leaders, angles);
        }
    }
}
