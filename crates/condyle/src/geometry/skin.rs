//! A surface that several segments carry at once.

use condyle_math::{Affine, Mat3, Vec3};
use condyle_mesh::Mesh;
use condyle_model::{Pose, SegmentId};

/// What carries corners of a skin: a segment, or the world where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// The segment.
    pub segment: Option<SegmentId>,
    /// From the skin as it was modelled to that segment.
    pub bind: Affine,
}

/// A skin: linear blend skinning.
///
/// With the place S of a segment in the world, the transform B from the skin as it was modelled to that segment, and the
/// weights w of a corner p, which sum to 1, the corner is shown at `Σ w S B p`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Its name.
    pub name: String,
    /// The surface as it was modelled.
    pub mesh: Mesh,
    /// What carries it.
    pub holds: Vec<Hold>,
    /// For each corner four positions in `holds`.
    pub carriers: Vec<[u16; 4]>,
    /// For each corner how much each of the four counts; they sum to 1.
    pub weights: Vec<[f32; 4]>,
    /// Red, green and blue as a screen takes them, where its file gives one.
    pub colour: Option<[u8; 3]>,
}

impl Skin {
    /// The surface in a pose of its model, in the world.
    ///
    /// ```
    /// use condyle::geometry::{Hold, Skin};
    /// use condyle::math::{Affine, Vec3};
    /// use condyle::mesh::Mesh;
    /// use condyle::{Mode, ModelBuilder, Pose, Program};
    /// let mut b = ModelBuilder::new("arm");
    /// let arm = b.segment("arm", None);
    /// b.hinge("elbow", arm, "flexion", Vec3::Z);
    /// let model = b.build()?;
    /// // A corner that the world and the arm carry by halves, at 1 m from the hinge.
    /// let mesh = Mesh::of(vec![Vec3::X, Vec3::Y, Vec3::ZERO], vec![[0, 1, 2]]);
    /// let holds = [None, Some(arm)].map(|segment| Hold { segment, bind: Affine::IDENTITY }).to_vec();
    /// let skin = Skin { mesh, holds, carriers: vec![[0, 1, 0, 0]; 3], weights: vec![[0.5, 0.5, 0.0, 0.0]; 3],
    ///     ..Skin::default() };
    /// let program = Program::compile(&model);
    /// let mut pose = Pose::new(&program);
    /// program.evaluate(&[std::f64::consts::FRAC_PI_2], Mode::Open, &mut pose)?;
    /// let shown = skin.posed(&pose).positions[0];
    /// assert!((shown - Vec3::new(0.5, 0.5, 0.0)).norm() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn posed(&self, pose: &Pose) -> Mesh {
        let of = |hold: &Hold| {
            let place = hold.segment.map_or(Affine::IDENTITY, |segment| pose.segment(segment));
            place * hold.bind
        };
        let moves: Vec<Affine> = self.holds.iter().map(of).collect();
        let none = ([0; 4], [0.0; 4]);
        let mut mesh = self.mesh.clone();
        for (corner, (p, n)) in mesh.positions.iter_mut().zip(&mut mesh.normals).enumerate() {
            let carriers = self.carriers.get(corner).zip(self.weights.get(corner));
            let (carriers, weights) = carriers.map_or(none, |(c, w)| (*c, *w));
            let (mut place, mut turn) = (Vec3::ZERO, [Vec3::ZERO; 3]);
            for (carrier, weight) in carriers.into_iter().zip(weights) {
                let Some(moved) = moves.get(usize::from(carrier)).filter(|_| weight != 0.0) else {
                    continue;
                };
                let weight = f64::from(weight);
                place += (*moved * *p) * weight;
                let columns = [moved.linear.x, moved.linear.y, moved.linear.z];
                turn.iter_mut().zip(columns).for_each(|(sum, column)| *sum += column * weight);
            }
            *p = place;
            // Normals go with the inverse transpose, whose columns are the cross products but for a factor.
            let [x, y, z] = turn;
            let across = Mat3::from_columns(y.cross(z), z.cross(x), x.cross(y));
            let turned = across * *n;
            *n = if turned.norm() > 0.0 { turned.normalized() } else { *n };
        }
        mesh
    }
}
