//! A slow reference for the evaluation: every value is recomputed by walking the model.

use super::scan;
use condyle_math::{Affine, EulerOrder, Mat3, Quat, Vec3};
use condyle_model::component::{
    Along, AngleNames, Centre, Component, ContactPair, Gliding, JointCone, Law, MotionLaw,
    SurfaceAxis, Swinging,
};
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateId, Mode, Model, SegmentId, Signal};
use std::cell::Cell;
use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

pub(crate) struct Evaluator<'a> {
    model: &'a Model,
    stored: &'a [f64],
    mode: Mode,
    needed: HashSet<ComponentId>,
    /// Set if a contact is so near to a tangency that its angle is ill-conditioned.
    pub(crate) doubtful: Cell<bool>,
}

/// The sources that a limit component limits: one for each of its outputs.
fn held(model: &Model, limit: ComponentId) -> Vec<Signal> {
    let component = &model.components()[limit.index()];
    match component.law {
        _ if measured(model, limit) => vec![],
        Law::Depend(_) => component.at("passive").to_vec(),
        Law::Cone(_) | Law::Ellipse(_) | Law::HalfSpace(_) => component.inputs.clone(),
        _ => vec![],
    }
}

/// Whether a component depends on what is measured between segments: no limit moves it.
fn measured(model: &Model, id: ComponentId) -> bool {
    let component = &model.components()[id.index()];
    let reads = |source: Signal| match source {
        Signal::Output(id, _) => measured(model, id),
        Signal::Coordinate(id) => match model.coordinate(id).follows {
            Some(Signal::Output(id, _)) => measured(model, id),
            Some(Signal::Coordinate(id)) => {
                let follows = model.coordinate(id).follows;
                matches!(follows, Some(Signal::Output(id, _)) if measured(model, id))
            }
            _ => false,
        },
        Signal::Segment(_) => true,
    };
    match component.law {
        Law::Compensate(_) | Law::Contact(_) => component.values().any(reads),
        _ => component.inputs.iter().copied().any(reads),
    }
}

impl<'a> Evaluator<'a> {
    pub(crate) fn new(model: &'a Model, stored: &'a [f64], mode: Mode) -> Self {
        // What segments and followers read, directly or not.
        let mut needed = HashSet::new();
        let followed = model.coordinates().iter().filter_map(|c| c.follows);
        // A limit on what is measured moves nothing, and bounds without being read.
        let limits = model.component_ids().filter(|&id| {
            let law = &model.components()[id.index()].law;
            let bounds = law.limit().is_some() || matches!(law, Law::Depend(_));
            bounds && measured(model, id)
        });
        let limits = limits.map(|id| Signal::Output(id, 0));
        let moved = model.segments().iter().filter_map(|s| s.motion);
        let mut open: Vec<Signal> = moved.chain(followed).chain(limits).collect();
        while let Some(source) = open.pop() {
            if let Signal::Output(id, _) = source
                && needed.insert(id)
            {
                open.extend(model.reads(id));
            }
        }
        Self { model, stored, mode, needed, doubtful: Cell::new(false) }
    }

    pub(crate) fn coordinate(&self, id: CoordinateId) -> Vec<f64> {
        let coordinate = self.model.coordinate(id);
        if let Some(leader) = coordinate.follows {
            return vec![self.scalar(leader)];
        }
        match self.last_limit(id) {
            Some((_, limit, output)) => self.numbers(Signal::Output(limit, output)),
            None => self.asked(id),
        }
    }

    /// The requested numbers, clamped to the range in posed mode.
    fn asked(&self, id: CoordinateId) -> Vec<f64> {
        let coordinate = self.model.coordinate(id);
        let mut values = self.stored[self.model.stored_range(id)].to_vec();
        if self.mode == Mode::Posed && values.len() == 1 {
            values[0] = coordinate.range.nearest(values[0]);
        }
        values
    }

    /// The last of the limits that act on a coordinate, among those that something reads.
    fn last_limit(&self, id: CoordinateId) -> Option<(usize, ComponentId, u32)> {
        let mut best: Option<(usize, ComponentId, u32)> = None;
        for limit in self.model.component_ids().filter(|id| self.needed.contains(id)) {
            for (output, source) in held(self.model, limit).into_iter().enumerate() {
                let Some(depth) = self.limits_between(id, source) else { continue };
                let found = (depth + 1, limit, output as u32);
                if best.is_none_or(|(depth, limit, _)| (found.0, found.1) >= (depth, limit)) {
                    best = Some(found);
                }
            }
        }
        best
    }

