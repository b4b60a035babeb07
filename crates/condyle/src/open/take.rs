//! The skeleton of a take: AMC files mean nothing without the ASF file that they belong to.

use super::{Cause, OpenError, ending, failed, source};
use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_formats::skeleton::Assumed;
use condyle_formats::{Content, asf};
use condyle_motion::Motion;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The skeleton of takes, once one is told or was opened.
static SKELETON: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Says which skeleton takes belong to that are opened from here on. Paths that do not end with `.asf` say
/// nothing, and the first that does counts; without one, the skeleton is the one that was opened as a model
/// before, else it is looked for beside the take.
pub fn skeleton_is(path: &Path) {
    if ending(path) == "asf"
        && let Ok(mut told) = SKELETON.lock()
    {
        told.get_or_insert_with(|| path.to_owned());
    }
}

/// The skeleton of a take, with how it was found where that is worth a word.
fn skeleton_of(take: &Path) -> Result<(PathBuf, Option<String>), Error> {
    let told = SKELETON.lock().ok().and_then(|told| told.clone());
    if let Some(path) = told {
        return Ok((path, None));
    }
    let folder = match take.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let beside = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut found: Vec<PathBuf> =
        beside.map(|entry| entry.path()).filter(|path| ending(path) == "asf").collect();
    found.sort();
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let own = stem(take);
    let subject = own.rsplit_once(['_', '-', '.']).map_or(own.as_str(), |(subject, _)| subject);
    for name in [own.as_str(), subject] {
        if let Some(path) = found.iter().find(|path| stem(path) == name) {
            let said = format!("its skeleton is {}, by the name of the subject", path.display());
            return Ok((path.clone(), Some(said)));
        }
    }
    match &found[..] {
        [only] => {
            let said =
                format!("its skeleton is taken to be {}, the only one beside it", only.display());
            Ok((only.clone(), Some(said)))
        }
        _ => {
            let count = found.len();
            let message = format!(
                "a take needs its skeleton: there is no {subject}.asf beside it, and {count} other .asf files"
            );
            let help = "give it with --skeleton, or as the model";
            Err(Error::new("amc/skeleton", message).with_help(help))
        }
    }
}

/// A take with its skeleton.
pub(super) fn take(
    path: &Path,
    bytes: &[u8],
    assumed: &Assumed,
) -> Result<Read<Content>, OpenError> {
    let wrong = |path: &Path, error| failed(path, Cause::Content { error, text: None });
    let (skeleton, how) = skeleton_of(path).map_err(|error| wrong(path, error))?;
    let own = source::bytes(&skeleton)?;
    // What is wrong in the skeleton is told with its own path.
    asf::read(&own, assumed).map_err(|error| wrong(&skeleton, error))?;
    let read = asf::with_skeleton(bytes, &own, assumed).map_err(|error| wrong(path, error))?;
    let mut read = read.map(|found| Content::Animation(Box::new(found)));
    if let Some(how) = how {
        read.warnings.insert(0, Diagnostic::note("amc/skeleton", how));
    }
    Ok(read)
}

/// A motion as a take of a skeleton, which is an `.asf`, or that of an `.amc`.
///
/// # Errors
/// `amc/skeleton` if the path is that of another format; what [`asf::write`] finds wrong.
pub fn written(path: &Path, motion: &Motion) -> Result<Read<Vec<u8>>, OpenError> {
    let wrong = |path: &Path, error| failed(path, Cause::Content { error, text: None });
    let skeleton = match ending(path).as_str() {
        "asf" => path.to_owned(),
        "amc" => skeleton_of(path).map_err(|error| wrong(path, error))?.0,
        _ => {
            let error = Error::new("amc/skeleton", "a take is of a skeleton, an .asf file");
            let help = "give it with --onto, which carries the motion over, or with --model if it is the motion's own";
            return Err(wrong(path, error.with_help(help)));
        }
    };
    let text = asf::write(motion, &source::bytes(&skeleton)?, &source::assumed());
    Ok(text.map_err(|error| wrong(&skeleton, error))?.map(String::into_bytes))
}
