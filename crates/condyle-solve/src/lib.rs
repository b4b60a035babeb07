//! Dense bounded least squares for the few dozen unknowns of a skeleton.
//!
//! Inverse kinematics minimises a sum of squares `F(q) = |r(q)|²` over coordinates with limits.
//! Each Gauss-Newton step linearises the residual, `r(q + d) ≈ r + J d`, which gives a strictly
//! convex quadratic program in the step `d`:
//!
//! ```text
//! minimise   ½ dᵀ H d + gᵀ d          H = JᵀJ + damping,  g = Jᵀ r
//! subject to lower ≤ d ≤ upper        limits of the coordinates
//!            C d = c                  loops to be closed
//!            G d ≥ h                  limits that couple coordinates
//! ```
//!
//! [`quadratic`] solves it thousands of times a second: without allocation after set-up,
//! warm-started from the active set of the last call, with a Lagrange multiplier for every
//! constraint and a status. [`cholesky`] is the factorisation that it uses, [`least_squares`] the
//! iteration around it.
//!
//! [`regression`] is for recordings rather than for frames: linear least squares with a report of rank, whatever the
//! number of rows.
//!
//! The solution is the unique feasible point that satisfies the KKT conditions: there are
//! multipliers `z` (bounds), `y` (equalities), `w ≥ 0` (inequalities) with
//! `H d + g = z + Cᵀ y + Gᵀ w`, where `z_i ≥ 0` at a lower bound, `z_i ≤ 0` at an upper bound and
//! `z_i = 0` between them, and `w_k = 0` unless `G_k d = h_k`.
//!
//! ```
//! use condyle_solve::quadratic::{QuadraticProgram, Workspace};
//!
//! // Nearest point to (2, 1) with d₀ ≤ 1: minimise ½|d|² - 2 d₀ - d₁.
//! let (hessian, gradient) = ([1.0, 0.0, 0.0, 1.0], [-2.0, -1.0]);
//! let (lower, upper) = ([f64::NEG_INFINITY; 2], [1.0, f64::INFINITY]);
//! let mut workspace = Workspace::new(2, 0, 0);
//! let solution =
//!     workspace.solve(&QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper));
//! assert_eq!(solution.d(), [1.0, 1.0]);
//! assert_eq!(solution.bound_multipliers(), [-1.0, 0.0]); // H d + g = (1 - 2, 1 - 1)
//! ```

pub mod cholesky;
mod curvature;
pub mod eigen;
mod elimination;
pub mod least_squares;
pub mod quadratic;
pub mod regression;
