//! Compilation of a checked model to a program.

mod chain;
mod scalar;

use super::behind::{Behind, Between};
use super::derivative_plan::{DerivativePlan, plan};
use super::instruction::{Code, Frame, Number};
use super::program::Program;
use crate::component::{Combine, Correlate, Law, PortType, Signal};
use crate::model::{
    ComponentId, CoordinateId, CoordinateKind, Model, Node, SegmentId, dependency_order, measured,
};
use std::collections::HashMap;

/// The compiled form of a source: a constant or a register.
#[derive(Clone, Copy, Debug)]
enum Operand {
    Constant(f64),
    Register(Number),
}

struct Compiler<'m> {
    model: &'m Model,
    program: Program,
    /// The value of each coordinate as components read it (for an orientation its first register).
    coordinates: Vec<Operand>,
    /// The value of each output of each scalar component.
    outputs: Vec<Vec<Operand>>,
    /// The register of each transform component with several readers.
    shared: Vec<Option<Frame>>,
    /// For each compensation the registers of the path without and with compensation.
    compensations: Vec<Option<(Frame, Frame)>>,
    /// For each contact the register of its rotations.
    contacts: Vec<Option<Frame>>,
    /// The number of readers of each component.
    readers: Vec<usize>,
    needed: Vec<bool>,
    /// Which components depend on what is measured between segments.
    measured: Vec<bool>,
    /// The outputs of limit components that are the effective value of a coordinate.
    effective: HashMap<Signal, CoordinateId>,
}

impl Program {
    /// Compiles a model. Models are checked when they are built, so this cannot fail.
    pub fn compile(model: &Model) -> Self {
        let moving = vec![true; model.tangent_len()];
        compile(model, &vec![true; model.segments.len()], &moving, true)
    }

    /// Compiles a model without its limits on what is measured between segments, which move nothing: all else is that of
    /// [`Program::compile`], to the bit, and the rows of these limits are not there.
    ///
    /// For those who ask for no limits: what a limit needs to be asked is then not made.
    pub fn compile_unmeasured(model: &Model) -> Self {
        let moving = vec![true; model.tangent_len()];
        compile(model, &vec![true; model.segments.len()], &moving, false)
    }

    /// Compiles what some segments need, with derivatives along some directions.
    ///
    /// The transforms of these segments, the coordinates and the limit rows are those of
    /// [`Program::compile`], to the bit; other segments stay at the identity, where their ancestors are
    /// not asked for either, and have no directions. `moving` has one entry for each direction of the
    /// model; those of an orientation must be alike.
    ///
    /// # Panics
    ///
    /// If `moving` is shorter than [`Model::tangent_len`].
    ///
    /// ```
    /// use condyle_math::Vec3;
    /// use condyle_model::{Mode, ModelBuilder, Pose, Program};
    ///
    /// let mut builder = ModelBuilder::new("arm");
    /// let humerus = builder.segment("humerus", None);
    /// builder.hinge("shoulder", humerus, "elevation", Vec3::Z);
    /// let hand = builder.segment("hand", Some(humerus));
    /// builder.hinge("wrist", hand, "flexion", Vec3::Z);
    /// let model = builder.build().unwrap();
    ///
    /// let upper_arm = Program::compile_for(&model, [humerus], &[true; 2]);
    /// let mut pose = Pose::new(&upper_arm);
    /// upper_arm.evaluate(&[0.5, 0.25], Mode::Open, &mut pose).unwrap();
    /// assert_eq!(pose.segment(humerus).linear.x.y, 0.5_f64.sin());
    /// assert_eq!(pose.segment(hand).linear.x.y, 0.0); // not computed
    /// ```
    pub fn compile_for(
        model: &Model,
        segments: impl IntoIterator<Item = SegmentId>,
        moving: &[bool],
    ) -> Self {
        let mut wanted = vec![false; model.segments.len()];
        for segment in segments {
            let mut here = Some(segment);
            while let Some(id) = here
                && !std::mem::replace(&mut wanted[id.index()], true)
            {
                here = model.segment(id).parent;
            }
        }
        compile(model, &wanted, moving, true)
    }
}

