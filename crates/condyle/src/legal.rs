//! Legal poses: limits on coordinates project, and those on what is measured between segments are solved for.

use condyle_model::{Mode, Model, Pose, Program, SizeMismatch};
use condyle_motion::Motion;
use condyle_track::goal::MET;
pub use condyle_track::goal::nearest_legal as nearest;

/// Evaluates a pose within the limits of its model: ranges and limits on coordinates project, and where a
/// limit on what is measured between segments is broken then, the nearest legal pose is found. Loops are
/// not closed.
///
/// Whether a pose was looked for that way: the effective coordinates of `pose` are then the answer's.
///
/// # Errors
/// If `asked` or the pose is not of this program.
///
/// ```
/// use condyle::math::Vec3;
/// use condyle::model::component::{HalfSpace, RelativePosition};
/// use condyle::{Law, ModelBuilder, Pose, Program, legal};
///
/// // A hand 30 cm from the elbow that must not be lower than 15 cm under it.
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// let (set, _) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let point = Vec3::new(0.3, 0.0, 0.0);
/// let depth = RelativePosition { reference: false, point, along: vec![-Vec3::Y] };
/// let depth = b.component(set, "depth", Law::RelativePosition(depth), vec![forearm.into()]);
/// let floor = Law::HalfSpace(HalfSpace::new(vec![1.0], 0.15).unwrap());
/// b.component(set, "floor", floor, vec![depth]);
/// let model = b.build().unwrap();
/// let program = Program::compile(&model);
/// let mut pose = Pose::new(&program);
/// assert!(legal::evaluate(&model, &program, &[-1.0], &mut pose).unwrap());
/// assert!((pose.effective()[0] + 30f64.to_radians()).abs() < 1e-9);
/// assert!(!legal::evaluate(&model, &program, &[0.5], &mut pose).unwrap());
/// ```
pub fn evaluate(
    model: &Model,
    program: &Program,
    asked: &[f64],
    pose: &mut Pose,
) -> Result<bool, SizeMismatch> {
    program.evaluate(asked, Mode::Posed, pose)?;
    // Rounding in the numbers of a file breaks no limit.
    let broken = |&row: &usize| pose.limit_row(row) < -MET;
    if !program.measured_limit_rows().iter().any(broken) {
        return Ok(false);
    }
    let Some(legal) = nearest(model, asked) else { return Ok(false) };
    program.evaluate(&legal, Mode::Open, pose)?;
    Ok(true)
}

/// Gives every frame of a motion that breaks a limit on what is measured between segments the nearest legal
/// pose; other limits hold in posed mode. How many frames changed.
pub fn keep(model: &Model, motion: &mut Motion) -> usize {
    let program = Program::compile(model);
    if program.measured_limit_rows().is_empty() {
        return 0;
    }
    let mut pose = Pose::new(&program);
    let mut changed = 0;
    for frame in &mut motion.frames {
        if let Ok(true) = evaluate(model, &program, frame, &mut pose) {
            frame.copy_from_slice(pose.effective());
            changed += 1;
        }
    }
    changed
}
