//! Which numbers a Jacobian holds and how they are made, settled when a program is compiled.

use super::instruction::{Code, Instruction, NO_BASE, Step};

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
    /// Position of the input among those of the function.
    pub input: u32,
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
    /// For each transform register its (direction, twist) pairs, sorted by direction.
    entries: Vec<(u32, u32)>,
    entry_offsets: Vec<u32>,
    /// For each stored number its (direction, derivative slot) pairs.
    coordinate_entries: Vec<Vec<(u32, u32)>>,
    /// For each limit row its (direction, derivative slot) pairs.
    row_entries: Vec<Vec<(u32, u32)>>,
}

impl DerivativePlan {
    /// The directions that move a segment, with their twists.
    #[inline]
    pub(super) fn segment_entries(&self, register: usize) -> &[(u32, u32)] {
        let [from, to] = [register, register + 1].map(|i| self.entry_offsets[i] as usize);
        &self.entries[from..to]
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
/// `coordinate_directions` gives the first direction of each stored register that is a scalar
/// coordinate, or of the first register of an orientation; `None` where a coordinate follows others.
pub(super) fn plan(
    code: &Code,
    tangents: usize,
    coordinate_directions: &[Option<u32>],
) -> DerivativePlan {
    let mut plan = DerivativePlan { tangents, derivatives: 1, ..Default::default() };
    // (direction, slot) of every scalar register.
    let mut scalars: Vec<Vec<(u32, u32)>> = vec![vec![]; code.scalars];
    for (register, direction) in coordinate_directions.iter().enumerate() {
        scalars[register].extend(direction.map(|d| (d, 0)));
    }
    let mut transforms: Vec<Vec<(u32, u32)>> = vec![vec![]; code.transforms];
    let one = [0u32];
    for instruction in &code.instructions {
        match instruction {
            Instruction::Function { input, output, .. } => {
                plan.scalar(&mut scalars, &[*input], *output);
            }
            Instruction::Hold { passive, output, .. } => {
                // Derivatives are those of open mode, where nothing is held.
                plan.scalar(&mut scalars, &[*passive], *output);
            }
            Instruction::Combine { function, output } => {
                let inputs = &code.combines[*function as usize].inputs;
                plan.scalar(&mut scalars, inputs, *output);
            }
            Instruction::BallAt { base, orientation, output, .. } => {
                let mut moving = plan.inherit(&transforms, *base);
                plan.ball(&mut moving, &scalars[*orientation as usize]);
                transforms[*output as usize] = plan.close(moving);
            }
            Instruction::Chain { base, first, end, output } => {
                let mut moving = plan.inherit(&transforms, *base);
                for step in &code.steps[*first as usize..*end as usize] {
                    match *step {
                        Step::Fixed(_) | Step::Shift(_) => {}
                        Step::TurnX(s)
                        | Step::TurnY(s)
                        | Step::TurnZ(s)
                        | Step::Turn { angle: s, .. }
                        | Step::Slide { distance: s, .. } => {
                            plan.unit(&mut moving, &scalars[s as usize]);
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
                transforms[*output as usize] = plan.close(moving);
            }
        }
    }
    plan.coordinate_entries = scalars[..coordinate_directions.len()].to_vec();
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
    fn scalar(&mut self, scalars: &mut [Vec<(u32, u32)>], inputs: &[u32], output: u32) {
        let mut made: Vec<(u32, u32)> = vec![];
        let mut count = 0;
        for (position, &input) in inputs.iter().enumerate() {
            for &(direction, from) in &scalars[input as usize] {
                let known = made.iter().find(|(d, _)| *d == direction).map(|(_, slot)| *slot);
                let to = known.unwrap_or_else(|| {
                    let slot = self.derivatives as u32;
                    self.derivatives += 1;
                    made.push((direction, slot));
                    slot
                });
                let first = known.is_none();
                self.scalar_terms.push(ScalarTerm { input: position as u32, from, to, first });
                count += 1;
            }
        }
        self.scalar_counts.push(count);
        scalars[output as usize] = made;
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

    fn close(&mut self, mut moving: Vec<Moving>) -> Vec<(u32, u32)> {
        moving.sort_by_key(|m| m.direction);
        moving.into_iter().map(|m| (m.direction, m.twist)).collect()
    }
}
