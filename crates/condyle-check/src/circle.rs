//! Rotations without ends: a range of 359° or more in which whole turns are the same posture.
//!
//! Many files give a rotation the range -180° to 180° where the body has no ends. A screw's angle, or one
//! that a spline or a limit reads, is no such rotation, however wide its range. That is tried, not read off
//! the components: at several postures everything must stay where it is when the coordinate gains 2π.

use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Mode, Model, Pose, Program};
use std::f64::consts::{PI, TAU};

/// A range that spans this much, 359°, has no ends where whole turns are the same posture.
const WIDE: f64 = 359.0 * PI / 180.0;
/// At how many postures is tried.
const TRIES: u32 = 6;
/// Two numbers for one posture may differ by rounding.
const SAME: f64 = 1e-9;

/// The rotations whose range is a circle: it spans 359° or more, and q and q + 2π are the same posture of
/// the whole model. A value beyond such a range is no violation of it.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::{ModelBuilder, Range};
/// let mut b = ModelBuilder::new("arm");
/// let arm = b.segment("arm", None);
/// let (_, angle) = b.hinge("shoulder", arm, "angle", Vec3::Z);
/// b.coordinate_mut(angle).range = Range::new(-180f64.to_radians(), 180f64.to_radians());
/// assert_eq!(condyle_check::circles(&b.build().unwrap()), [angle]);
/// ```
pub fn circles(model: &Model) -> Vec<CoordinateId> {
    let wide = |id: &CoordinateId| {
        let coordinate = model.coordinate(*id);
        let (lower, upper) = (coordinate.range.lower, coordinate.range.upper);
        coordinate.kind == CoordinateKind::Rotation
            && coordinate.follows.is_none()
            && lower.zip(upper).is_some_and(|(lower, upper)| upper - lower >= WIDE)
    };
    let wide: Vec<CoordinateId> = model.coordinate_ids().filter(wide).collect();
    if wide.is_empty() {
        return wide;
    }
    let program = Program::compile(model);
    let mut poses = [Pose::new(&program), Pose::new(&program)];
    let mut rows = [ClosureRows::new(model), ClosureRows::new(model)];
    let mut periodic = |id: &CoordinateId| {
        let place = model.stored_range(*id).start;
        (0..TRIES).all(|attempt| {
            let mut stored = spread(model, attempt);
            for (turn, (pose, rows)) in poses.iter_mut().zip(&mut rows).enumerate() {
                stored[place] += TAU * turn as f64;
                if program.evaluate(&stored, Mode::Open, pose).is_err() {
                    return false;
                }
                rows.update(model, &program, pose, None);
            }
            same(model, &program, &poses, place) && alike(&rows[0].residuals, &rows[1].residuals)
        })
    };
    wide.into_iter().filter(|id| periodic(id)).collect()
}

/// A posture in which every rotation is somewhere within half a turn of its default.
fn spread(model: &Model, attempt: u32) -> Vec<f64> {
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        if model.coordinate(id).kind == CoordinateKind::Rotation {
            // The golden ratio spreads evenly however many there are.
            let number = f64::from(attempt) * 31.0 + id.index() as f64 * 17.0 + 1.0;
            let share = (number * 0.618_033_988_749_895).fract();
            stored[model.stored_range(id).start] += PI * (2.0 * share - 1.0);
        }
    }
    stored
}

/// Whether two poses are the same in all but one stored number.
fn same(model: &Model, program: &Program, [a, b]: &[Pose; 2], but: usize) -> bool {
    let placed = |id| {
        let [p, q] = [a, b].map(|pose| pose.segment(id).to_rows());
        alike(&p, &q)
    };
    model.segment_ids().all(placed)
        && (0..program.limit_row_len()).all(|row| alike(&[a.limit_row(row)], &[b.limit_row(row)]))
        && (0..a.effective().len())
            .all(|i| i == but || alike(&a.effective()[i..=i], &b.effective()[i..=i]))
}

fn alike(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME || (x.is_nan() && y.is_nan()))
}
