//! Robust tracking on clean recordings and on generated faults:
//! `cargo run --release --example faults -- FOLDER [FAULTS]`.
//!
//! FOLDER holds recordings and models at the places listed here. The first table compares robust with
//! plain tracking where nothing is known to be wrong. For the second each fault is written into a
//! recording whose clean answer is known: measured ones, and ones generated from their motion, where each
//! marker has a constant offset and noise. Tables are printed in Markdown; `-v` after FAULTS prints a line
//! for each fault.
//!
//! - *found*: marker-frames off by over 50 mm that were put right or left out;
//! - *accused*: marker-frames that are right, and were left out or given another label;
//! - *angles*: the largest difference of a rotation from the clean answer, in frames with labels over
//!   50 mm off and in those beyond the fault, of the rotations that stay within 1° there if these labels
//!   are taken out by hand.

mod fault;

use condyle::formats::Recording;
use condyle::math::Vec3;
use condyle::model::Mode;
use condyle::tracking::{Faulty, Job, Request, Tracking};
use condyle::{CoordinateId, CoordinateKind, Model, Observed, open};
use fault::{Dice, Fault, KINDS};
use std::collections::HashSet;
use std::error::Error;
use std::ops::Range;
use std::path::PathBuf;
use std::time::Instant;

/// Name, model, recording, setup.
const CLEAN: [(&str, &str, &str, Option<&str>); 9] = [
    (
        "synthetic",
        "ik/core_subject01/subject01_simbody.osim",
        "ik/core_subject01/subject01_synthetic_marker_data.trc",
        None,
    ),
    (
        "arm26",
        "ik/arm26/arm26.osim",
        "ik/arm26/arm26_elbow_flex.trc",
        Some("ik/arm26/arm26_Setup_InverseKinematics.xml"),
    ),
    (
        "bone pins",
        "ik/core_abdbonepin/subject1_abdbonepin.osim",
        "shoulder/bonepin/abdbonepin.trc",
        Some("ik/core_abdbonepin/setup_ik_abdbonepin.xml"),
    ),
    (
        "gait10dof",
        "ik/gait10dof/subject01.osim",
        "ik/gait10dof/subject01_walk.trc",
        Some("ik/gait10dof/walk_Setup_IK.xml"),
    ),
    ("OpenCap squat", "knee/opencap4/manually_scaled.osim", "knee/opencap4/squats1.trc", None),
    ("OpenCap walk", "knee/opencap4/manually_scaled.osim", "knee/opencap4/walking1.trc", None),
    ("OpenCap static", "knee/opencap4/manually_scaled.osim", "knee/opencap4/static1.trc", None),
    (
        "Lai 2017 walk",
        "ik/lai_subject6/LaiArnoldModified2017_scaled.osim",
        "ik/lai_subject6/walking1.trc",
        None,
    ),
    ("Lenhart walk", "knee/lenhart/lenhart2015.osim", "knee/lenhart/overground_17.trc", None),
];

/// Those of them that faults are written into.
const FAULTY: [&str; 5] =
    ["OpenCap walk", "OpenCap squat", "synthetic", "gait10dof", "Lenhart walk"];

struct Trial {
    name: String,
    model: Model,
    recording: Recording,
    request: Request,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let Some(folder) = args.next().map(PathBuf::from) else {
        return Err("give the folder of the recordings".into());
    };
    let faults = args.next().map_or(Ok(200), |n| n.parse())?;
    let tell = args.next().is_some();
    let mut trials = vec![];
    for (name, model, recording, setup) in CLEAN {
        let path = folder.join(recording);
        if !path.exists() {
            println!("{name} is not there: {}", path.display());
            continue;
        }
        trials.push(Trial {
            name: name.to_owned(),
            model: open::model(&folder.join(model))?.value,
            recording: open::recording(&path)?.value,
            request: match setup {
                Some(setup) => Request::from_setup(&open::setup(&folder.join(setup))?.value),
                None => Request::default(),
            },
        });
    }
    clean(&trials)?;
    alone(&trials)?;
    let mut measured: Vec<Trial> =
        trials.into_iter().filter(|trial| FAULTY.contains(&trial.name.as_str())).collect();
    let generated: Vec<Trial> =
        measured.iter().map(|trial| generate(trial)).collect::<Result<_, _>>()?;
    measured.extend(generated);
    with_faults(&measured, faults, tell)
}

