//! Chains cut into joints that slide first and then turn.

use super::chain::{Step, is_identity};
use super::rule::Value;
use condyle_math::{Affine, Mat3, Vec3};

/// One joint: before · slides · turns · after, with at most three of each about independent axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The frame before it.
    pub before: Affine,
    /// Slides along axes.
    pub slides: Vec<(Vec3, Value)>,
    /// Turns about body-fixed axes.
    pub turns: Vec<(Vec3, Value)>,
    /// The frame after it.
    pub after: Affine,
}

impl Piece {
    fn starting_at(before: Affine) -> Self {
        Self { before, slides: vec![], turns: vec![], after: Affine::IDENTITY }
    }

    /// Whether it does not move.
    pub fn is_fixed(&self) -> bool {
        self.slides.is_empty() && self.turns.is_empty()
    }

    /// All values with whether they turn.
    pub fn values(&self) -> impl Iterator<Item = (Value, bool)> + '_ {
        let slides = self.slides.iter().map(|&(_, value)| (value, false));
        slides.chain(self.turns.iter().map(|&(_, value)| (value, true)))
    }
}

/// The joints of a chain of fixed frames, slides and turns, at least one. Balls are left out.
pub fn pieces(steps: &[Step]) -> Vec<Piece> {
    let mut all = vec![];
    let mut piece = Piece::starting_at(Affine::IDENTITY);
    for step in steps {
        match *step {
            Step::Fixed(frame) if piece.is_fixed() => piece.before = piece.before * frame,
            Step::Fixed(frame) => {
                piece.after = piece.after * frame;
                if piece.turns.is_empty() {
                    // Translations commute.
                    let place = piece.after.translation;
                    piece.before = piece.before.shifted(place);
                    piece.after.translation = Vec3::ZERO;
                }
            }
            Step::Slide { axis, value } => {
                let turned = piece.after.linear * axis;
                if !piece.turns.is_empty() || !independent(&piece.slides, turned) {
                    all.push(next(&mut piece));
                    piece.slides.push((axis, value));
                } else {
                    piece.slides.push((turned, value));
                }
            }
            Step::Turn { axis, value } => {
                let turned = piece.after.linear * axis;
                let apart = piece.after.translation.norm() > 1e-15;
                if !piece.is_fixed() && (apart || !independent(&piece.turns, turned)) {
                    all.push(next(&mut piece));
                    piece.turns.push((axis, value));
                } else {
                    piece.turns.push((turned, value));
                }
            }
            Step::Ball { .. } => {}
        }
    }
    all.push(piece);
    all
}

/// Ends a joint; what comes after it begins the next.
fn next(piece: &mut Piece) -> Piece {
    let after = std::mem::replace(&mut piece.after, Affine::IDENTITY);
    std::mem::replace(piece, Piece::starting_at(after))
}

/// Whether another axis leaves a set of at most three that are well apart.
fn independent(axes: &[(Vec3, Value)], axis: Vec3) -> bool {
    match *axes {
        [] => true,
        [(a, _)] => a.cross(axis).norm() > 0.05,
        [(a, _), (b, _)] => a.cross(b).normalized().dot(axis).abs() > 0.05,
        _ => false,
    }
}

/// Three independent axes that begin with the given ones.
pub fn completed(axes: &[(Vec3, Value)]) -> [Vec3; 3] {
    let other = |a: Vec3| {
        let least = [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .min_by(|u, v| u.dot(a).abs().total_cmp(&v.dot(a).abs()));
        a.cross(least.unwrap_or(Vec3::X)).normalized()
    };
    match *axes {
        [] => [Vec3::X, Vec3::Y, Vec3::Z],
        [(a, _)] => {
            let b = other(a);
            [a, b, a.cross(b).normalized()]
        }
        [(a, _), (b, _)] => [a, b, a.cross(b).normalized()],
        [(a, _), (b, _), (c, _), ..] => [a, b, c],
    }
}

/// Whether a frame does nothing.
pub fn is_still(frame: &Affine) -> bool {
    is_identity(frame)
}

/// The rotation that puts y up where z is.
pub fn upright() -> Affine {
    Affine::from_rotation(Mat3::from_columns(Vec3::X, Vec3::Z, -Vec3::Y))
}
