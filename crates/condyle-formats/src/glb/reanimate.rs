//! A character that a user has, with a new animation: all else byte for byte as it was.

use super::container::Container;
use super::json::{self, Item};
use super::scene::{Driven, LocalPose};
use super::splice::Splice;
use super::tree::Tree;
use super::write::{continuous, kept_frames};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, listed, nearest};
use serde_json::json;
use std::collections::HashMap;

/// The transforms of one node over time, in the units of its file.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct NodeTrack {
    /// The name of the node, as [`read`](super::read) gives it: `node_` and its number for one without a name, `name#2` for the second of one name.
    pub name: String,
    /// Where the node is in its parent; one for each time, or none if it stays where it stands.
    pub translations: Vec<[f64; 3]>,
    /// Quaternions x, y, z, w of any length; one for each time, or none.
    pub rotations: Vec<[f64; 4]>,
    /// Factors along the node's axes; one for each time, or none.
    pub scales: Vec<[f64; 3]>,
}

/// What the nodes of a file do.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct NodeMotion {
    /// The name of the animation; empty for `condyle`.
    pub name: String,
    /// Seconds, rising; written from the first, which is 0.
    pub times: Vec<f64>,
    /// Nodes that move.
    pub tracks: Vec<NodeTrack>,
    /// Morphs by the names that the meshes' extras give them (`targetNames`), as most programs write them.
    pub driven: Vec<Driven>,
}

/// What becomes of the animations that a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Old {
    /// They are left out: the new one is the only one.
    #[default]
    Replaced,
    /// They stay, and the new one stands first.
    Kept,
}

/// Gives a character a new animation.
///
/// Meshes, skins, materials, textures, nodes, extras and extensions stay byte for byte as they are, as do all bytes of the
/// binary chunk; the keys are appended to it. A glTF file in JSON becomes a GLB: buffers that it holds become the binary chunk; where
/// others are beside it, all stay where they are and the keys are in an address of their own. Linear keys in 32 bits; a node's property that never changes has one key.
///
/// [`node_motion`](super::node_motion) makes the tracks from a motion of the model that [`read`](super::read) gives. Who computes them in another way
/// gives for each node its transform in its parent as glTF has it, scaled first, then rotated, then translated, with lengths
/// in the unit of the file.
///
/// # Warnings
/// `glb/replaced` with the names of animations that are left out, `glb/node` with names that the file does not have,
/// `glb/morph` for what is driven and no mesh has,
/// `glb/matrix` for a node whose matrix is written as its three parts, since one with a matrix cannot move.
///
/// # Errors
/// As [`read`](super::read) for the file; `glb/track` if a track is not as long as the times or two move one node,
/// `glb/time` if times are not finite and rising, `glb/pose` if a number is not finite, `glb/node` if the file has none of the
/// nodes, `glb/size` beyond 4 GiB.
///
/// ```
/// use condyle_formats::glb::{self, NodeMotion, NodeTrack, Old, Options};
/// let character = br#"{"asset": {"version": "2.0"}, "nodes": [{"name": "hip"}], "skins": [{"joints": [0]}]}"#;
/// let hip = NodeTrack {
///     name: "hip".into(),
///     translations: vec![[0.0, 0.9, 0.0], [0.0, 1.0, 0.5]],
///     ..NodeTrack::default()
/// };
/// let jump = NodeMotion {
///     name: "jump".into(),
///     times: vec![0.0, 0.5],
///     tracks: vec![hip],
///     ..NodeMotion::default()
/// };
/// let file = glb::reanimate(character, &jump, Old::Replaced)?.value;
/// let read = glb::from_bytes(&file)?.value;
/// assert_eq!(read.motion.frames[1][..3], [0.0, 1.0, 0.5]);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn reanimate(bytes: &[u8], motion: &NodeMotion, old: Old) -> Result<Read<Vec<u8>>, Error> {
    let mut warnings = Warnings::default();
    let container = Container::find(bytes, &mut warnings)?;
    let text = bytes.get(container.json.clone()).unwrap_or_default();
    let value = json::parse(text)?;
    let root = Item::root(&value);
    let tree = Tree::read(&root, &mut warnings)?;
    check_times(&motion.times)?;
    let tracks = found(motion, &tree, &mut warnings)?;
    tell_replaced(&root, old, &mut warnings);

    let mut splice = Splice::new(text);
    let binary = container.binary.clone().and_then(|range| bytes.get(range));
    // The keys go into the binary chunk, which is the first buffer, if that has no address of its own.
    let first = root.element("buffers", 0).ok();
    let joined = if container.is_binary { None } else { joined(&mut splice, &root)? };
    let own_chunk = match &first {
        None => true,
        Some(_) if joined.is_some() => true,
        Some(buffer) => buffer.text("uri").is_none() && binary.is_some(),
    };
    let chunk = joined.as_deref().or(binary).unwrap_or_default();
    let before = if own_chunk { chunk.len().next_multiple_of(4) } else { 0 };
    let buffers = root.list("buffers")?.len();
    let mut keys = Keys {
        bytes: vec![],
        before,
        buffer: if own_chunk { 0 } else { buffers },
        views: root.list("bufferViews")?.len(),
        accessors: root.list("accessors")?.len(),
        splice: &mut splice,
    };
    let morphs = morphs(motion, &root, &mut warnings)?;
    let animation = keys.animation(motion, &tracks, &morphs)?;
    let added = keys.bytes;
    let total = before + added.len();
    if own_chunk {
        match &first {
            Some(_) if joined.is_some() => {
                splice.add("buffers", json!({ "byteLength": total }).to_string(), true);
            }
            Some(_) => set_length(&mut splice, total),
            None => splice.add("buffers", json!({ "byteLength": total }).to_string(), false),
        }
    } else {
        let uri =
            format!("data:application/octet-stream;base64,{}", crate::text::base64::encode(&added));
        splice.add("buffers", json!({ "byteLength": added.len(), "uri": uri }).to_string(), false);
    }
    add_animation(&mut splice, &root, animation, old)?;
    unpack_matrices(&mut splice, &root, &tree, &tracks, &mut warnings)?;

    let mut chunk = chunk.to_vec();
    if own_chunk {
        chunk.resize(before, 0);
        chunk.extend(added);
    }
    let file = assembled(bytes, &container, splice.finish(), &chunk)?;
    Ok(Read { value: file, warnings: warnings.finish() })
}

