//! Dense Cholesky factorisation `A = L Lᵀ` for a few dozen unknowns, without allocation.
//!
//! Matrices are `n × n`, row-major, in one slice of length `n * n`. The input is read from the lower
//! triangle. The factor is written to the *upper* triangle, as `U = Lᵀ`: a row of `U` is a column
//! of `L`, so every inner loop of the factorisation and of both substitutions runs over contiguous
//! memory and has no horizontal sum, which is what lets the compiler vectorise it.
//!
//! ```
//! use condyle_solve::cholesky;
//!
//! // A = [4 2; 2 5] = L Lᵀ with L = [2 0; 1 2]; the entry above the diagonal is not read.
//! let mut a = [4.0, f64::NAN, 2.0, 5.0];
//! cholesky::factor(&mut a, 2).unwrap();
//! let mut x = [8.0, 12.0];
//! cholesky::solve(&a, 2, &mut x);
//! assert_eq!(x, [1.0, 2.0]); // 4·1 + 2·2 = 8, 2·1 + 5·2 = 12
//! ```

use std::fmt;

/// The matrix is not positive definite to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PivotFailure {
    /// The first row whose pivot is not positive beyond rounding; the rows before it are factored.
    pub index: usize,
}

impl fmt::Display for PivotFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the matrix is not positive definite: pivot {} is not positive", self.index)
    }
}

impl std::error::Error for PivotFailure {}

/// Factors a symmetric positive definite matrix in place, `A = Uᵀ U` with `U = Lᵀ`.
///
/// - `a`: `n × n` row-major; the lower triangle with the diagonal holds `A`, the rest is not read.
///   On success the upper triangle with the diagonal holds `U`; the strict lower triangle keeps
///   its part of `A`.
/// - `n`: the number of rows.
///
/// # Errors
///
/// [`PivotFailure`] with the first row `k` whose pivot is at most `n ε A_kk` (ε = 2⁻⁵²) or is not a
/// number; the upper triangle then holds a partial factor.
///
/// # Panics
///
/// If `a.len() != n * n`.
///
/// ```
/// let mut a = [9.0, 0.0, 3.0, 2.0]; // [9 3; 3 2] = [3 0; 1 1] [3 1; 0 1]
/// condyle_solve::cholesky::factor(&mut a, 2).unwrap();
/// assert_eq!(a, [3.0, 1.0, 3.0, 1.0]);
///
/// let mut singular = [1.0, 0.0, 1.0, 1.0];
/// let failure = condyle_solve::cholesky::factor(&mut singular, 2).unwrap_err();
/// assert_eq!(failure.index, 1);
/// ```
pub fn factor(a: &mut [f64], n: usize) -> Result<(), PivotFailure> {
    assert_eq!(a.len(), n * n, "a Cholesky factor of {n} rows needs {n} x {n} numbers");
    for i in 1..n {
        let (above, row) = a.split_at_mut(i * n);
        for k in 0..i {
            above[k * n + i] = row[k];
        }
    }
    factor_upper(a, n)
}

/// Factors like [`factor`], reading `A` from the upper triangle.
///
/// Saves the transposition of [`factor`] if the caller can write the upper triangle itself. The
/// strict lower triangle is neither read nor written.
///
/// # Errors
///
/// As [`factor`].
///
/// # Panics
///
/// If `a.len() != n * n`.
///
/// ```
/// let mut a = [9.0, 3.0, f64::NAN, 2.0];
/// condyle_solve::cholesky::factor_upper(&mut a, 2).unwrap();
/// assert_eq!(a[..2], [3.0, 1.0]);
/// assert_eq!(a[3], 1.0);
/// ```
pub fn factor_upper(a: &mut [f64], n: usize) -> Result<(), PivotFailure> {
    assert_eq!(a.len(), n * n, "a Cholesky factor of {n} rows needs {n} x {n} numbers");
    let relative = n as f64 * f64::EPSILON;
    for j in 0..n {
        let (done, rest) = a.split_at_mut(j * n);
        let row = &mut rest[j..n];
        let threshold = relative * row[0];
        // Row j of A - Σ_k U_kᵀ U_k over the finished rows k < j (left-looking).
        subtract_rows(row, done, n, j, |k| done[k * n + j], 0..j);
        let pivot = row[0];
        if !(pivot > threshold && pivot < f64::INFINITY) {
            return Err(PivotFailure { index: j });
        }
        let root = pivot.sqrt();
        let scale = 1.0 / root;
        row[0] = root;
        for x in &mut row[1..] {
            *x *= scale;
        }
    }
    Ok(())
}