fn run(
    trial: &Trial,
    recording: &Recording,
    robust: bool,
) -> Result<(Tracking, f64), Box<dyn Error>> {
    let request = Request { robust, threads: Some(1), ..trial.request.clone() };
    let job = Job::new(trial.model.clone(), recording, &request)?;
    let start = Instant::now();
    let tracking = job.run(&mut |_, _| {});
    Ok((tracking, start.elapsed().as_secs_f64()))
}

/// The best of five times.
fn timed(trial: &Trial, robust: bool) -> Result<(Tracking, f64), Box<dyn Error>> {
    let (tracking, mut least) = run(trial, &trial.recording, robust)?;
    for _ in 0..4 {
        least = least.min(run(trial, &trial.recording, robust)?.1);
    }
    Ok((tracking, least))
}

fn clean(trials: &[Trial]) -> Result<(), Box<dyn Error>> {
    println!(
        "| recording | frames | RMS plain | robust | largest RMS of a rotation | RMS of translations | put right | left out | speed |"
    );
    println!("| --- | ---: | ---: | ---: | --- | ---: | --- | ---: | ---: |");
    for trial in trials {
        let (plain, plain_time) = timed(trial, false)?;
        let (robust, robust_time) = timed(trial, true)?;
        let frames = 0..plain.answers.len();
        let turned = rotations(&trial.model)
            .map(|id| (off(&trial.model, &plain, &robust, id, frames.clone()), id))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let (turn, id) = turned.ok_or("no rotation")?;
        let ids = trial.model.coordinate_ids();
        let moved = ids
            .filter(|&id| trial.model.coordinate(id).kind == CoordinateKind::Translation)
            .map(|id| off(&trial.model, &plain, &robust, id, frames.clone()))
            .fold(0.0, f64::max);
        let out: usize = left_out(&robust).map(|f| f.frames.len()).sum();
        println!(
            "| {} | {} | {:.2} mm | {:.2} mm | {:.2}° ({}) | {:.1} mm | {} | {} | {:.0} % |",
            trial.name,
            plain.answers.len(),
            1e3 * plain.summary().rms,
            1e3 * robust.summary().rms,
            turn.to_degrees(),
            trial.model.coordinate_key(id),
            1e3 * moved,
            robust.swaps.len(),
            out,
            100.0 * plain_time / robust_time
        );
        for swap in &robust.swaps {
            eprintln!("{}: {swap}", trial.name);
        }
        for faulty in &robust.faulty {
            eprintln!("{}: {faulty}", trial.name);
        }
    }
    Ok(())
}

/// Frames without the trial around them, in which no offset is known: as they are, and with the fault.
fn alone(trials: &[Trial]) -> Result<(), Box<dyn Error>> {
    println!();
    println!("| frames alone | frames | changed as they are | plain | robust |");
    println!("| --- | ---: | ---: | ---: | ---: |");
    let mut dice = Dice(5);
    for trial in trials {
        let (mut changed, mut frames, mut plain_off, mut robust_off) = (0, 0, vec![], vec![]);
        let count = trial.recording.frames();
        for at in (0..count).step_by(count.div_ceil(20)) {
            let width = trial.recording.labels.len();
            let mut one = Recording {
                times: trial.recording.times[at..=at].to_vec(),
                positions: trial.recording.frame(at).to_vec(),
                ..trial.recording.clone()
            };
            let (clean, _) = run(trial, &one, false)?;
            let (robust, _) = run(trial, &one, true)?;
            frames += 1;
            changed += usize::from(!robust.swaps.is_empty() || left_out(&robust).count() > 0);
            let label = clean.labels[dice.below(clean.labels.len())];
            let away = dice.vector();
            let away = away * (0.5 / away.norm());
            let Some(place) = one.positions[label % width].position_mut() else { continue };
            *place = (Vec3::from(*place) + away).to_array();
            let (plain, _) = run(trial, &one, false)?;
            let (robust, _) = run(trial, &one, true)?;
            let most = |a: &Tracking| {
                let offs = rotations(&trial.model).map(|id| off(&trial.model, a, &clean, id, 0..1));
                offs.fold(0.0, f64::max).to_degrees()
            };
            plain_off.push(most(&plain));
            robust_off.push(most(&robust));
        }
        let within = |offs: &[f64]| {
            format!("{} of {}", offs.iter().filter(|o| **o < 5.0).count(), offs.len())
        };
        println!(
            "| {} | {frames} | {changed} | {} | {} |",
            trial.name,
            within(&plain_off),
            within(&robust_off)
        );
    }
    Ok(())
}

