//! The kernels whose instructions are counted.

use crate::{chain, full_body, limits, walk};
use condyle_learn::limits::Field;
use condyle_math::Quat;
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
pub const KERNELS: [Kernel; 10] = [
    Kernel { name: "pose_full_body", repeats: 1280, run: pose_full_body },
    Kernel { name: "jacobian_full_body", repeats: 1280, run: jacobian_full_body },
    Kernel { name: "ball_chain_64", repeats: 1280, run: ball_chain_64 },
    Kernel { name: "track_frame", repeats: 256, run: track_frame },
    Kernel { name: "limit_state", repeats: 25_600, run: limit_state },
    Kernel { name: "limit_gradient", repeats: 25_600, run: limit_gradient },
    Kernel { name: "limit_evidence", repeats: 25_600, run: limit_evidence },
    Kernel { name: "limit_nearest", repeats: 12_800, run: limit_nearest },
    Kernel { name: "limit_learn", repeats: 2, run: limit_learn },
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

/// Frames of a motion that goes in and out of a limit; fewer nodes than usual, for a shorter start.
fn ask(repeats: usize, keep: impl Fn(&Field, Quat) -> bool, ask: impl Fn(&Field, Quat)) {
    let field = limits::field(&limits::cloud(400), 32);
    let motion = limits::motion(640).into_iter().filter(|q| keep(&field, *q));
    for q in motion.collect::<Vec<_>>().iter().cycle().take(repeats) {
        ask(&field, black_box(*q));
    }
}

fn limit_state(repeats: usize) {
    ask(
        repeats,
        |_, _| true,
        |field, q| {
            black_box(field.state(q));
        },
    );
}

fn limit_gradient(repeats: usize) {
    ask(
        repeats,
        |_, _| true,
        |field, q| {
            black_box(field.distance_and_gradient(q));
        },
    );
}

fn limit_evidence(repeats: usize) {
    ask(
        repeats,
        |_, _| true,
        |field, q| {
            black_box(field.state_with_evidence(q));
        },
    );
}

/// What is outside by up to 11 degrees.
fn limit_nearest(repeats: usize) {
    ask(
        repeats,
        |field, q| (-0.2..0.0).contains(&field.distance(q)),
        |field, q| {
            black_box(field.nearest(q));
        },
    );
}

fn limit_learn(repeats: usize) {
    let cloud = limits::cloud(400);
    for _ in 0..repeats {
        black_box(limits::field(black_box(&cloud), 32));
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
