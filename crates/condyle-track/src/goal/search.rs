//! From which starts, and in which stages, a pose is looked for.

use super::answer::{Answer, By, Miss};
use super::determined;
use super::problem::{Descent, Stage};
use super::question::Question;
use super::{Goals, Rest};
use condyle_math::Quat;
use condyle_model::{CoordinateKind, Model};
use condyle_solve::least_squares::{Stop, Stopping, Summary};
use std::f64::consts::PI;

/// How many starts there are beside rest.
const STARTS: u32 = 12;
/// A first descent draws near: goals as squares, so that a radian off rest weighs as much as a
/// millimetre of a goal.
const NEAR: Stopping =
    Stopping { tolerance: 1e-5, floor: 1e-16, feasibility: 1e-6, iterations: 100, trust: 0.5 };
/// The last one goes on until steps are rounding.
pub(super) const CLOSE: Stopping =
    Stopping { tolerance: 1e-21, floor: 1e-28, feasibility: 1e-10, iterations: 200, trust: 0.5 };
/// One that follows what is dragged: to a tenth of a millimetre, within the time between two pictures.
const FOLLOWING: Stopping =
    Stopping { tolerance: 1e-9, floor: 1e-12, feasibility: 1e-9, iterations: 24, trust: 0.5 };
/// How much less rest counts where goals cannot be met.
const LITTLE: f64 = 1e-4;
/// The stiffness about a pose that is kept where nothing else says anything.
const KEPT: f64 = 1e-9;
/// Of two answers the later is taken if it is nearer to rest, or misses less, by this share.
const BETTER: f64 = 1e-7;

/// Of the places to which first descents come, so many different ones are followed to the end.
const FOLLOWED: usize = 4;
/// Two places are the same if no coordinate differs by more than this, in radians or metres.
const SAME: f64 = 1e-3;

/// One descent's end.
pub(super) struct End {
    pub stored: Vec<f64>,
    /// What was minimised.
    pub value: f64,
    pub(super) answer: Answer,
}

