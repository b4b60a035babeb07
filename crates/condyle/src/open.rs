//! Files by path, with errors and warnings that carry the path.

#[cfg(feature = "smpl")]
mod body;
mod parts;
mod source;
mod take;

use crate::shipped;
#[cfg(any(feature = "document", feature = "opensim"))]
use crate::tracking::Request;
#[cfg(feature = "document")]
use condyle_diagnostics::did_you_mean;
use condyle_diagnostics::{Diagnostic, Error, Read, nearest};
#[cfg(feature = "document")]
use condyle_formats::document::{
    self, goals::GoalList, landmarks::LandmarksDocument, law::LawDocument, names::NameTable,
};
#[cfg(feature = "glb")]
use condyle_formats::glb;
#[cfg(feature = "opensim")]
use condyle_formats::opensim::{
    self,
    scale_setup::ScaleSetup,
    setup::{IkSetup, IkTasks},
};
#[cfg(feature = "poses")]
use condyle_formats::poses::{Poses, Resolved};
use condyle_formats::skeleton::Assumed;
use condyle_formats::text::utf8;
use condyle_formats::{Content, ContentKind, FORMATS, Format, Id};
#[cfg(feature = "document")]
use condyle_learn::{frames::Recipe, limits::LearnedLimit};
use condyle_model::Model;
#[cfg(feature = "poses")]
use condyle_motion::Keys;
use condyle_motion::{AngleUnit, Animation, Motion, Recording, Table, Zeros};
pub(crate) use source::bytes;
use source::nameless_format;
use std::fmt;
use std::path::{Path, PathBuf};

#[cfg(feature = "smpl")]
pub use body::body_is;
pub use parts::{MotionParts, motion_parts};
pub use source::{
    animation_is, assumed, files_read, is_standard_input, nameless_is, skeletons_are,
};
pub use take::{skeleton_is, written as take_written};

/// A file that could not be used.
#[derive(Debug)]
pub struct OpenError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub cause: Cause,
}

/// Why a file could not be used.
#[derive(Debug)]
#[non_exhaustive]
pub enum Cause {
    /// The system would not give it.
    Io(std::io::Error),
    /// Its content is wrong, perhaps in several places.
    Content {
        /// What is wrong.
        error: Error,
        /// The text, of a document that people write.
        text: Option<String>,
    },
    /// Neither its ending nor its content is of a format that can hold what was wanted.
    Format {
        /// What was wanted; `None` for anything that can be read.
        wanted: Option<ContentKind>,
    },
    /// It is no file, and a word that might be the name of a shipped model, but none has it.
    Unknown,
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match &self.cause {
            Cause::Io(error) => {
                write!(f, "{path}: {error}")?;
                let name = self.path.to_str().and_then(|path| path.strip_suffix(".toml"));
                match name.filter(|name| shipped::text(name).is_some()) {
                    Some(name) => write!(f, " (`{name}` without an ending is a shipped model)"),
                    None => Ok(()),
                }
            }
            Cause::Content { error, .. } => {
                let lines: Vec<String> = error.iter().map(|e| located(&self.path, e)).collect();
                f.write_str(&lines.join("\n"))
            }
            Cause::Format { wanted } if is_standard_input(&self.path) => write!(
                f,
                "standard input: its content is not recognised as {}: name its format",
                wanted.map_or("that of any format", ContentKind::name)
            ),
            Cause::Format { wanted: Some(kind) } => write!(
                f,
                "{path}: the ending names no format for {} (known are {})",
                kind.name(),
                Format::endings_that_read(*kind)
            ),
            Cause::Format { wanted: None } => {
                let known = FORMATS.iter().filter(|format| !format.reads.is_empty());
                let known: Vec<String> =
                    known.flat_map(|format| format.endings).map(|e| format!(".{e}")).collect();
                write!(
                    f,
                    "{path}: the ending names no format that can be read (known are {})",
                    known.join(", ")
                )
            }
            Cause::Unknown => {
                let near = self.path.to_str().and_then(|name| nearest(name, shipped::names()));
                let help = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
                let names: Vec<&str> = shipped::names().collect();
                let names = names.join(", ");
                write!(
                    f,
                    "`{path}` is neither a file nor a shipped model ({help}shipped are {names})"
                )
            }
        }
    }
}

