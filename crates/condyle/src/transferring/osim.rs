//! Laws in the text of an `.osim`.

use super::Ready;
use condyle_diagnostics::{Error, Read};
use condyle_formats::document::law::LawDocument;
use condyle_formats::opensim::coupled::{
    Coupler, JointInPlace, NewCoordinate, SlideOf, TurnOf, with_couplers, with_joint,
};
use condyle_learn::coupling::{LawFunction, of_opposite, scaled};
use condyle_learn::transfer::Driver;
use condyle_math::function::FunctionOfSeveral;
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::{Mode, Model, Pose, Program};

/// A step of a coordinate for a difference quotient, in radians.
const STEP: f64 = 1e-4;
/// An axis of the target within about 37 degrees of one of the law's is that axis: joints with splines turn about oblique ones.
const SAME_AXIS: f64 = 0.8;
/// A coordinate is an angle where a radian of it turns the child by a radian but for this share.
const SAME_RATE: f64 = 0.5;
/// The range of an angle that the target did not have: half a radian to both sides, not enforced.
const RANGE: [f64; 2] = [-0.5, 0.5];

/// The text of a model file whose coordinates follow by a law, where it has them all by name.
///
/// # Errors
/// `transfer/spline` for a law of splines; where the model does not have a coordinate.
pub fn coupled_text(text: &str, law: &LawDocument) -> Result<String, Error> {
    let mut couplers = vec![];
    for one in &law.laws {
        couplers.push(Coupler {
            dependent: one.dependent.clone(),
            drivers: law.controls.clone(),
            function: plain(&one.function, &one.dependent)?,
        });
    }
    with_couplers(text, &couplers)
}

/// A law as one function, which the constraints and joints of OpenSim hold.
fn plain(law: &LawFunction, name: &str) -> Result<FunctionOfSeveral, Error> {
    match law {
        LawFunction::Several(function) => Ok(function.clone()),
        LawFunction::Sum { intercept, parts } => {
            let linear: Option<Vec<(f64, f64)>> = parts
                .iter()
                .map(|part| part.as_linear().or_else(|| part.as_constant().map(|c| (0.0, c))))
                .collect();
            let Some(linear) = linear else {
                let message = format!(
                    "the law of `{name}` is a sum of splines, which a file of OpenSim holds in no single function"
                );
                let help =
                    "learn it with --basis linear or polynomial:3, or write a document (.toml)";
                return Err(Error::new("transfer/spline", message).with_help(help));
            };
            let slopes = linear.iter().map(|(slope, _)| *slope).collect();
            let intercept = intercept + linear.iter().map(|(_, c)| c).sum::<f64>();
            Ok(FunctionOfSeveral::Linear { slopes, intercept })
        }
    }
}

