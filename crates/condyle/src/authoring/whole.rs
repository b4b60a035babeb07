//! A file that is written whole or not at all.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// How often a name is tried.
const DRAWS: u32 = 64;

/// Writes a file under another name beside it, then renames it; its mode stays, links are followed. A `new` one must
/// not be there yet.
pub(super) fn write(path: &Path, bytes: &[u8], new: bool) -> io::Result<()> {
    if new {
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        file.write_all(bytes)?;
        return file.sync_all();
    }
    let place = std::fs::canonicalize(path)?;
    let known = std::fs::metadata(&place)?;
    if known.permissions().readonly() {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
    }
    let (mut file, beside) = temporary(&place)?;
    let written = file
        .write_all(bytes)
        .and_then(|()| file.set_permissions(known.permissions()))
        .and_then(|()| file.sync_all())
        .and_then(|()| std::fs::rename(&beside, &place));
    if written.is_err() {
        // The first error is the one to tell.
        let _ = std::fs::remove_file(&beside);
    }
    written
}

fn temporary(place: &Path) -> io::Result<(File, PathBuf)> {
    let folder = place.parent().unwrap_or(Path::new("."));
    let mut last = None;
    for draw in 0..DRAWS {
        let name = format!(".condyle-{}-{draw}.part", std::process::id());
        let path = folder.join(name);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((file, path)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => last = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(last.unwrap_or_else(|| io::Error::other("no name was free")))
}
