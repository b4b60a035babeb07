//! Kernels in several lanes at once: each lane has the numbers that it has alone.

mod eight;

use condyle_math::function::{Curve, Function, SimmSpline};
use condyle_math::{Affine, Dual, Lane, Mat3, Quat, Scalar, SwingTwist, Vec3};
use eight::Eight;
use proptest::prelude::*;

/// Everything that a scalar can do, and what geometry makes of it.
fn everything<S: Scalar>([x, y, z]: [S; 3]) -> [S; 20] {
    let spline = SimmSpline::new(vec![-1.0, -0.2, 0.3, 1.0], vec![0.0, 0.4, -0.3, 0.1]).unwrap();
    let spline = Function { factor: 0.7, curve: Curve::SimmSpline(spline) };
    let v = Vec3::new(x, y, z);
    let turn = Quat::exp(v);
    let frame = Affine::new(turn.to_mat3() * Mat3::rotation_y(z), v);
    let moved = (frame.rigid_inverse() * frame).to_columns();
    let back = Quat::from_mat3(frame.linear).log();
    let twist = SwingTwist::of(turn, Vec3::Y.cast()).twist_angle(Vec3::Y.cast());
    let [branch, sum] = S::lane_by_lane([x, y, z], |[x, y, z]| {
        [if x.value() < y.value() { x * z } else { y / (z + S::Lane::from_f64(3.0)) }, x + y + z]
    });
    let mut all = [S::zero(); 20];
    all[..12].copy_from_slice(&moved);
    all[12..15].copy_from_slice(&back.to_array());
    all[15..].copy_from_slice(&[twist, branch, sum, spline.apply(x), y.abs().sqrt().atan2(z)]);
    all
}

proptest! {
    #[test]
    fn each_lane_has_the_numbers_that_it_has_alone(
        lanes in proptest::array::uniform8([-2.0..2.0f64, -2.0..2.0, -2.0..2.0]),
    ) {
        let [x, y, z] = [0, 1, 2].map(|k: usize| lanes.map(|lane| lane[k]));
        let together = everything([Eight(x), Eight(y), Eight(z)]);
        let seeded = |lane: usize, x: f64| Dual { value: x, partials: [lane as f64 - 3.5] };
        let duals = [x, y, z].map(|all| Eight(std::array::from_fn(|i| seeded(i, all[i]))));
        let duals_together = everything(duals);
        for (i, lane) in lanes.into_iter().enumerate() {
            let alone = everything(lane);
            let dual_alone = everything(lane.map(|x| seeded(i, x)));
            for k in 0..alone.len() {
                prop_assert_eq!(together[k].0[i].to_bits(), alone[k].to_bits(), "{} {}", i, k);
                let (one, other) = (duals_together[k].0[i], dual_alone[k]);
                prop_assert_eq!(one.value.to_bits(), other.value.to_bits(), "{} {}", i, k);
                prop_assert_eq!(one.partials[0].to_bits(), other.partials[0].to_bits());
            }
        }
    }
}
