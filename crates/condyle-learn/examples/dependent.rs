//! How good limits that depend on another joint are where the truth is known:
//! `cargo run --release -p condyle-learn --example dependent [COUNTS [SLOPE [STEP]]]`.
//!
//! Balanced accuracy (of what is outside, of what is inside) at true distances of 2 and 3 degrees from the boundary at the
//! driver, of the limit with its driver and of the one without.

#[path = "../tests/dependent/laws.rs"]
#[allow(dead_code, reason = "what only tests ask for")]
mod laws;

use condyle_learn::limits::dependent::{Asked, DependenceSettings, Pairs, limit};
use condyle_learn::limits::{About, Settings};
use laws::{LAWS, Random, accuracy};
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let list = arguments.first().map_or("500,1500,5000", String::as_str);
    let counts: Vec<usize> = list.split(',').filter_map(|n| n.parse().ok()).collect();
    let number = |at: usize| arguments.get(at).and_then(|n| n.parse::<f64>().ok());
    println!(
        "law | samples | at 2° | at 3° (outside, inside) | without driver | cells | layer | ball | seconds, made"
    );
    for law in LAWS {
        if let Some(only) = arguments.get(3)
            && !law.name.contains(only.as_str())
        {
            continue;
        }
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let tests = [2f64, 3.0].map(|angle| law.at(angle.to_radians(), 800, &mut random));
        for &count in &counts {
            let (rotations, drivers) = law.samples(count, &mut random);
            let mut settings = DependenceSettings::of(&drivers);
            settings.slope = number(1).unwrap_or(settings.slope);
            settings.step = number(2).unwrap_or(settings.step);
            let pairs =
                Pairs::gather(&[(&rotations, drivers)], 0.0, settings.slope).expect("pairs");
            let asked = Asked {
                about: About::default(),
                name: "driver".into(),
                reference: None,
                kind: None,
                settings: Some(settings),
                whole: Settings::default(),
                curves: None,
            };
            let start = Instant::now();
            let (limit, _) = limit(&pairs, &asked).expect("samples");
            let learning = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let given = limit.given().expect("a driver");
            let making = start.elapsed().as_secs_f64();
            let [two, three] = tests
                .each_ref()
                .map(|points| accuracy(points, |q, driver| given.distance(q, driver) >= 0.0));
            // Without its driver a hinge has the bounds of all.
            let whole = accuracy(&tests[1], |q, _| given.whole_distance(q) >= 0.0);
            let made = given.made();
            println!(
                "{} | {count} | {:.3} | {:.3} ({:.3}, {:.3}) | {:.3} ({:.3}, {:.3}) | {} | {:.1}° | {:.0}° | {learning:.1}, {making:.1}",
                law.name,
                two[0],
                three[0],
                three[1],
                three[2],
                whole[0],
                whole[1],
                whole[2],
                made.cells.len(),
                made.known.gap.to_degrees(),
                made.known.radius.to_degrees(),
            );
        }
    }
}
