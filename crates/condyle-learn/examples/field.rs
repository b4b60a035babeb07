//! How good learned limits are where the truth is known: `cargo run --release -p condyle-learn --example field PART [COUNTS]`.
//!
//! | part | what |
//! | --- | --- |
//! | `accuracy`, `aside`, `drawn`, `unseen` | of six shapes, of six others, of four drawn at random, of four more that were kept aside: balanced accuracy at true distances of 2 and 3 degrees, volume over the true one, how far the nearest rotation is from the true boundary and how wrong the distance is (median and 99th percentile, up to 10 degrees outside) |
//! | `later` | of eight more that were drawn, kept aside until edges and gaps were settled anew |
//! | `seeds COUNTS SET` | of six clouds of each shape of a set (`shapes`, `aside`, `drawn`, `unseen`, `later`; `all` but the last): accuracies at 2 and 3 degrees, and volume, as the mean and the worst |
//! | `disturbed`, `disturbed-unseen` | accuracy with noise of 1 and 2 degrees about each axis, and with one half 12 times as dense as the other |
//! | `projection` | nearest rotations beside the best of 100 000 places on the field's own boundary |
//! | `compare` | the same samples by a threshold on the distance to the nearest sample, set by leaving samples out, and by cells of a grid |
//! | `speed` | nanoseconds of a query, seconds of learning |

#[path = "../tests/field/shapes.rs"]
#[allow(dead_code, reason = "what only tests ask for")]
mod shapes;

#[path = "../tests/field/drawn.rs"]
mod drawn;

use condyle_learn::limits::{Cloud, Field, Settings, State, learn};
use condyle_math::{Quat, Vec3};
use shapes::{ASIDE, Random, SHAPES, Shape, quantile};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let part = arguments.first().map_or("accuracy", String::as_str);
    let counts: Vec<usize> = match arguments.get(1) {
        Some(list) => list.split(',').filter_map(|n| n.parse().ok()).collect(),
        None => vec![500, 1500, 5000],
    };
    match part {
        "accuracy" => accuracies(&SHAPES, &counts, &[("", 0.0, 1.0)]),
        "aside" => accuracies(&ASIDE, &counts, &[("", 0.0, 1.0)]),
        "drawn" => accuracies(&drawn::SEEN, &counts, &[("", 0.0, 1.0)]),
        "unseen" => accuracies(&drawn::UNSEEN, &counts, &[("", 0.0, 1.0)]),
        "disturbed" => accuracies(&SHAPES, &counts, &DISTURBED),
        "disturbed-unseen" => accuracies(&drawn::UNSEEN, &counts, &DISTURBED),
        "later" => accuracies(&drawn::LATER, &counts, &[("", 0.0, 1.0)]),
        "seeds" => clouds(arguments.get(2).map_or("all", String::as_str), &counts, 6),
        "projection" => projection(&SHAPES),
        "compare" => compare(&counts),
        "speed" => speed(),
        _ => eprintln!("error: there is no part {part}"),
    }
}

/// A name, noise in degrees, how many times denser one side is.
const DISTURBED: [(&str, f64, f64); 3] =
    [("noise 1", 1.0, 1.0), ("noise 2", 2.0, 1.0), ("12 to 1", 0.0, 12.0)];

fn learned(samples: &[Quat]) -> Field {
    let cloud = Cloud::gather(&[samples], 0.0).expect("samples");
    learn(&cloud, &Settings::default()).expect("settings")
}

/// Samples with noise in degrees about each axis, and of one half so many times more than of the other.
fn samples(shape: &Shape, count: usize, noise: f64, more: f64, random: &mut Random) -> Vec<Quat> {
    let mut found = vec![];
    while found.len() < count {
        for q in shape.samples(100, random) {
            let sparse = (Quat::exp(Vec3::new(0.2, 0.3, 0.1)).conjugate() * q).log().x < 0.0;
            if sparse && random.unit() * more > 1.0 {
                continue;
            }
            let off = Vec3::new(random.normal(), random.normal(), random.normal());
            found.push(if noise > 0.0 { q * Quat::exp(off * noise.to_radians()) } else { q });
        }
    }
    found.truncate(count);
    found
}

/// Balanced, of what is outside, of what is inside.
fn accuracy(points: &[(Quat, bool)], valid: impl Fn(Quat) -> bool) -> [f64; 3] {
    let (mut good, mut all) = ([0.0; 2], [0.0; 2]);
    for (q, inside) in points {
        all[usize::from(*inside)] += 1.0;
        good[usize::from(*inside)] += f64::from(u8::from(valid(*q) == *inside));
    }
    let [outside, inside] = [good[0] / all[0], good[1] / all[1]];
    [0.5 * (outside + inside), outside, inside]
}

