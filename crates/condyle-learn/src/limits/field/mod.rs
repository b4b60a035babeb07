//! The default method: the signed distance to the closing of a cloud by empty balls.
//!
//! ```text
//! Cloud -> Ground               axes               samples as files hold them, the cloud's axes
//!       -> distances at nodes   closing, nearest   what no empty ball covers, holes carved
//!                               layer, density     what samples leave before a boundary, more where they are sparse
//!                               even, edges        roughness by chance evened out, edges from the faces that meet
//!       -> Field                condyle-model      a cubic spline over all rotations, and its answers
//! Shape -> distances at nodes   shape              of a limit that is given by formulas, without samples
//! ```

mod axes;
mod closing;
mod density;
pub mod dependent;
mod edges;
mod even;
mod layer;
mod nearest;
mod shape;

pub use condyle_model::limit::field::{
    About, Answer, Evidence, Fibre, Field, Ground, Hole, Known, Learned, LearnedLimit, Settings,
    State, fibre,
};

pub use shape::shaped;

use super::Cloud;
use condyle_diagnostics::Error;
use condyle_model::limit::field::{Grid, Lattice, snapped};
use std::f64::consts::PI;
use std::sync::Arc;

/// Learns the limit of a cloud.
///
/// ```
/// use condyle_learn::limits::{Cloud, Settings, State, learn};
/// use condyle_math::{Quat, Vec3};
/// // All turns by up to 60 degrees, from points of a lattice.
/// let range = -10..=10;
/// let mut take = vec![];
/// for (i, j, k) in range.clone().flat_map(|i| range.clone().map(move |j| (i, j)))
///     .flat_map(|(i, j)| (-10..=10).map(move |k| (i, j, k)))
/// {
///     let turn = Vec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.12;
///     if turn.norm() < 60f64.to_radians() {
///         take.push(Quat::exp(turn));
///     }
/// }
/// let cloud = Cloud::gather(&[&take], 0.0)?;
/// let field = learn(&cloud, &Settings { nodes: 48, ..Settings::default() })?;
/// let answer = field.answer(Quat::from_axis_angle(Vec3::Y, 80f64.to_radians()));
/// assert_eq!(answer.state, State::Invalid);
/// assert!((answer.distance.to_degrees() + 20.0).abs() < 3.0);
/// assert!((answer.nearest.log().y.to_degrees() - 60.0).abs() < 3.0);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
///
/// # Errors
/// `field/settings` for settings that make no sense.
pub fn learn(cloud: &Cloud, settings: &Settings) -> Result<Field, Error> {
    let mut ground = ground(cloud, settings)?;
    let grid = grid(&ground);
    let Learned { spacing, radius, gap, .. } = grid.learned;
    ground.known = Some(Known { spacing, radius, gap });
    Ok(Field::new(Arc::new(ground), grid))
}

/// The limit of a cloud, with what people want to know of it; `about.takes` may name the takes.
///
/// # Errors
/// As [`learn`].
pub fn limit(cloud: &Cloud, settings: &Settings, about: About) -> Result<LearnedLimit, Error> {
    let field = learn(cloud, settings)?;
    let limit =
        LearnedLimit::new(about, field.ground().clone(), Some(field.learned().clone()), made);
    Ok(limit.with_field(field))
}

/// What a field is made of, of a cloud: its rotations as files hold them, so that a limit that is saved and read
/// answers to the bit as the one that was learned.
///
/// # Errors
/// As [`learn`].
pub fn ground(cloud: &Cloud, settings: &Settings) -> Result<Ground, Error> {
    let [least, most] = settings.radius;
    if !((24..=256).contains(&settings.nodes) && least > 0.0 && least <= most && most < PI) {
        let message = "nodes are not 24 to 256, or radii not rising between 0 and half a turn";
        return Err(Error::new("field/settings", message));
    }
    // Samples of a take follow each other.
    let mut takes: Vec<u32> = vec![];
    for take in cloud.takes() {
        let take = *take as usize;
        if takes.len() <= take {
            takes.resize(take + 1, 0);
        }
        takes[take] += 1;
    }
    Ok(Ground {
        samples: cloud.rotations().iter().map(|q| snapped(*q)).collect(),
        takes,
        thinned: cloud.spacing(),
        chart: axes::of(cloud),
        settings: *settings,
        known: None,
        shape: None,
    })
}

/// The field of a ground: of one that was saved, the same as it was.
#[must_use]
pub fn made(ground: &Arc<Ground>) -> Field {
    let grid = match &ground.shape {
        Some(shape) => shape::grid(ground, shape),
        None => grid(ground),
    };
    Field::new(ground.clone(), grid)
}

fn grid(ground: &Ground) -> Grid {
    let lattice = Lattice::new(ground.settings.nodes.clamp(24, 256));
    let found = closing::closing(ground, &lattice);
    let all = 8.0 * PI * PI;
    let [_, outer, hollow] = found.volumes;
    let holes = found.holes.iter().map(|(q, radius, volume)| Hole {
        centre: ground.chart.outward(*q),
        radius: *radius,
        share: volume / all,
    });
    let learned = Learned {
        spacing: found.spacing,
        radius: found.radius,
        gap: found.gap,
        extreme: found.extreme,
        surface: found.surface,
        outer: outer / all,
        valid: (outer - hollow) / all,
        holes: holes.collect(),
    };
    let closing::Closing { outer, carved, samples: near, counts, boundary, .. } = found;
    Grid { lattice, outer, carved, near, counts, boundary, learned }
}
