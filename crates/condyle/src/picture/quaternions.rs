//! The rotations of a joint in the space of quaternions: that by θ about the unit vector u is at u·sin(θ/2), within a ball of
//! radius 1, as Herda et al. 2003 draw them (their Figures 5 and 6).

use super::figure::Figure;
use super::limits::Judged;
use super::marks::{label, line};
use crate::limits::{boundary, herda2003};
use condyle_math::{Quat, Vec3};
use condyle_model::{JointSetId, Mode, Pose};
use condyle_render::{Line, Scene, Surface, palette, shape};
use std::f64::consts::TAU;

/// Cells along an edge of the boundary's lattice: 3.7 degrees each in the middle.
const CELLS: usize = 64;
/// How opaque the boundary is.
const OPACITY: f64 = 0.28;
/// The most samples that are drawn, evenly of all.
const MOST_SAMPLES: usize = 6000;
/// Steps of a path that are longer lead over the ball's surface: to the same rotation on the other side.
const JUMP: f64 = 0.5;
/// Radii of the present rotation's ball and of the nearest one's.
const BALLS: [f64; 2] = [0.035, 0.025];

/// Rotations of a joint, and what limits them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rotations {
    /// The boundary, axes, and the path of a motion.
    pub scene: Scene,
    /// The rotations that a limit was learned from.
    pub samples: Vec<Vec3>,
    /// Those of them that are outermost in their solid angle, as Herda et al. extract the surface of a cloud.
    pub surface: Vec<Vec3>,
    /// What the rotation is of, in words.
    pub title: String,
}

/// Of q and -q the one in the half with w ≥ 0.
fn place(q: Quat) -> Vec3 {
    if q.w < 0.0 { -q.vector() } else { q.vector() }
}

impl Figure<'_> {
    /// What limits the rotation of a segment that a joint set moves.
    fn judged(&self, set: JointSetId) -> Option<Judged<'_>> {
        let own: Vec<_> = self.model.outputs_of(set).map(|(segment, _)| segment).collect();
        Judged::of(self, &own)
    }

    /// What stays while the pose changes; `frames` are stored numbers over time.
    pub(super) fn rotations(&self, set: JointSetId, frames: &[Vec<f64>]) -> Option<Rotations> {
        let judged = self.judged(set)?;
        let mut found = Rotations { title: judged.title.clone(), ..Rotations::default() };
        let scene = &mut found.scene;
        let mesh = self.reaches.boundary_of(&judged, |distance| boundary(distance, CELLS));
        scene.surfaces.push(Surface {
            positions: mesh.positions.iter().map(|p| p.to_array()).collect(),
            normals: mesh.normals.iter().map(|n| n.to_array()).collect(),
            triangles: mesh.triangles.clone(),
            colour: palette::LIMIT,
            opacity: OPACITY,
        });
        let named = [("qx", palette::AXIS_X), ("qy", palette::AXIS_Y), ("qz", palette::AXIS_Z)];
        for (axis, (name, colour)) in Vec3::UNITS.into_iter().zip(named) {
            let plain = line(vec![-axis, axis], 1.0, colour);
            scene.lines.push(Line { through: 0.5, ..plain });
            label(axis, name, colour, scene);
            // Half turns are on the ball.
            let [u, v] = shape::across(axis);
            let round = (0..=64).map(|i| (TAU * f64::from(i) / 64.0).sin_cos());
            let round = round.map(|(s, c)| u * c + v * s).collect();
            scene.lines.push(Line {
                opacity: 0.5,
                through: 0.3,
                ..line(round, 1.0, palette::LEADER)
            });
        }
        let samples = judged.samples();
        let all: Vec<Vec3> = samples.iter().map(|q| place(*q)).collect();
        if let Some(middle) = (!all.is_empty()).then(|| herda2003_surface(&all)) {
            found.surface = middle;
        }
        let step = all.len().div_ceil(MOST_SAMPLES).max(1);
        found.samples = all.into_iter().step_by(step).collect();
        self.path(&judged, frames, &mut found.scene);
        Some(found)
    }

    /// The path of a motion: violet inside, thick and red outside.
    fn path(&self, judged: &Judged, frames: &[Vec<f64>], scene: &mut Scene) {
        let mut pose = Pose::new(self.program);
        let mut runs: Vec<(bool, Vec<Vec3>)> = vec![];
        for frame in frames {
            if self.program.evaluate(frame, Mode::Open, &mut pose).is_err() {
                continue;
            }
            let Some((q, distance)) = judged.at(&pose) else { continue };
            let (inside, at) = (distance >= -1e-6, place(q));
            let near = |run: &Vec<Vec3>| run.last().is_some_and(|p| (*p - at).norm() < JUMP);
            match runs.last_mut() {
                Some((same, run)) if *same == inside && near(run) => run.push(at),
                Some((_, run)) if near(run) => {
                    let shared = run[run.len() - 1];
                    runs.push((inside, vec![shared, at]));
                }
                _ => runs.push((inside, vec![at])),
            }
        }
        for (inside, run) in runs.into_iter().filter(|(_, run)| run.len() > 1) {
            let (width, colour) =
                if inside { (2.0, palette::MOTION) } else { (4.0, palette::GAP_BROKEN) };
            scene.lines.push(Line { through: 0.5, ..line(run, width, colour) });
        }
    }

    /// The present rotation, and the nearest one that is allowed where it is not.
    pub(super) fn rotation(&self, set: JointSetId) -> Option<Scene> {
        let judged = self.judged(set)?;
        let (q, distance) = judged.at(self.pose)?;
        let mut scene = Scene::default();
        let inside = distance >= -1e-6;
        let mut ball = |at: Vec3, radius: f64, colour| {
            let mut ball = Surface::empty(colour);
            shape::add_ball(&mut ball, at, radius, (18, 12));
            scene.surfaces.push(ball);
        };
        ball(place(q), BALLS[0], if inside { palette::VALUE } else { palette::GAP_BROKEN });
        let nearest = judged.nearest(self.pose).filter(|_| !inside);
        if let Some(nearest) = nearest {
            ball(place(nearest), BALLS[1], palette::GAP);
            let way = vec![place(q), place(nearest)];
            scene.lines.push(Line { through: 1.0, ..line(way, 3.0, palette::GAP_BROKEN) });
        }
        let degrees = distance.to_degrees().abs();
        let said = match inside {
            true => format!("{degrees:.1}° inside"),
            false => format!("{degrees:.1}° outside"),
        };
        label(place(q), &said, palette::TEXT, &mut scene);
        Some(scene)
    }
}