impl std::error::Error for OpenError {}

/// A diagnostic as compilers print it: `file:line:column: message (help)`.
pub fn located(path: &Path, said: &Diagnostic) -> String {
    let place = match said.place {
        Some(p) if p.line > 0 && p.column > 0 => format!(":{}:{}", p.line, p.column),
        Some(p) if p.line > 0 => format!(":{}", p.line),
        Some(p) => p.byte.map_or(String::new(), |byte| format!(": byte {byte}")),
        None => String::new(),
    };
    format!("{}{place}: {}", path.display(), said.sentence())
}

fn failed(path: &Path, cause: Cause) -> OpenError {
    OpenError { path: path.to_owned(), cause }
}

/// The ending of a path in lower case, without its dot.
pub fn ending(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Opens a file of any format as [`content_with`] does, zeros told by the rest of their recording.
///
/// # Errors
/// As [`content_with`].
pub fn content(path: &Path, wanted: Option<ContentKind>) -> Result<Read<Content>, OpenError> {
    content_with(path, wanted, Zeros::Told)
}

/// Opens a file of any format, by its ending or else by its content; `-` is standard input. Where there is
/// no such file, the name of a [`shipped`] model does. A setup comes with its tasks, if those have a file of their
/// own. `zeros` says what a marker at 0 0 0 is.
///
/// # Errors
/// [`OpenError`] with the path and everything that is wrong; [`Cause::Format`] if it is of no known
/// format, or cannot hold what is `wanted`.
pub fn content_with(
    path: &Path,
    wanted: Option<ContentKind>,
    zeros: Zeros,
) -> Result<Read<Content>, OpenError> {
    content_as(path, wanted, zeros, &source::assumed())
}

/// Opens a file as [`content_with`] does, with what is known of a skeleton whose file does not state it.
///
/// # Errors
/// As [`content_with`].
pub fn content_as(
    path: &Path,
    wanted: Option<ContentKind>,
    zeros: Zeros,
    assumed: &Assumed,
) -> Result<Read<Content>, OpenError> {
    content_within(path, wanted, zeros, assumed, None)
}

/// As [`content_as`], with the text of what a document may include as [`SKELETON`].
fn content_within(
    path: &Path,
    wanted: Option<ContentKind>,
    zeros: Zeros,
    assumed: &Assumed,
    skeleton: Option<&str>,
) -> Result<Read<Content>, OpenError> {
    #[cfg(feature = "document")]
    if wanted.is_none_or(|kind| kind == ContentKind::Model)
        && !is_standard_input(path)
        && let Some(name) = shipped::asked_for(path)
    {
        return Ok(shipped::read(name)?.map(Content::Document));
    }
    let no_format = || failed(path, Cause::Format { wanted });
    let fits = |format: &&Format| wanted.is_none_or(|kind| format.reads.contains(&kind));
    let named = Format::of_ending(&ending(path)).or_else(|| nameless_format(path));
    if named.is_some_and(|format| !fits(&format)) {
        return Err(no_format());
    }
    // A path without a known ending may still be a file that is recognised.
    let bytes = match (bytes(path), named) {
        (Ok(bytes), _) => bytes,
        (Err(_), None) if !path.exists() && !is_standard_input(path) => return Err(no_format()),
        (Err(error), _) => return Err(error),
    };
    let found = named.or_else(|| Format::of_bytes(&bytes).filter(fits));
    let format = found.ok_or_else(no_format)?;
    let mut include = |name: &str| match skeleton {
        Some(text) if name == SKELETON => Ok(text.to_owned()),
        _ => included(path, name),
    };
    let read = match format.id {
        #[cfg(feature = "smpl")]
        Id::Smpl => {
            let read = named_after(path, body::opened(path, &bytes, assumed)?);
            return fitting(path, wanted, read);
        }
        Id::Amc => return take::take(path, &bytes, assumed).map(|read| named_after(path, read)),
        #[cfg(feature = "glb")]
        Id::Glb | Id::Gltf => scene_of(path, &bytes, assumed),
        #[cfg(feature = "fbx")]
        Id::Fbx => {
            let options = glb::Options { animation: source::wanted_animation(), assumed: *assumed };
            let read = condyle_formats::fbx::read(&bytes, &options);
            read.map(|read| read.map(|found| Content::Animation(Box::new(found))))
        }
        _ => format.read_with(&bytes, &mut include, assumed),
    };
    let read = read.map_err(|error| {
        // Only the text of a document is shown beside its errors.
        let document = format.id == Id::Document;
        let text = document.then(|| utf8(&bytes).ok().map(str::to_owned)).flatten();
        failed(path, Cause::Content { error, text })
    })?;
    #[cfg(feature = "opensim")]
    let mut read = with_tasks(path, read)?;
    #[cfg(not(feature = "opensim"))]
    let mut read = read;
    match &mut read.value {
        Content::Recording(recording) => read.warnings.extend(recording.settle_zeros(zeros)),
        Content::Trial(trial) => read.warnings.extend(trial.recording.settle_zeros(zeros)),
        _ => {}
    }
    if format.id == Id::Asf {
        skeleton_is(path);
    }
    fitting(path, wanted, named_after(path, read))
}

/// What was read, if it is what was wanted.
fn fitting(
    path: &Path,
    wanted: Option<ContentKind>,
    read: Read<Content>,
) -> Result<Read<Content>, OpenError> {
    match wanted {
        Some(kind) if !read.value.holds(kind) => {
            let message =
                format!("the file holds {}, not {}", read.value.kind().name(), kind.name());
            let error = Error::new("file/content", message);
            Err(failed(path, Cause::Content { error, text: None }))
        }
        _ => Ok(read),
    }
}

/// A skeleton without a name of its own is called after its file.
fn named_after(path: &Path, mut read: Read<Content>) -> Read<Content> {
    let model = match &mut read.value {
        Content::Animation(animation) => &mut animation.model,
        Content::Model(model) => model,
        _ => return read,
    };
    if model.name().is_empty() {
        model.set_name(&path.file_stem().unwrap_or_default().to_string_lossy());
    }
    read
}

/// The skeleton of a glTF file, whose buffers may be files beside it.
#[cfg(feature = "glb")]
fn scene_of(path: &Path, bytes: &[u8], assumed: &Assumed) -> Result<Read<Content>, Error> {
    let options = glb::Options { animation: source::wanted_animation(), assumed: *assumed };
    let read = glb::read(bytes, &options, &mut |name| buffer(path, name))?;
    Ok(read.map(|found| Content::Animation(Box::new(found))))
}

/// The bytes of a file that a glTF file names.
#[cfg(feature = "glb")]
fn buffer(path: &Path, name: &str) -> Result<Vec<u8>, String> {
    source::bytes(&beside(path, name)).map_err(|error| match error.cause {
        Cause::Io(error) => error.to_string(),
        _ => error.to_string(),
    })
}

/// Opens a figure that is to get a motion, as [`animation`] does; of what [`animation_is`] said nothing counts, since that is about
/// the motion.
///
/// # Errors
/// As [`content`].
pub fn figure(path: &Path) -> Result<Read<Animation>, OpenError> {
    #[cfg(feature = "glb")]
    if is_gltf(path) {
        let bytes = bytes(path)?;
        let options = glb::Options { animation: None, assumed: source::assumed() };
        let read = glb::read(&bytes, &options, &mut |name| buffer(path, name));
        let mut read = read.map_err(|error| failed(path, Cause::Content { error, text: None }))?;
        read.warnings.retain(|said| said.code != "glb/animations");
        return Ok(read);
    }
    animation(path)
}

/// The surfaces of a file of glTF, carried by the segments of the model that [`animation`] opens from it.
#[cfg(feature = "glb")]
pub(crate) fn surfaces(path: &Path) -> Result<Read<Vec<glb::Cover>>, OpenError> {
    let bytes = bytes(path)?;
    let options =
        glb::Options { animation: source::wanted_animation(), assumed: source::assumed() };
    let read = glb::covers(&bytes, &options, &mut |name| buffer(path, name));
    read.map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// Whether a path names a file of glTF.
#[cfg(feature = "glb")]
pub fn is_gltf(path: &Path) -> bool {
    Format::of_ending(&ending(path)).is_some_and(|f| matches!(f.id, Id::Glb | Id::Gltf))
}

/// The bytes of a character of glTF with another animation: a motion of the model that [`figure`] opens from it. All else stays as
/// it is ([`glb::reanimate`]). What is `driven` moves morphs of that name.
///
/// # Errors
/// As [`content`]; what [`glb::node_motion`] and [`glb::reanimate`] find wrong.
#[cfg(feature = "glb")]
pub fn reanimated(
    path: &Path,
    motion: &Motion,
    driven: Vec<glb::Driven>,
    name: &str,
) -> Result<Read<Vec<u8>>, OpenError> {
    let bytes = bytes(path)?;
    let options = glb::Options { animation: None, assumed: source::assumed() };
    let tracks = glb::node_motion(&bytes, &options, &mut |name| buffer(path, name), motion);
    let file = tracks.and_then(|tracks| {
        let named = glb::NodeMotion { name: name.to_owned(), driven, ..tracks };
        glb::reanimate(&bytes, &named, glb::Old::Replaced)
    });
    file.map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// A setup with the tasks that have a file of their own.
#[cfg(feature = "opensim")]
fn with_tasks(path: &Path, mut read: Read<Content>) -> Result<Read<Content>, OpenError> {
    if let Content::Setup(setup) = &mut read.value
        && let IkTasks::File(name) = &setup.tasks
    {
        let tasks = content(&beside(path, name), Some(ContentKind::Setup))?;
        if let Content::Tasks(set) = tasks.value {
            read.warnings.extend(tasks.warnings);
            setup.tasks = IkTasks::Inline(set);
        }
    }
    Ok(read)
}

/// The text that a file includes: another file, from its own place, or else a shipped model by its
/// name or a part of one.
pub(crate) fn included(from: &Path, name: &str) -> Result<String, String> {
    let path = beside(from, name);
    #[cfg(feature = "document")]
    if !path.exists()
        && let Some(text) = shipped::includable(name)
    {
        return Ok(text.to_owned());
    }
    // A document may include a skeleton of another format, as the text that says the same.
    #[cfg(feature = "document")]
    if Format::of_ending(&ending(from)).is_none_or(|f| f.id == Id::Document)
        && Format::of_ending(&ending(&path))
            .is_some_and(|f| f.id != Id::Document && f.reads.contains(&ContentKind::Model))
    {
        let model = model(&path).map_err(|error| error.to_string())?.value;
        return Ok(condyle_formats::document::write(&model));
    }
    let bytes = bytes(&path).map_err(|error| match error.cause {
        Cause::Io(error) => {
            #[cfg(feature = "document")]
            if let Some(near) = nearest(name, shipped::names()) {
                return format!(
                    "{error}; the shipped model `{near}` is included by its name alone"
                );
            }
            error.to_string()
        }
        _ => error.to_string(),
    })?;
    utf8(&bytes).map(str::to_owned).map_err(|error| error.to_string())
}

/// What is picked from the content of a file that can hold it.
fn only<T>(
    path: &Path,
    kind: ContentKind,
    zeros: Zeros,
    pick: impl FnOnce(Content) -> Option<T>,
) -> Result<Read<T>, OpenError> {
    let Read { value, warnings } = content_with(path, Some(kind), zeros)?;
    let value = pick(value).ok_or_else(|| failed(path, Cause::Format { wanted: Some(kind) }))?;
    Ok(Read { value, warnings })
}

/// Opens a model of any format, as [`content`] does.
///
/// # Errors
/// As [`content`].
pub fn model(path: &Path) -> Result<Read<Model>, OpenError> {
    only(path, ContentKind::Model, Zeros::Told, |content| match content {
        Content::Model(model) => Some(model),
        #[cfg(feature = "document")]
        Content::Document(document) => Some(document.model),
        Content::Animation(animation) => Some(animation.model),
        _ => None,
    })
}

/// What a document includes to get the skeleton of whatever motion it is used with: such a document puts limits on
/// the joints of foreign skeletons.
pub const SKELETON: &str = "skeleton";

/// Whether a file is a document that includes [`SKELETON`].
#[cfg(feature = "document")]
pub fn is_binding(path: &Path) -> bool {
    let document = Format::of_ending(&ending(path)).is_some_and(|f| f.id == Id::Document);
    let text = if document { bytes(path).ok() } else { None };
    text.and_then(|text| utf8(&text).ok().map(condyle_formats::document::includes))
        .is_some_and(|all| all.iter().any(|(_, name)| name == SKELETON))
}

/// Opens a document that includes [`SKELETON`] with a skeleton.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn bound(path: &Path, skeleton: &Model) -> Result<Read<Model>, OpenError> {
    let text = condyle_formats::document::write(skeleton);
    let wanted = Some(ContentKind::Model);
    let read = content_within(path, wanted, Zeros::Told, &source::assumed(), Some(text.as_str()))?;
    let Content::Document(document) = read.value else {
        return Err(failed(path, Cause::Format { wanted }));
    };
    let model = document.model;
    // A coordinate that the skeleton does not have moves nothing: its joint is misspelled.
    let set =
        |model: &Model, id| model.joint_sets()[model.coordinate(id).joint_set.index()].name.clone();
    let named = |model: &Model, id| format!("{}.{}", set(model, id), model.coordinate(id).name);
    let known: Vec<String> = skeleton.coordinate_ids().map(|id| named(skeleton, id)).collect();
    let new = model.coordinate_ids().map(|id| named(&model, id)).find(|own| !known.contains(own));
    if let Some(own) = new {
        let message = format!("the skeleton has no coordinate `{own}`");
        let help = did_you_mean(&own, known.iter().map(String::as_str), || {
            "`condyle info` lists them".to_owned()
        });
        let error = Error::new("binding/coordinate", message).with_help(help);
        return Err(failed(path, Cause::Content { error, text: None }));
    }
    Ok(Read { value: model, warnings: read.warnings })
}

/// The bytes of a BVH file with another motion of its skeleton, all else to the letter.
///
/// # Errors
/// As [`content`].
pub fn bvh_with(path: &Path, motion: &Motion) -> Result<Vec<u8>, OpenError> {
    let bytes = bytes(path)?;
    let text = condyle_formats::bvh::with_motion(&bytes, &source::assumed(), motion);
    text.map(String::into_bytes).map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// Opens a model as [`model`] does, with the motion that its file holds; without frames if it holds none.
///
/// # Errors
/// As [`content`].
pub fn animation(path: &Path) -> Result<Read<Animation>, OpenError> {
    only(path, ContentKind::Model, Zeros::Told, |content| match content {
        Content::Animation(animation) => Some(*animation),
        Content::Model(model) => Some(Animation { model, motion: Motion::default() }),
        #[cfg(feature = "document")]
        Content::Document(document) => {
            Some(Animation { model: document.model, motion: Motion::default() })
        }
        _ => None,
    })
}

/// Opens a marker recording of any format as [`recording_with`] does, zeros told by the rest of it.
///
/// # Errors
/// As [`recording_with`].
pub fn recording(path: &Path) -> Result<Read<Recording>, OpenError> {
    recording_with(path, Zeros::Told)
}

/// Opens a marker recording of any format, as [`content`] does; of a table over time its markers, which have
/// three columns each. `zeros` says what a marker at 0 0 0 is.
///
/// # Errors
/// As [`content`]; tables without markers.
pub fn recording_with(path: &Path, zeros: Zeros) -> Result<Read<Recording>, OpenError> {
    let table_format = Format::of_ending(&ending(path)).or_else(|| nameless_format(path));
    let mut read = if let Some(recording) = parts::recording(path) {
        Read::clean(recording)
    } else if table_format.is_some_and(|f| matches!(f.id, Id::Mot | Id::Sto | Id::Csv)) {
        let Read { value, warnings } = content_with(path, None, zeros)?;
        let markers = match value {
            // Keypoints say what they are.
            Content::Recording(value) => return Ok(Read { value, warnings }),
            Content::Table(table) => Recording::from_table(&table),
            _ => return Err(failed(path, Cause::Format { wanted: Some(ContentKind::Recording) })),
        };
        let markers =
            markers.map_err(|error| failed(path, Cause::Content { error, text: None }))?;
        // What a cell of three numbers is called has no meaning here.
        let warnings = warnings.into_iter().filter(|said| said.code != "sto/vector-cells");
        Read { value: markers.value, warnings: warnings.chain(markers.warnings).collect() }
    } else {
        return only(path, ContentKind::Recording, zeros, |content| match content {
            Content::Recording(recording) => Some(recording),
            Content::Trial(trial) => Some(trial.recording),
            _ => None,
        });
    };
    read.warnings.extend(read.value.settle_zeros(zeros));
    Ok(read)
}

/// Opens a table over time of any format, such as a motion, as [`content`] does.
///
/// # Errors
/// As [`content`].
pub fn table(path: &Path) -> Result<Read<Table>, OpenError> {
    only(path, ContentKind::Motion, Zeros::Told, |content| match content {
        Content::Table(table) => Some(table),
        Content::Animation(found) => Some(found.motion.to_table(&found.model, found.model.name())),
        _ => None,
    })
}

/// Opens a setup of inverse kinematics, as [`content`] does.
///
/// # Errors
/// As [`content`]; `setup/no-tool` for tasks alone.
#[cfg(feature = "opensim")]
pub fn setup(path: &Path) -> Result<Read<IkSetup>, OpenError> {
    let Read { value, warnings } = content(path, Some(ContentKind::Setup))?;
    if let Content::Setup(value) = value {
        return Ok(Read { value, warnings });
    }
    let error = Error::new("setup/no-tool", "the file holds no setup of OpenSim's tool")
        .with_help("read tasks alone, and setups that people write, as a request");
    Err(failed(path, Cause::Content { error, text: None }))
}

/// Opens a setup of OpenSim's scaling, with the sets that it keeps in files of their own.
///
/// # Errors
/// [`OpenError`] where the file cannot be had, or is no such setup.
#[cfg(feature = "opensim")]
pub fn scale_setup(path: &Path) -> Result<Read<ScaleSetup>, OpenError> {
    let bytes = bytes(path)?;
    let read = opensim::scale_setup::read(&bytes, &mut |name| included(path, name));
    read.map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// The text of a model file of OpenSim with all its sets inside, to be scaled.
///
/// # Errors
/// [`OpenError`] where the file cannot be had, is no XML, or names a set that cannot be had.
#[cfg(feature = "opensim")]
pub fn osim_text(path: &Path) -> Result<Read<String>, OpenError> {
    let bytes = bytes(path)?;
    let read = opensim::scale::whole(&bytes, &mut |name| included(path, name));
    read.map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// The text of a model file with the markers of another file put in.
///
/// # Errors
/// [`OpenError`] where the file of the markers cannot be had, or its markers do not fit the model.
#[cfg(feature = "opensim")]
pub fn osim_with_markers(text: &str, path: &Path) -> Result<Read<String>, OpenError> {
    let read = opensim::scale::with_marker_set(text, &bytes(path)?);
    read.map_err(|error| failed(path, Cause::Content { error, text: None }))
}

/// What a setup of tracking asks for, of OpenSim or written by people, with the files that it names;
/// tasks of OpenSim may stand alone.
///
/// # Errors
/// As [`content`], of the setup and of the files that it names.
#[cfg(any(feature = "document", feature = "opensim"))]
pub fn request(path: &Path) -> Result<Read<Request>, OpenError> {
    let Read { value, mut warnings } = content(path, Some(ContentKind::Setup))?;
    let mut request = match &value {
        #[cfg(feature = "opensim")]
        Content::Setup(setup) => Request::from_setup(setup),
        #[cfg(feature = "opensim")]
        Content::Tasks(tasks) => Request::from_tasks(tasks),
        #[cfg(feature = "document")]
        Content::TrackSetup(setup) => Request::from_document(setup),
        _ => return Err(failed(path, Cause::Format { wanted: Some(ContentKind::Setup) })),
    };
    #[cfg(feature = "opensim")]
    if let Content::Setup(setup) = &value
        && let Some(name) = &setup.coordinate_file
        && request.wants_values()
    {
        let path = beside(path, name);
        let read = table(&path)?;
        warnings.extend(read.warnings.into_iter().map(|said| of_file(&path, said)));
        request.coordinate_values = Some(read.value);
    }
    #[cfg(feature = "document")]
    if let Content::TrackSetup(setup) = &value
        && let Some(name) = &setup.names
    {
        let path = match shipped::name_table(name) {
            Some(_) => PathBuf::from(name),
            None => beside(path, name),
        };
        let read = names(&path)?;
        warnings.extend(read.warnings.into_iter().map(|said| of_file(&path, said)));
        request.names = read.value;
    }
    Ok(Read { value: request, warnings })
}

/// A warning about a file that another names.
#[cfg(any(feature = "document", feature = "opensim"))]
fn of_file(path: &Path, said: Diagnostic) -> Diagnostic {
    Diagnostic::new(said.severity, said.code, located(path, &said))
}

/// Opens a table of names; where there is no such file, that of a [`shipped`] one.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn names(path: &Path) -> Result<Read<NameTable>, OpenError> {
    if let Some(text) = path.to_str().filter(|_| !path.is_file()).and_then(shipped::name_table) {
        let read = document::names::read(text, &mut |_| Err("it stands alone".to_owned()));
        return read
            .map_err(|error| failed(path, Cause::Content { error, text: Some(text.to_owned()) }));
    }
    let word = path.to_str().filter(|word| !word.contains(['.', '/', '\\']) && !path.exists());
    let word = word.filter(|_| !is_standard_input(path));
    if let Some(word) = word {
        let shipped: Vec<&str> = shipped::name_tables().collect();
        let message = format!("`{word}` is neither a file nor a shipped table of names");
        let all = || format!("shipped are: {}", shipped.join(", "));
        let help = did_you_mean(word, shipped.iter().copied(), all);
        let error = Error::new("file/names", message).with_help(help);
        return Err(failed(path, Cause::Content { error, text: None }));
    }
    only(path, ContentKind::Names, Zeros::Told, |content| match content {
        Content::Names(table) => Some(table),
        _ => None,
    })
}

/// A motion of a model as [`motion_with`] reads it, the unit of its angles not told.
///
/// # Errors
/// As [`motion_with`].
pub fn motion(path: &Path, model: &Model) -> Result<Read<Motion>, OpenError> {
    motion_with(path, model, None)
}

/// A motion of a model, from a table whose columns are named after its coordinates. Its angles are in the
/// unit that is told, else in that which the file states; without both, it is guessed by their size
/// ([`Table::settle_angles`]), with a warning.
///
/// # Errors
/// As [`content`]; an equal name of two columns of a coordinate; a unit that is not stated and cannot be told.
pub fn motion_with(
    path: &Path,
    model: &Model,
    angles: Option<AngleUnit>,
) -> Result<Read<Motion>, OpenError> {
    let mut table = table(path)?;
    let said = settled(model, &mut table.value, angles);
    table
        .warnings
        .extend(said.map_err(|error| failed(path, Cause::Content { error, text: None }))?);
    let (value, warnings) = Motion::from_table(model, &table.value);
    Ok(Read { value, warnings: [table.warnings, warnings].concat() })
}

/// Makes a table that of a motion of a model: the unit of its angles is decided, and no coordinate has two
/// columns.
///
/// # Errors
/// Those of [`Table::settle_angles`]; `motion/duplicate` where two columns have the name of a coordinate.
pub fn settled(
    model: &Model,
    table: &mut Table,
    angles: Option<AngleUnit>,
) -> Result<Vec<Diagnostic>, Error> {
    condyle_motion::columns::check_single(model, table)?;
    table.settle_angles(Some(model), angles)
}

/// Opens a recipe; where there is no such file, a [`shipped`] one.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn recipe(path: &Path) -> Result<Read<Recipe>, OpenError> {
    if let Some(text) = path.to_str().filter(|_| !path.is_file()).and_then(shipped::recipe) {
        let read = document::recipe::read(text, &mut |_| Err("it stands alone".to_owned()));
        return read
            .map_err(|error| failed(path, Cause::Content { error, text: Some(text.to_owned()) }));
    }
    let word = path.to_str().filter(|word| !word.contains(['.', '/', '\\']) && !path.exists());
    if let Some(word) = word.filter(|_| !is_standard_input(path)) {
        let shipped: Vec<&str> = shipped::recipes().collect();
        let message = format!("`{word}` is neither a file nor a shipped recipe");
        let all = || format!("shipped are: {}", shipped.join(", "));
        let help = did_you_mean(word, shipped.iter().copied(), all);
        let error = Error::new("file/recipe", message).with_help(help);
        return Err(failed(path, Cause::Content { error, text: None }));
    }
    only(path, ContentKind::Recipe, Zeros::Told, |content| match content {
        Content::Recipe(recipe) => Some(recipe),
        _ => None,
    })
}

/// Opens what a pose should do.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn goals(path: &Path) -> Result<Read<GoalList>, OpenError> {
    only(path, ContentKind::Goals, Zeros::Told, |content| match content {
        Content::Goals(list) => Some(list),
        _ => None,
    })
}

/// Opens a learned limit.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn limit(path: &Path) -> Result<Read<LearnedLimit>, OpenError> {
    only(path, ContentKind::Limit, Zeros::Told, |content| match content {
        Content::Limit(limit) => Some(*limit),
        _ => None,
    })
}

/// Opens laws of coordinates.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn law(path: &Path) -> Result<Read<LawDocument>, OpenError> {
    only(path, ContentKind::Law, Zeros::Told, |content| match content {
        Content::Law(law) => Some(*law),
        _ => None,
    })
}

