//! `condyle limits engine`: a learned limit in the numbers of game and robot engines.

use super::Outcome;
use super::report::{axis, field};
use crate::failure::Failure;
use crate::output;
use clap::Args;
use condyle::learn::limits::LearnedLimit;
use condyle::learning::{self, Aim, Axis, ConeTwist, Engines, Fitted, Law, Loss, Lost, ReachCone};
use condyle::math::{Quat, Vec3};
use condyle::open;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Tell what game and robot engines can hold of a limit, in their own numbers, and what is lost.
///
/// The nearest cone of swing with a range of twist for Jolt, PhysX and MuJoCo, each by its own law, and the nearest reach cone: N
/// directions, each with a range of twist. docs/engines.md says which number goes where.
#[derive(Debug, Args)]
pub(super) struct Engine {
    /// The limit: a document of `kind = "limit"`.
    limit: PathBuf,
    /// Directions of the reach cone, from 6 to 256.
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u16).range(6..=256))]
    directions: u16,
    /// The direction of the bone in the child: -y of an arm or thigh in the axes of the ISB.
    #[arg(long, value_name = "X,Y,Z", value_parser = axis, allow_hyphen_values = true, default_value = "0,-1,0")]
    bone: Axis,
    /// Allow nothing that the limit does not; without it false accepts and false rejects together are made least.
    #[arg(long)]
    inside: bool,
    /// Where to write it: .json has all numbers, .csv the reach cone, .toml the reach cone as a model with a `cone`; `-` is
    /// standard output, as .json.
    #[arg(short, long, value_name = "TABLE")]
    output: Option<PathBuf>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

