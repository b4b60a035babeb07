//! The interpolating cubic spline of SIMM and OpenSim.

use super::{KnotError, check_knots, interval};

/// The cubic spline through knots that SIMM and OpenSim compute.
///
/// It is twice continuously differentiable inside. At each end the *third* derivative equals that
/// of the cubic through the four outermost knots: this is the spline of Forsythe, Malcolm and Moler
/// (*Computer Methods for Mathematical Computations*, 1977, chapter 4), not the natural spline.
/// Outside the knots it is extrapolated linearly with the end slope. Three knots make a parabola,
/// two a line, one a constant.
#[derive(Clone, Debug, PartialEq)]
pub struct SimmSpline {
    x: Vec<f64>,
    /// For each knot: value, and the coefficients of (t, t², t³) in the interval to its right.
    cubic: Vec<[f64; 4]>,
}

impl SimmSpline {
    /// The spline through the knots (x, y), with x increasing.
    ///
    /// # Errors
    /// [`KnotError`] for no knots, lists of different length, non-increasing or non-finite numbers.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, KnotError> {
        check_knots(&x, &y, true)?;
        let n = x.len();
        if n < 3 {
            let slope = if n == 2 { (y[1] - y[0]) / (x[1] - x[0]) } else { 0.0 };
            let cubic = y.iter().map(|&y| [y, slope, 0.0, 0.0]).collect();
            return Ok(Self { x, cubic });
        }
        // The unknowns are sigma, a sixth of the second derivative at each knot. The system is
        // symmetric and tridiagonal, with the widths beside the diagonal. An interior row makes the
        // slope continuous, an end row sets the third derivative: (σ₁ - σ₀)/h₀ is a sixth of it.
        let width: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        let chord: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / width[i]).collect();
        let mut diagonal = vec![0.0; n];
        let mut sigma = vec![0.0; n];
        for i in 1..n - 1 {
            diagonal[i] = 2.0 * (width[i - 1] + width[i]);
            sigma[i] = chord[i] - chord[i - 1];
        }
        diagonal[0] = -width[0];
        diagonal[n - 1] = -width[n - 2];
        if n > 3 {
            // Third divided differences of the first and of the last four knots, each a sixth of
            // the third derivative of the cubic through them. With three knots it is 0: a parabola.
            let second = |i: usize| (chord[i + 1] - chord[i]) / (x[i + 2] - x[i]);
            let third = |i: usize| (second(i + 1) - second(i)) / (x[i + 3] - x[i]);
            sigma[0] = width[0] * width[0] * third(0);
            sigma[n - 1] = -width[n - 2] * width[n - 2] * third(n - 4);
        }
        // Gaussian elimination without pivoting. No pivot is 0: the first is -h₀, those between
        // stay above 2·(hᵢ₋₁ + hᵢ) - hᵢ₋₁, and the last stays below -h of the last interval.
        for i in 1..n {
            let ratio = width[i - 1] / diagonal[i - 1];
            diagonal[i] -= ratio * width[i - 1];
            sigma[i] -= ratio * sigma[i - 1];
        }
        sigma[n - 1] /= diagonal[n - 1];
        for i in (0..n - 1).rev() {
            sigma[i] = (sigma[i] - width[i] * sigma[i + 1]) / diagonal[i];
        }
        // y + t·b + t²·c + t³·d with c = 3σᵢ and d = (σᵢ₊₁ - σᵢ)/hᵢ; b makes it reach y[i + 1].
        let mut cubic: Vec<[f64; 4]> = (0..n - 1)
            .map(|i| {
                let (s, t) = (sigma[i], sigma[i + 1]);
                [y[i], chord[i] - width[i] * (t + 2.0 * s), 3.0 * s, (t - s) / width[i]]
            })
            .collect();
        // The last entry is only read for the linear extrapolation to the right.
        let end_slope = chord[n - 2] + width[n - 2] * (sigma[n - 2] + 2.0 * sigma[n - 1]);
        cubic.push([y[n - 1], end_slope, 0.0, 0.0]);
        Ok(Self { x, cubic })
    }

    /// Value and derivative at `at`.
    #[inline]
    pub fn value_and_slope(&self, at: f64) -> (f64, f64) {
        let last = self.x.len() - 1;
        if at >= self.x[last] || last == 0 {
            let [y, b, ..] = self.cubic[last];
            return (y + b * (at - self.x[last]), b);
        }
        if at <= self.x[0] {
            let [y, b, ..] = self.cubic[0];
            return (y + b * (at - self.x[0]), b);
        }
        let i = interval(&self.x, at);
        let [y, b, c, d] = self.cubic[i];
        let t = at - self.x[i];
        (y + t * (b + t * (c + t * d)), b + t * (2.0 * c + t * 3.0 * d))
    }

    /// Value and first three derivatives at `at`; at a knot those of the interval to its right.
    ///
    /// ```
    /// use condyle_math::function::SimmSpline;
    /// // Through four points of x³ the spline is x³: 8, 12, 12, 6 at 2.
    /// let cube = SimmSpline::new(vec![0.0, 1.0, 2.5, 3.0], vec![0.0, 1.0, 15.625, 27.0]).unwrap();
    /// let exact = [8.0, 12.0, 12.0, 6.0];
    /// assert!(cube.derivatives(2.0).iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-12));
    /// ```
    pub fn derivatives(&self, at: f64) -> [f64; 4] {
        let last = self.x.len() - 1;
        if at >= self.x[last] || at < self.x[0] || last == 0 {
            let (value, slope) = self.value_and_slope(at);
            return [value, slope, 0.0, 0.0];
        }
        let i = interval(&self.x, at);
        let [y, b, c, d] = self.cubic[i];
        let t = at - self.x[i];
        [
            y + t * (b + t * (c + t * d)),
            b + t * (2.0 * c + t * 3.0 * d),
            2.0 * c + 6.0 * d * t,
            6.0 * d,
        ]
    }

    /// The knots, argument and value.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.cubic.iter().map(|c| c[0]))
    }

    /// Makes it x ↦ `result`·f(x/`argument`); unchanged where the knots would not increase.
    pub fn stretch(&mut self, result: f64, argument: f64) {
        let (x, y) = self.knots().map(|(x, y)| (x * argument, y * result)).unzip();
        if let Ok(stretched) = Self::new(x, y) {
            *self = stretched;
        }
    }

    /// First and last argument.
    pub fn domain(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[allow(clippy::approx_constant, reason = "the knots as published")]
    /// Knee of gait2392 (Yamaguchi & Zajac 1989; Delp et al. 1990): flexion (rad) to metres.
    fn knee() -> (SimmSpline, SimmSpline) {
        let forward = SimmSpline::new(
            vec![
                -2.0944, -1.74533, -1.39626, -1.0472, -0.698132, -0.349066, -0.174533, 0.197344,
                0.337395, 0.490178, 1.52146, 2.0944,
            ],
            vec![
                -0.0032, 0.00179, 0.00411, 0.0041, 0.00212, -0.001, -0.0031, -0.005227, -0.005435,
                -0.005574, -0.005435, -0.00525,
            ],
        );
        let up = SimmSpline::new(
            vec![-2.0944, -1.22173, -0.523599, -0.349066, -0.174533, 0.159149, 2.0944],
            vec![-0.4226, -0.4082, -0.399, -0.3976, -0.3966, -0.395264, -0.396],
        );
        (forward.unwrap(), up.unwrap())
    }

    #[test]
    fn knee_golden_values() {
        // Degrees, forward mm, up mm, evaluated with the published end condition. -140 is outside
        // the knots; at -110 a natural spline would differ by 0.14 mm.
        let golden = [
            (-140.0, -9.645639, -427.95950),
            (-90.0, 3.258752, -413.99220),
            (-75.0, 4.319661, -409.61308),
            (-60.0, 4.0999916, -405.49607),
            (-45.0, 2.729400, -401.87857),
            (-30.0, 0.757712, -399.00000),
            (-15.0, -2.072733, -397.06109),
            (-5.0, -3.910036, -396.18837),
            (0.0, -4.499857, -395.82070),
            (5.0, -4.908674, -395.49718),
            (10.0, -5.175703, -395.21801),
        ];
        let (forward, up) = knee();
        for (degrees, mm_forward, mm_up) in golden {
            let at = f64::to_radians(degrees);
            assert!((1e3 * forward.value_and_slope(at).0 - mm_forward).abs() < 1e-5, "{degrees}");
            assert!((1e3 * up.value_and_slope(at).0 - mm_up).abs() < 1e-5, "{degrees}");
        }
        assert!((1e3 * forward.value_and_slope(f64::to_radians(-110.0)).0 + 0.348091).abs() < 1e-6);
    }

    #[test]
    fn a_cubic_is_reproduced_exactly() {
        // The end condition is exact for cubics: the spline through points of a cubic is that
        // cubic.
        let f = |x: f64| 0.3 - 1.1 * x + 0.4 * x * x + 0.9 * x * x * x;
        let x = vec![-1.0, -0.3, 0.2, 0.9, 1.4];
        let spline = SimmSpline::new(x.clone(), x.iter().map(|&x| f(x)).collect()).unwrap();
        for i in 0..100 {
            let at = -1.0 + 2.4 * f64::from(i) / 99.0;
            assert!((spline.value_and_slope(at).0 - f(at)).abs() < 1e-14);
        }
    }

    #[test]
    fn it_goes_on_straight_outside_its_knots() {
        let (forward, _) = knee();
        let (lowest, _) = forward.domain();
        let (y0, slope) = forward.value_and_slope(lowest);
        let (y1, same) = forward.value_and_slope(lowest - 0.5);
        assert_eq!(slope, same);
        assert!((y1 - (y0 - 0.5 * slope)).abs() < 1e-15);
    }
}