/// Opens where a law is carried to.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn landmarks(path: &Path) -> Result<Read<LandmarksDocument>, OpenError> {
    only(path, ContentKind::Landmarks, Zeros::Told, |content| match content {
        Content::Landmarks(landmarks) => Some(*landmarks),
        _ => None,
    })
}

/// Opens a learned limit of any method.
///
/// # Errors
/// As [`content`].
#[cfg(feature = "document")]
pub fn any_limit(path: &Path) -> Result<Read<crate::learning::Limit>, OpenError> {
    only(path, ContentKind::Limit, Zeros::Told, |content| match content {
        Content::Limit(limit) => Some(crate::learning::Limit::Field(limit)),
        Content::Spheres(spheres) => Some(crate::learning::Limit::Spheres(spheres)),
        _ => None,
    })
}

/// Poses of a model, in JSON.
///
/// # Errors
/// As [`content`]; names that the model does not have.
#[cfg(feature = "poses")]
pub fn poses(path: &Path, model: &Model) -> Result<Read<Resolved>, OpenError> {
    resolved(path, model, |poses| poses.resolve(model))
}

/// Key poses of a model, in JSON: poses with times.
///
/// # Errors
/// As [`content`]; names that the model does not have; times that are missing or do not rise.
#[cfg(feature = "poses")]
pub fn keys(path: &Path, model: &Model) -> Result<Read<Keys>, OpenError> {
    resolved(path, model, |poses| poses.keys(model))
}

#[cfg(feature = "poses")]
fn resolved<T>(
    path: &Path,
    model: &Model,
    resolve: impl FnOnce(&Poses) -> Result<T, Error>,
) -> Result<Read<T>, OpenError> {
    let Read { value: poses, mut warnings } =
        only(path, ContentKind::Poses, Zeros::Told, |content| match content {
            Content::Poses(poses) => Some(poses),
            _ => None,
        })?;
    warnings.extend(poses.remarks(model));
    let value = resolve(&poses);
    let value = value.map_err(|error| failed(path, Cause::Content { error, text: None }))?;
    Ok(Read { value, warnings })
}

/// A path that a file gives, from the file's own place.
pub fn beside(file: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    file.parent().unwrap_or(Path::new("")).join(name)
}
