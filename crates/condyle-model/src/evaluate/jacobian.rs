//! The derivatives of all segments with respect to the directions (tangents) of the coordinates.

use super::chain::{Recorder, run_chain};
use super::deformation::NO_STRAIN;
use super::derivative_plan::ScalarTerm;
use super::forward::finite;
use super::instruction::Instruction;
use super::pose::Pose;
use super::program::{Mode, Program, SizeMismatch};
use super::tape::Tape;
use crate::component::{MOST_NUMBERS, NumberDual};
use crate::limit::MOST_LIMITED;
use crate::model::SegmentId;
use condyle_math::{Affine, Mat3, Quat, Scalar, Twist, Vec3};

/// The generators of one evaluation, expressed in the world.
///
/// Sparse: a segment has a twist for each direction that moves it, and shares twists with its
/// ancestors. Below a scale or a shear a twist also has a strain. [`Jacobian::velocity_at`] is the
/// velocity of a point of the world per unit of a direction.
#[derive(Clone, Debug)]
pub struct Jacobian {
    pub(super) twists: Vec<Twist>,
    pub(super) strains: Vec<Mat3>,
    pub(super) derivatives: Vec<f64>,
}

impl Jacobian {
    /// Buffers for this program.
    pub fn new(program: &Program) -> Self {
        // Slot 0 is the constant 1, the derivative of a coordinate in its own direction.
        let mut derivatives = vec![0.0; program.plan.derivatives];
        derivatives[0] = 1.0;
        Self {
            twists: vec![Twist::zero(); program.plan.twists],
            strains: vec![NO_STRAIN; program.plan.strains],
            derivatives,
        }
    }

    /// A twist by its index, as given by [`Program::segment_directions`].
    #[inline(always)]
    pub fn twist(&self, number: u32) -> Twist {
        self.twists[number as usize]
    }

    /// The strain that belongs to a twist, for a segment below a scale or a shear; otherwise
    /// `None`.
    ///
    /// A symmetric matrix D: the velocity of the point p of the world is that of the twist plus
    /// D·p.
    #[inline(always)]
    pub fn strain(&self, program: &Program, number: u32) -> Option<Mat3> {
        program.plan.strain_slot(number).map(|slot| self.strains[slot])
    }

    /// The velocity of a point (in the world, metres) per unit of a direction, given by the index
    /// of its twist.
    #[inline(always)]
    pub fn velocity_at(&self, program: &Program, number: u32, point: Vec3) -> Vec3 {
        let rigid = self.twist(number).velocity_at(point);
        self.strain(program, number).map_or(rigid, |strain| rigid + strain * point)
    }

    /// The derivative in a slot, as given by [`Program::coordinate_directions`].
    #[inline(always)]
    pub fn derivative(&self, slot: u32) -> f64 {
        self.derivatives[slot as usize]
    }

    /// Calls `visit` for each direction that moves a point (in the world, metres) fixed in a
    /// segment, with the direction and the velocity of the point per unit of it.
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
                visit(direction as usize, self.velocity_at(program, twist, point));
            }
        }
    }
}

/// Adds a term of the derivative of a scalar.
#[inline(always)]
fn add(derivatives: &mut [f64], term: &ScalarTerm, slope: f64) {
    let addend = slope * derivatives[term.from as usize];
    let to = &mut derivatives[term.to as usize];
    *to = if term.first { addend } else { *to + addend };
}

