//! What stands beside the bones of a posed figure, for who draws the bones in another way.

use super::figure::Figure;
use super::sheet::scene;
use super::{Focus, Reaches, Show};
use condyle_diagnostics::Error;
use condyle_model::{Jacobian, Model, Pose, Program};
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
    (model, program, surfaces, reaches): (&Model, &Program, &crate::Figure, &Reaches),
    stored: &[f64],
    show: &[Show],
    focus: &Focus,
    unit: f64,
) -> Result<Scene, Error> {
    let chosen = focus.resolve(model)?;
    let (mut pose, mut jacobian) = (Pose::new(program), Jacobian::new(program));
    let evaluated = program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian);
    evaluated.map_err(|error| Error::new("picture/poses", error.to_string()))?;
    let figure = Figure {
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
    };
    let beside = |kind: &&Show| !matches!(kind, Show::Bones | Show::Skin);
    let show: Vec<Show> = show.iter().filter(beside).copied().collect();
    Ok(scene(&figure, &show))
}