/// Solves `A x = b` with the factor of [`factor`]: `Uᵀ y = b`, then `U x = y`.
///
/// - `factor`: `n × n` row-major, `U` in the upper triangle.
/// - `b`: `n` numbers, the right-hand side; overwritten by `x`.
///
/// # Panics
///
/// If `factor.len() != n * n` or `b.len() != n`.
///
/// ```
/// let mut a = [2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 8.0];
/// condyle_solve::cholesky::factor(&mut a, 3).unwrap();
/// let mut x = [2.0, 2.0, 2.0];
/// condyle_solve::cholesky::solve(&a, 3, &mut x);
/// assert!((x[2] - 0.25).abs() < 1e-15);
/// ```
pub fn solve(factor: &[f64], n: usize, b: &mut [f64]) {
    assert_eq!(factor.len(), n * n, "the factor must have {n} x {n} numbers");
    assert_eq!(b.len(), n, "the right-hand side must have {n} numbers");
    solve_forward(factor, n, b);
    solve_backward(factor, n, b);
}

/// `b := U⁻ᵀ b`, by rows of U: once an entry is known, its contribution to the rest is removed.
pub(crate) fn solve_forward(factor: &[f64], n: usize, b: &mut [f64]) {
    for k in 0..n {
        let row = &factor[k * n + k..k * n + n];
        let (head, tail) = b[k..].split_first_mut().expect("k < n");
        *head /= row[0];
        axpy(tail, -*head, &row[1..]);
    }
}

/// `b := U⁻¹ b`.
pub(crate) fn solve_backward(factor: &[f64], n: usize, b: &mut [f64]) {
    for k in (0..n).rev() {
        let row = &factor[k * n + k..k * n + n];
        let (head, tail) = b[k..].split_first_mut().expect("k < n");
        *head = (*head - dot(&row[1..], tail)) / row[0];
    }
}

/// Writes `L⁻¹` (lower triangular, row-major, zeros above) from the factor `U = Lᵀ` of [`factor`].
///
/// - `factor`: `n × n` row-major, `U` in the upper triangle.
/// - `inverse`: `n × n` numbers, overwritten.
///
/// # Panics
///
/// If a slice is shorter than `n * n`.
///
/// ```
/// let mut a = [4.0, 0.0, 2.0, 5.0]; // L = [2 0; 1 2]
/// condyle_solve::cholesky::factor(&mut a, 2).unwrap();
/// let mut inverse = [f64::NAN; 4];
/// condyle_solve::cholesky::invert_lower(&a, 2, &mut inverse);
/// assert_eq!(inverse, [0.5, 0.0, -0.25, 0.5]);
/// ```
pub fn invert_lower(factor: &[f64], n: usize, inverse: &mut [f64]) {
    inverse.fill(0.0);
    for i in 0..n {
        let (done, rest) = inverse.split_at_mut(i * n);
        let row = &mut rest[..=i];
        // L_ii row_i = e_i - sum_{k<i} L_ik row_k, and L_ik = U_ki; row_k ends at its diagonal.
        subtract_rows(&mut row[..i], done, n, 0, |k| factor[k * n + i], 0..i);
        let scale = 1.0 / factor[i * n + i];
        row[i] = 1.0;
        for x in row {
            *x *= scale;
        }
    }
}

/// `y -= sum_k coefficient(k) * rows[k][start .. start + y.len()]`, four rows at a time.
#[inline(always)]
pub(crate) fn subtract_rows(
    y: &mut [f64],
    rows: &[f64],
    stride: usize,
    start: usize,
    coefficient: impl Fn(usize) -> f64,
    range: std::ops::Range<usize>,
) {
    let len = y.len();
    let piece = |k: usize| &rows[k * stride + start..][..len];
    let mut k = range.start;
    while k + 4 <= range.end {
        let (a, b) = (coefficient(k), coefficient(k + 1));
        let (c, d) = (coefficient(k + 2), coefficient(k + 3));
        let (p, q, r, s) = (piece(k), piece(k + 1), piece(k + 2), piece(k + 3));
        for i in 0..len {
            y[i] -= (a * p[i] + b * q[i]) + (c * r[i] + d * s[i]);
        }
        k += 4;
    }
    while k < range.end {
        axpy(y, -coefficient(k), piece(k));
        k += 1;
    }
}

