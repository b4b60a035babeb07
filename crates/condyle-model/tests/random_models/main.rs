//! Random trees that mix every component, against a naive twin and against differences.

mod grow;
mod naive;

use condyle_math::{Affine, Dual, Vec3};
use condyle_model::{Jacobian, Mode, Model, Pose, Program};
use proptest::prelude::*;

/// Largest difference of any entry of two transforms.
fn difference(a: Affine, b: Affine) -> f64 {
    a.to_rows().iter().zip(b.to_rows()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The stored numbers after a step in one direction.
fn retract(model: &Model, stored: &[f64], direction: usize, step: f64) -> Vec<f64> {
    let (mut moved, mut along) = (stored.to_vec(), vec![0.0; model.tangent_len()]);
    along[direction] = step;
    model.retract(stored, &along, &mut moved);
    moved
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_program_equals_the_naive_evaluator(seed in any::<u64>()) {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for mode in [Mode::Open, Mode::Posed] {
            program.evaluate(&stored, mode, &mut pose).unwrap();
            let twin = naive::Evaluator::new(&model, &stored, mode);
            for id in model.segment_ids() {
                let expected = twin.segment(id);
                let scale = 1.0 + expected.translation.norm();
                prop_assert!(difference(pose.segment(id), expected) < 1e-12 * scale);
            }
            for id in model.coordinate_ids() {
                let effective = twin.coordinate(id);
                for (a, b) in pose.coordinate(&model, id).iter().zip(effective) {
                    prop_assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()));
                }
            }
        }
    }

    #[test]
    fn legal_coordinates_give_the_same_pose_in_both_modes(seed in any::<u64>()) {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let (mut open, mut posed) = (Pose::new(&program), Pose::new(&program));
        program.evaluate(&stored, Mode::Posed, &mut posed).unwrap();
        let within = posed.effective().to_vec();
        program.evaluate(&within, Mode::Open, &mut open).unwrap();
        // Ranges are met; the rows say whether every other limit is.
        let legal = (0..program.limit_row_len()).all(|row| open.limit_row(row) >= 0.0);
        if legal {
            prop_assert_eq!(open.segments(), posed.segments());
        }
    }

    #[test]
    fn the_jacobian_equals_central_differences_and_duals(seed in any::<u64>()) {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let mut plain = Pose::new(&program);
        program.evaluate(&stored, Mode::Open, &mut plain).unwrap();
        prop_assert_eq!(plain.segments(), pose.segments());

        let h = 1e-6;
        let point = Vec3::new(0.03, -0.11, 0.07);
        let mut dual_pose = Pose::<Dual<1>>::new(&program);
        for direction in 0..program.tangent_len() {
            let mut ahead = Pose::new(&program);
            let mut behind = Pose::new(&program);
            program.evaluate(&retract(&model, &stored, direction, h), Mode::Open, &mut ahead).unwrap();
            program.evaluate(&retract(&model, &stored, direction, -h), Mode::Open, &mut behind).unwrap();
            // Seeding the stored numbers with the retraction's slope makes the dual answer exact.
            let slope: Vec<f64> = retract(&model, &stored, direction, 1e-5).iter()
                .zip(retract(&model, &stored, direction, -1e-5))
                .map(|(a, b)| (a - b) / 2e-5).collect();
            let seeded: Vec<Dual<1>> = stored.iter().zip(slope)
                .map(|(&value, s)| Dual { value, partials: [s] }).collect();
            program.evaluate(&seeded, Mode::Open, &mut dual_pose).unwrap();
            for id in model.segment_ids() {
                let world = pose.segment(id) * point;
                let mut exact = Vec3::ZERO;
                jacobian.visit_point(&program, Some(id), world, |d, v| {
                    if d == direction { exact = v; }
                });
                let difference =
                    (ahead.segment(id) * point - behind.segment(id) * point) * (0.5 / h);
                let size = 1.0 + exact.norm() + world.norm();
                prop_assert!((exact - difference).norm() < 1e-7 * size, "{direction} {id:?}");
                let dual = dual_pose.segment(id) * point.cast();
                let dual = Vec3::new(dual.x.partials[0], dual.y.partials[0], dual.z.partials[0]);
                prop_assert!((exact - dual).norm() < 1e-9 * size, "{direction} {id:?}");
            }
        }
    }
}

#[test]
fn absurd_numbers_pose_without_a_panic() {
    for seed in 0..200 {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        for absurd in [0.0, -0.0, 1e300, -1e300, f64::INFINITY, f64::NAN, 1e-320] {
            let coordinates = vec![absurd; stored.len()];
            program.evaluate(&coordinates, Mode::Open, &mut pose).unwrap();
            program.evaluate(&coordinates, Mode::Posed, &mut pose).unwrap();
        }
        let wrong = program.evaluate(&vec![0.0; stored.len() + 1], Mode::Open, &mut pose);
        assert_eq!(wrong.unwrap_err().found, stored.len() + 1);
    }
}
