//! A scene as the JSON and bytes of a GLB.

use std::collections::BTreeMap;

use gltf_json::animation::{Animation, Channel, Interpolation, Property, Sampler};
use gltf_json::buffer::Buffer;
use gltf_json::mesh::{Mesh, Mode, Primitive};
use gltf_json::scene::{Node, UnitQuaternion};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Index, Material, Root};

use super::pack::Pack;
use super::scene::{LocalPose, Scene, UpAxis};
use super::skin;
use condyle_diagnostics::Error;
use condyle_math::{Mat3, Quat, Vec3};
use condyle_mesh::{Ball, Finish, Form};
use serde_json::value::to_raw_value;

/// Writes a scene.
///
/// # Errors
///
/// `glb/parent` if a node's parent does not come before it, `glb/track` if a track has no node,
/// shares one, or is not as long as the times, `glb/time` if times are not finite and rising,
/// `glb/pose` if a place or size is not finite or a rotation has no length, `glb/surface` if a surface's
/// numbers are not finite, name no corner or no node, or hang on a node that is bound where nothing can
/// be, `glb/size` if the file would exceed 4 GiB.
///
/// ```
/// use condyle_formats::glb::{self, LocalPose, Scene, SceneNode, Track};
/// let quarter = LocalPose { rotation: [0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt()], ..LocalPose::IDENTITY };
/// let scene = Scene {
///     name: "bend".into(),
///     nodes: vec![SceneNode {
///         name: "upper".into(),
///         ..SceneNode::default()
///     }],
///     times: vec![0.0, 1.0],
///     tracks: vec![Track { node: 0, poses: vec![LocalPose::IDENTITY, quarter] }],
///     ..Scene::default()
/// };
/// let file = glb::write(&scene)?;
/// assert_eq!(&file[..4], b"glTF");
/// assert_eq!(file.len() % 4, 0);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(scene: &Scene) -> Result<Vec<u8>, Error> {
    check(scene)?;
    let mut writer = Writer {
        scene,
        root: Root::default(),
        pack: Pack::default(),
        kept: kept_frames(&scene.times),
        materials: BTreeMap::new(),
    };
    writer.root.asset.generator = Some("condyle".to_owned());
    let figure = writer.figure();
    let skinned = writer.skin(&figure);
    let mut markers = writer.markers();
    markers.extend(writer.driven());
    let animation = writer.animation(&figure, &markers);
    if !animation.channels.is_empty() {
        writer.root.push(animation);
    }
    let tops = scene.nodes.iter().zip(&figure).filter(|(n, _)| n.parent.is_none());
    let tops = tops.map(|(_, index)| *index).chain(markers.iter().map(|m| m.node)).collect();
    let turn = ahead(scene);
    let top = writer.root.push(Node {
        name: Some(scene.name.clone()),
        children: Some(tops).filter(|c: &Vec<_>| !c.is_empty()),
        rotation: (turn.w < 1.0).then(|| UnitQuaternion(turn.to_array().map(|x| x as f32))),
        ..Node::default()
    });
    let shown = writer.root.push(gltf_json::Scene {
        name: Some(scene.name.clone()),
        // Only its joints place a skinned mesh, so it stands beside them.
        nodes: [top].into_iter().chain(skinned).collect(),
        extensions: None,
        extras: Default::default(),
    });
    writer.root.scene = Some(shown);
    writer.finish()
}

/// The turn of the whole figure so that it stands along y and looks along z.
fn ahead(scene: &Scene) -> Quat {
    // A quarter turn about x takes z to y.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let upright = match scene.up {
        UpAxis::Y => Quat::IDENTITY,
        UpAxis::Z => Quat::from([-half, 0.0, 0.0, half]),
    };
    // With z up a facing is that of the world with y up, turned by that quarter: here it is turned back.
    let front = scene.facing.direction();
    Quat::from_axis_angle(Vec3::Y, -front.x.atan2(front.z)) * upright
}

