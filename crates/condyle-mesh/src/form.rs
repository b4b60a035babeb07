//! What a bone looks like.

use crate::{Ball, Block, Mesh, Plate, Rib, Spindle, Station, Tube};
use condyle_math::{Growth, Vec3};

/// A surface by a few numbers, in the frame of its segment; lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// An ellipsoid.
    Ball(Ball),
    /// A box.
    Block(Block),
    /// A curve swept with an ellipse.
    Tube(Tube),
    /// A curved plate within an outline.
    Plate(Plate),
    /// A rib by its published parameters.
    Rib(Rib),
    /// A long octahedron.
    Spindle(Spindle),
}

/// How a surface looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Finish {
    /// Ivory, for bones.
    #[default]
    Bone,
    /// Pale blue, for cartilage.
    Cartilage,
    /// Grey-blue, for joints and ends.
    Joint,
    /// Orange, for highlights.
    Accent,
    /// Green, for recorded markers.
    Marker,
}

impl Finish {
    /// All of them, in their order.
    pub const ALL: [Self; 5] =
        [Self::Bone, Self::Cartilage, Self::Joint, Self::Accent, Self::Marker];

    /// Its word in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bone => "bone",
            Self::Cartilage => "cartilage",
            Self::Joint => "joint",
            Self::Accent => "accent",
            Self::Marker => "marker",
        }
    }

    /// Linear red, green, blue.
    #[must_use]
    pub fn colour(self) -> [f32; 3] {
        match self {
            Self::Bone => [0.82, 0.76, 0.63],
            Self::Cartilage => [0.55, 0.68, 0.74],
            Self::Joint => [0.18, 0.26, 0.36],
            Self::Accent => [0.85, 0.30, 0.05],
            Self::Marker => [0.05, 0.55, 0.22],
        }
    }
}

impl Form {
    /// Its triangles; none where its numbers leave no surface, such as a tube of no stations.
    #[must_use]
    pub fn mesh(&self) -> Mesh {
        match self {
            Self::Ball(ball) => ball.mesh(),
            Self::Block(block) => block.mesh(),
            Self::Tube(tube) => tube.mesh(),
            Self::Plate(plate) => plate.mesh(),
            Self::Rib(rib) => rib.mesh(),
            Self::Spindle(spindle) => spindle.mesh(),
        }
    }

