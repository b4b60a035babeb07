//! A limit from takes.

use super::Take;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_learn::limits::field::{self, About};
use condyle_learn::limits::herda2003::{LearnedSpheres, Options, SphereLimit};
use condyle_learn::limits::{
    Cloud, Gathered, LearnedLimit, LeftOut, SPACING, Settings, independent, left_out,
};
use condyle_math::Quat;

/// So many independent rotations are kept, whatever their density.
pub const MOST_INDEPENDENT: usize = 40_000;

/// How a limit is learned; what is not said follows from the takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct How {
    /// The least angle between two rotations, in radians: 2 degrees along curves, 0 of independent rotations.
    pub spacing: Option<f64>,
    /// How far the limit goes beyond the closing, in radians.
    pub offset: Option<f64>,
    /// The share of left-out rotations that the limit must hold, as far as an offset of 15 degrees does; without it, 0.95.
    pub cover: Option<f64>,
    /// The settings of the field; its `gap` is that of `offset`.
    pub settings: Settings,
}

/// A limit, and how it came about.
#[derive(Clone, Debug)]
pub struct LearnedFrom {
    /// The limit.
    pub limit: LearnedLimit,
    /// What became of all rotations.
    pub gathered: Gathered,
    /// Whether most rotations are independent of those before and after them.
    pub independent: bool,
    /// What takes tell that were left out; `None` for independent rotations.
    pub left_out: Option<LeftOut>,
    /// What a person should know.
    pub warnings: Vec<Diagnostic>,
}

/// A limit must have this many samples that differ, or there is a warning.
const FEW: usize = 200;

pub(super) fn raw(takes: &[Take]) -> Vec<&[Quat]> {
    takes.iter().map(|take| &take.found.rotations[..]).collect()
}

pub(super) fn are_independent(takes: &[&[Quat]]) -> bool {
    let all: usize = takes.iter().map(|take| take.len()).sum();
    let of: usize = takes.iter().filter(|take| independent(take)).map(|take| take.len()).sum();
    2 * of > all
}

fn gather(takes: &[&[Quat]], how: &How, independent: bool) -> Result<Cloud, Error> {
    if let Some(spacing) = how.spacing {
        return Cloud::gather(takes, spacing);
    }
    if !independent {
        return Cloud::gather(takes, SPACING);
    }
    let mut spacing = 0.0;
    loop {
        let cloud = Cloud::gather(takes, spacing)?;
        if cloud.rotations().len() <= MOST_INDEPENDENT {
            return Ok(cloud);
        }
        spacing = if spacing == 0.0 { 0.25 * SPACING } else { 1.5 * spacing };
    }
}

/// The settings of the field.
pub(super) fn settings(how: &How) -> Settings {
    Settings { gap: how.offset, ..how.settings }
}

/// Learns a limit from takes.
///
/// Rotations along curves, frames of a recording, are thinned at two degrees, and takes that are left out say how far the limit goes
/// beyond them and from what distance on a place without samples is a hole ([`left_out`]). Independent rotations are all kept, and
/// single ones left out.
///
/// # Errors
/// `cloud/empty` without any rotation; settings out of range.
///
/// ```
/// use condyle::learning::{How, Take, learn};
/// use condyle::math::{Quat, Vec3};
/// // Six takes of an elbow that is bent by up to 120 degrees and turned by up to 60 in its lower half.
/// let frame = |take: usize, i: usize| {
///     let t = 0.02 * i as f64 + take as f64;
///     let bent = 1.0 + 1.0 * (1.3 * t).sin();
///     Quat::from_axis_angle(Vec3::Z, bent) * Quat::from_axis_angle(Vec3::Y, (0.41 * t).cos())
/// };
/// let takes: Vec<Take> = (0..6)
///     .map(|take| Take {
///         name: format!("take {take}"),
///         found: condyle::learn::frames::Orientated {
///             rotations: (0..800).map(|i| frame(take, i)).collect(),
///             ..Default::default()
///         },
///         child: "forearm".into(),
///         reference: Some("humerus".into()),
///         frames: String::new(),
///         given: None,
///     })
///     .collect();
/// let found = learn(&takes, &How::default(), "elbow")?;
/// assert!(found.left_out.is_some_and(|left| left.parts == 6 && left.whole_takes));
/// let field = found.limit.field();
/// assert!(field.distance(frame(2, 300)) > 0.0);
/// assert!(field.distance(Quat::from_axis_angle(Vec3::X, 1.5)) < -0.5);
/// # Ok::<(), condyle::Error>(())
/// ```
pub fn learn(takes: &[Take], how: &How, name: &str) -> Result<LearnedFrom, Error> {
    let raw = raw(takes);
    let independent = are_independent(&raw);
    let cloud = gather(&raw, how, independent)?;
    let mut settings = settings(how);
    let mut said = None;
    if !independent {
        let mut left = left_out(&raw, cloud.spacing(), &settings)?;
        if let Some(cover) = how.cover {
            left.gap = left.reaching(cover);
        }
        settings = left.settings(&settings);
        said = Some(left);
    }
    let mut about = about(takes, &cloud, name);
    if let (Some(left), Some(gap)) = (&said, settings.gap) {
        about.source.push_str(&beyond(left, gap));
    }
    let limit = field::limit(&cloud, &settings, about)?;
    let warnings = warnings(&cloud, takes);
    Ok(LearnedFrom { limit, gathered: cloud.gathered(), independent, left_out: said, warnings })
}