/// Validates a scene before anything is built.
fn check(scene: &Scene) -> Result<(), Error> {
    for (index, node) in scene.nodes.iter().enumerate() {
        if let Some(parent) = node.parent
            && parent >= index
        {
            return Err(Error::new(
                "glb/parent",
                format!("node {index} `{}` has parent {parent}", node.name),
            )
            .with_help("a parent comes before its children"));
        }
        check_pose(&node.rest, &node.name, "at rest")?;
    }
    skin::check(scene)?;
    if let Some(bad) = scene.times.iter().position(|t| !t.is_finite()) {
        return Err(Error::new("glb/time", format!("time {bad} is not finite")));
    }
    if let Some(bad) = scene.times.windows(2).position(|t| t[1] < t[0]) {
        return Err(Error::new("glb/time", format!("time {} is before time {bad}", bad + 1)));
    }
    let mut moved = vec![false; scene.nodes.len()];
    for track in &scene.tracks {
        let (Some(node), Some(taken)) = (scene.nodes.get(track.node), moved.get_mut(track.node))
        else {
            return Err(Error::new("glb/track", format!("a track moves node {}", track.node))
                .with_help(format!("there are {} nodes", scene.nodes.len())));
        };
        if std::mem::replace(taken, true) {
            return Err(Error::new("glb/track", format!("two tracks move `{}`", node.name)));
        }
        check_length(track.poses.len(), scene, &node.name)?;
        for (frame, pose) in track.poses.iter().enumerate() {
            check_pose(pose, &node.name, &format!("in frame {frame}"))?;
        }
    }
    for marker in &scene.markers {
        check_length(marker.positions.len(), scene, &marker.name)?;
        if marker.positions.iter().flatten().flatten().any(|x| !x.is_finite()) {
            return Err(Error::new("glb/pose", format!("marker `{}` is not finite", marker.name)));
        }
    }
    for driven in &scene.driven {
        check_length(driven.values.len(), scene, &driven.name)?;
        if !driven.values.iter().chain([&driven.rest]).all(|x| x.abs() < 1e9) {
            return Err(Error::new(
                "glb/pose",
                format!("what drives `{}` is not finite", driven.name),
            ));
        }
    }
    if !scene.markers.is_empty() && ball(scene.marker_radius).check().is_err() {
        return Err(Error::new("glb/surface", format!("marker radius {}", scene.marker_radius)));
    }
    Ok(())
}

/// A recorded marker.
fn ball(radius: f64) -> Form {
    let radii = Vec3::new(radius, radius, radius);
    Form::Ball(Ball { at: Vec3::ZERO, radii, turn: Mat3::IDENTITY })
}

fn check_length(found: usize, scene: &Scene, name: &str) -> Result<(), Error> {
    if found == scene.times.len() {
        return Ok(());
    }
    Err(Error::new("glb/track", format!("the track of `{name}` has {found} frames"))
        .with_help(format!("expected {}, one for each time", scene.times.len())))
}

fn check_pose(pose: &LocalPose, name: &str, when: &str) -> Result<(), Error> {
    // f32 holds no more than 3.4e38; positions beyond a million kilometres are errors.
    let held = |numbers: &[f64; 3]| numbers.iter().all(|x| x.abs() < 1e9);
    if held(&pose.translation) && held(&pose.scale) && unit(pose.rotation).is_some() {
        return Ok(());
    }
    Err(Error::new("glb/pose", format!("`{name}` has {pose:?} {when}"))
        .with_help("places and sizes are finite, a rotation is a unit quaternion x, y, z, w"))
}

/// The quaternion normalised to length 1; `None` if its length is 0.
fn unit(q: [f64; 4]) -> Option<[f32; 4]> {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length.is_finite() && length > 1e-6).then(|| q.map(|x| (x / length) as f32))
}

/// Rotations as unit quaternions whose signs never jump, so that LINEAR takes the shortest arc.
pub(super) fn continuous(poses: impl Iterator<Item = [f64; 4]>) -> Vec<[f32; 4]> {
    let mut rotations: Vec<[f32; 4]> = Vec::new();
    for rotation in poses {
        let next = unit(rotation).unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let dot = rotations.last().map_or(1.0, |last| (0..4).map(|i| last[i] * next[i]).sum());
        rotations.push(if dot < 0.0 { next.map(|x| -x) } else { next });
    }
    rotations
}

/// The frames whose time, counted from the first in 32 bits, is later than all before.
pub(super) fn kept_frames(times: &[f64]) -> Vec<(usize, f32)> {
    let mut kept: Vec<(usize, f32)> = Vec::new();
    let first = times.first().copied().unwrap_or_default();
    for (frame, time) in times.iter().enumerate() {
        let time = (time - first) as f32;
        if kept.last().is_none_or(|(_, last)| time > *last) && time.is_finite() {
            kept.push((frame, time));
        }
    }
    kept
}

pub(super) struct Writer<'s> {
    pub(super) scene: &'s Scene,
    pub(super) root: Root,
    pub(super) pack: Pack,
    /// Frame and time of each key.
    kept: Vec<(usize, f32)>,
    materials: BTreeMap<(Finish, bool), Index<Material>>,
}

