//! The slow and obvious twin of a program: every value is computed afresh by walking the model.

use condyle_math::{Affine, Mat3, Quat, Vec3};
use condyle_model::component::{Centre, Component, Law};
use condyle_model::{CoordinateId, Mode, Model, SegmentId, Source};

pub(crate) struct Evaluator<'a> {
    model: &'a Model,
    stored: &'a [f64],
    mode: Mode,
}

impl<'a> Evaluator<'a> {
    pub(crate) fn new(model: &'a Model, stored: &'a [f64], mode: Mode) -> Self {
        Self { model, stored, mode }
    }

    pub(crate) fn coordinate(&self, id: CoordinateId) -> Vec<f64> {
        let coordinate = self.model.coordinate(id);
        if let Some(leader) = coordinate.follows {
            return vec![self.scalar(leader)];
        }
        let mut values = self.stored[self.model.stored_range(id)].to_vec();
        if self.mode == Mode::Posed && values.len() == 1 {
            values[0] = coordinate.range.nearest(values[0]);
        }
        values
    }

    fn scalar(&self, source: Source) -> f64 {
        match source {
            Source::Coordinate(id) => self.coordinate(id)[0],
            Source::Output(id, output) => match &self.model.components()[id.index()].component {
                Component::Map(map) => {
                    let x = self.scalar(map.input);
                    map.functions[output as usize].value_and_slope(x).0
                }
                Component::Depend(depend) => {
                    let (mut x, d) = (self.scalar(depend.passive), self.scalar(depend.driver));
                    let bound = |f: &condyle_math::function::Function| f.value_and_slope(d).0;
                    if self.mode == Mode::Posed {
                        x = depend.lower.as_ref().map_or(x, |f| x.max(bound(f)));
                        x = depend.upper.as_ref().map_or(x, |f| x.min(bound(f)));
                    }
                    x
                }
                Component::Combine(combine) => {
                    let x: Vec<f64> = combine.inputs.iter().map(|&s| self.scalar(s)).collect();
                    combine.function.apply(&x)
                }
                other => panic!("{} is no scalar", other.kind()),
            },
        }
    }

    fn transform(&self, source: Source) -> Affine {
        let Source::Output(id, _) = source else { panic!("a coordinate is no transform") };
        match &self.model.components()[id.index()].component {
            Component::Rotate(c) => {
                let angle = self.scalar(c.angle);
                Affine::from_rotation(Quat::from_axis_angle(c.axis, angle).to_mat3())
            }
            Component::Translate(c) => Affine::from_translation(c.axis * self.scalar(c.distance)),
            Component::Pivot(c) => match c.centre() {
                // Interval by interval, the one that holds 0 first.
                Centre::Intervals(list) => {
                    let angle = self.scalar(c.angle);
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
                Centre::Path(_) => c.transform(&[self.scalar(c.angle)]),
            },
            Component::Ball(c) => {
                let Source::Coordinate(id) = c.orientation else {
                    panic!("a ball takes a coordinate")
                };
                let q: [f64; 4] = self.coordinate(id).try_into().unwrap();
                Affine::from_rotation(Quat::from(q).normalized().to_mat3())
            }
            Component::Place(c) => c.child_in_parent,
            Component::Product(c) => {
                c.factors.iter().fold(Affine::IDENTITY, |t, &f| t * self.transform(f))
            }
            Component::Compensate(c) => {
                // Up from the parent to the topmost named ancestor, both paths side by side.
                let mut chain = vec![];
                let mut here = self.model.segment(c.segment).parent;
                while let Some(id) = here {
                    chain.push(id);
                    here = self.model.segment(id).parent;
                }
                let Some(top) = chain.iter().rposition(|id| c.ancestors.contains(id)) else {
                    return Affine::IDENTITY;
                };
                let (mut is, mut should) = (Mat3::IDENTITY, Mat3::IDENTITY);
                for id in chain[..=top].iter().rev() {
                    let s = self.model.segment(*id);
                    let motion = s.motion.map_or(Mat3::IDENTITY, |m| self.transform(m).linear);
                    let left = if c.ancestors.contains(id) {
                        let turn = Quat::from_mat3(motion).log() * (1.0 - c.weight);
                        Quat::exp(turn).to_mat3()
                    } else {
                        motion
                    };
                    let back = s.joint_in_segment.linear.transpose();
                    is = is * s.joint_in_parent.linear * motion * back;
                    should = should * s.joint_in_parent.linear * left * back;
                }
                let joint = self.model.segment(c.segment).joint_in_parent.linear;
                Affine::from_rotation(joint.transpose() * is.transpose() * should * joint)
            }
            Component::Ellipsoid(c) => {
                let [a, b, g] = c.angles.map(|s| self.scalar(s));
                let r = Mat3::rotation_x(a) * Mat3::rotation_y(b) * Mat3::rotation_z(g);
                let n = r * Vec3::Z;
                let [rx, ry, rz] = c.radii.to_array();
                Affine::new(r, Vec3::new(rx * n.x, ry * n.y, rz * n.z))
            }
            Component::ConstantCurvature(c) => c.transform(&c.angles.map(|s| self.scalar(s))),
            other => panic!("{} is no transform", other.kind()),
        }
    }

    pub(crate) fn segment(&self, id: SegmentId) -> Affine {
        let segment = self.model.segment(id);
        let parent = segment.parent.map_or(Affine::IDENTITY, |p| self.segment(p));
        let motion = segment.motion.map_or(Affine::IDENTITY, |m| self.transform(m));
        parent * segment.joint_in_parent * motion * segment.joint_in_segment.rigid_inverse()
    }
}
