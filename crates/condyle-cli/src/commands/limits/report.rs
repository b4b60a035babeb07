//! `condyle limits report`: the mobility of a joint, and two compared.

use super::Outcome;
use crate::commands::learn::{bins_json, bins_text};
use crate::failure::{Failure, warned};
use crate::output;
use clap::{Args, ValueEnum};
use condyle::learn::limits::{LearnedLimit, State};
use condyle::learning::{self, Axis, Limit, Region, Report as Numbers, Side, Versus};
use condyle::math::Vec3;
use condyle::open;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Tell how mobile a joint is, what to record next, and what two limits have in common.
///
/// Shares are of all rotations there are, by Haar's measure: they depend on no axes and no order of angles.
#[derive(Debug, Args)]
pub(super) struct Report {
    /// The limit: a document of `kind = "limit"`.
    limit: PathBuf,
    /// Another, of another person or side, or learned from more recordings.
    other: Option<PathBuf>,
    /// Compare with the mirror image of the other: the axis that points to the side, z in the axes of the ISB.
    #[arg(long, value_enum, value_name = "AXIS", requires = "other")]
    mirror: Option<Mirror>,
    /// Also tell how far it goes about this axis of the child.
    #[arg(long, value_name = "X,Y,Z", value_parser = axis, allow_hyphen_values = true)]
    axis: Vec<Axis>,
    /// The direction of the bone at the identity, for words: -y of an arm or thigh in the axes of the ISB.
    #[arg(long, value_name = "X,Y,Z", value_parser = axis, allow_hyphen_values = true, default_value = "0,-1,0")]
    bone: Axis,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// An axis that points to the side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mirror {
    X,
    Y,
    Z,
}

pub(super) fn axis(text: &str) -> Result<Axis, String> {
    let parts: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [x, y, z]
            if Vec3::new(x, y, z).norm() > 1e-9
                && x.is_finite()
                && y.is_finite()
                && z.is_finite() =>
        {
            Ok(Axis { name: text.to_owned(), direction: Vec3::new(x, y, z) })
        }
        _ => Err("give three numbers with commas between, not all 0".to_owned()),
    }
}

/// The field of a file; spheres have no distance.
pub(super) fn field(path: &Path) -> Result<Box<LearnedLimit>, Failure> {
    match warned(path, open::any_limit(path)?) {
        Limit::Field(limit) => Ok(limit),
        Limit::Spheres(_) => Err(Failure::new(format!(
            "{}: spheres of Herda et al. 2003 have no distance to report: learn the limit with --method closing",
            path.display()
        ))),
    }
}

