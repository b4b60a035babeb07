//! The linear law nearest to a truth, by the method of Gram & Schmidt.

/// d = intercept + Σ slope · angle, by least squares over frames that are known exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BestLinear {
    /// The value at angles of 0, in metres.
    pub intercept: f64,
    /// Metres per radian of the three angles; none of one that does not move, or moves only as those before it do: data of this knee cannot tell it.
    pub slopes: [Option<f64>; 3],
    /// The root mean square of what is left, in metres: 0 of a knee that is linear.
    pub left: f64,
    /// The largest of it.
    pub largest: f64,
}

/// An angle moves if its standard deviation is more than a thousandth of a radian beside the others.
const MOVES: f64 = 1e-3;

impl BestLinear {
    /// Of rows of three angles and three places: the law of one place, 0 to 2.
    ///
    /// ```
    /// use condyle_learn::study::BestLinear;
    /// // The third angle never moves.
    /// let row = |i: i32| {
    ///     let (a, b) = (0.1 * f64::from(i), f64::from(i * i % 7) * 0.05);
    ///     [a, b, 0.0, 0.4 + 0.02 * a - 0.01 * b, 0.0, 0.0]
    /// };
    /// let rows: Vec<[f64; 6]> = (0..40).map(row).collect();
    /// let law = BestLinear::of(&rows, 0);
    /// assert!((law.slopes[0].unwrap() - 0.02).abs() < 1e-12 && (law.slopes[1].unwrap() + 0.01).abs() < 1e-12);
    /// assert_eq!(law.slopes[2], None);
    /// assert!((law.intercept - 0.4).abs() < 1e-12 && law.left < 1e-12);
    /// ```
    #[must_use]
    pub fn of(rows: &[[f64; 6]], place: usize) -> Self {
        let n = rows.len().max(1) as f64;
        let mean = |column: usize| rows.iter().map(|row| row[column]).sum::<f64>() / n;
        let means = [mean(0), mean(1), mean(2), mean(3 + place.min(2))];
        let value = |row: &[f64; 6], k: usize| match k {
            3 => row[3 + place.min(2)] - means[3],
            k => row[k] - means[k],
        };
        // Each angle less what those before it say (Gram & Schmidt), and how they say it.
        let mut own: Vec<Vec<f64>> = vec![];
        let mut shares = [[0.0; 3]; 3];
        let mut moves = [false; 3];
        for k in 0..3 {
            let mut column: Vec<f64> = rows.iter().map(|row| value(row, k)).collect();
            for j in 0..k {
                if moves[j] {
                    let share = dot(&column, &own[j]) / dot(&own[j], &own[j]);
                    shares[k][j] = share;
                    column.iter_mut().zip(&own[j]).for_each(|(x, o)| *x -= share * o);
                }
            }
            moves[k] = (dot(&column, &column) / n).sqrt() > MOVES;
            own.push(column);
        }
        let mut left: Vec<f64> = rows.iter().map(|row| value(row, 3)).collect();
        let mut gamma = [0.0; 3];
        for k in (0..3).filter(|k| moves[*k]) {
            gamma[k] = dot(&left, &own[k]) / dot(&own[k], &own[k]);
            left.iter_mut().zip(&own[k]).for_each(|(x, o)| *x -= gamma[k] * o);
        }
        // Back from the parts of their own to the angles.
        let mut slopes = [0.0; 3];
        for k in (0..3).rev().filter(|k| moves[*k]) {
            let later: f64 =
                (k + 1..3).filter(|j| moves[*j]).map(|j| slopes[j] * shares[j][k]).sum();
            slopes[k] = gamma[k] - later;
        }
        Self {
            intercept: means[3] - (0..3).map(|k| slopes[k] * means[k]).sum::<f64>(),
            slopes: [0, 1, 2].map(|k| moves[k].then_some(slopes[k])),
            left: (dot(&left, &left) / n).sqrt(),
            largest: left.iter().fold(0.0, |most, x| most.max(x.abs())),
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
