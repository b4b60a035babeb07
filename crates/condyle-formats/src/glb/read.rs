//! The skeleton of a file, and what it does.

use super::accessor::{Accessors, Beside};
use super::clip::Clip;
use super::container::Container;
use super::figure::{Figure, Still};
use super::json::{self, Item};
use super::reanimate::NodeMotion;
use super::tree::Tree;
use crate::skeleton::Assumed;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, did_you_mean};
use condyle_motion::{Animation, Motion};

/// What of a file is read.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Options {
    /// The animation, by its name or its number, counted from 1; the first of the file where it is not told.
    pub animation: Option<String>,
    /// What the user knows: glTF is in metres and y up, but not every program keeps to that.
    pub assumed: Assumed,
}

/// Reads the skeleton of a GLB, or of glTF whose buffers are inside of it, and its first animation.
///
/// # Errors
/// As [`read`]; `glb/buffer` for a buffer in a file of its own.
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Animation>, Error> {
    read(bytes, &Options::default(), &mut |_| Err("the file is read alone".to_owned()))
}

/// Reads the skeleton of a GLB or of glTF in JSON, and one of its animations.
///
/// Bones are the joints of all skins, what they hang on, and what moves below them; without a skin, what is animated.
/// The [contract](crate::skeleton) says what they become. A joint has an orientation, places and sizes where
/// the animation changes them, all from the rest of the skin. A scale that never changes and is the same along all axes is
/// multiplied into the lengths below it, so that bones are rigid and in metres.
///
/// Frames are at the times of the keys; a curve or a step between keys that are far apart is sampled 60 times a second
/// and more. The key of a frame has the value that the specification gives it at that time.
///
/// `beside` gives the bytes of another file by its path as seen from this one.
///
/// # Warnings
/// `glb/animations` where the file holds several and none was asked for, `glb/rest` where rest is not where
/// nodes stand, `skeleton/scale` for lengths that are multiplied, `skeleton/unit` for a figure in centimetres,
/// `skeleton/left-out` for what moves and is no part of the skeleton; repairs: `glb/length`, `glb/chunk`, `glb/parents`, `glb/roots`,
/// `glb/rotation`, `glb/shear`, `glb/bind`, `glb/channel`, `glb/time`, `glb/uneven`, `glb/frames`, `skeleton/name`.
///
/// # Errors
/// `glb/json`, `glb/version`, `glb/chunk`, `glb/reference`, `glb/cycle`, `glb/buffer`, `glb/accessor`, `glb/size`,
/// `glb/keys`, `glb/time`, `glb/interpolation`, `glb/no-joints`, `glb/no-skeleton` without skin and animation,
/// `glb/animation` if there is none of the wanted name, `glb/pose` where scales multiply beyond any number.
///
/// ```
/// use condyle_formats::glb::{self, Options};
/// // A root that turns by a right angle about z within a second, and its child 2 m above it.
/// let keys: [f32; 10] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5f32.sqrt(), 0.5f32.sqrt()];
/// let bytes: Vec<u8> = keys.iter().flat_map(|x| x.to_le_bytes()).collect();
/// let text = r#"{"asset": {"version": "2.0"},
///   "nodes": [{"name": "root", "children": [1]}, {"name": "tip", "translation": [0, 2, 0]}],
///   "skins": [{"joints": [0, 1]}],
///   "buffers": [{"uri": "keys.bin", "byteLength": 40}],
///   "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
///   "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
///                 {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
///   "animations": [{"samplers": [{"input": 0, "output": 1}],
///                   "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]}"#;
/// let read = glb::read(text.as_bytes(), &Options::default(), &mut |_| Ok(bytes.clone()))?;
/// let animation = read.value;
/// assert_eq!(animation.motion.times, [0.0, 1.0]);
/// // Three numbers for the place of the root, four for each orientation.
/// assert_eq!(animation.model.stored_len(), 11);
/// assert!((animation.motion.frames[1][5] - 0.5f64.sqrt()).abs() < 1e-7);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    bytes: &[u8],
    options: &Options,
    beside: &mut Beside<'_>,
) -> Result<Read<Animation>, Error> {
    let mut warnings = Warnings::default();
    let Parts { tree, bound, clip, figure } = parts(bytes, options, beside, &mut warnings)?;
    let motion = figure.motion(&tree, &bound, &clip, bytes.len(), &mut warnings);
    if let Some(bad) = motion.frames.iter().position(|f| f.iter().any(|x| !x.is_finite())) {
        let message = format!("frame {bad} holds what is no number");
        return Err(Error::new("glb/pose", message)
            .with_help("scales of the nodes above multiply beyond any number"));
    }
    let Read { value: model, warnings: told } = figure.skeleton.build()?;
    warnings.extend(told);
    Ok(Read { value: Animation { model, motion }, warnings: warnings.finish() })
}

