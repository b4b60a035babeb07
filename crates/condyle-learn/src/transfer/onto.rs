//! The law in a model.
//!
//! The joint's rotation stays what it was and drives the law: a segment without a shape, named after the child with `_turn`, is turned as the
//! child is, but by A before and B after it, so that its orientation in the parent has the law's angles. The centre follows them, and the
//! child is put there. So it does not matter what the joint is made of: a hinge, three angles in any order, a quaternion.

use super::asked::{Standing, upright};
use super::{Driver, Transfer};
use crate::coupling::leader;
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::component::{AngleNames, Angles, Place, RelativeOrientation, Rotate};
use condyle_model::{CoordinateKind, JointSetId, Law, Model, ModelBuilder, Signal};

impl Transfer {
    /// The model in which a joint's centre travels by the law.
    ///
    /// # Errors
    /// `transfer/joint` where the joint does not move; names of drivers that the model does not have; what is wrong with the model
    /// that results.
    pub fn onto(&self, model: &Model, at: &Standing) -> Result<Model, Error> {
        let segment = model.segment(at.segment);
        let (Some(motion), Some(set)) = (segment.motion, segment.joint_set) else {
            let message = format!("`{}` does not move in its parent", segment.name);
            return Err(Error::new("transfer/joint", message)
                .with_help("name a segment that a joint turns"));
        };
        let mut new = Naming { builder: ModelBuilder::from(model.clone()), model, set };
        let [a, b] = self.to_law;
        let (before, after) =
            (upright(segment.joint_in_parent.linear), upright(segment.joint_in_segment.linear));
        let helper = new.segment(&format!("{}_turn", segment.name), segment.parent);
        new.builder.place_joint_frames(
            helper,
            Affine::from_rotation(a * before),
            Affine::from_rotation(b.transpose() * after),
        );
        new.builder.output(set, helper, motion);
        let stem = format!("{}_law", segment.name);
        let reference = segment.parent.is_some();
        let seen: Vec<Signal> =
            std::iter::once(helper).chain(segment.parent).map(Signal::from).collect();
        let relative = Law::RelativeOrientation(RelativeOrientation { reference });
        let turned = new.add(&format!("{stem}_turn"), relative, seen);
        let angles = Angles { names: AngleNames::Euler(self.order), mirrored: None };
        let angles = new.add(&format!("{stem}_angles"), Law::Angles(angles), vec![turned]);
        let Signal::Output(angles, _) = angles else {
            return Err(Error::new("transfer/joint", "the angles are no component"));
        };
        let mut inputs = vec![];
        for driver in &self.drivers {
            inputs.push(match driver {
                Driver::Angle(k) => Signal::Output(angles, *k as u32),
                Driver::Coordinate(name) => model.find_coordinate(name)?.into(),
            });
        }
        let back = segment.joint_in_parent.linear.inverse();
        let frame = Affine::new(self.frame.linear, self.frame * self.fixed);
        let start = Affine::new(
            back * frame.linear,
            back * (frame.translation - segment.joint_in_parent.translation),
        );
        let mut parts = vec![new.place(&format!("{stem}_landmarks"), start)];
        for slide in &self.slides {
            let name = new.free(&format!("{stem}_{}", slide.name.replace(['/', ' '], "_")));
            let region = self.region.as_ref();
            let law = leader(&mut new.builder, set, &name, &inputs, &slide.law, region);
            let along = new.free(&format!("{name}_along"));
            parts.push(new.builder.translate(set, &along, law, slide.along));
        }
        let turn = self.frame.linear.transpose() * segment.joint_in_parent.linear;
        let chain = rotations(model, motion).filter(|_| self.turned.iter().all(Option::is_none));
        match chain {
            Some(chain) => {
                parts.push(new.place(&format!("{stem}_axes"), Affine::from_rotation(turn)));
                for (number, part) in chain.into_iter().enumerate() {
                    let name = format!("{stem}_part_{}", number + 1);
                    match part {
                        Part::Same(signal) => parts.push(signal),
                        Part::Turn(angle, axis) => {
                            let law = Law::Rotate(Rotate { axis });
                            parts.push(new.add(&name, law, vec![angle]));
                        }
                        Part::Fixed(place) => parts.push(new.place(&name, place)),
                    }
                }
            }
            // From the law's angles: T = Aᵀ·R(α)·Bᵀ.
            None => {
                let to_law = self.frame.linear.transpose() * a.transpose();
                parts.push(new.place(&format!("{stem}_axes"), Affine::from_rotation(to_law)));
                for k in 0..3 {
                    let name = new.free(&format!("{stem}_{}", self.angles[k]));
                    let own = Signal::Output(angles, k as u32);
                    let angle = match &self.turned[k] {
                        None => own,
                        Some(law) => {
                            let region = self.region.as_ref();
                            leader(&mut new.builder, set, &name, &inputs, law, region)
                        }
                    };
                    let about = format!("{name}_about");
                    let axis = axis_of(self.order, k);
                    parts.push(new.add(&about, Law::Rotate(Rotate { axis }), vec![angle]));
                }
                let end = b.transpose() * after;
                parts.push(new.place(&format!("{stem}_back"), Affine::from_rotation(end)));
            }
        }
        let name = new.free(&format!("{stem}_motion"));
        let whole = new.builder.product(set, &name, parts);
        new.builder.output(set, at.segment, whole);
        // Distances that moved the child before move nothing now.
        let slides = model.coordinates_of(set).filter(|id| {
            let coordinate = model.coordinate(*id);
            let drives = inputs.contains(&Signal::Coordinate(*id));
            coordinate.kind == CoordinateKind::Translation
                && coordinate.follows.is_none()
                && !drives
        });
        if model.outputs_of(set).count() == 1 {
            for id in slides {
                new.builder.coordinate_mut(id).locked = true;
            }
        }
        new.builder.build()
    }
}

