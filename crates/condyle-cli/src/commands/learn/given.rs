//! What `condyle learn limits --given` says of a limit that depends on another joint.

use super::{OFFSETS, degrees, percent, seen, takes_json, takes_text};
use crate::output;
use condyle::learn::limits::dependent::{Dependence, Driver};
use condyle::learn::limits::{LearnedLimit, percentile};
use condyle::learning::{self, Bin, LearnedGiven, Take};
use condyle::model::CoordinateKind;
use serde_json::{Value, json};

/// So many rows of a table on the screen.
const ROWS: usize = 24;

/// How far a rotation of the driver is from the first bin's, or the coordinate itself, in degrees.
fn at_json(at: Driver) -> Value {
    match at {
        Driver::Scalar(value) => json!(value),
        Driver::Rotation(q) => json!(q.to_array()),
    }
}

/// The unit of the values of a driver, `null` of a rotation.
fn unit(kind: CoordinateKind) -> Option<&'static str> {
    match kind {
        CoordinateKind::Rotation => Some("rad"),
        CoordinateKind::Translation => Some("m"),
        CoordinateKind::Scale | CoordinateKind::Other => Some("1"),
        CoordinateKind::Orientation => None,
    }
}

/// A value of a coordinate in the unit that people read.
fn at_text(kind: CoordinateKind, value: f64) -> String {
    match kind {
        CoordinateKind::Translation => format!("{:.1} mm", value * 1e3),
        CoordinateKind::Scale | CoordinateKind::Other => format!("{value:.3}"),
        CoordinateKind::Rotation | CoordinateKind::Orientation => {
            format!("{:.1}°", value.to_degrees())
        }
    }
}

/// What is known at values of the driver, of a limit that depends on one.
pub(in crate::commands) fn bins_json(limit: &LearnedLimit) -> Value {
    let Some((dependence, bins)) = learning::bins(limit) else { return Value::Null };
    let bin = |bin: &Bin| {
        json!({
            "at": at_json(bin.at),
            "share": bin.share,
            "samples": bin.samples,
            "bounds_deg": bin.bounds.map(|bounds| bounds.map(degrees)),
        })
    };
    let known = dependence.known;
    json!({
        "name": dependence.name,
        "unit": unit(dependence.kind),
        "reference": dependence.reference,
        "slope": dependence.settings.slope,
        "step": dependence.settings.step,
        "ball_deg": known.map(|known| degrees(known.radius)),
        "offset_deg": known.map(|known| degrees(known.gap)),
        "hinge": bins.first().is_some_and(|bin| bin.bounds.is_some()),
        "bins": bins.iter().map(bin).collect::<Vec<_>>(),
    })
}

/// The same as text: a row for each value of a coordinate, of rotations the range of the shares and the bins with
/// most samples.
pub(in crate::commands) fn bins_text(limit: &LearnedLimit) -> String {
    let Some((dependence, bins)) = learning::bins(limit) else { return String::new() };
    let Dependence { name, reference, .. } = dependence;
    let of = if bins.first().is_some_and(|bin| bin.bounds.is_some()) {
        "a turn"
    } else {
        "all rotations"
    };
    let within = reference.as_ref().map_or(String::new(), |r| format!(" in {r}"));
    let mut shares: Vec<f64> = bins.iter().map(|bin| bin.share).collect();
    shares.sort_by(f64::total_cmp);
    let mut text = format!(
        "given {name}{within}: {} to {} of {of} are valid, {} at the median of {} values\n",
        percent(percentile(&shares, 0.0)),
        percent(percentile(&shares, 1.0)),
        percent(percentile(&shares, 0.5)),
        bins.len(),
    );
    let mut shown: Vec<&Bin> = bins.iter().collect();
    if matches!(bins.first().map(|bin| bin.at), Some(Driver::Rotation(_))) {
        shown.sort_by_key(|bin| std::cmp::Reverse(bin.samples));
    }
    let mut rows = vec![["at", "samples", "valid", "from", "to"].map(str::to_owned).to_vec()];
    for bin in shown.iter().take(ROWS) {
        let at = match bin.at {
            Driver::Scalar(value) => at_text(dependence.kind, value),
            Driver::Rotation(q) => {
                let turn = q.log().to_array().map(|angle| format!("{:.0}", angle.to_degrees()));
                format!("turn by {}°", turn.join(", "))
            }
        };
        let [low, high] = match bin.bounds {
            Some(bounds) => bounds.map(|angle| format!("{:.1}°", angle.to_degrees())),
            None => [String::new(), String::new()],
        };
        rows.push(vec![at, bin.samples.to_string(), percent(bin.share), low, high]);
    }
    text.push_str(&output::columns(&rows));
    if shown.len() > ROWS {
        text.push_str(&format!("and {} others\n", shown.len() - ROWS));
    }
    text
}

fn held(distances: &[f64], gap: f64) -> f64 {
    let held = distances.iter().filter(|d| **d >= -gap).count();
    held as f64 / distances.len().max(1) as f64
}

fn layer(limit: &LearnedLimit) -> f64 {
    limit.dependence().and_then(|dependence| dependence.known).map_or(0.0, |known| known.gap)
}

pub(super) fn report(takes: &[Take], found: &LearnedGiven, seconds: f64) -> Value {
    let (about, learned, ground) =
        (found.limit.about(), found.limit.learned(), found.limit.ground());
    let curve = OFFSETS.map(|offset| {
        json!({ "offset_deg": offset, "inside": held(&found.left_out, offset.to_radians()) })
    });
    json!({
        "method": "closing",
        "child": about.child,
        "reference": about.reference,
        "frames_of": about.frames,
        "takes": takes_json(takes, &ground.takes),
        "frames": takes.iter().map(|take| take.found.given()).sum::<usize>(),
        "rotations": found.gathered.given,
        "samples": ground.samples.len(),
        "thinned_deg": degrees(ground.thinned),
        "independent": found.independent,
        "valid_share": learned.valid,
        "left_out": {
            "rotations": found.left_out.len(),
            "inside_closing": held(&found.left_out, 0.0),
            "inside_with_offset": held(&found.left_out, layer(&found.limit)),
            "by_offset": curve,
        },
        "given": bins_json(&found.limit),
        "seconds": seconds,
    })
}

pub(super) fn text(takes: &[Take], found: &LearnedGiven) -> String {
    let (about, ground) = (found.limit.about(), found.limit.ground());
    let mut text = format!("{}\n", seen(&about.child, about.reference.as_deref()));
    text.push_str(&takes_text(takes, &ground.takes));
    text.push_str(&format!(
        "{} samples with a value of what the limit depends on; it goes {:.1}° beyond them\n",
        ground.samples.len(),
        layer(&found.limit).to_degrees(),
    ));
    text.push_str(&format!(
        "of {} that were left out in turn, {} are inside what the others say, {} inside with what the limit goes beyond it\n",
        found.left_out.len(),
        percent(held(&found.left_out, 0.0)),
        percent(held(&found.left_out, layer(&found.limit))),
    ));
    text.push_str(&format!(
        "without what it depends on, valid are {} of all rotations\n",
        percent(found.limit.learned().valid)
    ));
    text.push_str(&bins_text(&found.limit));
    text
}
