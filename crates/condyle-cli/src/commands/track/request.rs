//! What is asked of a tracking: a setup, and the arguments that win over it.

use crate::commands::{Limits, ZerosArgument};
use crate::failure::{Failure, warned};
use clap::Args;
use condyle::tracking::{PostureRequest, Request};
use condyle::{Model, open};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Asked {
    /// Weights, coordinate tasks and time range: a setup or the tasks of OpenSim's inverse kinematics, or
    /// a document of `kind = "setup"`; arguments win over it.
    #[arg(long, value_name = "IK.xml|TASKS.xml|SETUP.toml")]
    setup: Option<PathBuf>,
    /// The weight of markers of the model, `*` for any letters; repeatable, the last that fits counts, 0
    /// drops.
    #[arg(long, value_name = "NAME=W", value_parser = named)]
    weight: Vec<(String, f64)>,
    /// First and last time in seconds, either of which may be left out: `1.5:`.
    #[arg(long, value_name = "A:B", value_parser = times, allow_hyphen_values = true)]
    time: Option<[f64; 2]>,
    /// What the recording's labels are called in the model: a document of `kind = "names"`, or a shipped
    /// table (cmu, gait2392, isb, opencap, plug-in-gait).
    #[arg(long, value_name = "TABLE")]
    names: Option<PathBuf>,
    /// Whose markers are meant, where the labels of several people begin with their names: `Anna:RFHD`.
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    pub(super) zeros: Option<ZerosArgument>,
    /// Hold a coordinate near its default with a stiffness in m²/rad² (or per m²), such as
    /// `lumbar_bending=1e-5`; repeatable.
    #[arg(long, value_name = "COORD=STIFFNESS", value_parser = named)]
    hold: Vec<(String, f64)>,
    /// The largest marker error that is plausible, in mm RMS over the trial; 100 without it.
    #[arg(long, value_name = "MM", value_parser = millimetres)]
    max_rms: Option<f64>,
    /// Hold coordinates to their enforced ranges; on without it.
    #[arg(long, value_enum)]
    limits: Option<Limits>,
    /// Put swapped labels right, and leave markers out where they cannot be.
    #[arg(long)]
    robust: bool,
}

impl Asked {
    /// The files that are read.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.setup.iter().chain(&self.names)
    }

    pub(super) fn request(&self, model: &Model) -> Result<Request, Failure> {
        let mut request = match &self.setup {
            Some(path) => warned(path, open::request(path)?),
            None => Request::default(),
        };
        request.weights.extend(self.weight.iter().cloned());
        if self.time.is_some() {
            request.time_range = self.time;
        }
        if let Some(path) = &self.names {
            request.names = warned(path, open::names(path)?);
        }
        if self.subject.is_some() {
            request.subject.clone_from(&self.subject);
        }
        for (name, stiffness) in &self.hold {
            model.find_coordinate(name)?;
            let alone = vec![(name.clone(), 1.0)];
            request.postures.retain(|posture| posture.coordinates != alone);
            if *stiffness > 0.0 {
                let posture =
                    PostureRequest { coordinates: alone, rest: None, stiffness: *stiffness };
                request.postures.push(posture);
            }
        }
        if let Some(rms) = self.max_rms {
            request.max_rms = rms;
        }
        if let Some(limits) = self.limits {
            request.limits = limits == Limits::On;
        }
        request.robust |= self.robust;
        Ok(request)
    }
}

/// A name and a number of 0 or more.
fn named(text: &str) -> Result<(String, f64), String> {
    let (name, number) = text.rsplit_once('=').ok_or("give NAME=NUMBER")?;
    let number: f64 = number.trim().parse().map_err(|_| format!("`{number}` is no number"))?;
    match name.trim() {
        "" => Err("there is no name before `=`".to_owned()),
        _ if !(number >= 0.0 && number.is_finite()) => Err("give a number of 0 or more".to_owned()),
        name => Ok((name.to_owned(), number)),
    }
}

fn times(text: &str) -> Result<[f64; 2], String> {
    let (first, last) = text.split_once(':').ok_or("give FIRST:LAST in seconds")?;
    let side = |text: &str, open: f64| match text.trim() {
        "" => Ok(open),
        text => match text.parse() {
            Ok(time) if !f64::is_nan(time) => Ok(time),
            _ => Err(format!("`{text}` is no time in seconds")),
        },
    };
    let [first, last] = [side(first, f64::NEG_INFINITY)?, side(last, f64::INFINITY)?];
    if first > last {
        return Err(format!("no time lies between {first} and {last}"));
    }
    Ok([first, last])
}

/// A length in millimetres, as metres.
fn millimetres(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length > 0.0 => Ok(1e-3 * length),
        _ => Err("give a number of millimetres above 0".to_owned()),
    }
}
