//! The sparsity pattern of a Jacobian and the order of its terms, determined when a program is
//! compiled.
//!
//! The plan walks the instructions in the order in which they run. For every scalar it records
//! which directions (tangents of the coordinates) it depends on, with a slot for each derivative;
//! for every transform which directions move it, with the index of each twist. Each instruction has its
//! own terms, which evaluation reads without a search: the motions of a step are those of its
//! [drivers](Step::drivers), in their order.

#[cfg(doc)]
use super::instruction::Step;
use super::instruction::{Code, Driver, Frame, Instruction, Number};
use crate::component::MOST_NUMBERS;
use crate::limit::MOST_LIMITED;
use std::ops::Range;
use std::slice::Iter;

/// The initial value of the sum to which a term is added.
#[derive(Clone, Copy, Debug)]
pub(super) enum Start {
    /// Zero: the first term, in a direction that does not move the base.
    Zero,
    /// Another twist, that of the base in this direction: the first term of this chain.
    From(u32),
    /// The twist itself: a later term.
    Add,
}

/// One term of a twist: a unit motion times the derivative of the scalar that drives it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub twist: u32,
    /// The slot of ∂scalar/∂direction; slot 0 always contains 1.
    pub derivative: u32,
    pub start: Start,
}

/// One term of a scalar's derivative: ∂f/∂input · ∂input/∂direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScalarTerm {
    /// The position among the partial derivatives that the instruction computes.
    pub slope: u32,
    pub from: u32,
    pub to: u32,
    pub first: bool,
}

/// The sparsity pattern of all derivatives of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct DerivativePlan {
    pub tangents: usize,
    pub twists: usize,
    pub derivatives: usize,
    /// For each instruction its first unit motion and its first term.
    motions: Vec<(u32, u32)>,
    /// For each unit motion the number of its terms.
    counts: Vec<u32>,
    terms: Vec<Term>,
    /// For each instruction where its scalar terms begin; one entry more than there are.
    scalar_offsets: Vec<u32>,
    scalar_terms: Vec<ScalarTerm>,
    /// The (direction, twist) pairs of all transform registers, sorted by direction within each;
    /// register i has those from `entry_offsets[i]` up to `entry_offsets[i + 1]`.
    entries: Vec<(u32, u32)>,
    entry_offsets: Vec<u32>,
    /// For each stored number its (direction, derivative slot) pairs.
    coordinate_entries: Vec<Vec<(u32, u32)>>,
    /// For each limit row its (direction, derivative slot) pairs.
    row_entries: Vec<Vec<(u32, u32)>>,
    /// For each transform register whether it is not rigid.
    pub deforming: Vec<bool>,
    /// For each twist the slot of its strain, if it has one; twists beyond its end have none.
    strain_slots: Vec<Option<u32>>,
    pub strains: usize,
}

impl DerivativePlan {
    /// The directions that move a transform, with their twists.
    #[inline]
    pub(super) fn frame_entries(&self, frame: Frame) -> &[(u32, u32)] {
        &self.entries[between(&self.entry_offsets, frame.index())]
    }

    /// The numbers of terms of the unit motions of an instruction and of those after it, and the terms.
    #[inline(always)]
    pub(super) fn motions(&self, instruction: usize) -> (Iter<'_, u32>, Iter<'_, Term>) {
        let (unit, term) = self.motions[instruction];
        (self.counts[unit as usize..].iter(), self.terms[term as usize..].iter())
    }

    /// The terms of the scalars that an instruction computes.
    #[inline(always)]
    pub(super) fn scalar_terms(&self, instruction: usize) -> &[ScalarTerm] {
        &self.scalar_terms[between(&self.scalar_offsets, instruction)]
    }

    /// The slot of a twist's strain, if it has one.
    #[inline(always)]
    pub(super) fn strain_slot(&self, twist: u32) -> Option<usize> {
        self.strain_slots.get(twist as usize).copied().flatten().map(|slot| slot as usize)
    }

    /// The directions that move a limit row, with the slots of its derivatives.
    pub(super) fn row_entries(&self, row: usize) -> &[(u32, u32)] {
        &self.row_entries[row]
    }

    /// The directions that move a stored number, with the slots of its derivatives.
    pub(super) fn coordinate_entries(&self, register: usize) -> &[(u32, u32)] {
        &self.coordinate_entries[register]
    }
}

#[inline(always)]
fn between(offsets: &[u32], i: usize) -> Range<usize> {
    offsets[i] as usize..offsets[i + 1] as usize
}

