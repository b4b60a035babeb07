//! The kernels whose instructions are counted.

use crate::{chain, full_body, walk};
use condyle_model::{Jacobian, Mode, Pose, Program};
use condyle_track::{MarkerTarget, Rules, Scratch, Targets, Tracker};
use std::hint::black_box;

/// A kernel by name.
pub struct Kernel {
    /// Its name.
    pub name: &'static str,
    /// How often to run it for a stable count: a multiple of the number of its inputs.
    pub repeats: usize,
    /// Runs it that often.
    pub run: fn(usize),
}

/// All kernels.
pub const KERNELS: [Kernel; 5] = [
    Kernel { name: "pose_full_body", repeats: 1280, run: pose_full_body },
    Kernel { name: "jacobian_full_body", repeats: 1280, run: jacobian_full_body },
    Kernel { name: "ball_chain_64", repeats: 1280, run: ball_chain_64 },
    Kernel { name: "track_frame", repeats: 256, run: track_frame },
    Kernel { name: "spline", repeats: 25_600, run: spline },
];

fn pose_full_body(repeats: usize) {
    let model = full_body::model();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let motion = walk::motion(&model, 64);
    for i in 0..repeats {
        let evaluated = program.evaluate(black_box(&motion[i % 64]), Mode::Open, &mut pose);
        assert!(black_box(evaluated).is_ok());
    }
}

fn jacobian_full_body(repeats: usize) {
    let model = full_body::model();
    let program = Program::compile(&model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let motion = walk::motion(&model, 64);
    for i in 0..repeats {
        let stored = black_box(&motion[i % 64]);
        let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
        assert!(black_box(evaluated).is_ok());
    }
}

fn ball_chain_64(repeats: usize) {
    let model = chain::balls(&chain::line(64));
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let poses = chain::poses(&model, 64);
    for i in 0..repeats {
        let evaluated = program.evaluate(black_box(&poses[i % 64]), Mode::Open, &mut pose);
        assert!(black_box(evaluated).is_ok());
    }
}

/// One frame of a noisy walk, started from the frame before it.
fn track_frame(repeats: usize) {
    let model = full_body::model();
    let motion = walk::motion(&model, 65);
    let recorded = walk::recorded(&model, &motion, 0.002);
    let markers = (0..model.markers().len()).map(|marker| MarkerTarget { marker, weight: 1.0 });
    let targets = Targets { markers: markers.collect(), ..Targets::default() };
    let tracker = Tracker::new(model, targets, Rules::default());
    let mut scratch = Scratch::new(&tracker);
    for i in 0..repeats {
        let frame = i % 64;
        let answer =
            tracker.solve_frame(&mut scratch, &recorded[frame + 1], frame + 1, &motion[frame]);
        assert!(black_box(answer).status.is_solved());
    }
}

fn spline(repeats: usize) {
    let spline = full_body::spline();
    for i in 0..repeats {
        black_box(spline.value_and_slope(black_box(-0.3 + 0.01 * (i % 256) as f64)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_runs() {
        KERNELS.iter().for_each(|kernel| (kernel.run)(2));
    }
}
