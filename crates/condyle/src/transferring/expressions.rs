//! A law as plain expressions that any program can evaluate.

use super::Ready;
use condyle_learn::coupling::LawFunction;
use condyle_learn::transfer::Driver;
use condyle_math::function::{Curve, FunctionOfSeveral};
use condyle_math::{Affine, Mat3};
use std::fmt::Write;

/// A law for a joint as text: its angles, their order and how they follow from the child's orientation, and the centre as sums of products,
/// with units and frame.
///
/// # Errors
/// Never for linear laws and polynomials; for splines a text that says that they are not expressions.
pub fn expressions(ready: &Ready, target: &str) -> Result<String, String> {
    let t = &ready.transfer;
    let mut out = format!(
        "# {target}: a learned law as expressions. Angles in radians, lengths in metres.\n\n"
    );
    let order: String = t.order.axes().iter().filter_map(|a| "xyz".chars().nth(*a)).collect();
    out.push_str("# T is the orientation of the child in its parent: columns are the child's axes. R = A*T*B has the angles\n");
    let turns: Vec<String> = t
        .order
        .axes()
        .iter()
        .zip(&t.angles)
        .map(|(axis, name)| format!("R{}({})", ["x", "y", "z"][*axis], identifier(name)))
        .collect();
    let _ = writeln!(
        out,
        "# R = {}, the order {order}, each about the axes as the ones before turned them.",
        turns.join("*")
    );
    let _ = writeln!(out, "A = {}\nB = {}\n", rows(t.to_law[0]), rows(t.to_law[1]));
    let names: Vec<String> = t
        .drivers
        .iter()
        .zip(&t.controls)
        .map(|(driver, control)| match driver {
            Driver::Angle(k) => identifier(&t.angles[*k]),
            Driver::Coordinate(_) => identifier(control),
        })
        .collect();
    for (driver, name) in t.drivers.iter().zip(&names) {
        if let Driver::Coordinate(coordinate) = driver {
            let _ = writeln!(out, "# {name} is the coordinate {coordinate} of the figure.");
        }
    }
    for (k, law) in t.turned.iter().enumerate() {
        if let Some(law) = law {
            let _ = writeln!(out, "{} = {}", identifier(&t.angles[k]), expression(law, &names)?);
        }
    }
    out.push_str("# Distances of the joint's centre from the landmarks' frame:\n");
    for slide in &t.slides {
        let _ = writeln!(out, "{} = {}", identifier(&slide.name), expression(&slide.law, &names)?);
    }
    out.push_str("\n# The centre in the landmarks' axes (x forward, y up, z to the right), from the landmark at the origin:\n");
    let fixed = t.fixed.to_array();
    for (axis, word) in ["x", "y", "z"].into_iter().enumerate() {
        let parts = t.slides.iter().filter_map(|slide| {
            let share = slide.along.to_array()[axis];
            (share.abs() > 1e-15).then(|| format!("{} * {}", shown(share), identifier(&slide.name)))
        });
        let sum: Vec<String> =
            parts.chain((fixed[axis] != 0.0).then(|| shown(fixed[axis]))).collect();
        let sum = if sum.is_empty() { "0".to_owned() } else { sum.join(" + ") };
        let _ = writeln!(out, "centre_{word} = {sum}");
    }
    let _ = writeln!(
        out,
        "\n# The landmarks' frame in the parent, row by row: axes as columns, then the origin.\nL = {}",
        affine(t.frame)
    );
    Ok(out)
}

/// A name that programs take.
pub(super) fn identifier(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let name: String = plain.collect();
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("_{name}") } else { name }
}

fn shown(number: f64) -> String {
    let text = format!("{number:?}");
    if number < 0.0 { format!("({text})") } else { text }
}

fn rows(m: Mat3) -> String {
    let row = |i: usize| format!("[{:?}, {:?}, {:?}]", m.at(i, 0), m.at(i, 1), m.at(i, 2));
    format!("[{}, {}, {}]", row(0), row(1), row(2))
}

fn affine(a: Affine) -> String {
    let [x, y, z] = a.translation.to_array();
    let row = |i: usize, at: f64| {
        format!(
            "[{:?}, {:?}, {:?}, {at:?}]",
            a.linear.at(i, 0),
            a.linear.at(i, 1),
            a.linear.at(i, 2)
        )
    };
    format!("[{}, {}, {}]", row(0, x), row(1, y), row(2, z))
}

/// A law as a sum of products.
pub(super) fn expression(law: &LawFunction, names: &[String]) -> Result<String, String> {
    let sum = |terms: Vec<String>| match terms.is_empty() {
        true => "0.0".to_owned(),
        false => terms.join(" + "),
    };
    match law {
        LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept }) => {
            let terms = slopes.iter().zip(names).filter(|(slope, _)| **slope != 0.0);
            let terms = terms.map(|(slope, name)| format!("{} * {name}", shown(*slope)));
            Ok(sum(std::iter::once(shown(*intercept)).chain(terms).collect()))
        }
        LawFunction::Several(FunctionOfSeveral::Polynomial(p)) => {
            let mut terms = vec![];
            let mut powers = vec![0usize; names.len()];
            for c in p.coefficients() {
                if *c != 0.0 {
                    let factors = powers
                        .iter()
                        .zip(names)
                        .flat_map(|(power, name)| std::iter::repeat_n(name.as_str(), *power));
                    let all: Vec<String> =
                        std::iter::once(shown(*c)).chain(factors.map(str::to_owned)).collect();
                    terms.push(all.join(" * "));
                }
                let mut place = powers.len();
                while place > 0 {
                    place -= 1;
                    powers[place] += 1;
                    if powers.iter().sum::<usize>() <= p.order() {
                        break;
                    }
                    powers[place] = 0;
                }
            }
            Ok(sum(terms))
        }
        LawFunction::Sum { intercept, parts } => {
            let mut terms = vec![shown(*intercept)];
            for (part, name) in parts.iter().zip(names) {
                match (&part.curve, part.as_linear()) {
                    (_, Some((slope, at))) => {
                        terms.push(format!("{} * {name} + {}", shown(slope), shown(at)))
                    }
                    (Curve::Constant(c), _) => terms.push(shown(part.factor * c)),
                    (Curve::Polynomial(q), _) => {
                        for (power, c) in q.ascending().iter().enumerate() {
                            let factors = std::iter::repeat_n(name.clone(), power);
                            let all: Vec<String> =
                                std::iter::once(shown(part.factor * c)).chain(factors).collect();
                            terms.push(all.join(" * "));
                        }
                    }
                    _ => {
                        return Err("a law of splines is no sum of products: learn it with --basis linear or polynomial:3".to_owned());
                    }
                }
            }
            Ok(sum(terms))
        }
    }
}
