//! One partner for each, at the lowest total cost.

/// For each row the column it gets, so that the sum of costs is the lowest: Kuhn's method with
/// potentials, of order n³. `costs` has `n` rows of `n` finite numbers.
pub(super) fn assign(costs: &[f64], n: usize) -> Vec<usize> {
    // Row and column 0 stand for none; columns know their rows.
    let mut row_of = vec![0usize; n + 1];
    let (mut rows, mut columns) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    for row in 1..=n {
        row_of[0] = row;
        let mut at = 0;
        let mut least = vec![f64::INFINITY; n + 1];
        let (mut came_from, mut done) = (vec![0usize; n + 1], vec![false; n + 1]);
        while row_of[at] != 0 {
            done[at] = true;
            let current = row_of[at];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in (1..=n).filter(|&column| !done[column]) {
                let cost = costs[(current - 1) * n + column - 1] - rows[current] - columns[column];
                if cost < least[column] {
                    (least[column], came_from[column]) = (cost, at);
                }
                if least[column] < step {
                    (step, next) = (least[column], column);
                }
            }
            if next == 0 {
                // Only costs that are not finite end here.
                return (0..n).collect();
            }
            for column in 0..=n {
                if done[column] {
                    rows[row_of[column]] += step;
                    columns[column] -= step;
                } else {
                    least[column] -= step;
                }
            }
            at = next;
        }
        while at != 0 {
            let before = came_from[at];
            row_of[at] = row_of[before];
            at = before;
        }
    }
    let mut column_of = vec![0; n];
    for column in 1..=n {
        column_of[row_of[column] - 1] = column - 1;
    }
    column_of
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lowest sum over all orders of the columns.
    fn least(costs: &[f64], n: usize, row: usize, free: &mut Vec<usize>) -> f64 {
        if row == n {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for position in 0..free.len() {
            let column = free.swap_remove(position);
            best = best.min(costs[row * n + column] + least(costs, n, row + 1, free));
            free.push(column);
            let last = free.len() - 1;
            free.swap(position, last);
        }
        best
    }

    #[test]
    fn the_sum_is_the_lowest_of_all_orders() {
        let mut state = 1u64;
        for n in 0..7 {
            for _ in 0..20 {
                let mut next = || {
                    // Numbers of Lehmer's generator (Park & Miller 1988).
                    state = state * 48271 % 0x7fff_ffff;
                    (state % 100) as f64
                };
                let costs: Vec<f64> = (0..n * n).map(|_| next()).collect();
                let columns = assign(&costs, n);
                let mut sorted = columns.clone();
                sorted.sort_unstable();
                assert_eq!(sorted, (0..n).collect::<Vec<_>>());
                let sum: f64 = columns.iter().enumerate().map(|(i, &j)| costs[i * n + j]).sum();
                assert_eq!(sum, least(&costs, n, 0, &mut (0..n).collect()));
            }
        }
    }

    #[test]
    fn costs_that_are_no_numbers_end_all_the_same() {
        assert_eq!(assign(&[f64::NAN; 4], 2).len(), 2);
        assert_eq!(assign(&[f64::INFINITY; 9], 3).len(), 3);
    }
}
