//! Nanoseconds of one pose with all its derivatives: `cargo bench -p condyle-benches --bench
//! jacobian [-- --osim FILE]`. The bound is the pose alone.
#![allow(missing_docs, reason = "a benchmark has no interface")]

mod files;

use condyle_benches::{arguments, chain, clock, full_body, table, walk};
use condyle_model::{Jacobian, Mode, Model, Pose, Program};
use std::hint::black_box;

fn main() {
    let mut rows = vec![];
    if let Some(path) = arguments::path("--osim") {
        let model = files::model(&path);
        rows.push(measure(&path.display().to_string(), &model, &walk::motion(&model, 64)));
    } else {
        let body = full_body::model();
        rows.push(measure("full body", &body, &walk::motion(&body, 64)));
        let balls = chain::balls(&chain::body());
        rows.push(measure("60 balls", &balls, &chain::poses(&balls, 64)));
    }
    let head = ["model", "directions", "pairs", "ns", "ns/pair", "pose ns", "ratio"];
    table::print("pose and Jacobian, f64", &head, &rows);
    println!("  a pair is a segment and a direction that moves it");
}

fn measure(name: &str, model: &Model, motion: &[Vec<f64>]) -> Vec<String> {
    let program = Program::compile(model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let pairs: usize = model.segment_ids().map(|id| program.segment_directions(id).len()).sum();
    let (mut time, mut bound) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..3 {
        time = time.min(clock::nanoseconds(|i| {
            let stored = black_box(&motion[i % 64]);
            let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
            assert!(black_box(evaluated).is_ok());
        }));
        bound = bound.min(clock::nanoseconds(|i| {
            let evaluated = program.evaluate(black_box(&motion[i % 64]), Mode::Open, &mut pose);
            assert!(black_box(evaluated).is_ok());
        }));
    }
    vec![
        name.to_owned(),
        program.tangent_len().to_string(),
        pairs.to_string(),
        format!("{time:.0}"),
        format!("{:.2}", time / pairs as f64),
        format!("{bound:.0}"),
        format!("{:.2}", time / bound),
    ]
}
