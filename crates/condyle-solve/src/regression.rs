//! Linear least squares that says which of its columns the data determine.
//!
//! ```text
//! minimise |X b - y|² + Σ pⱼ bⱼ²        X with one row an observation, one column a term; p the ridge
//! ```
//!
//! The columns are scaled to length 1 and factorised as X·P = Q·R by Householder reflections with column pivoting
//! (Golub & Van Loan 2013, algorithm 5.4.1): at every step the column that is longest after the others are taken out of
//! it comes next. Where what is left of all is shorter than a tolerance, the rest are sums of those before: they are
//! *dropped*, their coefficients are 0, and the factorisation says of which columns they are the sum. A solver that is
//! silent about that gives one of infinitely many answers.
//!
//! Q has orthonormal columns. In its coordinates γ = Qᵀy everything about parts of the rows is small: without the rows of
//! a part g the coefficients are (I - QgᵀQg)⁻¹(γ - Qgᵀyg), whatever the number of rows.

/// A factorised design.
#[derive(Clone, Debug)]
pub struct Regression {
    rows: usize,
    columns: usize,
    rank: usize,
    /// The columns in the order in which they were taken.
    order: Vec<usize>,
    /// The length of each column, by which it was divided.
    scales: Vec<f64>,
    /// R of the columns in their order, row by row, `rank` rows of `columns`.
    upper: Vec<f64>,
    /// Q, row by row, `rank` numbers for each of the rows that were given.
    basis: Vec<f64>,
}

/// A scaled column of which less is left is a sum of the others.
pub const TOLERANCE: f64 = 1e-10;

impl Regression {
    /// Factorises a design, given row by row, `columns` numbers each.
    ///
    /// `ridge` has a penalty for each column, or is empty for none. Columns of length 0 are dropped. Numbers that are
    /// not finite give coefficients that are not.
    ///
    /// ```
    /// use condyle_solve::regression::Regression;
    /// // y = 1 + 2 x at x = 0, 1, 2; the third column is the sum of the others.
    /// let design = [1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 2.0, 3.0];
    /// let fit = Regression::new(&design, 3, &[]);
    /// assert_eq!((fit.rank(), fit.dropped().len()), (2, 1));
    /// let b = fit.solve(&[1.0, 3.0, 5.0]);
    /// for (row, y) in design.chunks(3).zip([1.0, 3.0, 5.0]) {
    ///     let sum: f64 = row.iter().zip(&b).map(|(x, b)| x * b).sum();
    ///     assert!((sum - y).abs() < 1e-14);
    /// }
    /// ```
    #[must_use]
    pub fn new(design: &[f64], columns: usize, ridge: &[f64]) -> Self {
        let given = design.len().checked_div(columns).unwrap_or(0);
        let rows = given + if ridge.is_empty() { 0 } else { columns };
        // Column by column, the penalties as rows below.
        let mut work = vec![0.0; rows * columns];
        let mut scales = vec![0.0; columns];
        for column in 0..columns {
            let part = &mut work[column * rows..(column + 1) * rows];
            for (row, x) in part[..given].iter_mut().enumerate() {
                *x = design[row * columns + column];
            }
            let length = norm(&part[..given]);
            scales[column] = length;
            if length > 0.0 {
                part.iter_mut().for_each(|x| *x /= length);
            }
            if let (Some(penalty), true) = (ridge.get(column), rows > given) {
                part[given + column] =
                    penalty.max(0.0).sqrt() / if length > 0.0 { length } else { 1.0 };
            }
        }
        let mut order: Vec<usize> = (0..columns).collect();
        let mut reflections: Vec<Vec<f64>> = vec![];
        let mut upper = vec![];
        let most = rows.min(columns);
        let mut rank = 0;
        while rank < most {
            // The lengths are computed anew: a design has few columns, and updating them loses digits.
            let left = |column: usize| norm(&work[column * rows + rank..(column + 1) * rows]);
            let longest = (rank..columns)
                .map(|place| (place, left(order[place])))
                .fold((rank, -1.0), |best, one| if one.1 > best.1 { one } else { best });
            let (place, length) = longest;
            // What is not a number is not dropped, so that it is seen in the answer.
            if length <= TOLERANCE {
                break;
            }
            order.swap(rank, place);
            let pivot = order[rank];
            let mut reflection = work[pivot * rows + rank..(pivot + 1) * rows].to_vec();
            let head = if reflection[0] > 0.0 { -length } else { length };
            reflection[0] -= head;
            let size = norm(&reflection);
            if size > 0.0 {
                reflection.iter_mut().for_each(|x| *x /= size);
            }
            for place in rank..columns {
                let column = order[place];
                let part = &mut work[column * rows + rank..(column + 1) * rows];
                reflect(&reflection, part);
            }
            reflections.push(reflection);
            rank += 1;
        }
        for row in 0..rank {
            for place in 0..columns {
                let below = row > place;
                upper.push(if below { 0.0 } else { work[order[place] * rows + row] });
            }
        }
        // Q = H₁ H₂ … applied to the first unit vectors.
        let mut basis = vec![0.0; given * rank];
        let mut unit = vec![0.0; rows];
        for column in 0..rank {
            unit.iter_mut().for_each(|x| *x = 0.0);
            unit[column] = 1.0;
            for (step, reflection) in reflections.iter().enumerate().rev() {
                reflect(reflection, &mut unit[step..]);
            }
            for row in 0..given {
                basis[row * rank + column] = unit[row];
            }
        }
        Self { rows: given, columns, rank, order, scales, upper, basis }
    }

