//! Limits of a ball joint as a sum of spheres, after Herda, Urtasun, Fua & Hanson, *Automatic
//! Determination of Shoulder Joint Limits using Quaternion Field Boundaries*, IJRR 22(6), 2003.
//!
//! ```text
//! rotations -> points (qx, qy, qz)        chart       equation 1
//!           -> outer points of the cloud  surface     section 4.1
//!           -> spheres                    fitting     equations 5 to 7, section 4.3
//! rotation  -> possible if F ≥ 1          field       equation 5
//!           -> a possible one             projection  section 5.1
//!           -> swing polygon with twist   polygon     section 5.1
//! ```
//!
//! It is the baseline with which other limits are compared, and follows the paper to the letter. Where the
//! paper is silent or says two things, the file concerned says what is done, and both readings can be
//! chosen. What it cannot do is in `docs/learned-limits.md`: its field is 0 with no slope beyond 0.4 of the
//! spheres, it covers holes, it may build a shell that is hollow, and its points are no distances.

mod chart;
mod energy;
mod field;
mod fitting;
mod judged;
mod learned;
mod polygon;
mod projection;
mod split;
mod surface;

pub use chart::{Chart, Placement};
pub use energy::{ALPHA_2, Energy};
pub use field::{ISO, Primitive, SphereField, profile};
pub use fitting::{FitError, Fitting, Options, Removed, SphereLimit, Stage};
pub use judged::{Judged, judge};
pub use learned::LearnedSpheres;
pub use polygon::{PolygonError, SwingPolygon};
pub use projection::{Failure, project};
pub use split::{Split, principal_axis, split};
pub use surface::{Histogram, SolidAngles, centroid};
