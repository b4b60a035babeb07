//! Polynomials through what no rule computes.

use super::measure::{LinkError, measure};
use super::{Legal, Rule, Tree, Value};
use condyle_diagnostics::Diagnostic;
use condyle_math::function::{FunctionOfSeveral, MultivariatePolynomial};
use condyle_model::Model;
use condyle_model::model::ComponentId;
use std::collections::HashMap;

/// A fitted part that is worse than this, in metres, is named as not to be said.
pub const LENGTH_TOLERANCE: f64 = 0.5e-3;
/// The same for angles, in radians: a tenth of a degree.
pub const ANGLE_TOLERANCE: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// The most coefficients of a fitted polynomial.
const MOST_COEFFICIENTS: usize = 500;
/// The most values that a fitted one depends on.
const MOST_DRIVERS: usize = 8;
/// How many poses are tried for one that is legal.
const MOST_TRIES: usize = 20;
/// How many poses a tree is compared at.
pub(crate) const COMPARED: usize = 300;

/// A fitted link.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The position of the link.
    pub link: usize,
    /// The order of its polynomials.
    pub order: usize,
    /// The largest error over legal poses.
    pub error: LinkError,
}

/// Replaces everything that is measured by polynomials of what it depends on, with remarks that say how far
/// they are off.
pub fn fit(model: &Model, tree: &mut Tree) -> Vec<Fit> {
    let mut fits = vec![];
    let measured: Vec<usize> =
        (0..tree.links.len()).filter(|&i| tree.links[i].measured.is_some()).collect();
    if measured.is_empty() {
        return fits;
    }
    for link in measured {
        let Some(part) = tree.links[link].measured.clone() else { continue };
        let samples = samples(model, tree, &part.components, 5, 8 * MOST_COEFFICIENTS);
        let held = samples_held(model, tree, &part.components);
        let order = fit_part(tree, &part.slots, &part.drivers, &samples, &held);
        fits.push(Fit { link, order, error: LinkError::default() });
    }
    let errors = measure(model, tree, COMPARED);
    for fit in &mut fits {
        fit.error = errors[fit.link];
        let link = &tree.links[fit.link];
        let what = link.measured.as_ref().map_or("", |part| part.what.as_str());
        let (mm, degrees) = (fit.error.length * 1e3, fit.error.angle.to_degrees());
        let fine = fit.error.length <= LENGTH_TOLERANCE && fit.error.angle <= ANGLE_TOLERANCE;
        let message = format!(
            "{what} of `{}` is fitted by polynomials of order {}: largest error {mm:.3} mm, {degrees:.3}°",
            link.name, fit.order
        );
        tree.remarks.push(if fine {
            Diagnostic::note("plain/fitted", message)
        } else {
            Diagnostic::warning("plain/not-said", message)
                .with_help("more than 0.5 mm or 0.1°: the written model does not say this motion")
        });
    }
    fits
}

/// The values at poses at which the limits of these components hold, at most so many.
fn samples(
    model: &Model,
    tree: &Tree,
    components: &[ComponentId],
    seed: u64,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut legal = Legal::new(model, seed);
    let mut all = vec![];
    for _ in 0..MOST_TRIES * count {
        if all.len() == count {
            break;
        }
        let values = legal.next_values(tree);
        if legal.keeps(components) {
            all.push(values);
        }
    }
    all
}

/// Other such poses, to choose the order by.
fn samples_held(model: &Model, tree: &Tree, components: &[ComponentId]) -> Vec<Vec<f64>> {
    samples(model, tree, components, 1234, 400)
}

/// Fits the slots of one part; the order of the polynomials.
fn fit_part(
    tree: &mut Tree,
    slots: &[Value; 6],
    drivers: &[Value],
    samples: &[Vec<f64>],
    held: &[Vec<f64>],
) -> usize {
    let spread = |v: Value| {
        let all = samples.iter().chain(held).map(|s| s[v]);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), x| (l.min(x), u.max(x)))
    };
    let still = |v: Value| {
        let (l, u) = spread(v);
        u - l < 1e-10
    };
    // What does not move needs no polynomial.
    for &slot in slots {
        if still(slot) {
            let (l, u) = spread(slot);
            let middle = 0.5 * (l + u);
            let value = if middle.abs() < 1e-10 { 0.0 } else { middle };
            tree.rules.set(slot, Rule::Constant(value));
        }
    }
    let open: Vec<Value> = slots.iter().copied().filter(|&slot| !still(slot)).collect();
    let drivers: Vec<Value> =
        drivers.iter().copied().filter(|&d| !still(d)).take(MOST_DRIVERS).collect();
    if drivers.is_empty() {
        open.iter().for_each(|&slot| tree.rules.set(slot, Rule::Constant(0.0)));
        return 0;
    }
    let domain: Vec<(f64, f64)> = drivers.iter().map(|&d| spread(d)).collect();
    let points = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
        all.iter().map(|s| drivers.iter().map(|&d| s[d]).collect()).collect()
    };
    let values = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
        all.iter().map(|s| open.iter().map(|&slot| s[slot]).collect()).collect()
    };
    let (x, y, x_held, y_held) = (points(samples), values(samples), points(held), values(held));
    let mut best: Option<(f64, usize, Vec<MultivariatePolynomial>)> = None;
    for order in 1..=12 {
        let Some(polynomials) = polynomials(order, &domain, &x, &y) else { break };
        let worst = x_held
            .iter()
            .zip(&y_held)
            .flat_map(|(x, y)| polynomials.iter().zip(y).map(|(p, y)| (p.apply(x) - y).abs()));
        let worst = worst.fold(0.0, f64::max);
        if best.as_ref().is_none_or(|(least, ..)| worst < *least) {
            best = Some((worst, order, polynomials));
        }
        if worst < 1e-6 {
            break;
        }
    }
    let Some((_, order, polynomials)) = best else { return 0 };
    for (&slot, polynomial) in open.iter().zip(polynomials) {
        let rule = Rule::Several(FunctionOfSeveral::Polynomial(polynomial), drivers.clone());
        tree.rules.set(slot, rule);
    }
    order
}