/// Plans the derivatives of the instructions of a program, in their final order.
///
/// `directions` gives the register of each free coordinate (the first one of an orientation) with its
/// (first) direction.
pub(super) fn plan(
    code: &Code,
    stored: usize,
    tangents: usize,
    directions: &[(Number, u32)],
) -> DerivativePlan {
    // One derivative from the start: slot 0, the constant 1.
    let mut plan = DerivativePlan {
        tangents,
        derivatives: 1,
        deforming: vec![false; code.transforms],
        ..Default::default()
    };
    // (direction, slot) of every scalar register.
    let mut scalars: Vec<Vec<(u32, u32)>> = vec![vec![]; code.scalars];
    // A free coordinate has the derivative 1 in its own direction: slot 0. The first three registers of
    // an orientation stand for its tangents.
    for &(register, direction) in directions {
        scalars[register.index()].push((direction, 0));
    }
    let mut transforms: Vec<Vec<(u32, u32)>> = vec![vec![]; code.transforms];
    for instruction in &code.instructions {
        plan.scalar_offsets.push(plan.scalar_terms.len() as u32);
        plan.motions.push((plan.counts.len() as u32, plan.terms.len() as u32));
        match instruction {
            Instruction::Function { input, output, .. } => {
                scalars[output.index()] = plan.scalar(0, &[scalars[input.index()].clone()]);
            }
            Instruction::Hold { passive, output, .. } => {
                // Derivatives are those of open mode, where the value passes unchanged.
                scalars[output.index()] = plan.scalar(0, &[scalars[passive.index()].clone()]);
            }
            Instruction::Combine { function, output } => {
                let inputs = &code.combines[*function as usize].inputs;
                let inputs: Vec<_> = inputs.iter().map(|&r| scalars[r.index()].clone()).collect();
                scalars[output.index()] = plan.scalar(0, &inputs);
            }
            Instruction::Limit { limit } => {
                let call = &code.limits[*limit as usize];
                // An orientation has three tangents, in its first three registers.
                let turned = 4 * call.orientations;
                let moves = |k: usize| k >= turned || k % 4 < 3;
                let read = |(_, r): (usize, &Number)| scalars[r.index()].clone();
                let inputs = call.inputs.iter().enumerate().filter(|(k, _)| moves(*k));
                let inputs: Vec<_> = inputs.map(read).collect();
                // In open mode the numbers pass unchanged: their derivative, at position 0, is 1.
                let held = if call.orientations > 0 { 3 } else { call.outputs.len() };
                for (input, &output) in inputs.iter().zip(&call.outputs).take(held) {
                    scalars[output.index()] = plan.scalar(0, std::slice::from_ref(input));
                }
                // After it the derivatives of each row.
                for (row, &register) in call.rows.iter().enumerate() {
                    scalars[register.index()] = plan.scalar(1 + MOST_LIMITED * row, &inputs);
                }
            }
            Instruction::Orientation { frame, output } => {
                for k in 0..3 {
                    let register = Number(output.0 + k).index();
                    scalars[register] = plan.measured(&transforms[frame.index()], k, 3);
                }
            }
            Instruction::Position { position } => {
                let call = &code.positions[*position as usize];
                let n = call.outputs.len() as u32;
                for (k, output) in (0..n).zip(&call.outputs) {
                    let moving = &transforms[call.frame.index()];
                    scalars[output.index()] = plan.measured(moving, k, n);
                }
            }
            Instruction::Numbers { numbers } => {
                let call = &code.numbers[*numbers as usize];
                // An orientation has three tangents, in its first three registers.
                let count = if call.orientation { 3 } else { call.inputs.len() };
                let read = |r: &Number| scalars[r.index()].clone();
                let inputs: Vec<_> = call.inputs[..count].iter().map(read).collect();
                for (k, output) in call.outputs.iter().enumerate() {
                    scalars[output.index()] = plan.scalar(MOST_NUMBERS * k, &inputs);
                }
            }
            Instruction::Contact { contact } => {
                let call = &code.contacts[*contact as usize];
                let mut moving = vec![];
                plan.units(&mut moving, Driver::Frame(call.frame), &scalars, &transforms);
                for &driver in &call.drivers {
                    plan.units(&mut moving, Driver::Number(driver), &scalars, &transforms);
                }
                transforms[call.output.index()] = plan.close(moving, false, call.output);
                if call.bounded {
                    // The directions of the frame, then the drivers; for each gap.
                    let own = transforms[call.frame.index()].iter().map(|&(d, _)| vec![(d, 0)]);
                    let driven = call.drivers.iter().map(|driver| scalars[driver.index()].clone());
                    let inputs: Vec<_> = own.chain(driven).collect();
                    for gap in 0..2 {
                        let register = Number(call.report.0 + 2 + gap).index();
                        scalars[register] = plan.scalar(gap as usize * inputs.len(), &inputs);
                    }
                }
            }
            Instruction::BallAt { base, orientation, output, .. } => {
                let mut moving = inherit(&transforms[base.index()]);
                let deforming = plan.deforming[base.index()];
                let driver = Driver::Orientation(*orientation);
                plan.units(&mut moving, driver, &scalars, &transforms);
                transforms[output.index()] = plan.close(moving, deforming, *output);
            }
            Instruction::Chain { base, first, end, output, .. } => {
                let mut moving = inherit(&transforms[base.index()]);
                let mut deforming = plan.deforming[base.index()];
                for step in &code.steps[*first as usize..*end as usize] {
                    let (drivers, deforms) = step.drivers(code);
                    deforming |= deforms;
                    for driver in drivers {
                        // Everything after the first step that is not rigid is not rigid either.
                        if let Driver::Frame(frame) = driver {
                            deforming |= plan.deforming[frame.index()];
                        }
                        plan.units(&mut moving, driver, &scalars, &transforms);
                    }
                }
                transforms[output.index()] = plan.close(moving, deforming, *output);
            }
        }
    }
    plan.scalar_offsets.push(plan.scalar_terms.len() as u32);
    plan.coordinate_entries = scalars[..stored].to_vec();
    plan.row_entries = code.rows.iter().map(|&r| scalars[r.index()].clone()).collect();
    plan.entry_offsets.push(0);
    for list in transforms {
        plan.entries.extend(list);
        plan.entry_offsets.push(plan.entries.len() as u32);
    }
    plan
}

