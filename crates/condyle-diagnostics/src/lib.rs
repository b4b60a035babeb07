//! Everything that condyle says about a model, a file or a motion has one type: [`Diagnostic`].
//!
//! A diagnostic has a [`Severity`], a stable code for programs, the [`Subject`]s that it is about,
//! a message and a help for people, and the [`Place`] in a file where it has one. Warnings are values
//! that functions return ([`Read`]); an [`Error`] is one diagnostic or several. Nothing prints.
//!
//! ```
//! use condyle_diagnostics::{Diagnostic, Place, Severity, Subject};
//! let said = Diagnostic::warning("model/axis-length", "the axis has length 2")
//!     .about(Subject::Segment("tibia_r".into()))
//!     .at(Place::at(12, 3))
//!     .with_help("it is normalised");
//! assert_eq!(said.severity, Severity::Warning);
//! assert_eq!(said.to_string(), "line 12, column 3: the axis has length 2 (it is normalised)");
//! ```

mod diagnostic;
mod error;
mod nearest;
mod place;
mod read;
mod subject;
mod warnings;

pub use diagnostic::{Diagnostic, Severity, listed};
pub use error::Error;
pub use nearest::{did_you_mean, nearest};
pub use place::Place;
pub use read::Read;
pub use subject::Subject;
pub use warnings::Warnings;
