//! Anatomical joints for people who pose bodies with a computer.
//!
//! A **model** turns a few **coordinates** (bend the knee by 40°) into the transform of every bone,
//! through **joint sets** made of small **components**. A **recording** of markers goes the other
//! way: [`tracking`] finds, for every frame, the coordinates whose posture comes nearest.
//!
//! # From coordinates to bones
//!
//! ```
//! use condyle::{Mode, ModelBuilder, Pose, Program, math::Vec3};
//!
//! let mut b = ModelBuilder::new("leg");
//! let thigh = b.segment("thigh", None);
//! let shank = b.segment("shank", Some(thigh));
//! b.place_joint(shank, Vec3::new(0.0, -0.42, 0.0));
//! b.hinge("knee", shank, "flexion", -Vec3::Z);
//! let model = b.build().unwrap();
//!
//! let program = Program::compile(&model);
//! let mut pose = Pose::new(&program);
//! program.evaluate(&[40f64.to_radians()], Mode::Open, &mut pose).unwrap();
//! let ankle = pose.segment(shank) * Vec3::new(0.0, -0.40, 0.0);
//! assert!((ankle.x + 0.40 * 40f64.to_radians().sin()).abs() < 1e-15);
//! ```
//!
//! # From markers to coordinates
//!
//! ```
//! use condyle::tracking::{Request, track};
//! # use condyle::{LengthUnit, ModelBuilder, Recording, math::Vec3};
//! # let mut b = ModelBuilder::new("leg");
//! # let shank = b.segment("shank", None);
//! # b.hinge("knee", shank, "flexion", -Vec3::Z);
//! # b.marker("ankle", Some(shank), Vec3::new(0.0, -0.40, 0.0));
//! # let model = b.build().unwrap();
//! // A marker seen 20 cm behind and 35 cm below the knee, on a shank that ends at 40 cm.
//! let recording = Recording {
//!     labels: vec!["ankle".into()],
//!     rate: 100.0,
//!     times: vec![0.0],
//!     positions: vec![[-0.20, -0.35, 0.0].into()],
//!     units: LengthUnit::Metre,
//! };
//! let tracking = track(&model, &recording, &Request::default(), &mut |_, _| {}).unwrap();
//! let flexion = tracking.motion.frames[0][0];
//! assert!((flexion - f64::atan2(0.20, 0.35)).abs() < 1e-5);
//! ```
//!
//! Files are opened by [`open`], models that come along are in [`shipped`], motions are tied to a
//! model by [`motion`], animated scenes made by [`scene`]. The `condyle` command is these calls and a printer.

pub mod figure;
pub mod lint;
pub mod matching;
pub mod open;
pub mod scaling;
pub mod scene;
pub mod shipped;
pub mod tracking;

pub use condyle_diagnostics::{Diagnostic, Error, Place, Read, Severity, Subject};
pub use condyle_formats as formats;
pub use condyle_math as math;
pub use condyle_model::{
    self as model, Component, Coordinate, CoordinateId, CoordinateKind, Jacobian, Mode, Model,
    ModelBuilder, Pose, Program, Range, SegmentId, Source,
};
pub use condyle_motion::{
    self as motion, AngleUnit, LengthUnit, Motion, Observed, Posture, Recording, Table,
};

/// The README's examples, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;
