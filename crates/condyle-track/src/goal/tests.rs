//! Every kind of goal on random trees: the derivatives of its residuals and the gradient of its squares
//! against central differences, its Hessian, where residuals vanish and Gauss and Newton's is exact,
//! against those of its gradient; and the same of rest.

use super::problem::{Descent, Stage};
use super::question::Question;
use super::{Aim, Anchor, Goal, Goals, Side};
use crate::target::PostureTarget;
use crate::target::tests::{Dice, tree};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program, SegmentId};

/// One goal of each kind that is met, or all but met, at a pose; that of two segments refers to others.
fn met_at(model: &Model, stored: &[f64], dice: &mut Dice) -> Vec<Aim> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Open, &mut pose).unwrap();
    let rigid: Vec<SegmentId> = model.segment_ids().filter(|&id| !program.deforms(id)).collect();
    let mut pick = |list: &[SegmentId]| list[(dice.next().abs() * list.len() as f64) as usize];
    let all: Vec<SegmentId> = model.segment_ids().collect();
    let a = pick(&all);
    let [c, d] = [pick(&rigid), pick(&rigid)];
    // Sight of a point of the same segment does not change.
    let others: Vec<SegmentId> = all.iter().copied().filter(|&id| id != c).collect();
    let b = pick(&others);
    let point: Anchor = (Some(a), dice.vector());
    let place = pose.segment(a) * point.1;
    let in_segment = |id: SegmentId, p: Vec3| {
        let frame = pose.segment(id);
        frame.linear.inverse() * (p - frame.translation)
    };
    let [turned, other] = [c, d].map(|id| pose.segment(id).linear);
    let axis = dice.vector();
    let along = (turned * axis).normalized();
    let far = (Some(b), dice.vector());
    let through = dice.vector();
    let eye = pose.segment(c) * through;
    let coordinate = model.coordinate_ids().last().unwrap();
    let plane = |side, shift: f64| {
        let normal = dice_normal(along);
        let on = place - normal * shift;
        let origin = (Some(d), in_segment(d, on));
        Aim::Plane { point, origin, normal: other.transpose() * normal * 2.0, side }
    };
    vec![
        Aim::Point { point, at: (None, place) },
        Aim::Point { point, at: (Some(b), in_segment(b, place)) },
        Aim::Distance { points: [point, far], distance: (place - pose.segment(b) * far.1).norm() },
        Aim::Orientation { segment: c, relative_to: None, rotation: Quat::from_mat3(turned) },
        Aim::Orientation {
            segment: c,
            relative_to: Some(d),
            rotation: Quat::from_mat3(other.transpose() * turned),
        },
        Aim::Axis { segment: c, axis, relative_to: None, along: along * 0.3 },
        Aim::Axis { segment: c, axis, relative_to: Some(d), along: other.transpose() * along },
        Aim::Look { segment: c, axis, through, at: (None, eye + along * 1.7) },
        Aim::Look { segment: c, axis, through, at: (Some(b), in_segment(b, eye + along * 1.7)) },
        plane(Side::On, 0.0),
        plane(Side::Above, -1e-12),
        Aim::Coordinate { coordinate, value: model.value(stored, coordinate) },
    ]
}

/// A direction that is not that of `along`.
fn dice_normal(along: Vec3) -> Vec3 {
    (along + Vec3::new(0.4, -0.7, 0.2)).normalized()
}

/// What rounding of values about 1 leaves of a quotient over [`STEP`], where no coordinate moves a goal.
const ROUNDING: f64 = 1e-9;
const STEP: f64 = 1e-5;

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

