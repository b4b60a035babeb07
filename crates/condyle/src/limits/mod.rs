//! Limits learned from rotations: learned, opened, asked, saved.
//!
//! ```
//! use condyle::formats::document::limit;
//! use condyle::limits::{About, Cloud, Settings, State, learn};
//! use condyle::math::{Quat, Vec3};
//! // A joint of which all turns by up to 50 degrees about two axes were seen.
//! let steps = |i: i32| (i - 7) as f64 * 7f64.to_radians();
//! let take: Vec<Quat> = (0..15 * 15 * 3)
//!     .map(|n| Vec3::new(steps(n % 15), 0.05 * f64::from(n / 225 - 1), steps(n / 15 % 15)))
//!     .filter(|turn| turn.norm() < 50f64.to_radians())
//!     .map(Quat::exp)
//!     .collect();
//! let cloud = Cloud::gather(&[&take], 2f64.to_radians())?;
//! let about = About { child: "hand".into(), reference: Some("forearm".into()), ..About::default() };
//! let learned = learn(&cloud, &Settings { nodes: 48, ..Settings::default() }, about)?;
//! let far = learned.field().answer(Quat::exp(Vec3::X * 80f64.to_radians()));
//! assert_eq!(far.state, State::Invalid);
//! assert!((far.distance.to_degrees() + 30.0).abs() < 6.0);
//! // Saved and read again, it answers the same.
//! let text = limit::write(&learned);
//! let again = limit::read(&text, &mut |_| Err("it stands alone".into()))?.value;
//! assert_eq!(again.field().answer(Quat::exp(Vec3::X * 80f64.to_radians())), far);
//! # Ok::<(), condyle::Error>(())
//! ```
//!
//! [`open::limit`](crate::open::limit) opens a file, [`encode::limit`](crate::encode::limit) gives the bytes of one. The field
//! itself is made when [`LearnedLimit::field`] is first called, which for 96 nodes takes about a second.

mod swing;

pub use swing::{COLOURS, LEVEL, Swing};

pub use condyle_learn::limits::field::{
    About, Answer, Evidence, Field, Ground, Hole, Known, Learned, LearnedLimit, Settings, State,
    limit as learn, made, shaped,
};
pub use condyle_learn::limits::{Cloud, Gathered, SPACING, herda2003};
pub use condyle_model::limit::field::{Ends, Shape, ShapeError};

use condyle_math::{Quat, Vec3};
use condyle_mesh::Mesh;

/// Cells along each axis of a boundary that is drawn: 2.5 degrees each in the middle.
pub const CELLS: usize = 96;

/// The boundary of what a limit allows, in quaternion space: a rotation by θ about the unit vector u is at u·sin(θ/2), half turns
/// on the sphere of radius 1, where the surface is closed. Closed, facing outward; holes are bounded too.
///
/// `distance` is the signed distance to the boundary, positive inside, such as [`Field::distance`].
///
/// ```
/// use condyle::limits::boundary;
/// use condyle::math::Quat;
/// // A ball of 50 degrees about rest.
/// let reach = 50f64.to_radians();
/// let mesh = boundary(&|q: Quat| reach - q.angle_to(Quat::IDENTITY), 48);
/// let radius = (reach / 2.0).sin();
/// assert!(mesh.positions.iter().all(|p| (p.norm() - radius).abs() < 2e-4));
/// ```
#[must_use]
pub fn boundary(distance: &dyn Fn(Quat) -> f64, cells: usize) -> Mesh {
    let value = |p: Vec3| {
        let size = p.norm();
        if size >= 1.0 {
            return 1.0 - size;
        }
        let w = (1.0 - size * size).sqrt();
        distance(Quat { x: p.x, y: p.y, z: p.z, w }).min(1.0 - size)
    };
    // A little more than the sphere of half turns, so that nothing reaches the faces.
    Mesh::of_level(&value, 1.0 + 2.0 / cells.max(1) as f64, cells)
}