/// Learns the spheres of Herda et al. 2003 from takes; the cloud is thinned as for the default method.
///
/// # Errors
/// As [`learn`]; `herda2003/fit` where nothing can be fitted.
pub fn spheres(
    takes: &[Take],
    how: &How,
    options: Options,
    name: &str,
) -> Result<(LearnedSpheres, Vec<Diagnostic>), Error> {
    let raw = raw(takes);
    let cloud = gather(&raw, how, are_independent(&raw))?;
    let limit = SphereLimit::learn(cloud.rotations(), cloud.reference(), options)
        .map_err(|error| Error::new("herda2003/fit", error.to_string()))?;
    let warnings = warnings(&cloud, takes);
    let ground = field::ground(&cloud, &Settings::default())?;
    let learned = LearnedSpheres {
        about: about(takes, &cloud, name),
        limit,
        samples: ground.samples,
        takes: ground.takes,
        thinned: ground.thinned,
    };
    Ok((learned, warnings))
}

pub(super) fn warnings(cloud: &Cloud, takes: &[Take]) -> Vec<Diagnostic> {
    let mut warnings = cloud.gathered().warnings();
    let count = cloud.rotations().len();
    if count < FEW {
        let message = format!("{count} rotations that differ say little about a limit");
        let help = "record more: slow movements along the boundary, in all directions and twists";
        warnings.push(Diagnostic::warning("learn/few", message).with_help(help));
    }
    let mut names: Vec<(&str, Option<&str>)> =
        takes.iter().map(|t| (t.child.as_str(), t.reference.as_deref())).collect();
    names.dedup();
    if names.len() > 1 {
        let said = names.iter().map(|(child, reference)| {
            format!("{child} in {}", reference.unwrap_or("the laboratory"))
        });
        let said: Vec<String> = said.collect();
        let message = format!("the recordings do not show the same: {}", said.join(", "));
        warnings.push(Diagnostic::warning("learn/mixed", message));
    }
    warnings
}

/// How far a limit goes beyond recordings, and what that rests on.
fn beyond(left: &LeftOut, gap: f64) -> String {
    let what = if left.whole_takes { "takes" } else { "blocks of time" };
    format!(
        "; {:.1} degrees beyond them, with which {:.0} % of {} {what} are inside the others",
        gap.to_degrees(),
        100.0 * left.held(gap),
        left.parts
    )
}

/// What is said of a limit that is learned from takes.
pub(super) fn about(takes: &[Take], cloud: &Cloud, name: &str) -> About {
    let first = takes.first();
    // Takes after the last one that gave samples have none to name.
    let last = cloud.takes().iter().max().map_or(0, |last| *last as usize + 1);
    let names: Vec<String> = takes.iter().take(last).map(|take| take.name.clone()).collect();
    About {
        name: name.to_owned(),
        child: first.map_or_else(String::new, |take| take.child.clone()),
        reference: first.and_then(|take| take.reference.clone()),
        source: format!("recordings {}", names.join(", ")),
        population: String::new(),
        frames: first.map_or_else(String::new, |take| take.frames.clone()),
        takes: names,
    }
}
