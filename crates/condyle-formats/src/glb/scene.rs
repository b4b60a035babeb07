//! The parts of a scene.

use condyle_math::Affine;
use condyle_mesh::{Finish, Mesh};
use condyle_model::model::Facing;

/// The axis that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum UpAxis {
    /// As in glTF and OpenSim.
    #[default]
    Y,
    /// As in most laboratories.
    Z,
}

/// The transform of a node in its parent: scaled first, then rotated, then translated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalPose {
    /// Metres.
    pub translation: [f64; 3],
    /// Unit quaternion x, y, z, w; it is normalised on writing, and its sign is free.
    pub rotation: [f64; 4],
    /// Factors along the node's own axes, without unit; 1 changes nothing.
    pub scale: [f64; 3],
}

impl LocalPose {
    /// Where the parent is.
    pub const IDENTITY: Self =
        Self { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
}

impl Default for LocalPose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// A named frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneNode {
    /// Shown in viewers.
    pub name: String,
    /// Index of an earlier node; `None` for a root.
    pub parent: Option<usize>,
    /// Where the node is while no track moves it.
    pub rest: LocalPose,
    /// Where the node is in the figure's world while the surfaces are as they are given.
    pub bound: Affine,
}

impl Default for SceneNode {
    fn default() -> Self {
        let rest = LocalPose::IDENTITY;
        Self { name: String::new(), parent: None, rest, bound: Affine::IDENTITY }
    }
}

/// A surface that one node carries, or two.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// In the figure's world, while every node is where it is bound.
    pub mesh: Mesh,
    /// How it looks.
    pub finish: Finish,
    /// Indices of the nodes that carry it; twice the same for one.
    pub nodes: [usize; 2],
    /// For each corner the part of the second node, from 0 to 1; empty for none.
    pub weights: Vec<f64>,
    /// For each corner red, green and blue in linear light, from 0 to 1, in place of the finish's; empty for none.
    pub colours: Vec<[f32; 3]>,
}

/// The motion of one node.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// Index of the node; no node has two tracks.
    pub node: usize,
    /// One for each of the scene's times.
    pub poses: Vec<LocalPose>,
}

/// The path of a recorded marker, drawn as a small ball.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MarkerTrack {
    /// Shown in viewers.
    pub name: String,
    /// Metres in the figure's world, one for each of the scene's times; where it was not seen,
    /// the ball stays at its last position.
    pub positions: Vec<Option<[f64; 3]>>,
}

/// What a number drives outside of the figure, such as a morph or a muscle.
///
/// glTF animates nothing but nodes and morphs, so it is written as a node of that name whose place along x is the value, in
/// metres a unit: every program shows it, and can drive a property of its own by it. The node's extras say `{"drives": NAME}`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Driven {
    /// What is driven.
    pub name: String,
    /// Its value where no time is given.
    pub rest: f64,
    /// One for each time.
    pub values: Vec<f64>,
}

/// A figure, its motion and the markers it follows.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Names the scene, its root and its animation.
    pub name: String,
    /// The axis that points up in the figure's world.
    pub up: UpAxis,
    /// Where the figure looks; the node above all others is turned so that it looks along +z, as glTF asks.
    pub facing: Facing,
    /// Parents before their children.
    pub nodes: Vec<SceneNode>,
    /// What is drawn.
    pub surfaces: Vec<Surface>,
    /// Seconds, rising; empty for a still figure.
    pub times: Vec<f64>,
    /// Nodes without one stay at rest.
    pub tracks: Vec<Track>,
    /// What is driven besides the figure's nodes.
    pub driven: Vec<Driven>,
    /// Drawn besides the figure.
    pub markers: Vec<MarkerTrack>,
    /// Radius of the markers' balls in metres; 8 mm by default.
    pub marker_radius: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            name: String::new(),
            up: UpAxis::Y,
            facing: Facing::PlusZ,
            nodes: Vec::new(),
            surfaces: Vec::new(),
            times: Vec::new(),
            tracks: Vec::new(),
            driven: Vec::new(),
            markers: Vec::new(),
            marker_radius: 0.008,
        }
    }
}