fn accuracies(shapes: &[Shape], counts: &[usize], kinds: &[(&str, f64, f64)]) {
    println!(
        "shape | samples | at 2° | at 3° (outside, inside) | volume | nearest | distance | gap | spacing | holes | seconds"
    );
    for shape in shapes {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let share = shape.share(&mut random);
        let boundary = shape.boundary(30_000, &mut random);
        let mut at =
            |degrees: f64, count| boundary.at(shape, degrees.to_radians(), count, &mut random);
        let (two, three) = (at(2.0, 1600), at(3.0, 1600));
        let beyond: Vec<Quat> = [2.0, 4.0, 6.0, 8.0, 10.0]
            .into_iter()
            .flat_map(|degrees| at(degrees, 200).into_iter().filter(|(_, inside)| !inside))
            .map(|(q, _)| q)
            .collect();
        for (&count, (name, noise, more)) in
            counts.iter().flat_map(|count| kinds.iter().map(move |kind| (count, kind)))
        {
            let samples = samples(shape, count, *noise, *more, &mut random);
            let start = Instant::now();
            let field = learned(&samples);
            let seconds = start.elapsed().as_secs_f64();
            let [of_two, of_three] =
                [&two, &three].map(|points| accuracy(points, |q| field.state(q).0 == State::Valid));
            let (mut off, mut wrong) = (vec![], vec![]);
            for q in &beyond {
                off.push(boundary.nearest(field.nearest(*q)).1.to_degrees());
                let truth = -boundary.nearest(*q).1;
                wrong.push((field.distance(*q) - truth).abs().to_degrees());
            }
            let learned = field.learned();
            println!(
                "{} | {count} {name} | {:.3} | {:.3} ({:.3}, {:.3}) | {:.3} | {:.1}, {:.1} | {:.1}, {:.1} | {:.2} | {:.2} | {} | {seconds:.2}",
                shape.name,
                of_two[0],
                of_three[0],
                of_three[1],
                of_three[2],
                learned.valid / share,
                quantile(&mut off, 0.5),
                quantile(&mut off, 0.99),
                quantile(&mut wrong, 0.5),
                quantile(&mut wrong, 0.99),
                learned.gap.to_degrees(),
                learned.spacing.to_degrees(),
                learned.holes.len(),
            );
        }
    }
}

/// Several clouds of each shape: accuracies at 2 and 3 degrees and volume, as the mean and the worst; where errors lie at
/// 3 degrees, as shares of what is outside and inside.
fn clouds(which: &str, counts: &[usize], seeds: u64) {
    let sets: [(&str, &[Shape]); 5] = [
        ("shapes", &SHAPES),
        ("aside", &ASIDE),
        ("drawn", &drawn::SEEN),
        ("unseen", &drawn::UNSEEN),
        ("later", &drawn::LATER),
    ];
    println!(
        "shape | samples | at 2°, mean and least | at 3° | outside, inside | volume, mean, least, most"
    );
    for (name, shapes) in sets {
        if which != name && (which != "all" || name == "later") {
            continue;
        }
        for shape in shapes {
            let mut random = Random(0x9E37_79B9_7F4A_7C15);
            let share = shape.share(&mut random);
            let boundary = shape.boundary(20_000, &mut random);
            let [two, three] = [2.0f64, 3.0]
                .map(|degrees| boundary.at(shape, degrees.to_radians(), 1200, &mut random));
            for &count in counts {
                let mut found: [Vec<f64>; 5] = Default::default();
                for seed in 0..seeds {
                    let mut random = Random(0x1234_5678_9ABC_DEF1 ^ (seed + 1) << 33);
                    let field = learned(&shape.samples(count, &mut random));
                    let valid = |q| field.state(q).0 == State::Valid;
                    let of_three = accuracy(&three, valid);
                    found[0].push(accuracy(&two, valid)[0]);
                    for (found, of) in found[1..4].iter_mut().zip(of_three) {
                        found.push(of);
                    }
                    found[4].push(field.learned().valid / share);
                }
                let mean = |i: usize| found[i].iter().sum::<f64>() / found[i].len() as f64;
                let least = |i: usize| found[i].iter().copied().fold(f64::INFINITY, f64::min);
                let most = |i: usize| found[i].iter().copied().fold(0.0, f64::max);
                println!(
                    "{} | {count} | {:.3}, {:.3} | {:.3}, {:.3} | {:.3}, {:.3} | {:.3}, {:.3}, {:.3}",
                    shape.name,
                    mean(0),
                    least(0),
                    mean(1),
                    least(1),
                    mean(2),
                    mean(3),
                    mean(4),
                    least(4),
                    most(4),
                );
            }
        }
    }
}