impl Program {
    /// [`Program::evaluate`] in open mode, which also computes the generators of all segments.
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
        SizeMismatch::check("the Jacobian", self.plan.strains, jacobian.strains.len())?;
        SizeMismatch::check("the Jacobian", self.plan.derivatives, jacobian.derivatives.len())?;
        self.load(requested, Mode::Open, pose)?;
        for stage in &self.code.stages {
            let instructions = &self.code.instructions;
            for (number, instruction) in
                stage.scalars.clone().zip(&instructions[stage.scalars.clone()])
            {
                self.differentiate_scalar(number, instruction, pose, jacobian);
            }
            pose.take_turns(&self.code.turns, stage.turns.clone());
            for (number, instruction) in
                stage.transforms.clone().zip(&instructions[stage.transforms.clone()])
            {
                self.differentiate_transform(number, instruction, pose, jacobian);
            }
        }
        Ok(())
    }

    /// Runs an instruction that computes a transform and records the twists of its motions.
    #[inline(always)]
    fn differentiate_transform(
        &self,
        number: usize,
        instruction: &Instruction,
        pose: &mut Pose,
        jacobian: &mut Jacobian,
    ) {
        let plan = &self.plan;
        let (counts, terms) = plan.motions(number);
        let mut tape = Tape {
            twists: &mut jacobian.twists,
            strains: &mut jacobian.strains,
            deforming: false,
            derivatives: &jacobian.derivatives,
            scalars: &pose.scalars,
            plan,
            counts,
            terms,
        };
        match *instruction {
            Instruction::BallAt { base, shift, orientation, output } => {
                tape.deforming = plan.deforming[output.index()];
                let at = pose.transforms[base.index()].shifted(shift);
                let q = orientation.quaternion(&pose.scalars);
                let turned = at.linear * Quat::from(q).to_mat3();
                let end = Affine::new(turned, at.translation);
                for (unit, axis) in Vec3::UNITS.into_iter().zip([turned.x, turned.y, turned.z]) {
                    let inside = || Twist::rotation(unit, Vec3::ZERO);
                    tape.motion(end, inside, || Twist::rotation(axis, at.translation));
                }
                pose.transforms[output.index()] = end;
            }
            Instruction::Chain { base, shift, first, end, output } => {
                tape.deforming = plan.deforming[output.index()];
                let from = pose.transforms[base.index()].shifted(shift);
                let steps = &self.code.steps[first as usize..end as usize];
                let end = run_chain(&self.code, steps, from, pose, &mut tape);
                pose.transforms[output.index()] = end;
            }
            Instruction::Contact { contact } => {
                let call = &self.code.contacts[contact as usize];
                let frame = pose.transforms[call.frame.index()];
                let (turns, report, slopes) = tape.contact(call, frame);
                pose.scalars[call.report.index()..][..4].copy_from_slice(&report);
                pose.transforms[call.output.index()] = turns;
                let entries = plan.frame_entries(call.frame);
                let each = entries.len() + call.drivers.len();
                for term in plan.scalar_terms(number) {
                    let (gap, k) = (term.slope as usize / each, term.slope as usize % each);
                    let slopes = slopes[gap];
                    let slope = match entries.get(k) {
                        Some(&(_, twist)) => {
                            let Twist { angular, linear } = jacobian.twists[twist as usize];
                            let along = Vec3::new(slopes[0], slopes[1], slopes[2]);
                            along.dot(angular)
                                + Vec3::new(slopes[3], slopes[4], slopes[5]).dot(linear)
                        }
                        None => slopes[6 + k - entries.len()],
                    };
                    add(&mut jacobian.derivatives, term, slope);
                }
            }
            _ => {}
        }
    }

    /// Runs a scalar instruction and applies the chain rule to it.
    #[inline(always)]
    fn differentiate_scalar(
        &self,
        number: usize,
        instruction: &Instruction,
        pose: &mut Pose,
        jacobian: &mut Jacobian,
    ) {
        let (derivatives, twists) = (&mut jacobian.derivatives[..], &jacobian.twists[..]);
        let terms = self.plan.scalar_terms(number);
        let mut add = |term: &ScalarTerm, slope: f64| add(derivatives, term, slope);
        match *instruction {
            Instruction::Function { function, input, output } => {
                let x = pose.scalars[input.index()];
                let (value, slope) = self.code.functions[function as usize].value_and_slope(x);
                pose.scalars[output.index()] = finite(value);
                terms.iter().for_each(|term| add(term, slope));
            }
            Instruction::Combine { function, output } => {
                let call = &self.code.combines[function as usize];
                let values = call.inputs.iter().map(|input| pose.scalars[input.index()]);
                for term in terms {
                    add(term, call.function.slope_at(values.clone(), term.slope as usize));
                }
                pose.scalars[output.index()] = finite(call.function.apply_to(values));
            }
            Instruction::Hold { passive, output, .. } => {
                pose.scalars[output.index()] = pose.scalars[passive.index()];
                terms.iter().for_each(|term| add(term, 1.0));
            }
            Instruction::Limit { limit } => {
                let call = &self.code.limits[limit as usize];
                let Some(limit) = call.law.limit() else { return };
                let mut numbers = [0.0; MOST_LIMITED];
                for (i, &input) in call.inputs.iter().enumerate() {
                    numbers[i] = pose.scalars[input.index()];
                }
                for (&output, value) in call.outputs.iter().zip(numbers) {
                    pose.scalars[output.index()] = value;
                }
                let rows = limit.rows_at(&numbers[..call.inputs.len()]);
                for (&register, (value, _)) in call.rows.iter().zip(&rows) {
                    pose.scalars[register.index()] = *value;
                }
                // Position 0 is that of the numbers, the others those of the rows along each of them.
                for term in terms {
                    let slope = (term.slope as usize).checked_sub(1);
                    add(term, slope.map_or(1.0, |k| rows[k / MOST_LIMITED].1[k % MOST_LIMITED]));
                }
            }
            Instruction::Orientation { frame, output } => {
                let turned = pose.transforms[frame.index()].linear;
                let q = Quat::from_mat3(turned).to_array();
                pose.scalars[output.index()..][..4].copy_from_slice(&q);
                // Position 3·i + k is the tangent k along the i-th direction of the frame: δ = Rᵀ·ω.
                let entries = self.plan.frame_entries(frame);
                for term in terms {
                    let (i, k) = (term.slope as usize / 3, term.slope as usize % 3);
                    let spin = twists[entries[i].1 as usize].angular;
                    add(term, [turned.x, turned.y, turned.z][k].dot(spin));
                }
            }
            Instruction::Position { position } => {
                let call = &self.code.positions[position as usize];
                let place = pose.transforms[call.frame.index()] * call.point;
                for (&output, along) in call.outputs.iter().zip(&call.along) {
                    pose.scalars[output.index()] = finite(place.dot(*along));
                }
                // Position n·i + k is the output k of n along the i-th direction of the frame.
                let (entries, n) = (self.plan.frame_entries(call.frame), call.along.len());
                for term in terms {
                    let (i, k) = (term.slope as usize / n, term.slope as usize % n);
                    let velocity = twists[entries[i].1 as usize].velocity_at(place);
                    add(term, call.along[k].dot(velocity));
                }
            }
            Instruction::Numbers { numbers } => {
                let call = &self.code.numbers[numbers as usize];
                let Some(law) = call.law.numbers() else { return };
                let mut inputs = [NumberDual::constant(0.0); MOST_NUMBERS];
                for (i, register) in call.inputs.iter().enumerate() {
                    inputs[i] = NumberDual::variable(pose.scalars[register.index()], i);
                }
                if call.orientation {
                    // Along its tangents: q·exp(δ) is q·(δ/2, 1) to first order.
                    let half = |i| NumberDual::variable(0.0, i).scale(0.5);
                    let (x, y, z) = (half(0), half(1), half(2));
                    let step = Quat { x, y, z, w: NumberDual::constant(1.0) };
                    let q = inputs.map(|input| NumberDual::constant(input.value));
                    inputs = (Quat::from(q) * step).to_array();
                }
                let found = law.dual_at(inputs);
                for (output, value) in call.outputs.iter().zip(found) {
                    pose.scalars[output.index()] = finite(value.value);
                }
                // Position n·output + k is its slope along the input, or the tangent, k.
                for term in terms {
                    let slope = term.slope as usize;
                    add(term, found[slope / MOST_NUMBERS].partials[slope % MOST_NUMBERS]);
                }
            }
            Instruction::Contact { .. }
            | Instruction::Chain { .. }
            | Instruction::BallAt { .. } => {}
        }
    }
}
