//! Anatomical joints for people who pose bodies with a computer.
//!
//! A **model** turns a few **coordinates** (bend the knee by 40°) into the transform of every bone,
//! through **joint sets** made of small **components**. A **recording** of markers goes the other
//! way: [`tracking`] finds, for every frame, the coordinates whose posture comes nearest. This page is
//! a tour; each stop is a program that runs as a test.
//!
//! # Load a file
//!
//! [`open`] reads a file of any format by its ending or its content, and the name of a [`shipped`]
//! model does as well. Warnings come back as [`Diagnostic`]s beside the value; nothing is printed.
//!
//! ```
//! use condyle::open;
//! let read = open::model("human".as_ref())?;
//! assert!(read.warnings.is_empty());
//! let model = read.value;
//! let knee = model.find_coordinate("knee_angle_r")?;
//! assert!(model.coordinate(knee).range.upper.is_some());
//! // A name that is not there comes back with the nearest one.
//! let error = model.find_segment("femr_r").unwrap_err();
//! assert_eq!(error.to_string(), "unknown segment `femr_r` (did you mean `femur_r`?)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Pose it
//!
//! A [`Program`] is a model made ready for evaluation, a [`Pose`] the caller's buffer. Angles are
//! radians, lengths metres. A pose of a full body takes about a microsecond and allocates nothing.
//!
//! ```
//! use condyle::{Mode, ModelBuilder, Pose, Posture, Program, math::Vec3};
//!
//! let mut b = ModelBuilder::new("leg");
//! let thigh = b.segment("thigh", None);
//! let shank = b.segment("shank", Some(thigh));
//! b.place_joint(shank, Vec3::new(0.0, -0.42, 0.0));
//! let (_, flexion) = b.hinge("knee", shank, "flexion", -Vec3::Z);
//! let model = b.build()?;
//!
//! let program = Program::compile(&model);
//! let mut pose = Pose::new(&program);
//! let mut posture = Posture::of_defaults(&model);
//! posture.set(flexion, 40f64.to_radians());
//! program.evaluate(posture.stored(), Mode::Open, &mut pose)?;
//! let ankle = pose.segment(shank) * Vec3::new(0.0, -0.40, 0.0);
//! assert!((ankle.x + 0.40 * 40f64.to_radians().sin()).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In [`Mode::Posed`] limits hold what is asked for, so that a slider cannot break a figure; in
//! [`Mode::Open`] coordinates are taken as given, and a solver gets the limits as rows.
//!
//! # Its Jacobian
//!
//! Derivatives are exact, and come with the pose: how a point moves when each coordinate does.
//!
//! ```
//! use condyle::{Jacobian, Mode, Pose, Program, math::Vec3, open};
//! let model = open::model("knee".as_ref())?.value;
//! let program = Program::compile(&model);
//! let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
//! let tibia = model.find_segment("tibia_r")?;
//! program.evaluate_with_jacobian(&[1.0], &mut pose, &mut jacobian)?;
//! let shin = pose.segment(tibia) * Vec3::new(0.0, -0.2, 0.0);
//! let mut velocity = Vec3::ZERO;
//! jacobian.visit_point(&program, Some(tibia), shin, |_, per_radian| velocity = per_radian);
//! // Against a difference quotient over a millionth of a radian.
//! program.evaluate(&[1.0 + 1e-6], Mode::Open, &mut pose)?;
//! let moved = pose.segment(tibia) * Vec3::new(0.0, -0.2, 0.0);
//! assert!(((moved - shin) * 1e6 - velocity).norm() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Track a recording
//!
//! One call matches names, solves every frame and says how well it fits.
//!
//! ```
//! use condyle::tracking::{Request, track};
//! use condyle::{LengthUnit, ModelBuilder, Recording, math::Vec3};
//! # let mut b = ModelBuilder::new("leg");
//! # let shank = b.segment("shank", None);
//! # b.hinge("knee", shank, "flexion", -Vec3::Z);
//! # b.marker("ankle", Some(shank), Vec3::new(0.0, -0.40, 0.0));
//! # let model = b.build()?;
//! // A marker seen 20 cm behind and 35 cm below the knee, on a shank that ends at 40 cm.
//! let recording = Recording {
//!     labels: vec!["ankle".into()],
//!     rate: 100.0,
//!     times: vec![0.0],
//!     positions: vec![[-0.20, -0.35, 0.0].into()],
//!     units: LengthUnit::Metre,
//!     ..Recording::default()
//! };
//! let tracking = track(&model, &recording, &Request::default(), &mut |_, _| {})?;
//! let flexion = tracking.motion().frames[0][0];
//! assert!((flexion - f64::atan2(0.20, 0.35)).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Stream at 100 Hz
//!
//! A [`tracking::Live`] solves frames as they come, each from the one before, into the caller's buffer. It
//! owns its share of the model, so that both live in one struct, and allocates nothing from frame to
//! frame. `examples/streaming` is such a program, over the [`tracking::Stream`] below it, and runs in a
//! browser as well; `condyle bench MODEL TRIAL` measures the slowest frame of a recording.
//!
//! ```
//! use condyle::tracking::{Live, Request};
//! use condyle::{ModelBuilder, math::Vec3};
//! # let mut b = ModelBuilder::new("leg");
//! # let shank = b.segment("shank", None);
//! # b.hinge("knee", shank, "flexion", -Vec3::Z);
//! # b.marker("ankle", Some(shank), Vec3::new(0.0, -0.40, 0.0));
//! # let model = b.build()?;
//! let labels = ["ankle".to_owned()];
//! let mut live = Live::new(model, &labels, &Request::default())?;
//! let mut coordinates = [0.0];
//! for frame in 0..100 {
//!     let flexion = 0.5 * (f64::from(frame) * 0.05).sin();
//!     let seen = [-0.40 * flexion.sin(), -0.40 * flexion.cos(), 0.0];
//!     live.next(&[Some(seen)], &mut coordinates)?;
//!     assert!((coordinates[0] - flexion).abs() < 1e-5);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Many at once
//!
//! A program is shared between threads; each has a pose of its own.
//!
//! ```
//! use condyle::{Mode, Pose, Program, open};
//! use rayon::prelude::*;
//! let model = open::model("knee".as_ref())?.value;
//! let program = Program::compile(&model);
//! let tibia = model.find_segment("tibia_r")?;
//! let angles: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.002).collect();
//! let heights: Vec<f64> = angles
//!     .par_iter()
//!     .map_init(|| Pose::new(&program), |pose, &angle| {
//!         program.evaluate(&[angle], Mode::Open, pose).map(|()| pose.segment(tibia).translation.y)
//!     })
//!     .collect::<Result<_, _>>()?;
//! // The knee's centre rolls back and forth by millimetres, not by centimetres.
//! assert!(heights.iter().all(|y| (y - heights[0]).abs() < 0.04));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A law of your own
//!
//! A motion that no component describes is one generic function: posing, derivatives and tracking run
//! it. Registered by name, documents speak of it.
//!
//! ```
//! use condyle::formats::document;
//! use condyle::math::{Affine, Scalar, Vec3};
//! use condyle::model::component::{MotionLaw, Registry};
//! use condyle::{Mode, Pose, Program};
//!
//! /// A scapula that is lifted with the square of the arm's elevation.
//! #[derive(Debug)]
//! struct Lift(f64);
//! impl MotionLaw for Lift {
//!     fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
//!         let height = inputs[0] * inputs[0] * S::from_f64(self.0);
//!         Affine::from_translation(Vec3::new(S::zero(), height, S::zero()))
//!     }
//! }
//! let mut laws = Registry::default();
//! laws.register("lift", &["elevation"], |parameters| {
//!     let height = parameters.get("height").and_then(|list| list.first());
//!     Ok(Lift(*height.ok_or("it needs a `height` in metres")?))
//! });
//! let text = r#"
//! condyle = 1
//! kind = "model"
//! [segment.scapula]
//! [joint_set.girdle.coordinate.elevation]
//! [joint_set.girdle.component.raise.custom]
//! law = "lift"
//! inputs = ["elevation"]
//! parameters = { height = 0.02 }
//! [joint_set.girdle.output]
//! scapula = "raise"
//! "#;
//! let model = document::read_with(text, &mut |_| Err("alone".into()), &laws)?.value.model;
//! let program = Program::compile(&model);
//! let mut pose = Pose::new(&program);
//! program.evaluate(&[1.5], Mode::Open, &mut pose)?;
//! assert!((pose.segments()[0].translation.y - 0.02 * 2.25).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A document with limits
//!
//! Models are written by hand in TOML; everything that is wrong comes at once, with its line. A range
//! holds a coordinate, a `depend` holds one by another.
//!
//! ```
//! use condyle::formats::document;
//! use condyle::{Mode, Pose, Program};
//! let text = r#"
//! condyle = 1
//! kind = "model"
//! angles = "deg"
//!
//! [segment.thigh]
//! [segment.shank]
//! parent = "thigh"
//! at = [0, -0.42, 0]
//!
//! [joint.knee]
//! type = "hinge"
//! segment = "shank"
//! axis = [0, 0, -1]
//! coordinate.angle = { range = [0, 140] }
//! "#;
//! let model = document::read(text, &mut |_| Err("alone".into()))?.value.model;
//! let program = Program::compile(&model);
//! let mut pose = Pose::new(&program);
//! // Asked for 170°, the knee stops at 140° where limits hold.
//! program.evaluate(&[170f64.to_radians()], Mode::Posed, &mut pose)?;
//! assert!((pose.effective()[0] - 140f64.to_radians()).abs() < 1e-15);
//!
//! let wrong = text.replace("axis", "axsi");
//! let error = document::read(&wrong, &mut |_| Err("alone".into())).unwrap_err();
//! assert!(error.iter().any(|said| said.help == "did you mean `axis`?"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A model of one person
//!
//! [`scaling`] finds the lengths of a person from a recording in which that person stands still.
//!
//! ```
//! use condyle::scaling::{Assumptions, fit};
//! use condyle::{LengthUnit, Mode, Motion, Observed, Recording, open};
//! let model = open::model("knee".as_ref())?.value;
//! // Markers as a person would have them whose leg is a tenth longer in every direction.
//! let rest = Motion { times: vec![0.0], frames: vec![model.defaults()] };
//! let mut trial = rest.virtual_markers(&model, Mode::Open)?;
//! trial.positions.iter_mut().filter_map(Observed::position_mut).flatten().for_each(|x| *x *= 1.1);
//! let scaled = fit(&model, &trial, &Assumptions::default())?;
//! assert!((scaled.body.factor - 1.1).abs() < 0.03);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where things are
//!
//! | module | what |
//! | --- | --- |
//! | [`math`] | vectors, rotations, transforms, functions |
//! | [`model`] | models, their components, programs |
//! | [`motion`] | recordings, tables, motions, postures, differences |
//! | [`tracking`] | recordings to motions; streams; orientations of inertial sensors |
//! | [`scaling`] | a model as large as a person |
//! | [`legal`] | poses within all limits |
//! | [`limits`] | limits of joints learned from rotations |
//! | [`picture`], [`render`] | still pictures of models, and of any surfaces and lines |
//! | [`posing`] | the pose nearest to rest that meets goals |
//! | [`learning`] | limits of joints from recordings, and what they say |
//! | [`transferring`] | learned laws on the joints of other figures |
//! | [`check`] | findings about a model, or about a motion of it |
//! | [`formats`], [`open`], [`encode`] | bytes to values and back, by path or not |
//! | [`shipped`], [`scene`] | models that come along, animated scenes |
//! | [`authoring`] | model documents edited in their files |
//!
//! The last three rows are features: without them nothing that reads a file is compiled.