/// Least-squares polynomials of an order for every column of `y`; `None` where they have too many coefficients.
pub(super) fn polynomials(
    order: usize,
    domain: &[(f64, f64)],
    x: &[Vec<f64>],
    y: &[Vec<f64>],
) -> Option<Vec<MultivariatePolynomial>> {
    let dimension = domain.len();
    let powers = powers(dimension, order, MOST_COEFFICIENTS)?;
    let count = powers.len();
    if 3 * count > x.len() {
        return None;
    }
    let columns = y.first().map_or(0, Vec::len);
    let mut normal = vec![0.0; count * count];
    let mut right = vec![vec![0.0; count]; columns];
    let mut basis = vec![0.0; count];
    for (x, y) in x.iter().zip(y) {
        let tables: Vec<Vec<f64>> =
            x.iter().zip(domain).map(|(&x, &d)| chebyshev(scaled(x, d), order)).collect();
        for (value, powers) in basis.iter_mut().zip(&powers) {
            *value = powers.iter().zip(&tables).map(|(&p, table)| table[usize::from(p)]).product();
        }
        for i in 0..count {
            let row = &mut normal[i * count..i * count + i + 1];
            let factor = basis[i];
            row.iter_mut().zip(&basis).for_each(|(entry, b)| *entry += factor * b);
        }
        for (right, y) in right.iter_mut().zip(y) {
            right.iter_mut().zip(&basis).for_each(|(entry, b)| *entry += y * b);
        }
    }
    let trace: f64 = (0..count).map(|i| normal[i * count + i]).sum();
    (0..count).for_each(|i| normal[i * count + i] += 1e-13 * trace / count as f64);
    factorise(&mut normal, count)?;
    right
        .into_iter()
        .map(|mut right| {
            solve(&normal, count, &mut right);
            let coefficients = monomials(&powers, &right, domain, order);
            MultivariatePolynomial::up_to_order(dimension, order, &coefficients).ok()
        })
        .collect()
}

/// The exponents of all monomials up to an order, the last varying fastest; `None` if there are more than `most`.
fn powers(dimension: usize, order: usize, most: usize) -> Option<Vec<Vec<u8>>> {
    let mut all = vec![];
    let mut powers = vec![0u8; dimension];
    loop {
        if all.len() == most {
            return None;
        }
        all.push(powers.clone());
        let mut place = dimension;
        loop {
            if place == 0 {
                return Some(all);
            }
            place -= 1;
            powers[place] += 1;
            if powers.iter().map(|&p| usize::from(p)).sum::<usize>() <= order {
                break;
            }
            powers[place] = 0;
        }
    }
}

fn scaled(x: f64, (lower, upper): (f64, f64)) -> f64 {
    (2.0 * x - lower - upper) / (upper - lower)
}

/// The Chebyshev polynomials up to an order at u.
fn chebyshev(u: f64, order: usize) -> Vec<f64> {
    let mut table = vec![1.0, u];
    for k in 2..=order {
        table.push(2.0 * u * table[k - 1] - table[k - 2]);
    }
    table
}

