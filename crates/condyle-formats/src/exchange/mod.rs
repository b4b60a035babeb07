//! Resolved models in JSON, for programs that pose them by themselves.
//!
//! A file holds what is evaluated and nothing that has to be worked out first: no include, constant,
//! template or mirror, no short form of a joint, no unit but metres and radians. Structure, formulas and
//! conventions are in `docs/exchange.md`, from which alone an evaluator can be written.
//!
//! ```text
//! file        = { "condyle_model": 1, "name", "up", "facing", and the lists below }
//! segments    = { name, parent, joint_in_parent, joint_in_segment, joint_set, motion }
//! joint_sets  = name
//! coordinates = { path, joint_set, name, kind, unit, default, range, clamped, typical, locked, follows, … }
//! components  = { path, joint_set, name, kind, inputs by port, outputs, parameters }
//! order       = { values: what is computed, segments: parents first }
//! markers, closures, postures, sizes, shapes
//! signal      = { coordinate: path } | { component: path, output: number from 0 } | { segment: name }
//! frame       = three rows of four numbers, [R | t]
//! ```
//!
//! Numbers are written so that reading gives the same bits.

mod read;
mod write;

pub use read::{read, read_with};
pub use write::write;

/// The key that a file begins with; its value is the version.
const HEAD: &str = "condyle_model";

/// The version of the structure.
const VERSION: u64 = 1;

/// Whether bytes look like a resolved model rather than other JSON.
pub(crate) fn is_model(bytes: &[u8]) -> bool {
    let key = HEAD.as_bytes();
    let opens = bytes.iter().find(|byte| !byte.is_ascii_whitespace() && byte.is_ascii());
    opens == Some(&b'{') && bytes.windows(key.len() + 2).any(|w| is_quoted(w, key))
}

fn is_quoted(window: &[u8], key: &[u8]) -> bool {
    window.first() == Some(&b'"')
        && window.last() == Some(&b'"')
        && window.get(1..=key.len()) == Some(key)
}

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];
