//! A factorised design: rows of terms, which of them belong together, intervals, and fits without a part.
//!
//! With n rows the centred terms are X = Q·R and q the rows of [1/√n, Q]. The observations that belong together are
//! parts g, Sg = qgᵀqg. All that is asked about parts is small in the coordinates γ = qᵀy (as many as there are terms):
//!
//! ```text
//! without part g      γ' = (I - Sg)⁻¹ (γ - qgᵀyg)
//! variance of γ       Σ_g s sᵀ,   s = (I - Sg)^(-1/2) qgᵀeg        e the residuals: CR2 of Bell & McCaffrey 2002
//! of a coefficient    l·γ: its degrees of freedom are (tr B)²/tr B², with wg = (I - Sg)^(-1/2) l,
//!                     Bgg = wgᵀSg wg - |Sg wg|²,  Bgh = -(Sg wg)·(Sh wh)    (Satterthwaite, independent errors)
//! ```
//!
//! (I - qgqgᵀ)^(-1/2), which CR2 asks for, has as many rows as the part has frames; qgᵀ commutes with its powers.
//! With a ridge the variance is CR1: s = qgᵀeg, times G/(G - 1)·(n - 1)/(n - p), with G - 1 degrees of freedom.

use condyle_solve::eigen;
use condyle_solve::regression::Regression;
use std::ops::Range;

/// Of I - S a smaller eigenvalue is 0: without this part nothing is known of that direction.
const UNDETERMINED: f64 = 1e-9;
/// A column whose spread is so small beside its values is constant.
const CONSTANT: f64 = 1e-12;

pub(super) struct Design {
    pub(super) fit: Regression,
    /// The mean of each term.
    means: Vec<f64>,
    /// The rows of each part.
    pub(super) parts: Vec<Range<usize>>,
    rows: usize,
    /// The number of coordinates: the rank, and one for the constant.
    width: usize,
    /// Row by row [1/√n, Q].
    q: Vec<f64>,
    /// S of each part.
    grams: Vec<Vec<f64>>,
    ridge: bool,
}

/// A fit of one dependent.
pub(super) struct Fitted {
    pub(super) intercept: f64,
    pub(super) coefficients: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    gamma: Vec<f64>,
}

/// A coefficient's spread.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub(super) error: f64,
    pub(super) freedom: f64,
}

impl Design {
    /// `terms` row by row, `count` numbers each; parts are rows that follow each other. The ridge is relative to each
    /// term's sum of squares about its mean.
    pub(super) fn new(terms: &[f64], count: usize, parts: Vec<Range<usize>>, ridge: f64) -> Self {
        let rows = terms.len() / count.max(1);
        let n = rows as f64;
        let mut means = vec![0.0; count];
        let mut squares = vec![0.0f64; count];
        for row in terms.chunks_exact(count.max(1)) {
            for (j, x) in row.iter().enumerate() {
                means[j] += x / n;
                squares[j] += x * x;
            }
        }
        let mut centred: Vec<f64> = terms.to_vec();
        let mut about = vec![0.0f64; count];
        for row in centred.chunks_exact_mut(count.max(1)) {
            for (j, x) in row.iter_mut().enumerate() {
                *x -= means[j];
                about[j] += *x * *x;
            }
        }
        let constant: Vec<bool> =
            (0..count).map(|j| about[j] <= CONSTANT * CONSTANT * squares[j]).collect();
        for row in centred.chunks_exact_mut(count.max(1)) {
            row.iter_mut().zip(&constant).filter(|(_, c)| **c).for_each(|(x, _)| *x = 0.0);
        }
        let penalties: Vec<f64> =
            if ridge > 0.0 { about.iter().map(|s| ridge * s).collect() } else { vec![] };
        let fit = Regression::new(&centred, count, &penalties);
        let width = fit.rank() + 1;
        let root = 1.0 / n.sqrt();
        let mut q = Vec::with_capacity(rows * width);
        for row in 0..rows {
            q.push(root);
            q.extend_from_slice(&fit.basis()[row * (width - 1)..(row + 1) * (width - 1)]);
        }
        let grams = parts.iter().map(|part| gram(&q, width, part)).collect();
        Self { fit, means, parts, rows, width, q, grams, ridge: ridge > 0.0 }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.q[row * self.width..(row + 1) * self.width]
    }

    fn projected(&self, y: &[f64], rows: impl Iterator<Item = usize>) -> Vec<f64> {
        let mut gamma = vec![0.0; self.width];
        for row in rows {
            gamma.iter_mut().zip(self.row(row)).for_each(|(sum, q)| *sum += q * y[row]);
        }
        gamma
    }

    pub(super) fn fitted(&self, y: &[f64]) -> Fitted {
        // About the mean, which takes less of the digits.
        let mean = y.iter().sum::<f64>() / self.rows as f64;
        let about: Vec<f64> = y.iter().map(|y| y - mean).collect();
        let mut gamma = self.projected(&about, 0..self.rows);
        gamma[0] = 0.0;
        let coefficients = self.fit.coefficients(&gamma[1..]);
        let residuals = (0..self.rows).map(|row| about[row] - dot(self.row(row), &gamma)).collect();
        gamma[0] = mean * (self.rows as f64).sqrt();
        let intercept = mean - dot(&self.means, &coefficients);
        Fitted { intercept, coefficients, residuals, gamma }
    }

