//! Which numbers a Jacobian holds and how they are made, settled when a program is compiled.

use super::instruction::{Code, Instruction, NO_BASE, Step};
use crate::component::Swinging;

/// Where the running sum of a twist begins.
#[derive(Clone, Copy, Debug)]
pub(super) enum Start {
    /// From nothing.
    Zero,
    /// From another twist: what the parent already does for this direction.
    From(u32),
    /// It has begun: add.
    Add,
}

/// One term of a twist: a unit motion times the derivative of the scalar that drives it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub twist: u32,
    /// Slot of ∂scalar/∂direction; slot 0 always holds 1.
    pub derivative: u32,
    pub start: Start,
}

/// One term of a scalar's derivative: ∂f/∂input · ∂input/∂direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScalarTerm {
    /// Position among the slopes that the instruction computes.
    pub slope: u32,
    pub from: u32,
    pub to: u32,
    pub first: bool,
}

/// The sparse shape of all derivatives of a code.
#[derive(Clone, Debug, Default)]
pub(super) struct DerivativePlan {
    pub tangents: usize,
    pub twists: usize,
    pub derivatives: usize,
    /// For each unit motion in the order in which chains run, how many terms it feeds.
    pub term_counts: Vec<u32>,
    pub terms: Vec<Term>,
    /// For each scalar instruction in order, how many terms it has.
    pub scalar_counts: Vec<u32>,
    pub scalar_terms: Vec<ScalarTerm>,
    /// How many scalar terms belong to instructions that are complete.
    ended: u32,
    /// For each transform register its (direction, twist) pairs, sorted by direction.
    entries: Vec<(u32, u32)>,
    entry_offsets: Vec<u32>,
    /// For each stored number its (direction, derivative slot) pairs.
    coordinate_entries: Vec<Vec<(u32, u32)>>,
    /// For each limit row its (direction, derivative slot) pairs.
    row_entries: Vec<Vec<(u32, u32)>>,
    /// Which transform registers are not rigid.
    pub deforming: Vec<bool>,
    /// For each twist the slot of its strain, or [`RIGID`]; empty where no twist has one.
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

/// Plans the derivatives of a program whose instructions are complete.
///
/// `directions` gives the register of each free coordinate (the first one of an orientation) with its
/// (first) direction.
pub(super) fn plan(
    code: &Code,
    stored: usize,
    tangents: usize,
    directions: &[(u32, u32)],
) -> DerivativePlan {
    let mut plan = DerivativePlan {
        tangents,
        derivatives: 1,
        deforming: vec![false; code.transforms],
        ..Default::default()
    };
    // (direction, slot) of every scalar register.
    let mut scalars: Vec<Vec<(u32, u32)>> = vec![vec![]; code.scalars];
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
                // Derivatives are those of open mode, where nothing is held.
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
                        let first = scalars[call.inputs[0] as usize].clone();
                        scalars[call.outputs[0] as usize] = first.clone();
                        let along = |k| first.iter().map(|&(d, slot)| (d + k, slot)).collect();
                        vec![along(0), along(1), along(2)]
                    }
                    _ => {
                        let read = |&r: &u32| scalars[r as usize].clone();
                        let inputs: Vec<_> = call.inputs.iter().map(read).collect();
                        // In open mode the angles pass: their slope is 1.
                        for (input, &output) in inputs.iter().zip(&call.outputs) {
                            scalars[output as usize] = plan.scalar(0, std::slice::from_ref(input));
                        }
                        inputs
                    }
                };
                for (row, &register) in call.rows.iter().enumerate() {
                    scalars[register as usize] = plan.scalar(1 + 3 * row, &inputs);
                }
                plan.end_scalar();
            }
            Instruction::Contact { contact } => {
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

/// A direction that moves the frame of a chain: its twist, and whether this chain has its own.
struct Moving {
    direction: u32,
    twist: u32,
    own: bool,
}

impl DerivativePlan {
    /// Derivatives of a new scalar that depends on `inputs` by as many slopes, from `first` on.
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

    /// Closes the terms of a scalar instruction.
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
