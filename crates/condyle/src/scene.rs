//! A model in motion as a scene that any viewer opens.

use crate::motion::Motion;
use condyle_formats::Recording;
use condyle_formats::glb::{
    Finish, LocalPose, MarkerTrack, Scene, SceneNode, Shape, Track, UpAxis,
};
use condyle_math::{Affine, Quat, Vec3};
use condyle_model::{Mode, Model, Pose, Program, SegmentId};

/// Bones as simple shapes: from each segment's origin to where its children hang, with a ball at
/// every joint.
///
/// Segments keep their names and their tree, so the file can be driven further in Blender. Rigid
/// motion only is written: translation and rotation of every segment in its parent.
pub fn scene(model: &Model, motion: &Motion, markers: Option<(&Recording, &[usize])>) -> Scene {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let order = model.parents_first();
    let mut node_of = vec![0usize; order.len()];
    for (node, id) in order.iter().enumerate() {
        node_of[id.index()] = node;
    }
    let rest = model.defaults();
    let mut tracks: Vec<Track> = (0..order.len())
        .map(|node| Track { node, poses: Vec::with_capacity(motion.frames.len()) })
        .collect();
    let evaluated = program.evaluate(&rest, Mode::Open, &mut pose);
    debug_assert!(evaluated.is_ok(), "defaults have the model's length");
    let nodes = order
        .iter()
        .map(|&id| SceneNode {
            name: model.segment(id).name.clone(),
            parent: model.segment(id).parent.map(|p| node_of[p.index()]),
            rest: local(model, &pose, id),
            shapes: shapes(model, id),
        })
        .collect();
    for frame in &motion.frames {
        if program.evaluate(frame, Mode::Open, &mut pose).is_ok() {
            for (track, &id) in tracks.iter_mut().zip(&order) {
                track.poses.push(local(model, &pose, id));
            }
        }
    }
    let markers = markers.map_or_else(Vec::new, |(recording, labels)| {
        marker_tracks(recording, labels, &motion.times)
    });
    Scene {
        name: model.name().to_owned(),
        up: match model.up() {
            condyle_model::UpAxis::Y => UpAxis::Y,
            condyle_model::UpAxis::Z => UpAxis::Z,
        },
        nodes,
        times: motion.times.clone(),
        tracks: if motion.frames.is_empty() { vec![] } else { tracks },
        markers,
        ..Scene::default()
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

fn local(model: &Model, pose: &Pose, id: SegmentId) -> LocalPose {
    let parent = pose.frame(model.segment(id).parent);
    let local: Affine = parent.rigid_inverse() * pose.segment(id);
    LocalPose {
        translation: local.translation.to_array(),
        rotation: Quat::from_mat3(local.linear).to_array(),
    }
}

/// A joint ball at the segment's own joint, and a bone to each child's.
fn shapes(model: &Model, id: SegmentId) -> Vec<Shape> {
    let segment = model.segment(id);
    let own = segment.joint_in_segment.translation;
    let children: Vec<Vec3> = model
        .segments()
        .iter()
        .filter(|s| s.parent == Some(id))
        .map(|s| s.joint_in_parent.translation)
        .collect();
    // A last segment reaches to its farthest marker.
    let marks = model.markers().iter().filter(|m| m.segment == Some(id)).map(|m| m.point);
    let ends = if children.is_empty() {
        marks.max_by(|a, b| (*a - own).norm().total_cmp(&(*b - own).norm())).into_iter().collect()
    } else {
        children
    };
    let mut shapes = vec![];
    let mut longest: f64 = 0.03;
    for end in ends {
        let length = (end - own).norm();
        if length < 0.005 {
            continue;
        }
        longest = longest.max(length);
        if own.norm() < 1e-9 {
            shapes.push(Shape::Bone { to: end.to_array() });
        } else {
            // The bone's thick end is at the origin of its node, so only the far half is drawn.
            shapes.push(Shape::Ball { at: own.to_array(), radius: 0.012, finish: Finish::Joint });
            shapes.push(Shape::Bone { to: end.to_array() });
        }
    }
    let radius = (0.06 * longest).clamp(0.006, 0.02);
    shapes.push(Shape::Ball { at: own.to_array(), radius, finish: Finish::Joint });
    shapes
}
