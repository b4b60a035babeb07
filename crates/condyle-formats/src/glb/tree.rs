//! The nodes of a file: where each is in its parent, and on which it hangs.

use super::json::Item;
use super::scene::LocalPose;
use crate::text::distinct;
use condyle_diagnostics::{Diagnostic, Error, Warnings};
use condyle_math::{Affine, Mat3, Quat, Vec3};

/// A node.
#[derive(Clone, Debug)]
pub(crate) struct TreeNode {
    /// Its name; one that has none is called `node_` and its number.
    pub(crate) name: String,
    /// On which it hangs.
    pub(crate) parent: Option<usize>,
    /// Where it is in that.
    pub(crate) local: LocalPose,
    /// Whether it shows something: a mesh, a camera or a light.
    pub(crate) shows: bool,
    /// The skin of its mesh.
    pub(crate) skin: Option<usize>,
}

/// All nodes, and an order in which parents come first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// In the order of the file.
    pub(crate) nodes: Vec<TreeNode>,
    /// Each after its parent.
    pub(crate) order: Vec<usize>,
}

/// A shear that is told, without unit.
const SHEAR: f64 = 1e-4;

impl Tree {
    /// Reads the nodes.
    ///
    /// # Errors
    /// `glb/json`, `glb/reference`, `glb/cycle` where a node is below itself.
    pub(super) fn read(root: &Item<'_>, warnings: &mut Warnings) -> Result<Self, Error> {
        let items = root.list("nodes")?;
        let mut nodes = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let name = item.text("name").map(str::trim).filter(|name| !name.is_empty());
            let name = name.map_or_else(|| format!("node_{index}"), str::to_owned);
            let local = local(item, &name, warnings)?;
            let shows = ["mesh", "camera", "skin"].iter().any(|key| item.get(key).is_some());
            let skin = item.get("skin").and_then(|skin| skin.index().ok());
            nodes.push(TreeNode { name, parent: None, local, shows, skin });
        }
        for (index, item) in items.iter().enumerate() {
            for child in item.list("children")? {
                let below = child.below(items.len(), "node")?;
                let Some(node) = nodes.get_mut(below) else { continue };
                match node.parent {
                    None => node.parent = Some(index),
                    Some(first) => warnings.add("glb/parents", || {
                        let message = format!(
                            "node {below} `{}` hangs on nodes {first} and {index}",
                            node.name
                        );
                        Diagnostic::warning("glb/parents", message).with_help("the first counts")
                    }),
                }
            }
        }
        let order = order(&nodes)?;
        let names = names(root, &nodes)?;
        for (node, name) in nodes.iter_mut().zip(names) {
            if node.name != name {
                warnings.add("skeleton/name", || {
                    let message = format!(
                        "two nodes are called `{}`: the second is called `{name}`",
                        node.name
                    );
                    Diagnostic::warning("skeleton/name", message)
                });
                node.name = name;
            }
        }
        Ok(Self { nodes, order })
    }

    /// The tree of these nodes.
    ///
    /// # Errors
    /// `glb/cycle` where a node is below itself.
    #[cfg(feature = "fbx")]
    pub(crate) fn of(nodes: Vec<TreeNode>) -> Result<Self, Error> {
        let order = order(&nodes)?;
        Ok(Self { nodes, order })
    }

    /// Where every node is in the scene while nothing moves it.
    pub(super) fn world(&self) -> Vec<Affine> {
        let mut world = vec![Affine::IDENTITY; self.nodes.len()];
        for &index in &self.order {
            let node = &self.nodes[index];
            let parent = node.parent.map_or(Affine::IDENTITY, |parent| world[parent]);
            world[index] = parent * affine(&node.local);
        }
        world
    }
}

/// Names of which no two are the same. Joints have theirs before others: which nodes are read must not matter.
fn names(root: &Item<'_>, nodes: &[TreeNode]) -> Result<Vec<String>, Error> {
    let mut joint = vec![false; nodes.len()];
    for skin in root.list("skins")? {
        for item in skin.list("joints")? {
            if let Some(joint) = item.index().ok().and_then(|index| joint.get_mut(index)) {
                *joint = true;
            }
        }
    }
    let mut first: Vec<usize> = (0..nodes.len()).collect();
    first.sort_by_key(|index| !joint[*index]);
    let names = distinct(first.iter().map(|index| nodes[*index].name.as_str()), |_, _| {});
    let mut of = vec![String::new(); nodes.len()];
    for (index, name) in first.into_iter().zip(names) {
        of[index] = name;
    }
    Ok(of)
}

/// The transform of a place.
pub(crate) fn affine(place: &LocalPose) -> Affine {
    let turn = Quat::from(place.rotation).to_mat3();
    let [x, y, z] = place.scale;
    Affine::new(
        Mat3::from_columns(turn.x * x, turn.y * y, turn.z * z),
        Vec3::from(place.translation),
    )
}

fn local(item: &Item<'_>, name: &str, warnings: &mut Warnings) -> Result<LocalPose, Error> {
    if let Some(m) = item.numbers::<16>("matrix")? {
        let column = |c: usize| Vec3::new(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
        let linear = Mat3::from_columns(column(0), column(1), column(2));
        let (place, shear) = LocalPose::nearest(Affine::new(linear, column(3)));
        if shear > SHEAR {
            warnings.add("glb/shear", || {
                let message = format!("the matrix of node `{name}` has a shear of {shear:.2e}");
                Diagnostic::warning("glb/shear", message)
                    .with_help("the nearest place without one is taken")
            });
        }
        return Ok(place);
    }
    let rotation = item.numbers("rotation")?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    let rotation = if length > 1e-6 {
        rotation.map(|x| x / length)
    } else {
        let message = format!("node `{name}` has a rotation without length");
        warnings.push(Diagnostic::warning("glb/rotation", message).with_help("it is not turned"));
        [0.0, 0.0, 0.0, 1.0]
    };
    Ok(LocalPose {
        translation: item.numbers("translation")?.unwrap_or([0.0; 3]),
        rotation,
        scale: item.numbers("scale")?.unwrap_or([1.0; 3]),
    })
}

/// Parents before their children, otherwise in the order of the file.
fn order(nodes: &[TreeNode]) -> Result<Vec<usize>, Error> {
    let mut children: Vec<Vec<usize>> = vec![vec![]; nodes.len()];
    let mut order = Vec::with_capacity(nodes.len());
    // A stack from which the first in the file comes first.
    let mut open: Vec<usize> = vec![];
    for (index, node) in nodes.iter().enumerate().rev() {
        match node.parent {
            Some(parent) => children[parent].push(index),
            None => open.push(index),
        }
    }
    while let Some(next) = open.pop() {
        order.push(next);
        open.append(&mut children[next]);
    }
    if order.len() == nodes.len() {
        return Ok(order);
    }
    let mut reached = vec![false; nodes.len()];
    order.iter().for_each(|index| reached[*index] = true);
    let lost = reached.iter().position(|reached| !reached).unwrap_or(0);
    let message = format!("node {lost} `{}` is below itself", nodes[lost].name);
    Err(Error::new("glb/cycle", message).with_help("the nodes of a file are a tree"))
}
