//! `condyle render`: a still picture.

use super::{Angles, Limits, Outcome};
use crate::failure::{Failure, warned};
use crate::output;
use crate::screen::say;
use clap::Args;
use condyle::picture::{self, Focus, Posed, Sheet, Show, View};
use condyle::{Animation, Figure, Model, Motion, geometry, legal, open};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Render {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// A motion whose columns are named after coordinates; by default the one that the model's file holds.
    #[arg(conflicts_with = "pose")]
    motion: Option<PathBuf>,
    /// A JSON file with a pose as `fk` takes it, or a list of them; several stand side by side.
    #[arg(long, value_name = "P.json")]
    pose: Vec<PathBuf>,
    /// The time of the motion that is drawn, in seconds; without it, its first frame.
    #[arg(long, value_name = "T", conflicts_with_all = ["pose", "sheet"], allow_negative_numbers = true)]
    time: Option<f64>,
    /// So many frames of the motion, evenly in time.
    #[arg(long, value_name = "N", conflicts_with = "pose")]
    sheet: Option<usize>,
    /// From where: front, back, side, left, right, top, or azimuth and elevation in degrees such as 30,15;
    /// several make a grid.
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true)]
    view: Vec<String>,
    /// The segment or joint set to look at.
    #[arg(long, value_name = "SEGMENT|JOINT_SET", value_delimiter = ',')]
    at: Vec<String>,
    /// How many times larger than a picture of the whole figure; without it, what is looked at fills it.
    #[arg(long, value_name = "X")]
    zoom: Option<f64>,
    /// Draw what is looked at in the accent colour, and the rest pale.
    #[arg(long, requires = "at")]
    highlight: bool,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: String,
    /// What is shown: bones, skin, frames, axes, centres, limits, contacts, markers, names. Without it, the skin of a file that
    /// has one, else bones.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    show: Vec<String>,
    /// A folder in which the meshes are that an `.osim` names, beside its own folder and `Geometry` there.
    #[arg(long, value_name = "DIR")]
    geometry: Vec<PathBuf>,
    /// Draw the nearest legal pose.
    #[arg(long, value_enum, default_value_t = Limits::On)]
    limits: Limits,
    /// The unit of angles in a motion that does not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// Where to write the PNG; `-` is standard output.
    #[arg(short, long, value_name = "P.png")]
    output: PathBuf,
}

impl Render {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let inputs = [&self.model].into_iter().chain(&self.motion).chain(&self.pose);
        let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &[&self.output])?;
        let mut sheet = Sheet::new(vec![]);
        sheet.size = size(&self.size)?;
        if !self.view.is_empty() {
            sheet.views = self.view.iter().map(|v| View::named(v)).collect::<Result<_, _>>()?;
        }
        let show = self.show.iter().map(|s| Show::named(s.trim())).collect::<Result<_, _>>()?;
        if let Some(zoom) = self.zoom.filter(|zoom| !(1e-3..=1e4).contains(zoom)) {
            return Err(Failure::new(format!("--zoom {zoom}: give a number from 0.001 to 10000")));
        }
        sheet.focus = Focus { names: self.at.clone(), zoom: self.zoom, highlight: self.highlight };
        let Animation { model, motion } = warned(&self.model, open::animation(&self.model)?);
        sheet.poses = self.poses(&model, motion)?;
        let geometry = warned(&self.model, geometry::open(&self.model, &model, &self.geometry)?);
        sheet.show = match (self.show.is_empty(), geometry.skins.is_empty()) {
            (false, _) => show,
            (true, false) => vec![Show::Skin],
            (true, true) => vec![Show::Bones],
        };
        let picture = picture::draw_figure(&model, &Figure::new(&model).with(geometry), &sheet)?;
        output::write(&self.output, &picture.png())?;
        Ok(Outcome::Done)
    }

    /// The poses that are drawn, legal if asked for.
    fn poses(&self, model: &Model, own: Motion) -> Result<Vec<Posed>, Failure> {
        let (mut motion, titles) = match &self.motion {
            Some(path) => {
                let all = open::motion_with(path, model, self.angles.map(Into::into))?;
                self.frames(path, model, warned(path, all))?
            }
            None if self.pose.is_empty() && !own.frames.is_empty() => {
                self.frames(&self.model, model, own)?
            }
            None => self.still(model)?,
        };
        if self.limits == Limits::On {
            let kept = legal::keep(model, &mut motion);
            if kept.solved > 0 {
                say(&format!(
                    "note: {} of {} poses broke limits between segments: drawn is the nearest legal one",
                    kept.solved,
                    motion.frames.len()
                ));
            }
        }
        let posed = motion.frames.into_iter().zip(titles);
        Ok(posed.map(|(stored, title)| Posed { stored, title }).collect())
    }

    /// Poses of files, or the default one.
    fn still(&self, model: &Model) -> Result<(Motion, Vec<String>), Failure> {
        if self.time.is_some() || self.sheet.is_some() {
            return Err(Failure::new("--time and --sheet need a motion: give it after the model"));
        }
        let mut motion = Motion { times: vec![], frames: vec![] };
        let mut titles = vec![];
        for path in &self.pose {
            let found = warned(path, open::poses(path, model)?).motion;
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            for index in 0..found.frames.len() {
                titles.push(match (self.pose.len(), found.frames.len()) {
                    (1, _) => String::new(),
                    (_, 1) => stem.to_string(),
                    _ => format!("{stem} {index}"),
                });
            }
            motion.times.extend(found.times);
            motion.frames.extend(found.frames);
        }
        if self.pose.is_empty() {
            motion = Motion { times: vec![0.0], frames: vec![model.defaults()] };
            titles.push(String::new());
        }
        if motion.frames.is_empty() {
            return Err(Failure::new("there is no pose in what --pose names"));
        }
        Ok((motion, titles))
    }

    /// Frames of the motion.
    fn frames(
        &self,
        path: &Path,
        model: &Model,
        all: Motion,
    ) -> Result<(Motion, Vec<String>), Failure> {
        let (Some(&first), Some(&last)) = (all.times.first(), all.times.last()) else {
            return Err(Failure::new(format!("{}: there are no frames in it", path.display())));
        };
        let times: Vec<f64> = match (self.sheet, self.time) {
            (Some(count), _) => {
                if !(1..=1000).contains(&count) {
                    return Err(Failure::new(format!("--sheet {count}: give 1 to 1000 frames")));
                }
                let step = (last - first) / (count.max(2) - 1) as f64;
                (0..count).map(|index| (first + index as f64 * step).min(last)).collect()
            }
            (None, time) => vec![time.unwrap_or(first)],
        };
        let mut motion = Motion { times: vec![], frames: vec![] };
        for time in times {
            let stored = all.at(model, time).ok_or_else(|| {
                Failure::new(format!(
                    "{}: it has no time {time} s: give one from {first} to {last}",
                    path.display()
                ))
            })?;
            motion.times.push(time);
            motion.frames.push(stored);
        }
        let several = motion.times.len() > 1;
        let title = |time: &f64| if several { format!("{time:.3} s") } else { String::new() };
        let titles = motion.times.iter().map(title).collect();
        Ok((motion, titles))
    }
}

/// Width and height in pixels.
fn size(text: &str) -> Result<[usize; 2], Failure> {
    let parsed = text.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some([width.trim().parse().ok()?, height.trim().parse().ok()?])
    });
    parsed.ok_or_else(|| {
        Failure::new(format!("--size {text}: give width and height in pixels, such as 1280x720"))
    })
}
