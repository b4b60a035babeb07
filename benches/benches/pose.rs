//! Nanoseconds of one pose of a full body: `cargo bench -p condyle-benches --bench pose
//! [-- --osim FILE]`.
//!
//! Beside it two parts of the same work: one sine and cosine for each rotation that a coordinate
//! drives, and only the products of as many transforms.
#![allow(missing_docs, reason = "a benchmark has no interface")]

mod files;

use condyle_benches::bare_products::BareProducts;
use condyle_benches::{arguments, clock, full_body, table, walk};
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program};
use std::hint::black_box;

fn main() {
    let (name, model) = match arguments::path("--osim") {
        Some(path) => (path.display().to_string(), files::model(&path)),
        None => ("full body".to_owned(), full_body::model()),
    };
    let row = measure(&name, &model);
    let head = [
        "model",
        "segments",
        "coordinates",
        "ns/pose",
        "bytes/pose",
        "sines ns",
        "products ns",
        "pose/(sines+products)",
    ];
    table::print("one pose, f64, 64 poses in turn", &head, &[row]);
    println!("  target for the full body: below 3000 ns");
}

fn measure(name: &str, model: &Model) -> Vec<String> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let motion = walk::motion(model, 64);
    let time = clock::nanoseconds(|i| {
        let evaluated = program.evaluate(black_box(&motion[i % 64]), Mode::Open, &mut pose);
        assert!(black_box(evaluated).is_ok());
    });
    let turning = |&id: &_| model.coordinate(id).kind == CoordinateKind::Rotation;
    let angles: Vec<usize> =
        model.coordinate_ids().filter(turning).map(|id| model.stored_range(id).start).collect();
    let sines = clock::nanoseconds(|i| {
        for &place in &angles {
            black_box(black_box(motion[i % 64][place]).sin_cos());
        }
    });
    // A parent may be made after its child; the bound needs only as many products.
    let parents = model
        .segments()
        .iter()
        .enumerate()
        .map(|(i, segment)| segment.parent.map_or(0, |parent| (parent.index() + 1).min(i)));
    let mut bare = BareProducts::new(std::iter::once(0).chain(parents).collect());
    let products = clock::nanoseconds(|_| bare.run());
    vec![
        name.to_owned(),
        model.segments().len().to_string(),
        model.coordinates().len().to_string(),
        format!("{time:.0}"),
        pose.bytes().to_string(),
        format!("{sines:.0}"),
        format!("{products:.0}"),
        format!("{:.2}", time / (sines + products)),
    ]
}
