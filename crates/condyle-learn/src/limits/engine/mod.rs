//! What game and robot engines can hold of a learned limit: the nearest cone with a range of twist, and the nearest reach cone.
//!
//! ```text
//! field -> samples inside and outside     region     even rotations with their signed distances
//!       -> two half-angles, twist, frame  cone_twist, fitting   by the law with which an engine tests them
//!       -> N directions with twists       reach      a spherical polygon, our own `Cone`
//!       -> none outside the field         inside     proved cell by cell
//! either -> what is lost                  loss       shares of all rotations and degrees
//! ```
//!
//! A rotation R of the child in its reference is seen in a frame of each, c = F_r⁻¹·R·F_c, both with x along the bone, and is
//! parted as c = swing·twist: first a turn τ about x, then the shortest swing. Engines bound the swing about y and z and τ;
//! the *law* says how two half-angles make a boundary ([`Law`]).
//!
//! Two aims: [`Aim::Closest`] makes false accepts and false rejects together least, as volumes of rotations by Haar's measure;
//! [`Aim::Inside`] allows no false accept and makes the rest as large as it can. Holes of the field are outside for both.

mod cone_twist;
mod fitting;
mod inside;
mod law;
mod loss;
mod reach;
mod region;

pub use cone_twist::ConeTwist;
pub use fitting::{Aim, EngineError, cone_twist};
pub use law::{Law, Parted};
pub use loss::{Loss, Lost};
pub use reach::{ReachCone, reach_cone};
pub use region::Region;
