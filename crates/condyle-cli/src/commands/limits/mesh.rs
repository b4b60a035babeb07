//! `condyle limits mesh`: the boundary of a limit as a surface.

use super::Outcome;
use super::report::{axis, field};
use crate::failure::Failure;
use crate::output;
use clap::{Args, ValueEnum};
use condyle::learning::Axis;
use condyle::{encode, limits, open};
use std::path::{Path, PathBuf};

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Space {
    /// The boundary in quaternion space: a turn by θ about u is at u·sin(θ/2).
    Quaternion,
    /// The directions that the bone reaches, a shell about the joint, coloured by how far it can twist there.
    Swing,
}

/// Draw the boundary of a limit as a surface (.glb): in quaternion space, or the directions that a bone reaches.
///
/// Both are closed and face outward. The colours of directions go from yellow, where the bone twists least, to green-blue, where most;
/// the name of the node says how many degrees these are.
#[derive(Debug, Args)]
pub(super) struct Mesh {
    /// The limit: a document of `kind = "limit"`.
    limit: PathBuf,
    /// What is drawn.
    #[arg(long, value_enum, default_value = "swing")]
    space: Space,
    /// The direction of the bone in the child: -y of an arm or thigh in the axes of the ISB.
    #[arg(long, value_name = "X,Y,Z", value_parser = axis, allow_hyphen_values = true, default_value = "0,-1,0")]
    bone: Axis,
    /// The surface; `-` is standard output.
    #[arg(short, long, value_name = "M.glb")]
    output: PathBuf,
}

impl Mesh {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output == Path::new("-");
        if !to_screen && open::ending(&self.output) != "glb" {
            let path = self.output.display();
            let message = format!("{path}: a surface is written as .glb: end it in that");
            return Err(Failure::new(message));
        }
        output::check_distinct(&[&self.limit], &[&self.output])?;
        let limit = field(&self.limit)?;
        let distance = |q| limit.field().distance(q);
        let name = match &limit.about().name[..] {
            "" => "limit",
            name => name,
        };
        let (bytes, said) = match self.space {
            Space::Quaternion => {
                let mesh = limits::boundary(&distance, limits::CELLS);
                let said = format!("{} triangles, closed\n", mesh.triangles.len());
                (encode::surface(mesh, name)?, said)
            }
            Space::Swing => {
                let swing = limits::Swing::of(&distance, self.bone.direction, limits::LEVEL);
                let [least, most] = [swing.least(), swing.most()].map(f64::to_degrees);
                let twists = format!("twist {least:.0}° (yellow) to {most:.0}° (green-blue)");
                let (mesh, colours) = swing.shell();
                let said = format!("{} triangles, closed; {twists}\n", mesh.triangles.len());
                (encode::coloured_surface(mesh, colours, &format!("{name}: {twists}"))?, said)
            }
        };
        output::write(&self.output, &bytes)?;
        if !to_screen {
            output::print(said.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}