/// The coefficients over powers of x of a sum of products of Chebyshev polynomials of scaled x.
fn monomials(
    powers: &[Vec<u8>],
    coefficients: &[f64],
    domain: &[(f64, f64)],
    order: usize,
) -> Vec<f64> {
    let place: HashMap<&[u8], usize> =
        powers.iter().enumerate().map(|(i, p)| (&p[..], i)).collect();
    let mut here = coefficients.to_vec();
    for (axis, &(lower, upper)) in domain.iter().enumerate() {
        let (slope, start) = (2.0 / (upper - lower), -(lower + upper) / (upper - lower));
        // The Chebyshev polynomials of slope·x + start, by ascending powers of x.
        let mut table = vec![vec![1.0], vec![start, slope]];
        for k in 2..=order {
            let mut next = vec![0.0; k + 1];
            for (i, c) in table[k - 1].iter().enumerate() {
                next[i] += 2.0 * start * c;
                next[i + 1] += 2.0 * slope * c;
            }
            table[k - 2].iter().enumerate().for_each(|(i, c)| next[i] -= c);
            table.push(next);
        }
        let mut after = vec![0.0; here.len()];
        for (powers, c) in powers.iter().zip(&here) {
            let mut to = powers.clone();
            for (power, factor) in table[usize::from(powers[axis])].iter().enumerate() {
                to[axis] = power as u8;
                if let Some(&at) = place.get(&to[..]) {
                    after[at] += c * factor;
                }
            }
        }
        here = after;
    }
    here
}

/// The Cholesky factor in the lower triangle; `None` if the matrix is not positive definite.
fn factorise(matrix: &mut [f64], n: usize) -> Option<()> {
    for i in 0..n {
        let (above, below) = matrix.split_at_mut(i * n);
        let row = &mut below[..n];
        for j in 0..i {
            let other = &above[j * n..j * n + j];
            let inner: f64 = row[..j].iter().zip(other).map(|(a, b)| a * b).sum();
            row[j] = (row[j] - inner) / above[j * n + j];
        }
        let rest = row[i] - row[..i].iter().map(|a| a * a).sum::<f64>();
        if rest.is_nan() || rest <= 0.0 {
            return None;
        }
        row[i] = rest.sqrt();
    }
    Some(())
}

fn solve(factor: &[f64], n: usize, right: &mut [f64]) {
    for i in 0..n {
        let inner: f64 = factor[i * n..i * n + i].iter().zip(&right[..i]).map(|(a, b)| a * b).sum();
        right[i] = (right[i] - inner) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let inner: f64 = (i + 1..n).map(|k| factor[k * n + i] * right[k]).sum();
        right[i] = (right[i] - inner) / factor[i * n + i];
    }
}

/// The least-squares polynomial of a function of one number over an interval, by ascending powers, and its
/// largest error there.
pub fn polynomial_of_one(
    function: &dyn Fn(f64) -> f64,
    domain: (f64, f64),
    order: usize,
) -> Option<(Vec<f64>, f64)> {
    const POINTS: usize = 400;
    if domain.1 - domain.0 < 1e-12 {
        return Some((vec![function(domain.0)], 0.0));
    }
    // Denser towards the ends, as the extrema of Chebyshev polynomials are: near to the least largest error.
    let at = |i: usize| {
        let u = (std::f64::consts::PI * i as f64 / (POINTS - 1) as f64).cos();
        0.5 * (domain.0 + domain.1) + 0.5 * (domain.1 - domain.0) * u
    };
    let x: Vec<Vec<f64>> = (0..POINTS).map(|i| vec![at(i)]).collect();
    let y: Vec<Vec<f64>> = x.iter().map(|x| vec![function(x[0])]).collect();
    let polynomial = polynomials(order, &[domain], &x, &y)?.pop()?;
    let worst =
        x.iter().zip(&y).map(|(x, y)| (polynomial.apply(&x[..]) - y[0]).abs()).fold(0.0, f64::max);
    Some((polynomial.coefficients().to_vec(), worst))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_two_variables_is_found_again() {
        // 1 + 2y + 3y² + 4x + 5xy + 6x² over an oblong that is not about 0.
        let truth =
            MultivariatePolynomial::up_to_order(2, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
        let x: Vec<Vec<f64>> = (0..100)
            .map(|i| vec![0.5 + f64::from(i % 10) * 0.2, f64::from(i / 10) * 0.1 - 0.3])
            .collect();
        let y: Vec<Vec<f64>> = x.iter().map(|x| vec![truth.apply(x)]).collect();
        let found = polynomials(2, &[(0.5, 2.3), (-0.3, 0.6)], &x, &y).unwrap();
        for (found, truth) in found[0].coefficients().iter().zip(truth.coefficients()) {
            assert!((found - truth).abs() < 1e-9, "{found} {truth}");
        }
    }

    #[test]
    fn the_sine_is_a_polynomial_of_order_four_up_to_its_remainder() {
        // Over ±0.5 the Taylor remainder of order 5 is 0.5⁵/120 = 2.6e-4 at most; a least-squares fit is nearer.
        let (coefficients, worst) = polynomial_of_one(&f64::sin, (-0.5, 0.5), 4).unwrap();
        assert_eq!(coefficients.len(), 5);
        assert!(worst < 2.6e-4 && worst > 1e-7, "{worst}");
    }
}
