//! Still pictures of surfaces, lines and labels, computed without a GPU or a display.
//!
//! A [`Scene`] is plain data; [`render`] draws it as a [`Camera`] sees it: triangles by their depth with
//! smooth light, the ground with its grid, lines, translucent surfaces from back to front, labels. Every
//! pixel is the mean of nine samples. The same scene gives the same bytes on every machine.
//!
//! ```
//! use condyle_render::{Bounds, Camera, Scene, Surface, palette, render, shape};
//!
//! let ball = shape::ball([0.0, 1.0, 0.0], 0.1, palette::BONE);
//! let bounds = Bounds::of(ball.positions.iter().copied()).unwrap();
//! let scene = Scene { surfaces: vec![ball], ..Scene::default() };
//! let front = Camera::looking([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.0, 0.0);
//! let picture = render(&scene, &front.framing(&bounds, 1.0, 0.1), 64, 64);
//! assert_eq!(picture.at(0, 0), Some(palette::BACKGROUND));
//! assert_ne!(picture.at(32, 32), Some(palette::BACKGROUND));
//! assert_eq!(&picture.png()[1..4], b"PNG");
//! ```

mod band;
mod camera;
mod canvas;
mod chart;
mod cloud;
mod ground;
mod label;
mod light;
pub mod palette;
mod picture;
mod scene;
pub mod shape;

pub use camera::{Bounds, Camera};
pub use canvas::{Canvas, TextSize};
pub use chart::{Chart, Drawn, Mark, Series};
pub use cloud::Cloud;
pub use picture::{Picture, render};
pub use scene::{Ground, Label, Line, Scene, Surface};