/// A track and its node.
type Found<'m> = (usize, &'m NodeTrack);

fn found<'m>(
    motion: &'m NodeMotion,
    tree: &Tree,
    warnings: &mut Warnings,
) -> Result<Vec<Found<'m>>, Error> {
    let of: HashMap<&str, usize> =
        tree.nodes.iter().enumerate().map(|(index, node)| (node.name.as_str(), index)).collect();
    let (mut tracks, mut lost): (Vec<Found<'m>>, Vec<&str>) = (vec![], vec![]);
    let mut moved = vec![false; tree.nodes.len()];
    for track in &motion.tracks {
        check(track, motion.times.len())?;
        let Some(&node) = of.get(track.name.as_str()) else {
            lost.push(&track.name);
            continue;
        };
        if std::mem::replace(&mut moved[node], true) {
            return Err(Error::new("glb/track", format!("two tracks move `{}`", track.name)));
        }
        tracks.push((node, track));
    }
    if let Some(first) = lost.first() {
        let message = format!("the file has no nodes {}", listed(&lost));
        let near = nearest(first, of.keys().copied());
        let help = near.map_or_else(
            || "their motion is left out".to_owned(),
            |near| format!("their motion is left out; did you mean `{near}`?"),
        );
        if tracks.is_empty() {
            return Err(Error::new("glb/node", message).with_help(help));
        }
        warnings.push(Diagnostic::warning("glb/node", message).with_help(help));
    }
    Ok(tracks)
}

/// The morphs of the mesh of one node.
struct Morphs<'m> {
    node: usize,
    weights: Vec<Weight<'m>>,
}

/// The weight of a morph.
enum Weight<'m> {
    Still(f64),
    Driven(&'m Driven),
}

