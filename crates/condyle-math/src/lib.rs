//! Numbers in space: vectors, rotations, transforms and scalar functions over one [`Scalar`] trait.
//!
//! Every hot path of condyle is written once, generic over the number type: [`f64`] gives values,
//! [`Dual`] gives values with exact derivatives, and SIMD lanes (several characters at once) can be
//! added as another implementation without changing a formula. For that reason [`Scalar`] has no
//! comparison that returns a `bool`: selections use [`Scalar::select_less`], table look-ups
//! [`Scalar::chain`], and what branches runs lane by lane ([`Scalar::lane_by_lane`]).
//!
//! # Conventions
//!
//! Frames are right-handed; units are metres and radians. Vectors are columns:
//! `p_parent = T * p_child`. The name of a transform gives the frames it maps from and to:
//! `scapula_in_thorax` maps scapula coordinates to thorax coordinates. Quaternions are
//! `x, y, z, w`; `q` and `-q` are the same rotation. Euler orders are named by their body-fixed
//! axes in the order of the product: `zxy` = Rz·Rx·Ry.
//!
//! ```
//! use condyle_math::{Affine, Quat, Vec3};
//!
//! // Elbow flexion by a right angle about z moves the tip of the forearm from x to y.
//! let quarter = std::f64::consts::FRAC_PI_2;
//! let forearm_in_upper_arm =
//!     Affine::from_rotation(Quat::from_axis_angle(Vec3::Z, quarter).to_mat3());
//! let tip = forearm_in_upper_arm * Vec3::new(0.25, 0.0, 0.0);
//! assert!((tip - Vec3::new(0.0, 0.25, 0.0)).norm() < 1e-15);
//! ```

mod affine;
mod dual;
mod euler;
pub mod function;
mod growth;
mod mat3;
mod quat;
mod scalar;
mod sine;
mod swing_twist;
mod twist;
mod vec3;

pub use affine::Affine;
pub use dual::Dual;
pub use euler::{EulerOrder, UnknownOrder};
pub use growth::Growth;
pub use mat3::Mat3;
pub use quat::Quat;
pub use scalar::{Lane, Scalar};
pub use swing_twist::SwingTwist;
pub use twist::Twist;
pub use vec3::Vec3;