fn rotations(model: &Model) -> impl Iterator<Item = CoordinateId> + '_ {
    let rotates = |id: &CoordinateId| model.coordinate(*id).kind == CoordinateKind::Rotation;
    model.coordinate_ids().filter(rotates)
}

/// RMS over frames of what a coordinate differs in two trackings.
fn off(
    model: &Model,
    a: &Tracking,
    b: &Tracking,
    id: CoordinateId,
    frames: impl ExactSizeIterator<Item = usize>,
) -> f64 {
    let n = frames.len().max(1) as f64;
    let value = |t: &Tracking, frame: usize| model.value(t.answers.coordinates(frame), id);
    let turns = model.coordinate(id).kind == CoordinateKind::Rotation;
    let square = |frame| {
        let off: f64 = value(a, frame) - value(b, frame);
        let whole =
            if turns { std::f64::consts::TAU * (off / std::f64::consts::TAU).round() } else { 0.0 };
        (off - whole).powi(2)
    };
    (frames.map(square).sum::<f64>() / n).sqrt()
}

/// A recording of the same motion by a model whose markers lie beside their places by a constant offset
/// of 10 mm RMS an axis, with noise of 2 mm.
fn generate(trial: &Trial) -> Result<Trial, Box<dyn Error>> {
    let (plain, _) = run(trial, &trial.recording, false)?;
    let mut dice = Dice(17);
    let markers = trial.model.markers().iter();
    let points: Vec<_> = markers.map(|m| Some(m.point + dice.vector() * 0.010)).collect();
    let placed = trial.model.with_markers_at(&points);
    let mut recording = plain.motion().virtual_markers(&placed, Mode::Open)?;
    recording.rate = trial.recording.rate;
    for position in recording.positions.iter_mut().filter_map(Observed::position_mut) {
        let noise = dice.vector() * 0.002;
        position.iter_mut().zip(noise.to_array()).for_each(|(x, n)| *x += n);
    }
    let (name, request) = (format!("{}, generated", trial.name), trial.request.clone());
    Ok(Trial { name, model: trial.model.clone(), recording, request })
}

/// Counts over the faults of one kind.
#[derive(Default, Clone)]
struct Tally {
    faults: usize,
    off: usize,
    found: usize,
    right: usize,
    accused: usize,
    named: usize,
    judged: usize,
    within: usize,
    plain_within: usize,
    worse: usize,
    determined: usize,
    rotations: usize,
    time: [f64; 2],
}

