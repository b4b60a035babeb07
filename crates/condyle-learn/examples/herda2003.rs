//! How well the readings of Herda et al. 2003 find a limit whose inside is known: the tables of
//! `docs/learned-limits.md`.
//!
//! `cargo run --release -p condyle-learn --example herda2003`

#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/herda2003/shapes.rs"]
mod shapes;

use condyle_learn::limits::herda2003::{
    Chart, Fitting, Options, Placement, SphereField, SphereLimit, Split, SwingPolygon, project,
};
use condyle_math::{Quat, Vec3};
use shapes::{Random, labelled, mean, samples, shares, shoulder};

const MARGIN_DEG: f64 = 3.0;

fn main() {
    let mut random = Random::new(14);
    let cloud = samples(&shoulder, 5000, &mut random);
    let margin = MARGIN_DEG.to_radians();
    let tests = labelled(&shoulder, [margin, f64::INFINITY], 20_000, &mut random);
    let near = labelled(&shoulder, [margin, 1.15 * margin], 4_000, &mut random);
    let reference = mean(&cloud);
    println!(
        "| reading | split | spheres | E | cleaned: spheres | E | inside allowed | outside refused | balanced | balanced at 3 to 3.5° |"
    );
    println!("| ---| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut best: Option<(f64, SphereLimit)> = None;
    for (placement, name) in
        [(Placement::AsRecorded, "as recorded"), (Placement::Centred, "centred")]
    {
        for (split, into) in [(Split::Two, "two"), (Split::Six, "six")] {
            let options = Options { placement, split, stable: 0.0, most: 41, ..Options::default() };
            let chart = Chart::new(reference, placement);
            let points: Vec<Vec3> = cloud.iter().map(|q| chart.point(*q)).collect();
            let Ok(fitting) = Fitting::new(points, options) else { continue };
            for stage in fitting.stages() {
                let count = stage.field.primitives.len();
                let (clean, _) = fitting.clean(&stage.field);
                let limit = limit(chart, clean.field.clone());
                let [inside, outside] = shares(&tests, |q| limit.allows(q));
                let balanced = 0.5 * (inside + outside);
                let [in3, out3] = shares(&near, |q| limit.allows(q));
                let at3 = 0.5 * (in3 + out3);
                println!(
                    "| {name} | {into} | {count} | {:.4} | {} | {:.4} | {inside:.3} | {outside:.3} | {balanced:.3} | {at3:.3} |",
                    stage.energy,
                    clean.field.primitives.len(),
                    clean.energy
                );
                if best.as_ref().is_none_or(|(score, _)| *score < balanced) {
                    best = Some((balanced, limit));
                }
            }
            let learned = SphereLimit::learn(
                &cloud,
                reference,
                Options { stable: Options::default().stable, most: 31, ..options },
            );
            if let Ok(learned) = learned {
                let [inside, outside] = shares(&tests, |q| learned.allows(q));
                let [in3, out3] = shares(&near, |q| learned.allows(q));
                println!(
                    "| {name} | {into} | stable at {} | {:.4} | {} | {:.4} | {inside:.3} | {outside:.3} | {:.3} | {:.3} |",
                    learned.history.last().map_or(0, |h| h.0),
                    learned.history.last().map_or(0.0, |h| h.1),
                    learned.field.primitives.len(),
                    learned.energy,
                    0.5 * (inside + outside),
                    0.5 * (in3 + out3)
                );
            }
        }
    }
    if let Some((score, limit)) = best {
        println!("best {score:.3}");
        projections(&limit, &tests);
        polygon(&limit, &mut random);
    }
}

fn limit(chart: Chart, field: SphereField) -> SphereLimit {
    SphereLimit { chart, field, energy: 0.0, history: Vec::new(), removed: Default::default() }
}

/// What the dichotomy does with rotations outside.
fn projections(limit: &SphereLimit, tests: &[(Quat, bool)]) {
    let mut counts = std::collections::BTreeMap::new();
    let mut moved = Vec::new();
    for (q, _) in tests.iter().filter(|(q, _)| !limit.allows(*q)) {
        match project(limit, *q) {
            Ok(answer) => {
                moved.push(answer.angle_to(*q).to_degrees());
                *counts.entry("found").or_insert(0) += 1;
            }
            Err(failure) => *counts.entry(failure.text()).or_insert(0) += 1,
        }
    }
    println!("projections {counts:?} of {}", counts.values().sum::<usize>());
}

/// The swing polygon beside the field.
fn polygon(limit: &SphereLimit, random: &mut Random) {
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        match SwingPolygon::new(limit, axis, limit.chart.reference(), 36) {
            Ok(polygon) => {
                let (mut same, mut both, mut field, mut cone) = (0, 0, 0, 0);
                for _ in 0..100_000 {
                    let q = random.rotation();
                    let (a, b) = (limit.allows(q), polygon.allows(q));
                    same += usize::from(a == b);
                    both += usize::from(a && b);
                    field += usize::from(a);
                    cone += usize::from(b);
                }
                println!(
                    "polygon about {axis:?}: same {same} of 100000, field {field}, cone {cone}, both {both}"
                );
            }
            Err(error) => println!("polygon about {axis:?}: {error}"),
        }
    }
}
