//! The models that come with the library, by name.
//!
//! Each is a text that a person wrote, with the source of its numbers; what it is and how many
//! coordinates it has stands in `docs/shipped-models.md`. Texts that include others find them here
//! by file name. Where a model is asked for by path, as in [`open::model`](crate::open::model), the
//! name of a shipped one does as well.
//!
//! ```
//! use condyle::{open, shipped};
//! use std::path::Path;
//! assert!(shipped::names().any(|name| name == "spine"));
//! let spine = open::model(Path::new("spine")).unwrap().value;
//! assert!(spine.find_segment("skull").is_ok());
//! ```

#[cfg(feature = "document")]
use crate::open::{Cause, OpenError};
#[cfg(feature = "document")]
use condyle_formats::{
    Read,
    document::{self, Document},
};
use std::path::Path;

/// Name and text of every shipped model, by name.
#[cfg(feature = "document")]
const MODELS: &[(&str, &str)] = &[
    ("arms", include_str!("../models/arms.toml")),
    ("human", include_str!("../models/human.toml")),
    ("knee", include_str!("../models/knee.toml")),
    ("knee-pronost2010", include_str!("../models/knee-pronost2010.toml")),
    ("knee-three-rotations", include_str!("../models/knee-three-rotations.toml")),
    ("legs", include_str!("../models/legs.toml")),
    ("octopus", include_str!("../models/octopus.toml")),
    ("shoulder", include_str!("../models/shoulder.toml")),
    ("shoulder-shao2003", include_str!("../models/shoulder-shao2003.toml")),
    ("spine", include_str!("../models/spine.toml")),
    ("spine-shao2003", include_str!("../models/spine-shao2003.toml")),
];

/// Without a reader of documents there are none.
#[cfg(not(feature = "document"))]
const MODELS: &[(&str, &str)] = &[];

/// Texts that models include and that are none alone, by the path that is included.
#[cfg(feature = "document")]
const PARTS: &[(&str, &str)] = &[
    ("parts/body.toml", include_str!("../models/parts/body.toml")),
    ("parts/hand.toml", include_str!("../models/parts/hand.toml")),
    ("parts/head.toml", include_str!("../models/parts/head.toml")),
    ("parts/human-keypoints.toml", include_str!("../models/parts/human-keypoints.toml")),
    ("parts/human-limits.toml", include_str!("../models/parts/human-limits.toml")),
    ("parts/human-markers.toml", include_str!("../models/parts/human-markers.toml")),
    ("parts/knee-human.toml", include_str!("../models/parts/knee-human.toml")),
    ("parts/knee-yamaguchi1989.toml", include_str!("../models/parts/knee-yamaguchi1989.toml")),
    ("parts/leg-bones.toml", include_str!("../models/parts/leg-bones.toml")),
    ("parts/limit-shoulder.toml", include_str!("../models/parts/limit-shoulder.toml")),
    (
        "parts/limit-shoulder-lenarcic1994.toml",
        include_str!("../models/parts/limit-shoulder-lenarcic1994.toml"),
    ),
    ("parts/rib-cage.toml", include_str!("../models/parts/rib-cage.toml")),
    ("parts/vertebrae.toml", include_str!("../models/parts/vertebrae.toml")),
];

/// Name and text of every shipped table of names, by name.
#[cfg(feature = "document")]
const NAME_TABLES: &[(&str, &str)] = &[
    ("cmu", include_str!("../names/cmu.toml")),
    ("gait2392", include_str!("../names/gait2392.toml")),
    ("isb", include_str!("../names/isb.toml")),
    ("opencap", include_str!("../names/opencap.toml")),
    ("plug-in-gait", include_str!("../names/plug-in-gait.toml")),
];

/// Name and text of every shipped recipe, by name.
#[cfg(feature = "document")]
const RECIPES: &[(&str, &str)] = &[
    ("hip", include_str!("../recipes/hip.toml")),
    ("hip-left", include_str!("../recipes/hip-left.toml")),
    ("knee-isb", include_str!("../recipes/knee-isb.toml")),
    ("knee-isb-left", include_str!("../recipes/knee-isb-left.toml")),
    ("shoulder-herda2003", include_str!("../recipes/shoulder-herda2003.toml")),
    ("shoulder-herda2003-left", include_str!("../recipes/shoulder-herda2003-left.toml")),
    ("shoulder-isb", include_str!("../recipes/shoulder-isb.toml")),
    ("shoulder-isb-left", include_str!("../recipes/shoulder-isb-left.toml")),
    ("shoulder-plug-in-gait", include_str!("../recipes/shoulder-plug-in-gait.toml")),
    ("shoulder-plug-in-gait-left", include_str!("../recipes/shoulder-plug-in-gait-left.toml")),
];

/// Name and text of every shipped table of the names of bones, by name.
#[cfg(feature = "document")]
const SKELETONS: &[(&str, &str)] = &[
    ("biovision", include_str!("../names/skeletons/biovision.toml")),
    ("biped", include_str!("../names/skeletons/biped.toml")),
    ("cmu-asf", include_str!("../names/skeletons/cmu-asf.toml")),
    ("cmu-bvh", include_str!("../names/skeletons/cmu-bvh.toml")),
    ("h-anim", include_str!("../names/skeletons/h-anim.toml")),
    ("human", include_str!("../names/skeletons/human.toml")),
    ("mixamo", include_str!("../names/skeletons/mixamo.toml")),
    ("opensim", include_str!("../names/skeletons/opensim.toml")),
    ("poser", include_str!("../names/skeletons/poser.toml")),
    ("rigify", include_str!("../names/skeletons/rigify.toml")),
    ("smpl", include_str!("../names/skeletons/smpl.toml")),
    ("unreal", include_str!("../names/skeletons/unreal.toml")),
    ("vrm", include_str!("../names/skeletons/vrm.toml")),
    ("vrm0", include_str!("../names/skeletons/vrm0.toml")),
];