impl Report {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        let limit = field(&self.limit)?;
        let other = self.other.as_deref().map(field).transpose()?;
        let bone = self.bone.direction;
        let numbers = learning::report(limit.field(), &self.axis, bone)
            .map_err(|error| Failure::new(format!("{}: {error}", self.limit.display())))?;
        let mirror = self.mirror.map(|mirror| match mirror {
            Mirror::X => Side::X,
            Mirror::Y => Side::Y,
            Mirror::Z => Side::Z,
        });
        let versus = other.as_ref().map(|other| {
            learning::versus(limit.field(), other.field(), mirror, &numbers.regions, bone)
        });
        if self.json {
            output::print_json(&json(&limit, other.as_deref(), &numbers, versus.as_ref()))?;
        } else {
            let mut text = self.text(&limit, &numbers, versus.as_ref());
            text.push_str(&bins_text(&limit));
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    fn text(&self, limit: &LearnedLimit, numbers: &Numbers, versus: Option<&Versus>) -> String {
        let about = limit.about();
        let ground = limit.ground();
        let from = match &ground.shape {
            Some(_) => "by formulas".to_owned(),
            None => format!("{} samples", ground.samples.len()),
        };
        let mut text = format!(
            "{}: {} in {}, {from}\n",
            self.limit.display(),
            about.child,
            about.reference.as_deref().unwrap_or("the laboratory"),
        );
        let bounds = numbers.interval.map_or(String::new(), |interval| {
            format!(
                " (95 %: {:.2} to {:.2}, from {} parts left out in turn)",
                1e2 * interval.low,
                1e2 * interval.high,
                interval.parts
            )
        });
        text.push_str(&format!(
            "valid are {:.2} % of all rotations{bounds}\n",
            1e2 * numbers.share
        ));
        text.push_str(&format!(
            "two valid rotations are up to {:.1}° apart; the middle is {:.1}° from the boundary\n",
            numbers.largest_angle.to_degrees(),
            numbers.depth.to_degrees()
        ));
        text.push_str("about axes of the child: from the middle to the boundary, and the arc of 99 % of the twists\n");
        let rows: Vec<Vec<String>> = numbers
            .about
            .iter()
            .map(|about| {
                let [start, length] = about.twists;
                vec![
                    about.axis.name.clone(),
                    format!("{:.1}°", about.through_middle.backward.to_degrees()),
                    format!("{:.1}°", about.through_middle.forward.to_degrees()),
                    format!("{:.0}° to {:.0}°", start.to_degrees(), (start + length).to_degrees()),
                ]
            })
            .collect();
        text.push_str(&output::columns(&rows));
        text.push_str(
            "in joint coordinate systems: share, ranges of 99 %, share of the box of all angles\n",
        );
        let rows: Vec<Vec<String>> = numbers
            .systems
            .iter()
            .map(|(name, system)| {
                let mut row = vec![(*name).to_owned(), format!("{:.2} %", 1e2 * system.share)];
                row.extend(system.ranges.iter().map(|[low, high]| {
                    format!("{:.0}° to {:.0}°", low.to_degrees(), high.to_degrees())
                }));
                row.push(format!("{:.2} %", 1e2 * system.share_of_angles));
                row
            })
            .collect();
        text.push_str(&output::columns(&rows));
        text.push_str(&self.regions(numbers, versus));
        if let Some(versus) = versus {
            text.push_str(&self.versus(versus));
        }
        text
    }

    fn regions(&self, numbers: &Numbers, versus: Option<&Versus>) -> String {
        if numbers.regions.is_empty() {
            return "no suspected holes, and no thin regions\n".to_owned();
        }
        let mut text =
            "to record next: suspected holes, and regions far from all samples\n".to_owned();
        let states = versus.map_or(&[][..], |versus| &versus.regions);
        let rows: Vec<Vec<String>> = numbers
            .regions
            .iter()
            .enumerate()
            .map(|(index, region)| {
                let mut row = vec![
                    if region.thin.hole { "hole" } else { "thin" }.to_owned(),
                    region.placed.words(),
                    format!("nearest sample {:.1}° away", region.thin.radius.to_degrees()),
                    format!("{:.3} %", 1e2 * region.thin.share),
                ];
                if let Some(state) = states.get(index) {
                    row.push(told(*state).to_owned());
                }
                row
            })
            .collect();
        text.push_str(&output::columns(&rows));
        text
    }

    fn versus(&self, versus: &Versus) -> String {
        let compared = &versus.compared;
        let [a, b] = compared.shares.map(|share| 1e2 * share);
        let other = self.other.as_deref().unwrap_or(Path::new("")).display();
        let mut text = format!(
            "beside {other}: {a:.2} % and {b:.2} % of all rotations, {:.2} % in both; in common {:.1} % of what is in either\n",
            1e2 * compared.both,
            1e2 * compared.overlap()
        );
        let names = [self.limit.display().to_string(), other.to_string()];
        for (far, name, placed) in compared
            .beyond
            .iter()
            .zip(&names)
            .zip(&versus.beyond)
            .map(|((far, name), placed)| (far, name, placed))
        {
            if let (Some(far), Some(placed)) = (far, placed) {
                text.push_str(&format!(
                    "{name} goes up to {:.1}° beyond: {}\n",
                    far.distance.to_degrees(),
                    placed.words()
                ));
            }
        }
        text
    }
}

/// What another limit makes of a suspected hole.
fn told(state: State) -> &'static str {
    match state {
        State::Valid => "closed by the other",
        State::Unknown => "unknown to the other as well",
        State::Invalid => "outside of the other",
    }
}

