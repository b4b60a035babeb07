//! Orthonormalisation of equality rows, with elimination of linearly dependent ones.

/// An equality row counts as linearly dependent if its part orthogonal to the others is below this
/// fraction of the longest row. Loops of a symmetric or planar model often have redundant rows.
const DEPENDENT: f64 = 1e-7;

/// The operations that orthonormalised the rows, to apply the same ones to their right-hand sides.
#[derive(Debug)]
pub(crate) struct Elimination {
    rank: usize,
    picks: Vec<usize>,
    sizes: Vec<f64>,
    along: Vec<f64>,
}

impl Elimination {
    pub(crate) fn new(equalities: usize) -> Self {
        Self {
            rank: 0,
            picks: vec![0; equalities],
            sizes: vec![0.0; equalities],
            along: vec![0.0; equalities * equalities],
        }
    }

    /// Replaces rows of `n` entries by orthonormal rows with the same span, and dependent ones by
    /// zeros (modified Gram-Schmidt, the longest remaining row first).
    pub(crate) fn orthonormalise(&mut self, rows: &mut [f64], n: usize) {
        let m = self.picks.len();
        self.rank = 0;
        let length = |row: &[f64]| row.iter().map(|v| v * v).sum::<f64>().sqrt();
        let longest = rows.chunks_exact(n.max(1)).map(length).fold(0.0, f64::max);
        for i in 0..m {
            // Rows i.. are orthogonal to the rows before i; the longest of them is the next pivot.
            let norm = |k: usize, rows: &[f64]| length(&rows[k * n..(k + 1) * n]);
            let mut pick = i;
            for k in i + 1..m {
                if norm(k, rows) > norm(pick, rows) {
                    pick = k;
                }
            }
            for j in 0..n {
                rows.swap(i * n + j, pick * n + j);
            }
            let size = norm(i, rows);
            // If the longest is negligible, so are all others.
            if size <= DEPENDENT * longest || size == 0.0 {
                rows[i * n..].fill(0.0);
                break;
            }
            self.rank = i + 1;
            self.picks[i] = pick;
            self.sizes[i] = size;
            rows[i * n..(i + 1) * n].iter_mut().for_each(|v| *v /= size);
            // Subtract the projection on the new unit row from all later rows.
            let (done, rest) = rows.split_at_mut((i + 1) * n);
            let unit = &done[i * n..];
            for (k, row) in rest.chunks_exact_mut(n).enumerate() {
                let along: f64 = row.iter().zip(unit).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(unit).for_each(|(a, b)| *a -= along * b);
                self.along[i * m + i + 1 + k] = along;
            }
        }
    }

    /// Transforms right-hand sides of the original rows to those of the orthonormal rows, in place;
    /// 0 for eliminated rows.
    pub(crate) fn apply(&self, values: &mut [f64]) {
        let m = values.len();
        // The row operations of `orthonormalise`, in the same order.
        for i in 0..self.rank {
            values.swap(i, self.picks[i]);
            values[i] /= self.sizes[i];
            for k in i + 1..m {
                values[k] -= self.along[i * m + k] * values[i];
            }
        }
        values[self.rank..].fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_span_and_values_their_meaning() {
        // The third row is the sum of the first two, the fourth is nothing.
        let original =
            [1.0, 2.0, 0.0, 1.0, 0.0, -1.0, 3.0, 0.5, 1.0, 1.0, 3.0, 1.5, 0.0, 0.0, 0.0, 0.0];
        let n = 4;
        let mut rows = original;
        let mut elimination = Elimination::new(4);
        elimination.orthonormalise(&mut rows, n);
        assert_eq!(elimination.rank, 2);
        for i in 0..4 {
            for j in 0..4 {
                let dot: f64 = (0..n).map(|k| rows[i * n + k] * rows[j * n + k]).sum();
                let expected = if i == j && i < 2 { 1.0 } else { 0.0 };
                assert!((dot - expected).abs() < 1e-14, "{i} {j}: {dot}");
            }
        }
        // A point that satisfies the original rows satisfies the orthonormal ones.
        let point = [0.3, -0.7, 0.2, 1.1];
        let mut values: Vec<f64> =
            (0..4).map(|i| (0..n).map(|k| original[i * n + k] * point[k]).sum()).collect();
        elimination.apply(&mut values);
        for i in 0..4 {
            let new: f64 = (0..n).map(|k| rows[i * n + k] * point[k]).sum();
            assert!((values[i] - new).abs() < 1e-13, "{i}");
        }
    }
}
