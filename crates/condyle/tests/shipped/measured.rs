//! Limits on what is measured between the bones of the shipped shoulder: through a clavicle and a scapula
//! that move with the arm.

use crate::figure::Draws;
use condyle::formats::document;
use condyle::legal::nearest as nearest_legal;
use condyle::model::component::Law;
use condyle::{Jacobian, Mode, Model, Pose, Program, shipped};

/// What is added to the right side; the left is its mirror image. Numbers are chosen so that some poses
/// within the ranges keep each limit and others do not.
const ADDED: &str = r#"
ribs.contact.most_gap = 0.002
arm_in_thorax.relative_orientation = { segment = "humerus_r", reference = "thorax" }
reach.cone.orientation = "arm_in_thorax"
reach.cone.rest = [0.3, -1, 0.5]
reach.cone.twist = [-60, 70]
reach.cone.points = [
    { direction = [1, -0.2, 0.2], twist = [-40, 60] },
    { direction = [0.2, 0.7, 0.7] },
    { direction = [-0.6, -0.4, 0.7] },
    { direction = [-0.3, -1, -0.1] },
]
arm_angles.angles = { orientation = "arm_in_thorax", order = "yxy" }
swing.angles = { orientation = "arm_in_thorax", twist = "y" }
hollow.ellipse = { first = "arm_angles.2", second = "upward", centre = [-60, 20], half_axes = [70, 25], tilt = -20, in = "deg" }
corner.half_space = { inputs = ["swing.2", "retraction"], normal = [1, 2], bound = 80, in = "deg" }
border.relative_position = { segment = "scapula_r", reference = "thorax", point = [-0.01, -0.03, -0.11], along = [[0, 0, 1]] }
apart.half_space = { inputs = ["border"], normal = [-1], bound = -0.05 }

[joint_set.shoulder_r.output]"#;

/// Rows of one side: four of the contact, three of the cone, one of each other limit.
const ROWS: usize = 4 + 3 + 3;

fn read(text: &str) -> Model {
    let models = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let part =
        |file: &str| std::fs::read_to_string(models.join(file)).map_err(|error| error.to_string());
    document::read(text, &mut { part }).unwrap_or_else(|e| panic!("{e}")).value.model
}

fn plain() -> &'static str {
    shipped::text("shoulder").expect("it is shipped")
}

fn limited() -> Model {
    read(&plain().replace("\n[joint_set.shoulder_r.output]", ADDED))
}

/// Random poses within the ranges.
fn poses(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let mut draws = Draws(0x5eed);
    (0..count).map(|_| draws.inside(model)).collect()
}

/// The number of limit rows that the shoulder has without these.
fn own_rows() -> usize {
    Program::compile(&read(plain())).limit_row_len()
}

#[test]
fn what_is_measured_moves_nothing() {
    let (with, without) = (limited(), read(plain()));
    let programs = [&with, &without].map(Program::compile);
    assert_eq!(programs[0].limit_row_len(), own_rows() + 2 * ROWS);
    for stored in poses(&with, 200) {
        for mode in [Mode::Open, Mode::Posed] {
            let [a, b] = [0, 1].map(|i: usize| {
                let mut pose = Pose::new(&programs[i]);
                programs[i].evaluate(&stored, mode, &mut pose).unwrap();
                pose
            });
            // A transform that measures read as well has a register of its own, so that products are
            // grouped otherwise.
            let rows = |pose: &Pose| pose.segments().iter().flat_map(|t| t.to_rows()).collect();
            let [a_rows, b_rows]: [Vec<f64>; 2] = [rows(&a), rows(&b)];
            for (a, b) in a_rows.iter().zip(&b_rows) {
                assert!((a - b).abs() < 1e-14, "{a} {b}");
            }
            assert_eq!(a.effective(), b.effective());
        }
    }
}

