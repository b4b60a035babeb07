//! From a checked model to its program.

use super::derivative_plan::{DerivativePlan, plan};
use super::instruction::{
    AnyLaw, Code, CombineCall, Instruction, LawCall, NO_BASE, NO_BOUND, Step,
};
use super::program::Program;
use crate::component::{Compensate, Component, Depend, Source};
use crate::model::{ComponentId, CoordinateKind, Model, Node, SegmentId, dependency_order};
use condyle_math::function::FunctionOfSeveral;
use condyle_math::{Affine, Mat3, Vec3};

/// What stands for a source while a program is laid out.
#[derive(Clone, Copy, Debug)]
enum Scalar {
    Constant(f64),
    Register(u32),
}

struct Compiler<'m> {
    model: &'m Model,
    program: Program,
    /// What each coordinate's effective value is (its first register, for an orientation).
    coordinates: Vec<Scalar>,
    /// What each output of each scalar component is.
    outputs: Vec<Vec<Scalar>>,
    /// The register of each transform component that several things read.
    shared: Vec<Option<u32>>,
    /// For each compensation the path as it is and as it should be.
    compensations: Vec<Option<(u32, u32)>>,
    /// How many things read each transform component.
    readers: Vec<usize>,
    needed: Vec<bool>,
}

impl Program {
    /// Flattens a model. Models are checked when they are built, so this cannot fail.
    pub fn compile(model: &Model) -> Self {
        compile(model)
    }
}

/// Flattens a model.
fn compile(model: &Model) -> Program {
    // A built model has no circle; an empty order for a wrong one would only pose nothing.
    let order = dependency_order(model).unwrap_or_default();
    let components = model.components.len();
    let mut compiler = Compiler {
        model,
        program: Program {
            stored: model.stored_len(),
            segments: model.segments.len(),
            constants: vec![],
            limits: vec![],
            code: Code {
                scalars: model.stored_len(),
                transforms: model.segments.len(),
                instructions: vec![],
                steps: vec![],
                fixed: vec![],
                functions: vec![],
                combines: vec![],
                laws: vec![],
                rows: vec![],
            },
            plan: DerivativePlan::default(),
        },
        coordinates: model
            .coordinate_ids()
            .map(|id| Scalar::Register(model.stored_range(id).start as u32))
            .collect(),
        outputs: vec![vec![]; components],
        shared: vec![None; components],
        compensations: vec![None; components],
        readers: vec![0; components],
        needed: vec![false; components],
    };
    compiler.mark_needed(&order);
    compiler.limits();
    for node in order {
        compiler.node(node);
    }
    compiler.follower_rows();
    for segment in model.parents_first() {
        compiler.segment(segment);
    }
    let mut directions = vec![None; model.stored_len()];
    for id in model.coordinate_ids() {
        if model.coordinate(id).follows.is_none() {
            directions[model.stored_range(id).start] = Some(model.tangent_range(id).start as u32);
        }
    }
    compiler.program.plan = plan(&compiler.program.code, model.tangent_len(), &directions);
    compiler.program
}

