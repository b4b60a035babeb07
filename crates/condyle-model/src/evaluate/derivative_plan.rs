//! The sparsity pattern of a Jacobian and the order of its terms, determined when a program is
//! compiled.
//!
//! The plan walks the instructions in the order in which they run. For every scalar it records
//! which directions (tangents of the coordinates) it depends on, with a slot for each derivative;
//! for every transform which directions move it, with the index of each twist. Evaluation then
//! reads the terms in sequence, without a search.

use super::instruction::{Code, Instruction, NO_BASE, Step};
use crate::component::Swinging;

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
    /// For each unit motion in the order in which chains run, the number of its terms.
    pub term_counts: Vec<u32>,
    pub terms: Vec<Term>,
    /// For each scalar instruction in order, the number of its terms.
    pub scalar_counts: Vec<u32>,
    pub scalar_terms: Vec<ScalarTerm>,
    /// The number of scalar terms of completed instructions.
    ended: u32,
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
    /// For each twist the slot of its strain, or [`RIGID`]; twists beyond its end have none.
    strain_slots: Vec<u32>,
    pub strains: usize,
}

/// Marks a twist without a strain.
pub(super) const RIGID: u32 = u32::MAX;

impl DerivativePlan {
    /// The directions that move a segment, with their twists.
    #[inline]
    pub(super) fn segment_entries(&self, register: usize) -> &[(u32, u32)] {
        let [from, to] = [register, register + 1].map(|i| self.entry_offsets[i] as usize);
        &self.entries[from..to]
    }