fn projection(shapes: &[Shape]) {
    for shape in shapes {
        let mut random = Random(23);
        let field = learned(&shape.samples(5000, &mut random));
        let mut boundary = vec![];
        while boundary.len() < 100_000 {
            let q = random.rotation();
            if (-0.4..0.0).contains(&field.distance(q)) {
                boundary.push(field.nearest(q));
            }
        }
        let (mut excess, mut far, mut outside, mut moved, mut all) = (vec![], 0, 0, 0.0f64, 0);
        while all < 3000 {
            let q = random.rotation();
            if field.distance(q) >= 0.0 {
                continue;
            }
            all += 1;
            let best = boundary.iter().map(|p| q.dot(*p).abs()).fold(0.0, f64::max);
            let nearest = field.nearest(q);
            outside += usize::from(field.distance(nearest) < 0.0);
            moved = moved.max(field.nearest(nearest).angle_to(nearest));
            let more = (q.angle_to(nearest) - 2.0 * best.min(1.0).acos()).to_degrees();
            far += usize::from(more > 0.1);
            excess.push(more);
        }
        println!(
            "{}: {far} of {all} farther than the best place and 0.1°; the most {:.3}°, outside {outside}, moved again by {moved:e} rad",
            shape.name,
            quantile(&mut excess, 1.0)
        );
    }
}

/// The angle to the nearest of samples, one left out.
fn nearest_of(samples: &[Quat], q: Quat, without: usize) -> f64 {
    let mut best = 0.0f64;
    for (index, p) in samples.iter().enumerate() {
        if index != without {
            best = best.max(q.dot(*p).abs());
        }
    }
    2.0 * best.min(1.0).acos()
}

fn compare(counts: &[usize]) {
    println!("shape | samples | closing | nearest sample, 95 % and 99 % of left-out ones | cells");
    for shape in SHAPES {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let boundary = shape.boundary(30_000, &mut random);
        let three = boundary.at(&shape, 3f64.to_radians(), 1600, &mut random);
        for &count in counts {
            let samples = shape.samples(count, &mut random);
            let field = learned(&samples);
            let closing = accuracy(&three, |q| field.state(q).0 == State::Valid)[0];
            let mut left: Vec<f64> = samples
                .iter()
                .enumerate()
                .map(|(index, q)| nearest_of(&samples, *q, index))
                .collect();
            let near = [0.95, 0.99].map(|part| {
                let most = quantile(&mut left, part);
                accuracy(&three, |q| nearest_of(&samples, q, usize::MAX) <= most)[0]
            });
            // Cells of the map x = √2 v/√(1 + w), as wide as a spacing, that hold a sample or touch six that do.
            let width = field.learned().spacing / 2.0;
            let cell = |q: Quat| {
                let q = if q.w < 0.0 { -q } else { q };
                let scale = (2.0 / (1.0 + q.w)).sqrt() / width;
                [q.x, q.y, q.z].map(|c| (c * scale).floor() as i32)
            };
            let held: std::collections::HashSet<[i32; 3]> =
                samples.iter().map(|q| cell(*q)).collect();
            let valid = |q: Quat| {
                let [i, j, k] = cell(q);
                let around = (0..27)
                    .filter(|n| held.contains(&[i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]));
                held.contains(&[i, j, k]) || around.count() >= 6
            };
            let cells = accuracy(&three, valid)[0];
            println!(
                "{} | {count} | {closing:.3} | {:.3}, {:.3} | {cells:.3}",
                shape.name, near[0], near[1]
            );
        }
    }
}

fn speed() {
    let mut random = Random(7);
    let time = |name: &str, queries: &[Quat], ask: &dyn Fn(Quat) -> f64| {
        let best = (0..5)
            .map(|_| {
                let start = Instant::now();
                black_box(queries.iter().map(|q| ask(black_box(*q))).sum::<f64>());
                start.elapsed().as_secs_f64() * 1e9 / queries.len() as f64
            })
            .fold(f64::INFINITY, f64::min);
        println!("  {name}: {best:.0} ns");
    };
    let all: Vec<Quat> = (0..100_000).map(|_| random.rotation()).collect();
    let motion: Vec<Quat> = (0..100_000)
        .map(|i| f64::from(i) * 1e-3)
        .map(|t| Quat::exp(Vec3::new(t.sin(), (1.3 * t).cos(), (0.7 * t).sin()) * 1.2))
        .collect();
    for shape in [SHAPES[0], SHAPES[5]] {
        let field = learned(&shape.samples(5000, &mut random));
        for (kind, queries) in [("uniform rotations", &all), ("a motion", &motion)] {
            println!("{}, {kind}", shape.name);
            let outside: Vec<Quat> =
                queries.iter().copied().filter(|q| field.distance(*q) < 0.0).collect();
            let near: Vec<Quat> =
                outside.iter().copied().filter(|q| field.distance(*q) > -0.2).collect();
            time("state and distance", queries, &|q| field.state(q).1);
            time("distance and gradient", queries, &|q| field.distance_and_gradient(q).1.x);
            time("state, distance, evidence", queries, &|q| field.state_with_evidence(q).2.angle);
            time("nearest of what is outside", &outside, &|q| field.nearest(q).x);
            time("nearest of what is up to 11° outside", &near, &|q| field.nearest(q).x);
        }
    }
    for count in [1500, 5000, 30_000] {
        let samples = SHAPES[0].samples(count, &mut random);
        let start = Instant::now();
        black_box(learned(&samples));
        println!("{count} samples: {:.2} s", start.elapsed().as_secs_f64());
    }
}
