//! From a limit given by formulas to signed distances at nodes.
//!
//! 1. The boundary is the images of the six faces of a cube, of the parts of the way between the ends of the three turns.
//!    Places on them, at most 5 degrees apart, tell for the nodes of a lattice half as fine which part of the boundary is nearest.
//! 2. A node begins at the nearest of the places of the coarse nodes about it. Two Gauss-Newton steps on its face, within the
//!    face, find the nearest rotation of the boundary.
//! 3. The sign is that of the formulas; where a coarse node is farther from the boundary than a cell is wide, its sign.
//!
//! Where the second turn is a quarter turn, first and third turn about one line, and images of different parts of the cube
//! meet: what is between them by less than twice `beyond` is inside.

use super::nearest::{Ball, Nearest, Nodes};
use condyle_math::{Quat, Vec3};
use condyle_model::limit::field::{
    Boundary, Chart, Grid, Ground, Lattice, Learned, Settings, Shape,
};
use std::f64::consts::PI;
use std::sync::Arc;

/// Nodes along an edge of the map for a shape: 6.6 degrees apart in the middle.
const NODES: usize = 56;
/// The most between neighbouring places of a face, in radians.
const APART: f64 = 5.0 * PI / 180.0;
/// What a cell of a lattice is at most across, in steps of its nodes in the middle: √3, and √2 where steps are longest.
const ACROSS: f64 = 2.5;
/// Gauss-Newton steps from a place to the nearest rotation of its face.
const STEPS: usize = 2;
/// A step by which slopes of a face are found, in parts of it.
const STEP: f64 = 1e-5;

/// What a field of a shape is made of; `nodes` along an edge of the map, 56 where it is not given.
///
/// ```
/// use condyle_learn::limits::field::{State, made, shaped};
/// use condyle_math::{Quat, Vec3};
/// use condyle_model::limit::field::{Ends, Shape};
/// let ends = |low: f64, high: f64| [low.to_radians(), high.to_radians()];
/// let (second, third) = (Ends::fixed(ends(-40.0, 40.0)), Ends::fixed(ends(-30.0, 50.0)));
/// let shape = Shape::new(Vec3::UNITS, ends(-60.0, 60.0), second, third, 0.0).unwrap();
/// let field = made(&shaped(shape, None).into());
/// let (state, distance) = field.state(Quat::from_axis_angle(Vec3::X, 80f64.to_radians()));
/// assert_eq!(state, State::Invalid);
/// assert!((distance.to_degrees() + 20.0).abs() < 0.3);
/// ```
#[must_use]
pub fn shaped(shape: Shape, nodes: Option<usize>) -> Ground {
    Ground {
        samples: vec![],
        takes: vec![],
        thinned: 0.0,
        chart: Chart::new(shape.middle(), Quat::IDENTITY),
        settings: Settings { nodes: nodes.unwrap_or(NODES), hole: None, ..Settings::default() },
        known: None,
        shape: Some(Arc::new(shape)),
    }
}

/// A face of the cube: the turn that is at an end, and which end.
#[derive(Clone, Copy, Debug)]
struct Face {
    turn: usize,
    end: f64,
}

impl Face {
    const ALL: [Self; 6] = {
        let mut all = [Self { turn: 0, end: 0.0 }; 6];
        let mut n = 0;
        while n < 6 {
            all[n] = Self { turn: n / 2, end: (n % 2) as f64 };
            n += 1;
        }
        all
    };

    /// Parts of the three turns at a place of the face.
    fn parts(self, [u, v]: [f64; 2]) -> [f64; 3] {
        match self.turn {
            0 => [self.end, u, v],
            1 => [u, self.end, v],
            _ => [u, v, self.end],
        }
    }

    fn rotation(self, shape: &Shape, at: [f64; 2]) -> Quat {
        shape.rotation(shape.angles_at(self.parts(at)))
    }

    /// How many places along both sides are needed.
    fn counts(self, shape: &Shape) -> [usize; 2] {
        let mut longest = [0.0f64; 2];
        for i in 0..=8 {
            for j in 0..=8 {
                let at = [f64::from(i) / 8.0, f64::from(j) / 8.0];
                let here = self.rotation(shape, at);
                for (side, longest) in longest.iter_mut().enumerate() {
                    let mut there = at;
                    there[side] += STEP;
                    let speed = here.angle_to(self.rotation(shape, there)) / STEP;
                    *longest = longest.max(speed);
                }
            }
        }
        longest.map(|longest| (longest / APART).ceil() as usize + 1)
    }
}

/// A place on the boundary, and how it moves along both sides of its face.
#[derive(Clone, Copy, Debug)]
struct Place {
    face: Face,
    at: [f64; 2],
    here: Quat,
    slopes: [Vec3; 2],
}

impl Place {
    fn new(shape: &Shape, face: Face, at: [f64; 2]) -> Self {
        let here = face.rotation(shape, at);
        // Towards the middle, so that tables are not left.
        let slopes = [0, 1].map(|side| {
            let step = if at[side] > 0.5 { -STEP } else { STEP };
            let mut there = at;
            there[side] += step;
            towards(here, face.rotation(shape, there)) * (1.0 / step)
        });
        Self { face, at, here, slopes }
    }

