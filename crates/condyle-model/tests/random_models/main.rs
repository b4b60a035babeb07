//! Random trees with all components, against a naive reference and against finite differences.

mod backend;
mod grow;
mod naive;
mod scan;
mod suite;

use condyle_math::{Affine, Dual, Mat3, Vec3};
use condyle_model::evaluate::ClosureRows;
use condyle_model::model::Condition;
use condyle_model::{Jacobian, Mode, Model, Pose, Program};

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

/// Trees in each test.
const TREES: u64 = 1000;

#[test]
fn the_program_conforms() {
    suite::conforms(&backend::PLAIN);
}

#[test]
fn numbers_with_derivatives_conform() {
    suite::conforms(&backend::DUAL);
    suite::equals(&backend::DUAL, &backend::PLAIN);
}

#[test]
fn eight_postures_at_once_conform() {
    suite::conforms(&backend::EIGHT);
    suite::equals(&backend::EIGHT, &backend::PLAIN);
}

#[test]
fn the_jacobian_equals_central_differences_and_duals() {
    let (mut rows, mut points, mut kinks) = (0, 0, 0);
    for seed in 0..TREES {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let mut plain = Pose::new(&program);
        program.evaluate(&stored, Mode::Open, &mut plain).unwrap();
        assert_eq!(plain.segments(), pose.segments());

        let h = 1e-6;
        let point = Vec3::new(0.03, -0.11, 0.07);
        let mut dual_pose = Pose::<Dual<1>>::new(&program);
        for direction in 0..program.tangent_len() {
            let mut ahead = Pose::new(&program);
            let mut behind = Pose::new(&program);
            program
                .evaluate(&retract(&model, &stored, direction, h), Mode::Open, &mut ahead)
                .unwrap();
            program
                .evaluate(&retract(&model, &stored, direction, -h), Mode::Open, &mut behind)
                .unwrap();
            // Seeded with the derivative of the retraction, the dual evaluation is exact.
            let slope: Vec<f64> = retract(&model, &stored, direction, 1e-5)
                .iter()
                .zip(retract(&model, &stored, direction, -1e-5))
                .map(|(a, b)| (a - b) / 2e-5)
                .collect();
            let seeded: Vec<Dual<1>> =
                stored.iter().zip(slope).map(|(&value, s)| Dual { value, partials: [s] }).collect();
            program.evaluate(&seeded, Mode::Open, &mut dual_pose).unwrap();
            for row in 0..program.limit_row_len() {
                let exact = program
                    .limit_row_directions(row)
                    .iter()
                    .filter(|(d, _)| *d as usize == direction)
                    .map(|(_, slot)| jacobian.derivative(*slot))
                    .sum::<f64>();
                let (up, here, down) =
                    (ahead.limit_row(row), plain.limit_row(row), behind.limit_row(row));
                // Where the two sides differ there is a kink: a corner of a cone, a free twist.
                let sides = [(up - here) / h, (here - down) / h];
                if (sides[0] - sides[1]).abs() < 1e-3 * (1.0 + exact.abs()) {
                    let difference = (up - down) * (0.5 / h);
                    assert!(
                        (exact - difference).abs() < 1e-7 * (1.0 + exact.abs()),
                        "seed {seed}: row {row} {direction}: {exact} {difference}"
                    );
                    rows += 1;
                }
                let dual = dual_pose.limit_row(row).partials[0];
                assert!(
                    (exact - dual).abs() < 1e-9 * (1.0 + exact.abs()),
                    "seed {seed}: row {row}"
                );
            }
            for id in model.segment_ids() {
                let world = pose.segment(id) * point;
                let mut exact = Vec3::ZERO;
                jacobian.visit_point(&program, Some(id), world, |d, v| {
                    if d == direction {
                        exact = v;
                    }
                });
                let [up, down] = [&ahead, &behind].map(|pose| pose.segment(id) * point);
                let difference = (up - down) * (0.5 / h);
                let size = 1.0 + exact.norm() + world.norm();
                // Near singular angles the slope changes fast, as at a kink.
                let sides = (up - world) - (world - down);
                if sides.norm() < 1e-4 * h * size {
                    points += 1;
                    assert!(
                        (exact - difference).norm() < 1e-7 * size,
                        "seed {seed}: {direction} {id:?}: {exact:?} {difference:?}"
                    );
                } else {
                    kinks += 1;
                }
                let dual = dual_pose.segment(id) * point.cast();
                let dual = Vec3::new(dual.x.partials[0], dual.y.partials[0], dual.z.partials[0]);
                assert!((exact - dual).norm() < 1e-9 * size, "seed {seed}: {direction} {id:?}");
            }
        }
    }
    assert!(rows > 1000, "only {rows} rows away from kinks");
    assert!(points > 10_000 && kinks * 200 < points, "{points} points, {kinks} at kinks");
}

