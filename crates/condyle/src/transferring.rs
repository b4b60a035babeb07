//! A learned law put into a model: onto the joint of another figure by three landmarks, or where the model has the coordinates
//! of the law, as it is. An `.osim` comes back as its own text.
//!
//! What is computed is in [`condyle_learn::transfer`]; how a law is written for other programs is in
//! [`expressions()`] and [`blender_driver()`].

mod blender;
mod expressions;
#[cfg(feature = "opensim")]
mod osim;

pub use blender::blender_driver;
pub use expressions::expressions;
#[cfg(feature = "opensim")]
pub use osim::{coupled_text, joint_text};

use condyle_diagnostics::{Diagnostic, Error};
use condyle_formats::document::landmarks::LandmarksDocument;
use condyle_formats::document::law::LawDocument;
use condyle_learn::coupling::{LawFunction, ScaleRule, apply};
use condyle_learn::transfer::{Driver, JointLaws, LawFrame, Standing, TargetJoint, Transfer};
use condyle_model::Model;

/// Figures whose two ratios differ from their mean by more than this share are not of the law's shape: one is at least 1.35 times the other.
pub const MOST_DIFFERENCE: f64 = 0.15;

/// A law made ready for a joint.
#[derive(Clone, Debug)]
pub struct Ready {
    /// The law for the target.
    pub transfer: Transfer,
    /// The joint of the target.
    pub standing: Standing,
    /// The law's side.
    pub law: LawFrame,
    /// How far the law has the joint from where the figure has it, in the posture in which its angles are 0 (metres).
    pub moved: f64,
    /// Whether the joint stays there all the same.
    pub holds: bool,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// Steps 1 to 5 for a joint of a model.
///
/// # Errors
/// `transfer/no-landmarks` where neither document has the law's landmarks; as [`TargetJoint::find`] and [`Transfer::new`].
pub fn ready(
    model: &Model,
    law: &LawDocument,
    landmarks: &LandmarksDocument,
    rule: ScaleRule,
) -> Result<Ready, Error> {
    let target: &TargetJoint = &landmarks.target;
    let Some(frame) = landmarks.law.as_ref().or(law.joint.as_ref()) else {
        let message = "neither the law nor the landmarks say where the law's landmarks are";
        let help = "give [law] in the landmarks, or [joint] in the law: origin, medial, lateral";
        return Err(Error::new("transfer/no-landmarks", message).with_help(help));
    };
    let standing = target.find(model)?;
    let laws: Vec<(&str, &LawFunction)> =
        law.laws.iter().map(|law| (law.dependent.as_str(), &law.function)).collect();
    let joint =
        JointLaws { controls: &law.controls, laws: &laws, region: law.region.as_ref(), frame };
    let elsewhere = |name: &str| target.driver(name);
    let mut transfer =
        Transfer::new(&joint, standing.landmarks, standing.at_zero, rule, &elsewhere)?;
    let mut at = vec![];
    for driver in &transfer.drivers {
        at.push(match driver {
            Driver::Angle(_) => 0.0,
            Driver::Coordinate(name) => {
                let id = model.find_coordinate(name)?;
                let stated = target.zero.iter().find(|(zero, _)| zero == name);
                let stated = stated.and_then(|(_, values)| values.first().copied());
                stated.unwrap_or(model.coordinate(id).default[0])
            }
        });
    }
    let mut warnings = vec![];
    if transfer.ratios.difference() > MOST_DIFFERENCE {
        let message = format!(
            "the figure is not of the law's shape: its parent is {:.2} times as long and {:.2} times as wide",
            transfer.ratios.along, transfer.ratios.across
        );
        let help = "a law of a person means little on a figure that is not built like one; look at the landmarks first";
        warnings.push(Diagnostic::warning("transfer/shape", message).with_help(help));
    }
    let moved = (transfer.frame * transfer.centre(&at) - standing.centre).norm();
    if target.holds {
        transfer.hold(standing.centre, &at);
    } else if moved > 0.25 * (standing.landmarks.medial - standing.landmarks.lateral).norm() {
        let message =
            format!("at rest the joint is {:.0} mm from where the figure has it", 1e3 * moved);
        let help = "look at the landmarks; `holds = true` keeps the joint where it is, and lets it travel by the law";
        warnings.push(Diagnostic::warning("transfer/moved", message).with_help(help));
    }
    Ok(Ready { transfer, standing, law: frame.clone(), moved, holds: target.holds, warnings })
}

/// What the five steps were, a line each.
#[must_use]
pub fn steps(ready: &Ready) -> Vec<String> {
    let Ready { transfer, standing, law, moved, .. } = ready;
    let point = |p: condyle_math::Vec3| format!("[{:.4}, {:.4}, {:.4}]", p.x, p.y, p.z);
    let points = |all: [condyle_math::Vec3; 3]| all.map(point).join(" ");
    let rows = |m: condyle_math::Mat3| {
        let row = |i: usize| format!("[{:.4} {:.4} {:.4}]", m.at(i, 0), m.at(i, 1), m.at(i, 2));
        [row(0), row(1), row(2)].join(" ")
    };
    let [x, y, z] = transfer.factors;
    let [a, b] = transfer.to_law;
    vec![
        format!(
            "1. landmarks of the law's parent (origin, medial, lateral): {}",
            points(law.landmarks.points())
        ),
        format!("2. landmarks of the target's parent: {}", points(standing.landmarks.points())),
        format!(
            "3. scaled: s1 = {:.4}, s2 = {:.4}; along x by {x:.4}, y by {y:.4}, z by {z:.4}",
            transfer.ratios.along, transfer.ratios.across
        ),
        format!(
            "4. the landmarks' frame in the target's parent: at {}, axes {}{}",
            point(transfer.frame.translation),
            rows(transfer.frame.linear),
            if transfer.mirrored { "; mirrored to the other side" } else { "" }
        ),
        format!(
            "5. the joint's orientation T has the law's angles as A·T·B: A = {}, B = {}",
            rows(a),
            rows(b)
        ),
        match ready.holds {
            true => format!(
                "at rest the joint stays; by the law it would be {:.1} mm away",
                1e3 * moved
            ),
            false => format!("at rest the joint moves by {:.1} mm", 1e3 * moved),
        },
    ]
}

/// The model whose coordinates follow by a law, where it has them all by name.
///
/// # Errors
/// As [`apply`].
pub fn onto_named(model: &Model, law: &LawDocument) -> Result<Model, Error> {
    let laws: Vec<(&str, &LawFunction)> =
        law.laws.iter().map(|law| (law.dependent.as_str(), &law.function)).collect();
    let mut coupled = apply(model, &law.controls, law.region.as_ref(), &laws)?;
    coupled.set_name(model.name());
    Ok(coupled)
}
