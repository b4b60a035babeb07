//! The legal pose nearest to one that was asked for.

use super::problem::Stage;
use super::question::Question;
use super::search::{CLOSE, descend, start_of};
use super::{Goals, REST_ANGLE, REST_LENGTH, Rest};
use condyle_model::{CoordinateKind, Mode, Model, Pose, Program};

/// A row below this, in metres or radians, breaks its limit.
const BROKEN: f64 = 1e-9;
/// A row that a descent has left below this is not kept.
const SOLVED: f64 = 1e-7;
/// How many more starts there are where the first ones end in no legal pose, or not near.
const DRAWN: u32 = 8;
/// Half a radian in all.
const NEAR: f64 = 0.25 * REST_ANGLE;

/// The stored numbers of the legal pose nearest to `asked`, or `None` where that one is legal.
///
/// Ranges and all limit rows are kept, those of what is measured between segments as well; loops are not
/// closed. Nearest is the least Σ k_c |q_c - asked_c|² over the independent coordinates with [`REST_ANGLE`] for
/// every angle and [`REST_LENGTH`] for every distance, so that 10 cm count as much as a radian. Where the
/// limits leave no legal pose within reach, it is the one that breaks them least.
///
/// # Panics
/// If `asked` has not as many numbers as the model stores.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::component::{HalfSpace, RelativePosition};
/// use condyle_model::{Law, ModelBuilder};
/// use condyle_track::goal::nearest_legal;
///
/// // A hand 30 cm from the elbow that must not be lower than 15 cm under it.
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// let (set, _) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let point = Vec3::new(0.3, 0.0, 0.0);
/// let height = RelativePosition { reference: false, point, along: vec![-Vec3::Y] };
/// let height = b.component(set, "depth", Law::RelativePosition(height), vec![forearm.into()]);
/// let limit = HalfSpace::new(vec![1.0], 0.15).unwrap();
/// b.component(set, "floor", Law::HalfSpace(limit), vec![height]);
/// let model = b.build().unwrap();
/// let legal = nearest_legal(&model, &[-1.0]).unwrap();
/// assert!((legal[0] + 30f64.to_radians()).abs() < 1e-9); // sin 30° = 0.15 / 0.3
/// assert_eq!(nearest_legal(&model, &[-0.4]), None);
/// ```
pub fn nearest_legal(model: &Model, asked: &[f64]) -> Option<Vec<f64>> {
    let open = model.without_closures();
    let program = Program::compile(&open);
    if within_ranges(&open, asked) == asked && worst_row(&program, asked) >= -BROKEN {
        return None;
    }
    searched(&open, &program, asked)
}

/// As [`nearest_legal`], with the loops of the model closed as well; a pose is always looked for.
///
/// # Panics
/// If `asked` has not as many numbers as the model stores.
pub fn nearest_closed(model: &Model, asked: &[f64]) -> Option<Vec<f64>> {
    searched(model, &Program::compile(model), asked)
}

/// The nearest pose that keeps the limits and the loops of a model.
fn searched(open: &Model, program: &Program, asked: &[f64]) -> Option<Vec<f64>> {
    let within = within_ranges(open, asked);
    let stiffness = open.coordinates().iter().map(|c| match c.kind {
        CoordinateKind::Translation => REST_LENGTH,
        _ => REST_ANGLE,
    });
    let rest = Rest { pose: asked.to_vec(), stiffness: stiffness.collect(), sums: vec![] };
    let goals = Goals { goals: vec![], held: vec![], rest, limits: true };
    let question = Question::new(open, &goals);
    let stage =
        || Stage { exact: None, weighted: 1.0, rest: 1.0, near: goals.rest.clone(), curved: true };
    // From the asked pose, from where its limits on coordinates put it, and from the defaults.
    let mut posed = Pose::new(program);
    let projected = match program.evaluate(asked, Mode::Posed, &mut posed) {
        Ok(()) => posed.effective().to_vec(),
        Err(_) => within.clone(),
    };
    // What limits do not move stays as it is asked for, wherever a descent starts.
    let mut defaults = within.clone();
    let all = within_ranges(open, &open.defaults());
    for place in question.coordinates.iter().map(|&id| open.stored_range(id)) {
        defaults[place.clone()].copy_from_slice(&all[place]);
    }
    // Where a row has no slope, as that of a straight arm, only another start leads on; and what is far
    // away may be nearer on another way.
    let drawn = (1..=DRAWN).map(|start| start_of(&question, start));
    let mut best: Option<(f64, f64, Vec<f64>)> = None;
    for (number, start) in [within, projected, defaults].into_iter().chain(drawn).enumerate() {
        let near = |(broken, value, _): &(f64, f64, _)| *broken == 0.0 && *value <= NEAR;
        if number >= 3 && best.as_ref().is_some_and(near) {
            break;
        }
        let Some(end) = descend(&question, stage(), &start, &CLOSE) else { continue };
        let row = worst_row(program, &end.stored).min(-end.answer.closure_error);
        let broken = if row < -SOLVED { -row } else { 0.0 };
        // Legal ones first, then the nearest.
        if best.as_ref().is_none_or(|best| (broken, end.value) < (best.0, best.1)) {
            best = Some((broken, end.value, end.stored));
        }
    }
    best.map(|(.., stored)| stored)
}

fn within_ranges(model: &Model, stored: &[f64]) -> Vec<f64> {
    let mut within = stored.to_vec();
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        if coordinate.kind != CoordinateKind::Orientation && coordinate.follows.is_none() {
            let value = coordinate.range.nearest(model.value(stored, id));
            *model.value_mut(&mut within, id) = value;
        }
    }
    within
}

/// The lowest limit row of a posture; infinite where there is none.
fn worst_row(program: &Program, stored: &[f64]) -> f64 {
    let mut pose = Pose::new(program);
    match program.evaluate(stored, Mode::Open, &mut pose) {
        Ok(()) => (0..program.limit_row_len())
            .map(|row| pose.limit_row(row))
            .fold(f64::INFINITY, f64::min),
        Err(_) => f64::NEG_INFINITY,
    }
}
