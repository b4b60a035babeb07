//! Eigenvectors of small symmetric matrices, by Jacobi's rotations.

/// Eigenvalues, falling, and the eigenvector of each.
pub(super) fn principal<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut rows = [[0.0; N]; N];
    for i in 0..N {
        rows[i][i] = 1.0;
    }
    // Converges quadratically: a dozen sweeps are more than any matrix of four rows needs.
    for _ in 0..16 {
        for i in 0..N {
            for j in i + 1..N {
                let (at, beside) = (a[i][j], a[j][j] - a[i][i]);
                if at.abs() < 1e-300 {
                    continue;
                }
                let ratio = beside / (2.0 * at);
                let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                for k in 0..N {
                    (a[k][i], a[k][j]) =
                        (cosine * a[k][i] - sine * a[k][j], sine * a[k][i] + cosine * a[k][j]);
                }
                for k in 0..N {
                    (a[i][k], a[j][k]) =
                        (cosine * a[i][k] - sine * a[j][k], sine * a[i][k] + cosine * a[j][k]);
                    (rows[i][k], rows[j][k]) = (
                        cosine * rows[i][k] - sine * rows[j][k],
                        sine * rows[i][k] + cosine * rows[j][k],
                    );
                }
            }
        }
    }
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_by(|&i, &j| a[j][j].total_cmp(&a[i][i]));
    (order.map(|i| a[i][i]), order.map(|i| rows[i]))
}

#[cfg(test)]
mod tests {
    use super::principal;

    #[test]
    fn a_matrix_is_the_sum_of_its_principal_parts() {
        let a = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 1.0]];
        let (values, vectors) = principal(a);
        assert!(values[0] >= values[1] && values[1] >= values[2]);
        for i in 0..3 {
            for j in 0..3 {
                let sum: f64 = (0..3).map(|k| values[k] * vectors[k][i] * vectors[k][j]).sum();
                assert!((sum - a[i][j]).abs() < 1e-14);
            }
        }
    }
}