#[test]
fn derivatives_are_those_of_the_values() {
    for seed in 0..40 {
        let mut dice = Dice(!seed);
        let model = tree(seed, Vec3::ZERO);
        let random = |from: &[f64], size: f64, dice: &mut Dice| {
            let along: Vec<f64> = (0..model.tangent_len()).map(|_| size * dice.next()).collect();
            let mut to = from.to_vec();
            model.retract(from, &along, &mut to);
            to
        };
        let rest = random(&model.defaults(), 0.6, &mut dice);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        program.evaluate(&rest, Mode::Open, &mut pose).unwrap();
        // As coupled coordinates really are.
        let rest = pose.effective().to_vec();
        let aims = met_at(&model, &rest, &mut dice);
        let mut of_rest = Goals::of(&model);
        of_rest.rest.pose = rest.clone();
        of_rest.rest.stiffness.iter_mut().for_each(|k| *k = 0.5 + dice.next().abs());
        let numbers = model
            .coordinate_ids()
            .filter(|&id| model.coordinate(id).kind != CoordinateKind::Orientation);
        let terms: Vec<_> = numbers.map(|id| (id, dice.next())).collect();
        let sum = terms.iter().map(|&(id, factor)| factor * model.value(&rest, id)).sum();
        of_rest.rest.sums = vec![PostureTarget { terms, rest: sum, stiffness: 0.3 }];
        let nothing = Stage {
            exact: Some(1.0),
            weighted: 1.0,
            rest: 0.0,
            near: of_rest.rest.clone(),
            curved: false,
        };
        let mut asked: Vec<(Goals, Stage)> = aims
            .into_iter()
            .map(|aim| {
                let goals = vec![Goal { aim, weight: Some(0.7) }];
                (Goals { goals, ..Goals::of(&model) }, nothing.clone())
            })
            .collect();
        asked.push((of_rest, Stage { rest: 1.0, ..nothing }));
        for (kind, (goals, stage)) in asked.iter().enumerate() {
            let question = Question::new(&model, goals);
            let n = question.unknown_len();
            let mut descent = Descent::new(&question, stage.clone(), &rest);
            let moved = |from: &[f64], unknown: usize, step: f64| {
                let mut along = vec![0.0; model.tangent_len()];
                along[question.directions[unknown]] = step;
                let mut to = from.to_vec();
                model.retract(from, &along, &mut to);
                to
            };
            let away = random(&rest, 0.3, &mut dice);
            descent.evaluate_at(&away);
            let slopes = descent.goal_rows();
            let mut gradient = vec![0.0; n];
            descent.gradient(&mut gradient);
            let value = descent.objective();
            let one_sided = goals.goals.iter().any(|goal| goal.aim.is_one_sided());
            let still = one_sided || largest(&slopes) < ROUNDING;
            assert!(value > 0.0 || still, "{seed}: kind {kind} says nothing");
            let mut exact = vec![0.0; n * n];
            descent.evaluate_at(&rest);
            descent.hessian(&mut exact);
            for i in 0..n {
                let mut at = |from: &[f64], sign: f64| {
                    descent.evaluate_at(&moved(from, i, sign * STEP));
                    let mut gradient = vec![0.0; n];
                    descent.gradient(&mut gradient);
                    (descent.objective(), descent.residuals.clone(), gradient)
                };
                let (ahead, behind) = (at(&away, 1.0), at(&away, -1.0));
                for row in 0..ahead.1.len() {
                    let slope = (ahead.1[row] - behind.1[row]) / (2.0 * STEP);
                    let off = (slope - slopes[row * n + i]).abs();
                    assert!(
                        off < 1e-7 * largest(&slopes) + ROUNDING,
                        "{seed} kind {kind} {row}, {i}: {off}"
                    );
                }
                let slope = (ahead.0 - behind.0) / (2.0 * STEP);
                let off = (slope - gradient[i]).abs();
                assert!(
                    off < 1e-7 * largest(&gradient) + ROUNDING,
                    "{seed} kind {kind} {i}: {off}"
                );
                // The square of one side has a kink in its slope where it begins.
                if one_sided {
                    continue;
                }
                let (ahead, behind) = (at(&rest, 1.0).2, at(&rest, -1.0).2);
                for row in i..n {
                    let off =
                        ((ahead[row] - behind[row]) / (2.0 * STEP) - exact[row * n + i]).abs();
                    assert!(
                        off < 1e-7 * largest(&exact) + ROUNDING,
                        "{seed} kind {kind} {row}, {i}: {off}"
                    );
                }
            }
        }
    }
}
