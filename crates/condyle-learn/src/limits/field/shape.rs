//! From a limit given by formulas to signed distances at nodes.
//!
//! 1. The boundary is the images of the six faces of a cube, of the parts of the way between the ends of the three turns.
//!    Places on them, at most 2.5 degrees apart, tell for every node which part of the boundary is nearest.
//! 2. From that place one Gauss-Newton step on its face, within the face, finds the nearest rotation of the boundary.
//! 3. The sign is that of the formulas.
//!
//! Where the second turn is a quarter turn, first and third turn about one line, and images of different parts of the cube
//! meet: what is between them by less than twice `beyond` is inside.

use super::nearest::{Ball, Nearest, Nodes};
use condyle_math::{Quat, Vec3};
use condyle_model::limit::field::{Boundary, Chart, Grid, Ground, Lattice, Learned, Settings, Shape};
use std::f64::consts::PI;
use std::sync::Arc;

/// Nodes along an edge of the map for a shape: 6.6 degrees apart in the middle.
const NODES: usize = 56;
/// The most between neighbouring places of a face, in radians.
const APART: f64 = 2.5 * PI / 180.0;
/// Farther than this from the boundary the nearest of the places is near enough, in radians: within 0.1 degrees.
const NEAR: f32 = 0.4;
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

    /// The angle from a rotation to the boundary about this place: from the foot of the perpendicular on the plane of both
    /// slopes, which is on the boundary but for its curvature over half of what places are apart.
    fn angle_to(&self, shape: &Shape, q: Quat) -> f64 {
        let to = towards(self.here, q);
        let [a, b] = self.slopes;
        let (aa, ab, bb) = (a.dot(a) + 1e-9, a.dot(b), b.dot(b) + 1e-9);
        let (ta, tb) = (a.dot(to), b.dot(to));
        let determinant = (aa * bb - ab * ab).max(1e-12);
        let mut step = [(ta * bb - tb * ab) / determinant, (tb * aa - ta * ab) / determinant];
        let room = |side: usize, step: f64| (self.at[side] + step).clamp(0.0, 1.0) - self.at[side];
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
        let at = [0, 1].map(|side| self.at[side] + room(side, step[side]));
        self.face.rotation(shape, at).angle_to(q).min(to.norm())
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
    let nodes = Nodes::new(&lattice, &rotations);
    let places = places(shape);
    let at: Vec<Quat> = places.iter().map(|place| ground.chart.inward(place.here)).collect();
    let balls: Vec<Ball> = at.iter().map(|q| Ball::new(*q, 0.0)).collect();
    let Nearest { mut value, ball } = nodes.nearest(&balls, super::closing::seeds(&lattice, &at));
    for ((value, ball), q) in value.iter_mut().zip(&ball).zip(&rotations) {
        let Some(q) = q else {
            *value = f32::NAN;
            continue;
        };
        let q = ground.chart.outward(*q);
        if *value < NEAR + shape.beyond() as f32
            && let Some(place) = places.get(*ball as usize)
        {
            *value = value.min(place.angle_to(shape, q) as f32);
        }
        let sign = if shape.contains(q) { 1.0 } else { -1.0 };
        *value = sign * *value + shape.beyond() as f32;
    }
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
    // Searches for the nearest rotation start on the boundary without what is beyond it, and go out from there.
    let boundary = Boundary::new(&lattice, &at, &ball);
    Grid { lattice, outer: value, carved: None, near: vec![], counts: vec![], boundary, learned }
}