/// Compiles a model with its `wanted` segments, which include their ancestors, and perhaps its limits on what is measured.
fn compile(model: &Model, wanted: &[bool], moving: &[bool], measured_limits: bool) -> Program {
    // A built model has no dependency cycle, so the default, an empty order, is never used.
    let order = dependency_order(model).unwrap_or_default();
    let components = model.components.len();
    let mut compiler = Compiler {
        model,
        program: Program {
            stored: model.stored_len(),
            segments: model.segments.len(),
            constants: vec![],
            asked: vec![],
            limits: vec![],
            measured_rows: vec![],
            bounds: vec![],
            behind: vec![],
            code: Code {
                scalars: model.stored_len(),
                transforms: model.segments.len() + 2,
                instructions: vec![],
                stages: vec![],
                turns: vec![],
                steps: vec![],
                fixed: vec![],
                functions: vec![],
                combines: vec![],
                laws: vec![],
                scales: vec![],
                shears: vec![],
                rows: vec![],
                limits: vec![],
                positions: vec![],
                numbers: vec![],
                contacts: vec![],
                base: Frame::new(model.segments.len()),
                identity: Frame::new(model.segments.len() + 1),
            },
            plan: DerivativePlan::default(),
            outputs: vec![],
        },
        coordinates: model
            .coordinate_ids()
            .map(|id| Operand::Register(Number::new(model.stored_range(id).start)))
            .collect(),
        outputs: vec![vec![]; components],
        shared: vec![None; components],
        compensations: vec![None; components],
        contacts: vec![None; components],
        readers: vec![0; components],
        needed: vec![false; components],
        measured: measured(model, &order),
        effective: HashMap::new(),
    };
    compiler.mark_needed(&order, wanted, measured_limits);
    compiler.limits();
    compiler.find_effective(&order);
    for &node in &order {
        compiler.node(node);
    }
    compiler.find_behind(&order);
    compiler.follower_rows();
    for segment in model.parents_first() {
        if wanted[segment.index()] {
            compiler.segment(segment);
        }
    }
    compiler.program.code.order();
    let directions: Vec<(Number, u32)> = model
        .coordinate_ids()
        .filter(|&id| model.coordinate(id).follows.is_none())
        .filter(|&id| moving[model.tangent_range(id).start])
        .filter_map(|id| match compiler.coordinates[id.index()] {
            Operand::Register(register) => Some((register, model.tangent_range(id))),
            Operand::Constant(_) => None,
        })
        .flat_map(|(register, along)| {
            along.enumerate().map(move |(k, at)| (Number(register.0 + k as u32), at as u32))
        })
        .collect();
    compiler.program.plan =
        plan(&compiler.program.code, model.stored_len(), model.tangent_len(), &directions);
    let number = |operand: &Operand| match *operand {
        Operand::Constant(value) => Ok(value),
        Operand::Register(number) => Err(number),
    };
    compiler.program.outputs =
        compiler.outputs.iter().map(|own| own.iter().map(number).collect()).collect();
    compiler.program
}

