//! Evaluation of a program: transforms from coordinates.

use super::chain::{Silent, run_chain};
use super::instruction::Instruction;
use super::pose::Pose;
use super::program::{Mode, Program, SizeMismatch};
use crate::component::MOST_NUMBERS;
use crate::limit::MOST_LIMITED;
use condyle_math::{Affine, Lane, Quat, Scalar, Vec3};

/// The largest absolute value of a scalar; larger ones are clamped.
const MOST: f64 = 1e9;

/// A number clamped to ±10⁹; NaN becomes 10⁹.
#[inline(always)]
pub(super) fn finite<S: Scalar>(x: S) -> S {
    // NaN is not less than `most`, so the first selection replaces it.
    let (least, most) = (S::from_f64(-MOST), S::from_f64(MOST));
    let held = x.select_less(most, x, most);
    held.select_less(least, least, held)
}

/// Slopes along the tangents of an orientation as slopes along its four stored numbers.
///
/// δ = 2·vec(q*·q̇)/|q|², with q* the conjugate, so s·δ = 2·((w·s - s × v)·v̇ - (s·v)·ẇ)/|q|².
fn stored_slopes(
    numbers: &[f64],
    slopes: [f64; MOST_LIMITED],
    orientations: usize,
) -> [f64; MOST_LIMITED] {
    let mut stored = [0.0; MOST_LIMITED];
    let (turns, scalars) = (3 * orientations, 4 * orientations);
    for (to, from) in stored[scalars..].iter_mut().zip(&slopes[turns..]) {
        *to = *from;
    }
    for ((q, from), to) in numbers
        .chunks_exact(4)
        .zip(slopes.chunks_exact(3))
        .zip(stored.chunks_exact_mut(4))
        .take(orientations)
    {
        to.copy_from_slice(&slopes_of_stored(q, from));
    }
    stored
}

/// Those of one orientation.
fn slopes_of_stored(q: &[f64], along: &[f64]) -> [f64; 4] {
    let [a, b, c] = [0, 1, 2].map(|k| along[k]);
    let (v, s) = (Vec3::new(q[0], q[1], q[2]), Vec3::new(a, b, c));
    let square = q.iter().map(|x| x * x).sum::<f64>().max(1e-300);
    let along = (s * q[3] - s.cross(v)) * (2.0 / square);
    [along.x, along.y, along.z, -2.0 * s.dot(v) / square]
}

/// Runs consecutive ball instructions: first the local transforms of all, then the products along
/// the tree.
///
/// The iterations of the first loop are independent, so the divisions of several overlap. In the
/// second loop the frame stays in registers as long as each ball is a child of the previous one:
/// reading it back right after writing it in smaller pieces would cause a store-forwarding stall.
#[inline]
fn run_balls<S: Scalar>(balls: &[Instruction], pose: &mut Pose<S>) {
    for ball in balls {
        let Instruction::BallAt { shift, orientation, output, .. } = *ball else { continue };
        let q = orientation.quaternion(&pose.scalars);
        pose.transforms[output.index()] = Affine::new(Quat::from(q).to_mat3(), shift.cast());
    }
    let mut rest = balls.iter().peekable();
    while let Some(Instruction::BallAt { base, .. }) = rest.peek() {
        let mut frame = pose.transforms[base.index()];
        let mut last = *base;
        while let Some(&&Instruction::BallAt { base, output, .. }) = rest.peek()
            && base == last
        {
            frame = frame * pose.transforms[output.index()];
            pose.transforms[output.index()] = frame;
            last = output;
            rest.next();
        }
    }
}

impl Program {
    /// Computes the transforms of all segments at the requested coordinates.
    ///
    /// `requested` contains the stored numbers of all coordinates in the model's order, in radians
    /// and metres, an orientation as a quaternion x, y, z, w of any length (length 0 is the
    /// identity). Numbers for coordinates that follow others are ignored. Numbers are clamped to
    /// ±10⁹, so that no input gives a non-finite transform. Does not allocate.
    ///
    /// # Errors
    /// [`SizeMismatch`] if `requested`, or a pose made for another program, has the wrong length.
    pub fn evaluate<S: Scalar>(
        &self,
        requested: &[S],
        mode: Mode,
        pose: &mut Pose<S>,
    ) -> Result<(), SizeMismatch> {
        self.load(requested, mode, pose)?;
        for stage in &self.code.stages {
            let (scalars, transforms) = (&mut pose.scalars[..], &pose.transforms[..]);
            for instruction in &self.code.instructions[stage.scalars.clone()] {
                self.run_scalar(instruction, mode, scalars, transforms);
            }
            pose.take_turns(&self.code.turns, stage.turns.clone());
            self.run_transforms(&self.code.instructions[stage.transforms.clone()], pose);
        }
        Ok(())
    }