    /// The predictions of some parts' rows by the fit of all others, in the order of the parts; `None` where nothing is
    /// left.
    pub(super) fn left_out(&self, y: &[f64], fitted: &Fitted, parts: &[usize]) -> Option<Vec<f64>> {
        let width = self.width;
        let mut rest = vec![0.0; width * width];
        (0..width).for_each(|i| rest[i * width + i] = 1.0);
        let mut gamma = fitted.gamma.clone();
        let mut rows = 0;
        for &part in parts {
            rest.iter_mut().zip(&self.grams[part]).for_each(|(r, g)| *r -= g);
            let own = self.projected(y, self.parts[part].clone());
            gamma.iter_mut().zip(own).for_each(|(g, own)| *g -= own);
            rows += self.parts[part].len();
        }
        if rows >= self.rows {
            return None;
        }
        let inverse =
            eigen::function(&rest, width, |v| if v > UNDETERMINED { 1.0 / v } else { 0.0 });
        let moved = times(&inverse, &gamma);
        let all = parts.iter().flat_map(|part| self.parts[*part].clone());
        Some(all.map(|row| dot(self.row(row), &moved)).collect())
    }

    /// The rows that l·γ has for the intercept and each coefficient.
    fn maps(&self) -> Vec<Vec<f64>> {
        let rank = self.width - 1;
        let mut all = vec![vec![0.0; self.width]; self.means.len() + 1];
        all[0][0] = 1.0 / (self.rows as f64).sqrt();
        let mut unit = vec![0.0; rank];
        for k in 0..rank {
            unit.iter_mut().for_each(|x| *x = 0.0);
            unit[k] = 1.0;
            let column = self.fit.coefficients(&unit);
            all[0][k + 1] = -dot(&self.means, &column);
            for (j, b) in column.into_iter().enumerate() {
                all[j + 1][k + 1] = b;
            }
        }
        all
    }

    /// (I - S)^(-1/2) of each part; the identity with a ridge.
    fn adjustments(&self) -> Vec<Vec<f64>> {
        let width = self.width;
        let of = |gram: &Vec<f64>| {
            if self.ridge {
                let mut one = vec![0.0; width * width];
                (0..width).for_each(|i| one[i * width + i] = 1.0);
                return one;
            }
            let weight =
                |v: f64| if 1.0 - v > UNDETERMINED { (1.0 - v).sqrt().recip() } else { 0.0 };
            eigen::function(gram, width, weight)
        };
        self.grams.iter().map(of).collect()
    }

    /// What intervals need that is the same for all dependents.
    pub(super) fn clusters(&self) -> Clusters<'_> {
        let (maps, adjustments) = (self.maps(), self.adjustments());
        let count = self.parts.len() as f64;
        let freedoms = maps.iter().map(|map| {
            if self.ridge {
                return count - 1.0;
            }
            let own: Vec<(f64, Vec<f64>)> = adjustments
                .iter()
                .zip(&self.grams)
                .map(|(adjustment, gram)| {
                    let w = times(adjustment, map);
                    let sw = times(gram, &w);
                    (dot(&w, &sw), sw)
                })
                .collect();
            let (mut trace, mut square) = (0.0, 0.0);
            for (g, (wsw, a)) in own.iter().enumerate() {
                for (h, (_, b)) in own.iter().enumerate() {
                    let entry = if g == h { wsw - dot(a, a) } else { -dot(a, b) };
                    trace += if g == h { entry } else { 0.0 };
                    square += entry * entry;
                }
            }
            if square > 0.0 { trace * trace / square } else { 0.0 }
        });
        Clusters { freedoms: freedoms.collect(), maps, adjustments, design: self }
    }
}

/// Standard errors of the intercept and the coefficients.
pub(super) struct Clusters<'d> {
    design: &'d Design,
    maps: Vec<Vec<f64>>,
    adjustments: Vec<Vec<f64>>,
    freedoms: Vec<f64>,
}

impl Clusters<'_> {
    /// The intercept's, and that of each coefficient; of dropped ones 0.
    pub(super) fn spreads(&self, fitted: &Fitted) -> Vec<Spread> {
        let design = self.design;
        let scores: Vec<Vec<f64>> = design
            .parts
            .iter()
            .zip(&self.adjustments)
            .map(|(part, adjustment)| {
                times(adjustment, &design.projected(&fitted.residuals, part.clone()))
            })
            .collect();
        let (n, parts) = (design.rows as f64, design.parts.len() as f64);
        let factor = match design.ridge {
            true => parts / (parts - 1.0) * (n - 1.0) / (n - design.width as f64),
            false => 1.0,
        };
        let of = |(map, freedom): (&Vec<f64>, &f64)| {
            let variance: f64 = scores.iter().map(|score| dot(map, score).powi(2)).sum();
            Spread { error: (factor * variance).sqrt(), freedom: *freedom }
        };
        self.maps.iter().zip(&self.freedoms).map(of).collect()
    }
}

fn gram(q: &[f64], width: usize, rows: &Range<usize>) -> Vec<f64> {
    let mut gram = vec![0.0; width * width];
    for row in q[rows.start * width..rows.end * width].chunks_exact(width) {
        for i in 0..width {
            for j in 0..width {
                gram[i * width + j] += row[i] * row[j];
            }
        }
    }
    gram
}

fn times(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(x.len()).map(|row| dot(row, x)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
