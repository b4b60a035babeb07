//! How every segment moves with every direction of the coordinates.

use super::chain::{Recorder, run_chain};
use super::derivative_plan::{DerivativePlan, Start, Term};
use super::instruction::{Code, Instruction, NO_BASE};
use super::pose::Pose;
use super::program::{Mode, Program, SizeMismatch};
use super::rotation_rate::{exp_rate, log_rate};
use crate::component::{Law, MOST_COMBINED, MOST_LAW_INPUTS};
use crate::model::SegmentId;
use condyle_math::{Affine, Dual, Mat3, Quat, Twist, Vec3};

/// World generators of one evaluation.
///
/// Sparse: a segment has a twist for each direction that moves it, and shares the twists of its
/// ancestors. The velocity of a point p of the world per unit of a direction is
/// [`Twist::velocity_at`]\(p\).
#[derive(Clone, Debug)]
pub struct Jacobian {
    pub(super) twists: Vec<Twist>,
    pub(super) derivatives: Vec<f64>,
}

impl Jacobian {
    /// Buffers for this program.
    pub fn new(program: &Program) -> Self {
        let mut derivatives = vec![0.0; program.plan.derivatives];
        derivatives[0] = 1.0;
        Self { twists: vec![Twist::zero(); program.plan.twists], derivatives }
    }

    /// A twist by its number, as [`Program::segment_directions`] gives it.
    #[inline(always)]
    pub fn twist(&self, number: u32) -> Twist {
        self.twists[number as usize]
    }

    /// The derivative in a slot, as [`Program::coordinate_directions`] gives it.
    #[inline(always)]
    pub fn derivative(&self, slot: u32) -> f64 {
        self.derivatives[slot as usize]
    }

    /// Calls `visit` with each direction that moves a point (in the world, metres) fixed in a
    /// segment, and the point's velocity per unit of it.
    #[inline]
    pub fn visit_point(
        &self,
        program: &Program,
        segment: Option<SegmentId>,
        point: Vec3,
        mut visit: impl FnMut(usize, Vec3),
    ) {
        if let Some(segment) = segment {
            for &(direction, twist) in program.segment_directions(segment) {
                visit(direction as usize, self.twist(twist).velocity_at(point));
            }
        }
    }
}

/// Turns unit motions into twists, in the order that the plan foresees.
struct Tape<'p, 'a> {
    twists: &'a mut [Twist],
    derivatives: &'a [f64],
    counts: std::slice::Iter<'p, u32>,
    terms: std::slice::Iter<'p, Term>,
    scalars: &'a [f64],
    plan: &'p DerivativePlan,
}

impl Tape<'_, '_> {
    #[inline(always)]
    fn emit(&mut self, twist: impl FnOnce() -> Twist) {
        let count = self.counts.next().copied().unwrap_or(0);
        if count == 0 {
            return;
        }
        let unit = twist();
        for _ in 0..count {
            let Some(term) = self.terms.next() else { return };
            let addend = unit * self.derivatives[term.derivative as usize];
            self.twists[term.twist as usize] = match term.start {
                Start::Zero => addend,
                Start::From(other) => self.twists[other as usize] + addend,
                Start::Add => self.twists[term.twist as usize] + addend,
            };
        }
    }
}

impl Recorder<f64> for Tape<'_, '_> {
    #[inline(always)]
    fn motion(&mut self, twist: impl FnOnce() -> Twist) {
        self.emit(twist);
    }

    fn law(&mut self, code: &Code, law: u32, before: Affine) {
        let call = &code.laws[law as usize];
        let mut inputs = [Dual::<MOST_LAW_INPUTS>::constant(0.0); MOST_LAW_INPUTS];
        for (i, &register) in call.inputs.iter().enumerate() {
            inputs[i] = Dual::variable(self.scalars[register as usize], i);
        }
        let moved = call.law.transform(&inputs);
        let part = |v: Vec3<Dual<MOST_LAW_INPUTS>>, f: &dyn Fn(Dual<MOST_LAW_INPUTS>) -> f64| {
            Vec3::new(f(v.x), f(v.y), f(v.z))
        };
        let whole = |f: &dyn Fn(Dual<MOST_LAW_INPUTS>) -> f64| {
            let l = moved.linear;
            let linear = Mat3::from_columns(part(l.x, f), part(l.y, f), part(l.z, f));
            Affine::new(linear, part(moved.translation, f))
        };
        let value = whole(&|d| d.value);
        for i in 0..call.inputs.len() {
            let derivative = whole(&|d| d.partials[i]);
            self.emit(|| Twist::from_derivative(value, derivative).transformed(before));
        }
    }

    fn power(&mut self, register: u32, exponent: f64, rotation: Mat3, before: Affine) {
        let turn = rotation.log();
        let raised = turn * exponent;
        for &(_, twist) in self.plan.segment_entries(register as usize) {
            let spin = self.twists[twist as usize].angular;
            // d exp(p·ρ) = J(p·ρ)·p·J(ρ)⁻¹·ω, with J the left Jacobian of SO(3).
            let moved = match exponent {
                1.0 => spin,
                -1.0 => -(rotation.transpose() * spin),
                _ => exp_rate(raised, log_rate(turn, spin) * exponent),
            };
            self.emit(|| Twist::rotation(before.linear * moved, before.translation));
        }
    }

