//! Nanoseconds of every kind of joint: `cargo bench -p condyle-benches --bench components`.
//!
//! Lines of 24 joints of one kind, 64 different poses in turn, per joint: one pose in posed mode, and
//! one with its Jacobian; beside them only the product of a transform computed before. Then a whole
//! shoulder. With a name as an argument only the kinds whose names contain it are measured.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use condyle_benches::bare_products::BareProducts;
use condyle_benches::{chain, clock, joints, shoulder, table};
use condyle_model::{Jacobian, Mode, Model, Pose, Program};
use std::hint::black_box;

const JOINTS: usize = 24;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let named = |name: &str| wanted.is_empty() || wanted.iter().any(|w| name.contains(w));
    let mut rows = vec![];
    for kind in joints::kinds().iter().filter(|kind| named(kind.name)) {
        let model = joints::line(kind, JOINTS);
        let [posed, open, jacobian] = measure(&model).map(|time| time / JOINTS as f64);
        let mut bare = BareProducts::new(chain::line(JOINTS));
        let bound = clock::nanoseconds(|_| bare.run()) / JOINTS as f64;
        let target = if kind.simple { "20" } else { "" };
        let cells = [posed, open, jacobian, bound, posed / bound];
        let mut row = vec![kind.name.to_owned()];
        row.extend(cells.map(|x| format!("{x:.1}")));
        row.push(target.to_owned());
        rows.push(row);
    }
    let head = ["joint", "posed ns", "open ns", "Jacobian ns", "bare ns", "ratio", "target ns"];
    table::print("every kind of joint, f64, per joint", &head, &rows);
    if named("shoulder") {
        let model = shoulder::network();
        let [posed, open, jacobian] = measure(&model);
        println!(
            "a shoulder of {} components: {posed:.0} ns posed, {open:.0} ns open, {jacobian:.0} ns with its Jacobian (target: 1000)",
            model.components().len()
        );
    }
}

/// One pose in posed and in open mode, and one with its Jacobian.
fn measure(model: &Model) -> [f64; 3] {
    let program = Program::compile(model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let poses = joints::poses(model, 64);
    let [posed, open] = [Mode::Posed, Mode::Open].map(|mode| {
        clock::nanoseconds(|i| {
            let done = program.evaluate(black_box(&poses[i % 64]), mode, &mut pose);
            assert!(black_box(done).is_ok());
        })
    });
    let with = clock::nanoseconds(|i| {
        let done =
            program.evaluate_with_jacobian(black_box(&poses[i % 64]), &mut pose, &mut jacobian);
        assert!(black_box(done).is_ok());
    });
    [posed, open, with]
}
