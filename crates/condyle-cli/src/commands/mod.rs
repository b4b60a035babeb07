//! The commands, one file each.

mod bench;
mod check;
mod constrain;
mod convert;
mod demo;
mod diff;
mod export;
mod fk;
mod info;
mod learn;
mod limits;
mod pose;
mod render;
mod scale;
mod track;
mod transfer;
mod upkeep;
mod view;

use crate::failure::Failure;
use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand, ValueEnum};
use condyle::formats::skeleton::{Assumed, named_unit};
use condyle::formats::{FORMATS, Format};
use condyle::model::UpAxis;
use condyle::{AngleUnit, Zeros, open};
use std::path::PathBuf;

/// Anatomical joints: models, limits, and tracking of markers.
#[derive(Debug, Parser)]
#[command(name = "condyle", version, about, max_term_width = 100)]
pub(crate) struct Arguments {
    /// The format of an input without an ending: `-`, which is standard input, or a pipe.
    #[arg(long, global = true, value_name = "FORMAT", value_parser = formats())]
    from: Option<String>,
    /// The unit of lengths in a file that holds a skeleton and does not state it, such as a .bvh: m, cm, mm,
    /// in, ft, cmu (1/0.45 inch), or metres in a unit. Without it, it is guessed by the figure's size, and
    /// written are cm.
    #[arg(long, global = true, value_name = "UNIT", value_parser = length_unit)]
    length_unit: Option<f64>,
    /// Frames per second of a file that does not state it, such as an .amc; without it, 120.
    #[arg(long, global = true, value_name = "N", value_parser = frame_rate)]
    frame_rate: Option<f64>,
    /// The skeleton (.asf) of takes (.amc); without it, the model if that is one, else the .asf of the subject
    /// beside the take. Or the body of SMPL poses (.npz): one of SMPL (.npz), or a model; without it, the
    /// proportions of `human`.
    #[arg(long, global = true, value_name = "F")]
    skeleton: Option<PathBuf>,
    /// Which animation is read of a file that holds several (.glb, .gltf, .fbx): its name, or its number
    /// counted from 1. Without it, the first.
    #[arg(long, global = true, value_name = "NAME")]
    animation: Option<String>,
    /// The axis that points up in such a file; without it, it is guessed by the figure's pose.
    #[arg(long, global = true, value_enum, value_name = "AXIS")]
    up_axis: Option<Up>,
    #[command(subcommand)]
    command: Command,
}

/// An axis that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Up {
    Y,
    Z,
}

/// Metres in a unit.
fn length_unit(name: &str) -> Result<f64, String> {
    let help = "give m, cm, mm, in, ft, cmu, or a positive number of metres";
    named_unit(name).ok_or_else(|| help.to_owned())
}

/// Frames per second.
fn frame_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| *rate > 0.0 && rate.is_finite());
    rate.ok_or_else(|| "give a positive number".to_owned())
}

/// The names of all formats that are read.
fn formats() -> PossibleValuesParser {
    let read = FORMATS.iter().filter(|format| !format.reads.is_empty());
    PossibleValuesParser::new(read.map(|format| format.name).collect::<Vec<_>>())
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Show what a file contains: segments and coordinates, or markers, frames and gaps.
    Info(info::Info),
    /// Report inconsistencies of a model, and where a motion exceeds its limits.
    Check(check::Check),
    /// Pose a model: world transforms of all segments.
    Fk(fk::Fk),
    /// Find the legal pose nearest to rest that meets goals, loops closed.
    Pose(pose::Pose),
    /// Draw a model, or frames of its motion, as a PNG.
    Render(render::Render),
    /// Show a model and its motions in the browser, and edit it there.
    View(view::View),
    /// Write what is seen as one file to send: a page with a model and its motions.
    Export(export::Export),
    /// Compute the motion of a model that follows recorded markers.
    Track(track::Track),
    /// Scale a model to the person of a static trial.
    Scale(scale::Scale),
    /// Learn from recordings which rotations of a joint are possible, and how coordinates follow others.
    Learn(learn::Learn),
    /// Put a learned law into another model, by three landmarks or by name.
    Transfer(transfer::Transfer),
    /// Ask learned limits about rotations, and about the mobility of a joint.
    Limits(limits::Limits),
    /// Find the legal motion nearest to a given one, and what limits it broke.
    Constrain(constrain::Constrain),
    /// Write a file in another format.
    Convert(convert::Convert),
    /// Filter, fill, resample, cut or turn a recording or a motion.
    Upkeep(upkeep::Upkeep),
    /// Compare two motions, coordinate by coordinate.
    Diff(diff::Diff),
    /// Measure how fast a model is posed on this machine.
    Bench(bench::Bench),
    /// Track a recording made from a known motion, and report the errors.
    Demo(demo::Demo),
}

/// Whether limits hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Limits {
    Off,
    On,
}

/// What a marker at exactly 0 0 0 is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ZerosArgument {
    /// A place like any other.
    Keep,
    /// Not seen.
    Missing,
}

/// Without the argument, the rest of the recording tells.
pub(crate) fn zeros(argument: Option<ZerosArgument>) -> Zeros {
    match argument {
        None => Zeros::Told,
        Some(ZerosArgument::Keep) => Zeros::Keep,
        Some(ZerosArgument::Missing) => Zeros::Missing,
    }
}

/// The unit of angles in a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Angles {
    Deg,
    Rad,
}

impl From<Angles> for AngleUnit {
    fn from(angles: Angles) -> Self {
        match angles {
            Angles::Deg => Self::Degrees,
            Angles::Rad => Self::Radians,
        }
    }
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Success.
    Done,
    /// The input was read but a requested condition does not hold.
    DoesNotHold,
}

/// Runs a command.
pub(crate) fn run(arguments: Arguments) -> Result<Outcome, Failure> {
    if let Some(format) = arguments.from.as_deref().and_then(Format::of_ending) {
        open::nameless_is(format);
    }
    let up = arguments.up_axis.map(|up| match up {
        Up::Y => UpAxis::Y,
        Up::Z => UpAxis::Z,
    });
    if let Some(name) = &arguments.animation {
        open::animation_is(name);
    }
    if let Some(path) = &arguments.skeleton {
        open::skeleton_is(path);
        if open::ending(path) != "asf" {
            open::body_is(path);
        }
    }
    open::skeletons_are(Assumed {
        metres_per_unit: arguments.length_unit,
        up,
        rate: arguments.frame_rate,
    });
    // What is read from here on is not written over.
    open::files_read();
    match arguments.command {
        Command::Info(command) => command.run(),
        Command::Check(command) => command.run(),
        Command::Fk(command) => command.run(),
        Command::Pose(command) => command.run(),
        Command::Render(command) => command.run(),
        Command::View(command) => command.run(),
        Command::Export(command) => command.run(),
        Command::Track(command) => command.run(),
        Command::Scale(command) => command.run(),
        Command::Learn(command) => command.run(),
        Command::Transfer(command) => command.run(),
        Command::Limits(command) => command.run(),
        Command::Constrain(command) => command.run(),
        Command::Convert(command) => command.run(),
        Command::Upkeep(command) => command.run(),
        Command::Diff(command) => command.run(),
        Command::Bench(command) => command.run(),
        Command::Demo(command) => command.run(),
    }
}