/// Nodes with a mesh that has a morph which is driven.
fn morphs<'m>(
    motion: &'m NodeMotion,
    root: &Item<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Morphs<'m>>, Error> {
    let (mut found, mut used) = (vec![], vec![false; motion.driven.len()]);
    for driven in &motion.driven {
        let finite = driven.values.iter().all(|x| x.abs() < 1e9);
        if driven.values.len() != motion.times.len() || !finite {
            let message =
                format!("what drives `{}` has {} values", driven.name, driven.values.len());
            return Err(Error::new("glb/track", message).with_help(format!(
                "expected {} finite ones, one for each time",
                motion.times.len()
            )));
        }
    }
    let nodes = if motion.driven.is_empty() { vec![] } else { root.list("nodes")? };
    for (index, node) in nodes.iter().enumerate() {
        let Some(mesh) = node.get("mesh") else { continue };
        let mesh = root.element("meshes", mesh.index()?)?;
        let extras = mesh.get("extras");
        let names = extras.map_or(Ok(vec![]), |extras| extras.list("targetNames"))?;
        let targets = mesh.element("primitives", 0).and_then(|part| part.list("targets"));
        if names.is_empty() || targets.map_or(0, |targets| targets.len()) != names.len() {
            continue;
        }
        let still = if node.get("weights").is_some() { node } else { &mesh };
        let still = still.list("weights")?;
        let mut any = false;
        let weights = names.iter().enumerate().map(|(place, name)| {
            let name = name.value.as_str();
            match motion.driven.iter().position(|driven| Some(driven.name.as_str()) == name) {
                Some(driven) => {
                    (any, used[driven]) = (true, true);
                    Weight::Driven(&motion.driven[driven])
                }
                None => {
                    Weight::Still(still.get(place).and_then(|w| w.value.as_f64()).unwrap_or(0.0))
                }
            }
        });
        let weights = weights.collect();
        if any {
            found.push(Morphs { node: index, weights });
        }
    }
    let lost = motion.driven.iter().zip(used).filter(|(_, used)| !used);
    let lost: Vec<&str> = lost.map(|(driven, _)| driven.name.as_str()).collect();
    if !lost.is_empty() {
        let message = format!("no mesh of the file has a morph {}", listed(&lost));
        warnings.push(
            Diagnostic::warning("glb/morph", message)
                .with_help("meshes name their morphs in extras.targetNames"),
        );
    }
    Ok(found)
}

fn check(track: &NodeTrack, frames: usize) -> Result<(), Error> {
    let (places, turns, sizes) = (&track.translations, &track.rotations, &track.scales);
    for length in [places.len(), turns.len(), sizes.len()] {
        if length != 0 && length != frames {
            let message = format!("the track of `{}` has {length} frames", track.name);
            return Err(Error::new("glb/track", message)
                .with_help(format!("expected {frames}, one for each time, or none")));
        }
    }
    let held = |x: &f64| x.abs() < 1e9;
    let numbers = places.iter().chain(sizes).flatten().all(held);
    let length = |q: &[f64; 4]| q.iter().map(|x| x * x).sum::<f64>();
    if numbers && turns.iter().all(|q| length(q).is_finite() && length(q) > 1e-12) {
        return Ok(());
    }
    Err(Error::new("glb/pose", format!("the track of `{}` holds what is no transform", track.name))
        .with_help("places and sizes are finite, a rotation is a quaternion with a length"))
}

fn check_times(times: &[f64]) -> Result<(), Error> {
    if times.is_empty() {
        return Err(Error::new("glb/time", "the motion has no frames"));
    }
    if let Some(bad) = times.iter().position(|t| !t.is_finite()) {
        return Err(Error::new("glb/time", format!("time {bad} is not finite")));
    }
    match times.windows(2).position(|pair| pair[1] < pair[0]) {
        Some(bad) => Err(Error::new("glb/time", format!("time {} is before time {bad}", bad + 1))),
        None => Ok(()),
    }
}

fn tell_replaced(root: &Item<'_>, old: Old, warnings: &mut Warnings) {
    let Ok(known) = root.list("animations") else { return };
    if old == Old::Replaced && !known.is_empty() {
        let name = |(index, item): (usize, &Item<'_>)| {
            item.text("name").map_or_else(|| (index + 1).to_string(), str::to_owned)
        };
        let names: Vec<String> = known.iter().enumerate().map(name).collect();
        let message = format!("the animations of the file are replaced: {}", listed(&names));
        warnings.push(
            Diagnostic::warning("glb/replaced", message)
                .with_help("their keys stay in the buffer, unused"),
        );
    }
}

/// Keys that are being appended.
struct Keys<'s, 't> {
    bytes: Vec<u8>,
    /// How many bytes of the buffer come before them.
    before: usize,
    buffer: usize,
    views: usize,
    accessors: usize,
    splice: &'s mut Splice<'t>,
}

