//! The formats that a motion can be written in.

use crate::failure::{Failure, warned};
use clap::ValueEnum;
use condyle::formats::{AngleUnit, Recording, csv, glb, sto};
use condyle::{Mode, Model, Motion, open, scene};
use std::path::Path;

/// The formats that a motion can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionFormat {
    /// OpenSim's motion file, in degrees.
    Mot,
    /// OpenSim's storage file, in degrees.
    Sto,
    /// Comma-separated, in radians and metres.
    Csv,
    /// An animated scene.
    Glb,
}

impl MotionFormat {
    /// The format of a path: by `--to`, else by its ending.
    pub(crate) fn of(path: &Path, to: Option<Self>) -> Result<Self, Failure> {
        if let Some(to) = to {
            return Ok(to);
        }
        match open::ending(path).as_str() {
            "mot" => Ok(Self::Mot),
            "sto" => Ok(Self::Sto),
            "csv" => Ok(Self::Csv),
            "glb" => Ok(Self::Glb),
            _ if path == Path::new("-") => Ok(Self::Mot),
            _ => Err(Failure::new(format!(
                "{}: the ending names no format for a motion (known are .mot, .sto, .csv, .glb; or \
                 give --to)",
                path.display()
            ))),
        }
    }

    /// The ending of its files, without the dot.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Mot => "mot",
            Self::Sto => "sto",
            Self::Csv => "csv",
            Self::Glb => "glb",
        }
    }

    /// A motion in this format.
    pub(crate) fn encode(
        self,
        model: &Model,
        motion: &Motion,
        name: &str,
        markers: Option<(&Recording, &[usize])>,
    ) -> Result<Vec<u8>, Failure> {
        let fail = |error: condyle::formats::Error| Failure::new(error.to_string());
        match self {
            Self::Mot | Self::Sto => {
                Ok(sto::write(&motion.to_table(model, name)).map_err(fail)?.into_bytes())
            }
            Self::Csv => {
                let mut table = motion.to_table(model, name);
                // A table for programs: the units of the library.
                table.values = motion.frames.concat();
                table.angle_unit = AngleUnit::Radians;
                Ok(csv::write(&table).map_err(fail)?.into_bytes())
            }
            Self::Glb => {
                let baked = scene::baked(model, motion, Mode::Open, markers);
                glb::write(&warned(Path::new(name), baked)).map_err(fail)
            }
        }
    }
}
