//! Residuals of goals and their derivatives.

use super::Aim;
use condyle_math::{Mat3, Vec3};
use condyle_model::evaluate::log_rate;
use condyle_model::{Jacobian, Model, Pose, Program, SegmentId};

/// An evaluated pose with its Jacobian.
#[derive(Clone, Copy)]
pub(super) struct Evaluated<'a> {
    pub model: &'a Model,
    pub program: &'a Program,
    pub pose: &'a Pose,
    pub jacobian: &'a Jacobian,
}

impl Evaluated<'_> {
    /// The orientation of a segment, or of the world.
    fn axes(&self, segment: Option<SegmentId>) -> Mat3 {
        self.pose.frame(segment).linear
    }

    fn place(&self, (segment, point): super::Anchor) -> Vec3 {
        self.pose.frame(segment) * point
    }

    /// Calls `visit` with each direction that turns a segment and its angular velocity.
    fn visit_spin(&self, segment: Option<SegmentId>, mut visit: impl FnMut(usize, Vec3)) {
        if let Some(segment) = segment {
            for &(direction, twist) in self.program.segment_directions(segment) {
                visit(direction as usize, self.jacobian.twist(twist).angular);
            }
        }
    }
}

/// The residuals of one goal and their derivatives, a row of `tangents` numbers for each.
pub(super) struct Rows<'a> {
    pub residuals: &'a mut [f64],
    pub slopes: &'a mut [f64],
    pub tangents: usize,
}

impl Rows<'_> {
    fn add(&mut self, row: usize, direction: usize, slope: f64) {
        self.slopes[row * self.tangents + direction] += slope;
    }

    fn add_vector(&mut self, direction: usize, slope: Vec3) {
        for (row, slope) in slope.to_array().into_iter().enumerate() {
            self.add(row, direction, slope);
        }
    }
}

impl Aim {
    /// Writes the residuals, and adds the derivatives to rows that are 0.
    pub(super) fn measure(&self, at: Evaluated<'_>, out: &mut Rows<'_>) {
        match self {
            Self::Point { point, at: place } => {
                let [p, q] = [*point, *place].map(|anchor| at.place(anchor));
                out.residuals.copy_from_slice(&(p - q).to_array());
                for (anchor, p, sign) in [(point, p, 1.0), (place, q, -1.0)] {
                    at.jacobian.visit_point(at.program, anchor.0, p, |direction, velocity| {
                        out.add_vector(direction, velocity * sign);
                    });
                }
            }
            Self::Distance { points, distance } => {
                let [p, q] = points.map(|anchor| at.place(anchor));
                let (gap, length) = (p - q, (p - q).norm());
                out.residuals[0] = length - distance;
                // The gradient of points that coincide is not defined, and x is used.
                let along = if length > 1e-12 { gap * (1.0 / length) } else { Vec3::X };
                for (anchor, p, sign) in [(points[0], p, 1.0), (points[1], q, -1.0)] {
                    at.jacobian.visit_point(at.program, anchor.0, p, |direction, velocity| {
                        out.add(0, direction, sign * along.dot(velocity));
                    });
                }
            }
            Self::Orientation { segment, relative_to, rotation } => {
                // R (R₂ W)ᵀ has the angular velocity ω - R (R₂ W)ᵀ ω₂, which log_rate maps to ṙ.
                let wanted = at.axes(*relative_to) * rotation.to_mat3();
                let between = at.axes(Some(*segment)) * wanted.transpose();
                let turn = between.log();
                out.residuals.copy_from_slice(&turn.to_array());
                at.visit_spin(Some(*segment), |direction, spin| {
                    out.add_vector(direction, log_rate(turn, spin));
                });
                at.visit_spin(*relative_to, |direction, spin| {
                    out.add_vector(direction, -log_rate(turn, between * spin));
                });
            }
            Self::Axis { segment, axis, relative_to, along } => {
                let toward = (at.axes(*relative_to) * *along).normalized();
                let mut directed = Directed::new(at.axes(Some(*segment)), *axis, toward, out);
                at.visit_spin(*relative_to, |d, spin| directed.turn(d, spin.cross(toward)));
                at.visit_spin(Some(*segment), |d, spin| directed.turn(d, toward.cross(spin)));
            }
            Self::Look { segment, axis, through, at: place } => {
                let [p, q] = [(Some(*segment), *through), *place].map(|anchor| at.place(anchor));
                let (line, length) = (q - p, (q - p).norm());
                // What looks at itself looks along x.
                let inverse = if length > 1e-12 { 1.0 / length } else { 0.0 };
                let toward = if length > 1e-12 { line * inverse } else { Vec3::X };
                let mut directed = Directed::new(at.axes(Some(*segment)), *axis, toward, out);
                for (segment, p, sign) in [(place.0, q, inverse), (Some(*segment), p, -inverse)] {
                    at.jacobian.visit_point(at.program, segment, p, |direction, velocity| {
                        let moved = velocity * sign;
                        directed.turn(direction, moved - toward * toward.dot(moved));
                    });
                }
                at.visit_spin(Some(*segment), |d, spin| directed.turn(d, toward.cross(spin)));
            }
            Self::Plane { point, origin, normal, .. } => {
                let [p, o] = [*point, *origin].map(|anchor| at.place(anchor));
                let normal = (at.axes(origin.0) * *normal).normalized();
                out.residuals[0] = normal.dot(p - o);
                // n·(ṗ - ȯ) + ṅ·(p - o) is n times the velocity of p seen from the plane.
                for (segment, sign) in [(point.0, 1.0), (origin.0, -1.0)] {
                    at.jacobian.visit_point(at.program, segment, p, |direction, velocity| {
                        out.add(0, direction, sign * normal.dot(velocity));
                    });
                }
            }
            Self::Coordinate { coordinate, value } => {
                out.residuals[0] = at.pose.coordinate(at.model, *coordinate)[0] - value;
                for &(direction, slot) in at.program.coordinate_directions(at.model, *coordinate) {
                    out.add(0, direction as usize, at.jacobian.derivative(slot));
                }
            }
        }
    }
}