/// A node that only moves, of a marker or a driven value, and its place at every key.
struct MarkerNode {
    node: Index<Node>,
    places: Vec<[f32; 3]>,
}

impl Writer<'_> {
    /// The figure's nodes, in order.
    fn figure(&mut self) -> Vec<Index<Node>> {
        let scene = self.scene;
        let mut indices = Vec::with_capacity(scene.nodes.len());
        let first = self.kept.first().map(|(frame, _)| *frame);
        let mut rests: Vec<LocalPose> = scene.nodes.iter().map(|node| node.rest).collect();
        for track in &scene.tracks {
            let pose = first.and_then(|frame| track.poses.get(frame));
            if let (Some(pose), Some(rest)) = (pose, rests.get_mut(track.node)) {
                *rest = *pose;
            }
        }
        let mut children: Vec<Vec<Index<Node>>> = vec![Vec::new(); scene.nodes.len()];
        for (index, (node, rest)) in scene.nodes.iter().zip(rests).enumerate() {
            let built = self.root.push(Node {
                name: Some(node.name.clone()),
                translation: Some(rest.translation.map(|x| x as f32)),
                rotation: unit(rest.rotation).map(UnitQuaternion),
                scale: Some(rest.scale.map(|x| x as f32)).filter(|s| *s != [1.0; 3]),
                ..Node::default()
            });
            indices.push(built);
            debug_assert_eq!(built.value(), index);
            if let Some(siblings) = node.parent.and_then(|parent| children.get_mut(parent)) {
                siblings.push(built);
            }
        }
        for (node, children) in self.root.nodes.iter_mut().zip(children) {
            node.children = Some(children).filter(|c| !c.is_empty());
        }
        indices
    }

    /// One node for each marker that was ever seen; all share one ball.
    fn markers(&mut self) -> Vec<MarkerNode> {
        let scene = self.scene;
        let mut nodes = Vec::new();
        let mut mesh = None;
        for marker in &scene.markers {
            let at = |frame: usize| marker.positions.get(frame).copied().flatten();
            let Some(mut last) = self.kept.iter().find_map(|(frame, _)| at(*frame)) else {
                continue;
            };
            let mut places = Vec::with_capacity(self.kept.len());
            for (frame, _) in &self.kept {
                last = at(*frame).unwrap_or(last);
                places.push(last.map(|x| x as f32));
            }
            let radius = scene.marker_radius;
            mesh = mesh.or_else(|| {
                let mut corners = skin::Corners::default();
                corners.add(&ball(radius).mesh(), &mut |_| None);
                self.mesh("marker", BTreeMap::from([((Finish::Marker, false), corners)]))
            });
            let node = self.root.push(Node {
                name: Some(marker.name.clone()),
                mesh,
                translation: places.first().copied(),
                ..Node::default()
            });
            nodes.push(MarkerNode { node, places });
        }
        nodes
    }

    /// One node for each thing that is driven: its place along x is the value.
    fn driven(&mut self) -> Vec<MarkerNode> {
        let mut nodes = Vec::new();
        for driven in &self.scene.driven {
            let place = |value: f64| [value as f32, 0.0, 0.0];
            let values = self.kept.iter().filter_map(|(frame, _)| driven.values.get(*frame));
            let places: Vec<[f32; 3]> = values.map(|value| place(*value)).collect();
            let node = self.root.push(Node {
                name: Some(driven.name.clone()),
                translation: Some(places.first().copied().unwrap_or(place(driven.rest))),
                extras: to_raw_value(&serde_json::json!({ "drives": driven.name })).ok(),
                ..Node::default()
            });
            nodes.push(MarkerNode { node, places });
        }
        nodes
    }

    /// A mesh with one primitive for each finish, with colours of its corners and without; none without triangles.
    pub(super) fn mesh(
        &mut self,
        name: &str,
        parts: BTreeMap<(Finish, bool), skin::Corners>,
    ) -> Option<Index<Mesh>> {
        let mut primitives = Vec::new();
        for (finish, corners) in parts {
            if corners.indices.is_empty() {
                continue;
            }
            let (root, pack) = (&mut self.root, &mut self.pack);
            let attributes = corners.attributes(root, pack);
            let indices = pack.indices(root, &corners.indices);
            primitives.push(Primitive {
                attributes,
                indices: Some(indices),
                material: Some(self.material(finish)),
                mode: Checked::Valid(Mode::Triangles),
                targets: None,
                extensions: None,
                extras: Default::default(),
            });
        }
        (!primitives.is_empty()).then(|| {
            self.root.push(Mesh {
                name: Some(name.to_owned()),
                primitives,
                weights: None,
                extensions: None,
                extras: Default::default(),
            })
        })
    }

    /// How a finish looks; where corners have colours of their own it is white, for the two are multiplied.
    fn material(&mut self, (finish, coloured): (Finish, bool)) -> Index<Material> {
        let root = &mut self.root;
        *self.materials.entry((finish, coloured)).or_insert_with(|| {
            let roughness = if finish == Finish::Bone { 0.7 } else { 0.5 };
            let [red, green, blue] = if coloured { [1.0; 3] } else { finish.colour() };
            let name = if coloured { "by corner" } else { finish.name() };
            let name = Some(name.to_owned());
            let mut material = Material { name, ..Material::default() };
            material.pbr_metallic_roughness.base_color_factor.0 = [red, green, blue, 1.0];
            material.pbr_metallic_roughness.metallic_factor.0 = 0.0;
            material.pbr_metallic_roughness.roughness_factor.0 = roughness;
            root.push(material)
        })
    }

    /// A channel for everything that changes.
    fn animation(&mut self, figure: &[Index<Node>], markers: &[MarkerNode]) -> Animation {
        let mut animation = Animation {
            name: Some(self.scene.name.clone()),
            channels: Vec::new(),
            samplers: Vec::new(),
            extensions: None,
            extras: Default::default(),
        };
        let mut clock = None;
        let kept = std::mem::take(&mut self.kept);
        for track in &self.scene.tracks {
            let Some(node) = figure.get(track.node) else { continue };
            let poses = || kept.iter().filter_map(|(frame, _)| track.poses.get(*frame));
            let places: Vec<[f32; 3]> = poses().map(|p| p.translation.map(|x| x as f32)).collect();
            let rotations = continuous(poses().map(|p| p.rotation));
            let path = Property::Translation;
            self.channel(&mut animation, &mut clock, &kept, *node, path, &places);
            let path = Property::Rotation;
            self.channel(&mut animation, &mut clock, &kept, *node, path, &rotations);
            let sizes: Vec<[f32; 3]> = poses().map(|p| p.scale.map(|x| x as f32)).collect();
            let path = Property::Scale;
            self.channel(&mut animation, &mut clock, &kept, *node, path, &sizes);
        }
        for marker in markers {
            let path = Property::Translation;
            self.channel(&mut animation, &mut clock, &kept, marker.node, path, &marker.places);
        }
        animation
    }

    /// Adds a channel unless its values never change.
    fn channel<const N: usize>(
        &mut self,
        animation: &mut Animation,
        clock: &mut Option<Index<gltf_json::Accessor>>,
        kept: &[(usize, f32)],
        node: Index<Node>,
        path: Property,
        values: &[[f32; N]],
    ) {
        if values.windows(2).all(|pair| pair[0] == pair[1]) {
            return;
        }
        let (root, pack) = (&mut self.root, &mut self.pack);
        let input = *clock.get_or_insert_with(|| {
            let times: Vec<[f32; 1]> = kept.iter().map(|(_, time)| [*time]).collect();
            pack.floats(root, &times, None, true)
        });
        let output = pack.floats(root, values, None, false);
        let sampler = Index::push(
            &mut animation.samplers,
            Sampler {
                input,
                interpolation: Checked::Valid(Interpolation::Linear),
                output,
                extensions: None,
                extras: Default::default(),
            },
        );
        animation.channels.push(Channel {
            sampler,
            target: gltf_json::animation::Target {
                node,
                path: Checked::Valid(path),
                extensions: None,
                extras: Default::default(),
            },
            extensions: None,
            extras: Default::default(),
        });
    }

    fn finish(mut self) -> Result<Vec<u8>, Error> {
        let too_large = || {
            Error::new("glb/size", "the scene needs more than 4 GiB")
                .with_help("write fewer frames or markers")
        };
        // Chunks may not be empty: a scene without shapes and motion has no buffer.
        if !self.pack.bytes.is_empty() {
            self.root.push(Buffer {
                byte_length: USize64::from(self.pack.bytes.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: Default::default(),
            });
        }
        let json = self.root.to_vec().map_err(|e| Error::new("glb/json", e.to_string()))?;
        self.pack.file(json).ok_or_else(too_large)
    }
}
