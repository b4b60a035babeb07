//! The borrowed data of one quadratic program.

/// `minimise ½ dᵀ H d + gᵀ d` subject to `lower ≤ d ≤ upper`, `C d = c`, `G d ≥ h`; borrowed.
///
/// ```
/// use condyle_solve::quadratic::QuadraticProgram;
///
/// let program = QuadraticProgram::bounded(&[2.0], &[1.0], &[0.0], &[1.0])
///     .with_inequalities(&[1.0], &[0.5]);
/// assert_eq!(program.inequality_values, [0.5]);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct QuadraticProgram<'a> {
    /// `H`, `n × n` row-major, symmetric positive definite; only the lower triangle is read.
    pub hessian: &'a [f64],
    /// `g`, `n`.
    pub gradient: &'a [f64],
    /// Lower bounds, `n`; `-∞` for none. Equal to the upper bound to fix a variable.
    pub lower: &'a [f64],
    /// Upper bounds, `n`; `+∞` for none.
    pub upper: &'a [f64],
    /// `C`, `m_e × n` row-major. Rows may be linearly dependent.
    pub equality_rows: &'a [f64],
    /// `c`, `m_e`.
    pub equality_values: &'a [f64],
    /// `G`, `m_i × n` row-major.
    pub inequality_rows: &'a [f64],
    /// `h`, `m_i`; `-∞` switches a row off.
    pub inequality_values: &'a [f64],
}

impl<'a> QuadraticProgram<'a> {
    /// `minimise ½ dᵀ H d + gᵀ d` subject to `lower ≤ d ≤ upper`.
    ///
    /// `hessian` is `n × n` row-major (lower triangle read), the others have `n` numbers.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// let program = QuadraticProgram::bounded(&[4.0], &[-2.0], &[0.0], &[1.0]);
    /// assert_eq!(Workspace::new(1, 0, 0).solve(&program).d(), [0.5]); // 4 d = 2
    /// ```
    pub fn bounded(
        hessian: &'a [f64],
        gradient: &'a [f64],
        lower: &'a [f64],
        upper: &'a [f64],
    ) -> Self {
        Self {
            hessian,
            gradient,
            lower,
            upper,
            equality_rows: &[],
            equality_values: &[],
            inequality_rows: &[],
            inequality_values: &[],
        }
    }

    /// The same program with `C d = c`: `rows` is `m_e × n` row-major, `values` has `m_e` numbers.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// let program = QuadraticProgram::bounded(&[2.0], &[-1.0], &[0.0], &[1.0])
    ///     .with_equalities(&[4.0], &[3.0]);
    /// assert_eq!(Workspace::new(1, 1, 0).solve(&program).d(), [0.75]); // 4 d = 3
    /// ```
    #[must_use]
    pub fn with_equalities(self, rows: &'a [f64], values: &'a [f64]) -> Self {
        Self { equality_rows: rows, equality_values: values, ..self }
    }

    /// The same program with `G d ≥ h`: `rows` is `m_i × n` row-major, `values` has `m_i` numbers.
    ///
    /// ```
    /// use condyle_solve::quadratic::{QuadraticProgram, Workspace};
    ///
    /// let program = QuadraticProgram::bounded(&[2.0], &[-1.0], &[0.0], &[1.0])
    ///     .with_inequalities(&[-4.0], &[-1.0]);
    /// assert_eq!(Workspace::new(1, 0, 1).solve(&program).d(), [0.25]); // -4 d ≥ -1
    /// ```
    #[must_use]
    pub fn with_inequalities(self, rows: &'a [f64], values: &'a [f64]) -> Self {
        Self { inequality_rows: rows, inequality_values: values, ..self }
    }

    /// The number of unknowns.
    pub(super) fn n(&self) -> usize {
        self.gradient.len()
    }

    pub(super) fn equality_row(&self, k: usize) -> &'a [f64] {
        &self.equality_rows[k * self.n()..(k + 1) * self.n()]
    }

    pub(super) fn inequality_row(&self, k: usize) -> &'a [f64] {
        &self.inequality_rows[k * self.n()..(k + 1) * self.n()]
    }

    pub(super) fn check_shape(&self, n: usize, equalities: usize, inequalities: usize) {
        let check = |what: &str, length: usize, expected: usize| {
            assert!(length == expected, "{what} has {length} numbers, the workspace {expected}");
        };
        check("hessian", self.hessian.len(), n * n);
        check("gradient", self.gradient.len(), n);
        check("lower", self.lower.len(), n);
        check("upper", self.upper.len(), n);
        check("equality_rows", self.equality_rows.len(), equalities * n);
        check("equality_values", self.equality_values.len(), equalities);
        check("inequality_rows", self.inequality_rows.len(), inequalities * n);
        check("inequality_values", self.inequality_values.len(), inequalities);
    }
}
