//! A model in motion as a scene that any viewer opens.

use crate::Figure;
use condyle_diagnostics::{Diagnostic, Read};
use condyle_formats::glb::{
    self, Driven, LocalPose, MarkerTrack, Scene, SceneNode, Surface, Track, UpAxis,
};
use condyle_math::{Affine, Mat3};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};
use condyle_motion::Motion;
use condyle_motion::Recording;
use std::collections::BTreeSet;

/// Bones as surfaces, the motion's coordinates taken as they are: [`baked`] in open mode,
/// without its warnings.
pub fn scene(model: &Model, motion: &Motion, markers: Option<(&Recording, &[usize])>) -> Scene {
    baked(model, motion, Mode::Open, markers).value
}

/// The surfaces of a model ([`Figure`]) on a node for each segment.
///
/// Segments keep their names and their tree, so the file can be driven further in Blender: joint
/// sets are evaluated, and the result is plain bones, each with its place, turn and size in its
/// parent at every time. In posed mode limits hold. Without frames the model stands at its defaults.
///
/// # Warnings
/// `scene/shear` where segments are sheared, or stretched along a direction that is none of their
/// own axes: one node cannot hold that, so that each of these hangs on a second node, named after it, which has the stretch
/// ([`glb::in_two`]). Places are exact at every key.
pub fn baked(
    model: &Model,
    motion: &Motion,
    mode: Mode,
    markers: Option<(&Recording, &[usize])>,
) -> Read<Scene> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut lost = Lost::default();
    let order = model.parents_first();
    let mut node_of = vec![0usize; order.len()];
    for (node, id) in order.iter().enumerate() {
        node_of[id.index()] = node;
    }
    let mut tracks: Vec<Track> = (0..order.len())
        .map(|node| Track { node, poses: Vec::with_capacity(motion.frames.len()) })
        .collect();
    let evaluated = program.evaluate(&model.defaults(), mode, &mut pose);
    debug_assert!(evaluated.is_ok(), "defaults have the model's length");
    // A scene in motion rests where its first frame is.
    let rest_counts = motion.frames.is_empty();
    let figure = Figure::new(model);
    let nodes: Vec<SceneNode> = order
        .iter()
        .map(|&id| {
            let (rest, shear) = local(model, &pose, id);
            if rest_counts {
                lost.note(id, None, shear);
            }
            SceneNode {
                name: model.segment(id).name.clone(),
                parent: model.segment(id).parent.map(|p| node_of[p.index()]),
                rest,
                bound: figure.neutral[id.index()],
            }
        })
        .collect();
    for (frame, stored) in motion.frames.iter().enumerate() {
        if program.evaluate(stored, mode, &mut pose).is_ok() {
            for (track, &id) in tracks.iter_mut().zip(&order) {
                let (place, shear) = local(model, &pose, id);
                lost.note(id, Some(frame), shear);
                track.poses.push(place);
            }
        }
    }
    let mut figure_nodes: Vec<SceneNode> = nodes;
    if !lost.segments.is_empty() {
        let frames = if rest_counts { &[] } else { &motion.frames[..] };
        stretch(model, mode, frames, &order, &lost, (&mut figure_nodes, &mut tracks, &mut node_of));
    }
    let markers = markers.map_or_else(Vec::new, |(recording, labels)| {
        marker_tracks(recording, labels, &motion.times)
    });
    let scene = Scene {
        name: model.name().to_owned(),
        up: match model.up() {
            condyle_model::UpAxis::Y => UpAxis::Y,
            condyle_model::UpAxis::Z => UpAxis::Z,
        },
        facing: model.facing(),
        nodes: figure_nodes,
        surfaces: figure
            .parts
            .into_iter()
            .map(|part| Surface {
                nodes: part.segments.map(|id| node_of[id.index()]),
                mesh: part.mesh,
                finish: part.finish,
                weights: part.weights,
                colours: vec![],
            })
            .collect(),
        times: motion.times.clone(),
        tracks: if motion.frames.is_empty() { vec![] } else { tracks },
        driven: driven(model, motion, mode),
        markers,
        ..Scene::default()
    };
    Read { value: scene, warnings: lost.warning(model).into_iter().collect() }
}