    /// The same form of a body that has grown. A section keeps its shape: what is thin grows with the mean where its direction
    /// is not one number's.
    #[must_use]
    pub fn grown(&self, by: &Growth) -> Self {
        let column = |turn: condyle_math::Mat3, axis| by.length(turn * axis);
        let each = |turn, v: Vec3| {
            let factors = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| column(turn, axis));
            v.times(Vec3::from(factors))
        };
        match self {
            Self::Ball(b) => {
                Self::Ball(Ball { at: by.point(b.at), radii: each(b.turn, b.radii), ..*b })
            }
            Self::Block(b) => {
                Self::Block(Block { at: by.point(b.at), size: each(b.turn, b.size), ..*b })
            }
            Self::Tube(tube) => {
                let across = by.length(tube.across.normalized());
                let station = |s: &Station| Station {
                    at: by.point(s.at),
                    radii: [s.radii[0] * across, s.radii[1] * by.mean()],
                };
                Self::Tube(Tube {
                    stations: tube.stations.iter().map(station).collect(),
                    across: tube.across,
                })
            }
            Self::Plate(plate) => Self::Plate(Plate {
                outline: plate.outline.iter().map(|p| by.point(*p)).collect(),
                middle: by.point(plate.middle),
                thickness: plate.thickness * by.mean(),
            }),
            Self::Rib(rib) => Self::Rib(Rib {
                at: by.point(rib.at),
                chord: rib.chord * by.length(rib.along.normalized()),
                along: by.direction(rib.along),
                radii: rib.radii.map(|r| r * by.mean()),
                ..*rib
            }),
            Self::Spindle(s) => {
                Self::Spindle(Spindle { from: by.point(s.from), to: by.point(s.to) })
            }
        }
    }

    /// The form in the mirror: what becomes of a point, and of a direction that is no turn.
    #[must_use]
    pub fn mirrored(&self, point: &dyn Fn(Vec3) -> Vec3) -> Self {
        // A turn T becomes D T D: its columns are the mirrored ones of the mirrored axes.
        let turn = |m: condyle_math::Mat3| {
            let column = |axis: Vec3| point(m * point(axis));
            condyle_math::Mat3::from_columns(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
        };
        match self {
            Self::Ball(b) => Self::Ball(Ball { at: point(b.at), turn: turn(b.turn), ..*b }),
            Self::Block(b) => Self::Block(Block { at: point(b.at), turn: turn(b.turn), ..*b }),
            Self::Tube(tube) => Self::Tube(Tube {
                stations: tube.stations.iter().map(|s| Station { at: point(s.at), ..*s }).collect(),
                across: point(tube.across),
            }),
            Self::Plate(plate) => Self::Plate(Plate {
                outline: plate.outline.iter().map(|p| point(*p)).collect(),
                middle: point(plate.middle),
                thickness: plate.thickness,
            }),
            Self::Rib(rib) => Self::Rib(Rib {
                at: point(rib.at),
                along: point(rib.along),
                outward: point(rib.outward),
                ..*rib
            }),
            Self::Spindle(s) => Self::Spindle(Spindle { from: point(s.from), to: point(s.to) }),
        }
    }

    /// What is wrong with its numbers, if anything.
    ///
    /// # Errors
    /// A number that is not finite or beyond a kilometre, a size that is not positive, an outline of fewer than
    /// three points, a tube of fewer than two; a rib whose peak is not between its ends or whose neck does not
    /// reach its spiral.
    pub fn check(&self) -> Result<(), &'static str> {
        let finite = |v: Vec3| v.to_array().iter().all(|x| x.abs() < 1e3);
        let size = |x: f64| (1e-6..1e3).contains(&x);
        let both = |r: [f64; 2]| r.iter().all(|&r| size(r));
        let (places, sizes) = match self {
            Self::Ball(b) => (finite(b.at), b.radii.to_array().into_iter().all(size)),
            Self::Block(b) => (finite(b.at), b.size.to_array().into_iter().all(size)),
            Self::Tube(tube) => {
                if tube.stations.len() < 2 {
                    return Err("a tube has two points at least");
                }
                let stations = &tube.stations;
                let places = stations.iter().all(|s| finite(s.at)) && finite(tube.across);
                (places, stations.iter().all(|s| both(s.radii)))
            }
            Self::Plate(plate) => {
                if plate.outline.len() < 3 {
                    return Err("an outline has three points at least");
                }
                let places = plate.outline.iter().all(|p| finite(*p)) && finite(plate.middle);
                (places, size(plate.thickness))
            }
            Self::Rib(rib) => {
                let [x, y] = rib.peak;
                let alpha = y.atan2(x);
                if !(x > 0.0 && x < 1.0 && y > 0.0 && y < 5.0) {
                    return Err("the peak of a rib is between its ends, and outward");
                }
                if !(rib.angle > alpha && rib.angle < std::f64::consts::PI) {
                    return Err("the inner angle of a rib is larger than that of its peak");
                }
                if !(rib.proximal.abs() < 5.0 && rib.distal.abs() < 5.0) {
                    return Err("the exponents of a rib are between -5 and 5");
                }
                let places = finite(rib.at) && finite(rib.along) && finite(rib.outward);
                (places, size(rib.chord) && both(rib.radii))
            }
            Self::Spindle(s) => (finite(s.from) && finite(s.to), true),
        };
        if !places {
            return Err("places are finite, and within a kilometre");
        }
        if !sizes { Err("sizes are positive, and below a kilometre") } else { Ok(()) }
    }
}
