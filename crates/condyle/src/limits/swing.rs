//! The directions that a bone reaches, coloured by how far it can twist there.

use condyle_learn::limits::field::fibre;
use condyle_math::{Quat, Vec3};
use condyle_mesh::{Mesh, Patch};

/// Each triangle of an icosahedron is cut in four so often: corners 2 degrees apart.
pub const LEVEL: u32 = 5;
/// The inner radius of a shell whose outer is 1.
const INNER: f64 = 0.94;

/// The colours of the least and of the most twist, as `#rrggbb` of a page would have them: yellow, and green-blue.
pub const COLOURS: [[u8; 3]; 2] = [[0xf0, 0xd0, 0x50], [0x2c, 0x9c, 0xa6]];

/// The directions that a bone reaches.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// The part of the sphere of directions, in the reference.
    pub patch: Patch,
    /// How much of the turn about the bone is valid at each corner, in radians.
    pub widths: Vec<f64>,
}

impl Swing {
    /// Of a signed distance (positive inside) and a bone along `bone` in the child.
    ///
    /// Directions are cut at the zero of the greatest distance of all twists: the boundary that is asked is the one that is
    /// drawn.
    ///
    /// ```
    /// use condyle::limits::Swing;
    /// use condyle::math::{Quat, Vec3};
    /// // Turns by less than 60 degrees: the bone goes as far, and twists most in the middle, by ±60 degrees.
    /// let most = 60f64.to_radians();
    /// let swing = Swing::of(&|q: Quat| most - q.angle_to(Quat::IDENTITY), Vec3::X, 4);
    /// let lowest = swing.patch.corners.iter().map(|v| v.x).fold(1.0, f64::min);
    /// assert!((lowest.acos() - most).abs() < 1e-4);
    /// assert!((swing.most() - 2.0 * most).abs() < 0.01);
    /// ```
    #[must_use]
    pub fn of(distance: &dyn Fn(Quat) -> f64, bone: Vec3, level: u32) -> Self {
        let bone = bone.normalized();
        let patch = Patch::of(&|v| fibre(distance, bone, v).deepest, level);
        let widths = patch.corners.iter().map(|v| fibre(distance, bone, *v).width).collect();
        Self { patch, widths }
    }

    /// The least twist, in radians.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.widths.iter().copied().fold(f64::INFINITY, f64::min).min(self.most())
    }

    /// The most twist, in radians.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.widths.iter().copied().fold(0.0, f64::max)
    }

    /// A closed shell about the joint of outer radius 1, facing outward, and for each of its corners the colour, red, green and
    /// blue in linear light from 0 to 1.
    #[must_use]
    pub fn shell(&self) -> (Mesh, Vec<[f32; 3]>) {
        let (mesh, own) = self.patch.shell(1.0, INNER);
        let (least, most) = (self.least(), self.most());
        let colour = |corner: u32| {
            let width = self.widths.get(corner as usize).copied().unwrap_or(least);
            let share = if most > least { (width - least) / (most - least) } else { 1.0 };
            let [low, high] = COLOURS;
            [0, 1, 2].map(|i| {
                let [low, high] = [low[i], high[i]].map(linear);
                (low + (high - low) * share) as f32
            })
        };
        (mesh, own.into_iter().map(colour).collect())
    }
}

/// A byte of a colour in linear light (IEC 61966-2-1).
fn linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[cfg(all(test, feature = "picture"))]
mod tests {
    /// The same colours as in pictures.
    #[test]
    fn colours_are_those_of_pictures() {
        use condyle_render::palette;
        assert_eq!(super::COLOURS, [palette::LIMIT_LOW, palette::LIMIT]);
    }
}
