//! Where bytes come from: files, standard input, pipes and devices.

use super::{Cause, OpenError, failed};
use condyle_diagnostics::Error;
use condyle_formats::Format;
use condyle_formats::skeleton::Assumed;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};

/// The largest file that is read, in bytes.
const LARGEST: u64 = 1 << 30;

/// Of what format standard input and other nameless input is.
static NAMELESS: OnceLock<&'static Format> = OnceLock::new();

/// Says of what format input without an ending is: standard input, which goes by the path `-`, pipes and
/// devices. The first call counts; without one the content tells.
pub fn nameless_is(format: &'static Format) {
    let _ = NAMELESS.set(format);
}

/// What is known of skeletons whose files do not state it.
static ASSUMED: OnceLock<Assumed> = OnceLock::new();

/// Says what is known of all skeletons whose files do not state it; what is not said is guessed. The first
/// call counts.
pub fn skeletons_are(assumed: Assumed) {
    let _ = ASSUMED.set(assumed);
}

/// What [`skeletons_are`] said of skeletons whose files do not state it.
pub fn assumed() -> Assumed {
    ASSUMED.get().copied().unwrap_or_default()
}

/// Which animation is read of files that hold several.
static WANTED: OnceLock<String> = OnceLock::new();

/// Says which animation is read of files that hold several: its name or its number, counted from 1; the
/// first without it. The first call counts.
pub fn animation_is(name: &str) {
    let _ = WANTED.set(name.to_owned());
}

/// What [`animation_is`] said.
#[cfg(any(feature = "glb", feature = "fbx"))]
pub(super) fn wanted_animation() -> Option<String> {
    WANTED.get().cloned()
}

/// The files that were read, once somebody asked for the list.
static LISTED: Mutex<Option<Vec<PathBuf>>> = Mutex::new(None);

/// The files that were read since the first call of this function, which answers with none: those that
/// were named and those that they name, such as the includes of a document or the tasks of a setup.
pub fn files_read() -> Vec<PathBuf> {
    LISTED.lock().map(|mut listed| listed.get_or_insert_default().clone()).unwrap_or_default()
}

/// Puts a file on the list of those that were read.
pub(super) fn list(path: &Path) {
    if let Ok(mut listed) = LISTED.lock()
        && let Some(files) = listed.as_mut()
        && !files.iter().any(|file| file == path)
    {
        files.push(path.to_owned());
    }
}

/// Whether a path is standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// The format of input without an ending, as far as [`nameless_is`] told.
pub(super) fn nameless_format(path: &Path) -> Option<&'static Format> {
    let format = *NAMELESS.get()?;
    let nameless = is_standard_input(path)
        || std::fs::metadata(path).is_ok_and(|known| !known.is_file() && !known.is_dir());
    nameless.then_some(format)
}

/// All bytes of a file, of standard input, or of what comes through a pipe.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, OpenError> {
    if is_standard_input(path) {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        if TAKEN.swap(true, Ordering::Relaxed) {
            let error = Error::new("file/standard-input", "standard input can be read only once")
                .with_help("give `-` for one input, and files for the others");
            return Err(failed(path, Cause::Content { error, text: None }));
        }
        return limited(path, std::io::stdin().lock(), 0, LARGEST);
    }
    let fail = |error| failed(path, Cause::Io(error));
    let file = File::open(path).map_err(fail)?;
    let size = file.metadata().map_err(fail)?.len();
    list(path);
    limited(path, file, size, LARGEST)
}

/// What a source gives, if it is not more than `most` bytes: those of pipes and devices are not known
/// before. `size` is what the system states.
fn limited(path: &Path, source: impl Read, size: u64, most: u64) -> Result<Vec<u8>, OpenError> {
    let too_large = |message: String| {
        let help = format!("at most {most} bytes are read");
        let error = Error::new("file/size", message).with_help(help);
        failed(path, Cause::Content { error, text: None })
    };
    if size > most {
        return Err(too_large(format!("the file has {size} bytes")));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    let read = source.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|error| failed(path, Cause::Io(error)))?;
    match bytes.len() as u64 > most {
        true => Err(too_large("it does not end".to_owned())),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_without_an_end_is_cut_off() {
        let path = Path::new("zeros");
        assert_eq!(limited(path, [1u8; 8].as_slice(), 0, 8).unwrap(), [1; 8]);
        let error = limited(path, std::io::repeat(0), 0, 8).unwrap_err().to_string();
        assert_eq!(error, "zeros: it does not end (at most 8 bytes are read)");
        let error = limited(path, std::io::empty(), 9, 8).unwrap_err().to_string();
        assert_eq!(error, "zeros: the file has 9 bytes (at most 8 bytes are read)");
    }
}
