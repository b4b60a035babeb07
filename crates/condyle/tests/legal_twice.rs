//! Poses kept within the limits of the shipped models stay as they are when they are kept again, and their
//! coordinates alone give them.

use condyle::{CoordinateKind, Mode, Model, Motion, Pose, Program, legal, shipped};

/// Postures anywhere within the ranges, most of them outside other limits, the same at every run: a linear
/// congruential generator (Knuth's MMIX).
fn asked(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let mut state = 7u64;
    let mut unit = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    (0..count)
        .map(|_| {
            let mut frame = model.defaults();
            for id in model.coordinate_ids() {
                let coordinate = model.coordinate(id);
                if coordinate.kind == CoordinateKind::Orientation {
                    continue;
                }
                let (middle, reach) = match (coordinate.range.lower, coordinate.range.upper) {
                    (Some(low), Some(high)) => (0.5 * (low + high), 0.5 * (high - low)),
                    _ => (coordinate.default[0], 0.5),
                };
                frame[model.stored_range(id).start] = middle + reach * unit();
            }
            frame
        })
        .collect()
}

#[test]
fn a_legal_pose_stays() {
    let mut report = vec![];
    for name in shipped::names() {
        let model = shipped::read(name).expect("a shipped model").value.model;
        let program = Program::compile(&model);
        // What breaks a limit between segments is solved for, which takes a thousand times as long.
        let count = if program.measured_limit_rows().is_empty() { 300 } else { 60 };
        let frames = asked(&model, count);
        let times = (0..frames.len()).map(|i| i as f64).collect();
        let mut motion = Motion { times, frames };
        let kept = legal::keep(&model, &mut motion);
        let (mut posed, mut open) = (Pose::new(&program), Pose::new(&program));
        let mut held = model.defaults();
        let (mut moved, mut differs) = (0, 0);
        for frame in &motion.frames {
            legal::evaluate(&model, &program, frame, &mut posed).expect("sizes");
            program.evaluate(frame, Mode::Open, &mut open).expect("sizes");
            program.held(&model, &posed, &mut held);
            let ids = model.coordinate_ids().filter(|&id| model.coordinate(id).follows.is_none());
            let apart =
                ids.flat_map(|id| model.stored_range(id)).map(|k| (held[k] - frame[k]).abs());
            moved += usize::from(apart.fold(0.0, f64::max) > 1e-9);
            let places = posed.segments().iter().zip(open.segments());
            let far = places.map(|(a, b)| (a.translation - b.translation).norm());
            let far = far.fold(0.0, f64::max);
            differs += usize::from(far > 1e-7);
        }
        println!("{name}: {} solved, {} not given by their coordinates", kept.solved, kept.lost);
        if moved + differs + kept.lost > 0 {
            report.push(format!(
                "{name}: {} lost, {moved} of 300 move again, {differs} differ",
                kept.lost
            ));
        }
    }
    assert!(report.is_empty(), "{}", report.join("\n"));
}
