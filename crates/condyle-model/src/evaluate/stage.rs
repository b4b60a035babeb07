//! The order in which instructions run.

use super::instruction::{Code, Stage, Step, Turn};

impl Code {
    /// Sorts the instructions into stages, keeping their order within each.
    ///
    /// A scalar that is made of coordinates alone is of stage 0, and a transform is of the highest stage
    /// of what it reads. Only a scalar that is made of a transform has to wait for the next one, so most
    /// programs have one stage.
    pub(super) fn order(&mut self) {
        let (mut numbers, mut frames) = (vec![0; self.scalars], vec![0; self.transforms]);
        let mut keys = Vec::with_capacity(self.instructions.len());
        for instruction in &self.instructions {
            let registers = instruction.registers(self);
            let of_frames = registers.read_frames.iter().map(|f| frames[f.index()]).max();
            // A contact is no scalar, though it writes some: they are there after the transforms.
            let after = usize::from(registers.frame.is_none());
            let of_frames = of_frames.map_or(0, |stage: usize| stage + after);
            let of_numbers = registers.read.iter().map(|n| numbers[n.index()]).max().unwrap_or(0);
            let stage = of_frames.max(of_numbers);
            for written in &registers.written {
                numbers[written.index()] = stage + usize::from(registers.frame.is_some());
            }
            if let Some(frame) = registers.frame {
                frames[frame.index()] = stage;
            }
            keys.push((stage, registers.frame.is_some()));
        }
        let mut order: Vec<usize> = (0..keys.len()).collect();
        order.sort_by_key(|&i| keys[i]);
        self.instructions = order.iter().map(|&i| self.instructions[i].clone()).collect();
        keys.sort();
        // The angles of a stage stand together.
        let mut turns: Vec<usize> = (0..self.turns.len()).collect();
        turns.sort_by_key(|&i| numbers[self.turns[i].index()]);
        self.renumber(&turns);
        let last = keys.last().map_or(0, |key| key.0);
        let place = |key: (usize, bool)| keys.partition_point(|k| *k < key);
        let turned = |stage: usize| self.turns.partition_point(|n| numbers[n.index()] < stage);
        self.stages = (0..=last)
            .map(|stage| Stage {
                scalars: place((stage, false))..place((stage, true)),
                turns: turned(stage)..turned(stage + 1),
                transforms: place((stage, true))..place((stage + 1, false)),
            })
            .collect();
    }

    /// Puts the turns in this order.
    fn renumber(&mut self, order: &[usize]) {
        self.turns = order.iter().map(|&i| self.turns[i]).collect();
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| places[old] = new as u32);
        for step in &mut self.steps {
            match step {
                Step::TurnX(turn)
                | Step::TurnY(turn)
                | Step::TurnZ(turn)
                | Step::TurnAbout { turn, .. } => *turn = Turn(places[turn.0 as usize]),
                _ => {}
            }
        }
    }
}