/// `y += a x`.
#[inline]
pub(crate) fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// `Σ x_i y_i` with four running sums, in an order that depends only on the length: results are
/// reproducible.
#[inline]
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let len = x.len().min(y.len());
    let (x, y) = (&x[..len], &y[..len]);
    let mut sum = [0.0; 4];
    let (xs, ys) = (x.chunks_exact(4), y.chunks_exact(4));
    let mut tail = 0.0;
    for (a, b) in xs.remainder().iter().zip(ys.remainder()) {
        tail += a * b;
    }
    for (a, b) in xs.zip(ys) {
        for k in 0..4 {
            sum[k] += a[k] * b[k];
        }
    }
    (sum[0] + sum[2]) + (sum[1] + sum[3]) + tail
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Lehmer matrix min(i, j) / max(i, j), i, j from 1: symmetric positive definite.
    fn lehmer(n: usize) -> Vec<f64> {
        let entry = |i: usize, j: usize| (i.min(j) + 1) as f64 / (i.max(j) + 1) as f64;
        (0..n * n).map(|k| entry(k / n, k % n)).collect()
    }

    #[test]
    fn the_factor_multiplied_out_is_the_matrix() {
        for n in 0..=33 {
            let a = lehmer(n);
            let mut u = a.clone();
            factor(&mut u, n).unwrap();
            for i in 0..n {
                for j in 0..=i {
                    let product: f64 = (0..=j).map(|k| u[k * n + i] * u[k * n + j]).sum();
                    // Backward error of Cholesky: (n + 1) ε A_ii, Higham 2002, theorem 10.3.
                    assert!((product - a[i * n + j]).abs() < 40.0 * f64::EPSILON, "n {n}");
                    if j < i {
                        assert_eq!(u[i * n + j], a[i * n + j], "the strict lower part stays");
                    }
                }
            }
        }
    }

    #[test]
    fn min_matrix_has_the_factor_of_ones_and_known_inverse() {
        // min(i, j) from 1 is L Lᵀ with L the lower triangle of ones: exact in floating point.
        let n = 13;
        let mut a: Vec<f64> =
            (0..n * n).map(|k| ((k / n).min(k % n) + 1) as f64).collect::<Vec<_>>();
        factor(&mut a, n).unwrap();
        for i in 0..n {
            assert!(a[i * n + i..i * n + n].iter().all(|&x| x == 1.0));
        }
        // L⁻¹ is the difference operator: 1 on the diagonal and -1 below it.
        let mut inverse = vec![f64::NAN; n * n];
        invert_lower(&a, n, &mut inverse);
        for i in 0..n {
            for j in 0..n {
                let expected = if i == j { 1.0 } else { -f64::from(u8::from(i == j + 1)) };
                assert_eq!(inverse[i * n + j], expected, "row {i} column {j}");
            }
        }
        // A x = b with x = 1..n: b_i = Σ_j min(i, j) j.
        let mut x: Vec<f64> =
            (1..=n).map(|i| (1..=n).map(|j| (i.min(j) * j) as f64).sum()).collect();
        solve(&a, n, &mut x);
        for (i, x) in x.iter().enumerate() {
            assert_eq!(*x, (i + 1) as f64);
        }
    }

    #[test]
    fn a_failed_pivot_is_named() {
        // diag(1, 1, ..) with row 6 a copy of row 2: the pivot of row 6 is 1 - 1 = 0.
        let n = 9;
        for (value, what) in [(1.0, "dependent"), (0.5, "indefinite"), (f64::NAN, "NaN")] {
            let mut a = vec![0.0; n * n];
            for i in 0..n {
                a[i * n + i] = 1.0;
            }
            a[6 * n + 2] = 1.0;
            a[6 * n + 6] = value;
            assert_eq!(factor(&mut a, n), Err(PivotFailure { index: 6 }), "{what}");
        }
    }

    #[test]
    fn dot_and_rows_agree_with_the_sum() {
        // Σ_{i=1..m} i² = m (m + 1) (2 m + 1) / 6, exact in integers.
        for m in 0..20_usize {
            let x: Vec<f64> = (1..=m).map(|i| i as f64).collect();
            assert_eq!(dot(&x, &x), (m * (m + 1) * (2 * m + 1) / 6) as f64);
            // y - Σ_k k (rows all ones) = -m (m + 1) / 2 in every entry.
            let rows = vec![1.0; m * 5];
            let mut y = [0.0; 3];
            subtract_rows(&mut y, &rows, 5, 1, |k| x[k], 0..m);
            assert_eq!(y, [-((m * (m + 1) / 2) as f64); 3]);
        }
    }
}
