//! What a path leads to.

use std::ffi::OsStr;
use std::fs::Metadata;
use std::io;
use std::path::{Path, PathBuf};

/// What is written to, with all links followed.
#[derive(Debug)]
pub(super) enum Destination {
    Standard,
    StandardError,
    /// Another open file of this process.
    Descriptor(PathBuf),
    /// A device or a pipe.
    Device(PathBuf),
    /// A file, which may not be there yet.
    File {
        place: PathBuf,
        existing: Option<Metadata>,
    },
}

/// How many links are followed, as many as Linux does.
const MOST_LINKS: usize = 40;

impl Destination {
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let mut place = path.to_owned();
        for _ in 0..=MOST_LINKS {
            match descriptor(&place) {
                Some(1) => return Ok(Self::Standard),
                Some(2) => return Ok(Self::StandardError),
                Some(_) => return Ok(Self::Descriptor(place)),
                None => {}
            }
            let known = match std::fs::symlink_metadata(&place) {
                Ok(known) => known,
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    return Ok(Self::File { place, existing: None });
                }
                Err(error) => return Err(error),
            };
            if known.is_symlink() {
                let target = std::fs::read_link(&place)?;
                place = place.parent().unwrap_or(Path::new("")).join(target);
            } else if known.is_dir() {
                return Err(io::Error::new(
                    io::ErrorKind::IsADirectory,
                    "this is a folder: name a file in it",
                ));
            } else if known.is_file() {
                return Ok(Self::File { place, existing: Some(known) });
            } else {
                return Ok(Self::Device(place));
            }
        }
        Err(io::Error::other("the links lead in a circle"))
    }
}

/// The number of an open file of this process that a path stands for.
fn descriptor(path: &Path) -> Option<u32> {
    let own = format!("/proc/{}/fd", std::process::id());
    let folders = ["/dev/fd", "/proc/self/fd", &own];
    let folder = path.parent()?;
    let in_one = folders.iter().any(|known| folder == Path::new(known));
    path.file_name().and_then(OsStr::to_str).filter(|_| in_one)?.parse().ok()
}

/// How many names a file has.
#[cfg(unix)]
pub(super) fn names(known: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(known)
}

/// How many names a file has; where the system does not tell, one.
#[cfg(not(unix))]
pub(super) fn names(_: &Metadata) -> u64 {
    1
}

/// Which file a path leads to, whatever its name.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Identity {
    /// Device and number.
    #[cfg(unix)]
    Node(u64, u64),
    /// The path without links.
    Place(PathBuf),
}

impl Identity {
    /// Of a file that is read, be it through standard input; `None` of what is no file.
    pub(super) fn of_input(path: &Path) -> Option<Self> {
        let standard = path == Path::new("-");
        let path = if standard { Path::new("/dev/stdin") } else { path };
        let known = std::fs::metadata(path).ok().filter(Metadata::is_file)?;
        Some(Self::of_known(path, Some(&known)))
    }

    /// Of a file that is written, which may not be there yet; `None` of what is no file.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let Destination::File { place, existing } = Destination::of(path).ok()? else {
            return None;
        };
        Some(Self::of_known(&place, existing.as_ref()))
    }

    fn of_known(place: &Path, known: Option<&Metadata>) -> Self {
        #[cfg(unix)]
        if let Some(known) = known {
            use std::os::unix::fs::MetadataExt;
            return Self::Node(known.dev(), known.ino());
        }
        #[cfg(not(unix))]
        let _ = known;
        let folder = std::fs::canonicalize(super::temporary::folder_of(place));
        let name = place.file_name().unwrap_or_default();
        Self::Place(folder.map_or_else(|_| place.to_owned(), |folder| folder.join(name)))
    }
}