    /// The number of limits between a coordinate and a source that is this coordinate, limited.
    fn limits_between(&self, id: CoordinateId, source: Signal) -> Option<usize> {
        match source {
            Signal::Coordinate(other) => (other == id).then_some(0),
            Signal::Output(limit, output) => {
                let source = *held(self.model, limit).get(output as usize)?;
                self.limits_between(id, source).map(|depth| depth + 1)
            }
            Signal::Segment(_) => None,
        }
    }

    /// A segment in another, or in the world.
    fn relative(&self, component: &Component) -> Affine {
        let place = |port| component.segments_at(port).next().map(|id| self.segment(id));
        let segment = place("segment").expect("a segment");
        let reference = place("reference").unwrap_or(Affine::IDENTITY);
        let back = reference.linear.inverse();
        Affine::new(back, -(back * reference.translation)) * segment
    }

    /// The numbers of a scalar or an orientation.
    fn numbers(&self, source: Signal) -> Vec<f64> {
        match source {
            Signal::Coordinate(id) if self.model.coordinate(id).follows.is_none() => self.asked(id),
            Signal::Coordinate(id) => self.coordinate(id),
            Signal::Output(id, output) => {
                let component = &self.model.components()[id.index()];
                match &component.law {
                    Law::Cone(cone) if !measured(self.model, id) => {
                        self.cone(cone, &component.inputs, output)
                    }
                    Law::Cone(JointCone { of: Swinging::Orientation, .. }) => {
                        self.numbers(component.inputs[0])
                    }
                    Law::RelativeOrientation(_) => {
                        Quat::from_mat3(self.relative(component).linear).to_array().to_vec()
                    }
                    _ => vec![self.scalar(source)],
                }
            }
            Signal::Segment(_) => panic!("a segment is no number"),
        }
    }

    /// One output of a cone: the legal rotation decomposed into Euler angles, with all wraps tried.
    fn cone(&self, cone: &JointCone, sources: &[Signal], output: u32) -> Vec<f64> {
        let limit = &cone.cone;
        let axes = match cone.of {
            Swinging::Orientation => {
                let q = self.numbers(sources[0]);
                let q = Quat::from(<[f64; 4]>::try_from(q).unwrap());
                let legal = limit.legal(q.normalized().to_mat3());
                if self.mode == Mode::Open || !legal.moved {
                    return q.to_array().to_vec();
                }
                let found = Quat::from_mat3(legal.rotation).to_array();
                let same: f64 = found.iter().zip(q.to_array()).map(|(a, b)| a * b).sum();
                return found.map(|x| x * same.signum()).to_vec();
            }
            Swinging::Angles(axes) => axes,
            Swinging::Directions([a, b]) => [a, b, limit.rest()],
        };
        let asked: Vec<f64> = sources.iter().map(|&s| self.scalar(s)).collect();
        if self.mode == Mode::Open {
            return vec![asked[output as usize]];
        }
        let turn = |angles: &[f64]| {
            angles.iter().zip(axes).fold(Mat3::IDENTITY, |turned, (&angle, axis)| {
                turned * Quat::from_axis_angle(axis, angle).to_mat3()
            })
        };
        let two = sources.len() == 2;
        let legal = if two {
            let direction = turn(&asked) * limit.rest();
            if limit.contains(direction) {
                return vec![asked[output as usize]];
            }
            // Any rotation that carries the rest direction there will do.
            let to = limit.project(direction).direction;
            let about = limit.rest().cross(to);
            let angle = about.norm().atan2(limit.rest().dot(to));
            let some = if about.norm() > 1e-9 { about.normalized() } else { axes[1] };
            Quat::from_axis_angle(some, angle).to_mat3()
        } else {
            let legal = limit.legal(turn(&asked));
            if !legal.moved {
                return vec![asked[output as usize]];
            }
            legal.rotation
        };
        let name =
            |axis: Vec3| ["x", "y", "z"][axis.to_array().iter().position(|c| *c != 0.0).unwrap()];
        let sign = |axis: Vec3| axis.to_array().iter().sum::<f64>();
        let order: EulerOrder = axes.map(name).concat().parse().unwrap();
        let found = order.from_mat3(legal);
        let signs = axes.map(sign);
        let found: [f64; 3] = std::array::from_fn(|i| found[i] * signs[i]);
        // The other triple: the middle angle on the other side, half a turn on both others.
        let returns = order.axes()[0] == order.axes()[2];
        let middle = if returns { -found[1] } else { PI - found[1] };
        let other = [found[0] + PI, middle, found[2] + PI];
        let near = |angles: [f64; 3]| -> (f64, Vec<f64>) {
            let angles = asked.iter().zip(angles).map(|(&asked, angle)| {
                (-3..=3)
                    .map(|turns| angle + f64::from(turns) * TAU)
                    .min_by(|a, b| (a - asked).abs().total_cmp(&(b - asked).abs()))
                    .unwrap()
            });
            let angles: Vec<f64> = angles.collect();
            (angles.iter().zip(&asked).map(|(a, b)| (a - b) * (a - b)).sum(), angles)
        };
        let ((far, found), (other_far, other)) = (near(found), near(other));
        vec![if other_far < far { other[output as usize] } else { found[output as usize] }]
    }

