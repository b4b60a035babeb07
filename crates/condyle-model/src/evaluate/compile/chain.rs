//! Compilation of chains: the steps of the motions of segments, concatenated.

use super::super::instruction::{
    AnyLaw, ContactCall, Frame, Instruction, LawCall, Number, Step, Turn,
};
use super::{Compiler, Operand};
use crate::component::{Component, Contact, Family, Motion, Signal, shear};
use crate::model::{ComponentId, SegmentId};
use condyle_math::{Affine, Mat3, Vec3};

/// Merges three translations along x, y and z at the end of a list into one step.
fn merge_slides(steps: &mut Vec<Step>) {
    let Some(last) = steps.last_chunk::<3>() else { return };
    let slide = |step: Step, along: Vec3| match step {
        Step::Slide { axis, distance } if axis == along => Some(distance),
        _ => None,
    };
    let [x, y, z] = *last;
    if let (Some(x), Some(y), Some(z)) = (slide(x, Vec3::X), slide(y, Vec3::Y), slide(z, Vec3::Z)) {
        steps.truncate(steps.len() - 3);
        steps.push(Step::Move([x, y, z]));
    }
}

impl Compiler<'_> {
    /// The registers of the rotations A and A′ of a [`Compensate`](crate::component::Compensate): of the path from the parent of
    /// the topmost named ancestor to the parent of the segment, without and with compensation.
    pub(super) fn paths(&mut self, component: &Component, weight: f64) -> (Frame, Frame) {
        let path = self.model.between(component);
        let ancestors: Vec<SegmentId> = component.segments_at("ancestors").collect();
        let mut registers = [self.program.code.identity; 2];
        for (register, take) in registers.iter_mut().zip([0.0, weight]) {
            let mut steps = vec![];
            for &id in &path {
                let segment = self.model.segment(id);
                self.fixed(Affine::from_rotation(segment.joint_in_parent.linear), &mut steps);
                if let Some(Signal::Output(motion, _)) = segment.motion
                    && let Some(of) = self.shared[motion.index()]
                {
                    // The first path has exponent 1 everywhere, the second 1 - w for named
                    // ancestors.
                    let named = ancestors.contains(&id);
                    let exponent = if named { 1.0 - take } else { 1.0 };
                    if exponent != 0.0 {
                        steps.push(Step::Power { of, exponent });
                    }
                }
                let back = segment.joint_in_segment.linear.transpose();
                self.fixed(Affine::from_rotation(back), &mut steps);
            }
            *register = self.new_transform();
            self.chain(self.program.code.identity, steps, *register);
        }
        (registers[0], registers[1])
    }

    /// Compiles a contact: the chain from the ellipsoid to the joint frame of the segment, and the
    /// instruction that computes the rotations from it. Returns the register of the rotations.
    pub(super) fn contact(
        &mut self,
        id: ComponentId,
        component: &Component,
        contact: &Contact,
    ) -> Frame {
        let mut steps = vec![];
        self.fixed(contact.law.ellipsoid_in_surface().rigid_inverse(), &mut steps);
        for id in self.model.between(component) {
            self.joint(id, &mut steps);
        }
        // The own motion of the gliding segment is the contact; before it comes `before`, if any.
        let gliding = component.segments_at("segment").next().map(|id| self.model.segment(id));
        let joint = gliding.map_or(Affine::IDENTITY, |segment| segment.joint_in_segment);
        self.fixed(gliding.map_or(Affine::IDENTITY, |s| s.joint_in_parent), &mut steps);
        self.motion(component.at("before").first().copied(), &mut steps);
        let frame = self.new_transform();
        self.chain(self.program.code.identity, steps, frame);
        let drivers = self.registers(component.at("drivers"));
        let output = self.new_transform();
        // Two angles and two gaps.
        let report = Number::new(self.program.code.scalars);
        self.program.code.scalars += 4;
        let law = contact.law.seen_from(joint);
        let bounded = contact.most_gap.is_some();
        let call = ContactCall { component: id, law, frame, drivers, output, report, bounded };
        self.program.code.contacts.push(call);
        let number = self.program.code.contacts.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Contact { contact: number });
        for gap in [2, 3].map(|k| Number(report.0 + k)) {
            for (most, sign) in contact.most_gap.into_iter().flat_map(|m| [(m, -1.0), (-m, 1.0)]) {
                let bound = self.register(Operand::Constant(most));
                self.row(gap, bound, sign);
            }
        }
        output
    }

    /// The transform of the segment at the port `segment` in the one at `reference`, or in the world,
    /// through all joints between them.
    pub(super) fn relative(&mut self, component: &Component) -> Frame {
        let end = |port: &str| self.model.path_to(component.segments_at(port).next());
        let (to, from) = (end("segment"), end("reference"));
        let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
        let mut steps = vec![];
        if from.len() > common {
            let mut up = vec![];
            from[common..].iter().for_each(|&id| self.joint(id, &mut up));
            let reference = self.new_transform();
            self.chain(self.program.code.identity, up, reference);
            steps.push(Step::Inverse(reference));
        }
        to[common..].iter().for_each(|&id| self.joint(id, &mut steps));
        let frame = self.new_transform();
        self.chain(self.program.code.identity, steps, frame);
        frame
    }

    /// Appends the transform of a segment in its parent.
    fn joint(&mut self, id: SegmentId, steps: &mut Vec<Step>) {
        let segment = self.model.segment(id);
        self.fixed(segment.joint_in_parent, steps);
        self.motion(segment.motion, steps);
        self.fixed(segment.joint_in_segment.rigid_inverse(), steps);
    }

    /// Appends a transform: by its register where it has one, else its own steps.
    fn motion(&mut self, motion: Option<Signal>, steps: &mut Vec<Step>) {
        if let Some(Signal::Output(motion, _)) = motion {
            match self.shared[motion.index()] {
                Some(register) => steps.push(Step::Transform(register)),
                None => self.append(motion, steps),
            }
        }
    }

    fn registers(&mut self, sources: &[Signal]) -> Vec<Number> {
        let each = sources.iter().map(|&source| {
            let scalar = self.scalar(source);
            self.register(scalar)
        });
        each.collect()
    }

    pub(super) fn new_transform(&mut self) -> Frame {
        self.program.code.transforms += 1;
        Frame::new(self.program.code.transforms - 1)
    }

    /// Appends the steps of a transform component. Products are expanded with an explicit stack, so
    /// the depth of nesting does not matter.
    pub(super) fn append(&mut self, id: ComponentId, steps: &mut Vec<Step>) {
        let mut stack = vec![Signal::Output(id, 0)];
        let mut at_root = true;
        while let Some(source) = stack.pop() {
            let Signal::Output(id, _) = source else { continue };
            // The root itself may be the shared component that is being compiled.
            if let Some(register) = self.shared[id.index()]
                && !at_root
            {
                steps.push(Step::Transform(register));
                continue;
            }
            at_root = false;
            let component = &self.model.components[id.index()];
            let inputs = &component.inputs[..];
            let Family::Motion(law) = component.law.family() else { continue };
            match law {
                Motion::Product(_) => stack.extend(inputs.iter().rev()),
                Motion::Place(place) => self.fixed(place.child_in_parent, steps),
                Motion::Rotate(rotate) => match self.scalar(inputs[0]) {
                    Operand::Constant(angle) => {
                        let turn = Mat3::rotation_about(rotate.axis, angle.sin_cos());
                        self.fixed(Affine::from_rotation(turn), steps);
                    }
                    Operand::Register(angle) => {
                        let turn = self.turn(rotate.axis, angle);
                        steps.push(turn);
                    }
                },
                Motion::Translate(translate) => match self.scalar(inputs[0]) {
                    Operand::Constant(distance) => {
                        self.fixed(Affine::from_translation(translate.axis * distance), steps);
                    }
                    Operand::Register(distance) => {
                        steps.push(Step::Slide { axis: translate.axis, distance });
                        merge_slides(steps);
                    }
                },
                Motion::Ball(_) => {
                    let register = self.scalar(inputs[0]);
                    let register = self.register(register);
                    steps.push(Step::Ball(register));
                }
                Motion::Pivot(law) => {
                    let angle = self.scalar(inputs[0]);
                    if let (Some(centre), Operand::Register(angle)) = (law.fixed_centre(), angle) {
                        // One centre: a rotation between two shifts, cheaper than the law.
                        self.fixed(Affine::from_translation(centre), steps);
                        let turn = self.turn(law.axis(), angle);
                        steps.push(turn);
                        self.fixed(Affine::from_translation(-centre), steps);
                        continue;
                    }
                    self.law(AnyLaw::Pivot(law.clone()), inputs, steps);
                }
                Motion::Ellipsoid(law) => self.law(AnyLaw::Ellipsoid(law.clone()), inputs, steps),
                Motion::ConstantCurvature(law) => {
                    self.law(AnyLaw::ConstantCurvature(law.clone()), inputs, steps);
                }
                Motion::Scale(scale) => match self.scalar(inputs[0]) {
                    Operand::Constant(factor) => {
                        let linear = scale.along.matrix(factor);
                        self.fixed(Affine::new(linear, Vec3::ZERO), steps);
                    }
                    Operand::Register(factor) => {
                        self.program.code.scales.push(scale.along);
                        let along = self.program.code.scales.len() as u32 - 1;
                        steps.push(Step::Stretch { along, factor });
                    }
                },
                Motion::Shear(shear) => match self.scalar(inputs[0]) {
                    Operand::Constant(amount) => {
                        let linear = shear::matrix(shear.along, shear.across, amount);
                        self.fixed(Affine::new(linear, Vec3::ZERO), steps);
                    }
                    Operand::Register(amount) => {
                        self.program.code.shears.push([shear.along, shear.across]);
                        let directions = self.program.code.shears.len() as u32 - 1;
                        steps.push(Step::Shear { directions, amount });
                    }
                },
                Motion::Curve(law) => self.law(AnyLaw::Curve(law.clone()), inputs, steps),
                Motion::Custom(law) => self.law(AnyLaw::Custom(law.clone()), inputs, steps),
                Motion::Compensate(_) => {
                    // F⁻¹·A⁻¹·A′·F, with F the joint frame in the parent.
                    let Some((is, should)) = self.compensations[id.index()] else { continue };
                    let Some(moved) = component.segments_at("segment").next() else { continue };
                    let joint = self.model.segment(moved).joint_in_parent.linear;
                    self.fixed(Affine::from_rotation(joint.transpose()), steps);
                    steps.push(Step::Power { of: is, exponent: -1.0 });
                    steps.push(Step::Power { of: should, exponent: 1.0 });
                    self.fixed(Affine::from_rotation(joint), steps);
                }
                Motion::Contact(_) => {
                    let turns = self.contacts[id.index()].map(Step::Transform);
                    steps.extend(turns);
                }
            }
        }
    }

    fn law(&mut self, law: AnyLaw, inputs: &[Signal], steps: &mut Vec<Step>) {
        let inputs = self.registers(inputs);
        self.program.code.laws.push(LawCall { law, inputs });
        steps.push(Step::Law(self.program.code.laws.len() as u32 - 1));
    }

    /// Appends a fixed transform, merged with a preceding fixed one; the identity is dropped.
    pub(super) fn fixed(&mut self, transform: Affine, steps: &mut Vec<Step>) {
        let before = match steps.last() {
            Some(Step::Fixed(index)) => Some(self.program.code.fixed[*index as usize]),
            Some(Step::Shift(offset)) => Some(Affine::from_translation(*offset)),
            _ => None,
        };
        if before.is_some() {
            steps.pop();
        }
        let whole = before.map_or(transform, |b| b * transform);
        if whole == Affine::IDENTITY {
        } else if whole.linear == Mat3::IDENTITY {
            steps.push(Step::Shift(whole.translation));
        } else {
            self.program.code.fixed.push(whole);
            steps.push(Step::Fixed(self.program.code.fixed.len() as u32 - 1));
        }
    }

    pub(super) fn segment(&mut self, id: SegmentId) {
        let segment = self.model.segment(id);
        let base = segment.parent.map_or(self.program.code.base, |p| Frame(p.0));
        let mut steps = vec![];
        self.joint(id, &mut steps);
        self.chain(base, steps, Frame(id.0));
    }

    pub(super) fn chain(&mut self, base: Frame, steps: Vec<Step>, output: Frame) {
        let identity = self.program.code.identity;
        // A leading shift becomes part of the instruction.
        let instruction = match steps[..] {
            [Step::Ball(orientation)] if base != identity => {
                Instruction::BallAt { base, shift: Vec3::ZERO, orientation, output }
            }
            [Step::Shift(shift), Step::Ball(orientation)] if base != identity => {
                Instruction::BallAt { base, shift, orientation, output }
            }
            _ => {
                let (shift, steps) = match steps[..] {
                    [Step::Shift(shift), ref rest @ ..] => (shift, rest),
                    ref all => (Vec3::ZERO, all),
                };
                let first = self.program.code.steps.len() as u32;
                self.program.code.steps.extend(steps);
                let end = self.program.code.steps.len() as u32;
                Instruction::Chain { base, shift, first, end, output }
            }
        };
        self.program.code.instructions.push(instruction);
    }

    /// The step that rotates about an axis of length 1; rotations by the same angle share its sine
    /// and cosine.
    fn turn(&mut self, axis: Vec3, angle: Number) -> Step {
        let turns = &mut self.program.code.turns;
        let turn = turns.iter().position(|&known| known == angle).unwrap_or_else(|| {
            turns.push(angle);
            turns.len() - 1
        });
        let turn = Turn(turn as u32);
        if axis == Vec3::X {
            Step::TurnX(turn)
        } else if axis == Vec3::Y {
            Step::TurnY(turn)
        } else if axis == Vec3::Z {
            Step::TurnZ(turn)
        } else {
            Step::TurnAbout { axis, turn }
        }
    }
}