/// A motion of the model that [`read`] gives for these bytes and options, as transforms of the file's own nodes, in its own
/// units: what [`reanimate`](super::reanimate) takes.
///
/// Every frame of `motion` has the numbers of that model. Nodes that stay where they stand in the file have no track.
///
/// # Errors
/// As [`read`]; `glb/track` if a frame has not the numbers of the model.
pub fn node_motion(
    bytes: &[u8],
    options: &Options,
    beside: &mut Beside<'_>,
    motion: &Motion,
) -> Result<NodeMotion, Error> {
    let Parts { tree, bound, figure, .. } =
        parts(bytes, options, beside, &mut Warnings::default())?;
    figure.tracks(&tree, &bound, motion)
}

/// What a file consists of.
pub(super) struct Parts {
    pub(super) tree: Tree,
    bound: Still,
    clip: Clip,
    pub(super) figure: Figure,
}

pub(super) fn parts(
    bytes: &[u8],
    options: &Options,
    beside: &mut Beside<'_>,
    warnings: &mut Warnings,
) -> Result<Parts, Error> {
    let container = Container::find(bytes, warnings)?;
    let value = json::parse(bytes.get(container.json.clone()).unwrap_or_default())?;
    let root = Item::root(&value);
    check_version(&root)?;
    let binary = container.binary.and_then(|range| bytes.get(range));
    let mut accessors = Accessors::new(&value, binary, beside, bytes.len());
    let tree = Tree::read(&root, warnings)?;
    let bound = Still::read(&root, &tree, &mut accessors, warnings)?;
    let chosen = chosen(&root, options, warnings)?;
    if chosen.is_none() && !bound.joint.contains(&true) {
        let message = "the file has neither a skin nor an animation";
        return Err(Error::new("glb/no-skeleton", message)
            .with_help("a figure that moves is read, not a still scene"));
    }
    let clip = match &chosen {
        Some(item) => Clip::read(item, tree.nodes.len(), &mut accessors, warnings)?,
        None => Clip::default(),
    };
    let named = chosen.as_ref().and_then(|item| item.text("name")).filter(|name| !name.is_empty());
    let mut figure = Figure::new(&tree, &bound, &clip, warnings);
    figure.skeleton.name = name(&root, &tree, &bound).or(named).unwrap_or("figure").to_owned();
    figure.settle_unit(&options.assumed, warnings);
    Ok(Parts { tree, bound, clip, figure })
}

fn check_version(root: &Item<'_>) -> Result<(), Error> {
    let asset = root.get("asset");
    let version = asset.as_ref().and_then(|asset| asset.text("version")).unwrap_or("");
    match version.split('.').next() {
        Some("2") => Ok(()),
        _ if asset.is_none() => Err(Error::new("glb/json", "there is no `asset`: this is no glTF")),
        _ => Err(Error::new("glb/version", format!("the file is of version `{version}` of glTF"))
            .with_help("version 2 is read: export it again")),
    }
}

/// The animation that is wanted; `None` in a file without any.
fn chosen<'j>(
    root: &Item<'j>,
    options: &Options,
    warnings: &mut Warnings,
) -> Result<Option<Item<'j>>, Error> {
    let mut all = root.list("animations")?;
    let name = |(index, item): (usize, &Item<'_>)| {
        item.text("name").map_or_else(|| (index + 1).to_string(), str::to_owned)
    };
    let names: Vec<String> = all.iter().enumerate().map(name).collect();
    let listed = || condyle_diagnostics::listed(&names);
    let Some(wanted) = &options.animation else {
        if all.len() > 1 {
            let message = format!("the file holds {} animations: {}", all.len(), listed());
            warnings.push(
                Diagnostic::warning("glb/animations", message)
                    .with_help("the first is read; another is chosen by --animation"),
            );
        }
        return Ok((!all.is_empty()).then(|| all.swap_remove(0)));
    };
    let number = wanted.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let named = names.iter().position(|name| name == wanted);
    match named.or(number.filter(|number| *number < all.len())) {
        Some(index) => Ok(Some(all.swap_remove(index))),
        None => {
            let help =
                did_you_mean(wanted, names.iter().map(String::as_str), || match names.is_empty() {
                    true => "the file has none".to_owned(),
                    false => format!("the file holds {}", listed()),
                });
            let message = format!("there is no animation `{wanted}`");
            Err(Error::new("glb/animation", message).with_help(help))
        }
    }
}

/// What the figure is called: its skin, or the node above its first joint.
fn name<'j>(root: &Item<'j>, tree: &'j Tree, bound: &Still) -> Option<&'j str> {
    let skin = root.element("skins", 0).ok().and_then(|skin| skin.text("name"));
    let above = || {
        let first = tree.order.iter().find(|index| bound.joint[**index])?;
        let parent = tree.nodes[*first].parent?;
        Some(tree.nodes[parent].name.as_str()).filter(|name| !name.starts_with("node_"))
    };
    skin.filter(|name| !name.trim().is_empty()).or_else(above)
}
