//! What a character is, and how it is posed.
//!
//! A character is **segments**; the motion of each relative to its parent is the output of a
//! **joint set**: a small network of **components** that maps a few **coordinates** to transforms.
//! A hinge is a joint set with one component, a shoulder one with twenty; a knee read from a file
//! and a spine written by hand are made of the same pieces.
//!
//! ```text
//! Model --compile--> Program --evaluate(coordinates)--> Pose
//! (immutable,        (flat, sorted,                     (transforms of all segments,
//!  checked)           constants folded)                  small, one for each moment)
//! ```
//!
//! [`Model`] and [`Program`] never change while they are used and can be shared between threads; a
//! [`Pose`] is the caller's buffer. Evaluating is a pure function of the coordinates, allocates
//! nothing and remembers nothing of the frame before.
//!
//! ```
//! use condyle_math::{Vec3, function::Function};
//! use condyle_model::{Mode, ModelBuilder, Pose, Program};
//!
//! // A finger whose last joint turns by two thirds of the one before it.
//! let mut b = ModelBuilder::new("finger");
//! let middle = b.segment("middle_phalanx", None);
//! let distal = b.segment("distal_phalanx", Some(middle));
//! b.place_joint(distal, Vec3::new(0.025, 0.0, 0.0));
//! let (set, flexion) = b.hinge("pip", middle, "flexion", Vec3::Z);
//! let follow = b.map(set, "dip_follows", flexion, Function::linear(2.0 / 3.0, 0.0));
//! let turn = b.rotate(set, "dip", follow, Vec3::Z);
//! b.output(set, distal, turn);
//! let model = b.build().unwrap();
//!
//! let program = Program::compile(&model);
//! let mut pose = Pose::new(&program);
//! program.evaluate(&[0.9], Mode::Open, &mut pose).unwrap();
//! let tip = pose.segment(distal) * Vec3::new(0.02, 0.0, 0.0);
//! // The joint at 25 mm turned by 0.9, the tip 20 mm beyond it by 0.9 + 0.6.
//! let expected = 0.025 * 0.9f64.cos() + 0.020 * 1.5f64.cos();
//! assert!((tip.x - expected).abs() < 1e-15);
//! ```

pub mod component;
pub mod evaluate;
pub mod limit;
pub mod model;
mod position;

pub use component::{Component, Law, Signal};
pub use evaluate::{Jacobian, Mode, Pose, Program, SizeMismatch};
pub use limit::{Cone, ConeError, ConePoint, Legal, Projected, Projection, Range};
pub use model::{
    Closure, Coordinate, CoordinateId, CoordinateKind, Facing, JointSet, JointSetId, Marker, Model,
    ModelBuilder, PostureTerm, Segment, SegmentId, Shape, UpAxis,
};
