//! `condyle learn study`: the study of Pronost et al. 2010 with virtual people.

use crate::commands::Outcome;
use crate::failure::{Failure, warn_about};
use crate::output;
use crate::progress::frames_bar;
use clap::Args;
use condyle::formats::{opensim, trc};
use condyle::learn::study::{Kind, Person, Skin};
use condyle::learning::study::{Plan, Studied, figure, report, study, tables};
use std::path::{Path, PathBuf};

/// Remake the study of Pronost, Sandholm & Thalmann 2010 with six virtual people whose knees are known, with and without skin that moves.
///
/// Each person stands, walks ten times and crouches thirty times, as seven skin markers show it; a knee is learned from that as a user would, and ten more
/// gaits and crouches are tracked with it and with other knees. Tables are written as Markdown and CSV, Figure 3 as PNG.
#[derive(Debug, Args)]
pub(super) struct Study {
    /// The folder of the results: `study.md`, a `.csv` for each table, `figure3.png` and `figure3-rigid.png`.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// How many of the six people.
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u8).range(1..=6))]
    subjects: u8,
    /// What all that is random comes from; the same seed gives the same files.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The standard deviation of the noise of markers on each axis, in mm.
    #[arg(long, value_name = "MM", default_value_t = 0.5, value_parser = noise)]
    noise: f64,
    /// The cut-off of the low-pass that recordings go through before they are tracked, in Hz; 0 for none.
    #[arg(long, value_name = "HZ", default_value_t = 6.0, value_parser = hertz)]
    low_pass: f64,
    /// Number of solver threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Fewer trials and every eighth frame of crouches: seconds instead of minutes, and wider intervals.
    #[arg(long)]
    quick: bool,
    /// Write the recordings, too, as `trials/*.trc`, the standing trial and all others of each person, not filtered; and every knee as
    /// `models/*.osim`.
    #[arg(long)]
    trials: bool,
}

fn hertz(text: &str) -> Result<f64, String> {
    let hertz = text.parse().ok().filter(|hz: &f64| *hz == 0.0 || (0.5..=49.0).contains(hz));
    hertz.ok_or_else(|| "give 0.5 to 49 Hz, or 0 for none".to_owned())
}

fn noise(text: &str) -> Result<f64, String> {
    let mm = text.parse().ok().filter(|mm: &f64| (0.0..=50.0).contains(mm));
    mm.ok_or_else(|| "give millimetres, from 0 to 50".to_owned())
}

impl Study {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        if output::is_stream(&self.output) || self.output.is_file() {
            let path = self.output.display();
            return Err(Failure::new(format!(
                "{path}: the results are several files: give a folder"
            )));
        }
        let mut plan = Plan { people: usize::from(self.subjects), ..Plan::default() };
        plan.trials.seed = self.seed;
        plan.trials.noise = 1e-3 * self.noise;
        plan.low_pass = (self.low_pass > 0.0).then_some(self.low_pass);
        plan.threads = self.threads.map(usize::from);
        if self.quick {
            plan = plan.quick();
        }
        let bar = frames_bar("trials");
        let studied = study(&plan, &mut |done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        let studied = studied?;
        let write = |name: &str, bytes: &[u8]| output::write(&self.output.join(name), bytes);
        for sheet in tables(&studied) {
            write(&format!("{}.csv", sheet.name), sheet.csv().as_bytes())?;
        }
        write("figure3.png", &figure(&studied, Skin::Moving).png())?;
        write("figure3-rigid.png", &figure(&studied, Skin::Rigid).png())?;
        write("study.md", report(&studied, Some("figure3.png")).as_bytes())?;
        if self.trials {
            for person in &studied.people {
                write_trials(&self.output.join("trials"), &plan, person)?;
            }
            self.write_models(&studied)?;
        }
        output::print(format!("{}\n", self.output.join("study.md").display()).as_bytes())?;
        Ok(Outcome::Done)
    }
}

impl Study {
    /// Every knee of every person: `s1_moving_gait_learned.osim`.
    fn write_models(&self, studied: &Studied) -> Result<(), Failure> {
        for run in &studied.runs {
            let Some(person) = studied.people.get(run.person) else { continue };
            for (gait, motion) in [(true, "gait"), (false, "crouch")] {
                for (knee, model) in studied.models(run, gait)? {
                    let knee: Vec<&str> = knee.split([' ', ',', '\'']).collect();
                    let knee: Vec<&str> =
                        knee.into_iter().filter(|word| !word.is_empty()).collect();
                    let skin = if run.skin == Skin::Rigid { "rigid" } else { "moving" };
                    let name = format!("{}_{skin}_{motion}_{}.osim", person.name, knee.join("-"));
                    let path = self.output.join("models").join(name);
                    let written = opensim::write(&model);
                    warn_about(&path, &written.warnings);
                    output::write(&path, written.value.as_bytes())?;
                }
            }
        }
        Ok(())
    }
}

/// All recordings of a person: `s1_standing.trc`, `rigid/` and `moving/`.
fn write_trials(folder: &Path, plan: &Plan, person: &Person) -> Result<(), Failure> {
    let trials = &plan.trials;
    let standing = trials.standing(person);
    let name = format!("{}_standing.trc", person.name);
    output::write(&folder.join(&name), trc::write(&standing.recording, &name)?.as_bytes())?;
    for (skin, part) in [(Skin::Rigid, "rigid"), (Skin::Moving, "moving")] {
        for unseen in [false, true] {
            for (kind, number) in trials.wanted(unseen) {
                debug_assert!(kind != Kind::Standing);
                let take = trials.take(person, kind, number, unseen, skin);
                let name = format!("{}.trc", take.name);
                let text = trc::write(&take.recording, &name)?;
                output::write(&folder.join(part).join(&name), text.as_bytes())?;
            }
        }
    }
    Ok(())
}