/// All shipped tables of the names of bones, each with its name, in alphabetical order.
#[cfg(feature = "document")]
pub fn skeletons() -> impl Iterator<Item = (&'static str, &'static str)> {
    SKELETONS.iter().copied()
}

/// The names of all shipped tables of marker names, in alphabetical order.
#[cfg(feature = "document")]
pub fn name_tables() -> impl Iterator<Item = &'static str> {
    NAME_TABLES.iter().map(|(name, _)| *name)
}

/// The text of a shipped table of marker names; `None` if none has that name.
#[cfg(feature = "document")]
pub fn name_table(name: &str) -> Option<&'static str> {
    NAME_TABLES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The names of all shipped recipes, in alphabetical order.
#[cfg(feature = "document")]
pub fn recipes() -> impl Iterator<Item = &'static str> {
    RECIPES.iter().map(|(name, _)| *name)
}

/// The text of a shipped recipe; `None` if none has that name.
#[cfg(feature = "document")]
pub fn recipe(name: &str) -> Option<&'static str> {
    RECIPES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The names of all shipped models, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    MODELS.iter().map(|(name, _)| *name)
}

/// The text of a shipped model as it was written, with its comments; `None` if no model has that name.
pub fn text(name: &str) -> Option<&'static str> {
    MODELS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Reads a shipped model with all that it includes.
///
/// # Errors
/// [`Cause::Unknown`] if there is none of that name.
#[cfg(feature = "document")]
pub fn read(name: &str) -> Result<Read<Document>, OpenError> {
    with(name, &mut |_| {})
}

/// A text of a shipped model that needs no other: the text itself where it includes none, else its
/// head of comments and the whole model, written out.
///
/// # Errors
/// [`Cause::Unknown`] if there is none of that name.
#[cfg(feature = "document")]
pub fn standalone(name: &str) -> Result<String, OpenError> {
    let mut parts = vec![];
    let document = with(name, &mut |file| parts.push(file.to_owned()))?.value;
    if parts.is_empty() {
        return Ok(document.text);
    }
    let head = document.text.lines().take_while(|line| line.starts_with('#'));
    let head: String = head.map(|line| format!("{line}\n")).collect();
    let (parts, model) = (parts.join(", "), document::write(&document.model));
    Ok(format!("{head}#\n# Written out with {parts}, in metres and radians.\n{model}"))
}

/// Reads a shipped model and names what it includes.
#[cfg(feature = "document")]
fn with(name: &str, note: &mut dyn FnMut(&str)) -> Result<Read<Document>, OpenError> {
    let fail = |cause| OpenError { path: name.into(), cause };
    let text = text(name).ok_or_else(|| fail(Cause::Unknown))?;
    let read = document::read(text, &mut |file| {
        note(file);
        included(file).map(str::to_owned)
    });
    read.map_err(|error| fail(Cause::Content { error, text: Some(text.to_owned()) }))
}

/// The text of an included file: another shipped model, or a part.
///
/// # Errors
/// A sentence where none has that name.
#[cfg(feature = "document")]
pub fn included(file: &str) -> Result<&'static str, String> {
    includable(file).ok_or_else(|| format!("no text `{file}` is shipped"))
}

/// What a document can include without a file: a shipped model by its name, with or without `.toml`,
/// and the parts that shipped models include.
#[cfg(feature = "document")]
pub(crate) fn includable(name: &str) -> Option<&'static str> {
    text(name.strip_suffix(".toml").unwrap_or(name)).or_else(|| part(name))
}

/// The text of a part that shipped models include, or a limit that they name, by its path: `parts/limit-shoulder.toml`.
///
/// ```
/// use condyle::{formats::document::limit, shipped};
/// let text = shipped::part("parts/limit-shoulder.toml").unwrap();
/// let shoulder = limit::read(text, &mut |_| Err("it stands alone".into())).unwrap().value;
/// assert_eq!(shoulder.about().child, "humerus");
/// ```
#[cfg(feature = "document")]
#[must_use]
pub fn part(path: &str) -> Option<&'static str> {
    PARTS.iter().find(|(known, _)| *known == path).map(|(_, text)| *text)
}

/// The word that a path is where it is no file, but may be the name of a shipped model: one without
/// a folder and an ending.
///
/// ```
/// use condyle::shipped;
/// use std::path::Path;
/// assert_eq!(shipped::asked_for(Path::new("shoulder")), Some("shoulder"));
/// assert_eq!(shipped::asked_for(Path::new("shoulder.osim")), None);
/// assert_eq!(shipped::asked_for(Path::new("-")), None);
/// ```
pub fn asked_for(path: &Path) -> Option<&str> {
    let name = path.to_str()?;
    let in_words = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    // `-` alone is standard input; a pipe is as good as a file.
    let word = name.chars().any(char::is_alphanumeric) && name.chars().all(in_words);
    let there = path.exists() && !path.is_dir();
    (word && !MODELS.is_empty() && !there).then_some(name)
}