#[test]
fn slopes_equal_central_differences() {
    let model = limited();
    let program = Program::compile(&model);
    let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
    let (mut compared, mut kinks, mut broken) = (0, 0, vec![0; program.limit_row_len()]);
    let h = 1e-5;
    for stored in poses(&model, 100) {
        program.evaluate_with_jacobian(&stored, &mut pose, &mut jacobian).unwrap();
        let here: Vec<f64> = (0..program.limit_row_len()).map(|row| pose.limit_row(row)).collect();
        let at = |direction: usize, step: f64| {
            let mut moved = stored.clone();
            moved[direction] += step;
            let mut pose = Pose::new(&program);
            program.evaluate(&moved, Mode::Open, &mut pose).unwrap();
            (0..here.len()).map(|row| pose.limit_row(row)).collect::<Vec<f64>>()
        };
        for direction in 0..program.tangent_len() {
            let [far_behind, behind, ahead, far_ahead] =
                [-2.0 * h, -h, h, 2.0 * h].map(|step| at(direction, step));
            for row in 0..here.len() {
                let own = program.limit_row_directions(row).iter();
                let exact: f64 = own
                    .filter(|(d, _)| *d as usize == direction)
                    .map(|(_, slot)| jacobian.derivative(*slot))
                    .sum();
                // Four points, so that the error is of order h⁴.
                let difference = (8.0 * (ahead[row] - behind[row])
                    - (far_ahead[row] - far_behind[row]))
                    / (12.0 * h);
                // Where the two sides differ there is a kink.
                let sides = [(ahead[row] - here[row]) / h, (here[row] - behind[row]) / h];
                if (sides[0] - sides[1]).abs() > 1e-3 * (1.0 + exact.abs()) {
                    kinks += 1;
                    continue;
                }
                let off = (exact - difference).abs();
                assert!(off < 1e-7 * (1.0 + exact.abs()), "row {row}: {exact} {difference}");
                compared += 1;
            }
        }
        for (count, value) in broken.iter_mut().zip(here) {
            *count += usize::from(value < 0.0);
        }
    }
    assert!(compared > 20 * kinks && compared > 20_000, "{compared} compared, {kinks} kinks");
    // Each of these limits is broken by some pose and kept by another; of the gaps only one side is met.
    let met = broken.iter().filter(|&&count| count > 0 && count < 100).count();
    assert!(met >= 2 * (ROWS - 3), "{broken:?}");
}

#[test]
fn both_sides_have_the_same_rows() {
    let model = limited();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    // Rows are in the order of their components, those of a side together.
    let components = model.components().iter().filter(|c| match &c.law {
        Law::Contact(_) | Law::Depend(_) => true,
        law => law.limit().is_some(),
    });
    assert_eq!(components.count() % 2, 0);
    for mut stored in poses(&model, 50) {
        for id in model.coordinate_ids() {
            if let Some(stem) = model.coordinate(id).name.strip_suffix("_l") {
                let right = model.find_coordinate(&format!("{stem}_r")).unwrap();
                stored[model.stored_range(id).start] = stored[model.stored_range(right).start];
            }
        }
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let mut rows: Vec<f64> =
            (0..program.limit_row_len()).map(|row| pose.limit_row(row)).collect();
        rows.sort_by(f64::total_cmp);
        // Each value is there twice.
        for pair in rows.chunks(2) {
            assert!((pair[0] - pair[1]).abs() < 1e-9, "{pair:?}");
        }
    }
}

#[test]
fn no_legal_pose_found_by_chance_is_nearer() {
    let model = limited();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut worst = |stored: &[f64]| {
        program.evaluate(stored, Mode::Open, &mut pose).unwrap();
        (0..program.limit_row_len()).map(|row| pose.limit_row(row)).fold(f64::INFINITY, f64::min)
    };
    let mut draws = Draws(0xbead);
    let far =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let (mut solved, mut tried) = (0, 0);
    for asked in poses(&model, 12) {
        let Some(found) = nearest_legal(&model, &asked) else {
            assert!(worst(&asked) >= -1e-9);
            continue;
        };
        let row = worst(&found);
        assert!(row > -1e-7, "{row}");
        solved += 1;
        let own = far(&found, &asked);
        // Poses on a ball about the asked one that is as large, and about the found one, ever closer.
        for k in 0..2000 {
            let size = own * 0.5f64.powi(k % 12);
            let from = if k % 2 == 0 { &asked } else { &found };
            let near: Vec<f64> = model
                .coordinate_ids()
                .map(|id| {
                    let at = model.stored_range(id).start;
                    model
                        .coordinate(id)
                        .range
                        .nearest(from[at] + size * (2.0 * draws.share() - 1.0))
                })
                .collect();
            if worst(&near) >= 0.0 {
                tried += 1;
                let other = far(&near, &asked);
                assert!(other > own - 1e-5, "{own} {other}: {found:?} {near:?}");
            }
        }
    }
    assert!(solved > 6 && tried > 500, "{solved} solved, {tried} others tried");
}