    fn transform(&mut self, register: u32, before: Affine) {
        for &(_, twist) in self.plan.segment_entries(register as usize) {
            let inner = self.twists[twist as usize];
            self.emit(|| inner.transformed(before));
        }
    }
}

impl Program {
    /// [`Program::evaluate`] in open mode, with the generators of all segments beside it.
    ///
    /// # Errors
    /// [`SizeMismatch`] if `requested`, the pose or the Jacobian has the wrong length.
    pub fn evaluate_with_jacobian(
        &self,
        requested: &[f64],
        pose: &mut Pose,
        jacobian: &mut Jacobian,
    ) -> Result<(), SizeMismatch> {
        SizeMismatch::check("the Jacobian", self.plan.twists, jacobian.twists.len())?;
        SizeMismatch::check("the Jacobian", self.plan.derivatives, jacobian.derivatives.len())?;
        self.load(requested, Mode::Open, pose)?;
        let plan = &self.plan;
        // Scalar instructions stand before the chains that read them, but may follow other chains.
        let mut scalar_counts = plan.scalar_counts.iter();
        let mut scalar_terms = plan.scalar_terms.iter();
        let mut term_counts = plan.term_counts.iter();
        let mut terms = plan.terms.iter();
        for instruction in &self.code.instructions {
            let (base, output) = match *instruction {
                Instruction::Chain { base, output, .. } => (base, output),
                Instruction::BallAt { base, output, .. } => (base, output),
                _ => {
                    let count = scalar_counts.next().copied().unwrap_or(0) as usize;
                    let own = scalar_terms.as_slice().get(..count).unwrap_or(&[]);
                    scalar_terms = scalar_terms.as_slice().get(count..).unwrap_or(&[]).iter();
                    self.differentiate_scalar(instruction, own, pose, &mut jacobian.derivatives);
                    continue;
                }
            };
            let from =
                if base == NO_BASE { Affine::IDENTITY } else { pose.transforms[base as usize] };
            let mut tape = Tape {
                twists: &mut jacobian.twists,
                derivatives: &jacobian.derivatives,
                counts: term_counts.clone(),
                terms: terms.clone(),
                scalars: &pose.scalars,
                plan,
            };
            let end = match *instruction {
                Instruction::BallAt { shift, orientation, .. } => {
                    let q = orientation as usize;
                    let q: &[f64; 4] = pose.scalars[q..].first_chunk().expect("four registers");
                    let at = from.shifted(shift);
                    let turned = at.linear * Quat::from(*q).to_mat3();
                    for axis in [turned.x, turned.y, turned.z] {
                        tape.emit(|| Twist::rotation(axis, at.translation));
                    }
                    Affine::new(turned, at.translation)
                }
                Instruction::Chain { first, end, .. } => {
                    let steps = &self.code.steps[first as usize..end as usize];
                    run_chain(&self.code, steps, from, &pose.scalars, &pose.transforms, &mut tape)
                }
                _ => from,
            };
            (term_counts, terms) = (tape.counts, tape.terms);
            pose.transforms[output as usize] = end;
        }
        Ok(())
    }

    /// Runs a scalar instruction and the chain rule through it.
    fn differentiate_scalar(
        &self,
        instruction: &Instruction,
        terms: &[super::derivative_plan::ScalarTerm],
        pose: &mut Pose,
        derivatives: &mut [f64],
    ) {
        let mut add = |term: &super::derivative_plan::ScalarTerm, slope: f64| {
            let addend = slope * derivatives[term.from as usize];
            let to = &mut derivatives[term.to as usize];
            *to = if term.first { addend } else { *to + addend };
        };
        match *instruction {
            Instruction::Function { function, input, output } => {
                let x = pose.scalars[input as usize];
                let (value, slope) = self.code.functions[function as usize].value_and_slope(x);
                pose.scalars[output as usize] = value;
                terms.iter().for_each(|term| add(term, slope));
            }
            Instruction::Combine { function, output } => {
                let call = &self.code.combines[function as usize];
                let n = call.inputs.len();
                let mut values = [Dual::<1>::constant(0.0); MOST_COMBINED];
                for (value, &input) in values.iter_mut().zip(&call.inputs) {
                    value.value = pose.scalars[input as usize];
                }
                pose.scalars[output as usize] = call.function.apply(&values[..n]).value;
                for term in terms {
                    let i = term.input as usize;
                    values[i].partials[0] = 1.0;
                    add(term, call.function.apply(&values[..n]).partials[0]);
                    values[i].partials[0] = 0.0;
                }
            }
            Instruction::Hold { passive, output, .. } => {
                pose.scalars[output as usize] = pose.scalars[passive as usize];
                terms.iter().for_each(|term| add(term, 1.0));
            }
            Instruction::Chain { .. } | Instruction::BallAt { .. } => {}
        }
    }
}
