//! Files under another name until they are whole.

use std::collections::HashSet;
use std::fs::{File, Metadata, OpenOptions, TryLockError};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A file beside the one it shall become, locked while it is written, and removed if it does not get there.
#[derive(Debug)]
pub(super) struct Temporary {
    file: File,
    path: PathBuf,
    renamed: bool,
}

/// How names begin and end; between are the number of the process and one drawn at random.
const NAME: (&str, &str) = (".condyle-", ".part");

/// How often a name is drawn.
const DRAWS: usize = 16;

impl Temporary {
    /// A new file in the folder of a place, with the mode and owner of the file that is there. Those that
    /// ended runs left in the folder are removed.
    pub(super) fn beside(place: &Path, existing: Option<&Metadata>) -> io::Result<Self> {
        let folder = folder_of(place);
        sweep(folder);
        for _ in 0..DRAWS {
            let (start, end) = NAME;
            let drawn = RandomState::new().hash_one(0);
            let path = folder.join(format!("{start}{}-{drawn:016x}{end}", std::process::id()));
            let file = match OpenOptions::new().read(true).write(true).create_new(true).open(&path)
            {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                opened => opened?,
            };
            // Between the two another run may have taken it for a left-over.
            let taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
            let made = Self { file, path, renamed: false };
            if taken || is_gone(&made.file) {
                continue;
            }
            if let Some(known) = existing {
                made.take_after(known)?;
            }
            return Ok(made);
        }
        Err(io::Error::other("no name for a temporary file is free"))
    }

    fn take_after(&self, known: &Metadata) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, fchown};
            let own = self.file.metadata()?;
            if (own.uid(), own.gid()) != (known.uid(), known.gid()) {
                // Only the superuser may give files away; to others the file then belongs.
                let _ = fchown(&self.file, Some(known.uid()), Some(known.gid()));
            }
        }
        self.file.set_permissions(known.permissions())
    }

    /// Puts the file in a place, whatever is there, in one step.
    pub(super) fn rename_to(mut self, place: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        std::fs::rename(&self.path, place)?;
        self.renamed = true;
        // The name is on the disk once the folder is; not every system opens folders.
        let _ = File::open(folder_of(place)).and_then(|folder| folder.sync_all());
        Ok(())
    }

    /// Overwrites the file that is in a place. What it grows by is written first: on a full disk the old
    /// content stays.
    pub(super) fn copy_to(mut self, place: &Path) -> io::Result<()> {
        let mut shared = OpenOptions::new().write(true).open(place)?;
        let (old, new) = (shared.metadata()?.len(), self.file.metadata()?.len());
        if new > old
            && let Err(error) = self.copy_from(old, u64::MAX, &mut shared)
        {
            shared.set_len(old)?;
            return Err(error);
        }
        self.copy_from(0, old, &mut shared)?;
        shared.set_len(new)?;
        shared.sync_all()
    }

    /// Copies at most so many bytes from a place on to the same place of another file, down to the disk.
    fn copy_from(&mut self, start: u64, most: u64, shared: &mut File) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(start))?;
        shared.seek(SeekFrom::Start(start))?;
        io::copy(&mut Read::take(&self.file, most), shared)?;
        shared.sync_all()
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// The folder of a file.
pub(super) fn folder_of(place: &Path) -> &Path {
    place.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether a file has no name any more.
#[cfg(unix)]
fn is_gone(file: &File) -> bool {
    file.metadata().is_ok_and(|known| super::destination::names(&known) == 0)
}

#[cfg(not(unix))]
fn is_gone(_: &File) -> bool {
    false
}

/// Removes what ended runs left in a folder, once for each folder.
fn sweep(folder: &Path) {
    static SWEPT: Mutex<Option<HashSet<PathBuf>>> = Mutex::new(None);
    let Ok(mut swept) = SWEPT.lock() else { return };
    if !swept.get_or_insert_default().insert(folder.to_owned()) {
        return;
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        if entry.file_name().to_str().is_some_and(is_ours)
            && entry.file_type().is_ok_and(|kind| kind.is_file())
        {
            remove_unlocked(&entry.path());
        }
    }
}

/// Whether a name is one that is given here.
fn is_ours(name: &str) -> bool {
    let middle = name.strip_prefix(NAME.0).and_then(|rest| rest.strip_suffix(NAME.1));
    middle.and_then(|middle| middle.split_once('-')).is_some_and(|(process, drawn)| {
        process.parse::<u32>().is_ok()
            && drawn.len() == 16
            && drawn.bytes().all(|b| b.is_ascii_hexdigit())
    })
}

/// Removes a file whose writer is gone: the system unlocks files of processes that end.
fn remove_unlocked(path: &Path) {
    let Ok(file) = OpenOptions::new().write(true).open(path) else { return };
    if file.try_lock().is_ok() {
        let _ = std::fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_own_names_of_gone_writers_are_removed() {
        let folder = std::env::temp_dir().join(format!("condyle-sweep-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let left = folder.join(".condyle-1-0123456789abcdef.part");
        let others = ["mine.part", ".condyle-x-0123456789abcdef.part", ".condyle-1-abc.part"];
        for name in others {
            std::fs::write(folder.join(name), "").unwrap();
        }
        std::fs::write(&left, "half").unwrap();
        let held = OpenOptions::new().write(true).open(&left).unwrap();
        held.lock().unwrap();
        let written = Temporary::beside(&folder.join("a.mot"), None).unwrap();
        assert!(left.exists(), "its writer is at work");
        drop(held);
        remove_unlocked(&left);
        remove_unlocked(&written.path);
        assert!(!left.exists() && written.path.exists());
        drop(written);
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), others.len());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