    /// Runs instructions that compute transforms.
    #[inline]
    fn run_transforms<S: Scalar>(&self, mut rest: &[Instruction], pose: &mut Pose<S>) {
        // The last frame, kept in registers: most chains have the previous one as their base, and
        // reading it back from memory right after writing it would cause a store-forwarding stall.
        let mut last = (self.code.identity, Affine::identity());
        while let Some(first) = rest.first() {
            // Consecutive balls together, other instructions one by one.
            let mut count = 1;
            match *first {
                Instruction::BallAt { .. } => {
                    let is_ball = |i: &Instruction| matches!(i, Instruction::BallAt { .. });
                    count = rest.iter().position(|i| !is_ball(i)).unwrap_or(rest.len());
                    run_balls(&rest[..count], pose);
                }
                Instruction::Chain { base, shift, first, end, output } => {
                    let from = if base == last.0 { last.1 } else { pose.transforms[base.index()] };
                    let from = from.shifted(shift.cast());
                    let steps = &self.code.steps[first as usize..end as usize];
                    let frame = run_chain(&self.code, steps, from, pose, &mut Silent);
                    pose.transforms[output.index()] = frame;
                    last = (output, frame);
                }
                Instruction::Contact { contact } => self.run_contact(contact, pose),
                _ => {}
            }
            rest = &rest[count..];
        }
    }

    /// Checks sizes and fills the registers that no instruction computes.
    pub(super) fn load<S: Scalar>(
        &self,
        requested: &[S],
        mode: Mode,
        pose: &mut Pose<S>,
    ) -> Result<(), SizeMismatch> {
        SizeMismatch::check("the list of coordinates", self.stored, requested.len())?;
        SizeMismatch::check("the pose's list of scalars", self.code.scalars, pose.scalars.len())?;
        SizeMismatch::check(
            "the pose's list of transforms",
            self.code.transforms,
            pose.transforms.len(),
        )?;
        // Clamped, so that no input gives a non-finite transform.
        for (value, &asked) in pose.scalars.iter_mut().zip(requested) {
            *value = finite(asked);
        }
        if mode == Mode::Posed {
            for &(register, lower, upper) in &self.limits {
                let value = &mut pose.scalars[register.index()];
                let (lower, upper) = (S::from_f64(lower), S::from_f64(upper));
                *value = value.select_less(lower, lower, *value);
                *value = upper.select_less(*value, upper, *value);
            }
        }
        // The register of a coordinate that a limit component holds will be overwritten with its
        // effective value: everything that reads the requested one reads this copy.
        for &(own, asked) in &self.asked {
            pose.scalars[asked.index()] = pose.scalars[own.index()];
        }
        for &(register, value) in &self.constants {
            pose.scalars[register.index()] = S::from_f64(value);
        }
        Ok(())
    }

    /// Runs a scalar instruction; does nothing for the others.
    #[inline(always)]
    pub(super) fn run_scalar<S: Scalar>(
        &self,
        instruction: &Instruction,
        mode: Mode,
        scalars: &mut [S],
        transforms: &[Affine<S>],
    ) {
        match *instruction {
            Instruction::Function { function, input, output } => {
                let value = self.code.functions[function as usize].apply(scalars[input.index()]);
                scalars[output.index()] = finite(value);
            }
            Instruction::Combine { function, output } => {
                let call = &self.code.combines[function as usize];
                let inputs = call.inputs.iter().map(|input| scalars[input.index()]);
                scalars[output.index()] = finite(call.function.apply_to(inputs));
            }
            Instruction::Hold { passive, lower, upper, output } => {
                let mut value = scalars[passive.index()];
                // The lower bound first: where the bounds cross, the upper one wins.
                if mode == Mode::Posed {
                    if let Some(lower) = lower {
                        let bound = scalars[lower.index()];
                        value = value.select_less(bound, bound, value);
                    }
                    if let Some(upper) = upper {
                        let bound = scalars[upper.index()];
                        value = bound.select_less(value, bound, value);
                    }
                }
                scalars[output.index()] = value;
            }
            Instruction::Limit { limit } => self.run_limit(limit, mode, scalars),
            Instruction::Orientation { frame, output } => {
                let q = Quat::from_mat3(transforms[frame.index()].linear);
                scalars[output.index()..][..4].copy_from_slice(&q.to_array());
            }
            Instruction::Position { position } => {
                let call = &self.code.positions[position as usize];
                let place = transforms[call.frame.index()] * call.point.cast();
                for (&output, along) in call.outputs.iter().zip(&call.along) {
                    scalars[output.index()] = finite(place.dot(along.cast()));
                }
            }
            Instruction::Numbers { numbers } => {
                let call = &self.code.numbers[numbers as usize];
                let Some(law) = call.law.numbers() else { return };
                let mut inputs = [S::zero(); MOST_NUMBERS];
                for (input, register) in inputs.iter_mut().zip(&call.inputs) {
                    *input = scalars[register.index()];
                }
                for (output, value) in call.outputs.iter().zip(law.values(inputs)) {
                    scalars[output.index()] = finite(value);
                }
            }
            Instruction::Contact { .. }
            | Instruction::Chain { .. }
            | Instruction::BallAt { .. } => {}
        }
    }