    /// The rotation of the boundary about this place that is nearest to one: the foot of the perpendicular on the plane of both
    /// slopes, then again from there.
    fn foot(&self, shape: &Shape, q: Quat) -> Quat {
        let [a, b] = self.slopes;
        let (aa, ab, bb) = (a.dot(a) + 1e-9, a.dot(b), b.dot(b) + 1e-9);
        let determinant = (aa * bb - ab * ab).max(1e-12);
        let (mut at, mut here) = (self.at, self.here);
        let mut best = (q.dot(here).abs(), here);
        for _ in 0..STEPS {
            let to = towards(here, q);
            let (ta, tb) = (a.dot(to), b.dot(to));
            let mut step = [(ta * bb - tb * ab) / determinant, (tb * aa - ta * ab) / determinant];
            let room = |side: usize, step: f64| (at[side] + step).clamp(0.0, 1.0) - at[side];
            // At an edge of the face along the edge.
            match [0, 1].map(|side| (room(side, step[side]) - step[side]).abs() > 1e-12) {
                [true, false] => {
                    step[0] = room(0, step[0]);
                    step[1] = (tb - ab * step[0]) / bb;
                }
                [false, true] => {
                    step[1] = room(1, step[1]);
                    step[0] = (ta - ab * step[1]) / aa;
                }
                _ => {}
            }
            at = [0, 1].map(|side| at[side] + room(side, step[side]));
            here = self.face.rotation(shape, at);
            let near = q.dot(here).abs();
            if near > best.0 {
                best = (near, here);
            }
        }
        best.1
    }
}

fn places(shape: &Shape) -> Vec<Place> {
    let mut places = vec![];
    for face in Face::ALL {
        let [m, n] = face.counts(shape);
        for i in 0..m {
            for j in 0..n {
                let part = |i: usize, m: usize| i as f64 / (m - 1).max(1) as f64;
                places.push(Place::new(shape, face, [part(i, m), part(j, n)]));
            }
        }
    }
    places
}

/// The vector from one rotation to another in the first one's axes.
fn towards(q: Quat, p: Quat) -> Vec3 {
    let between = q.conjugate() * p;
    if between.w < 0.0 { (-between).log() } else { between.log() }
}

/// Signed distances of a shape at the nodes.
pub(super) fn grid(ground: &Ground, shape: &Shape) -> Grid {
    let lattice = Lattice::new(ground.settings.nodes.clamp(24, 256));
    let rotations = lattice.nodes();
    let places = places(shape);
    let at: Vec<Quat> = places.iter().map(|place| ground.chart.inward(place.here)).collect();
    let coarse = Coarse::new(ground, shape, (lattice.edge / 2).max(24), &at);
    let beyond = shape.beyond();
    let mut value = vec![f32::NAN; lattice.len()];
    let (mut starts, mut start_of) = (vec![], vec![u32::MAX; lattice.len()]);
    for (node, inward) in rotations.iter().enumerate() {
        let Some(inward) = inward else { continue };
        let q = ground.chart.outward(*inward);
        let (place, known) = coarse.about(*inward, &at);
        let Some(place) = places.get(place as usize) else { continue };
        let inside = known.unwrap_or_else(|| shape.contains(q));
        let foot = place.foot(shape, q);
        let to = towards(foot, q);
        let away = to.norm();
        value[node] = (if inside { away } else { -away } + beyond) as f32;
        // Every other node begins a search for the nearest rotation at its own.
        if [1, lattice.edge, lattice.edge * lattice.edge]
            .iter()
            .all(|stride| (node / stride % lattice.edge).is_multiple_of(2))
        {
            let out = if inside || away < beyond { 1.0 } else { beyond / away };
            start_of[node] = starts.len() as u32;
            starts.push(ground.chart.inward(foot * Quat::exp(to * out)));
        }
    }
    let nodes = Nodes::new(&lattice, &rotations);
    let share = super::layer::volume(&nodes, &value) / (8.0 * PI * PI);
    let learned = Learned {
        spacing: 0.0,
        radius: 0.0,
        gap: 0.0,
        extreme: 0.0,
        surface: super::layer::surface(&nodes, &value),
        outer: share,
        valid: share,
        holes: vec![],
    };
    let boundary = Boundary::new(&lattice, &starts, &start_of);
    Grid { lattice, outer: value, carved: None, near: vec![], counts: vec![], boundary, learned }
}

/// A lattice half as fine, with the nearest place of each node and the signed distance to the boundary by places.
struct Coarse {
    lattice: Lattice,
    near: Nearest,
    inside: Vec<bool>,
}

impl Coarse {
    fn new(ground: &Ground, shape: &Shape, edge: usize, at: &[Quat]) -> Self {
        let lattice = Lattice::new(edge);
        let rotations = lattice.nodes();
        let balls: Vec<Ball> = at.iter().map(|q| Ball::new(*q, 0.0)).collect();
        let nodes = Nodes::new(&lattice, &rotations);
        let near = nodes.nearest(&balls, super::closing::seeds(&lattice, at));
        let inside =
            rotations.iter().map(|q| q.is_some_and(|q| shape.contains(ground.chart.outward(q))));
        let inside = inside.collect();
        Self { lattice, near, inside }
    }

    /// Of a rotation of the map the nearest of the places of the nodes about it, and whether it is inside where they tell.
    fn about(&self, q: Quat, at: &[Quat]) -> (u32, Option<bool>) {
        let (mut best, mut place, mut known) = (-1.0, u32::MAX, None);
        let corners = self.lattice.corners(q);
        for node in corners {
            let Some(index) = self.near.ball.get(node) else { continue };
            let Some(there) = at.get(*index as usize) else { continue };
            let near = q.dot(*there).abs();
            if near > best {
                (best, place) = (near, *index);
            }
            let value = self.near.value.get(node).copied().unwrap_or(0.0);
            if f64::from(value) > ACROSS * self.lattice.angle() {
                known = self.inside.get(node).copied();
            }
        }
        (place, known)
    }
}
