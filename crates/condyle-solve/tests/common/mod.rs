//! Random programs, a check of the KKT conditions, and a reference solver that enumerates all
//! active sets.

use condyle_solve::quadratic::{Constraint, QuadraticProgram, Solution, Status, Workspace};

/// A linear congruential generator (Knuth's MMIX constants); the high bits are used.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// Below `count`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Uniform in [-1, 1).
    pub(crate) fn real(&mut self) -> f64 {
        self.bits() as f64 / f64::from(1_u32 << 30) - 1.0
    }

    pub(crate) fn reals(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.real()).collect()
    }

    /// A whole number of absolute value at most `size`.
    pub(crate) fn integer(&mut self, size: usize) -> f64 {
        self.below(2 * size + 1) as f64 - size as f64
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Instance {
    pub(crate) n: usize,
    /// NaN above the diagonal, which the solver must not read.
    pub(crate) hessian: Vec<f64>,
    pub(crate) gradient: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
    pub(crate) equality_rows: Vec<f64>,
    pub(crate) equality_values: Vec<f64>,
    pub(crate) inequality_rows: Vec<f64>,
    pub(crate) inequality_values: Vec<f64>,
}

/// AᵀA + damping from `rows` rows of `A`.
fn hessian(n: usize, rows: usize, damping: f64, mut entry: impl FnMut() -> f64) -> Vec<f64> {
    let a: Vec<f64> = (0..rows * n).map(|_| entry()).collect();
    let mut h = vec![f64::NAN; n * n];
    for i in 0..n {
        for j in 0..=i {
            h[i * n + j] = (0..rows).map(|k| a[k * n + i] * a[k * n + j]).sum();
        }
        h[i * n + i] += damping;
    }
    h
}

fn product(row: &[f64], d: &[f64]) -> f64 {
    row.iter().zip(d).map(|(a, x)| a * x).sum()
}

fn length(row: &[f64]) -> f64 {
    product(row, row).sqrt()
}

impl Instance {
    /// Data of small integers; feasible or not. With little damping every variable has finite
    /// bounds.
    pub(crate) fn integers(
        random: &mut Random,
        n: usize,
        equalities: usize,
        inequalities: usize,
        damping: f64,
    ) -> Self {
        let rows = random.below(n + 2);
        let hessian = hessian(n, rows, damping, || random.integer(2));
        let (mut lower, mut upper) = (vec![], vec![]);
        for _ in 0..n {
            let low = random.integer(2);
            let high = low + random.below(4) as f64;
            let open = damping > 0.1;
            lower.push(if open && random.below(3) == 0 { f64::NEG_INFINITY } else { low });
            upper.push(if open && random.below(3) == 0 { f64::INFINITY } else { high });
        }
        let mut integers =
            |count: usize, size| -> Vec<f64> { (0..count).map(|_| random.integer(size)).collect() };
        Self {
            n,
            hessian,
            gradient: integers(n, 4),
            lower,
            upper,
            equality_rows: integers(equalities * n, 1),
            equality_values: integers(equalities, 1),
            inequality_rows: integers(inequalities * n, 1),
            inequality_values: integers(inequalities, 2),
        }
    }

    /// Real numbers around a feasible point at which many of the constraints are active: bounds
    /// that are equal, infinite or active, rows that are duplicated, linearly combined or active.
    pub(crate) fn feasible(
        random: &mut Random,
        n: usize,
        equalities: usize,
        inequalities: usize,
        damping: f64,
    ) -> Self {
        let rows = if damping < 1e-6 { n.div_ceil(2) } else { n };
        let hessian = hessian(n, rows, damping, || random.real());
        let point = random.reals(n);
        let (mut lower, mut upper) = (vec![], vec![]);
        for &x in &point {
            let mut side = |sign: f64| match random.below(4) {
                0 => sign * f64::INFINITY,
                1 => x,
                _ => x + sign * random.real().abs(),
            };
            lower.push(side(-1.0));
            upper.push(side(1.0));
        }
        let mut instance = Self {
            n,
            hessian,
            gradient: random.reals(n).iter().map(|g| 3.0 * g).collect(),
            lower,
            upper,
            equality_rows: vec![],
            equality_values: vec![],
            inequality_rows: vec![],
            inequality_values: vec![],
        };
        for k in 0..equalities {
            let row = match random.below(4) {
                0 if k > 0 => instance.equality_rows[..n].iter().map(|x| -2.0 * x).collect(),
                1 if k > 1 => (0..n)
                    .map(|j| instance.equality_rows[j] - 0.3 * instance.equality_rows[n + j])
                    .collect(),
                _ => random.reals(n),
            };
            instance.equality_values.push(product(&row, &point));
            instance.equality_rows.extend(row);
        }
        for k in 0..inequalities {
            let (row, slack) = match random.below(5) {
                0 if k > 0 => (instance.inequality_rows[(k - 1) * n..].to_vec(), 0.0),
                1 if equalities > 0 => (instance.equality_rows[..n].to_vec(), 0.0),
                2 => (random.reals(n), 0.0),
                _ => (random.reals(n), random.real().abs()),
            };
            let value = match random.below(3) {
                // Exactly the limit of the previous row, if this one is a duplicate of it.
                0 if k > 0 && row == instance.inequality_rows[(k - 1) * n..] => {
                    instance.inequality_values[k - 1]
                }
                _ => product(&row, &point) - slack,
            };
            instance.inequality_values.push(value);
            instance.inequality_rows.extend(row);
        }
        instance
    }

    pub(crate) fn program(&self) -> QuadraticProgram<'_> {
        QuadraticProgram::bounded(&self.hessian, &self.gradient, &self.lower, &self.upper)
            .with_equalities(&self.equality_rows, &self.equality_values)
            .with_inequalities(&self.inequality_rows, &self.inequality_values)
    }

    pub(crate) fn workspace(&self) -> Workspace {
        Workspace::new(self.n, self.equality_values.len(), self.inequality_values.len())
    }

    fn h(&self, i: usize, j: usize) -> f64 {
        self.hessian[i.max(j) * self.n + i.min(j)]
    }

    fn objective(&self, d: &[f64]) -> f64 {
        let mut value = product(&self.gradient, d);
        for i in 0..self.n {
            for j in 0..self.n {
                value += 0.5 * self.h(i, j) * d[i] * d[j];
            }
        }
        value
    }

    fn equalities(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let row = |k| &self.equality_rows[k * self.n..(k + 1) * self.n];
        self.equality_values.iter().enumerate().map(move |(k, c)| (row(k), *c))
    }

    fn inequalities(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let row = |k| &self.inequality_rows[k * self.n..(k + 1) * self.n];
        self.inequality_values.iter().enumerate().map(move |(k, h)| (row(k), *h))
    }

    /// The reference solver: for every choice of free and held variables and of active rows, finds
    /// the minimiser with those as equalities, and returns the best feasible one. The minimiser of
    /// the program is among them, with linearly independent active constraints.
    pub(crate) fn enumerate(&self) -> Option<(Vec<f64>, f64)> {
        let rows: Vec<(&[f64], f64)> = self.equalities().chain(self.inequalities()).collect();
        let mut best: Option<(Vec<f64>, f64)> = None;
        for choice in 0..3_usize.pow(self.n as u32) {
            let digit = |i: usize| choice / 3_usize.pow(i as u32) % 3;
            let held: Vec<Option<f64>> = (0..self.n)
                .map(|i| [None, Some(self.lower[i]), Some(self.upper[i])][digit(i)])
                .collect();
            if held.iter().flatten().any(|x| x.is_infinite()) {
                continue;
            }
            for subset in 0..1_usize << rows.len() {
                let active: Vec<(&[f64], f64)> =
                    (0..rows.len()).filter(|k| subset >> k & 1 == 1).map(|k| rows[k]).collect();
                let Some(d) = self.minimiser(&held, &active) else { continue };
                let value = self.objective(&d);
                let feasible = (0..self.n)
                    .all(|i| d[i] >= self.lower[i] - 1e-6 && d[i] <= self.upper[i] + 1e-6)
                    && self.equalities().all(|(row, c)| (product(row, &d) - c).abs() < 1e-6)
                    && self.inequalities().all(|(row, h)| product(row, &d) > h - 1e-6);
                if feasible && best.as_ref().is_none_or(|(_, least)| value < *least) {
                    best = Some((d, value));
                }
            }
        }
        best
    }

    /// Solves [H Aᵀ; A 0] over the free variables; `None` if the rows are linearly dependent there.
    fn minimiser(&self, held: &[Option<f64>], active: &[(&[f64], f64)]) -> Option<Vec<f64>> {
        let free: Vec<usize> = (0..self.n).filter(|&i| held[i].is_none()).collect();
        let mut basis: Vec<Vec<f64>> = vec![];
        for (row, _) in active {
            let mut rest: Vec<f64> = free.iter().map(|&i| row[i]).collect();
            for other in &basis {
                let along = product(&rest, other);
                rest.iter_mut().zip(other).for_each(|(x, o)| *x -= along * o);
            }
            // Rows of small integers: the remainder is either rounding or of the order of one.
            let size = length(&rest);
            if size < 1e-6 {
                return None;
            }
            rest.iter_mut().for_each(|x| *x /= size);
            basis.push(rest);
        }
        let mut d: Vec<f64> = held.iter().map(|x| x.unwrap_or(0.0)).collect();
        let size = free.len() + active.len();
        let mut matrix = vec![vec![0.0; size + 1]; size];
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                matrix[a][b] = self.h(i, j);
            }
            let held_part: f64 = (0..self.n).map(|j| self.h(i, j) * d[j]).sum();
            matrix[a][size] = -self.gradient[i] - held_part;
            for (k, (row, _)) in active.iter().enumerate() {
                matrix[a][free.len() + k] = row[i];
                matrix[free.len() + k][a] = row[i];
            }
        }
        for (k, (row, value)) in active.iter().enumerate() {
            matrix[free.len() + k][size] = value - product(row, &d);
        }
        for (x, &i) in eliminate(matrix)?.iter().zip(&free) {
            d[i] = *x;
        }
        Some(d)
    }

    /// Whether some point satisfies these constraints alone (with an arbitrary objective).
    pub(crate) fn conflict_is_feasible(&self, conflict: &[Constraint]) -> bool {
        let mut part = Self {
            lower: vec![f64::NEG_INFINITY; self.n],
            upper: vec![f64::INFINITY; self.n],
            equality_rows: vec![],
            equality_values: vec![],
            inequality_rows: vec![],
            inequality_values: vec![],
            gradient: vec![0.0; self.n],
            hessian: hessian(self.n, 0, 1.0, || 0.0),
            n: self.n,
        };
        for constraint in conflict {
            match *constraint {
                Constraint::Lower(i) => {
                    part.lower[i] = self.lower[i];
                    if self.lower[i] == self.upper[i] {
                        part.upper[i] = self.upper[i];
                    }
                }
                Constraint::Upper(i) => part.upper[i] = self.upper[i],
                Constraint::Equality(k) => {
                    let (row, value) = self.equalities().nth(k).unwrap();
                    part.equality_rows.extend(row);
                    part.equality_values.push(value);
                }
                Constraint::Inequality(k) => {
                    let (row, value) = self.inequalities().nth(k).unwrap();
                    part.inequality_rows.extend(row);
                    part.inequality_values.push(value);
                }
            }
        }
        part.enumerate().is_some()
    }
}

