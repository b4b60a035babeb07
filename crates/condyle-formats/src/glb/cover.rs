//! The surfaces that a file shows, and which bones carry them.
//!
//! A corner p of a skinned mesh is shown at `Σ w W B p`, with the place W of a joint in the scene and the inverse B of where
//! it was bound; without a skin at `W p` of its node. Bones are rigid and in metres: with the scale s of a bone and what is
//! above it, `W = S·s`, S the bone. So what a bone carries is bound by `s·B`.

use super::accessor::{Accessors, Beside, Numbers};
use super::container::Container;
use super::json::{self, Item};
use super::read::{Options, Parts, parts};
use super::tree::affine;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_mesh::Mesh;
use std::rc::Rc;

/// What carries corners of a surface: a bone, or the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The position of the segment in the model that [`read`](super::read) gives for the same bytes; `None` where no bone
    /// is above.
    pub segment: Option<usize>,
    /// From the surface as it stands in the file to that segment, in metres.
    pub bind: Affine,
}

/// A surface of a file, as it was modelled.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    /// The name of its node.
    pub name: String,
    /// Corners in the file's own unit.
    pub mesh: Mesh,
    /// What carries it.
    pub carriers: Vec<Carrier>,
    /// For each corner four positions among these.
    pub joints: Vec<[u16; 4]>,
    /// For each corner how much each of the four counts; they sum to 1.
    pub weights: Vec<[f32; 4]>,
    /// The colour of its material as light, from 0 to 1; none where a picture gives it.
    pub colour: Option<[f64; 3]>,
}

/// How large surfaces may become in all, beside eight times the size of their file, in bytes.
const ROOM: usize = 64 << 20;
/// What a corner takes.
const CORNER: usize = 72;
/// What something that carries takes.
const CARRIER: usize = size_of::<Carrier>();

/// Reads the surfaces of a file whose skeleton [`read`](super::read) gives. Where more than four joints carry a corner, the
/// four with the largest weights do.
///
/// # Warnings
/// `glb/surface` for surfaces of lines, points or packed numbers, which are left out. Those of the skeleton are told by
/// [`read`](super::read).
///
/// # Errors
/// As [`read`](super::read).
pub fn covers(
    bytes: &[u8],
    options: &Options,
    beside: &mut Beside<'_>,
) -> Result<Read<Vec<Cover>>, Error> {
    let Parts { tree, figure, .. } = parts(bytes, options, beside, &mut Warnings::default())?;
    let container = Container::find(bytes, &mut Warnings::default())?;
    let value = json::parse(bytes.get(container.json.clone()).unwrap_or_default())?;
    let root = Item::root(&value);
    let binary = container.binary.and_then(|range| bytes.get(range));
    let mut accessors = Accessors::new(&value, binary, beside, bytes.len());
    let (bones, scales, unit) = figure.scales(tree.nodes.len());
    let mut warnings = Warnings::default();
    let (mut covers, mut left) = (vec![], 0usize);
    // A mesh that many nodes show is many surfaces.
    let mut room = bytes.len().saturating_mul(8).saturating_add(ROOM);
    for (index, item) in root.list("nodes")?.iter().enumerate() {
        let Some(mesh) = item.get("mesh") else { continue };
        let mesh = root.element("meshes", mesh.index()?)?;
        let skin = item.get("skin").map(|skin| root.element("skins", skin.index()?)).transpose()?;
        // What carries the surface.
        let held = |node: usize, bind: Affine| {
            let (mut at, mut bind) = (node, bind);
            loop {
                if let Some(segment) = bones.get(at).copied().flatten() {
                    return Carrier {
                        segment: Some(segment),
                        bind: stretched(scales[segment], bind),
                    };
                }
                bind = affine(&tree.nodes[at].local) * bind;
                match tree.nodes[at].parent {
                    Some(parent) => at = parent,
                    None => return Carrier { segment: None, bind: stretched(unit, bind) },
                }
            }
        };
        let carriers = match &skin {
            None => vec![held(index, Affine::IDENTITY)],
            Some(skin) => {
                let binds = skin.get("inverseBindMatrices");
                let binds = binds.map(|at| accessors.numbers(at.index()?)).transpose()?;
                let mut carriers = vec![];
                for (joint, item) in skin.list("joints")?.iter().enumerate() {
                    let node = item.below(tree.nodes.len(), "node")?;
                    let bind =
                        binds.as_ref().and_then(|b| matrix(b, joint)).unwrap_or(Affine::IDENTITY);
                    carriers.push(held(node, bind));
                }
                carriers
            }
        };
        for primitive in mesh.list("primitives")? {
            match surface(&root, &primitive, skin.is_some(), carriers.len(), &mut accessors)? {
                Some((mesh, joints, weights)) => {
                    let size = CORNER * mesh.positions.len() + CARRIER * carriers.len();
                    room = room.checked_sub(size + 12 * mesh.triangles.len()).ok_or_else(|| {
                        Error::new("glb/size", "the surfaces of the file are larger than it can be")
                    })?;
                    covers.push(Cover {
                        name: tree.nodes[index].name.clone(),
                        mesh,
                        carriers: carriers.clone(),
                        joints,
                        weights,
                        colour: colour(&root, &primitive)?,
                    })
                }
                None => left += 1,
            }
        }
    }
    if left > 0 {
        let message = format!("{left} surfaces of the file are not drawn");
        let help = "triangles are, whose numbers are not packed by an extension";
        warnings.push(Diagnostic::warning("glb/surface", message).with_help(help));
    }
    Ok(Read { value: covers, warnings: warnings.finish() })
}

