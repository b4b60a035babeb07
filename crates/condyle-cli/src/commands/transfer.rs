//! `condyle transfer`: a learned law put into another model.

use super::Outcome;
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use crate::screen::say;
use clap::{Args, ValueEnum};
use condyle::formats::document;
use condyle::formats::document::law::LawDocument;
use condyle::learn::coupling::ScaleRule;
use condyle::learn::transfer::Driver;
use condyle::transferring::{
    Ready, blender_driver, coupled_text, expressions, joint_text, onto_named, ready, steps,
};
use condyle::{Model, open};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Put a learned law into a model: onto the joint of another figure by three landmarks, or where the model has the coordinates of the law.
///
/// Without --landmarks the law goes as it is into a model that has its coordinates by name. With them it is scaled and turned by three
/// landmarks of the joint's parent. An `.osim` written as `.osim` keeps all else; any model or skeleton (.glb, .bvh, ...) can be
/// written as a document, in which the joint's rotation drives the law.
#[derive(Debug, Args)]
pub(crate) struct Transfer {
    /// The law, a document of `kind = "law"`.
    law: PathBuf,
    /// The model, or a file that holds a skeleton.
    #[arg(long, value_name = "MODEL")]
    onto: PathBuf,
    /// Where the landmarks are, a document of `kind = "landmarks"`.
    #[arg(long, value_name = "L.toml")]
    landmarks: Option<PathBuf>,
    /// What laws are scaled by: each axis by its own ratio, or all by the mean as Pronost et al. 2010 do.
    #[arg(long, value_enum, default_value_t = Scaling::PerAxis, requires = "landmarks")]
    scale: Scaling,
    /// The model with the law: a document (.toml), or an `.osim` where the model is one; `-` is standard output.
    #[arg(short, long, value_name = "MODEL")]
    output: PathBuf,
    /// The scaled law as plain expressions with units, order and frame.
    #[arg(long, value_name = "E.txt", requires = "landmarks")]
    expressions: Option<PathBuf>,
    /// A script that makes it a driver in Blender.
    #[arg(long, value_name = "D.py", requires = "landmarks")]
    blender: Option<PathBuf>,
    /// All numbers, in JSON.
    #[arg(long, value_name = "R.json", requires = "landmarks")]
    report: Option<PathBuf>,
}

/// How laws are scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Scaling {
    /// s1 for y, s2 for z, their mean for x.
    PerAxis,
    /// Equation 3 of Pronost et al. 2010: the mean for all.
    Mean,
}

