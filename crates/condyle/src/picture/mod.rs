//! Still pictures of a model: what is shown of a pose, from where, and several of them in one picture.
//!
//! Each file here adds one kind of thing to a [`Scene`](condyle_render::Scene): it reads a posed figure
//! and never changes it, and what it cannot draw it leaves out.
//!
//! ```
//! use condyle::{open, picture};
//! let model = open::model("knee".as_ref())?.value;
//! let poses = vec![picture::Posed::new(vec![0.0]), picture::Posed::new(vec![1.2])];
//! let sheet = picture::Sheet { size: [320, 200], ..picture::Sheet::new(poses) };
//! let drawn = picture::draw(&model, &sheet)?;
//! assert_eq!((drawn.width(), drawn.height()), (320, 200));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axes;
mod bones;
mod contacts;
mod figure;
mod focus;
mod limits;
mod marks;
mod quaternions;
mod screw;
mod sheet;
mod show;
mod signs;
mod sweep;
mod view;

pub use focus::Focus;
pub use limits::Reaches;
pub use quaternions::Rotations;
pub use sheet::{Posed, Sheet, draw, draw_figure};
pub use show::Show;
pub use signs::{rotation, rotations, signs};
pub use view::View;