/// The legal pose nearest to rest that meets the goals, else the one that misses them least.
///
/// # Panics
/// If the goals name segments or coordinates that the model does not have, or the rest pose has not as
/// many numbers as the model stores.
pub fn solve(model: &Model, goals: &Goals) -> Answer {
    let question = Question::new(model, goals);
    let as_asked = |exact: Option<f64>| Stage {
        exact,
        weighted: 1.0,
        rest: 1.0,
        near: goals.rest.clone(),
        curved: exact.is_none(),
    };
    let starts = if question.unknown_len() == 0 { 0 } else { 1 + STARTS };
    let drawn = |start| descend(&question, as_asked(Some(1.0)), &start_of(&question, start), &NEAR);
    let mut near: Vec<End> = (0..starts).filter_map(drawn).collect();
    let closed = |end: &End| end.answer.closure_error <= super::MET;
    near.sort_by(|a, b| closed(b).cmp(&closed(a)).then(a.value.total_cmp(&b.value)));
    let mut iterations: u32 = near.iter().map(|end| end.answer.iterations).sum();
    let mut different: Vec<End> = vec![];
    for end in near {
        let off = |other: &End| {
            let both = end.stored.iter().zip(&other.stored);
            both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        if different.len() < FOLLOWED && different.iter().all(|other| off(other) > SAME) {
            different.push(end);
        }
    }
    let mut met: Option<End> = None;
    for near in &different {
        // A pose that meets goals costs more than the one near it that need not.
        if met.as_ref().is_some_and(|met| near.value >= met.value) {
            break;
        }
        let Some(exact) = descend(&question, as_asked(None), &near.stored, &CLOSE) else {
            continue;
        };
        iterations += exact.answer.iterations;
        let nearer = |met: &End| exact.value < met.value * (1.0 - BETTER);
        if exact.answer.is_met() && met.as_ref().is_none_or(nearer) {
            met = Some(exact);
        }
    }
    let near =
        different.into_iter().reduce(|best, end| match misses_less(&end.answer, &best.answer) {
            true => end,
            false => best,
        });
    let mut end = match (met, near) {
        (Some(met), _) => met,
        (None, Some(near)) => {
            let (end, more) = least_missed(&question, near);
            iterations += more;
            end
        }
        // Nothing can move, or be evaluated: the rest pose with what it lacks.
        (None, None) => {
            let stored = goals.rest.pose.clone();
            let mut descent = Descent::new(&question, as_asked(None), &stored);
            descent.evaluate_at(&stored);
            let by = vec![By::Rest; question.unknown_len()];
            let by = determined::of_coordinates(&question, &by);
            let answer = answer(&descent, 0, by);
            End { stored, value: f64::NAN, answer }
        }
    };
    end.answer.starts = starts;
    end.answer.iterations = iterations;
    end.answer
}

/// The legal pose to which one descent comes from `start`, goals without a weight as squares of weight 1: for who moves a
/// goal a little at a time, as one that drags a hand does.
///
/// It is one descent where [`solve`] has thirteen and more, so that it answers in milliseconds; it misses a goal by what
/// nearness to rest takes of it, a fraction of a millimetre, and stays on its side of what it cannot pass.
/// `None` where nothing can be evaluated.
///
/// # Panics
/// As [`solve`]; if `start` has not as many numbers as the model stores.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_track::goal::{Aim, Goal, Goals, follow};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build().unwrap();
/// let wrist = (Some(forearm), Vec3::new(0.25, 0.0, 0.0));
/// let aim = Aim::Point { point: wrist, at: (None, Vec3::new(0.15, 0.20, 0.0)) };
/// let mut goals = Goals::of(&model);
/// goals.goals.push(Goal { aim, weight: None });
/// let answer = follow(&model, &goals, &[0.8]).unwrap();
/// assert!((answer.coordinates[0] - f64::atan2(0.20, 0.15)).abs() < 1e-4);
/// ```
pub fn follow(model: &Model, goals: &Goals, start: &[f64]) -> Option<Answer> {
    let question = Question::new(model, goals);
    let stage = Stage {
        exact: Some(1.0),
        weighted: 1.0,
        rest: 1.0,
        near: goals.rest.clone(),
        curved: false,
    };
    descend(&question, stage, start, &FOLLOWING).map(|end| end.answer)
}

/// What goals lack at a pose, in their order; nothing is moved.
///
/// # Panics
/// If `stored` has not as many numbers as the model stores.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_track::goal::{Aim, Goal, Goals, misses};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build().unwrap();
/// let wrist = (Some(forearm), Vec3::new(0.25, 0.0, 0.0));
/// let aim = Aim::Point { point: wrist, at: (None, Vec3::new(0.25, 0.10, 0.0)) };
/// let mut goals = Goals::of(&model);
/// goals.goals.push(Goal { aim, weight: None });
/// assert_eq!(misses(&model, &goals, &[0.0])[0].off, 0.10);
/// ```
pub fn misses(model: &Model, goals: &Goals, stored: &[f64]) -> Vec<Miss> {
    let question = Question::new(model, goals);
    let stage = Stage {
        exact: Some(1.0),
        weighted: 1.0,
        rest: 1.0,
        near: goals.rest.clone(),
        curved: false,
    };
    let mut descent = Descent::new(&question, stage, stored);
    descent.evaluate_at(stored);
    answer(&descent, 0, vec![]).misses
}

/// Whether an answer has loops closed where another has not, or misses the goals by less.
fn misses_less(a: &Answer, b: &Answer) -> bool {
    let closed = |answer: &Answer| answer.closure_error <= super::MET;
    match (closed(a), closed(b)) {
        (true, false) => true,
        (false, true) => false,
        _ => a.missed() < b.missed() * (1.0 - 1e-3) - 1e-6,
    }
}

/// The pose that misses the goals least, from one that is near it.
///
/// Rest counts little at first; then only the pose at hand is kept where the goals say nothing, again
/// and again, so that rest takes nothing from the goals.
fn least_missed(question: &Question<'_>, mut end: End) -> (End, u32) {
    let mut iterations = 0;
    let near = question.goals.rest.clone();
    let first = Stage {
        exact: Some(1.0),
        weighted: LITTLE,
        rest: LITTLE,
        near: near.clone(),
        curved: true,
    };
    let mut stage = first.clone();
    for _ in 0..4 {
        if let Some(next) = descend(question, stage.clone(), &end.stored, &CLOSE) {
            iterations += next.answer.iterations;
            let closed = next.answer.closure_error <= super::MET.max(end.answer.closure_error);
            if closed && next.answer.missed() <= end.answer.missed() {
                end = next;
            }
        }
        let stiffness = vec![KEPT; near.stiffness.len()];
        let near = Rest { pose: end.stored.clone(), stiffness, sums: vec![] };
        stage = Stage { weighted: 0.0, rest: 1.0, near, ..stage };
    }
    // R is measured by the rest that was asked for.
    let mut descent = Descent::new(question, Stage { rest: 1.0, ..first }, &end.stored);
    descent.evaluate_at(&end.stored);
    end.answer.rest = descent.rest_value();
    (end, iterations)
}

/// Descends from a start; `None` where nothing can be evaluated.
pub(super) fn descend(
    question: &Question<'_>,
    stage: Stage,
    start: &[f64],
    stopping: &Stopping,
) -> Option<End> {
    let mut descent = Descent::new(question, stage, start);
    let mut solver = descent.solver();
    let summary: Summary = solver.minimise(&mut descent, stopping);
    if summary.stop == Stop::NotFinite && !summary.objective.is_finite() {
        return None;
    }
    let stored = descent.current.clone();
    descent.evaluate_at(&stored);
    let by = determined::judge(&descent);
    let answer = answer(&descent, summary.iterations, by);
    Some(End { stored, value: summary.objective, answer })
}

/// The answer at the pose that was evaluated last.
fn answer(descent: &Descent<'_>, iterations: u32, by: Vec<By>) -> Answer {
    let question = descent.question;
    let goals = question.goals.goals.iter().enumerate();
    let misses = goals.map(|(i, goal)| {
        let squares = question.rows_of(i).map(|row| descent.residuals[row].powi(2));
        let off = squares.sum::<f64>().sqrt();
        Miss {
            off: if descent.is_met_aside(i) { 0.0 } else { off },
            angle: goal.aim.is_angle(question.model),
            weighted: goal.weight.is_some(),
        }
    });
    let closures = descent.closures.residuals.iter();
    Answer {
        coordinates: descent.pose.effective().to_vec(),
        misses: misses.collect(),
        rest: descent.rest_value(),
        closure_error: closures.fold(0.0, |m: f64, c| m.max(c.abs())),
        by,
        starts: 1,
        iterations,
    }
}

/// Rest for start 0; for each other one a pose half or all of the way from rest to a place within the
/// ranges, drawn from a fixed sequence.
pub(super) fn start_of(question: &Question<'_>, start: u32) -> Vec<f64> {
    let mut stored = question.goals.rest.pose.clone();
    if start == 0 {
        return stored;
    }
    let share = if start.is_multiple_of(2) { 1.0 } else { 0.5 };
    let at = |i: usize| drawn(u64::from(start) << 32 | i as u64);
    let mut unknown = 0;
    while unknown < question.unknown_len() {
        let id = question.coordinates[unknown];
        let kind = question.model.coordinate(id).kind;
        match question.stored[unknown] {
            Some((place, lower, upper)) => {
                let rest = stored[place];
                // Distances are linear: descents find their way from rest.
                let reach = match kind {
                    CoordinateKind::Rotation => PI,
                    _ => 0.0,
                };
                let (low, high) = (lower.max(rest - reach), upper.min(rest + reach));
                if low < high {
                    stored[place] += share * (low + (high - low) * at(unknown) - rest);
                }
                unknown += 1;
            }
            None => {
                let turn = [0, 1, 2].map(|i| share * PI * (2.0 * at(unknown + i) - 1.0));
                let place = question.model.stored_range(id);
                let rest =
                    Quat::from(std::array::from_fn::<f64, 4, _>(|i| stored[place.start + i]));
                let turned = (rest * Quat::exp(turn.into())).normalized();
                stored[place].copy_from_slice(&turned.to_array());
                unknown += 3;
            }
        }
    }
    stored
}

/// A number from 0 to 1 for each index: SplitMix64 (Steele, Lea & Flood 2014).
fn drawn(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