impl Keys<'_, '_> {
    /// The animation in JSON.
    fn animation(
        &mut self,
        motion: &NodeMotion,
        tracks: &[Found<'_>],
        morphs: &[Morphs<'_>],
    ) -> Result<String, Error> {
        let kept = kept_frames(&motion.times);
        let mut clocks = [None; 2];
        let (mut samplers, mut channels) = (vec![], vec![]);
        for (node, track) in tracks {
            let turns = kept.iter().filter_map(|(frame, _)| track.rotations.get(*frame).copied());
            let turns = continuous(turns);
            let single = |from: &[[f64; 3]]| -> Vec<[f32; 3]> {
                let picked = kept.iter().filter_map(|(frame, _)| from.get(*frame));
                picked.map(|vector| vector.map(|x| x as f32)).collect()
            };
            let parts = [
                ("translation", flat(&single(&track.translations)), 3),
                ("rotation", flat(&turns), 4),
                ("scale", flat(&single(&track.scales)), 3),
            ];
            for (path, mut values, width) in parts {
                if values.is_empty() {
                    continue;
                }
                let still = values.chunks_exact(width).all(|value| value == &values[..width]);
                if still {
                    values.truncate(width);
                }
                let clock = &mut clocks[usize::from(still)];
                let input = match *clock {
                    Some(input) => input,
                    None => {
                        let most = if still { 1 } else { kept.len() };
                        let times: Vec<f32> =
                            kept.iter().take(most).map(|(_, time)| *time).collect();
                        *clock.insert(self.accessor(&times, 1))
                    }
                };
                let output = self.accessor(&values, width);
                channels.push(
                    json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}),
                );
                samplers.push(json!({"input": input, "output": output}));
            }
        }
        for Morphs { node, weights } in morphs {
            let at = |frame: usize, weight: &Weight<'_>| match weight {
                Weight::Still(value) => *value as f32,
                Weight::Driven(driven) => driven.values.get(frame).copied().unwrap_or(0.0) as f32,
            };
            let frames = kept.iter().map(|(frame, _)| *frame);
            let values: Vec<f32> = frames
                .flat_map(|frame| weights.iter().map(move |weight| at(frame, weight)))
                .collect();
            let input = match clocks[0] {
                Some(input) => input,
                None => {
                    let times: Vec<f32> = kept.iter().map(|(_, time)| *time).collect();
                    *clocks[0].insert(self.accessor(&times, 1))
                }
            };
            let output = self.accessor(&values, 1);
            channels.push(
                json!({"sampler": samplers.len(), "target": {"node": node, "path": "weights"}}),
            );
            samplers.push(json!({"input": input, "output": output}));
        }
        if channels.is_empty() {
            return Err(Error::new("glb/track", "no track moves anything"));
        }
        let name = if motion.name.is_empty() { "condyle" } else { &motion.name };
        Ok(json!({"name": name, "channels": channels, "samplers": samplers}).to_string())
    }

    /// Adds numbers with their view and accessor, whose index is returned.
    fn accessor(&mut self, values: &[f32], width: usize) -> usize {
        let start = self.before + self.bytes.len();
        self.bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        let view =
            json!({"buffer": self.buffer, "byteOffset": start, "byteLength": 4 * values.len()});
        self.splice.add("bufferViews", view.to_string(), false);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][(width - 1).min(3)];
        let mut accessor = json!({"bufferView": self.views, "componentType": 5126,
            "count": values.len() / width, "type": kind});
        if width == 1 {
            let low = values.iter().copied().fold(f32::INFINITY, f32::min);
            let high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            accessor["min"] = json!([low]);
            accessor["max"] = json!([high]);
        }
        self.splice.add("accessors", accessor.to_string(), false);
        self.views += 1;
        self.accessors += 1;
        self.accessors - 1
    }
}

fn flat<const N: usize>(vectors: &[[f32; N]]) -> Vec<f32> {
    vectors.concat()
}