/// A direction that moves the frame of a chain: its twist, and whether that belongs to this chain
/// or is shared with the base.
struct Moving {
    direction: u32,
    twist: u32,
    own: bool,
}

/// The motions that a chain has from its base.
fn inherit(base: &[(u32, u32)]) -> Vec<Moving> {
    base.iter().map(|&(direction, twist)| Moving { direction, twist, own: false }).collect()
}

impl DerivativePlan {
    /// Plans the derivatives of a new scalar that depends on `inputs`: ∂f/∂inputs[i] is at position
    /// `first + i` of the derivatives that the instruction computes. Returns (direction, slot)
    /// pairs.
    fn scalar(&mut self, first: usize, inputs: &[Vec<(u32, u32)>]) -> Vec<(u32, u32)> {
        let mut made: Vec<(u32, u32)> = vec![];
        for (position, input) in inputs.iter().enumerate() {
            let slope = (first + position) as u32;
            for &(direction, from) in input {
                let known = made.iter().find(|(d, _)| *d == direction).map(|(_, slot)| *slot);
                let to = known.unwrap_or_else(|| {
                    let slot = self.derivatives as u32;
                    self.derivatives += 1;
                    made.push((direction, slot));
                    slot
                });
                let first = known.is_none();
                self.scalar_terms.push(ScalarTerm { slope, from, to, first });
            }
        }
        made
    }

    /// Plans the derivatives of one of `count` scalars that are measured on a moving transform: that
    /// along its i-th direction is at position `count`·i + `number`.
    fn measured(&mut self, moving: &[(u32, u32)], number: u32, count: u32) -> Vec<(u32, u32)> {
        let mut made = vec![];
        for (i, &(direction, _)) in moving.iter().enumerate() {
            let to = self.derivatives as u32;
            self.derivatives += 1;
            let slope = i as u32 * count + number;
            self.scalar_terms.push(ScalarTerm { slope, from: 0, to, first: true });
            made.push((direction, to));
        }
        made
    }

    /// Plans the motions of a driver.
    fn units(
        &mut self,
        moving: &mut Vec<Moving>,
        driver: Driver,
        scalars: &[Vec<(u32, u32)>],
        transforms: &[Vec<(u32, u32)>],
    ) {
        match driver {
            Driver::Number(number) => self.unit(moving, &scalars[number.index()]),
            // A constant orientation has no dependencies but still three motions.
            Driver::Orientation(first) => {
                for axis in 0..3 {
                    self.unit(moving, &scalars[Number(first.0 + axis).index()]);
                }
            }
            // Generators of the earlier transform, each already that of one direction.
            Driver::Frame(frame) => {
                for &(direction, _) in &transforms[frame.index()] {
                    self.unit(moving, &[(direction, 0)]);
                }
            }
        }
    }

    fn unit(&mut self, moving: &mut Vec<Moving>, dependencies: &[(u32, u32)]) {
        for &(direction, derivative) in dependencies {
            let known = moving.iter_mut().find(|m| m.direction == direction);
            let (twist, start) = match known {
                Some(m) if m.own => (m.twist, Start::Add),
                // Copy on write: the twist of the base stays as it is, for other children.
                Some(m) => {
                    let start = Start::From(m.twist);
                    *m = Moving { direction, twist: self.twists as u32, own: true };
                    self.twists += 1;
                    (m.twist, start)
                }
                None => {
                    let twist = self.twists as u32;
                    self.twists += 1;
                    moving.push(Moving { direction, twist, own: true });
                    (twist, Start::Zero)
                }
            };
            self.terms.push(Term { twist, derivative, start });
        }
        self.counts.push(dependencies.len() as u32);
    }

    fn close(
        &mut self,
        mut moving: Vec<Moving>,
        deforming: bool,
        output: Frame,
    ) -> Vec<(u32, u32)> {
        self.deforming[output.index()] = deforming;
        // Twists shared with the base keep the slots they have, if any.
        if deforming {
            self.strain_slots.resize(self.twists, None);
            for own in moving.iter().filter(|m| m.own) {
                self.strain_slots[own.twist as usize] = Some(self.strains as u32);
                self.strains += 1;
            }
        }
        moving.sort_by_key(|m| m.direction);
        moving.into_iter().map(|m| (m.direction, m.twist)).collect()
    }
}