    /// How many rows were given.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns there are.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// How many columns are no sum of the others.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// The columns that are kept, the one that says most first.
    #[must_use]
    pub fn kept(&self) -> &[usize] {
        &self.order[..self.rank]
    }

    /// The columns that are sums of those that are kept.
    #[must_use]
    pub fn dropped(&self) -> &[usize] {
        &self.order[self.rank..]
    }

    /// Q: for each row [`Self::rank`] numbers. Without a ridge its columns are orthonormal.
    #[must_use]
    pub fn basis(&self) -> &[f64] {
        &self.basis
    }

    /// The coefficients whose coordinates in Q are γ; 0 for dropped columns.
    ///
    /// # Panics
    /// If there are fewer than [`Self::rank`] coordinates.
    #[must_use]
    pub fn coefficients(&self, gamma: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; self.columns];
        let solved = self.back(gamma);
        for (place, value) in solved.into_iter().enumerate() {
            let column = self.order[place];
            found[column] = value / self.scales[column];
        }
        found
    }

    /// R⁻¹γ of the kept, scaled columns.
    fn back(&self, gamma: &[f64]) -> Vec<f64> {
        let mut x = gamma[..self.rank].to_vec();
        for row in (0..self.rank).rev() {
            let line = &self.upper[row * self.columns..(row + 1) * self.columns];
            let sum: f64 = (row + 1..self.rank).map(|k| line[k] * x[k]).sum();
            x[row] = (x[row] - sum) / line[row];
        }
        x
    }

    /// Qᵀy.
    ///
    /// # Panics
    /// If `y` has another number of rows.
    #[must_use]
    pub fn project(&self, y: &[f64]) -> Vec<f64> {
        assert_eq!(y.len(), self.rows, "a number for each row");
        let mut gamma = vec![0.0; self.rank];
        if self.rank > 0 {
            for (row, y) in self.basis.chunks_exact(self.rank).zip(y) {
                gamma.iter_mut().zip(row).for_each(|(sum, q)| *sum += q * y);
            }
        }
        gamma
    }

    /// The coefficients that minimise; 0 for dropped columns.
    ///
    /// # Panics
    /// If `y` has another number of rows.
    #[must_use]
    pub fn solve(&self, y: &[f64]) -> Vec<f64> {
        self.coefficients(&self.project(y))
    }

    /// The coefficients that give a dropped column as a sum of the kept; 0 for the others.
    #[must_use]
    pub fn dependence(&self, dropped: usize) -> Vec<f64> {
        let place = self.order.iter().position(|column| *column == dropped);
        let Some(place) = place.filter(|place| *place >= self.rank) else {
            return vec![0.0; self.columns];
        };
        let gamma: Vec<f64> =
            (0..self.rank).map(|row| self.upper[row * self.columns + place]).collect();
        let scale = self.scales[dropped];
        self.coefficients(&gamma).into_iter().map(|b| b * scale).collect()
    }

    /// The ratio of the largest to the least singular value of the kept columns, each scaled to length 1: 1 where they are
    /// perpendicular; beyond 30 they are nearly dependent (Belsley, Kuh & Welsch 1980).
    #[must_use]
    pub fn condition(&self) -> f64 {
        let n = self.rank;
        let mut gram = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                gram[i * n + j] = (0..n)
                    .map(|k| self.upper[k * self.columns + i] * self.upper[k * self.columns + j])
                    .sum();
            }
        }
        let values = crate::eigen::symmetric(&gram, n).0;
        let (least, most) = values
            .iter()
            .fold((f64::INFINITY, 0.0f64), |(least, most), v| (least.min(*v), most.max(*v)));
        if n == 0 { 1.0 } else { (most / least.max(f64::MIN_POSITIVE)).sqrt() }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// x - 2 v (v·x).
