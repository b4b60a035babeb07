//! A learned limit in numbers.

use condyle_diagnostics::Error;
use condyle_learn::limits::mobility::{
    self, Compared, Extent, InSystem, Interval, Placed, Thin, placed,
};
use condyle_learn::limits::{Field, State, uniform};
use condyle_math::{EulerOrder, Quat, Vec3};

/// An axis of the child by a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// `x`, `y`, `z`, or the numbers that were given.
    pub name: String,
    /// Its direction.
    pub direction: Vec3,
}

/// How far a limit goes about an axis of the child.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// The axis.
    pub axis: Axis,
    /// From the middle about the axis to the first rotation outside.
    pub through_middle: Extent,
    /// The smallest arc that holds 99 % of the twists about the axis: its start and its length, in radians.
    pub twists: [f64; 2],
}

/// A hole or a thin region, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The region.
    pub thin: Thin,
    /// Its middle as plane, elevation and twist.
    pub placed: Placed,
}

/// A learned limit in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The share of all rotations that is valid.
    pub share: f64,
    /// Its bounds; `None` where there are too few samples to leave any out.
    pub interval: Option<Interval>,
    /// The deepest rotation: the middle.
    pub middle: Quat,
    /// How deep it is, in radians.
    pub depth: f64,
    /// The largest angle between two valid rotations, in radians.
    pub largest_angle: f64,
    /// Extents about axes.
    pub about: Vec<About>,
    /// The same in three joint coordinate systems, by the names of their orders.
    pub systems: Vec<(&'static str, InSystem)>,
    /// Suspected holes, then thin regions.
    pub regions: Vec<Region>,
    /// From what distance to the nearest sample on a region is thin, in radians.
    pub thin_from: f64,
}

/// The joint coordinate systems of the ISB for the shoulder (Y-X-Y) and for hip, knee and elbow (Z-X-Y), and one in
/// neither.
const SYSTEMS: [&str; 3] = ["yxy", "zxy", "xyz"];

/// Even rotations with which shares are found: an error of about a thousandth.
const EVEN: usize = 200_000;

/// A field in numbers. `axes` are asked about beside x, y and z; `bone` is the direction of the bone at the identity.
///
/// # Errors
/// Those of learning from parts.
pub fn report(field: &Field, axes: &[Axis], bone: Vec3) -> Result<Report, Error> {
    let inside = |q: Quat| field.state(q).0 == State::Valid;
    let distance = |q: Quat| field.distance(q);
    let valid: Vec<Quat> = uniform(EVEN).filter(|q| inside(*q)).collect();
    let middle =
        mobility::middle(&distance, if valid.is_empty() { field.samples() } else { &valid });
    let middle = middle.unwrap_or(Quat::IDENTITY);
    let own = [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)]
        .map(|(name, direction)| Axis { name: name.to_owned(), direction });
    let about = own.iter().chain(axes).map(|axis| About {
        axis: axis.clone(),
        through_middle: mobility::about(&inside, middle, axis.direction.normalized()),
        twists: mobility::twists(&valid, axis.direction, 0.99),
    });
    let systems = SYSTEMS.map(|name| {
        let order = name.parse().unwrap_or(EulerOrder::XYZ);
        (name, mobility::in_system(&inside, order, 120))
    });
    let ground = field.ground();
    let learned = field.learned();
    let scale = ground.settings.hole.map_or(2.5, |[size, _]| size);
    let thin_from = 0.8 * scale * learned.spacing;
    let regions = mobility::thin(field, thin_from, 8)
        .into_iter()
        .map(|thin| Region { placed: placed(thin.centre, bone), thin });
    Ok(Report {
        share: valid.len() as f64 / EVEN as f64,
        interval: mobility::interval(field)?,
        middle,
        depth: field.distance(middle),
        largest_angle: mobility::largest_angle(&valid),
        about: about.collect(),
        systems: systems.to_vec(),
        regions: regions.collect(),
        thin_from,
    })
}

/// An axis that points to the side: what is mirrored is seen in a mirror across it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// x.
    X,
    /// y.
    Y,
    /// z, as in the axes of the ISB.
    Z,
}

impl Side {
    /// The rotation of the other side: D R D with D = diag(1, 1, -1) for z.
    #[must_use]
    pub fn mirrored(self, q: Quat) -> Quat {
        match self {
            Self::X => Quat { y: -q.y, z: -q.z, ..q },
            Self::Y => Quat { x: -q.x, z: -q.z, ..q },
            Self::Z => Quat { x: -q.x, y: -q.y, ..q },
        }
    }
}

/// Two limits compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Versus {
    /// What they have in common.
    pub compared: Compared,
    /// Where each goes farthest beyond the other.
    pub beyond: [Option<Placed>; 2],
    /// Of each region of the first, what the second says of its middle.
    pub regions: Vec<State>,
}

/// Compares two fields; the other is mirrored first where a side is given. `regions` are those of the first.
#[must_use]
pub fn versus(
    first: &Field,
    other: &Field,
    mirror: Option<Side>,
    regions: &[Region],
    bone: Vec3,
) -> Versus {
    let turned = |q: Quat| mirror.map_or(q, |side| side.mirrored(q));
    let one = |q: Quat| first.distance(q);
    let two = |q: Quat| other.distance(turned(q));
    let compared = mobility::compared(&one, &two, EVEN);
    let regions = regions.iter().map(|r| other.state(turned(r.thin.centre)).0).collect();
    let beyond = compared.beyond.map(|far| far.map(|far| placed(far.at, bone)));
    Versus { compared, beyond, regions }
}
