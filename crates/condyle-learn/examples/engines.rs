//! What engines lose of limits whose inside is known: `cargo run --release -p condyle-learn --example engines [DIRECTIONS]`.
//!
//! For each shape a field of 5000 samples, and of each law and of a reach cone the share of all rotations that is allowed, false
//! accepts and false rejects as parts of what the field allows, how far off those are, and seconds.

#[path = "../tests/field/shapes.rs"]
#[allow(dead_code, reason = "what only tests ask for")]
mod shapes;

use condyle_learn::limits::engine::{Aim, ConeTwist, Law, Loss, Region, cone_twist, reach_cone};
use condyle_learn::limits::{Cloud, Settings, learn};
use condyle_math::Vec3;
use shapes::{Random, SHAPES};
use std::time::Instant;

fn main() {
    let directions = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(24);
    println!(
        "| shape | aim | what | numbers | allowed | false accepts | false rejects | outside by | inside by | s |"
    );
    for shape in SHAPES {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let samples = shape.samples(5000, &mut random);
        let cloud = Cloud::gather(&[&samples], 0.0).expect("samples");
        let field = learn(&cloud, &Settings::default()).expect("settings");
        let region = Region::of(&field);
        let distance = |q| field.distance(q);
        for aim in [Aim::Closest, Aim::Inside] {
            let mut from: Option<ConeTwist> = None;
            for law in Law::ALL {
                let start = Instant::now();
                let found = cone_twist(&region, &distance, -Vec3::Y, law, aim, from.as_ref());
                let seconds = start.elapsed().as_secs_f64();
                match found {
                    Ok(cone) => {
                        let [a, b, t] =
                            [cone.swing[0], cone.swing[1], cone.twist].map(f64::to_degrees);
                        let numbers = format!("{a:.1}° {b:.1}° ±{t:.1}°");
                        let loss = Loss::of(&region, |q| cone.allows(q));
                        row(shape.name, aim, law.name(), &numbers, &loss, seconds);
                        from = from.or(Some(cone));
                    }
                    Err(error) => println!("{} {aim:?} {}: {error}", shape.name, law.name()),
                }
            }
            let Some(cone) = from else { continue };
            let start = Instant::now();
            match reach_cone(&region, &distance, &cone, directions, aim) {
                Ok(reach) => {
                    let seconds = start.elapsed().as_secs_f64();
                    let loss = Loss::of(&region, |q| reach.allows(q));
                    row(
                        shape.name,
                        aim,
                        "reach cone",
                        &format!("{directions} directions"),
                        &loss,
                        seconds,
                    );
                }
                Err(error) => println!("{} {aim:?} reach: {error}", shape.name),
            }
        }
    }
}

fn row(shape: &str, aim: Aim, what: &str, numbers: &str, loss: &Loss, seconds: f64) {
    let degrees = |lost: &condyle_learn::limits::engine::Lost| {
        let [mean, most, largest] = [lost.mean, lost.most, lost.largest].map(f64::to_degrees);
        format!("{mean:.1}°, {most:.1}°, {largest:.1}°")
    };
    println!(
        "| {shape} | {aim:?} | {what} | {numbers} | {:.2} % of {:.2} % | {:.3} | {:.3} | {} | {} | {seconds:.2} |",
        100.0 * loss.allowed,
        100.0 * loss.field,
        loss.accepts.of_field,
        loss.rejects.of_field,
        degrees(&loss.accepts),
        degrees(&loss.rejects),
    );
}