fn stretched(by: f64, bind: Affine) -> Affine {
    let m = bind.linear;
    Affine::new(Mat3::from_columns(m.x * by, m.y * by, m.z * by), bind.translation * by)
}

fn matrix(numbers: &Numbers, index: usize) -> Option<Affine> {
    let m = numbers.values.get(16 * index..16 * index + 16).filter(|_| numbers.width == 16)?;
    let column = |c: usize| Vec3::new(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
    Some(Affine::new(Mat3::from_columns(column(0), column(1), column(2)), column(3)))
}

fn colour(root: &Item<'_>, primitive: &Item<'_>) -> Result<Option<[f64; 3]>, Error> {
    let Some(material) = primitive.get("material") else { return Ok(None) };
    let material = root.element("materials", material.index()?)?;
    let Some(look) = material.get("pbrMetallicRoughness") else { return Ok(None) };
    if look.get("baseColorTexture").is_some() {
        return Ok(None);
    }
    let factor = look.numbers::<4>("baseColorFactor")?;
    Ok(factor.map(|[red, green, blue, _]| [red, green, blue].map(|x| x.clamp(0.0, 1.0))))
}

type Surface = (Mesh, Vec<[u16; 4]>, Vec<[f32; 4]>);

/// The triangles of a primitive; `None` where it has none that are read.
fn surface(
    root: &Item<'_>,
    primitive: &Item<'_>,
    skinned: bool,
    carriers: usize,
    accessors: &mut Accessors<'_, '_, '_>,
) -> Result<Option<Surface>, Error> {
    let packed =
        primitive.get("extensions").is_some_and(|e| e.value.to_string().contains("compression"));
    let mode = primitive.size_or("mode", 4)?;
    let attributes = primitive.need("attributes")?;
    if packed || !(4..=6).contains(&mode) || attributes.get("POSITION").is_none() {
        return Ok(None);
    }
    let mut of = |name: &str| -> Result<Option<Rc<Numbers>>, Error> {
        let Some(item) = attributes.get(name) else { return Ok(None) };
        let index = item.index()?;
        root.element("accessors", index)?;
        Ok(Some(accessors.numbers(index)?))
    };
    let three = |numbers: &Numbers| -> Vec<Vec3> {
        let (all, _) = numbers.values.as_chunks::<3>();
        all.iter().map(|v| Vec3::from(*v)).collect()
    };
    let Some(places) = of("POSITION")?.filter(|numbers| numbers.width == 3) else {
        return Ok(None);
    };
    let positions = three(&places);
    let normals = of("NORMAL")?.filter(|n| n.width == 3 && n.count() == positions.len());
    let mut sets = vec![];
    for set in 0..2 {
        let joints = of(&format!("JOINTS_{set}"))?.filter(|n| n.width == 4);
        let weights = of(&format!("WEIGHTS_{set}"))?.filter(|n| n.width == 4);
        sets.extend(joints.zip(weights).filter(|_| skinned));
    }
    let corners: Vec<u32> = match primitive.get("indices") {
        Some(indices) => {
            let numbers = accessors.numbers(indices.index()?)?;
            numbers.values.iter().map(|x| *x as u32).collect()
        }
        None => (0..positions.len() as u32).collect(),
    };
    let triangles: Vec<[u32; 3]> = match mode {
        4 => corners.as_chunks::<3>().0.to_vec(),
        5 => {
            let turned = |(at, t): (usize, &[u32])| {
                if at % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
            };
            corners.windows(3).enumerate().map(turned).collect()
        }
        _ => {
            let first = corners.first().copied().unwrap_or(0);
            let rest = corners.get(1..).unwrap_or_default();
            rest.windows(2).map(|pair| [first, pair[0], pair[1]]).collect()
        }
    };
    let count = positions.len();
    let mut mesh = Mesh::of(positions, triangles);
    if let Some(normals) = normals {
        mesh.normals = three(&normals);
    }
    let (mut joints, mut weights) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for corner in 0..count {
        let mut all: Vec<(usize, f64)> = sets
            .iter()
            .flat_map(|(joints, weights)| {
                let four = 4 * corner..4 * corner + 4;
                let joints = joints.values.get(four.clone()).unwrap_or_default();
                let weights = weights.values.get(four).unwrap_or_default();
                joints.iter().zip(weights).map(|(joint, weight)| (*joint as usize, *weight))
            })
            .filter(|(joint, weight)| *weight > 0.0 && *joint < carriers)
            .collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.truncate(4);
        let sum: f64 = all.iter().map(|(_, weight)| weight).sum();
        let (mut four, mut shares) = ([0u16; 4], [1.0f32, 0.0, 0.0, 0.0]);
        for (place, (joint, weight)) in all.iter().enumerate() {
            four[place] = u16::try_from(*joint).unwrap_or(0);
            shares[place] = (weight / sum) as f32;
        }
        joints.push(four);
        weights.push(shares);
    }
    Ok(Some((mesh, joints, weights)))
}