/// An axis u of a segment and a direction w, both of length 1, an angle θ apart: with e₁ and e₂ at right
/// angles to u, r = θ/sin θ (e₁·w, e₂·w), so that |r| = θ.
struct Directed<'a, 'r> {
    out: &'a mut Rows<'r>,
    /// u, e₁, e₂ in the world.
    axis: Vec3,
    across: [Vec3; 2],
    /// e₁·w and e₂·w.
    sides: [f64; 2],
    /// θ/sin θ, and its derivative by θ over sin θ.
    factor: f64,
    bend: f64,
}

impl<'a, 'r> Directed<'a, 'r> {
    fn new(axes: Mat3, axis: Vec3, toward: Vec3, out: &'a mut Rows<'r>) -> Self {
        let axis = axis.normalized();
        // Across the coordinate axis to which it is least parallel.
        let [x, y, z] = axis.to_array().map(f64::abs);
        let other = match () {
            () if x <= y && x <= z => Vec3::X,
            () if y <= z => Vec3::Y,
            () => Vec3::Z,
        };
        let first = axis.cross(other).normalized();
        let [axis, first, second] = [axis, first, axis.cross(first)].map(|v| axes * v);
        let sides = [first.dot(toward), second.dot(toward)];
        let (sine, cosine) = (sides[0].hypot(sides[1]), axis.dot(toward));
        let angle = sine.atan2(cosine);
        // Near 0 the Taylor series; the omitted terms are 7 θ⁴/360 and 2 θ²/15. At half a turn the bound
        // avoids 0/0.
        let (factor, bend) = if angle < 1e-4 {
            (1.0 + angle * angle / 6.0, 1.0 / 3.0)
        } else {
            let sine = sine.max(1e-12);
            (angle / sine, (sine - angle * cosine) / (sine * sine * sine))
        };
        out.residuals[0] = factor * sides[0];
        out.residuals[1] = factor * sides[1];
        Self { out, axis, across: [first, second], sides, factor, bend }
    }

    /// Adds a direction of which w, seen from the segment, has this rate.
    fn turn(&mut self, direction: usize, rate: Vec3) {
        // d(θ/sin θ) = bend · sin θ dθ = -bend d(u·w).
        let factor = -self.bend * self.axis.dot(rate);
        for row in 0..2 {
            let slope = self.factor * self.across[row].dot(rate) + factor * self.sides[row];
            self.out.add(row, direction, slope);
        }
    }
}