/// The values of coordinates that drive something outside of the model; in posed mode inside their ranges.
pub fn driven(model: &Model, motion: &Motion, mode: Mode) -> Vec<Driven> {
    let mut found = vec![];
    let mut start = 0;
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        if let Some(name) = &coordinate.drives {
            let held = |value: f64| match mode {
                Mode::Open => value,
                _ => value
                    .max(coordinate.range.lower.unwrap_or(f64::NEG_INFINITY))
                    .min(coordinate.range.upper.unwrap_or(f64::INFINITY)),
            };
            let value = |frame: &Vec<f64>| held(frame.get(start).copied().unwrap_or_default());
            found.push(Driven {
                name: name.clone(),
                rest: held(coordinate.default[0]),
                values: motion.frames.iter().map(value).collect(),
            });
        }
        start += coordinate.kind.stored();
    }
    found
}

/// Gives each sheared segment a second node above its own, which holds the stretch.
fn stretch(
    model: &Model,
    mode: Mode,
    frames: &[Vec<f64>],
    order: &[SegmentId],
    lost: &Lost,
    (nodes, tracks, node_of): (&mut Vec<SceneNode>, &mut Vec<Track>, &mut [usize]),
) {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut axes = vec![Mat3::IDENTITY; order.len()];
    let mut pairs: Vec<(Vec<LocalPose>, Vec<LocalPose>)> = vec![(vec![], vec![]); order.len()];
    let defaults = [model.defaults()];
    let shown = if frames.is_empty() { &defaults[..] } else { frames };
    for stored in shown {
        if program.evaluate(stored, mode, &mut pose).is_err() {
            continue;
        }
        for ((id, axes), pair) in order.iter().zip(&mut axes).zip(&mut pairs) {
            if lost.segments.contains(id) {
                let (outer, inner) = glb::in_two(affine(model, &pose, *id), axes);
                pair.0.push(outer);
                pair.1.push(inner);
            }
        }
    }
    // Every segment keeps its order; the second nodes come just before their own.
    let (mut all, mut moved): (Vec<SceneNode>, Vec<Track>) = (vec![], vec![]);
    let mut new = vec![0usize; nodes.len()];
    let old = std::mem::take(nodes).into_iter().zip(std::mem::take(tracks));
    for (index, ((mut node, mut track), (outer, inner))) in old.zip(pairs).enumerate() {
        node.parent = node.parent.map(|parent| new[parent]);
        if let (Some(first), Some(second)) = (outer.first(), inner.first()) {
            let name = format!("{} stretch", node.name);
            all.push(SceneNode { name, rest: *first, ..node.clone() });
            node.parent = Some(all.len() - 1);
            node.rest = *second;
            moved.push(Track { node: all.len() - 1, poses: outer });
            track.poses = inner;
        }
        new[index] = all.len();
        track.node = all.len();
        all.push(node);
        moved.push(track);
    }
    node_of.iter_mut().for_each(|node| *node = new[*node]);
    (*nodes, *tracks) = (all, moved);
}

/// The shear that nodes cannot hold.
#[derive(Default)]
struct Lost {
    segments: BTreeSet<SegmentId>,
    worst: f64,
    /// Where the worst is: the segment, and the frame if there are any.
    at: Option<(SegmentId, Option<usize>)>,
}

/// Less than single precision can tell.
const LEAST_SHEAR: f64 = 1e-7;

impl Lost {
    fn note(&mut self, id: SegmentId, frame: Option<usize>, shear: f64) {
        if shear > LEAST_SHEAR {
            self.segments.insert(id);
        }
        if shear > self.worst {
            (self.worst, self.at) = (shear, Some((id, frame)));
        }
    }