/// Gaussian elimination with full pivoting of `[A | b]`.
fn eliminate(mut a: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let size = a.len();
    let mut order: Vec<usize> = (0..size).collect();
    for k in 0..size {
        let (mut row, mut column) = (k, k);
        for i in k..size {
            for j in k..size {
                if a[i][j].abs() > a[row][column].abs() {
                    (row, column) = (i, j);
                }
            }
        }
        a.swap(k, row);
        a.iter_mut().for_each(|r| r.swap(k, column));
        order.swap(k, column);
        if a[k][k] == 0.0 {
            return None;
        }
        for i in k + 1..size {
            let factor = a[i][k] / a[k][k];
            for j in k..=size {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    let mut x = vec![0.0; size];
    for k in (0..size).rev() {
        let rest: f64 = (k + 1..size).map(|j| a[k][j] * x[order[j]]).sum();
        x[order[k]] = (a[k][size] - rest) / a[k][k];
    }
    Some(x)
}

/// Checks the KKT conditions, each relative to the terms that it sums (the gradient to its largest
/// entry).
pub(crate) fn assert_optimal(instance: &Instance, solution: &Solution) {
    const TOLERANCE: f64 = 1e-9;
    assert_eq!(solution.status(), Status::Solved);
    assert!(solution.conflict().is_empty());
    let (n, d) = (instance.n, solution.d());
    // The data are of the order of one: a point at the origin is accurate to 1e-15.
    let size = length(d) + 1e-6;

    let mut largest: (f64, f64) = (0.0, 0.0);
    for i in 0..n {
        let (x, z) = (d[i], solution.bound_multipliers()[i]);
        assert!(x >= instance.lower[i] && x <= instance.upper[i], "bounds hold exactly");
        assert!(z <= 0.0 || x == instance.lower[i] || instance.lower[i] == instance.upper[i]);
        assert!(z >= 0.0 || x == instance.upper[i]);

        let (mut sum, mut terms) = (instance.gradient[i] - z, instance.gradient[i].abs() + z.abs());
        let mut add = |term: f64| {
            sum += term;
            terms += term.abs();
        };
        for j in 0..n {
            add(instance.h(i, j) * d[j]);
        }
        for ((row, _), y) in instance.equalities().zip(solution.equality_multipliers()) {
            add(-row[i] * y);
        }
        for ((row, _), w) in instance.inequalities().zip(solution.inequality_multipliers()) {
            add(-row[i] * w);
        }
        largest = (largest.0.max(sum.abs()), largest.1.max(terms));
    }
    let (sum, terms) = largest;
    assert!(sum <= TOLERANCE * terms, "gradient: {sum:e} of {terms:e}");
    for (row, value) in instance.equalities() {
        let slack = product(row, d) - value;
        let scale = value.abs() + length(row) * size;
        assert!(slack.abs() <= TOLERANCE * scale, "equality: {slack:e} of {scale:e}");
    }
    let multipliers = solution.inequality_multipliers().iter().zip(solution.active_rows());
    for ((row, value), (&w, &active)) in instance.inequalities().zip(multipliers) {
        let slack = product(row, d) - value;
        let scale = value.abs() + length(row) * size;
        assert!(slack >= -TOLERANCE * scale, "inequality: {slack:e} of {scale:e}");
        assert!(w >= 0.0 && (w == 0.0 || active), "multiplier {w} of a row, active {active}");
        assert!(!active || slack.abs() <= TOLERANCE * scale, "active: {slack:e} of {scale:e}");
    }
}
