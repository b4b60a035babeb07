//! Eigenvalues and functions of small symmetric matrices, by cyclic Jacobi rotations (Golub & Van Loan 2013, 8.5).

/// The eigenvalues of a symmetric matrix of `n` rows, and the eigenvectors as the columns of a matrix, row by row.
///
/// Only the upper triangle is read. Sweeps end where what is off the diagonal is rounding, after 60 at the latest.
///
/// ```
/// use condyle_solve::eigen::symmetric;
/// let (mut values, _) = symmetric(&[2.0, 1.0, 1.0, 2.0], 2);
/// values.sort_by(f64::total_cmp);
/// assert!((values[0] - 1.0).abs() < 1e-15 && (values[1] - 3.0).abs() < 1e-15);
/// ```
///
/// # Panics
/// If the matrix has fewer than n² numbers.
#[must_use]
pub fn symmetric(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix[..n * n].to_vec();
    for i in 0..n {
        for j in 0..i {
            a[i * n + j] = a[j * n + i];
        }
    }
    let mut vectors = vec![0.0; n * n];
    (0..n).for_each(|i| vectors[i * n + i] = 1.0);
    for _ in 0..60 {
        let total: f64 = a.iter().map(|x| x * x).sum();
        let off: f64 =
            (0..n).flat_map(|i| (0..i).map(move |j| i * n + j)).map(|k| a[k] * a[k]).sum();
        // Not a number ends it, too.
        if off.partial_cmp(&(1e-32 * total)) != Some(std::cmp::Ordering::Greater) {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                let cross = a[p * n + q];
                if cross == 0.0 {
                    continue;
                }
                let half = 0.5 * (a[q * n + q] - a[p * n + p]) / cross;
                let t = half.signum() / (half.abs() + half.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..n {
                    let (x, y) = (a[k * n + p], a[k * n + q]);
                    a[k * n + p] = c * x - s * y;
                    a[k * n + q] = s * x + c * y;
                }
                for k in 0..n {
                    let (x, y) = (a[p * n + k], a[q * n + k]);
                    a[p * n + k] = c * x - s * y;
                    a[q * n + k] = s * x + c * y;
                    let (x, y) = (vectors[k * n + p], vectors[k * n + q]);
                    vectors[k * n + p] = c * x - s * y;
                    vectors[k * n + q] = s * x + c * y;
                }
            }
        }
    }
    ((0..n).map(|i| a[i * n + i]).collect(), vectors)
}

/// f of a symmetric matrix: V·f(λ)·Vᵀ, row by row.
///
/// ```
/// use condyle_solve::eigen::function;
/// let root = function(&[4.0, 0.0, 0.0, 9.0], 2, f64::sqrt);
/// assert_eq!(root, [2.0, 0.0, 0.0, 3.0]);
/// ```
///
/// # Panics
/// If the matrix has fewer than n² numbers.
#[must_use]
pub fn function(matrix: &[f64], n: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let (values, vectors) = symmetric(matrix, n);
    let values: Vec<f64> = values.into_iter().map(f).collect();
    let mut out = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            out[i * n + j] =
                (0..n).map(|k| vectors[i * n + k] * values[k] * vectors[j * n + k]).sum();
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_times_values_are_the_matrix() {
        let n = 6;
        let a: Vec<f64> = (0..n * n)
            .map(|k| {
                let (i, j) = (k / n, k % n);
                ((i * j) as f64 + 1.0).sin() + if i == j { 0.5 * i as f64 } else { 0.0 }
            })
            .collect();
        let same = function(&a, n, |x| x);
        for (found, expected) in same.iter().zip(&a) {
            assert!((found - expected).abs() < 1e-13);
        }
        let (_, v) = symmetric(&a, n);
        for i in 0..n {
            for j in 0..n {
                let dot: f64 = (0..n).map(|k| v[k * n + i] * v[k * n + j]).sum();
                assert!((dot - if i == j { 1.0 } else { 0.0 }).abs() < 1e-13);
            }
        }
    }
}