impl Compiler<'_> {
    /// Marks the components that wanted segments, coordinates and limits depend on, directly or not; the
    /// others are not compiled.
    fn mark_needed(&mut self, order: &[Node], wanted: &[bool], measured_limits: bool) {
        let model = self.model;
        let motion = |segment: usize| model.segments[segment].motion;
        let followed = || model.coordinates.iter().filter_map(|c| c.follows);
        // A limit on what is measured moves nothing, so that nothing has to read its outputs.
        let bounds = |id: &ComponentId| {
            self.measured[id.index()] && model.components[id.index()].law.bounds()
        };
        let measured = model.component_ids().filter(bounds).map(|id| Signal::Output(id, 0));
        let measured: Vec<Signal> = measured.collect();
        let moved = (0..wanted.len()).filter_map(motion);
        let all = moved.chain(followed()).chain(measured);
        // Whether a transform has several readers does not depend on what is wanted.
        let (of_model, readers) = self.reached(order, all);
        self.readers = readers;
        let limits = model
            .component_ids()
            .filter(|id| of_model[id.index()] && model.components[id.index()].law.bounds())
            .filter(|id| measured_limits || !self.measured[id.index()]);
        let wanted = (0..wanted.len()).filter(|&segment| wanted[segment]).filter_map(motion);
        let limits = limits.map(|id| Signal::Output(id, 0));
        self.needed = self.reached(order, wanted.chain(followed()).chain(limits)).0;
    }

    /// The components that sources depend on, directly or not, and the number of readers of each.
    fn reached(
        &self,
        order: &[Node],
        sources: impl Iterator<Item = Signal>,
    ) -> (Vec<bool>, Vec<usize>) {
        let components = self.model.components.len();
        let (mut reached, mut readers) = (vec![false; components], vec![0; components]);
        let mut read = |source: Signal, reached: &mut Vec<bool>| {
            if let Signal::Output(id, _) = source {
                reached[id.index()] = true;
                readers[id.index()] += 1;
            }
        };
        sources.for_each(|source| read(source, &mut reached));
        // Readers come after what they read: in reverse order one pass is enough.
        for node in order.iter().rev() {
            if let Node::Component(id) = *node
                && reached[id.index()]
            {
                self.model.reads(id).into_iter().for_each(|source| read(source, &mut reached));
            }
        }
        (reached, readers)
    }

    /// Finds the coordinates that limit components hold. If several limits act on a coordinate one
    /// after another, the last one writes its effective value (of several at the same depth, the
    /// last in the model). Whatever reads the coordinate itself gets the requested value.
    fn find_effective(&mut self, order: &[Node]) {
        // For each output the coordinate that it holds, and the number of limits up to it.
        let mut origin: HashMap<Signal, (CoordinateId, usize)> = HashMap::new();
        let mut last: HashMap<CoordinateId, (usize, ComponentId, Signal)> = HashMap::new();
        for node in order {
            let Node::Component(id) = *node else { continue };
            let component = &self.model.components[id.index()];
            if !self.needed[id.index()] || self.measured[id.index()] || !component.law.bounds() {
                continue;
            }
            let held = match component.law {
                Law::Depend(_) => component.at("passive"),
                Law::Field(_) => component.at("orientation"),
                _ => &component.inputs,
            };
            for (k, &source) in held.iter().enumerate() {
                // A limit on the output of another one acts on the same coordinate, one level
                // deeper.
                let found = match source {
                    Signal::Coordinate(id) => Some((id, 0)),
                    output => origin.get(&output).copied(),
                };
                let Some((coordinate, depth)) = found else { continue };
                if self.model.coordinate(coordinate).follows.is_some() {
                    continue;
                }
                let output = Signal::Output(id, k as u32);
                origin.insert(output, (coordinate, depth + 1));
                let far = (depth + 1, id, output);
                let best = last.entry(coordinate).or_insert(far);
                if (far.0, far.1) >= (best.0, best.1) {
                    *best = far;
                }
            }
        }
        for id in self.model.coordinate_ids() {
            let Some(&(.., output)) = last.get(&id) else { continue };
            self.effective.insert(output, id);
            // New registers for the requested numbers; readers of the coordinate are redirected
            // there.
            let own = self.model.stored_range(id);
            let asked = self.program.code.scalars;
            self.program.code.scalars += own.len();
            self.coordinates[id.index()] = Operand::Register(Number::new(asked));
            let pairs = own.zip(asked..).map(|(own, asked)| (Number::new(own), Number::new(asked)));
            self.program.asked.extend(pairs);
        }
    }

    /// Finds the coordinates whose limits act behind maps. Of several limits of one coordinate the last
    /// counts; one that acts on the coordinate itself has written it back.
    fn find_behind(&mut self, order: &[Node]) {
        // For each signal the coordinate that it comes from, and what is in between.
        let mut routes: HashMap<Signal, (CoordinateId, Vec<Between>)> = HashMap::new();
        let mut last: HashMap<CoordinateId, Behind> = HashMap::new();
        let direct: Vec<CoordinateId> = self.effective.values().copied().collect();
        let mut readers: HashMap<CoordinateId, usize> = HashMap::new();
        for input in self.model.components.iter().flat_map(|component| &component.inputs) {
            if let Signal::Coordinate(id) = input {
                *readers.entry(*id).or_default() += 1;
            }
        }
        for node in order {
            let Node::Component(id) = *node else { continue };
            let component = &self.model.components[id.index()];
            if !self.needed[id.index()] || self.measured[id.index()] {
                continue;
            }
            let route = |signal: Signal| match signal {
                Signal::Coordinate(id) if self.model.coordinate(id).follows.is_none() => {
                    Some((id, vec![]))
                }
                other => routes.get(&other).cloned(),
            };
            let mut found = vec![];
            match &component.law {
                Law::Map(map) => {
                    let Some((coordinate, steps)) = route(component.inputs[0]) else { continue };
                    for (k, function) in map.functions.iter().enumerate() {
                        let steps = [&steps[..], &[Between::Map(function.clone())]].concat();
                        found.push((Signal::Output(id, k as u32), (coordinate, steps)));
                    }
                }
                Law::Combine(Combine { function }) | Law::Correlate(Correlate { function, .. }) => {
                    let coordinate = |signal: &Signal| match route(*signal)? {
                        (id, steps) if steps.is_empty() => Some(id),
                        _ => None,
                    };
                    let all: Option<Vec<_>> = component.inputs.iter().map(coordinate).collect();
                    let Some(coordinates) = all else { continue };
                    let open: Vec<usize> = (0..coordinates.len())
                        .filter(|&k| !direct.contains(&coordinates[k]))
                        .collect();
                    // One that is not settled by a limit of its own makes up for the others; of several, the
                    // one that nothing else reads, such as a finger's part of a spread that all share.
                    let own = |k: &&usize| readers.get(&coordinates[**k]) == Some(&1);
                    let at = match (&open[..], &open.iter().filter(own).collect::<Vec<_>>()[..]) {
                        ([at], _) => *at,
                        (_, [at]) => **at,
                        _ => continue,
                    };
                    let (own, function) = (coordinates[at], function.clone());
                    let step = Between::Several { function, coordinates, at };
                    found.push((Signal::Output(id, 0), (own, vec![step])));
                }
                law if law.bounds() && law.outputs().0 == PortType::Scalar => {
                    for (k, &source) in component.inputs.iter().enumerate().take(law.outputs().1) {
                        let Some((coordinate, steps)) = route(source) else { continue };
                        let output = Signal::Output(id, k as u32);
                        let numbers = [self.scalar(source), self.scalar(output)];
                        if let [Operand::Register(before), Operand::Register(held)] = numbers
                            && !steps.is_empty()
                        {
                            // What goes into a chain of limits is what the first of them reads.
                            let before = last.get(&coordinate).map_or(before, |known| known.before);
                            let steps = steps.clone();
                            last.insert(coordinate, Behind { coordinate, steps, before, held });
                        }
                        found.push((output, (coordinate, steps)));
                    }
                }
                _ => {}
            }
            routes.extend(found);
        }
        let behind = last.into_values().filter(|behind| !direct.contains(&behind.coordinate));
        self.program.behind = behind.collect();
        self.program.behind.sort_by_key(|behind| behind.coordinate);
    }

    fn limits(&mut self) {
        for id in self.model.coordinate_ids() {
            let coordinate = self.model.coordinate(id);
            // Followers have limit rows instead, and orientations have cones.
            let (lower, upper) = coordinate.range.bounds();
            let bounded = lower > f64::NEG_INFINITY || upper < f64::INFINITY;
            if bounded
                && coordinate.follows.is_none()
                && coordinate.kind != CoordinateKind::Orientation
            {
                let register = self.own(id);
                self.program.limits.push((register, lower, upper));
            }
        }
    }
}