    fn warning(&self, model: &Model) -> Option<Diagnostic> {
        let (id, frame) = self.at.filter(|_| !self.segments.is_empty())?;
        let mut named: Vec<String> =
            self.segments.iter().take(4).map(|&s| format!("`{}`", model.segment(s).name)).collect();
        if self.segments.len() > named.len() {
            named.push(format!("{} more", self.segments.len() - named.len()));
        }
        let frame = frame.map_or(String::new(), |frame| format!(" in frame {frame}"));
        let message = format!(
            "sheared segments hang on a second node each: {}; most is sheared `{}`{frame}, by {:.2} %",
            named.join(", "),
            model.segment(id).name,
            100.0 * self.worst,
        );
        let help = "one node has sizes along its own axes only";
        Some(Diagnostic::warning("scene/shear", message).with_help(help))
    }
}

fn marker_tracks(recording: &Recording, labels: &[usize], times: &[f64]) -> Vec<MarkerTrack> {
    let frame_at = |time: f64| {
        let after = recording.times.partition_point(|&t| t < time - 1e-9);
        after.min(recording.frames().saturating_sub(1))
    };
    labels
        .iter()
        .map(|&label| MarkerTrack {
            name: format!("marker {}", recording.labels.get(label).map_or("", String::as_str)),
            positions: times.iter().map(|&t| recording.position(frame_at(t), label)).collect(),
        })
        .collect()
}

/// Where a segment is in its parent, and the shear that one node leaves out.
fn local(model: &Model, pose: &Pose, id: SegmentId) -> (LocalPose, f64) {
    LocalPose::nearest(affine(model, pose, id))
}

