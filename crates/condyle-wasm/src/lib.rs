//! The facade for a page in a browser.
//!
//! A [`Stage`] holds one model and its [`Actor`]s, poses of it whose numbers the page writes and reads in the
//! memory that it shares with WebAssembly. All else is asked in JSON ([`Stage::ask`]) and answered by an
//! [`Answer`]: a text, and numbers beside it. [`read`] takes the bytes of any file that the facade reads.
//!
//! Everything here is plain Rust that tests call; `border.rs` exports it, on WebAssembly alone.
//!
//! ```
//! use condyle_wasm::{Given, Stage, read};
//! let model = condyle::formats::exchange::write(&condyle::shipped::read("knee").unwrap().value.model);
//! let Ok(Given::Model(model, _)) = read(None, "knee.json", model.as_bytes()) else { panic!() };
//! let mut stage = Stage::new(*model);
//! stage.actors[0].asked[0] = 1.0;
//! assert!(stage.pose(0, true));
//! assert_eq!(stage.actors[0].effective[0], 1.0);
//! let answer = stage.ask(r#"{"ask": "describe"}"#).unwrap();
//! assert!(answer.text.contains("knee_angle_r"));
//! ```

mod answer;
mod bones;
#[cfg(all(target_arch = "wasm32", not(feature = "readers")))]
mod border;
mod checked;
#[cfg(feature = "readers")]
mod converted;
mod described;
mod dragged;
mod goals;
mod keyed;
mod network;
#[cfg(all(target_arch = "wasm32", feature = "readers"))]
mod readers;
mod reading;
mod saved;
mod shown;
mod signs;
mod stage;

pub use answer::{Answer, Fault};
pub use bones::{skins, surfaces};
#[cfg(feature = "readers")]
pub use converted::converted;
pub use reading::{Given, read};
pub use shown::Shown;
pub use stage::{Actor, Stage};
