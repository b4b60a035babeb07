//! The surfaces of a figure as one skinned mesh.
//!
//! With B a node's place in the figure's world where the surfaces are given, W its place now, and w the weight of
//! the second node, a corner p is shown at `((1 - w) W₁ B₁⁻¹ + w W₂ B₂⁻¹) p`.

use super::pack::Pack;
use super::scene::Scene;
use super::write::Writer;
use condyle_diagnostics::Error;
use condyle_mesh::Mesh;
use gltf_json::buffer::Target;
use gltf_json::mesh::Semantic;
use gltf_json::scene::Node;
use gltf_json::skin::Skin;
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index, Root};
use std::collections::BTreeMap;

/// The corners of several meshes.
#[derive(Debug, Default)]
pub(super) struct Corners {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// Two nodes and the weight of the second for each corner; none of a mesh that no skin moves.
    bound: Vec<([u16; 4], [f32; 4])>,
    /// The colour of each corner, of surfaces that have them.
    colours: Vec<[f32; 3]>,
    pub(super) indices: Vec<u32>,
}

impl Corners {
    pub(super) fn add(
        &mut self,
        mesh: &Mesh,
        bound: &mut dyn FnMut(usize) -> Option<([usize; 2], f64)>,
    ) {
        let first = self.positions.len() as u32;
        let single = |v: condyle_math::Vec3| v.to_array().map(|x| x as f32);
        self.positions.extend(mesh.positions.iter().map(|p| single(*p)));
        self.normals.extend(mesh.normals.iter().map(|n| single(*n)));
        self.indices.extend(mesh.triangles.iter().flatten().map(|i| first + i));
        for corner in 0..mesh.positions.len() {
            let Some(([a, b], weight)) = bound(corner) else { continue };
            let weight = weight as f32;
            // A joint of no weight is joint 0.
            self.bound.push(match weight {
                0.0 => ([a as u16, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
                1.0 => ([b as u16, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
                _ => ([a as u16, b as u16, 0, 0], [1.0 - weight, weight, 0.0, 0.0]),
            });
        }
    }

    pub(super) fn attributes(
        &self,
        root: &mut Root,
        pack: &mut Pack,
    ) -> BTreeMap<Checked<Semantic>, Index<Accessor>> {
        let array = Some(Target::ArrayBuffer);
        let mut attributes = BTreeMap::from([
            (Checked::Valid(Semantic::Positions), pack.floats(root, &self.positions, array, true)),
            (Checked::Valid(Semantic::Normals), pack.floats(root, &self.normals, array, false)),
        ]);
        if !self.colours.is_empty() {
            let colours = pack.floats(root, &self.colours, array, false);
            attributes.insert(Checked::Valid(Semantic::Colors(0)), colours);
        }
        if !self.bound.is_empty() {
            let joints: Vec<[u16; 4]> = self.bound.iter().map(|(joints, _)| *joints).collect();
            let weights: Vec<[f32; 4]> = self.bound.iter().map(|(_, weights)| *weights).collect();
            let joints = pack.joints(root, &joints);
            attributes.insert(Checked::Valid(Semantic::Joints(0)), joints);
            let weights = pack.floats(root, &weights, array, false);
            attributes.insert(Checked::Valid(Semantic::Weights(0)), weights);
        }
        attributes
    }
}

/// Validates the surfaces of a scene.
pub(super) fn check(scene: &Scene) -> Result<(), Error> {
    let wrong = |what: String, help: &str| Err(Error::new("glb/surface", what).with_help(help));
    if !scene.surfaces.is_empty() && scene.nodes.len() > usize::from(u16::MAX) {
        return wrong(format!("{} nodes carry surfaces", scene.nodes.len()), "write at most 65535");
    }
    for (number, surface) in scene.surfaces.iter().enumerate() {
        let mesh = &surface.mesh;
        let corners = mesh.positions.len();
        if mesh.normals.len() != corners
            || !(surface.weights.is_empty() || surface.weights.len() == corners)
            || !(surface.colours.is_empty() || surface.colours.len() == corners)
            || mesh.triangles.iter().flatten().any(|i| *i as usize >= corners)
        {
            return wrong(
                format!("surface {number} has {corners} corners"),
                "give each a normal, each or none a weight and a colour, and no triangle another corner",
            );
        }
        let finite = |v: &condyle_math::Vec3| v.to_array().iter().all(|x| x.abs() < 1e6);
        let weights = surface.weights.iter().all(|w| (0.0..=1.0).contains(w));
        let colours = surface.colours.iter().flatten().all(|c| (0.0..=1.0).contains(c));
        if !mesh.positions.iter().chain(&mesh.normals).all(finite) || !weights || !colours {
            return wrong(
                format!("surface {number} is not finite"),
                "places are in metres, weights and colours from 0 to 1",
            );
        }
        for node in surface.nodes {
            let Some(node) = scene.nodes.get(node) else {
                let help = format!("there are {} nodes", scene.nodes.len());
                return wrong(format!("surface {number} hangs on node {node}"), &help);
            };
            let size = node.bound.linear.determinant();
            if !node.bound.to_rows().iter().all(|x| x.abs() < 1e9) || size.abs() < 1e-12 {
                return wrong(
                    format!("surface {number} hangs on `{}`, which has no size", node.name),
                    "a node is bound where its transform has an inverse",
                );
            }
        }
    }
    Ok(())
}

impl Writer<'_> {
    /// The node that shows the surfaces, with its skin; none without surfaces.
    pub(super) fn skin(&mut self, figure: &[Index<Node>]) -> Option<Index<Node>> {
        let scene = self.scene;
        let mut parts = BTreeMap::<_, Corners>::new();
        for surface in &scene.surfaces {
            let weight = |corner: usize| surface.weights.get(corner).copied().unwrap_or(0.0);
            let coloured = !surface.colours.is_empty();
            let corners = parts.entry((surface.finish, coloured)).or_default();
            corners.colours.extend(&surface.colours);
            corners.add(&surface.mesh, &mut |corner| Some((surface.nodes, weight(corner))));
        }
        let mesh = self.mesh(&scene.name, parts)?;
        let back: Vec<[f32; 16]> = scene
            .nodes
            .iter()
            .map(|node| {
                // Column by column.
                let linear = node.bound.linear.inverse();
                let step = -(linear * node.bound.translation);
                let columns = [(linear.x, 0.0), (linear.y, 0.0), (linear.z, 0.0), (step, 1.0)];
                let mut matrix = [0.0; 16];
                for (column, (v, last)) in columns.into_iter().enumerate() {
                    for (row, x) in v.to_array().into_iter().chain([last]).enumerate() {
                        matrix[4 * column + row] = x as f32;
                    }
                }
                matrix
            })
            .collect();
        let matrices = self.pack.floats(&mut self.root, &back, None, false);
        let skin = self.root.push(Skin {
            name: Some(scene.name.clone()),
            inverse_bind_matrices: Some(matrices),
            joints: figure.to_vec(),
            skeleton: None,
            extensions: None,
            extras: Default::default(),
        });
        Some(self.root.push(Node {
            name: Some(format!("{} surface", scene.name)),
            mesh: Some(mesh),
            skin: Some(skin),
            ..Node::default()
        }))
    }
}
