//! The ribs and the sternum of the spine against the geometry that they follow from.

use crate::figure::{Figure, turns};
use condyle::Pose;
use condyle::math::{Mat3, Vec3};

/// Where ribs 1 to 7 and the sternum meet: the place on the rib, the place on the sternum.
fn gaps(spine: &Figure, pose: &Pose, rigid: bool) -> Vec<[Vec3; 2]> {
    let sides = ["r", "l"];
    let pairs = (1..=7).flat_map(|rib| sides.map(|side| (rib, side)));
    pairs
        .map(|(rib, side)| {
            let (id, on_rib) = spine.landmark(&format!("rib_{rib}_sternal_{side}"));
            let (sternum, on_sternum) = spine.landmark(&format!("sternum_rib_{rib}_{side}"));
            let s = spine.model.segment(id);
            let vertebra = pose.frame(s.parent);
            let ridden = vertebra * s.joint_in_parent * s.joint_in_segment.rigid_inverse();
            let rib_in_world = if rigid { ridden } else { pose.segment(id) };
            [rib_in_world * on_rib, pose.segment(sternum) * on_sternum]
        })
        .collect()
}

/// Root mean square of the gaps, in millimetres.
fn rms(gaps: &[[Vec3; 2]]) -> f64 {
    let sum: f64 = gaps.iter().map(|[a, b]| (*a - *b).norm_squared()).sum();
    1e3 * (sum / gaps.len() as f64).sqrt()
}

/// The gaps with the sternum where it fits the ribs best (Gauss-Newton on a rigid motion).
fn fitted(gaps: &[[Vec3; 2]]) -> Vec<[Vec3; 2]> {
    let mut fitted = gaps.to_vec();
    let count = gaps.len() as f64;
    for _ in 0..50 {
        let middle = |i: usize| fitted.iter().fold(Vec3::ZERO, |sum, g| sum + g[i]) * (1.0 / count);
        let (rib, sternum) = (middle(0), middle(1));
        // Σ [r]ᵀ[r] w = Σ r × d, with r from the middle of the sternum's places and d to the ribs.
        let mut square = [Vec3::ZERO; 3];
        let mut torque = Vec3::ZERO;
        for [a, b] in &fitted {
            let (d, r) = (*a - rib, *b - sternum);
            torque += r.cross(d - r);
            for (column, unit) in square.iter_mut().zip([Vec3::X, Vec3::Y, Vec3::Z]) {
                *column += unit * r.norm_squared() - r * r.dot(unit);
            }
        }
        let w = Mat3::from_columns(square[0], square[1], square[2]).inverse() * torque;
        let turn = match w.norm() {
            angle if angle > 1e-15 => Mat3::rotation_about(w * (1.0 / angle), angle.sin_cos()),
            _ => Mat3::IDENTITY,
        };
        for pair in &mut fitted {
            pair[1] = rib + turn * (pair[1] - sternum);
        }
    }
    fitted
}

/// Turning back, the ribs keep less than half of the gaps that they have when they are fixed to
/// their vertebrae, even if the sternum then goes where it fits them best.
#[test]
fn ribs_stay_with_the_sternum() {
    let spine = Figure::alone("spine");
    // Places are written to 0.01 mm.
    assert!(rms(&gaps(&spine, &spine.at(&[]), false)) < 0.03);
    let poses: [&[(&str, f64)]; 9] = [
        &[("thoracic_bending", 30.0)],
        &[("thoracic_bending", -30.0)],
        &[("thoracic_flexion", 30.0)],
        &[("thoracic_flexion", -30.0)],
        &[("thoracic_rotation", 30.0)],
        &[("thoracic_rotation", -30.0)],
        // All three together, at half and at the whole of their ranges.
        &[("thoracic_flexion", 7.9), ("thoracic_bending", 15.3), ("thoracic_rotation", -17.1)],
        &[("thoracic_flexion", 15.85), ("thoracic_bending", 30.6), ("thoracic_rotation", 34.2)],
        &[("thoracic_flexion", -15.85), ("thoracic_bending", 30.6), ("thoracic_rotation", -34.2)],
    ];
    for (number, degrees) in poses.into_iter().enumerate() {
        let pose = spine.at(degrees);
        let ours = rms(&gaps(&spine, &pose, false));
        let rigid = gaps(&spine, &pose, true);
        let (rigid, best) = (rms(&rigid), rms(&fitted(&rigid)));
        println!(
            "{degrees:?}: {ours:.2} mm; rigid ribs {rigid:.2}, with their own sternum {best:.2}"
        );
        assert!(ours < 0.5 * rigid, "{ours} {rigid}");
        if number < 6 {
            assert!(ours < 0.5 * best, "{ours} {best}");
        }
    }
}

/// The parts by which the ribs turn back are what the document says: a least squares solution at
/// rest.
///
/// With e the gap per radian of a coordinate and J what one more part of one rib adds to it, the
/// sum of squares is least where 2 e·J + λ part = 0 for every rib (both sides alike), and where the
/// gaps push and turn the sternum nowhere.
#[test]
fn the_parts_of_the_ribs_follow_from_the_geometry() {
    let spine = Figure::alone("spine");
    let rest = spine.at(&[]);
    let lambda = 0.016_f64.powi(2);
    let h = 1e-4;
    let motions = [("thoracic_flexion", 0), ("thoracic_bending", 1), ("thoracic_rotation", 2)];
    for (key, axis) in motions {
        let [up, down] = [h, -h].map(|value| spine.open(&spine.set(&[(key, value)])));
        let both = gaps(&spine, &up, false).into_iter().zip(gaps(&spine, &down, false));
        let rates: Vec<Vec3> = both.map(|(a, b)| (a[0] - a[1] - b[0] + b[1]) * (0.5 / h)).collect();
        for rib in 1..=7 {
            let name = format!("rib_{rib}_r");
            let id = spine.id(&name);
            let parts = turns(spine.motion(&up, id)).map(|angle| angle / h);
            let s = spine.model.segment(id);
            let joint = rest.frame(s.parent) * s.joint_in_parent;
            let (_, point) = spine.landmark(&format!("rib_{rib}_sternal_r"));
            let arm = rest.segment(id) * point - joint.translation;
            let rate = rates[2 * (rib - 1)];
            // A rib pumps in flexion, pumps and swings in bending, turns in rotation.
            let free: &[usize] = [&[0][..], &[0, 1], &[2]][axis];
            for &turn in free {
                let own = [-Vec3::Z, Vec3::X, Vec3::Y][turn];
                let added = (joint.linear * own).cross(arm);
                let slope = 2.0 * rate.dot(added) + lambda * parts[turn];
                let curve = 2.0 * added.norm_squared() + lambda;
                // Parts of 0.001, a sternum that turns by 0.001 as well: a few of them.
                assert!((slope / curve).abs() < 0.003, "{key} {name} {turn} {}", slope / curve);
            }
            for turn in (0..3).filter(|turn| !free.contains(turn)) {
                assert!(parts[turn].abs() < 1e-6, "{key} {name} {parts:?}");
            }
        }
        let push = rates.iter().fold(Vec3::ZERO, |sum, rate| sum + *rate) * (1.0 / 14.0);
        // The sternum's turn of 0.001 at an arm of 0.1 m, its centre to 0.1 mm.
        assert!(push.norm() < 0.2e-3, "{key} {push:?}");
    }
}