/// The buffers that a JSON holds in its addresses, one after the other for the binary chunk, with their views moved there; `None`
/// if one of them is elsewhere, or views have extensions, which may name buffers too.
fn joined(splice: &mut Splice<'_>, root: &Item<'_>) -> Result<Option<Vec<u8>>, Error> {
    let (mut bytes, mut starts): (Vec<u8>, Vec<usize>) = (vec![], vec![]);
    for buffer in root.list("buffers")? {
        let data = buffer.text("uri").and_then(|uri| uri.strip_prefix("data:"));
        let data = data.and_then(|data| data.split_once(";base64,"));
        let Some(data) = data.and_then(|(_, text)| crate::text::base64::decode(text)) else {
            return Ok(None);
        };
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        starts.push(bytes.len());
        bytes.extend(data);
    }
    let views = root.list("bufferViews")?;
    if starts.is_empty() || views.iter().any(|view| view.get("extensions").is_some()) {
        return Ok(None);
    }
    let list = splice.member(splice.top(), "bufferViews");
    let places = list.map_or_else(Vec::new, |list| splice.elements(list.start));
    for (view, place) in views.iter().zip(places) {
        let buffer = view.need("buffer")?.below(starts.len(), "buffer")?;
        let start = starts.get(buffer).copied().unwrap_or(0);
        if buffer == 0 {
            continue;
        }
        let offset = start + view.size_or("byteOffset", 0)?;
        if let Some(known) = splice.member(place.start, "byteOffset") {
            splice.replace(known, offset.to_string());
        }
        if let Some(known) = splice.member(place.start, "buffer") {
            let new = match view.get("byteOffset") {
                Some(_) => "0".to_owned(),
                None => format!("0,\"byteOffset\":{offset}"),
            };
            splice.replace(known, new);
        }
    }
    Ok(Some(bytes))
}

/// States the length of the first buffer.
fn set_length(splice: &mut Splice<'_>, total: usize) {
    let list = splice.member(splice.top(), "buffers");
    let first = list.and_then(|list| splice.elements(list.start).into_iter().next());
    let length = first.and_then(|buffer| splice.member(buffer.start, "byteLength"));
    if let Some(length) = length {
        splice.replace(length, total.to_string());
    }
}

/// The new animation first, so that programs that play one play it.
fn add_animation(
    splice: &mut Splice<'_>,
    root: &Item<'_>,
    animation: String,
    old: Old,
) -> Result<(), Error> {
    let known = root.list("animations")?;
    match splice
        .member(splice.top(), "animations")
        .filter(|_| old == Old::Kept && !known.is_empty())
    {
        Some(list) => splice.replace(list.start + 1..list.start + 1, format!("{animation},")),
        None => splice.add("animations", animation, true),
    }
    Ok(())
}

/// A node that moves has no matrix, but a translation, a rotation and a scale.
fn unpack_matrices(
    splice: &mut Splice<'_>,
    root: &Item<'_>,
    tree: &Tree,
    tracks: &[Found<'_>],
    warnings: &mut Warnings,
) -> Result<(), Error> {
    let Some(list) = splice.member(splice.top(), "nodes") else { return Ok(()) };
    let mut elements = None;
    for (index, _) in tracks {
        if root.element("nodes", *index)?.get("matrix").is_none() {
            continue;
        }
        let elements = elements.get_or_insert_with(|| splice.elements(list.start));
        let Some(element) = elements.get(*index).cloned() else { continue };
        let LocalPose { translation, rotation, scale } = tree.nodes[*index].local;
        let name = &tree.nodes[*index].name;
        warnings.add("glb/matrix", || {
            let message = format!("the matrix of node `{name}` is written as its parts");
            Diagnostic::warning("glb/matrix", message).with_help("a node with a matrix cannot move")
        });
        for (key, start, value) in splice.members(element.start) {
            if key == "matrix" {
                let parts =
                    json!({"translation": translation, "rotation": rotation, "scale": scale});
                let parts = parts.to_string();
                let inner = parts.trim_start_matches('{').trim_end_matches('}').to_owned();
                splice.replace(start..value.end, inner);
            }
        }
    }
    Ok(())
}

/// The whole file; chunks of other kinds stay after the others.
fn assembled(
    bytes: &[u8],
    container: &Container,
    mut json: Vec<u8>,
    chunk: &[u8],
) -> Result<Vec<u8>, Error> {
    if json.starts_with(b"\xef\xbb\xbf") {
        json.drain(..3);
    }
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut binary = chunk.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut parts: Vec<(&[u8], &[u8])> = vec![(b"JSON", &json)];
    if !binary.is_empty() {
        parts.push((b"BIN\0", &binary));
    }
    parts.extend(container.others(bytes));
    let total = 12 + parts.iter().map(|(_, part)| 8 + part.len()).sum::<usize>();
    let word = |n: usize| {
        u32::try_from(n).map(u32::to_le_bytes).map_err(|_| {
            Error::new("glb/size", "the file would need more than 4 GiB")
                .with_help("write fewer frames")
        })
    };
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(word(total)?);
    for (kind, part) in parts {
        file.extend(word(part.len())?);
        file.extend(kind);
        file.extend(part);
    }
    Ok(file)
}