impl Engine {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output.as_deref() == Some(Path::new("-"));
        if self.json && to_screen {
            let message = "--json and -o - both want standard output: give one of them";
            return Err(Failure::new(message));
        }
        let outputs: Vec<&Path> = self.output.iter().map(PathBuf::as_path).collect();
        output::check_distinct(&[&self.limit], &outputs)?;
        let ending = self.output.as_deref().filter(|_| !to_screen).map(open::ending);
        if let (Some(path), Some(ending)) = (&self.output, &ending)
            && !["json", "csv", "toml"].contains(&ending.as_str())
        {
            return Err(Failure::new(format!(
                "{}: a table is written as .json, .csv or .toml",
                path.display()
            )));
        }
        let limit = field(&self.limit)?;
        let wrong =
            |error: condyle::Error| Failure::new(format!("{}: {error}", self.limit.display()));
        let aim = if self.inside { Aim::Inside } else { Aim::Closest };
        let directions = usize::from(self.directions);
        let found = learning::engines(limit.field(), self.bone.direction, directions, aim)
            .map_err(wrong)?;
        if let Some(path) = &self.output {
            let text = match ending.as_deref() {
                Some("csv") => csv(&limit, &found),
                Some("toml") => {
                    let model =
                        learning::reach_document(&found.reach, limit.about()).map_err(wrong)?;
                    format!("{}{model}", remarks(&limit, &found))
                }
                _ => format!("{:#}\n", json(&limit, &found)),
            };
            output::write(path, text.as_bytes())?;
        }
        if self.json {
            output::print_json(&json(&limit, &found))?;
        } else if !to_screen {
            output::print(self.text(&limit, &found).as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    fn text(&self, limit: &LearnedLimit, found: &Engines) -> String {
        let about = limit.about();
        let reference = about.reference.as_deref().unwrap_or("the laboratory");
        let mut text = format!(
            "{}: {} in {reference}, bone along {}, valid are {:.2} % of all rotations\n",
            self.limit.display(),
            about.child,
            self.bone.name,
            1e2 * found.cone.loss.field
        );
        text.push_str(match found.aim {
            Aim::Closest => "nearest: false accepts and false rejects together are least\n",
            Aim::Inside => "inside: nothing is allowed that the limit does not allow\n",
        });
        text.push_str(
            "swing about y, about z and twist; false accepts and rejects as parts of what is valid, and how far they are off: mean, 95 %, most\n",
        );
        let mut rows = vec![];
        for fitted in std::iter::once(&found.cone).chain(&found.engines) {
            let cone = &fitted.cone;
            let [a, b, twist] = [cone.swing[0], cone.swing[1], cone.twist].map(f64::to_degrees);
            let numbers = match cone.law {
                Law::MujocoBall => format!("{a:.1}° in all"),
                _ => format!("{a:.1}°, {b:.1}°, ±{twist:.1}°"),
            };
            rows.push(row(cone.law.name(), numbers, &fitted.loss));
        }
        let count = found.reach.cone.points().len();
        rows.push(row("reach cone", format!("{count} directions"), &found.reach_loss));
        text.push_str(&output::columns(&rows));
        text
    }
}

fn row(name: &str, numbers: String, loss: &Loss) -> Vec<String> {
    let lost = |name: &str, lost: &Lost| {
        let [mean, most, largest] = [lost.mean, lost.most, lost.largest].map(f64::to_degrees);
        let part = 1e2 * lost.of_field;
        format!("{name} {part:.1} % ({mean:.1}°, {most:.1}°, {largest:.1}°)")
    };
    vec![name.to_owned(), numbers, lost("accepts", &loss.accepts), lost("rejects", &loss.rejects)]
}

fn lost(lost: &Lost) -> Value {
    json!({
        "share": lost.share,
        "of_field": lost.of_field,
        "mean_deg": lost.mean.to_degrees(),
        "p95_deg": lost.most.to_degrees(),
        "largest_deg": lost.largest.to_degrees(),
    })
}

fn loss(loss: &Loss) -> Value {
    json!({
        "allowed_share": loss.allowed,
        "false_accepts": lost(&loss.accepts),
        "false_rejects": lost(&loss.rejects),
        "rotations": loss.count,
    })
}

fn vector(v: Vec3) -> [f64; 3] {
    v.to_array()
}

/// As MuJoCo has it: the real part first.
fn real_first(q: Quat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

/// The numbers by the names that the engine gives them; angles in radians, as all three take them.
fn settings(cone: &ConeTwist) -> Value {
    let [[twist_1, plane_1], [twist_2, plane_2]] = cone.axes().map(|axes| axes.map(vector));
    let ([a, b], twist) = (cone.swing, cone.twist);
    let frames = [cone.in_reference(), cone.in_child].map(Quat::to_array);
    match cone.law {
        Law::Angle => Value::Null,
        Law::JoltCone | Law::JoltPyramid => json!({
            "mSwingType": if cone.law == Law::JoltCone { "Cone" } else { "Pyramid" },
            "mTwistAxis1": twist_1,
            "mPlaneAxis1": plane_1,
            "mTwistAxis2": twist_2,
            "mPlaneAxis2": plane_2,
            "mNormalHalfConeAngle": b,
            "mPlaneHalfConeAngle": a,
            "mTwistMinAngle": -twist,
            "mTwistMaxAngle": twist,
        }),
        Law::PhysxCone => json!({
            "localPose0.q": frames[0],
            "localPose1.q": frames[1],
            "PxJointLimitCone": { "yAngle": a, "zAngle": b },
            "PxJointAngularLimitPair": { "lower": -twist, "upper": twist },
        }),
        Law::PhysxPyramid => json!({
            "localPose0.q": frames[0],
            "localPose1.q": frames[1],
            "PxJointLimitPyramid": { "yAngleMin": -a, "yAngleMax": a, "zAngleMin": -b, "zAngleMax": b },
            "PxJointAngularLimitPair": { "lower": -twist, "upper": twist },
        }),
        Law::MujocoBall => json!({
            "body quat": real_first(cone.middle),
            "joint": [{ "type": "ball", "range": [0.0, a] }],
        }),
        Law::MujocoHinges => {
            let axes = cone.in_child.to_mat3();
            let hinge = |axis: Vec3, most: f64| json!({ "type": "hinge", "axis": vector(axis), "range": [-most, most] });
            json!({
                "body quat": real_first(cone.middle),
                "joint": [hinge(axes.y, a), hinge(axes.z, b), hinge(axes.x, twist)],
            })
        }
    }
}

fn fitted(fitted: &Fitted) -> Value {
    let cone = &fitted.cone;
    let mut value = json!({
        "law": cone.law.name(),
        "middle": cone.middle.to_array(),
        "frame_in_reference": cone.in_reference().to_array(),
        "frame_in_child": cone.in_child.to_array(),
        "swing_y_deg": cone.swing[0].to_degrees(),
        "loss": loss(&fitted.loss),
    });
    if cone.law.twists() {
        value["swing_z_deg"] = json!(cone.swing[1].to_degrees());
        value["twist_deg"] = json!([-cone.twist.to_degrees(), cone.twist.to_degrees()]);
    } else {
        value["swing_z_deg"] = value["swing_y_deg"].clone();
    }
    if cone.law != Law::Angle {
        value["settings"] = settings(cone);
    }
    value
}

/// A corner: its azimuth about the bone from y toward z of the frame in the child, its angle from the bone, its direction in the
/// frame that is turned by the middle, and its twists.
struct Corner {
    azimuth: f64,
    angle: f64,
    direction: Vec3,
    twist: [f64; 2],
}

fn corners(reach: &ReachCone, in_child: Quat) -> Vec<Corner> {
    let frame = in_child.to_mat3();
    let at_rest = reach.cone.twist_at_rest().unwrap_or([-180.0, 180.0]);
    let points = reach.cone.points().iter();
    points
        .map(|point| {
            let direction = point.direction.normalized();
            let [x, y, z] = [frame.x, frame.y, frame.z].map(|axis| axis.dot(direction));
            Corner {
                // To a billionth of a degree, so that what is a little less than 0 is not 360.
                azimuth: ((z.atan2(y).to_degrees() * 1e9).round() / 1e9).rem_euclid(360.0),
                angle: y.hypot(z).atan2(x).to_degrees(),
                direction,
                twist: point.twist.unwrap_or(at_rest).map(f64::to_degrees),
            }
        })
        .collect()
}

fn json(limit: &LearnedLimit, found: &Engines) -> Value {
    let about = limit.about();
    let reach = &found.reach;
    let corners = corners(reach, found.cone.cone.in_child);
    let corner = |corner: &Corner| {
        json!({
            "azimuth_deg": corner.azimuth,
            "swing_deg": corner.angle,
            "direction": vector(corner.direction),
            "direction_in_reference": vector(reach.middle.to_mat3() * corner.direction),
            "twist_deg": corner.twist,
        })
    };
    json!({
        "child": about.child,
        "reference": about.reference,
        "source": about.source,
        "bone": vector(found.bone.normalized()),
        "aim": match found.aim { Aim::Closest => "closest", Aim::Inside => "inside" },
        "field_share": found.cone.loss.field,
        "cone_twist": fitted(&found.cone),
        "engines": found.engines.iter().map(fitted).collect::<Vec<_>>(),
        "reach_cone": {
            "middle": reach.middle.to_array(),
            "twist_at_rest_deg": reach.cone.twist_at_rest().map(|ends| ends.map(f64::to_degrees)),
            "directions": corners.iter().map(corner).collect::<Vec<_>>(),
            "loss": loss(&found.reach_loss),
        },
    })
}

/// What a table says of itself in lines that begin with `#`.
fn remarks(limit: &LearnedLimit, found: &Engines) -> String {
    let about = limit.about();
    let (accepts, rejects) = (&found.reach_loss.accepts, &found.reach_loss.rejects);
    let part = |lost: &Lost| {
        let [mean, largest] = [lost.mean, lost.largest].map(f64::to_degrees);
        format!(
            "{:.2} % of what is valid, by {mean:.1} degrees on average and {largest:.1} at most",
            1e2 * lost.of_field
        )
    };
    // A name of a file may hold anything but must not end the line.
    let one_line = |text: &str| text.replace(|c: char| c.is_control(), " ");
    format!(
        "# The reach cone of {} in {}: {}.\n# Allowed and not valid: {}.\n# Valid and not allowed: {}.\n",
        one_line(&about.child),
        one_line(about.reference.as_deref().unwrap_or("the laboratory")),
        one_line(&about.source),
        part(accepts),
        part(rejects),
    )
}

fn csv(limit: &LearnedLimit, found: &Engines) -> String {
    let mut text = remarks(limit, found);
    let [x, y, z, w] = found.reach.middle.to_array();
    let [low, high] =
        found.reach.cone.twist_at_rest().unwrap_or([-180.0, 180.0]).map(f64::to_degrees);
    // Writing to a string cannot fail.
    let _ = writeln!(text, "# middle={x},{y},{z},{w}");
    let _ = writeln!(text, "# twist_at_rest_deg={low},{high}");
    text.push_str("azimuth_deg,swing_deg,dx,dy,dz,twist_min_deg,twist_max_deg\n");
    for corner in corners(&found.reach, found.cone.cone.in_child) {
        let [x, y, z] = vector(corner.direction);
        let [low, high] = corner.twist;
        let _ = writeln!(text, "{},{},{x},{y},{z},{low},{high}", corner.azimuth, corner.angle);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The settings that MuJoCo was asked with (`oracles/engines/mujoco.json`), and those of the other engines kept beside, are
    /// what is written for the same cones.
    #[test]
    fn settings_are_those_that_mujoco_was_asked_with() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/engines/mujoco.json");
        let text = std::fs::read_to_string(path).expect("the kept answers");
        let answers: Value = serde_json::from_str(&text).expect("JSON");
        let number = |value: &Value| value.as_f64().expect("a number");
        for law in Law::ALL.into_iter().filter(|law| *law != Law::Angle) {
            let laws = answers["laws"].as_array().expect("laws");
            let kept = laws.iter().find(|kept| kept["law"] == law.name()).expect("the law");
            let quat = |name: &str| Quat::from([0, 1, 2, 3].map(|i| number(&kept[name][i])));
            let radians = |value: &Value| number(value).to_radians();
            let cone = ConeTwist {
                law,
                middle: quat("middle"),
                in_child: quat("frame_in_child"),
                swing: [radians(&kept["swing_y_deg"]), radians(&kept["swing_z_deg"])],
                twist: radians(&kept["twist_deg"][1]),
            };
            assert_alike(&settings(&cone), &kept["settings"]);
        }
    }

    fn assert_alike(ours: &Value, kept: &Value) {
        match (ours, kept) {
            (Value::Array(ours), Value::Array(kept)) => {
                assert_eq!(ours.len(), kept.len());
                ours.iter().zip(kept).for_each(|(a, b)| assert_alike(a, b));
            }
            (Value::Object(ours), Value::Object(kept)) => {
                assert_eq!(ours.len(), kept.len());
                ours.iter().for_each(|(key, value)| assert_alike(value, &kept[key]));
            }
            (Value::Number(ours), Value::Number(kept)) => {
                let [a, b] = [ours, kept].map(|n| n.as_f64().expect("a number"));
                assert!((a - b).abs() < 1e-12, "{a} {b}");
            }
            _ => assert_eq!(ours, kept),
        }
    }
}
