//! The mirror image of a body's side.
//!
//! D is the reflection: diag(1, 1, -1) for a plane normal to z, and so on. A point p becomes D·p, a frame
//! D·T·D, the axis of a slide D·a, and the axis of a turn -D·a (it is a pseudovector).

use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Mat3, Vec3};

/// A reflection at a plane through the origin, normal to one of the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reflection {
    axis: usize,
}

/// What has to change beside a law that was mirrored.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Mirrored {
    /// Slope and intercept for each input: the mirrored law reads slope·x + intercept. Empty where all
    /// inputs stay as they are.
    pub inputs: Vec<[f64; 2]>,
    /// A fixed transform after the law's.
    pub after: Option<Affine>,
}

impl Reflection {
    /// The reflection that reverses an axis: 0 for x, 1 for y, 2 for z; `None` for other numbers.
    pub fn new(axis: usize) -> Option<Self> {
        (axis < 3).then_some(Self { axis })
    }

    /// The axis that it reverses.
    pub fn axis(self) -> usize {
        self.axis
    }

    /// D·p.
    #[must_use]
    pub fn point(self, p: Vec3) -> Vec3 {
        let mut p = p.to_array();
        p[self.axis] = -p[self.axis];
        Vec3::from(p)
    }

    /// -D·a: the mirrored axis of a turn.
    #[must_use]
    pub fn turning(self, axis: Vec3) -> Vec3 {
        -self.point(axis)
    }

    /// D·T·D.
    #[must_use]
    pub fn frame(self, frame: Affine) -> Affine {
        // D·M·D changes the sign of entries that mix the reversed axis with another.
        let column =
            |c: usize, v: Vec3| if c == self.axis { -self.point(v) } else { self.point(v) };
        let m = frame.linear;
        let linear = Mat3::from_columns(column(0, m.x), column(1, m.y), column(2, m.z));
        Affine::new(linear, self.point(frame.translation))
    }

    /// D·c(u), for a curve of three splines.
    pub(super) fn path(self, splines: &mut [SimmSpline; 3]) {
        let (x, y) = splines[self.axis].knots().map(|(x, y)| (x, -y)).unzip();
        if let Ok(reversed) = SimmSpline::new(x, y) {
            splines[self.axis] = reversed;
        }
    }
}
