//! How good learned limits are where the truth is known: `cargo run --release -p condyle-learn --example field`.
//!
//! For each shape and number of uniform samples: balanced accuracy at true distances of 2 and 3 degrees, volume over
//! the true one, how far the nearest rotation is from the true boundary and how wrong the distance is (median and 99th
//! percentile, degrees, up to 10 degrees outside), seconds of learning; then nanoseconds of a query.

#[path = "../tests/field/shapes.rs"]
mod shapes;

use condyle_learn::limits::{Cloud, Settings, State, learn};
use condyle_math::Quat;
use shapes::{Random, SHAPES, quantile};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let counts: Vec<usize> = match std::env::args().nth(1) {
        Some(list) => list.split(',').filter_map(|n| n.parse().ok()).collect(),
        None => vec![500, 1500, 5000],
    };
    let boundary_points = 30_000;
    println!(
        "shape, samples, accuracy 2, accuracy 3, volume, off median, off 99 %, distance median, distance 99 %, gap, radius, extreme, seconds"
    );
    for shape in SHAPES {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let share = shape.share(&mut random);
        let boundary = shape.boundary(boundary_points, &mut random);
        let at =
            |angle: f64, random: &mut Random| boundary.at(&shape, angle.to_radians(), 600, random);
        let (two, three) = (at(2.0, &mut random), at(3.0, &mut random));
        let beyond: Vec<Quat> = [2.0, 4.0, 6.0, 8.0, 10.0]
            .into_iter()
            .flat_map(|angle| {
                at(angle, &mut random).into_iter().filter(|(_, inside)| !inside).take(100)
            })
            .map(|(q, _)| q)
            .collect();
        for &count in &counts {
            let samples = shape.samples(count, &mut random);
            let start = Instant::now();
            let cloud = Cloud::gather(&[&samples], 0.0).expect("samples");
            let field = learn(&cloud, &Settings::default()).expect("settings");
            let seconds = start.elapsed().as_secs_f64();
            let accuracy = |points: &[(Quat, bool)]| {
                let right = points
                    .iter()
                    .map(|(q, inside)| (*inside, (field.state(*q).0 == State::Valid) == *inside));
                let (mut good, mut all) = ([0.0; 2], [0.0; 2]);
                for (inside, right) in right {
                    all[usize::from(inside)] += 1.0;
                    good[usize::from(inside)] += f64::from(u8::from(right));
                }
                (0.5 * (good[0] / all[0] + good[1] / all[1]), good[0] / all[0], good[1] / all[1])
            };
            let mut off = vec![];
            let mut wrong = vec![];
            for q in &beyond {
                off.push(boundary.nearest(field.nearest(*q)).1.to_degrees());
                let truth = -boundary.nearest(*q).1;
                wrong.push((field.distance(*q) - truth).abs().to_degrees());
            }
            let learned = field.learned();
            let (a2, o2, i2) = accuracy(&two);
            let (a3, o3, i3) = accuracy(&three);
            println!(
                "{}, {count}, {a2:.3} (out {o2:.3} in {i2:.3}), {a3:.3} (out {o3:.3} in {i3:.3}), {:.3}, {:.2}, {:.2}, {:.2}, {:.2}, {:.2}, {:.1}, {:.0}, {seconds:.2}",
                shape.name,
                learned.valid / share,
                quantile(&mut off, 0.5),
                quantile(&mut off, 0.99),
                quantile(&mut wrong, 0.5),
                quantile(&mut wrong, 0.99),
                learned.gap.to_degrees(),
                learned.radius.to_degrees(),
                learned.extreme,
            );
        }
    }
    speed();
}

fn speed() {
    let mut random = Random(7);
    let samples = SHAPES[5].samples(5000, &mut random);
    let cloud = Cloud::gather(&[&samples], 0.0).expect("samples");
    let field = learn(&cloud, &Settings::default()).expect("settings");
    let all: Vec<Quat> = (0..200_000).map(|_| random.rotation()).collect();
    let outside: Vec<Quat> =
        all.iter().copied().filter(|q| field.state(*q).0 == State::Invalid).collect();
    let time = |name: &str, queries: &[Quat], ask: &dyn Fn(Quat) -> f64| {
        let start = Instant::now();
        let sum: f64 = queries.iter().map(|q| black_box(ask(*q))).sum();
        let each = start.elapsed().as_secs_f64() * 1e9 / queries.len() as f64;
        println!("{name}: {each:.0} ns (sum {sum:.1})");
    };
    time("state and distance", &all, &|q| field.state(q).1);
    time("distance and gradient", &all, &|q| field.distance_and_gradient(q).1.x);
    time("state, distance, evidence", &all, &|q| field.state(q).1 + field.evidence(q).angle);
    time("projection of what is outside", &outside, &|q| field.nearest(q).x);
}