/// The outermost points by the method of Herda et al.: within a tenth of the farthest of 7 × 7 solid angles.
fn herda2003_surface(points: &[Vec3]) -> Vec<Vec3> {
    let cells = herda2003::SolidAngles { centre: herda2003::centroid(points), intervals: 7 };
    cells.surface(points, 0.1).into_iter().map(|i| points[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::figure::tests::{model, seen};
    use super::*;

    /// A ball that turns by at most 60 degrees to four sides, and twists by 40.
    const BALL: &str = r#"
        condyle = 1
        kind = "model"
        angles = "deg"
        [segment.trunk]
        [segment.arm]
        parent = "trunk"
        [joint_set.shoulder]
        coordinate.turn = { kind = "orientation" }
        component.held.cone = { orientation = "turn", rest = [0, -1, 0], twist = [-40, 40], points = [{ direction = [0.866, -0.5, 0] }, { direction = [0, -0.5, 0.866] }, { direction = [-0.866, -0.5, 0] }, { direction = [0, -0.5, -0.866] }] }
        component.ball.ball = { orientation = "held" }
        output.arm = "ball"
        "#;

    #[test]
    fn the_boundary_is_the_enforced_one_and_what_is_outside_leads_to_it() {
        let ball = model(BALL);
        let set = ball.joint_set_ids().next().expect("it is there");
        // Twisted by 70 degrees: 30 too far.
        let asked = Quat::from_axis_angle(Vec3::Y, 70f64.to_radians());
        seen(&ball, &asked.to_array(), |figure| {
            let frames: Vec<Vec<f64>> = (-80..=80)
                .map(|i| Quat::from_axis_angle(Vec3::Y, f64::from(i).to_radians()))
                .map(|q| q.to_array().to_vec())
                .collect();
            let found = figure.rotations(set, &frames).expect("a limit");
            let judged = figure.judged(set).expect("a limit");
            // Corners, and middles of triangles where the surface is not bent at an edge of the limit.
            let mesh = &found.scene.surfaces[0];
            assert!(mesh.triangles.len() > 500);
            for p in &mesh.positions {
                let p = Vec3::from(*p);
                let q = Quat { x: p.x, y: p.y, z: p.z, w: (1.0 - p.norm_squared()).sqrt() };
                assert!(
                    judged.distance(q).to_degrees().abs() < 0.1,
                    "{}",
                    judged.distance(q).to_degrees()
                );
            }
            // The path leaves at ±40 degrees: within a frame.
            let red: Vec<&Line> =
                found.scene.lines.iter().filter(|l| l.colour == palette::GAP_BROKEN).collect();
            assert_eq!(red.len(), 2);
            let ends = red.iter().flat_map(|l| &l.points).map(|p| p[1].abs());
            let nearest = ends.fold(1.0, f64::min);
            assert!((2.0 * nearest.asin().to_degrees() - 40.0).abs() < 1.0);
            let now = figure.rotation(set).expect("a rotation");
            assert_eq!(now.labels[0].text, "30.0° outside");
            let way = now.lines[0].points[1];
            assert!((Vec3::from(way) - Vec3::Y * 20f64.to_radians().sin()).norm() < 1e-9);
        });
    }
}