    /// The slot of a twist's strain, if it has one.
    #[inline(always)]
    pub(super) fn strain_slot(&self, twist: u32) -> Option<usize> {
        match self.strain_slots.get(twist as usize) {
            Some(&slot) if slot != RIGID => Some(slot as usize),
            _ => None,
        }
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

/// Plans the derivatives of the instructions of a program, in their final order.
///
/// `directions` gives the register of each free coordinate (the first one of an orientation) with its
/// (first) direction.
pub(super) fn plan(
    code: &Code,
    stored: usize,
    tangents: usize,
    directions: &[(u32, u32)],
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
    // A free coordinate has the derivative 1 in its own direction: slot 0.
    for &(register, direction) in directions {
        scalars[register as usize].push((direction, 0));
    }
    let mut transforms: Vec<Vec<(u32, u32)>> = vec![vec![]; code.transforms];
    let one = [0u32];
    for instruction in &code.instructions {
        match instruction {
            Instruction::Function { input, output, .. } => {
                let inputs = [scalars[*input as usize].clone()];
                scalars[*output as usize] = plan.scalar(0, &inputs);
                plan.end_scalar();
            }
            Instruction::Hold { passive, output, .. } => {
                // Derivatives are those of open mode, where the value passes unchanged.
                let inputs = [scalars[*passive as usize].clone()];
                scalars[*output as usize] = plan.scalar(0, &inputs);
                plan.end_scalar();
            }
            Instruction::Combine { function, output } => {
                let inputs = &code.combines[*function as usize].inputs;
                let inputs: Vec<_> = inputs.iter().map(|&r| scalars[r as usize].clone()).collect();
                scalars[*output as usize] = plan.scalar(0, &inputs);
                plan.end_scalar();
            }
            Instruction::Cone { cone } => {
                let call = &code.cones[*cone as usize];
                let inputs: Vec<Vec<(u32, u32)>> = match call.component.of {
                    Swinging::Orientation(_) => {
                        // The register of x stands for all four numbers and their three directions.
                        let first = scalars[call.inputs[0] as usize].clone();
                        scalars[call.outputs[0] as usize] = first.clone();
                        let along = |k| first.iter().map(|&(d, slot)| (d + k, slot)).collect();
                        vec![along(0), along(1), along(2)]
                    }
                    _ => {
                        let read = |&r: &u32| scalars[r as usize].clone();
                        let inputs: Vec<_> = call.inputs.iter().map(read).collect();
                        // In open mode the angles pass unchanged: their derivative, at position 0,
                        // is 1.
                        for (input, &output) in inputs.iter().zip(&call.outputs) {
                            scalars[output as usize] = plan.scalar(0, std::slice::from_ref(input));
                        }
                        inputs
                    }
                };
                // Three derivatives for each row, after that of the angles.
                for (row, &register) in call.rows.iter().enumerate() {
                    scalars[register as usize] = plan.scalar(1 + 3 * row, &inputs);
                }
                plan.end_scalar();
            }
            Instruction::Contact { contact } => {
                // The order of the units here and below is that of the calls of `Tape::emit`.
                let call = &code.contacts[*contact as usize];
                let mut moving = vec![];
                for (direction, _) in &transforms[call.frame as usize] {
                    plan.unit(&mut moving, &[(*direction, 0)]);
                }
                for driver in &call.drivers {
                    plan.unit(&mut moving, &scalars[*driver as usize]);
                }
                transforms[call.output as usize] = plan.close(moving, false, call.output);
            }
            Instruction::BallAt { base, orientation, output, .. } => {
                let mut moving = plan.inherit(&transforms, *base);
                let deforming = plan.deforms(*base);
                plan.ball(&mut moving, &scalars[*orientation as usize]);
                transforms[*output as usize] = plan.close(moving, deforming, *output);
            }
            Instruction::Chain { base, first, end, output, .. } => {
                let mut moving = plan.inherit(&transforms, *base);
                let mut deforming = plan.deforms(*base);
                for step in &code.steps[*first as usize..*end as usize] {
                    // Everything after the first step that is not rigid is not rigid either.
                    deforming |= !step.is_rigid(code, |register| !plan.deforms(register));
                    match *step {
                        Step::Fixed(_) | Step::Shift(_) => {}
                        Step::TurnX(turn)
                        | Step::TurnY(turn)
                        | Step::TurnZ(turn)
                        | Step::Turn { turn, .. } => {
                            plan.unit(&mut moving, &scalars[code.turns[turn as usize] as usize]);
                        }
                        Step::Slide { distance: s, .. }
                        | Step::Stretch { factor: s, .. }
                        | Step::Shear { amount: s, .. } => {
                            plan.unit(&mut moving, &scalars[s as usize]);
                        }
                        Step::Move(distances) => {
                            for distance in distances {
                                plan.unit(&mut moving, &scalars[distance as usize]);
                            }
                        }
                        Step::Ball(s) => plan.ball(&mut moving, &scalars[s as usize]),
                        Step::Law(index) => {
                            for input in &code.laws[index as usize].inputs {
                                plan.unit(&mut moving, &scalars[*input as usize]);
                            }
                        }
                        // Generators of the earlier transform, each already that of one direction.
                        Step::Transform(register) | Step::Power { of: register, .. } => {
                            for (direction, _) in &transforms[register as usize] {
                                plan.unit(&mut moving, &one.map(|slot| (*direction, slot)));
                            }
                        }
                    }
                }
                transforms[*output as usize] = plan.close(moving, deforming, *output);
            }
        }
    }
    plan.coordinate_entries = scalars[..stored].to_vec();
    plan.row_entries = code.rows.iter().map(|&r| scalars[r as usize].clone()).collect();
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

    /// Ends the terms of a scalar instruction.
    fn end_scalar(&mut self) {
        let all = self.scalar_terms.len() as u32;
        self.scalar_counts.push(all - std::mem::replace(&mut self.ended, all));
    }

    fn inherit(&self, transforms: &[Vec<(u32, u32)>], base: u32) -> Vec<Moving> {
        if base == NO_BASE {
            return vec![];
        }
        transforms[base as usize]
            .iter()
            .map(|&(direction, twist)| Moving { direction, twist, own: false })
            .collect()
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
        self.term_counts.push(dependencies.len() as u32);
    }

    fn ball(&mut self, moving: &mut Vec<Moving>, dependencies: &[(u32, u32)]) {
        // The three directions of an orientation are consecutive. A constant one has no
        // dependencies but still three units, because the chain records three motions.
        for axis in 0..3 {
            match dependencies.first() {
                Some(&(direction, slot)) => self.unit(moving, &[(direction + axis, slot)]),
                None => self.unit(moving, &[]),
            }
        }
    }

    fn deforms(&self, register: u32) -> bool {
        register != NO_BASE && self.deforming[register as usize]
    }

    fn close(&mut self, mut moving: Vec<Moving>, deforming: bool, output: u32) -> Vec<(u32, u32)> {
        self.deforming[output as usize] = deforming;
        // Twists shared with the base keep the slots they have, if any.
        if deforming {
            self.strain_slots.resize(self.twists, RIGID);
            for own in moving.iter().filter(|m| m.own) {
                self.strain_slots[own.twist as usize] = self.strains as u32;
                self.strains += 1;
            }
        }
        moving.sort_by_key(|m| m.direction);
        moving.into_iter().map(|m| (m.direction, m.twist)).collect()
    }
}
