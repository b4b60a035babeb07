//! How much each pair of points of a contact counts, as rules.
//!
//! What a contact turns is a smooth function of where its segment is and of how much each pair of points counts; of
//! the drivers that choose among the pairs it is not, since those stop to matter beyond the outermost pairs. So the
//! shares of the pairs are values of their own, and polynomials are fitted through those:
//!
//! ```text
//! uᵢ = 2·nᵢ(driverᵢ) - 1      n as in the contact, from 0 to 1; a spline
//! sₖ = a polynomial of u₁ and u₂, the share of pair k
//! ```

use super::fit::polynomials;
use super::rule::{Rules, Value};
use condyle_math::Vec3;
use condyle_math::function::{Curve, FunctionOfSeveral, SimmSpline};
use condyle_model::component::{ContactPair, Gliding};

/// The order of the polynomials: with four pairs their points are within 0.02 mm.
const ORDER: usize = 16;
/// Values of each driver at which shares are computed: three times as many points as there are coefficients.
const SIDE: usize = 24;
/// Knots of a spline between the outermost pairs, and beyond them on each side.
const KNOTS: i32 = 64;
const BEYOND: i32 = 8;

/// The shares of the pairs of a contact but of one, or as many other numbers from which they follow by a line.
pub(super) fn shares(rules: &mut Rules, law: &Gliding, drivers: &[Value]) -> Vec<Value> {
    let pairs = law.pairs();
    // Points whose blends are the shares themselves.
    let corners = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 1.0)];
    let marked = pairs.iter().zip(corners);
    let marked = marked.map(|(pair, at)| ContactPair { first: at, second: at, at: pair.at });
    let place = law.ellipsoid_in_surface();
    let Ok(blend) = Gliding::new(place, law.radii(), law.axis(), marked.collect()) else {
        return vec![];
    };
    let mut inputs = vec![];
    let mut spans = vec![];
    for (i, &driver) in drivers.iter().take(2).enumerate() {
        let at = || pairs.iter().map(|pair| pair.at[i]);
        let low = at().fold(f64::INFINITY, f64::min);
        let span = at().fold(f64::NEG_INFINITY, f64::max) - low;
        if span.is_nan() || span < 1e-9 {
            continue;
        }
        let Some(spline) = share_of_span(low, span) else { return vec![] };
        inputs.push(rules.one(Curve::SimmSpline(spline).into(), driver));
        spans.push((i, low, span));
    }
    if spans.is_empty() {
        return vec![];
    }
    let count = SIDE.pow(spans.len() as u32);
    let (mut x, mut y) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for point in 0..count {
        let mut asked = vec![0.0; drivers.len().min(2)];
        let mut here = vec![];
        for (place, &(i, low, span)) in spans.iter().enumerate() {
            let step = if place == 0 { point % SIDE } else { point / SIDE };
            let u = -(std::f64::consts::PI * step as f64 / (SIDE - 1) as f64).cos();
            here.push(u);
            // The inverse of n = t²·(3 - 2t).
            let t = 0.5 - ((-u).asin() / 3.0).sin();
            asked[i] = low + span * t;
        }
        let [first, _] = blend.points(&asked);
        x.push(here);
        y.push(first.to_array()[..(pairs.len() - 1).min(3)].to_vec());
    }
    let domain = vec![(-1.0, 1.0); spans.len()];
    let found = polynomials(ORDER, &domain, &x, &y).unwrap_or_default();
    let polynomials = found.into_iter().map(FunctionOfSeveral::Polynomial);
    polynomials.map(|polynomial| rules.several(polynomial, &inputs)).collect()
}

/// 2·t²·(3 - 2t) - 1 with t how far a number is within a span, at its ends beyond.
fn share_of_span(low: f64, span: f64) -> Option<SimmSpline> {
    let knots = (-BEYOND..=KNOTS + BEYOND).map(|k| f64::from(k) / f64::from(KNOTS));
    let (x, y) = knots
        .map(|t| {
            let inside = t.clamp(0.0, 1.0);
            (low + span * t, 2.0 * inside * inside * (3.0 - 2.0 * inside) - 1.0)
        })
        .unzip();
    SimmSpline::new(x, y).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plain::Rule;
    use condyle_math::Affine;

    #[test]
    fn blended_points_follow_from_the_shares_inside_and_beyond_the_pairs() {
        let pair = |x: f64, y: f64, at| ContactPair {
            first: Vec3::new(0.01 + x, y, -0.1),
            second: Vec3::new(x, y - 0.05, -0.12),
            at,
        };
        let pairs = vec![
            pair(0.0, -0.04, [0.0, 0.0]),
            pair(0.002, -0.007, [0.8, 0.33]),
            pair(0.003, -0.013, [0.45, -0.14]),
            pair(0.001, -0.011, [0.05, 0.42]),
        ];
        let radii = Vec3::new(0.08, 0.2, 0.1);
        let law = Gliding::new(Affine::IDENTITY, radii, Vec3::Y, pairs.clone()).unwrap();
        let mut rules = Rules::default();
        let drivers = [0, 1].map(|v| rules.push(Rule::Variable(v)));
        let shares = shares(&mut rules, &law, &drivers);
        assert_eq!(shares.len(), 3);
        for i in 0..50 {
            let at = [f64::from(i % 10) * 0.13 - 0.2, f64::from(i / 10) * 0.2 - 0.3];
            let values = rules.evaluate(&at);
            // The blends of the corners are w₁ + w₄, w₂ + w₄ and w₃ + w₄, and all shares together 1.
            let s = [0, 1, 2].map(|k| values[shares[k]]);
            let fourth = (s[0] + s[1] + s[2] - 1.0) / 2.0;
            let w = [s[0] - fourth, s[1] - fourth, s[2] - fourth, fourth];
            let point = pairs.iter().zip(w).fold(Vec3::ZERO, |sum, (p, w)| sum + p.first * w);
            let off = (point - law.points(&at)[0]).norm();
            assert!(off < 2e-5, "{at:?}: {off}");
        }
    }
}
