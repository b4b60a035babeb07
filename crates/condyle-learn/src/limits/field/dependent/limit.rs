//! A limit from pairs of driver and rotation.

use super::super::super::{Cloud, SPACING};
use super::super::{About, Ground, LearnedLimit, Settings, learn};
use super::{Pairs, layer, made};
use condyle_diagnostics::Error;
use condyle_model::CoordinateKind;
use condyle_model::limit::field::dependent::{Dependence, DependenceSettings, Drivers};
use condyle_model::limit::field::snapped;
use std::sync::Arc;

/// Parts of independent samples that are left out in turn, and of recordings.
const PARTS: [usize; 2] = [4, 8];

/// What a limit is learned for, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// What people want to know of it.
    pub about: About,
    /// The coordinate, or the segment whose rotation is the driver.
    pub name: String,
    /// Of a rotation, the segment in which it is seen.
    pub reference: Option<String>,
    /// What a coordinate measures; an angle, or a rotation in space, if not given.
    pub kind: Option<CoordinateKind>,
    /// How the dependence is learned; what is usual for the driver if not given.
    pub settings: Option<DependenceSettings>,
    /// How the limit without its driver is learned.
    pub whole: Settings,
    /// Whether samples are frames of recordings, thinned to this spacing in radians, and not independent.
    pub curves: Option<f64>,
}

/// Learns a limit that depends on a driver, and the distances of samples that were left out to what the others say, in
/// radians, rising.
///
/// # Errors
/// Those of [`Cloud::gather`] and [`learn`]; `given/settings` for settings that make no sense.
///
/// ```
/// use condyle_learn::limits::dependent::{Asked, Driver, Drivers, Pairs, limit};
/// use condyle_learn::limits::{About, Settings, State};
/// use condyle_math::{Quat, Vec3};
/// // A hinge that opens to 20 degrees and 0.4 of its driver.
/// let (mut rotations, mut drivers) = (vec![], vec![]);
/// for i in 0..2000 {
///     let driver = f64::from(i % 50) * 0.03;
///     let most = 20f64.to_radians() + 0.4 * driver;
///     rotations.push(Quat::from_axis_angle(Vec3::Z, most * f64::from(i / 50) / 39.0));
///     drivers.push(driver);
/// }
/// let pairs = Pairs::gather(&[(&rotations, Drivers::Scalars(drivers))], 0.0, 0.5)?;
/// let asked = Asked {
///     about: About { child: "forearm".into(), ..About::default() },
///     name: "shoulder".into(),
///     reference: None,
///     kind: None,
///     settings: None,
///     whole: Settings { nodes: 32, ..Settings::default() },
///     curves: None,
/// };
/// let (limit, _) = limit(&pairs, &asked)?;
/// let given = limit.given().ok_or_else(|| condyle_diagnostics::Error::new("x", "no driver"))?;
/// let turned = |degrees: f64| Quat::from_axis_angle(Vec3::Z, degrees.to_radians());
/// // At a driver of 0 it opens to 20 degrees, at 1.4 rad to 52.
/// assert!((given.distance(turned(30.0), Driver::Scalar(0.0)).to_degrees() + 10.0).abs() < 1.5);
/// assert!((given.distance(turned(30.0), Driver::Scalar(1.4)).to_degrees() - 22.0).abs() < 1.5);
/// // Nobody was recorded at 4 rad.
/// assert_eq!(given.state(turned(10.0), Driver::Scalar(4.0)), State::Unknown);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn limit(pairs: &Pairs, asked: &Asked) -> Result<(LearnedLimit, Vec<f64>), Error> {
    let cloud = Cloud::gather(&[&pairs.rotations], asked.curves.map_or(0.0, |_| SPACING))?;
    let whole = learn(&cloud, &asked.whole)?;
    let last = pairs.takes.iter().max().map_or(0, |last| *last as usize + 1);
    let mut takes = vec![0u32; last];
    for take in &pairs.takes {
        takes[*take as usize] += 1;
    }
    let ground = Ground {
        samples: pairs.rotations.iter().map(|q| snapped(*q)).collect(),
        takes,
        thinned: asked.curves.unwrap_or(0.0),
        ..(**whole.ground()).clone()
    };
    let drivers = match &pairs.drivers {
        // As files hold them.
        Drivers::Scalars(values) => {
            Drivers::Scalars(values.iter().map(|value| f64::from(*value as f32)).collect())
        }
        Drivers::Rotations(values) => {
            Drivers::Rotations(values.iter().map(|q| snapped(*q)).collect())
        }
    };
    let settings = asked.settings.unwrap_or_else(|| DependenceSettings::of(&drivers));
    let DependenceSettings { slope, step, nodes, .. } = settings;
    if !(slope >= 0.0 && slope.is_finite() && step > 0.0 && (24..=128).contains(&nodes)) {
        let message = "the slope is negative, the step not above 0, or nodes are not 24 to 128";
        return Err(Error::new("given/settings", message));
    }
    let (name, reference) = (asked.name.clone(), asked.reference.clone());
    let kind = match (asked.kind, &drivers) {
        (Some(CoordinateKind::Scale), Drivers::Scalars(_)) => CoordinateKind::Other,
        (Some(kind), Drivers::Scalars(_)) => kind,
        _ => drivers.usual_kind(),
    };
    let mut dependence = Dependence { name, reference, kind, drivers, settings, known: None };
    let parts = parts(&pairs.takes, last, asked.curves.is_some());
    let least = asked.curves.unwrap_or(0.0);
    let (known, distances) = layer(&ground, &dependence, &parts, asked.curves.is_some(), least);
    dependence.known = Some(known);
    let limit = LearnedLimit::new(
        asked.about.clone(),
        Arc::new(ground),
        Some(whole.learned().clone()),
        super::super::made,
    );
    Ok((limit.depending_on(dependence, made), distances))
}

/// The part of each sample: every fifth of independent ones, whole takes, or blocks of time of few takes.
fn parts(takes: &[u32], number: usize, curves: bool) -> Vec<usize> {
    let [mixed, most] = PARTS;
    if !curves {
        return (0..takes.len()).map(|sample| sample % mixed).collect();
    }
    if number >= 4 {
        return takes.iter().map(|take| *take as usize % most).collect();
    }
    let blocks = most.div_ceil(number.max(1));
    let length = |take: u32| takes.iter().filter(|other| **other == take).count();
    let lengths: Vec<usize> = (0..number as u32).map(length).collect();
    let mut seen = vec![0usize; number];
    takes
        .iter()
        .map(|take| {
            let take = *take as usize;
            let block = seen[take] * blocks / lengths[take].max(1);
            seen[take] += 1;
            take * blocks + block
        })
        .collect()
}
