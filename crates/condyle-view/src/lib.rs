//! The page on which a model stands, moves and explains itself.
//!
//! The page is built from `page/` and kept in `page/dist/`, so that nobody needs more than Rust to have it;
//! [`asset`] gives its files. What it shows is a [`Session`]: one JSON object with a model, motions and
//! recordings. The page evaluates the model itself, by the same code compiled to WebAssembly, so that it can
//! be served, be opened from a mail as one file ([`exported`]), or stand on any static web site.
//!
//! ```
//! use condyle_view::{Mode, Session, exported};
//! let session = Session::open("knee".as_ref(), &[], &[])?.value;
//! let html = exported(&session, false);
//! assert!(html.starts_with("<!doctype html>") && html.contains("knee"));
//! # Ok::<(), condyle::open::OpenError>(())
//! ```

mod base64;
mod bundle;
mod export;
#[cfg(feature = "server")]
pub mod server;
mod session;

pub use bundle::{Asset, PAGE, asset, assets};
pub use condyle_wasm::{Answer, Shown};
pub use export::exported;
pub use session::{Mode, Session, shown};