/// Where a segment is in its parent. The parent may be stretched, so its inverse is the general one.
fn affine(model: &Model, pose: &Pose, id: SegmentId) -> Affine {
    let parent = pose.frame(model.segment(id).parent);
    let child = pose.segment(id);
    let back = parent.linear.inverse();
    let step = child.translation - parent.translation;
    Affine::new(back * child.linear, back * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_formats::document;

    /// A neck that stretches at constant volume, and turns; a head that turns under it; a hat that
    /// leans.
    const FIGURE: &str = r#"
        condyle = 1
        kind = "model"
        [segment.neck]
        at = [0, 1.4, 0]
        turn = [0, 0, 0.2]
        [joint_set.neck]
        coordinate.stretch = { kind = "scale" }
        coordinate.nod = {}
        component.long.scale = { factor = "stretch", axis = [0, 1, 0], volume = true }
        component.turn.rotate = { angle = "nod", axis = [0, 0, 1] }
        output.neck = ["turn", "long"]
        [segment.head]
        parent = "neck"
        at = [0.01, 0.1, 0]
        [joint.head]
        type = "euler"
        order = "zxy"
        segment = "head"
        [segment.hat]
        parent = "head"
        at = [0, 0.2, 0]
        [joint.hat]
        type = "shear"
        segment = "hat"
        along = [1, 0, 0]
        across = [0, 1, 0]
    "#;

    fn figure() -> Model {
        document::read(FIGURE, &mut |_| Err("it stands alone".into())).expect("a model").value.model
    }

    fn motion(frames: &[[f64; 6]]) -> Motion {
        let times = (0..frames.len()).map(|frame| frame as f64).collect();
        Motion { times, frames: frames.iter().map(|f| f.to_vec()).collect() }
    }

    /// The transform that a viewer makes of a place.
    fn seen(place: &LocalPose) -> Affine {
        let r = condyle_math::Quat::from(place.rotation).to_mat3();
        let [x, y, z] = place.scale;
        let linear = condyle_math::Mat3::from_columns(r.x * x, r.y * y, r.z * z);
        Affine::new(linear, condyle_math::Vec3::from(place.translation))
    }

    #[test]
    fn nodes_multiply_to_the_pose_of_every_segment() {
        let model = figure();
        // stretch, nod, the three turns of the head, the lean of the hat.
        let motion = motion(&[
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1.7, 0.4, 0.3, -0.2, 0.9, 0.0],
            [0.6, -0.3, -0.5, 0.4, -1.1, 0.0],
        ]);
        let baked = baked(&model, &motion, Mode::Open, None);
        assert_eq!(baked.warnings, []);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for (frame, stored) in motion.frames.iter().enumerate() {
            program.evaluate(stored, Mode::Open, &mut pose).expect("buffers of this program");
            let mut world: Vec<Affine> = vec![];
            for (node, track) in baked.value.nodes.iter().zip(&baked.value.tracks) {
                let parent = node.parent.map_or(Affine::IDENTITY, |p| world[p]);
                world.push(parent * seen(&track.poses[frame]));
                let id = model.find_segment(&node.name).expect("nodes are called as segments");
                let expected = pose.segment(id).to_rows();
                let found = world[world.len() - 1].to_rows();
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-14, "{} in frame {frame}", node.name);
                }
            }
        }
        // The neck's sizes are s along y and 1/√s across.
        let thin = 1.7f64.sqrt().recip();
        for (found, expected) in baked.value.tracks[0].poses[1].scale.iter().zip([thin, 1.7, thin])
        {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
    }

    #[test]
    fn a_shear_is_carried_by_a_second_node_and_said() {
        let model = figure();
        let lean: f64 = 0.3;
        let upright = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let motion = motion(&[upright, [1.0, 0.1, 0.2, 0.0, 0.0, lean]]);
        let baked = baked(&model, &motion, Mode::Open, None);
        // The polar decomposition of I + s·x·yᵀ leaves sin(atan(s/2)) twice beside the diagonal.
        let left = 100.0 * 2f64.sqrt() * (lean / 2.0).atan().sin();
        let said: Vec<String> = baked.warnings.iter().map(|w| w.message.clone()).collect();
        let expected = format!(
            "sheared segments hang on a second node each: `hat`; most is sheared `hat` in frame 1, by \
             {left:.2} %"
        );
        assert_eq!(said, [expected]);
        assert_eq!(baked.warnings[0].code, "scene/shear");
        let names: Vec<&str> = baked.value.nodes.iter().map(|node| node.name.as_str()).collect();
        assert_eq!(names, ["neck", "head", "hat stretch", "hat"]);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for (frame, stored) in motion.frames.iter().enumerate() {
            program.evaluate(stored, Mode::Open, &mut pose).expect("buffers of this program");
            let mut world: Vec<Affine> = vec![];
            for (node, track) in baked.value.nodes.iter().zip(&baked.value.tracks) {
                let parent = node.parent.map_or(Affine::IDENTITY, |p| world[p]);
                world.push(parent * seen(&track.poses[frame]));
            }
            let hat = pose.segment(model.find_segment("hat").expect("it is in the text")).to_rows();
            for (found, expected) in world[3].to_rows().iter().zip(hat) {
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
    }

    #[test]
    fn what_moves_nothing_is_driven() {
        let text = FIGURE.replace(
            "coordinate.nod = {}",
            "coordinate.nod = {}\ncoordinate.smile = { kind = \"other\", default = 0.25, drives = \"smile\" }",
        );
        let read = document::read(&text, &mut |_| Err("it stands alone".into()));
        let model = read.expect("a model").value.model;
        let mut frame = model.defaults();
        frame[2] = 0.75;
        let motion = Motion { times: vec![0.0], frames: vec![frame] };
        let baked = baked(&model, &motion, Mode::Open, None).value;
        let smile = Driven { name: "smile".into(), rest: 0.25, values: vec![0.75] };
        assert_eq!(baked.driven, [smile]);
    }

    #[test]
    fn limits_hold_in_posed_mode() {
        let text =
            FIGURE.replace("coordinate.nod = {}", "coordinate.nod = { range = [-0.1, 0.5] }");
        let model = document::read(&text, &mut |_| Err("it stands alone".into()));
        let model = model.expect("a model").value.model;
        let far = motion(&[[1.0, 0.9, 0.0, 0.0, 0.0, 0.0]]);
        for (mode, nod) in [(Mode::Open, 0.9), (Mode::Posed, 0.5)] {
            let baked = baked(&model, &far, mode, None).value;
            let turn = baked.tracks[0].poses[0].rotation[2];
            // The joint itself is turned by 0.2.
            assert!((turn - ((nod + 0.2) / 2.0f64).sin()).abs() < 1e-15, "{mode:?}");
        }
    }
}
