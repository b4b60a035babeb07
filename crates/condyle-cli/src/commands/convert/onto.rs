//! `convert --onto`: the motion of one figure for another.

use crate::commands::Limits;
use crate::failure::{Failure, warn_about, warned};
use crate::progress::frames_bar;
use crate::screen::say;
use clap::Args;
use condyle::retargeting::{
    Fit, Humanoid, Options, Part, Recognised, Report, Retargeted, recognise, retarget,
};
use condyle::{Animation, Model, Motion, open};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(super) struct Onto {
    /// Carry the motion over to this figure: a model, or a file that holds a skeleton.
    ///
    /// A skinned character (.glb, .gltf, .vrm) written to .glb comes back as it is, with the motion in place of its
    /// animations.
    ///
    /// Limbs point where they do in the source, whatever the postures in which the two rest and however
    /// long their limbs are. The bones are recognised by their names.
    #[arg(long, value_name = "TARGET")]
    pub(super) onto: Option<PathBuf>,
    /// Which bones are which parts of the body: a document of `kind = "names"`.
    #[arg(long, value_name = "TABLE", requires = "onto")]
    pub(super) names: Option<PathBuf>,
    /// Feet that stand do not move at all.
    #[arg(long, requires = "onto")]
    pin_feet: bool,
}

impl Onto {
    /// The paths that are read.
    pub(super) fn inputs(&self) -> impl Iterator<Item = &PathBuf> {
        self.onto.iter().chain(&self.names)
    }

    /// The target and its motion; `None` where none is asked for.
    pub(super) fn carried(
        &self,
        from: &Path,
        model: &Model,
        motion: &Motion,
        limits: Limits,
    ) -> Result<Option<(Model, Motion)>, Failure> {
        let Some(onto) = &self.onto else { return Ok(None) };
        let table = match &self.names {
            Some(path) => Some(warned(path, open::names(path)?)),
            None => None,
        };
        let Animation { model: target, .. } = warned(onto, open::figure(onto)?);
        let known = |path: &Path, model: &Model| {
            let known = recognise(model, table.as_ref())?;
            warn_about(path, &known.warnings);
            Ok::<Recognised, Failure>(known)
        };
        let (source, to) = (known(from, model)?, known(onto, &target)?);
        let bar = frames_bar("carrying over");
        bar.set_length(motion.frames.len() as u64 * 2);
        let options = Options { limits: limits == Limits::On, pin_feet: self.pin_feet };
        let carried = retarget(
            Humanoid { model, body: &source.body },
            motion,
            Humanoid { model: &target, body: &to.body },
            options,
            &mut || bar.inc(1),
        );
        bar.finish_and_clear();
        let Retargeted { motion, report, warnings } = carried?;
        warn_about(from, &warnings);
        say(&told([(model, &source), (&target, &to)], &report, options));
        Ok(Some((target, motion)))
    }
}

/// So many coordinates at limits are named.
const MOST_NAMED: usize = 6;

/// What is said once: tables, parts, how near, at limits, feet.
fn told(figures: [(&Model, &Recognised); 2], report: &Report, options: Options) -> String {
    let mut text = String::new();
    let [(from, source), (to, target)] = figures;
    let by = |known: &Recognised| match &known.table {
        Some(table) => format!("names of `{table}`, {} parts", known.named),
        None => format!("by its tree, {} parts", known.named),
    };
    let _ = writeln!(
        text,
        "{} frames of `{}` ({}) for `{}` ({}), {:.3} times as large",
        report.frames,
        from.name(),
        by(source),
        to.name(),
        by(target),
        report.size,
    );
    for (parts, which) in report.unmatched.iter().zip(["source", "target"]) {
        let names: Vec<String> = parts
            .iter()
            .filter(|part| !matches!(part, Part::Finger(..)))
            .map(|p| p.name())
            .collect();
        if !names.is_empty() {
            let _ = writeln!(text, "  only the {which} has: {}", names.join(", "));
        }
    }
    let inside = options.limits;
    let head = if inside { ", mean inside limits and in what share of frames" } else { "" };
    let _ = writeln!(text, "  angle to what was asked for: mean, 95 %{head}");
    let line = |fit: &Fit| {
        let degrees = |angle: f64| format!("{:.2}°", angle.to_degrees());
        let kind = if fit.line { "" } else { " (turned)" };
        let within = match (inside, fit.inside.is_finite()) {
            (true, true) => format!("  {:>7} {:>4.0} %", degrees(fit.inside), fit.share * 100.0),
            (true, false) => "        -    0 %".to_owned(),
            _ => String::new(),
        };
        let name = format!("{}{kind}", fit.name);
        format!("    {name:<18} {:>7} {:>7}{within}\n", degrees(fit.mean), degrees(fit.most))
    };
    report.fits.iter().for_each(|fit| text.push_str(&line(fit)));
    if !report.limited.is_empty() {
        let share = |frames: &usize| *frames as f64 / report.frames.max(1) as f64 * 100.0;
        let names = report.limited.iter().map(|(name, at)| format!("{name} {:.0} %", share(at)));
        let names: Vec<String> = names.take(MOST_NAMED).collect();
        let _ = writeln!(text, "  frames at a limit, by coordinate: {}", names.join(", "));
    }
    let sliding = report.sliding;
    if sliding.stands > 0 {
        let mm = |length: f64| format!("{:.1}", length * 1e3);
        let _ = writeln!(
            text,
            "  feet stand {} times and slide {} mm (median; most {}), in the source {} ({}); most beyond it {}",
            sliding.stands,
            mm(sliding.target[0]),
            mm(sliding.target[1]),
            mm(sliding.source[0]),
            mm(sliding.source[1]),
            mm(sliding.excess),
        );
    }
    text.trim_end().to_owned()
}
