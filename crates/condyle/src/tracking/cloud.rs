//! Two clouds of the same points: how large, and which way up, one is as seen from the other.

use condyle_math::Vec3;

/// Sums over pairs of points, each about its centroid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cloud {
    /// Σ pᵢ qⱼ of the places p at rest and the seen ones q.
    product: [[f64; 3]; 3],
    /// Σ |p|² and Σ |q|².
    squares: [f64; 2],
}

/// A direction along an axis: the axis, and whether it is its positive end.
pub(super) type Direction = (usize, bool);

fn unit((axis, positive): Direction) -> Vec3 {
    [Vec3::X, Vec3::Y, Vec3::Z][axis] * if positive { 1.0 } else { -1.0 }
}

impl Cloud {
    /// The sums over pairs of a place at rest and a place where it was seen.
    pub(super) fn of(pairs: impl Iterator<Item = (Vec3, Vec3)> + Clone) -> Self {
        let (count, p, q) = pairs
            .clone()
            .fold((0.0, Vec3::ZERO, Vec3::ZERO), |(n, p, q), (a, b)| (n + 1.0, p + a, q + b));
        let (p, q) = (p * (1.0 / f64::max(count, 1.0)), q * (1.0 / f64::max(count, 1.0)));
        let mut cloud = Self::default();
        for (a, b) in pairs {
            let (a, b) = (a - p, b - q);
            let (from, to) = (a.to_array(), b.to_array());
            for (row, x) in cloud.product.iter_mut().zip(from) {
                for (sum, y) in row.iter_mut().zip(to) {
                    *sum += x * y;
                }
            }
            cloud.squares[0] += a.norm_squared();
            cloud.squares[1] += b.norm_squared();
        }
        cloud
    }

    /// How many times as large the seen cloud is; `None` where either is a point.
    pub(super) fn ratio(&self) -> Option<f64> {
        let [p, q] = self.squares;
        (p > 0.0 && q > 0.0).then(|| (q / p).sqrt())
    }

    /// Which way the axis `up` of the body at rest points in the seen cloud: of the six directions
    /// that whose best turn about itself brings the clouds nearest. `None` where that is hardly better
    /// than `up` itself.
    pub(super) fn upward(&self, up: usize) -> Option<Direction> {
        let (best, direction) = self.likeness(up);
        let upright = (up, true);
        let clear = direction == upright || best > self.agreement(up, upright) + 0.1;
        clear.then_some(direction)
    }

    /// How alike the clouds are in the best of the six directions: 1 where one is the other, turned and
    /// scaled; and that direction.
    pub(super) fn likeness(&self, up: usize) -> (f64, Direction) {
        let directions = (0..3).flat_map(|axis| [(axis, true), (axis, false)]);
        let scored = directions.map(|direction| (self.agreement(up, direction), direction));
        scored.fold((f64::NEG_INFINITY, (up, true)), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// The largest Σ q · R p over the turns R that take the axis `up` to a direction, as a share of
    /// √(Σ |p|² Σ |q|²).
    fn agreement(&self, up: usize, direction: Direction) -> f64 {
        // A right-handed frame whose third axis is `up`, and where one such turn takes it.
        let third = unit(direction);
        let first = unit(((direction.0 + 1) % 3, true));
        let to = [first, third.cross(first), third];
        let from = [(up + 1) % 3, (up + 2) % 3, up];
        let along = |i: usize, j: usize| Vec3::from(self.product[from[i]]).dot(to[j]);
        let sum = along(2, 2) + (along(0, 0) + along(1, 1)).hypot(along(0, 1) - along(1, 0));
        sum / (self.squares[0] * self.squares[1]).sqrt().max(f64::MIN_POSITIVE)
    }

    /// The axis whose mirroring brings the clouds nearest as they stand.
    pub(super) fn mirrored(&self) -> usize {
        let correlation = |axis: &usize| self.product[*axis][*axis];
        (0..3).min_by(|a, b| correlation(a).total_cmp(&correlation(b))).unwrap_or(0)
    }

    /// The horizontal axis about which half a turn brings the clouds nearest.
    pub(super) fn half_turn(&self, up: usize) -> usize {
        let [a, b] = [(up + 1) % 3, (up + 2) % 3];
        if self.product[a][a] >= self.product[b][b] { a } else { b }
    }
}

impl std::ops::AddAssign for Cloud {
    fn add_assign(&mut self, other: Self) {
        for (a, b) in self.product.iter_mut().flatten().zip(other.product.iter().flatten()) {
            *a += b;
        }
        self.squares[0] += other.squares[0];
        self.squares[1] += other.squares[1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: [[f64; 3]; 5] =
        [[0.1, 1.7, 0.0], [0.0, 1.0, 0.2], [0.0, 1.0, -0.25], [0.1, 0.0, 0.1], [0.2, 0.05, -0.1]];

    fn seen(change: impl Fn([f64; 3]) -> [f64; 3] + Clone) -> Cloud {
        Cloud::of(BODY.into_iter().map(move |p| (p.into(), change(p).into())))
    }

    #[test]
    fn a_body_is_found_in_all_six_directions_whatever_way_it_faces() {
        // Each change is a rotation, that is its determinant is 1, and says where (0, 1, 0) goes.
        let (s, c) = 2.1f64.sin_cos();
        let facing = move |[x, y, z]: [f64; 3]| [c * x + s * z, y, c * z - s * x];
        let turned = |change: fn([f64; 3]) -> [f64; 3]| seen(move |p| change(facing(p))).upward(1);
        assert_eq!(turned(|p| p), Some((1, true)));
        assert_eq!(turned(|[x, y, z]| [x, -y, -z]), Some((1, false)));
        assert_eq!(turned(|[x, y, z]| [x, -z, y]), Some((2, true)));
        assert_eq!(turned(|[x, y, z]| [x, z, -y]), Some((2, false)));
        assert_eq!(turned(|[x, y, z]| [y, -x, z]), Some((0, true)));
        assert_eq!(turned(|[x, y, z]| [-y, x, z]), Some((0, false)));
    }

    #[test]
    fn size_and_mirror_are_read_off() {
        assert!((seen(|p| p.map(|x| 3.0 * x + 1.0)).ratio().unwrap() - 3.0).abs() < 1e-12);
        assert_eq!(seen(|_| [1.0; 3]).ratio(), None);
        assert_eq!(seen(|[x, y, z]| [x, y, -z]).mirrored(), 2);
        assert_eq!(seen(|[x, y, z]| [x, -y, -z]).half_turn(1), 0);
        assert_eq!(seen(|[x, y, z]| [-x, -y, z]).half_turn(1), 2);
        // A point of its own says nothing about directions.
        assert_eq!(Cloud::default().likeness(1).0, 0.0);
        let [same, mirrored] = [seen(|p| p), seen(|[x, y, z]| [x, y, -z])].map(|c| c.likeness(1).0);
        assert!((same - 1.0).abs() < 1e-12 && mirrored < 0.99, "{same} {mirrored}");
    }
}