#[cfg(feature = "authoring")]
pub mod authoring;
pub mod constraining;
#[cfg(feature = "formats")]
pub mod encode;
mod figure;
pub mod geometry;
#[cfg(feature = "document")]
pub mod learning;
pub mod legal;
#[cfg(feature = "document")]
pub mod limits;
pub mod matching;
#[cfg(feature = "formats")]
pub mod open;
#[cfg(feature = "picture")]
pub mod picture;
#[cfg(feature = "document")]
pub mod posing;
#[cfg(feature = "document")]
pub mod retargeting;
pub mod scaling;
#[cfg(feature = "glb")]
pub mod scene;
#[cfg(feature = "formats")]
pub mod shipped;
#[cfg(feature = "opensim")]
pub mod subject;
pub mod tracking;
#[cfg(feature = "document")]
pub mod transferring;

pub use condyle_check as check;
pub use condyle_diagnostics::{Diagnostic, Error, Place, Read, Severity, Subject};
#[cfg(feature = "formats")]
pub use condyle_formats as formats;
pub use condyle_learn as learn;
pub use condyle_math as math;
pub use condyle_mesh as mesh;
pub use condyle_model::{
    self as model, Component, Coordinate, CoordinateId, CoordinateKind, Jacobian, Law, Mode, Model,
    ModelBuilder, Pose, Program, Range, SegmentId, Signal,
};
pub use condyle_motion::{
    self as motion, AngleUnit, Animation, Interpolation, Keys, LengthUnit, Motion, Observed,
    Posture, Recording, Table, Zeros, upkeep,
};
#[cfg(feature = "picture")]
pub use condyle_render as render;
pub use figure::{Figure, Part};

/// The README's examples, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;

/// The manual of editing, run as a test.
#[cfg(all(doctest, feature = "authoring"))]
#[doc = include_str!("../../../docs/authoring.md")]
pub struct AuthoringManual;