/// The text of a model file in which a joint is the law's: three rotations in its order, a centre that they move. The model's own angles keep
/// their names where their axes are the law's, those that it does not have are added. Where other joints drive the law, couplers are added.
///
/// # Errors
/// As [`coupled_text`] and [`with_joint`]; `transfer/zero` where an angle of the joint itself is not 0 in the zero posture.
pub fn joint_text(text: &str, model: &Model, ready: &Ready) -> Result<Read<String>, Error> {
    let transfer = &ready.transfer;
    let segment = model.segment(ready.standing.segment);
    let axes = law_axes(transfer.to_law[0]);
    let order = transfer.order.axes();
    let own = own_axes(model, ready)?;
    let set = segment.joint_set.map(|id| model.joint_sets()[id.index()].name.clone());
    let stem = set.unwrap_or_else(|| segment.name.clone());
    // For each angle of the law the coordinate and its sign.
    let mut angles: Vec<(String, f64)> = vec![];
    let mut coordinates = vec![];
    for (k, name) in transfer.angles.iter().enumerate() {
        let axis = axes[order[k]];
        let near = own.iter().filter(|(id, direction)| {
            direction.dot(axis).abs() > SAME_AXIS
                && angles.iter().all(|(taken, _)| model.coordinate(*id).name != *taken)
        });
        let along = |direction: &Vec3| direction.dot(axis).abs();
        let same = near.max_by(|(_, a), (_, b)| along(a).total_cmp(&along(b)));
        let (name, sign) = match same {
            Some((id, direction)) => {
                (model.coordinate(*id).name.clone(), direction.dot(axis).signum())
            }
            None => {
                let short = name.rsplit(['/', '_', '.']).next().unwrap_or(name);
                (format!("{stem}_{short}"), 1.0)
            }
        };
        if transfer.turned[k].is_none() {
            coordinates.push(NewCoordinate { name: name.clone(), default: 0.0, range: RANGE });
        }
        angles.push((name, sign));
    }
    let names: Vec<String> = transfer
        .drivers
        .iter()
        .map(|driver| match driver {
            Driver::Angle(k) => angles[*k].0.clone(),
            Driver::Coordinate(name) => name.rsplit('/').next().unwrap_or(name).to_owned(),
        })
        .collect();
    let alone = transfer
        .drivers
        .iter()
        .all(|driver| matches!(driver, Driver::Angle(k) if transfer.turned[*k].is_none()));
    if !alone && transfer.turned.iter().any(Option::is_some) {
        let message = "angles that follow by drivers of other joints are not written as .osim";
        return Err(Error::new("transfer/follows", message).with_help("write a document (.toml)"));
    }
    let signed = |law: &LawFunction| {
        let mut law = law.clone();
        for (place, driver) in transfer.drivers.iter().enumerate() {
            if matches!(driver, Driver::Angle(k) if angles[*k].1 < 0.0) {
                law = of_opposite(&law, place);
            }
        }
        law
    };
    let linear = |slope: f64| FunctionOfSeveral::Linear { slopes: vec![slope], intercept: 0.0 };
    let mut turns = vec![];
    for (k, (name, sign)) in angles.iter().enumerate() {
        let axis = Vec3::UNITS[order[k]];
        turns.push(match &transfer.turned[k] {
            None => TurnOf { axis: axis * *sign, drivers: vec![name.clone()], angle: linear(1.0) },
            Some(law) => TurnOf { axis, drivers: names.clone(), angle: plain(&signed(law), name)? },
        });
    }
    let to_axes = transfer.to_law[0] * transfer.frame.linear;
    let mut slides = vec![];
    let mut couplers = vec![];
    for slide in &transfer.slides {
        let law = signed(&slide.law);
        let along = to_axes * slide.along;
        // A direction against an axis is that axis, so that numbers are those that people expect.
        let against = along.x + along.y + along.z < 0.0;
        let (along, law) = if against { (-along, scaled(&law, -1.0)) } else { (along, law) };
        let function = plain(&law, &slide.name)?;
        if alone {
            slides.push(SlideOf { along, drivers: names.clone(), distance: function });
            continue;
        }
        let short = slide.name.rsplit(['/', '_', '.']).next().unwrap_or(&slide.name);
        let name = format!("{stem}_{short}");
        let at: Vec<f64> = names
            .iter()
            .map(|name| {
                model.find_coordinate(name).map_or(0.0, |id| model.coordinate(id).default[0])
            })
            .collect();
        let default = function.apply(&at);
        coordinates.push(NewCoordinate {
            name: name.clone(),
            default,
            range: [default - 1.0, default + 1.0],
        });
        couplers.push(Coupler { dependent: name.clone(), drivers: names.clone(), function });
        slides.push(SlideOf { along, drivers: vec![name], distance: linear(1.0) });
    }
    for axis in Vec3::UNITS {
        let seen = slides.iter().any(|slide: &SlideOf| slide.along.dot(axis).abs() > 0.6);
        if slides.len() < 3 && !seen {
            let distance = FunctionOfSeveral::Linear { slopes: vec![], intercept: 0.0 };
            slides.push(SlideOf { along: axis, drivers: vec![], distance });
        }
    }
    let lost = || Error::new("transfer/axes", "the translations of the law lie in a plane");
    let new = JointInPlace {
        child: segment.name.clone(),
        in_parent: Affine::new(transfer.to_law[0].transpose(), transfer.frame * transfer.fixed),
        in_child: Affine::new(transfer.to_law[1], segment.joint_in_segment.translation),
        turns: turns.try_into().map_err(|_| lost())?,
        slides: slides.try_into().map_err(|_| lost())?,
        coordinates,
        couplers,
    };
    with_joint(text, &new)
}

/// The law's axes in the target's parent: the columns of Aᵀ.
fn law_axes(a: Mat3) -> [Vec3; 3] {
    Vec3::UNITS.map(|axis| a.transpose() * axis)
}

/// The axes in the parent about which the joint's own coordinates turn the child, while all are 0.
fn own_axes(
    model: &Model,
    ready: &Ready,
) -> Result<Vec<(condyle_model::CoordinateId, Vec3)>, Error> {
    let segment = model.segment(ready.standing.segment);
    let Some(set) = segment.joint_set else { return Ok(vec![]) };
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut turned = |id, value: f64| {
        let mut stored = model.defaults();
        for own in model.coordinates_of(set) {
            *model.value_mut(&mut stored, own) = 0.0;
        }
        *model.value_mut(&mut stored, id) = value;
        program
            .evaluate(&stored, Mode::Open, &mut pose)
            .map_err(|error| Error::new("transfer/posture", error.to_string()))?;
        Ok::<Mat3, Error>(pose.segment_in_parent(model, ready.standing.segment).linear)
    };
    let mut all = vec![];
    for id in model.coordinates_of(set) {
        let coordinate = model.coordinate(id);
        if coordinate.kind.stored() != 1 || coordinate.follows.is_some() {
            continue;
        }
        let (before, after) = (turned(id, -STEP)?, turned(id, STEP)?);
        let axis = (after * before.transpose()).log() * (0.5 / STEP);
        if (axis.norm() - 1.0).abs() < SAME_RATE {
            all.push((id, axis.normalized()));
        }
    }
    Ok(all)
}