impl Compiler<'_> {
    /// Finds what segments and coupled coordinates read, directly or not; the rest is dropped.
    fn mark_needed(&mut self, order: &[Node]) {
        let roots = self.model.segments.iter().filter_map(|s| s.motion);
        let roots = roots.chain(self.model.coordinates.iter().filter_map(|c| c.follows));
        for source in roots {
            if let Source::Output(id, _) = source {
                self.needed[id.index()] = true;
                self.readers[id.index()] += 1;
            }
        }
        for node in order.iter().rev() {
            let Node::Component(id) = *node else { continue };
            if !self.needed[id.index()] {
                continue;
            }
            for source in self.model.reads(id) {
                if let Source::Output(input, _) = source {
                    self.needed[input.index()] = true;
                    self.readers[input.index()] += 1;
                }
            }
        }
    }

    fn limits(&mut self) {
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            let (lower, upper) = coordinate.range.bounds();
            let bounded = lower > f64::NEG_INFINITY || upper < f64::INFINITY;
            if bounded
                && coordinate.follows.is_none()
                && coordinate.kind != CoordinateKind::Orientation
            {
                let register = self.model.stored_range(id).start as u32;
                self.program.limits.push((register, lower, upper));
            }
        }
    }

    fn scalar(&self, source: Source) -> Scalar {
        match source {
            Source::Coordinate(id) => self.coordinates[id.index()],
            Source::Output(id, output) => self.outputs[id.index()]
                .get(output as usize)
                .copied()
                .unwrap_or(Scalar::Constant(0.0)),
        }
    }

    /// A register that holds a source, made for a constant.
    fn register(&mut self, scalar: Scalar) -> u32 {
        match scalar {
            Scalar::Register(register) => register,
            Scalar::Constant(value) => {
                let register = self.new_scalar();
                self.program.constants.push((register, value));
                register
            }
        }
    }

    fn new_scalar(&mut self) -> u32 {
        self.program.code.scalars += 1;
        self.program.code.scalars as u32 - 1
    }

    fn node(&mut self, node: Node) {
        match node {
            Node::Coordinate(id) => {
                let Some(leader) = self.model.coordinate(id).follows else { return };
                // The effective value must stand in the coordinate's own register, for whoever
                // reads the pose.
                let own = self.model.stored_range(id).start as u32;
                match self.scalar(leader) {
                    Scalar::Constant(value) => {
                        self.program.constants.push((own, value));
                        self.coordinates[id.index()] = Scalar::Constant(value);
                    }
                    Scalar::Register(input) => {
                        let identity = condyle_math::function::Function::identity();
                        self.function(identity, input, own);
                    }
                }
            }
            Node::Component(id) if self.needed[id.index()] => self.component(id),
            Node::Component(_) => {}
        }
    }

    fn function(&mut self, function: condyle_math::function::Function, input: u32, output: u32) {
        self.program.code.functions.push(function);
        let function = self.program.code.functions.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Function { function, input, output });
    }

    fn component(&mut self, id: ComponentId) {
        match &self.model.components[id.index()].component {
            Component::Map(map) => {
                let input = self.scalar(map.input);
                for function in &map.functions {
                    let value = function.as_constant();
                    let result = match (input, value, function.as_linear()) {
                        (_, Some(value), _) => Scalar::Constant(value),
                        (Scalar::Constant(x), ..) => {
                            Scalar::Constant(function.value_and_slope(x).0)
                        }
                        (register, _, Some((1.0, 0.0))) => register,
                        (Scalar::Register(input), ..) => {
                            let output = self.new_scalar();
                            self.function(function.clone(), input, output);
                            Scalar::Register(output)
                        }
                    };
                    self.outputs[id.index()].push(result);
                }
            }
            Component::Combine(combine) => {
                let inputs: Vec<Scalar> = combine.inputs.iter().map(|&s| self.scalar(s)).collect();
                let result = self.combine(&combine.function, &inputs);
                self.outputs[id.index()].push(result);
            }
            Component::Depend(depend) => {
                let result = self.depend(depend);
                self.outputs[id.index()].push(result);
            }
            component => {
                if let Component::Compensate(compensate) = component {
                    self.compensations[id.index()] = Some(self.paths(compensate));
                }
                if self.readers[id.index()] > 1 {
                    let register = self.program.code.transforms as u32;
                    self.program.code.transforms += 1;
                    let mut steps = vec![];
                    self.append(id, &mut steps);
                    self.chain(NO_BASE, steps, register);
                    self.shared[id.index()] = Some(register);
                }
            }
        }
    }

    /// The rotations from the topmost compensated ancestor's parent to the segment's: as they are,
    /// and with what is compensated taken away.
    fn paths(&mut self, compensate: &Compensate) -> (u32, u32) {
        let path = self.model.compensated_path(compensate);
        let mut registers = [0; 2];
        for (register, take) in registers.iter_mut().zip([0.0, compensate.weight]) {
            let mut steps = vec![];
            for &id in &path {
                let segment = self.model.segment(id);
                self.fixed(Affine::from_rotation(segment.joint_in_parent.linear), &mut steps);
                if let Some(Source::Output(motion, _)) = segment.motion
                    && let Some(of) = self.shared[motion.index()]
                {
                    let named = compensate.ancestors.contains(&id);
                    let exponent = if named { 1.0 - take } else { 1.0 };
                    if exponent != 0.0 {
                        steps.push(Step::Power { of, exponent });
                    }
                }
                let back = segment.joint_in_segment.linear.transpose();
                self.fixed(Affine::from_rotation(back), &mut steps);
            }
            *register = self.program.code.transforms as u32;
            self.program.code.transforms += 1;
            self.chain(NO_BASE, steps, *register);
        }
        (registers[0], registers[1])
    }

    /// A passive scalar between bounds that a driver sets: the held value, and a row for each side.
    fn depend(&mut self, depend: &Depend) -> Scalar {
        let passive = self.scalar(depend.passive);
        let passive = self.register(passive);
        let driver = self.scalar(depend.driver);
        let driver = self.register(driver);
        let mut bounds = [NO_BOUND; 2];
        let sides = [(&depend.lower, 1.0), (&depend.upper, -1.0)];
        for (bound, (function, sign)) in bounds.iter_mut().zip(sides) {
            let Some(function) = function else { continue };
            *bound = self.new_scalar();
            self.function(function.clone(), driver, *bound);
            self.row(passive, *bound, sign);
        }
        let output = self.new_scalar();
        let [lower, upper] = bounds;
        self.program.code.instructions.push(Instruction::Hold { passive, lower, upper, output });
        Scalar::Register(output)
    }

    /// The row `sign · (value - bound) ≥ 0`.
    fn row(&mut self, value: u32, bound: u32, sign: f64) {
        let function = FunctionOfSeveral::Linear { slopes: vec![sign, -sign], intercept: 0.0 };
        let inputs = [value, bound].map(Scalar::Register);
        let row = self.combine(&function, &inputs);
        let row = self.register(row);
        self.program.code.rows.push(row);
    }

    /// Rows for the ranges of coordinates that follow others.
    fn follower_rows(&mut self) {
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            if coordinate.follows.is_none() {
                continue;
            }
            let (lower, upper) = coordinate.range.bounds();
            let value = self.model.stored_range(id).start as u32;
            for (bound, sign) in [(lower, 1.0), (upper, -1.0)] {
                if bound.is_finite() {
                    let bound = self.register(Scalar::Constant(bound));
                    self.row(value, bound, sign);
                }
            }
        }
    }

    fn combine(&mut self, function: &FunctionOfSeveral, inputs: &[Scalar]) -> Scalar {
        let constants: Vec<f64> = inputs
            .iter()
            .filter_map(|s| if let Scalar::Constant(v) = s { Some(*v) } else { None })
            .collect();
        if constants.len() == inputs.len() {
            return Scalar::Constant(function.apply(&constants));
        }
        let inputs: Vec<u32> = inputs.iter().map(|&s| self.register(s)).collect();
        let output = self.new_scalar();
        self.program.code.combines.push(CombineCall { function: function.clone(), inputs });
        let function = self.program.code.combines.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Combine { function, output });
        Scalar::Register(output)
    }

    /// Lays the steps of a transform component end to end; products are opened without recursion.
    fn append(&mut self, id: ComponentId, steps: &mut Vec<Step>) {
        let mut stack = vec![Source::Output(id, 0)];
        let mut at_root = true;
        while let Some(source) = stack.pop() {
            let Source::Output(id, _) = source else { continue };
            if let Some(register) = self.shared[id.index()]
                && !at_root
            {
                steps.push(Step::Transform(register));
                continue;
            }
            at_root = false;
            match &self.model.components[id.index()].component {
                Component::Product(product) => stack.extend(product.factors.iter().rev()),
                Component::Place(place) => self.fixed(place.child_in_parent, steps),
                Component::Rotate(rotate) => match self.scalar(rotate.angle) {
                    Scalar::Constant(angle) => {
                        let turn = Mat3::rotation_about(rotate.axis, angle.sin_cos());
                        self.fixed(Affine::from_rotation(turn), steps);
                    }
                    Scalar::Register(angle) => steps.push(turn(rotate.axis, angle)),
                },
                Component::Translate(translate) => match self.scalar(translate.distance) {
                    Scalar::Constant(distance) => {
                        self.fixed(Affine::from_translation(translate.axis * distance), steps);
                    }
                    Scalar::Register(distance) => {
                        steps.push(Step::Slide { axis: translate.axis, distance });
                    }
                },
                Component::Ball(ball) => {
                    let register = self.scalar(ball.orientation);
                    let register = self.register(register);
                    steps.push(Step::Ball(register));
                }
                Component::Pivot(law) => {
                    self.law(AnyLaw::Pivot(law.clone()), &[law.angle], steps);
                }
                Component::Ellipsoid(law) => {
                    self.law(AnyLaw::Ellipsoid(law.clone()), &law.angles, steps);
                }
                Component::ConstantCurvature(law) => {
                    self.law(AnyLaw::ConstantCurvature(law.clone()), &law.angles, steps);
                }
                Component::Compensate(compensate) => {
                    let Some((is, should)) = self.compensations[id.index()] else { continue };
                    let joint = self.model.segment(compensate.segment).joint_in_parent.linear;
                    self.fixed(Affine::from_rotation(joint.transpose()), steps);
                    steps.push(Step::Power { of: is, exponent: -1.0 });
                    steps.push(Step::Power { of: should, exponent: 1.0 });
                    self.fixed(Affine::from_rotation(joint), steps);
                }
                Component::Map(_) | Component::Combine(_) | Component::Depend(_) => {}
            }
        }
    }

    fn law(&mut self, law: AnyLaw, inputs: &[Source], steps: &mut Vec<Step>) {
        let inputs = inputs
            .iter()
            .map(|&source| {
                let scalar = self.scalar(source);
                self.register(scalar)
            })
            .collect();
        self.program.code.laws.push(LawCall { law, inputs });
        steps.push(Step::Law(self.program.code.laws.len() as u32 - 1));
    }

    /// Appends a fixed transform, merged with a fixed one before it and dropped if it is nothing.
    fn fixed(&mut self, transform: Affine, steps: &mut Vec<Step>) {
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

    fn segment(&mut self, id: SegmentId) {
        let segment = self.model.segment(id);
        let base = segment.parent.map_or(NO_BASE, |p| p.0);
        let mut steps = vec![];
        self.fixed(segment.joint_in_parent, &mut steps);
        if let Some(Source::Output(component, _)) = segment.motion {
            match self.shared[component.index()] {
                Some(register) => steps.push(Step::Transform(register)),
                None => self.append(component, &mut steps),
            }
        }
        self.fixed(segment.joint_in_segment.rigid_inverse(), &mut steps);
        self.chain(base, steps, id.0);
    }

    fn chain(&mut self, base: u32, steps: Vec<Step>, output: u32) {
        let instruction = match steps[..] {
            [Step::Ball(orientation)] if base != NO_BASE => {
                Instruction::BallAt { base, shift: Vec3::ZERO, orientation, output }
            }
            [Step::Shift(shift), Step::Ball(orientation)] if base != NO_BASE => {
                Instruction::BallAt { base, shift, orientation, output }
            }
            _ => {
                let first = self.program.code.steps.len() as u32;
                self.program.code.steps.extend(steps);
                let end = self.program.code.steps.len() as u32;
                Instruction::Chain { base, first, end, output }
            }
        };
        self.program.code.instructions.push(instruction);
    }
}

/// The step that turns about an axis of length 1.
fn turn(axis: Vec3, angle: u32) -> Step {
    if axis == Vec3::X {
        Step::TurnX(angle)
    } else if axis == Vec3::Y {
        Step::TurnY(angle)
    } else if axis == Vec3::Z {
        Step::TurnZ(angle)
    } else {
        Step::Turn { axis, angle }
    }
}