    fn scalar(&self, source: Signal) -> f64 {
        let Signal::Output(id, output) = source else { return self.numbers(source)[0] };
        let component = &self.model.components()[id.index()];
        let input = |k: usize| self.scalar(component.inputs[k]);
        match &component.law {
            Law::Map(map) => map.functions[output as usize].value_and_slope(input(0)).0,
            Law::Depend(depend) => {
                let (mut x, d) = (input(0), input(1));
                let bound = |f: &condyle_math::function::Function| f.value_and_slope(d).0;
                if self.mode == Mode::Posed && !measured(self.model, id) {
                    x = depend.lower.as_ref().map_or(x, |f| x.max(bound(f)));
                    x = depend.upper.as_ref().map_or(x, |f| x.min(bound(f)));
                }
                x
            }
            Law::Combine(combine) => {
                let x: Vec<f64> = component.inputs.iter().map(|&s| self.scalar(s)).collect();
                combine.function.apply(&x)
            }
            Law::Correlate(law) => {
                let x: Vec<f64> = component.inputs.iter().map(|&s| self.scalar(s)).collect();
                law.function.apply(&x)
            }
            Law::Cone(_) | Law::Ellipse(_) | Law::HalfSpace(_)
                if self.mode == Mode::Open || measured(self.model, id) =>
            {
                input(output as usize)
            }
            Law::Cone(cone) => self.cone(cone, &component.inputs, output)[0],
            Law::HalfSpace(c) => {
                let x: Vec<f64> = (0..component.inputs.len()).map(input).collect();
                let sum: f64 = c.normal().iter().zip(&x).map(|(n, x)| n * x).sum();
                let square: f64 = c.normal().iter().map(|n| n * n).sum();
                let k = output as usize;
                x[k] - (sum - c.bound()).max(0.0) * c.normal()[k] / square
            }
            Law::Ellipse(c) => {
                let asked = [input(0), input(1)];
                let [a, b] = c.half_axes();
                let point = |t: f64| {
                    let (u, v) = (a * t.cos(), b * t.sin());
                    let (s, k) = c.tilt().sin_cos();
                    [c.centre()[0] + k * u - s * v, c.centre()[1] + s * u + k * v]
                };
                let (s, k) = c.tilt().sin_cos();
                let off = [0, 1].map(|i: usize| asked[i] - c.centre()[i]);
                let own = [k * off[0] + s * off[1], k * off[1] - s * off[0]];
                if (own[0] / a).hypot(own[1] / b) <= 1.0 {
                    return asked[output as usize];
                }
                let far = |t: f64| (point(t)[0] - asked[0]).hypot(point(t)[1] - asked[1]);
                // The nearest of many points, and between its neighbours where the line to it is
                // perpendicular to the ellipse.
                let step = TAU / 5000.0;
                let all = (0..5000).map(|i| step * f64::from(i));
                let near = all.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap();
                let slope = |t: f64| {
                    let (u, v) = (-a * t.sin(), b * t.cos());
                    let [x, y] = [0, 1].map(|i: usize| point(t)[i] - asked[i]);
                    x * (k * u - s * v) + y * (s * u + k * v)
                };
                let (mut low, mut high) = (near - step, near + step);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if slope(middle) < 0.0 { low = middle } else { high = middle }
                }
                let best = 0.5 * (low + high);
                point(best)[output as usize]
            }
            Law::RelativePosition(c) => {
                (self.relative(component) * c.point).dot(c.along[output as usize])
            }
            Law::Angles(c) => {
                let q: [f64; 4] = self.numbers(component.inputs[0]).try_into().unwrap();
                let mut turned = Quat::from(q).normalized().to_mat3();
                if let Some(at) = c.mirrored {
                    turned = at.frame(Affine::from_rotation(turned)).linear;
                }
                match c.names {
                    AngleNames::Euler(order) => order.from_mat3(turned)[output as usize],
                    AngleNames::SwingTwist(k) => {
                        // The swing turns the axis along the shortest arc.
                        let axis = Vec3::UNITS[k];
                        let to = turned * axis;
                        let about = axis.cross(to);
                        let angle = about.norm().atan2(axis.dot(to));
                        let swing = about * (angle / about.norm().max(1e-300));
                        let left = Quat::exp(swing).to_mat3().transpose() * turned;
                        let beside = Vec3::UNITS[(k + 1) % 3];
                        let moved = left * beside;
                        let twist = axis.dot(beside.cross(moved)).atan2(beside.dot(moved));
                        let swing = swing.to_array();
                        [twist, swing[(k + 1) % 3], swing[(k + 2) % 3]][output as usize]
                    }
                }
            }
            other => panic!("{} is no scalar", other.kind().name),
        }
    }

    /// The two rotations of a contact, found by scanning.
    fn contact(&self, component: &Component, law: &Gliding) -> Affine {
        let segment_at = |port| component.segments_at(port).next().expect("a segment");
        let segment = self.model.segment(segment_at("segment"));
        let parent = self.segment(segment.parent.expect("below its surface"));
        let before = component.at("before").first();
        let before = before.map_or(Affine::IDENTITY, |&source| self.transform(source));
        let surface = self.segment(segment_at("surface")) * law.ellipsoid_in_surface();
        // What is above the surface may stretch it; what lies between is rigid.
        let back = surface.linear.inverse();
        let back = Affine::new(back, -(back * surface.translation));
        let pose = back * parent * segment.joint_in_parent * before;
        let drivers: Vec<f64> = component.at("drivers").iter().map(|&d| self.scalar(d)).collect();
        // Points and axis are in the segment's frame; the rotations are in its joint frame.
        let joint = segment.joint_in_segment.rigid_inverse();
        let [first, second] = self.blended(law.pairs(), &drivers).map(|point| joint * point);
        let axis = joint.linear * law.axis();
        let theta = scan::turn(pose, law.radii(), axis, first);
        let about_axis = Quat::from_axis_angle(axis, theta.angle).to_mat3();
        let turned = pose * Affine::from_rotation(about_axis);
        let psi = scan::turn(turned, law.radii(), first.normalized(), second);
        if theta.doubtful || psi.doubtful {
            self.doubtful.set(true);
        }
        let about_first = Quat::from_axis_angle(first.normalized(), psi.angle).to_mat3();
        Affine::from_rotation(about_axis * about_first)
    }

    /// Pairs weighted by the inverse squares of their distances.
    fn blended(&self, pairs: &[ContactPair], drivers: &[f64]) -> [Vec3; 2] {
        let smooth = |k: usize, x: f64| {
            let places = pairs.iter().map(|pair| pair.at[k]);
            let (low, high) =
                places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let share = if high > low { ((x - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
            share * share * (3.0 - 2.0 * share)
        };
        let driver = |k: usize| smooth(k, drivers.get(k).copied().unwrap_or(0.0));
        let far = |pair: &ContactPair| {
            let off = [0, 1].map(|k: usize| driver(k) - smooth(k, pair.at[k]));
            off[0] * off[0] + off[1] * off[1]
        };
        if let Some(hit) = pairs.iter().find(|pair| far(pair) == 0.0) {
            return [hit.first, hit.second];
        }
        let sum: f64 = pairs.iter().map(|pair| 1.0 / far(pair)).sum();
        let blend = |pick: fn(&ContactPair) -> Vec3| {
            pairs.iter().fold(Vec3::ZERO, |v, pair| v + pick(pair) * (1.0 / far(pair) / sum))
        };
        [blend(|pair| pair.first), blend(|pair| pair.second)]
    }

    fn transform(&self, source: Signal) -> Affine {
        let Signal::Output(id, _) = source else { panic!("a coordinate is no transform") };
        let component = &self.model.components()[id.index()];
        let input = |k: usize| self.scalar(component.inputs[k]);
        match &component.law {
            Law::Rotate(c) => {
                let angle = input(0);
                Affine::from_rotation(Quat::from_axis_angle(c.axis, angle).to_mat3())
            }
            Law::Translate(c) => Affine::from_translation(c.axis * input(0)),
            Law::Pivot(c) => match c.centre() {
                // Interval by interval, the one that holds 0 first.
                Centre::Intervals(list) => {
                    let angle = input(0);
                    let mut motion = Affine::IDENTITY;
                    let (mut from, mut begin) = (0, f64::NEG_INFINITY);
                    let mut pieces = vec![];
                    while from < list.len() {
                        let last = from + 1 == list.len();
                        let end = if last { f64::INFINITY } else { list[from].0 };
                        let (lo, hi) = (begin.max(angle.min(0.0)), end.min(angle.max(0.0)));
                        if hi > lo {
                            pieces.push((hi - lo, list[from].1));
                        }
                        begin = end;
                        from += 1;
                    }
                    if angle < 0.0 {
                        pieces.reverse();
                    }
                    for (amount, centre) in pieces {
                        let turn = Quat::from_axis_angle(c.axis(), amount * angle.signum());
                        motion = Affine::from_translation(centre)
                            * Affine::from_rotation(turn.to_mat3())
                            * Affine::from_translation(-centre)
                            * motion;
                    }
                    motion
                }
                Centre::Path(_) => c.transform(&[input(0)]),
            },
            Law::Ball(_) => {
                let q: [f64; 4] = self.numbers(component.inputs[0]).try_into().unwrap();
                Affine::from_rotation(Quat::from(q).normalized().to_mat3())
            }
            Law::Place(c) => c.child_in_parent,
            Law::Product(_) => {
                component.inputs.iter().fold(Affine::IDENTITY, |t, &f| t * self.transform(f))
            }
            Law::Compensate(c) => {
                // Up from the parent to the topmost named ancestor, both paths side by side.
                let mut chain = vec![];
                let moved = component.segments_at("segment").next().expect("a segment");
                let ancestors: Vec<SegmentId> = component.segments_at("ancestors").collect();
                let mut here = self.model.segment(moved).parent;
                while let Some(id) = here {
                    chain.push(id);
                    here = self.model.segment(id).parent;
                }
                let Some(top) = chain.iter().rposition(|id| ancestors.contains(id)) else {
                    return Affine::IDENTITY;
                };
                let (mut is, mut should) = (Mat3::IDENTITY, Mat3::IDENTITY);
                for id in chain[..=top].iter().rev() {
                    let s = self.model.segment(*id);
                    let motion = s.motion.map_or(Mat3::IDENTITY, |m| self.transform(m).linear);
                    let left = if ancestors.contains(id) {
                        let turn = Quat::from_mat3(motion).log() * (1.0 - c.weight);
                        Quat::exp(turn).to_mat3()
                    } else {
                        motion
                    };
                    let back = s.joint_in_segment.linear.transpose();
                    is = is * s.joint_in_parent.linear * motion * back;
                    should = should * s.joint_in_parent.linear * left * back;
                }
                let joint = self.model.segment(moved).joint_in_parent.linear;
                Affine::from_rotation(joint.transpose() * is.transpose() * should * joint)
            }
            Law::Ellipsoid(c) => {
                let [a, b, g] = [0, 1, 2].map(input);
                let r = Mat3::rotation_x(a) * Mat3::rotation_y(b) * Mat3::rotation_z(g);
                let n = r * Vec3::Z;
                let [rx, ry, rz] = c.radii.to_array();
                let place = Vec3::new(rx * n.x, ry * n.y, rz * n.z);
                Affine::new(
                    r,
                    match c.axis {
                        SurfaceAxis::OpenSim => place,
                        // Where the normal of x²/a² + … is n: x = a²·n/√(a²n² + …).
                        SurfaceAxis::Normal => {
                            let size =
                                (rx * rx * n.x * n.x + ry * ry * n.y * n.y + rz * rz * n.z * n.z)
                                    .sqrt();
                            Vec3::new(rx * rx * n.x, ry * ry * n.y, rz * rz * n.z) * (1.0 / size)
                        }
                    },
                )
            }
            Law::Scale(c) => {
                // As the source has it for a principal axis, in a frame turned so that it is one.
                let s = input(0).max(1e-6);
                let (axis, diagonal) = match c.along {
                    Along::Everywhere => (Vec3::X, [s, s, s]),
                    Along::Axis(axis) => (axis, [s, 1.0, 1.0]),
                    Along::Volume(axis) => (axis, [s, s.powf(-0.5), s.powf(-0.5)]),
                };
                let beside = axis.cross(Vec3::new(0.2, 0.5, -0.9)).normalized();
                let turn = Mat3::from_columns(axis, beside, axis.cross(beside));
                let stretch = Mat3::from_columns(
                    Vec3::X * diagonal[0],
                    Vec3::Y * diagonal[1],
                    Vec3::Z * diagonal[2],
                );
                Affine::new(turn * stretch * turn.transpose(), Vec3::ZERO)
            }
            Law::Shear(c) => {
                let slide = |unit: Vec3| unit + c.along * (input(0) * c.across.dot(unit));
                let [x, y, z] = Vec3::UNITS.map(slide);
                Affine::new(Mat3::from_columns(x, y, z), Vec3::ZERO)
            }
            Law::Curve(c) => {
                let u = input(0);
                let along = |order: usize| {
                    Vec3::from([0, 1, 2].map(|k: usize| c.path[k].derivatives(u)[order]))
                };
                let Some(heading) = c.heading else { return Affine::from_translation(along(0)) };
                // Carry forward onto the tangent, then turn about it until up is as near as it gets.
                let (forward, tangent) = (heading.forward.normalized(), along(1).normalized());
                let about = forward.cross(tangent);
                let angle = about.norm().atan2(forward.dot(tangent));
                let some = if about.norm() > 1e-9 { about.normalized() } else { Vec3::Y };
                let swing = Quat::from_axis_angle(some, angle).to_mat3();
                let flat = |v: Vec3| (v - tangent * v.dot(tangent)).normalized();
                let own = (heading.up - forward * heading.up.dot(forward)).normalized();
                let (is, should) = (flat(swing * own), flat(heading.up));
                let roll = tangent.dot(is.cross(should)).atan2(is.dot(should));
                let roll = Quat::from_axis_angle(tangent, roll).to_mat3();
                Affine::new(roll * swing, along(0))
            }
            Law::Custom(c) => {
                // The formula of the law, written out.
                let [angle, wave] = [0, 1].map(input);
                let lift = c.parameters["lift"][0] * (1.0 - angle.cos());
                let turn = Quat::from_axis_angle(Vec3::Z, angle).to_mat3();
                let wide = Mat3::from_columns(Vec3::X * (1.0 + 0.2 * wave.sin()), Vec3::Y, Vec3::Z);
                Affine::new(turn * wide, Vec3::Y * lift)
            }
            Law::Contact(c) => self.contact(component, &c.law),
            Law::ConstantCurvature(c) => c.transform(&[0, 1, 2].map(input)),
            other => panic!("{} is no transform", other.kind().name),
        }
    }

    pub(crate) fn segment(&self, id: SegmentId) -> Affine {
        let segment = self.model.segment(id);
        let parent = segment.parent.map_or(Affine::IDENTITY, |p| self.segment(p));
        let motion = segment.motion.map_or(Affine::IDENTITY, |m| self.transform(m));
        parent * segment.joint_in_parent * motion * segment.joint_in_segment.rigid_inverse()
    }
}
