//! Which row goes to which column at the least sum of costs.

/// The column of each row so that the sum of `cost(row, column)` is least; no column is taken twice.
///
/// Rows are added one by one along shortest augmenting paths with potentials (Kuhn 1955, Munkres 1957,
/// in the form of Jonker & Volgenant 1987): O(rows² columns). There must be at least as many columns
/// as rows, else `None`.
pub fn assign(
    rows: usize,
    columns: usize,
    cost: impl Fn(usize, usize) -> f64,
) -> Option<Vec<usize>> {
    if rows > columns {
        return None;
    }
    let (mut of_row, mut of_column) = (vec![0.0; rows], vec![0.0; columns]);
    let mut row_of: Vec<Option<usize>> = vec![None; columns];
    for row in 0..rows {
        // For each column the least reduced cost of a path to it, and the column before it.
        let mut least = vec![f64::INFINITY; columns];
        let mut before: Vec<Option<usize>> = vec![None; columns];
        let mut done = vec![false; columns];
        let (mut at, mut here) = (row, None);
        let end = loop {
            let (mut step, mut nearest) = (f64::INFINITY, None);
            for column in (0..columns).filter(|&c| !done[c]) {
                let reduced = cost(at, column) - of_row[at] - of_column[column];
                if reduced < least[column] {
                    (least[column], before[column]) = (reduced, here);
                }
                if least[column] < step {
                    (step, nearest) = (least[column], Some(column));
                }
            }
            let nearest = nearest?;
            of_row[row] += step;
            for column in 0..columns {
                if done[column] {
                    of_column[column] -= step;
                    if let Some(taken) = row_of[column] {
                        of_row[taken] += step;
                    }
                } else {
                    least[column] -= step;
                }
            }
            done[nearest] = true;
            here = Some(nearest);
            match row_of[nearest] {
                Some(taken) => at = taken,
                None => break nearest,
            }
        };
        let mut column = end;
        while let Some(previous) = before[column] {
            row_of[column] = row_of[previous];
            column = previous;
        }
        row_of[column] = Some(row);
    }
    let mut columns_of = vec![0; rows];
    for (column, row) in row_of.into_iter().enumerate() {
        if let Some(row) = row {
            columns_of[row] = column;
        }
    }
    Some(columns_of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_permutation_costs_less() {
        // All 120 ways of five rows among five columns, for forty tables of remainders.
        for seed in 1..=40_u64 {
            let cost = |r: usize, c: usize| {
                let mixed =
                    (seed * 7919 + r as u64 * 104_729 + c as u64 * 1_299_709) * 2_654_435_761;
                ((mixed >> 16) % 1000) as f64
            };
            let sum = |columns: &[usize]| -> f64 {
                columns.iter().enumerate().map(|(r, &c)| cost(r, c)).sum()
            };
            let found = assign(5, 5, cost).unwrap();
            let mut least = f64::INFINITY;
            for code in 0..5_usize.pow(5) {
                let columns: Vec<usize> = (0..5).map(|i| code / 5_usize.pow(i) % 5).collect();
                let distinct = (0..5).all(|c| columns.contains(&c));
                if distinct {
                    least = least.min(sum(&columns));
                }
            }
            assert_eq!(sum(&found), least, "{seed}: {found:?}");
        }
    }

    #[test]
    fn more_columns_than_rows_leave_some_free() {
        // Both rows want the second column; the first loses 4 by giving way, the second 5.
        let cost = [[5.0, 1.0, 9.0], [7.0, 2.0, 9.0]];
        assert_eq!(assign(2, 3, |r, c| cost[r][c]), Some(vec![0, 1]));
        assert_eq!(assign(2, 1, |_, _| 0.0), None);
    }
}
