//! Nanoseconds of one quaternion ball: `cargo bench -p condyle-benches --bench ball_chain`.
//!
//! Chains of 24, 67 and 256 balls and a body of 60, one pose at a time, 64 different poses in turn;
//! beside each only the products along the same tree, of transforms computed before.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use condyle_benches::bare_products::BareProducts;
use condyle_benches::{chain, clock, table};
use condyle_model::{Mode, Pose, Program};
use std::hint::black_box;

fn main() {
    let trees = [
        ("chain of 24", chain::line(24)),
        ("chain of 67", chain::line(67)),
        ("chain of 256", chain::line(256)),
        ("body of 60", chain::body()),
    ];
    let rows = trees.map(|(name, parents)| measure(name, &parents));
    let head = ["skeleton", "ns/joint", "bare ns/joint", "ratio", "bytes/pose"];
    table::print("quaternion balls, f64", &head, &rows);
    println!("  target: below 12 ns a joint, at every length");
}

fn measure(name: &str, parents: &[usize]) -> Vec<String> {
    let joints = (parents.len() - 1) as f64;
    let model = chain::balls(parents);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let poses = chain::poses(&model, 64);
    let mut bare = BareProducts::new(parents.to_vec());
    let (mut time, mut bound) = (f64::INFINITY, f64::INFINITY);
    // Alternately, so that a disturbance affects both.
    for _ in 0..3 {
        time = time.min(clock::nanoseconds(|i| {
            let evaluated = program.evaluate(black_box(&poses[i % 64]), Mode::Open, &mut pose);
            assert!(black_box(evaluated).is_ok());
        }));
        bound = bound.min(clock::nanoseconds(|_| bare.run()));
    }
    vec![
        name.to_owned(),
        format!("{:.2}", time / joints),
        format!("{:.2}", bound / joints),
        format!("{:.2}", time / bound),
        pose.bytes().to_string(),
    ]
}
