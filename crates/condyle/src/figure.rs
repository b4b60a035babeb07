//! A model as surfaces that move with its pose.

use crate::geometry::{Geometry, Skin};
use condyle_math::{Affine, Vec3};
use condyle_mesh::{Ball, Finish, Form, Mesh, Spindle};
use condyle_model::{Mode, Model, Pose, Program, SegmentId, Shape};

/// A bone, or what hangs between two.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The name of its shape, or of its segment.
    pub name: String,
    /// The segments that carry it; twice the same for a bone.
    pub segments: [SegmentId; 2],
    /// How it looks.
    pub finish: Finish,
    /// In the world, while the model is at its defaults.
    pub mesh: Mesh,
    /// For each corner the part of the second segment, from 0 to 1; empty for a bone.
    pub weights: Vec<f64>,
}

/// The surfaces of a model: its shapes, or where it has none a long octahedron from each joint to the next and a
/// ball at every joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What is seen.
    pub parts: Vec<Part>,
    /// Meshes of files, which are seen in place of the parts of their segments.
    pub meshes: Vec<Part>,
    /// Skins of files.
    pub skins: Vec<Skin>,
    /// Where each segment is in the world while the model is at its defaults.
    pub neutral: Vec<Affine>,
}

impl Figure {
    /// The surfaces of a model at its defaults, where limits hold.
    ///
    /// ```
    /// let knee = condyle::shipped::read("knee").unwrap().value.model;
    /// let figure = condyle::Figure::new(&knee);
    /// assert!(figure.parts.iter().all(|part| part.mesh.volume() > 0.0));
    /// ```
    #[must_use]
    pub fn new(model: &Model) -> Self {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        let evaluated = program.evaluate(&model.defaults(), Mode::Posed, &mut pose);
        debug_assert!(evaluated.is_ok(), "defaults have the model's length");
        let neutral: Vec<Affine> = model.segment_ids().map(|id| pose.segment(id)).collect();
        let parts = if model.shapes().is_empty() {
            model.segment_ids().flat_map(|id| plain(model, id, &neutral)).collect()
        } else {
            model.shapes().iter().map(|shape| part(shape, &neutral)).collect()
        };
        Self { parts, meshes: vec![], skins: vec![], neutral }
    }

    /// The same with meshes and skins of files.
    #[must_use]
    pub fn with(mut self, geometry: Geometry) -> Self {
        let part = |placed: crate::geometry::Placed| {
            let mut mesh = placed.mesh;
            place(&mut mesh, *self.neutral.get(placed.segment.index())?);
            let segments = [placed.segment; 2];
            Some(Part { name: placed.name, segments, finish: Finish::Bone, mesh, weights: vec![] })
        };
        self.meshes = geometry.meshes.into_iter().filter_map(part).collect();
        self.skins = geometry.skins;
        self
    }

    /// What is seen of bones: meshes, and the parts of segments that have none.
    pub fn seen(&self) -> impl Iterator<Item = &Part> {
        let own = |part: &&Part| {
            let [a, b] = part.segments;
            a != b || !self.meshes.iter().any(|mesh| mesh.segments[0] == a)
        };
        self.parts.iter().filter(own).chain(&self.meshes)
    }

    /// The surface of one part in a pose of its model, in the world.
    ///
    /// Between two segments, a corner goes with each by its weight.
    #[must_use]
    pub fn posed(&self, part: &Part, pose: &Pose) -> Mesh {
        let moved = part.segments.map(|id| {
            let neutral = self.neutral[id.index()];
            let back = neutral.linear.inverse();
            let linear = pose.segment(id).linear * back;
            Affine::new(linear, pose.segment(id).translation - linear * neutral.translation)
        });
        // Normals go with the inverse transpose.
        let turned = moved.map(|m| m.linear.inverse().transpose());
        let mut mesh = part.mesh.clone();
        for (corner, (p, n)) in mesh.positions.iter_mut().zip(&mut mesh.normals).enumerate() {
            let weight = part.weights.get(corner).copied().unwrap_or(0.0);
            *p = (moved[0] * *p) * (1.0 - weight) + (moved[1] * *p) * weight;
            *n = ((turned[0] * *n) * (1.0 - weight) + (turned[1] * *n) * weight).normalized();
        }
        mesh
    }
}

/// A shape of the model.
fn part(shape: &Shape, neutral: &[Affine]) -> Part {
    let own = neutral[shape.segment.index()];
    let mut form = shape.form.clone();
    let mut segments = [shape.segment; 2];
    let mut ends = None;
    if let (Some((other, point)), Form::Tube(tube)) = (shape.until, &mut form) {
        segments[1] = other;
        let world = neutral[other.index()] * point;
        let linear = own.linear.inverse();
        let far = linear * (world - own.translation);
        if let [.., before, last] = &mut tube.stations[..] {
            last.at = far;
            ends = Some((before.at, far));
        }
    }
    let mut mesh = form.mesh();
    let weights = ends.map_or_else(Vec::new, |(from, to): (Vec3, Vec3)| {
        let along = to - from;
        let length = along.norm_squared().max(1e-12);
        let part = |p: &Vec3| {
            let t = ((*p - from).dot(along) / length).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        mesh.positions.iter().map(part).collect()
    });
    place(&mut mesh, own);
    Part { name: shape.name.clone(), segments, finish: shape.finish, mesh, weights }
}

fn place(mesh: &mut Mesh, at: Affine) {
    let turned = at.linear.inverse().transpose();
    for (p, n) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        *p = at * *p;
        *n = (turned * *n).normalized();
    }
}

/// A ball at the segment's own joint, and a bone to each child's.
fn plain(model: &Model, id: SegmentId, neutral: &[Affine]) -> Vec<Part> {
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
    let mut forms = vec![];
    let mut longest: f64 = 0.03;
    for end in ends {
        let length = (end - own).norm();
        if length < 0.005 {
            continue;
        }
        longest = longest.max(length);
        forms.push((Form::Spindle(Spindle { from: own, to: end }), Finish::Bone));
    }
    let radius = (0.06 * longest).clamp(0.006, 0.02);
    let radii = Vec3::new(radius, radius, radius);
    let turn = condyle_math::Mat3::IDENTITY;
    forms.push((Form::Ball(Ball { at: own, radii, turn }), Finish::Joint));
    let part = |(form, finish): (Form, Finish)| {
        let mut mesh = form.mesh();
        place(&mut mesh, neutral[id.index()]);
        let name = segment.name.clone();
        Part { name, segments: [id; 2], finish, mesh, weights: vec![] }
    };
    forms.into_iter().map(part).collect()
}