fn reflect(v: &[f64], x: &mut [f64]) {
    let along: f64 = v.iter().zip(&*x).map(|(v, x)| v * x).sum();
    x.iter_mut().zip(v).for_each(|(x, v)| *x -= 2.0 * along * v);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a fixed sequence between -1 and 1.
    fn numbers(count: usize) -> Vec<f64> {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        (0..count).map(|_| next()).collect()
    }

    /// The residual of a minimum is perpendicular to every column (the normal equations).
    #[test]
    fn the_residual_is_perpendicular_to_every_column() {
        let (rows, columns) = (40, 5);
        let design = numbers(rows * columns);
        let y = numbers(rows);
        for ridge in [vec![], vec![0.3, 0.0, 2.0, 1e-3, 5.0]] {
            let fit = Regression::new(&design, columns, &ridge);
            let b = fit.solve(&y);
            for j in 0..columns {
                let mut slope = -ridge.get(j).copied().unwrap_or(0.0) * b[j];
                for row in 0..rows {
                    let x = &design[row * columns..(row + 1) * columns];
                    let predicted: f64 = x.iter().zip(&b).map(|(x, b)| x * b).sum();
                    slope += x[j] * (y[row] - predicted);
                }
                assert!(slope.abs() < 1e-12, "{slope}");
            }
        }
    }

    #[test]
    fn a_sum_of_columns_is_named_with_its_parts() {
        let rows = 30;
        let two = numbers(rows * 2);
        let design: Vec<f64> =
            two.chunks(2).flat_map(|x| [x[0], 3.0 * x[0] - 0.5 * x[1], x[1], 0.0]).collect();
        let fit = Regression::new(&design, 4, &[]);
        assert_eq!(fit.rank(), 2);
        let zero = fit.dropped().iter().position(|column| *column == 3);
        assert!(zero.is_some());
        let sum = *fit.dropped().iter().find(|column| **column != 3).unwrap();
        let parts = fit.dependence(sum);
        for x in design.chunks(4) {
            let predicted: f64 = x.iter().zip(&parts).map(|(x, b)| x * b).sum();
            assert!((predicted - x[sum]).abs() < 1e-13);
        }
        assert_eq!(parts[sum], 0.0);
    }

    /// Two columns of length 1 with a cosine c have singular values √(1 ± c).
    #[test]
    fn the_condition_of_two_columns_follows_from_their_angle() {
        let c = 0.96f64;
        let design = [1.0, c, 0.0, (1.0 - c * c).sqrt()];
        let fit = Regression::new(&design, 2, &[]);
        assert!((fit.condition() - ((1.0 + c) / (1.0 - c)).sqrt()).abs() < 1e-12);
    }

    /// Against a second fit of the other rows.
    #[test]
    fn without_a_part_of_the_rows() {
        let (rows, columns) = (25, 3);
        let design = numbers(rows * columns);
        let y = numbers(rows);
        let fit = Regression::new(&design, columns, &[]);
        let part = 7;
        let q = &fit.basis()[..part * columns];
        let mut gram = vec![0.0; columns * columns];
        let mut gamma = fit.project(&y);
        for (row, y) in q.chunks(columns).zip(&y) {
            for i in 0..columns {
                gamma[i] -= row[i] * y;
                for j in 0..columns {
                    gram[i * columns + j] -= row[i] * row[j];
                }
            }
        }
        (0..columns).for_each(|i| gram[i * columns + i] += 1.0);
        let inverse = crate::eigen::function(&gram, columns, |value| 1.0 / value);
        let moved: Vec<f64> = (0..columns)
            .map(|i| (0..columns).map(|j| inverse[i * columns + j] * gamma[j]).sum())
            .collect();
        let found = fit.coefficients(&moved);
        let others = Regression::new(&design[part * columns..], columns, &[]).solve(&y[part..]);
        for (found, expected) in found.iter().zip(&others) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
}