#[test]
fn rows_of_closures_equal_central_differences() {
    let (mut rows, mut led) = (0, 0);
    for seed in 0..TREES {
        let (model, stored) = grow::random_model_with_loops(seed);
        let program = Program::compile(&model);
        let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let mut exact = ClosureRows::new(&model);
        exact.update(&model, &program, &pose, Some(&jacobian));
        let h = 1e-6;
        let mut twin = ClosureRows::new(&model);
        for direction in 0..model.tangent_len() {
            let [ahead, behind] = [h, -h].map(|step| {
                let moved = retract(&model, &stored, direction, step);
                program.evaluate(&moved, Mode::Open, &mut pose).unwrap();
                twin.update(&model, &program, &pose, None);
                twin.residuals.clone()
            });
            let mut row = 0;
            for closure in model.closures() {
                let own = row..row + closure.condition.rows();
                row = own.end;
                let smooth = match &closure.condition {
                    // The rotation between two frames has a kink at half a turn, a distance at 0.
                    Condition::Frames { .. } => {
                        let turn = &exact.residuals[own.start + 3..own.end];
                        let turn = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
                        turn < 3.0
                    }
                    Condition::Distance { distance, .. } => {
                        exact.residuals[own.start] + distance > 1e-3
                    }
                    Condition::Coupling { follower, driver, .. } => {
                        let follows = |&id: &_| model.coordinate(id).follows.is_some();
                        led += usize::from([*follower, *driver].iter().any(follows));
                        true
                    }
                    Condition::Points { .. } => true,
                };
                for row in own.filter(|_| smooth) {
                    let difference = (ahead[row] - behind[row]) * (0.5 / h);
                    let found = exact.row(row)[direction];
                    let size = 1.0 + found.abs() + exact.residuals[row].abs();
                    assert!(
                        (found - difference).abs() < 1e-6 * size,
                        "seed {seed}: row {row} along {direction}: {found} {difference}"
                    );
                    rows += 1;
                }
            }
        }
    }
    assert!(rows > 10_000 && led > 1000, "only {rows} slopes, {led} of couplings that are led");
}

#[test]
fn normals_stay_perpendicular_to_what_is_stretched() {
    let mut stretched = 0;
    for seed in 0..TREES {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        program.evaluate(&stored, Mode::Posed, &mut pose).unwrap();
        for id in model.segment_ids() {
            let (linear, normal) = (pose.segment(id).linear, pose.normal(id));
            stretched += usize::from(program.deforms(id));
            // The normal of one plane of axes, carried, is perpendicular to the carried axes in it, and
            // its product with its own carried axis is 1: together they are all entries.
            for i in 0..9 {
                let [n, v] = [Vec3::UNITS[i / 3], Vec3::UNITS[i % 3]];
                let (n, v) = (normal * n, linear * v);
                let off = n.dot(v) - if i / 3 == i % 3 { 1.0 } else { 0.0 };
                assert!(
                    off.abs() < 1e-9 * (1.0 + n.norm() * v.norm()),
                    "seed {seed} {id:?}: {off}"
                );
            }
        }
    }
    assert!(stretched > 500, "only {stretched} segments were stretched");
}

#[test]
fn a_world_placed_elsewhere_carries_everything_along() {
    let camera = Affine::new(
        Mat3::rotation_about(Vec3::new(0.6, 0.0, 0.8), 0.9f64.sin_cos()),
        Vec3::new(0.3, -1.2, 4.0),
    );
    for seed in 0..TREES {
        let (model, stored) = grow::random_model(seed);
        let program = Program::compile(&model);
        let (mut here, mut there) = (Pose::new(&program), Pose::new(&program));
        there.place(camera);
        program.evaluate(&stored, Mode::Posed, &mut here).unwrap();
        program.evaluate(&stored, Mode::Posed, &mut there).unwrap();
        for id in model.segment_ids() {
            let expected = camera * here.segment(id);
            let size = 1.0 + expected.translation.norm();
            assert!(difference(there.segment(id), expected) < 1e-12 * size, "seed {seed} {id:?}");
        }
    }
}

#[test]
fn a_million_poses_are_finite_whatever_is_asked() {
    suite::stays_finite(&backend::PLAIN, 1000);
}

#[test]
fn a_list_of_the_wrong_length_is_refused() {
    let (model, stored) = grow::random_model(0);
    let program = Program::compile(&model);
    let longer = vec![0.0; stored.len() + 1];
    let wrong = program.evaluate(&longer, Mode::Open, &mut Pose::new(&program));
    assert_eq!(wrong.unwrap_err().found, stored.len() + 1);
}
