//! What stands beside the bones of a posed figure, for who draws the bones in another way.

use super::figure::Figure;
use super::sheet::scene;
use super::{Focus, Reaches, Rotations, Show};
use condyle_diagnostics::Error;
use condyle_model::{Jacobian, JointSetId, Model, Pose, Program};
use condyle_render::Scene;

/// The signs that a picture shows of one pose, without bones and ground: as [`draw`](super::draw) draws them, by the
/// same code.
///
/// `surfaces` is that of the model, `reaches` what was worked out for pictures before, `unit` a length that suits signs beside bones in metres, such as a twentieth of
/// the picture's height. Of a [`Focus`] the names and the highlight count.
///
/// # Errors
/// `picture/unknown` for names that the model does not have; `picture/poses` for a pose of another length.
///
/// ```
/// use condyle::{Figure, Program, picture, open};
/// let model = open::model("knee".as_ref())?.value;
/// let (program, surfaces) = (Program::compile(&model), Figure::new(&model));
/// let reaches = picture::Reaches::default();
/// let show = [picture::Show::Frames];
/// let focus = picture::Focus::default();
/// let drawn = picture::signs((&model, &program, &surfaces, &reaches), &[1.2], &show, &focus, 0.05)?;
/// // Three axes for each segment.
/// assert_eq!(drawn.lines.len(), 3 * model.segments().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn signs(
    figure: (&Model, &Program, &crate::Figure, &Reaches),
    stored: &[f64],
    show: &[Show],
    focus: &Focus,
    unit: f64,
) -> Result<Scene, Error> {
    let beside = |kind: &&Show| !matches!(kind, Show::Bones | Show::Skin);
    let show: Vec<Show> = show.iter().filter(beside).copied().collect();
    posed(figure, stored, focus, unit, |figure| scene(figure, &show))
}

/// What is told of a posed figure.
fn posed<T>(
    (model, program, surfaces, reaches): (&Model, &Program, &crate::Figure, &Reaches),
    stored: &[f64],
    focus: &Focus,
    unit: f64,
    told: impl FnOnce(&Figure) -> T,
) -> Result<T, Error> {
    let chosen = focus.resolve(model)?;
    let (mut pose, mut jacobian) = (Pose::new(program), Jacobian::new(program));
    let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
    evaluated.map_err(|error| Error::new("picture/poses", error.to_string()))?;
    Ok(told(&Figure {
        model,
        program,
        stored,
        pose: &pose,
        jacobian: &jacobian,
        surfaces,
        chosen: chosen.as_ref(),
        highlight: focus.highlight,
        reaches,
        unit,
    }))
}

/// The rotations of what a joint set moves in the space of quaternions, with the path of a motion: a rotation by θ about the unit
/// vector u is at u·sin(θ/2). `None` where no cone with twist and no learned field limits them.
///
/// # Errors
/// As those of [`signs`].
///
/// ```
/// use condyle::{Figure, Program, open, picture};
/// let model = open::model("shoulder".as_ref())?.value;
/// let (program, surfaces) = (Program::compile(&model), Figure::new(&model));
/// let reaches = picture::Reaches::default();
/// let named = |name: &str| model.joint_sets().iter().position(|set| set.name == name);
/// let set = model.joint_set_ids().nth(named("shoulder_r").expect("it is there")).unwrap();
/// let of = (&model, &program, &surfaces, &reaches);
/// let found = picture::rotations(of, &model.defaults(), set, &[])?.expect("a cone");
/// // The boundary, within the ball of all rotations.
/// let places = found.scene.surfaces[0].positions.iter();
/// assert!(places.flatten().all(|x| x.abs() < 1.0 + 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rotations(
    figure: (&Model, &Program, &crate::Figure, &Reaches),
    stored: &[f64],
    set: JointSetId,
    frames: &[Vec<f64>],
) -> Result<Option<Rotations>, Error> {
    posed(figure, stored, &Focus::default(), 0.05, |figure| figure.rotations(set, frames))
}

/// The rotation of a pose there, and the nearest one that is allowed where it is not.
///
/// # Errors
/// As those of [`signs`].
pub fn rotation(
    figure: (&Model, &Program, &crate::Figure, &Reaches),
    stored: &[f64],
    set: JointSetId,
) -> Result<Option<Scene>, Error> {
    posed(figure, stored, &Focus::default(), 0.05, |figure| figure.rotation(set))
}
