//! Surfaces of simple shapes.

use crate::palette::Colour;
use crate::scene::Surface;
use condyle_math::{Affine, Vec3};
use std::f64::consts::{PI, TAU};

impl Surface {
    /// An opaque surface without triangles.
    pub fn empty(colour: Colour) -> Self {
        Self { positions: vec![], normals: vec![], triangles: vec![], colour, opacity: 1.0 }
    }

    /// The same surface, so opaque.
    #[must_use]
    pub fn with_opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// Adds a corner; its number.
    pub fn corner(&mut self, position: Vec3, normal: Vec3) -> u32 {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        u32::try_from(self.positions.len() - 1).unwrap_or(u32::MAX)
    }

    /// Adds a triangle with the normal of its plane, counter-clockwise from outside.
    pub fn flat(&mut self, corners: [Vec3; 3]) {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let numbers = corners.map(|corner| self.corner(corner, normal));
        self.triangles.push(numbers);
    }

    /// Moves all corners from `from` on: positions by the transform, normals as those of a surface that is
    /// stretched with it.
    pub fn transform(&mut self, frame: &Affine, from: usize) {
        let linear = frame.linear;
        // Cofactors are the inverse transpose times the determinant.
        let cofactors =
            [linear.y.cross(linear.z), linear.z.cross(linear.x), linear.x.cross(linear.y)];
        for position in self.positions.iter_mut().skip(from) {
            *position = (*frame * Vec3::from(*position)).to_array();
        }
        for normal in self.normals.iter_mut().skip(from) {
            let [x, y, z] = *normal;
            *normal = (cofactors[0] * x + cofactors[1] * y + cofactors[2] * z).to_array();
        }
    }
}

/// A ball of 24 by 16 faces.
pub fn ball(at: [f64; 3], radius: f64, colour: Colour) -> Surface {
    let mut surface = Surface::empty(colour);
    add_ball(&mut surface, at.into(), radius, (24, 16));
    surface
}

/// Adds a ball of so many meridians and parallels.
pub fn add_ball(surface: &mut Surface, at: Vec3, radius: f64, (meridians, parallels): (u32, u32)) {
    let (meridians, parallels) = (meridians.max(3), parallels.max(2));
    let mut rows = vec![];
    for parallel in 0..=parallels {
        let (sin, cos) = (PI * f64::from(parallel) / f64::from(parallels)).sin_cos();
        let row: Vec<u32> = (0..meridians)
            .map(|meridian| {
                let (s, c) = (TAU * f64::from(meridian) / f64::from(meridians)).sin_cos();
                let normal = Vec3::new(sin * c, cos, -sin * s);
                surface.corner(at + normal * radius, normal)
            })
            .collect();
        rows.push(row);
    }
    join(surface, &rows, true);
}

/// Adds the faces between rows of corners, each row before the one below it; `closed` rows end where they
/// begin.
pub fn join(surface: &mut Surface, rows: &[Vec<u32>], closed: bool) {
    for pair in rows.windows(2) {
        let count = pair[0].len().min(pair[1].len());
        for i in 0..if closed { count } else { count.saturating_sub(1) } {
            let next = (i + 1) % count;
            surface.triangles.push([pair[0][i], pair[1][i], pair[1][next]]);
            surface.triangles.push([pair[0][i], pair[1][next], pair[0][next]]);
        }
    }
}

/// An ellipsoid with its axes along those of a frame.
pub fn ellipsoid(frame: &Affine, radii: [f64; 3], colour: Colour) -> Surface {
    let mut surface = Surface::empty(colour);
    // Flat triangles are off by less than a thousandth and a half of the radius: 0.09 degrees.
    add_ball(&mut surface, Vec3::ZERO, 1.0, (80, 48));
    let [x, y, z] = radii;
    let linear = condyle_math::Mat3::from_columns(
        frame.linear.x * x,
        frame.linear.y * y,
        frame.linear.z * z,
    );
    surface.transform(&Affine::new(linear, frame.translation), 0);
    surface
}

/// Adds a cone from the middle of its base to its tip.
pub fn add_cone(surface: &mut Surface, base: Vec3, tip: Vec3, radius: f64) {
    const SIDES: u32 = 20;
    let length = (tip - base).norm();
    if !length.is_finite() || length < 1e-9 {
        return;
    }
    let axis = (tip - base) * length.recip();
    let [u, v] = across(axis);
    let ring: Vec<[Vec3; 2]> = (0..=SIDES)
        .map(|i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
            let out = u * c + v * s;
            // Across the slant of the side.
            [base + out * radius, out * length + axis * radius]
        })
        .collect();
    for pair in ring.windows(2) {
        let [[a, na], [b, nb]] = [pair[0], pair[1]];
        let side = [surface.corner(a, na), surface.corner(b, nb), surface.corner(tip, na + nb)];
        surface.triangles.push(side);
        surface.flat([b, a, base]);
    }
}

/// Two directions across one of length 1 and across each other, right-handed with it last.
pub fn across(axis: Vec3) -> [Vec3; 2] {
    let sizes = axis.to_array().map(f64::abs);
    let least = (0..3).min_by(|&i, &j| sizes[i].total_cmp(&sizes[j])).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let side = axis.cross(other.into());
    let side = side * side.norm().max(1e-300).recip();
    [side, axis.cross(side)]
}
