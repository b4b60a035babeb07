//! The command line of a bench: `--name VALUE` pairs.

use std::path::PathBuf;

/// The value after `--name`, if it is there.
pub fn value(name: &str) -> Option<String> {
    let mut arguments = std::env::args().skip_while(|argument| argument != name);
    arguments.next().and_then(|_| arguments.next())
}

/// The path after `--name`. Cargo runs benches in their own folder: a relative path is also tried
/// from the folder above.
pub fn path(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(value(name)?);
    let above = PathBuf::from("..").join(&path);
    Some(if path.exists() || !above.exists() { path } else { above })
}