impl Transfer {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let to_screen = output::is_standard(&self.output);
        let ending = if to_screen { "toml".to_owned() } else { open::ending(&self.output) };
        let as_text = match ending.as_str() {
            "toml" => false,
            "osim" if open::ending(&self.onto) == "osim" => true,
            "osim" => {
                let path = self.onto.display();
                let message =
                    format!("{path}: only an .osim comes back as one: write a document (.toml)");
                return Err(Failure::new(message));
            }
            other => {
                let path = self.output.display();
                let message = format!(
                    "{path}: the model is written as .toml or .osim, not as .{other}; `convert` bakes its motions"
                );
                return Err(Failure::new(message));
            }
        };
        let inputs: Vec<&Path> = [&self.law, &self.onto]
            .into_iter()
            .chain(&self.landmarks)
            .map(PathBuf::as_path)
            .collect();
        let outputs: Vec<&Path> = std::iter::once(&self.output)
            .chain(&self.expressions)
            .chain(&self.blender)
            .chain(&self.report)
            .map(PathBuf::as_path)
            .collect();
        output::check_distinct(&inputs, &outputs)?;
        let law = warned(&self.law, open::law(&self.law)?);
        let text = match as_text {
            true => Some(warned(&self.onto, open::osim_text(&self.onto)?)),
            false => None,
        };
        let model = warned(&self.onto, open::figure(&self.onto)?).model;
        let Some(path) = &self.landmarks else {
            return self.by_name(&law, &model, text.as_deref());
        };
        let mut landmarks = warned(path, open::landmarks(path)?);
        if as_text {
            zero_of_joint(&model, &mut landmarks.target)?;
        }
        let rule = match self.scale {
            Scaling::PerAxis => ScaleRule::PerAxis,
            Scaling::Mean => ScaleRule::Mean,
        };
        let made = ready(&model, &law, &landmarks, rule)
            .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
        warn_about(path, &made.warnings);
        for step in steps(&made) {
            say(&step);
        }
        let bytes = match &text {
            Some(text) => warned(&self.onto, joint_text(text, &model, &made)?).into_bytes(),
            None => document::write(&made.transfer.onto(&model, &made.standing)?).into_bytes(),
        };
        let target = landmarks.target.joint.as_str();
        let said = |error: String| Failure::new(format!("{}: {error}", self.law.display()));
        let written = self.expressions.as_ref().map(|_| expressions(&made, target).map_err(said));
        let driver = self.blender.as_ref().map(|_| blender_driver(&made, &model).map_err(said));
        output::write(&self.output, &bytes)?;
        for (path, text) in [(&self.expressions, written), (&self.blender, driver)] {
            if let (Some(path), Some(text)) = (path, text) {
                output::write(path, text?.as_bytes())?;
            }
        }
        if let Some(path) = &self.report {
            output::write(path, format!("{:#}\n", report(&made, &model)).as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    /// The law as it is, in a model that has its coordinates.
    fn by_name(
        &self,
        law: &LawDocument,
        model: &Model,
        text: Option<&str>,
    ) -> Result<Outcome, Failure> {
        let wrong =
            |error: condyle::Error| Failure::new(format!("{}: {error}", self.onto.display()));
        let bytes = match text {
            Some(text) => coupled_text(text, law).map_err(wrong)?.into_bytes(),
            None => document::write(&onto_named(model, law).map_err(wrong)?).into_bytes(),
        };
        output::write(&self.output, &bytes)?;
        Ok(Outcome::Done)
    }
}

/// In an `.osim` the joint's own angles are those of the law: both are 0 at once.
fn zero_of_joint(
    model: &Model,
    target: &mut condyle::learn::transfer::TargetJoint,
) -> Result<(), Failure> {
    let found = target.find(model)?;
    let Some(set) = model.segment(found.segment).joint_set else { return Ok(()) };
    for id in model.coordinates_of(set) {
        let key = model.coordinate_key(id);
        match target.zero.iter().find(|(name, _)| *name == key) {
            Some((_, values)) if values.iter().any(|value| *value != 0.0) => {
                let message = format!(
                    "`zero` has {key} = {values:?}: in an .osim the joint's own angles are 0 where the law's are; give it another \
                     zero posture, or write a document (.toml)"
                );
                return Err(Failure::new(message));
            }
            Some(_) => {}
            None => target.zero.push((key, vec![0.0])),
        }
    }
    Ok(())
}

fn report(made: &Ready, model: &Model) -> Value {
    let t = &made.transfer;
    let matrix =
        |m: condyle::math::Mat3| json!([0, 1, 2].map(|i| [m.at(i, 0), m.at(i, 1), m.at(i, 2)]));
    let zero = vec![0.0; t.controls.len()];
    let drivers = t.drivers.iter().zip(&t.controls).map(|(driver, control)| match driver {
        Driver::Angle(k) => json!({ "control": control, "angle": t.angles[*k] }),
        Driver::Coordinate(name) => json!({ "control": control, "coordinate": name }),
    });
    let laws = t.slides.iter().map(|slide| {
        let slopes = t.controls.iter().enumerate();
        let slopes: serde_json::Map<String, Value> =
            slopes.map(|(k, name)| (name.clone(), json!(slide.law.slope(&zero, k)))).collect();
        json!({
            "dependent": slide.name,
            "along": slide.along.to_array(),
            "factor": slide.factor,
            "value_at_0": slide.law.value(&zero),
            "slopes_at_0": slopes,
        })
    });
    json!({
        "segment": model.segment(made.standing.segment).name,
        "steps": steps(made),
        "s1": t.ratios.along,
        "s2": t.ratios.across,
        "factors": t.factors,
        "difference": t.ratios.difference(),
        "mirrored": t.mirrored,
        "landmarks_of_law_m": made.law.landmarks.points().map(|p| p.to_array()),
        "landmarks_of_target_m": made.standing.landmarks.points().map(|p| p.to_array()),
        "frame_in_parent": { "origin_m": t.frame.translation.to_array(), "axes": matrix(t.frame.linear) },
        "a": matrix(t.to_law[0]),
        "b": matrix(t.to_law[1]),
        "moved_at_rest_m": made.moved,
        "fixed_m": t.fixed.to_array(),
        "drivers": drivers.collect::<Vec<_>>(),
        "laws": laws.collect::<Vec<_>>(),
    })
}