fn region(region: &Region, state: Option<&State>) -> Value {
    json!({
        "kind": if region.thin.hole { "hole" } else { "thin" },
        "centre": region.thin.centre.to_array(),
        "radius_deg": region.thin.radius.to_degrees(),
        "share": region.thin.share,
        "plane_deg": region.placed.plane.to_degrees(),
        "elevation_deg": region.placed.elevation.to_degrees(),
        "twist_deg": region.placed.twist.to_degrees(),
        "words": region.placed.words(),
        "other": state.map(|state| state.name()),
    })
}

fn json(
    limit: &LearnedLimit,
    other: Option<&LearnedLimit>,
    numbers: &Numbers,
    versus: Option<&Versus>,
) -> Value {
    let about = |about: &learning::About| {
        json!({
            "axis": about.axis.direction.to_array(),
            "backward_deg": about.through_middle.backward.to_degrees(),
            "forward_deg": about.through_middle.forward.to_degrees(),
            "twist_deg": [
                about.twists[0].to_degrees(),
                (about.twists[0] + about.twists[1]).to_degrees(),
            ],
        })
    };
    let system = |(name, system): &(&str, condyle::learn::limits::mobility::InSystem)| {
        json!({
            "order": name,
            "share": system.share,
            "share_of_angles": system.share_of_angles,
            "ranges_deg": system.ranges.map(|range| range.map(f64::to_degrees)),
        })
    };
    let interval = numbers.interval.map(|interval| {
        json!({
            "low": interval.low,
            "high": interval.high,
            "parts": interval.parts,
            "mean_without_one": interval.without_one,
        })
    });
    let states = versus.map_or(&[][..], |versus| &versus.regions);
    let regions: Vec<Value> =
        numbers.regions.iter().enumerate().map(|(i, r)| region(r, states.get(i))).collect();
    let ground = limit.ground();
    json!({
        "child": limit.about().child,
        "reference": limit.about().reference,
        "source": limit.about().source,
        "samples": ground.samples.len(),
        "share": numbers.share,
        "share_95": interval,
        "unknown_share": limit.field().learned().outer - limit.field().learned().valid,
        "middle": numbers.middle.to_array(),
        "depth_deg": numbers.depth.to_degrees(),
        "largest_angle_deg": numbers.largest_angle.to_degrees(),
        "axes": numbers.about.iter().map(about).collect::<Vec<_>>(),
        "systems": numbers.systems.iter().map(system).collect::<Vec<_>>(),
        "thin_from_deg": numbers.thin_from.to_degrees(),
        "regions": regions,
        "given": bins_json(limit),
        "compared": versus.zip(other).map(|(versus, other)| compared(versus, other)),
    })
}

fn compared(versus: &Versus, other: &LearnedLimit) -> Value {
    let compared = &versus.compared;
    let beyond: Vec<Value> = compared
        .beyond
        .iter()
        .zip(&versus.beyond)
        .map(|(far, placed)| match far.zip(*placed) {
            Some((far, placed)) => json!({
                "distance_deg": far.distance.to_degrees(),
                "at": far.at.to_array(),
                "words": placed.words(),
            }),
            None => Value::Null,
        })
        .collect();
    json!({
        "child": other.about().child,
        "source": other.about().source,
        "shares": compared.shares,
        "both": compared.both,
        "in_common": compared.overlap(),
        "largest_distance_deg": compared.largest().to_degrees(),
        "beyond": beyond,
    })
}