    /// Posed mode: moves numbers into their limit. Open mode, and for what is measured: passes them,
    /// and computes the limit rows.
    fn run_limit<S: Scalar>(&self, limit: u32, mode: Mode, scalars: &mut [S]) {
        let call = &self.code.limits[limit as usize];
        let Some(limit) = call.law.limit() else { return };
        let mut numbers = [S::zero(); MOST_LIMITED];
        let n = call.inputs.len();
        for (number, &input) in numbers.iter_mut().zip(&call.inputs) {
            *number = scalars[input.index()];
        }
        // Which side of the boundary is nearest differs from lane to lane.
        if mode == Mode::Posed && !call.measured {
            numbers = S::lane_by_lane(numbers, |asked| {
                // Constants: the derivative of a moved number is taken as 0.
                let legal = limit.legal(&asked.map(Lane::value)[..n]);
                legal.map_or(asked, |legal| legal.map(Scalar::from_f64))
            });
            // The effective posture is legal: no violation remains.
            call.rows.iter().for_each(|&row| scalars[row.index()] = S::zero());
        } else {
            let rows = S::lane_by_lane(numbers, |asked| {
                let values = &asked.map(Lane::value)[..n];
                limit.rows_at(values).map(|(value, slopes)| {
                    let slopes = stored_slopes(values, slopes, call.orientations);
                    // A row is known by value and slopes: Σ x.chain(0, slope) adds the derivatives
                    // only.
                    let terms = asked[..n].iter().zip(slopes);
                    terms.fold(Scalar::from_f64(value), |sum: S::Lane, (x, slope)| {
                        sum + x.chain(|_| (0.0, slope))
                    })
                })
            });
            for (&register, row) in call.rows.iter().zip(rows) {
                scalars[register.index()] = row;
            }
        }
        for (&output, value) in call.outputs.iter().zip(numbers) {
            scalars[output.index()] = value;
        }
    }

    /// Evaluates a contact: the transform of its two rotations, and its report.
    fn run_contact<S: Scalar>(&self, contact: u32, pose: &mut Pose<S>) {
        let call = &self.code.contacts[contact as usize];
        let drivers = call.drivers.len();
        let mut inputs = [S::zero(); 14];
        inputs[..12].copy_from_slice(&pose.transforms[call.frame.index()].to_columns());
        for (value, &driver) in inputs[12..].iter_mut().zip(&call.drivers) {
            *value = pose.scalars[driver.index()];
        }
        // How many angles there are to choose from differs from lane to lane.
        let [turns @ .., a, b, c, d] = S::lane_by_lane(inputs, |[frame @ .., first, second]| {
            let glide = call.law.glide(Affine::from_columns(frame), &[first, second][..drivers]);
            let ([a, b], [c, d]) = (glide.angles, glide.gaps);
            let mut numbers = [Scalar::zero(); 16];
            numbers[..12].copy_from_slice(&Affine::from_rotation(glide.rotation).to_columns());
            numbers[12..].copy_from_slice(&[a, b, c, d]);
            numbers
        });
        pose.transforms[call.output.index()] = Affine::from_columns(turns);
        pose.scalars[call.report.index()..][..4].copy_from_slice(&[a, b, c, d]);
    }
}