fn with_faults(trials: &[Trial], faults: usize, tell: bool) -> Result<(), Box<dyn Error>> {
    let mut dice = Dice(2024);
    let mut tallies = vec![Tally::default(); KINDS.len()];
    let mut references = vec![];
    for trial in trials {
        // What is found where nothing was written in is the recording's own.
        let clean = run(trial, &trial.recording, true)?.0;
        let own = touched(&trial.recording, &clean);
        references.push((clean, own));
    }
    for number in 0..faults {
        let kind = number % KINDS.len();
        let which = number / KINDS.len() % trials.len();
        let (trial, reference) = (&trials[which], &references[which]);
        let used = &reference.0.labels;
        let fault = Fault::cast(KINDS[kind], used, trial.recording.frames(), &mut dice);
        let mut recording = trial.recording.clone();
        fault.write(&mut recording, &mut dice);
        one(trial, reference, &recording, &fault, &mut tallies[kind], tell.then_some(number))?;
    }
    println!();
    println!(
        "| fault | faults | marker-frames over 50 mm off: found | named as it is | accused | rotations determined | angles within 2° | plain | worse than plain | speed |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let mut all = Tally::default();
    for (kind, tally) in KINDS.iter().zip(&tallies) {
        print_row(kind, tally);
        all.faults += tally.faults;
        all.off += tally.off;
        all.found += tally.found;
        all.right += tally.right;
        all.accused += tally.accused;
        all.named += tally.named;
        all.judged += tally.judged;
        all.within += tally.within;
        all.plain_within += tally.plain_within;
        all.worse += tally.worse;
        all.determined += tally.determined;
        all.rotations += tally.rotations;
        (0..2).for_each(|i| all.time[i] += tally.time[i]);
    }
    print_row("all", &all);
    Ok(())
}

fn print_row(kind: &str, t: &Tally) {
    let share = |n: usize, of: usize| 100.0 * n as f64 / of.max(1) as f64;
    println!(
        "| {kind} | {} | {:.1} % of {} | {} | {:.3} % | {:.0} % | {} of {} | {} | {} | {:.0} % |",
        t.faults,
        share(t.found, t.off),
        t.off,
        t.named,
        share(t.accused, t.right),
        share(t.determined, t.rotations),
        t.within,
        t.judged,
        t.plain_within,
        t.worse,
        100.0 * t.time[0] / t.time[1]
    );
}

fn left_out(robust: &Tracking) -> impl Iterator<Item = &Faulty> {
    robust.faulty.iter().filter(|f| f.fault.is_left_out())
}

/// Frame and label of everything that was put right or left out.
fn touched(recording: &Recording, robust: &Tracking) -> HashSet<(usize, usize)> {
    let place = |name: &String| recording.labels.iter().position(|label| label == name);
    let swaps = robust.swaps.iter().flat_map(|s| s.labels.iter().map(|l| (l, &s.frames)));
    let left_out = left_out(robust).map(|f| (&f.label, &f.frames));
    let all = swaps.chain(left_out).filter_map(|(label, frames)| Some((place(label)?, frames)));
    all.flat_map(|(label, frames)| frames.clone().map(move |frame| (frame, label))).collect()
}

fn one(
    trial: &Trial,
    (clean, own): &(Tracking, HashSet<(usize, usize)>),
    recording: &Recording,
    fault: &Fault,
    tally: &mut Tally,
    tell: Option<usize>,
) -> Result<(), Box<dyn Error>> {
    let (plain, plain_time) = run(trial, recording, false)?;
    let (robust, robust_time) = run(trial, recording, true)?;
    let width = recording.labels.len();
    let touched = touched(recording, &robust);
    let (mut off_frames, mut found, mut all_off) = (HashSet::new(), 0, 0);
    let mut accused = 0;
    for frame in clean.frames.clone() {
        for &label in &clean.labels {
            let at = frame * width + label;
            let now = recording.positions[at].position();
            let Some(now) = now else { continue };
            let was = trial.recording.positions[at].position();
            let away = was.map_or(f64::INFINITY, |was| (Vec3::from(was) - Vec3::from(now)).norm());
            tally.right += 1;
            if away > 0.050 {
                off_frames.insert(frame);
                all_off += 1;
                found += usize::from(touched.contains(&(frame, label)));
            } else if away == 0.0 {
                let at = (frame, label);
                accused += usize::from(touched.contains(&at) && !own.contains(&at));
            }
        }
    }
    tally.faults += 1;
    tally.off += all_off;
    tally.found += found;
    tally.accused += accused;
    (tally.time[0], tally.time[1]) = (tally.time[0] + plain_time, tally.time[1] + robust_time);
    let mut off_frames: Vec<usize> = off_frames.into_iter().collect();
    off_frames.sort_unstable();
    if off_frames.is_empty() {
        return Ok(());
    }
    let named = is_named(trial, fault, &off_frames, &robust);
    tally.named += usize::from(named);
    let mut without = recording.clone();
    for &frame in &off_frames {
        fault.labels.iter().for_each(|l| without.positions[frame * width + l] = Observed::MISSING);
    }
    let (without, _) = run(trial, &without, false)?;
    let first = clean.frames.start;
    let of = |a: &Tracking, id, frames: &[usize]| {
        let frames = frames.iter().map(|f| f - first);
        let off = frames.map(|f| off(&trial.model, a, clean, id, f..f + 1).to_degrees());
        off.fold(0.0, f64::max)
    };
    let other_frames: Vec<usize> =
        clean.frames.clone().filter(|frame| !fault.frames.contains(frame)).collect();
    let (mut robust_off, mut plain_off) = ([0.0_f64; 2], [0.0_f64; 2]);
    for id in rotations(&trial.model) {
        tally.rotations += 1;
        if of(&without, id, &off_frames) < 1.0 {
            tally.determined += 1;
            robust_off[0] = robust_off[0].max(of(&robust, id, &off_frames));
            plain_off[0] = plain_off[0].max(of(&plain, id, &off_frames));
        }
        if of(&without, id, &other_frames) < 1.0 {
            robust_off[1] = robust_off[1].max(of(&robust, id, &other_frames));
            plain_off[1] = plain_off[1].max(of(&plain, id, &other_frames));
        }
    }
    let [robust_in, robust_out] = robust_off;
    let [robust_off, plain_off] = [robust_off, plain_off].map(|[a, b]| a.max(b));
    tally.judged += 1;
    tally.within += usize::from(robust_off <= 2.0);
    tally.plain_within += usize::from(plain_off <= 2.0);
    let is_worse = robust_off > plain_off + 0.2;
    tally.worse += usize::from(is_worse);
    if let Some(number) = tell {
        let names: Vec<&str> = fault.labels.iter().map(|&l| recording.labels[l].as_str()).collect();
        let (frames, kind) = (&fault.frames, fault.kind);
        println!(
            "{number} {}: {kind} {names:?} {frames:?}: found {found}/{all_off} accused {accused} named {named}, {robust_in:.2}° beyond {robust_out:.2}° plain {plain_off:.2}°{}",
            trial.name,
            if is_worse { " WORSE" } else { "" }
        );
        if robust_off > 2.0 || accused > 0 || found < all_off {
            robust.swaps.iter().take(6).for_each(|swap| println!("    {swap}"));
            robust.faulty.iter().take(6).for_each(|left| println!("    {left}"));
        }
    }
    Ok(())
}

/// Whether what was found says what the fault is, in nine tenths of the frames in which labels are off.
fn is_named(trial: &Trial, fault: &Fault, off: &[usize], robust: &Tracking) -> bool {
    let name = |&label: &usize| trial.recording.labels[label].clone();
    let names: Vec<String> = fault.labels.iter().map(name).collect();
    let cycles: Vec<Vec<String>> = match fault.kind {
        "three-cycle" => vec![names],
        "ghost" | "frozen" | "at 0 0 0" => {
            let covered = left_out(robust).filter(|l| l.label == names[0]);
            return enough(off, covered.map(|l| &l.frames));
        }
        _ => names.chunks_exact(2).map(<[String]>::to_vec).collect(),
    };
    cycles.iter().all(|cycle| {
        let same = |labels: &[String]| {
            labels.len() == cycle.len() && cycle.iter().all(|label| labels.contains(label))
        };
        let covered = robust.swaps.iter().filter(|swap| same(&swap.labels));
        enough(off, covered.map(|swap| &swap.frames))
    })
}

fn enough<'a>(off: &[usize], found: impl Iterator<Item = &'a Range<usize>>) -> bool {
    let found: Vec<_> = found.collect();
    let covered = off.iter().filter(|frame| found.iter().any(|range| range.contains(frame)));
    10 * covered.count() >= 9 * off.len()
}
