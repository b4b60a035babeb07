//! `condyle learn joint`: a free joint from a standing trial.

use crate::commands::{Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warned};
use crate::output;
use crate::screen::say;
use clap::Args;
use condyle::Error;
use condyle::formats::document;
use condyle::learn::calibration::{FreeJoint, Functional};
use condyle::math::EulerOrder;
use condyle::open;
use std::path::{Path, PathBuf};

/// The joint that is calibrated: the markers of its segments and the landmarks of its frame.
#[derive(Clone, Debug, Args)]
pub(super) struct Landmarks {
    /// The joint's name; its coordinates begin with it.
    #[arg(long, default_value = "knee_r")]
    pub(super) name: String,
    /// The parent segment and its markers, three or more.
    #[arg(long, value_name = "SEGMENT=M1,M2,...", default_value = "thigh_r=RGT,RLFE,RMFE", value_parser = segment)]
    pub(super) parent: (String, Vec<String>),
    /// The child segment and its markers, three or more.
    #[arg(long, value_name = "SEGMENT=M1,M2,...", default_value = "shank_r=RTT,RFH,RMEDMAL,RLATMAL", value_parser = segment)]
    pub(super) child: (String, Vec<String>),
    /// The marker at the parent's origin, above the joint.
    #[arg(long, value_name = "MARKER", default_value = "RGT")]
    pub(super) origin: String,
    /// The marker at the medial end of the joint.
    #[arg(long, value_name = "MARKER", default_value = "RMFE")]
    pub(super) medial: String,
    /// The marker at the lateral end of the joint.
    #[arg(long, value_name = "MARKER", default_value = "RLFE")]
    pub(super) lateral: String,
    /// The joint is on the left side.
    #[arg(long)]
    pub(super) left: bool,
}

/// Make a model of two segments with a free joint between them from a standing trial: with it `learn coupling` tracks.
///
/// The joint's frame comes from landmarks: z along its medial and lateral end to the right, y toward the marker at the parent's
/// origin, x forward. Both segments have these axes while the person stands, so that all angles are 0 there. Markers of the lists are placed as the trial shows
/// them; a landmark that later trials do not show stays where the others say it is.
#[derive(Debug, Args)]
pub(super) struct Joint {
    /// The standing trial.
    #[arg(value_name = "STATIC")]
    trial: PathBuf,
    #[command(flatten)]
    landmarks: Landmarks,
    /// The axes of both segments: a document of `kind = "recipe"` whose reference is the parent, or a shipped one such as knee-isb. The angles
    /// of the standing person are not 0 then.
    #[arg(long, value_name = "R.toml")]
    recipe: Option<PathBuf>,
    /// A trial in which the joint turns about all axes: its centre comes from there (hip, shoulder).
    #[arg(long, value_name = "TRIAL", conflicts_with = "functional_axis")]
    functional_centre: Option<PathBuf>,
    /// A trial in which the joint bends: its axis comes from there (knee, elbow), and the centre is the axis' point between the ends.
    #[arg(long, value_name = "TRIAL")]
    functional_axis: Option<PathBuf>,
    /// The order of the rotations; zxy is that of Grood & Suntay.
    #[arg(long, default_value = "zxy")]
    order: EulerOrder,
    /// The names of the rotations in that order.
    #[arg(long, value_delimiter = ',', num_args = 3, default_value = "flexion,adduction,rotation")]
    angles: Vec<String>,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// The model, a document; `-` is standard output.
    #[arg(short, long, value_name = "M.toml")]
    output: PathBuf,
}

/// Markers of a person who stands move by less, in metres.
const STILL: f64 = 0.03;

pub(super) fn segment(text: &str) -> Result<(String, Vec<String>), String> {
    let (name, markers) = text.split_once('=').ok_or("give SEGMENT=M1,M2,...")?;
    let markers: Vec<String> =
        markers.split(',').map(|m| m.trim().to_owned()).filter(|m| !m.is_empty()).collect();
    match name.trim() {
        "" => Err("there is no segment before `=`".to_owned()),
        _ if markers.len() < 3 => Err("a segment needs three markers".to_owned()),
        name => Ok((name.to_owned(), markers)),
    }
}

impl Joint {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        if !output::is_standard(&self.output) && open::ending(&self.output) != "toml" {
            let path = self.output.display();
            let message = format!("{path}: the model is written as a document: end it in .toml");
            return Err(Failure::new(message));
        }
        let inputs: Vec<&Path> = [&self.trial]
            .into_iter()
            .chain(
                [&self.recipe, &self.functional_centre, &self.functional_axis]
                    .into_iter()
                    .flatten(),
            )
            .map(PathBuf::as_path)
            .collect();
        output::check_distinct(&inputs, &[self.output.as_path()])?;
        let read = open::recording_with(&self.trial, zeros(self.zeros))?;
        let standing = warned(&self.trial, read);
        let axes = match &self.recipe {
            Some(path) => Some(warned(path, open::recipe(path)?)),
            None => None,
        };
        let Ok(angles) = <[String; 3]>::try_from(self.angles.clone()) else {
            return Err(Failure::new("--angles needs three names"));
        };
        let landmarks = self.landmarks;
        let joint = FreeJoint {
            name: landmarks.name,
            segments: [landmarks.parent.0, landmarks.child.0],
            markers: [landmarks.parent.1, landmarks.child.1],
            origin: landmarks.origin,
            ends: [landmarks.medial, landmarks.lateral],
            left: landmarks.left,
            order: self.order,
            angles,
            axes,
        };
        let of = |path: &Path| {
            let path = path.to_owned();
            move |error: Error| Failure::new(format!("{}: {error}", path.display()))
        };
        let functional = match (&self.functional_centre, &self.functional_axis) {
            (Some(path), _) => {
                let motion = warned(path, open::recording_with(path, zeros(self.zeros))?);
                let found = Functional::centre(&standing, &motion, &joint.markers);
                Some((path, found.map_err(of(path))?))
            }
            (None, Some(path)) => {
                let motion = warned(path, open::recording_with(path, zeros(self.zeros))?);
                let found = Functional::axis(&standing, &motion, &joint.markers);
                Some((path, found.map_err(of(path))?))
            }
            (None, None) => None,
        };
        let landmarks = joint.frames(&standing, None).map_err(of(&self.trial))?;
        let frames = match &functional {
            None => landmarks,
            Some((path, found)) => {
                let frames = joint.frames(&standing, Some(found)).map_err(of(&self.trial))?;
                let away = (frames.child.translation - landmarks.child.translation).norm();
                let message = format!(
                    "{}: {}; {:.1} mm from the middle of the ends",
                    path.display(),
                    found.describe(),
                    1e3 * away
                );
                say(&message);
                frames
            }
        };
        let model = joint.model_at(&standing, &frames).map_err(of(&self.trial))?;
        let unrest = joint.unrest(&standing);
        if unrest > STILL {
            let message = format!(
                "warning: {}: markers are up to {:.0} mm from their means: the person does not stand still, and the model is \
                 that of no moment",
                self.trial.display(),
                1e3 * unrest
            );
            say(&message);
        }
        output::write(&self.output, document::write(&model).as_bytes())?;
        Ok(Outcome::Done)
    }
}
