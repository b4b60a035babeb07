//! Nanoseconds of a learned limit's answers: `cargo bench -p condyle-benches --bench limits`.
//!
//! A limit with a hole, of 5000 samples at 96 nodes along an edge, asked about uniform rotations, which no cache
//! holds, and about a motion; beside a bare sum of 64 numbers of such a grid. Then seconds of learning.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use condyle_benches::random::Random;
use condyle_benches::{clock, limits, table};
use condyle_math::Quat;
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let field = limits::field(&limits::cloud(5000), 96);
    let mut random = Random::new(5);
    let uniform: Vec<Quat> = (0..1 << 16).map(|_| limits::rotation(&mut random)).collect();
    let motion = limits::motion(1 << 16);
    let near = |q: &Quat| (-0.2..0.0).contains(&field.distance(*q));
    let outside = |all: &[Quat]| -> Vec<Quat> {
        let kept: Vec<Quat> = all.iter().copied().filter(near).collect();
        kept.into_iter().cycle().take(1 << 14).collect()
    };
    let bare = limits::BareSpline::new();
    let bound = clock::nanoseconds(|i| {
        black_box(bare.run(black_box(i)));
    });
    type Ask<'a> = (&'a str, &'a dyn Fn(Quat) -> f64, f64);
    let asks: [Ask<'_>; 3] = [
        ("state and distance", &|q| field.state(q).1, 100.0),
        ("distance and gradient", &|q| field.distance_and_gradient(q).1.x, 200.0),
        ("state, distance and evidence", &|q| field.state_with_evidence(q).2.angle, 300.0),
    ];
    let mut rows = vec![];
    let mut row = |name: &str, queries: [&[Quat]; 2], ask: &dyn Fn(Quat) -> f64, target: f64| {
        let [a, b] = queries.map(|queries| {
            clock::nanoseconds(|i| {
                black_box(ask(black_box(queries[i % queries.len()])));
            })
        });
        let cells = [a, b, a / bound, target].map(|x| format!("{x:.1}"));
        rows.push(std::iter::once(name.to_owned()).chain(cells).collect());
    };
    for (name, ask, target) in asks {
        row(name, [&uniform, &motion], ask, target);
    }
    let (far, close) = (outside(&uniform), outside(&motion));
    row("nearest, up to 11° outside", [&far, &close], &|q| field.nearest(q).x, 1000.0);
    let head = ["what", "uniform ns", "motion ns", "uniform / bare sum", "target ns"];
    table::print("a learned limit with a hole", &head, &rows);
    println!("a bare sum of 64 numbers: {bound:.1} ns");
    for count in [5000, 30_000] {
        let cloud = limits::cloud(count);
        let start = Instant::now();
        black_box(limits::field(&cloud, 96));
        println!("learning {count} samples: {:.2} s (target: 5)", start.elapsed().as_secs_f64());
    }
}
