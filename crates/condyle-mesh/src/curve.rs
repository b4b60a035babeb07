//! Smooth curves through given points.

use condyle_math::Vec3;

/// A point of a curve with its width in two directions.
pub(crate) type Knot = (Vec3, [f64; 2]);

/// Points of the curve through all knots, `steps` to each span, both ends included.
///
/// Cubic Hermite in each span, over the distance between knots; the slope at a knot is that of the parabola
/// through it and its neighbours. Widths have no more than their neighbours' slopes, so that a curve through
/// rising widths rises.
pub(crate) fn through(knots: &[Knot], closed: bool, steps: usize) -> Vec<Knot> {
    let count = knots.len();
    let spans = if closed { count } else { count.saturating_sub(1) };
    if count < 2 || (count == 2 && !closed) {
        return knots.to_vec();
    }
    let at = |i: usize| knots[i % count];
    let chord = |i: usize| (at(i + 1).0 - at(i).0).norm().max(1e-9);
    // Slopes on both sides of a knot, and the lengths over which they are.
    let sides = |i: usize| -> [Option<usize>; 2] {
        let before = if i > 0 { Some(i - 1) } else { closed.then_some(count - 1) };
        let after = (i < spans).then_some(i);
        [before, after]
    };
    let slope = |i: usize| -> (Vec3, [f64; 2]) {
        let point = |s: usize| (at(s + 1).0 - at(s).0) * chord(s).recip();
        let width = |s: usize, w: usize| (at(s + 1).1[w] - at(s).1[w]) / chord(s);
        match sides(i % count) {
            [Some(a), Some(b)] => {
                let (ha, hb) = (chord(a), chord(b));
                let p = (point(a) * hb + point(b) * ha) * (ha + hb).recip();
                let narrow = |w: usize| {
                    let (s, t) = (width(a, w), width(b, w));
                    // The harmonic mean: zero where the width turns.
                    if s * t <= 0.0 { 0.0 } else { 2.0 * s * t / (s + t) }
                };
                (p, [narrow(0), narrow(1)])
            }
            [Some(s), None] | [None, Some(s)] => (point(s), [width(s, 0), width(s, 1)]),
            [None, None] => (Vec3::ZERO, [0.0; 2]),
        }
    };
    let mut curve = vec![];
    for span in 0..spans {
        let ((p, r), (q, s)) = (at(span), at(span + 1));
        let ((dp, dr), (dq, ds)) = (slope(span), slope(span + 1));
        let h = chord(span);
        for step in 0..steps {
            let t = step as f64 / steps as f64;
            let (t2, t3) = (t * t, t * t * t);
            let (a, b) = (2.0 * t3 - 3.0 * t2 + 1.0, t3 - 2.0 * t2 + t);
            let (c, d) = (3.0 * t2 - 2.0 * t3, t3 - t2);
            let point = p * a + dp * (b * h) + q * c + dq * (d * h);
            let width =
                [0, 1].map(|w| (a * r[w] + b * h * dr[w] + c * s[w] + d * h * ds[w]).max(0.0));
            curve.push((point, width));
        }
    }
    if !closed {
        curve.push(at(spans));
    }
    curve
}