fn axis_of(order: EulerOrder, k: usize) -> Vec3 {
    Vec3::UNITS[order.axes()[k]]
}

/// Adds parts under names that are free.
struct Naming<'m> {
    builder: ModelBuilder,
    model: &'m Model,
    set: JointSetId,
}

impl Naming<'_> {
    fn free(&self, name: &str) -> String {
        let own = |c: JointSetId| c == self.set;
        let taken = |name: &str| {
            self.model.components().iter().any(|c| own(c.joint_set) && c.name == name)
                || self.model.coordinates().iter().any(|c| own(c.joint_set) && c.name == name)
        };
        let mut free = name.to_owned();
        while taken(&free) {
            free.push('_');
        }
        free
    }

    fn segment(
        &mut self,
        name: &str,
        parent: Option<condyle_model::SegmentId>,
    ) -> condyle_model::SegmentId {
        let mut free = name.to_owned();
        while self.model.segments().iter().any(|segment| segment.name == free) {
            free.push('_');
        }
        self.builder.segment(&free, parent)
    }

    fn add(&mut self, name: &str, law: Law, inputs: Vec<Signal>) -> Signal {
        let name = self.free(name);
        self.builder.component(self.set, &name, law, inputs)
    }

    fn place(&mut self, name: &str, child_in_parent: Affine) -> Signal {
        self.add(name, Law::Place(Place { child_in_parent }), vec![])
    }
}

/// A factor of a rotation.
enum Part {
    Same(Signal),
    Turn(Signal, Vec3),
    Fixed(Affine),
}

/// The rotations of a motion without what it shifts; `None` where a component does both in a way that is not told apart.
fn rotations(model: &Model, motion: Signal) -> Option<Vec<Part>> {
    let mut open = vec![motion];
    let mut parts = vec![];
    while let Some(signal) = open.pop() {
        let Signal::Output(id, _) = signal else { return None };
        let component = model.components().get(id.index())?;
        match &component.law {
            Law::Product(_) => open.extend(component.inputs.iter().rev()),
            Law::Rotate(_) | Law::Ball(_) => parts.push(Part::Same(signal)),
            Law::Translate(_) => {}
            Law::Pivot(pivot) => parts.push(Part::Turn(*component.inputs.first()?, pivot.axis())),
            Law::Place(place) => {
                parts.push(Part::Fixed(Affine::from_rotation(place.child_in_parent.linear)));
            }
            _ => return None,
        }
    }
    Some(parts)
}
