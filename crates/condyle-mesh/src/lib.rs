//! Surfaces of bones from landmarks and dimensions.
//!
//! A [`Form`] says with a few numbers what a bone looks like in the frame of its segment; [`Form::mesh`] makes
//! triangles of it. Forms are grown and mirrored by their numbers, so a surface scales with its body and needs
//! no file.
//!
//! ```
//! use condyle_math::Vec3;
//! use condyle_mesh::{Form, Tube, Station};
//!
//! // The shaft of a thigh bone: 0.4 m long, 14 mm of radius.
//! let ends = [Vec3::ZERO, Vec3::new(0.0, -0.4, 0.0)];
//! let stations = ends.map(|at| Station { at, radii: [0.014, 0.014] }).to_vec();
//! let shaft = Form::Tube(Tube { stations, across: Vec3::Z }).mesh();
//! let cylinder = std::f64::consts::PI * 0.014 * 0.014 * 0.4;
//! let caps = 4.0 / 3.0 * std::f64::consts::PI * 0.014_f64.powi(3);
//! assert!((shaft.volume() / (cylinder + caps) - 1.0).abs() < 0.1);
//! ```

mod ball;
mod block;
mod curve;
mod form;
mod level;
mod mesh;
mod patch;
mod plate;
mod rib;
mod spindle;
mod tube;

pub use ball::Ball;
pub use block::Block;
pub use form::{Finish, Form};
pub use mesh::Mesh;
pub use patch::Patch;
pub use plate::Plate;
pub use rib::Rib;
pub use spindle::Spindle;
pub use tube::{Station, Tube};
