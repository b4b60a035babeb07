//! What is in a picture: plain data in metres, in the world.

use crate::camera::Bounds;
use crate::palette::Colour;

/// Everything in a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Surfaces; those that are not opaque are drawn over the others, from back to front.
    pub surfaces: Vec<Surface>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Names at places.
    pub labels: Vec<Label>,
    /// The ground, if there is one.
    pub ground: Option<Ground>,
}

/// Triangles with a normal at every corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Corners in metres.
    pub positions: Vec<[f64; 3]>,
    /// The outward normal at each corner, of any length.
    pub normals: Vec<[f64; 3]>,
    /// Three corners each, counter-clockwise from outside. Those that name a corner that is not there are
    /// not drawn.
    pub triangles: Vec<[u32; 3]>,
    /// The colour under white light.
    pub colour: Colour,
    /// 1 hides what is behind, 0 is not seen.
    pub opacity: f64,
}

/// A line through points.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its points in metres.
    pub points: Vec<[f64; 3]>,
    /// Its width in pixels.
    pub width: f64,
    /// Its colour; lines are not lit.
    pub colour: Colour,
    /// How opaque it is where nothing is in front of it.
    pub opacity: f64,
    /// How opaque it is where something is.
    pub through: f64,
}

/// A name at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The place that is named, in metres.
    pub at: [f64; 3],
    /// One line of text.
    pub text: String,
    /// The colour of the text.
    pub colour: Colour,
}

/// A level plane with a grid, faded away from what stands on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// The direction up, of length 1.
    pub up: [f64; 3],
    /// A direction along the grid, of length 1 and across `up`.
    pub forward: [f64; 3],
    /// A point on it, where it is seen most.
    pub middle: [f64; 3],
    /// How far from there it is gone, in metres.
    pub radius: f64,
}

impl Scene {
    /// The box of all surfaces and lines.
    pub fn bounds(&self) -> Option<Bounds> {
        let surfaces = self.surfaces.iter().flat_map(|s| s.positions.iter().copied());
        Bounds::of(surfaces.chain(self.lines.iter().flat_map(|l| l.points.iter().copied())))
    }
}
