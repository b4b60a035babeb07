//! Compilation of scalar components to scalar instructions.

use super::super::instruction::{
    CombineCall, Instruction, LimitCall, Number, NumbersCall, PositionCall,
};
use super::super::program::Bound;
use super::{Compiler, Operand};
use crate::component::{Component, Depend, Family, Law, Motion, PortType, Scalars, Signal};
use crate::limit::Limit;
use crate::model::{ComponentId, CoordinateId, Node};
use condyle_math::function::FunctionOfSeveral;

impl Compiler<'_> {
    pub(super) fn scalar(&self, source: Signal) -> Operand {
        match source {
            Signal::Coordinate(id) => self.coordinates[id.index()],
            Signal::Output(id, output) => self.outputs[id.index()]
                .get(output as usize)
                .copied()
                .unwrap_or(Operand::Constant(0.0)),
            Signal::Segment(_) => Operand::Constant(0.0),
        }
    }

    /// The register of a scalar; a new one for a constant.
    pub(super) fn register(&mut self, scalar: Operand) -> Number {
        match scalar {
            Operand::Register(register) => register,
            Operand::Constant(value) => {
                let register = self.new_scalar();
                self.program.constants.push((register, value));
                register
            }
        }
    }

    /// The (first) register of a coordinate's effective value, where readers of the pose expect it.
    pub(super) fn own(&self, id: CoordinateId) -> Number {
        Number::new(self.model.stored_range(id).start)
    }

    pub(super) fn new_scalar(&mut self) -> Number {
        self.program.code.scalars += 1;
        Number::new(self.program.code.scalars - 1)
    }

    pub(super) fn node(&mut self, node: Node) {
        match node {
            Node::Coordinate(id) => {
                let Some(leader) = self.model.coordinate(id).follows else { return };
                let own = self.own(id);
                match self.scalar(leader) {
                    Operand::Constant(value) => {
                        self.program.constants.push((own, value));
                        self.coordinates[id.index()] = Operand::Constant(value);
                    }
                    Operand::Register(input) => {
                        let identity = condyle_math::function::Function::identity();
                        self.function(identity, input, own);
                    }
                }
            }
            Node::Component(id) if self.needed[id.index()] => self.component(id),
            Node::Component(_) => {}
        }
    }

    pub(super) fn function(
        &mut self,
        function: condyle_math::function::Function,
        input: Number,
        output: Number,
    ) {
        self.program.code.functions.push(function);
        let function = self.program.code.functions.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Function { function, input, output });
    }

    pub(super) fn component(&mut self, id: ComponentId) {
        let component = &self.model.components[id.index()];
        let first_row = self.program.code.rows.len();
        match component.law.family() {
            Family::Scalars(law) => self.scalars(id, component, law),
            Family::Numbers(_) => self.numbers(id, component),
            Family::Limit(_) => {
                let results = self.limit(id, component);
                self.outputs[id.index()].extend(results);
            }
            Family::Motion(law) => {
                if let Motion::Compensate(law) = law {
                    self.compensations[id.index()] = Some(self.paths(component, law.weight));
                }
                if let Motion::Contact(contact) = law {
                    self.contacts[id.index()] = Some(self.contact(id, component, contact));
                }
                self.share(id);
            }
        }
        let rows = first_row..self.program.code.rows.len();
        if self.measured[id.index()] || matches!(component.law, Law::Contact(_)) {
            self.program.measured_rows.extend(rows.clone());
        }
        if !rows.is_empty() {
            let mut numbers = vec![];
            for (port, source) in component.ports().filter(|_| component.law.bounds()) {
                let scalar = self.scalar(source);
                let first = self.register(scalar);
                let count = if port.takes == PortType::Orientation { 4 } else { 1 };
                numbers.extend((0..count).map(|k| Number(first.0 + k)));
            }
            self.program.bounds.push(Bound { component: id, rows, numbers });
        }
    }

    fn scalars(&mut self, id: ComponentId, component: &Component, law: Scalars<'_>) {
        match law {
            Scalars::Map(map) => {
                let input = self.scalar(component.inputs[0]);
                for function in &map.functions {
                    let value = function.as_constant();
                    // Constants are folded, and the identity needs no instruction.
                    let result = match (input, value, function.as_linear()) {
                        (_, Some(value), _) => Operand::Constant(value),
                        (Operand::Constant(x), ..) => {
                            Operand::Constant(function.value_and_slope(x).0)
                        }
                        (register, _, Some((1.0, 0.0))) => register,
                        (Operand::Register(input), ..) => {
                            let output = self.new_scalar();
                            self.function(function.clone(), input, output);
                            Operand::Register(output)
                        }
                    };
                    self.outputs[id.index()].push(result);
                }
            }
            Scalars::Combine(combine) => {
                let inputs: Vec<Operand> =
                    component.inputs.iter().map(|&s| self.scalar(s)).collect();
                let result = self.combine(&combine.function, &inputs);
                self.outputs[id.index()].push(result);
            }
            Scalars::Correlate(law) => {
                let inputs: Vec<Operand> =
                    component.inputs.iter().map(|&s| self.scalar(s)).collect();
                let result = self.combine(&law.function, &inputs);
                self.outputs[id.index()].push(result);
            }
            Scalars::Depend(depend) => {
                let result = self.depend(id, depend, component.inputs[0], component.inputs[1]);
                self.outputs[id.index()].push(result);
            }
            Scalars::RelativeOrientation(_) => {
                let frame = self.relative(component);
                let output = self.new_orientation();
                self.program.code.instructions.push(Instruction::Orientation { frame, output });
                self.outputs[id.index()].push(Operand::Register(output));
            }
            Scalars::RelativePosition(law) => {
                let frame = self.relative(component);
                let outputs: Vec<Number> = law.along.iter().map(|_| self.new_scalar()).collect();
                self.outputs[id.index()].extend(outputs.iter().copied().map(Operand::Register));
                let (point, along) = (law.point, law.along.clone());
                let code = &mut self.program.code;
                code.positions.push(PositionCall { frame, point, along, outputs });
                let position = code.positions.len() as u32 - 1;
                code.instructions.push(Instruction::Position { position });
            }
        }
    }

    /// Compiles a smooth function of few numbers.
    fn numbers(&mut self, id: ComponentId, component: &Component) {
        let mut inputs = vec![];
        let mut orientation = false;
        for (port, source) in component.ports() {
            let scalar = self.scalar(source);
            let first = self.register(scalar);
            orientation |= port.takes == PortType::Orientation;
            inputs.extend((0..if orientation { 4 } else { 1 }).map(|k| Number(first.0 + k)));
        }
        let count = component.law.outputs().1;
        let outputs: Vec<Number> = (0..count).map(|_| self.new_scalar()).collect();
        self.outputs[id.index()].extend(outputs.iter().copied().map(Operand::Register));
        let law = component.law.clone();
        self.program.code.numbers.push(NumbersCall { law, orientation, inputs, outputs });
        let numbers = self.program.code.numbers.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Numbers { numbers });
    }

    /// Computes a transform with several readers once, as a chain of its own.
    fn share(&mut self, id: ComponentId) {
        if self.readers[id.index()] > 1 {
            let register = self.new_transform();
            let mut steps = vec![];
            self.append(id, &mut steps);
            self.chain(self.program.code.identity, steps, register);
            self.shared[id.index()] = Some(register);
        }
    }

    /// Compiles a passive scalar between bounds that a driver sets: its effective value, and a
    /// limit row for each bound.
    fn depend(
        &mut self,
        id: ComponentId,
        depend: &Depend,
        passive: Signal,
        driver: Signal,
    ) -> Operand {
        let passive = self.scalar(passive);
        let passive = self.register(passive);
        let driver = self.scalar(driver);
        let driver = self.register(driver);
        let mut bounds = [None; 2];
        let sides = [(&depend.lower, 1.0), (&depend.upper, -1.0)];
        for (bound, (function, sign)) in bounds.iter_mut().zip(sides) {
            let Some(function) = function else { continue };
            let register = self.new_scalar();
            self.function(function.clone(), driver, register);
            self.row(passive, register, sign);
            *bound = Some(register);
        }
        let output = self.limit_output(Signal::Output(id, 0));
        // What is measured is not moved.
        let [lower, upper] = if self.measured[id.index()] { [None; 2] } else { bounds };
        self.program.code.instructions.push(Instruction::Hold { passive, lower, upper, output });
        Operand::Register(output)
    }

    /// The register of an output of a limit component: the coordinate's own if the output is its
    /// effective value, otherwise a new one.
    fn limit_output(&mut self, output: Signal) -> Number {
        match self.effective.get(&output) {
            Some(&id) => self.own(id),
            None => self.new_scalar(),
        }
    }

    /// The first of four new registers.
    fn new_orientation(&mut self) -> Number {
        self.program.code.scalars += 4;
        Number::new(self.program.code.scalars - 4)
    }

    /// Compiles a limit on numbers: those that are legal, and its rows.
    fn limit(&mut self, id: ComponentId, component: &Component) -> Vec<Operand> {
        let (mut inputs, mut outputs) = (vec![], vec![]);
        let law = component.law.clone();
        let orientation = law.outputs().0 == PortType::Orientation;
        let held = law.outputs().1;
        let mut orientations = 0;
        for (k, (port, source)) in component.ports().enumerate() {
            let scalar = self.scalar(source);
            let first = self.register(scalar);
            let output = Signal::Output(id, k as u32);
            let turns = port.takes == PortType::Orientation;
            orientations += usize::from(turns);
            // What comes after the numbers that it limits is what it depends on.
            if k >= held {
                inputs.extend((0..if turns { 4 } else { 1 }).map(|k| Number(first.0 + k)));
            } else if orientation {
                inputs.extend((0..4).map(|k| Number(first.0 + k)));
                let first = match self.effective.get(&output) {
                    Some(&id) => self.own(id),
                    None => self.new_orientation(),
                };
                outputs.extend((0..4).map(|k| Number(first.0 + k)));
            } else {
                inputs.push(first);
                outputs.push(self.limit_output(output));
            }
        }
        let count = law.limit().map_or(0, Limit::rows);
        let rows: Vec<Number> = (0..count).map(|_| self.new_scalar()).collect();
        self.program.code.rows.extend(&rows);
        let results = outputs.iter().map(|&register| Operand::Register(register)).collect();
        let measured = self.measured[id.index()];
        let call = LimitCall { law, orientations, measured, inputs, outputs, rows };
        self.program.code.limits.push(call);
        let limit = self.program.code.limits.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Limit { limit });
        results
    }

    /// Adds the limit row `sign · (value - bound) ≥ 0`.
    pub(super) fn row(&mut self, value: Number, bound: Number, sign: f64) {
        let function = FunctionOfSeveral::Linear { slopes: vec![sign, -sign], intercept: 0.0 };
        let inputs = [value, bound].map(Operand::Register);
        let row = self.combine(&function, &inputs);
        let row = self.register(row);
        self.program.code.rows.push(row);
    }

    /// Adds limit rows for the ranges of coordinates that follow others.
    pub(super) fn follower_rows(&mut self) {
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            if coordinate.follows.is_none() {
                continue;
            }
            let (lower, upper) = coordinate.range.bounds();
            let value = self.own(id);
            for (bound, sign) in [(lower, 1.0), (upper, -1.0)] {
                if bound.is_finite() {
                    let bound = self.register(Operand::Constant(bound));
                    self.row(value, bound, sign);
                }
            }
        }
    }

    pub(super) fn combine(&mut self, function: &FunctionOfSeveral, inputs: &[Operand]) -> Operand {
        let constants: Vec<f64> = inputs
            .iter()
            .filter_map(|s| if let Operand::Constant(v) = s { Some(*v) } else { None })
            .collect();
        // All inputs are constant: folded.
        if constants.len() == inputs.len() {
            return Operand::Constant(function.apply(&constants));
        }
        let inputs: Vec<Number> = inputs.iter().map(|&s| self.register(s)).collect();
        let output = self.new_scalar();
        self.program.code.combines.push(CombineCall { function: function.clone(), inputs });
        let function = self.program.code.combines.len() as u32 - 1;
        self.program.code.instructions.push(Instruction::Combine { function, output });
        Operand::Register(output)
    }
}
