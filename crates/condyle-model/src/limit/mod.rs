//! Joint limits.
//!
//! A [`Limit`] bounds a few numbers x: coordinates, other scalars of a network, or an orientation. It
//! gives
//!
//! ```text
//! rows g(x) with slopes ∂g/∂x    legal: all g ≥ 0; radians or metres, a signed distance where it can be
//! the nearest legal numbers      x itself where it is legal
//! a margin                       how far x is from where the nearest legal numbers jump
//! ```
//!
//! In posed mode the nearest legal numbers of a limit on scalars are used. In open mode the numbers pass
//! unchanged, and the rows are inequalities for a solver. A limit on what is measured between segments
//! gives its rows in both modes and moves nothing: it can act on joints through which it is measured.
//!
//! A [`Range`] limits one coordinate, a [`Cone`] swing and twist of a ball joint together. The limits that
//! are laws of components are with them: [`JointCone`](crate::component::JointCone),
//! [`Ellipse`](crate::component::Ellipse), [`HalfSpace`](crate::component::HalfSpace),
//! [`FieldLimit`](crate::component::FieldLimit) of a [`field`] that was learned.

mod cone;
pub mod field;
mod range;

pub use cone::{Cone, ConeError, ConePoint, Legal, Projected, Projection};
pub use field::{Field, LearnedLimit};
pub use range::Range;

/// The most numbers that one limit reads: an orientation, and another that it depends on.
pub const MOST_LIMITED: usize = 8;

/// The most rows of one limit.
pub const MOST_ROWS: usize = 3;

/// A row of a limit: its value, not negative where the numbers are legal, and its slopes along each of
/// them; of an orientation along its three tangents q ⊕ δ = q·exp(δ), then those of what it depends on.
pub type Row = (f64, [f64; MOST_LIMITED]);

/// What every limit gives.
pub trait Limit: std::fmt::Debug + Send + Sync {
    /// The number of rows, at most [`MOST_ROWS`].
    fn rows(&self) -> usize;

    /// The rows at these numbers, an orientation as x, y, z, w; the first [`Limit::rows`] count.
    fn rows_at(&self, numbers: &[f64]) -> [Row; MOST_ROWS];

    /// The nearest legal numbers; `None` if the given ones are legal.
    fn legal(&self, numbers: &[f64]) -> Option<[f64; MOST_LIMITED]>;

    /// How far outside these numbers are, in radians or metres, as people say it; 0 if they are legal.
    ///
    /// The distance to the nearest legal numbers; of an orientation, the greater of how far its direction
    /// and how far its twist is outside.
    fn beyond(&self, numbers: &[f64]) -> f64 {
        let legal = self.legal(numbers);
        legal.map_or(0.0, |legal| {
            let apart = numbers.iter().zip(legal).map(|(asked, legal)| (asked - legal).powi(2));
            apart.sum::<f64>().sqrt()
        })
    }

    /// A measure of the distance of these numbers to the nearest ones where [`Limit::legal`] is
    /// discontinuous; infinite if they are legal or there is no such place.
    fn margin(&self, numbers: &[f64]) -> f64;
}

/// Numbers with zeros behind them.
pub(crate) fn padded<const N: usize>(numbers: [f64; N]) -> [f64; MOST_LIMITED] {
    let mut all = [0.0; MOST_LIMITED];
    for (to, from) in all.iter_mut().zip(numbers) {
        *to = from;
    }
    all
}

/// A row that does not exist.
pub(crate) const NO_ROW: Row = (f64::INFINITY, [0.0; MOST_LIMITED]);
