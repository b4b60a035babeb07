//! Whether other starts find better postures than tracking did:
//! `cargo run --release --example other_starts -- MODEL RECORDING [STEP [SETUP]]`.
//!
//! Every STEP-th frame is solved alone from ten starts (the first guesses, and random postures within the
//! ranges), and without limits; answers that are within the ranges compete. Then the recording is cut at
//! twenty places, and what is tracked from there on is compared with the whole. The printed ratio is that
//! of F + P.

use condyle::model::CoordinateKind;
use condyle::tracking::{Job, Request, Scratch, Tracker};
use condyle::{Model, open};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

/// Numbers from 0 to 1: SplitMix64 (Steele, Lea & Flood 2014).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A posture at random: rotations anywhere in their ranges, or within half a turn of the default.
fn anywhere(tracker: &Tracker, near: &[f64], dice: &mut Dice) -> Vec<f64> {
    let model = tracker.model();
    let mut stored = near.to_vec();
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let place = model.stored_range(id);
        if coordinate.kind == CoordinateKind::Orientation {
            let mut sum = 0.0;
            for x in &mut stored[place.clone()] {
                *x = 2.0 * dice.next() - 1.0;
                sum += *x * *x;
            }
            stored[place].iter_mut().for_each(|x| *x /= f64::sqrt(sum));
        } else if coordinate.kind == CoordinateKind::Rotation {
            let (lower, upper) = coordinate.range.bounds();
            let half = std::f64::consts::PI;
            let (lower, upper) = (lower.max(-half), upper.min(half));
            stored[place.start] = lower + (upper - lower) * dice.next();
        }
    }
    stored
}

fn within(model: &Model, stored: &[f64]) -> bool {
    let legal = |id| model.coordinate(id).range.distance(model.value(stored, id)) >= -1e-9;
    model.coordinate_ids().all(legal)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, recording, rest @ ..] = &arguments[..] else {
        return Err("give a model and a recording".into());
    };
    let step: usize = rest.first().map_or(Ok(10), |s| s.parse())?;
    let request = match rest.get(1) {
        Some(path) => Request::from_setup(&open::setup(Path::new(path))?.value),
        None => Request::default(),
    };
    let request = Request { threads: Some(1), time_range: None, ..request };
    let model = Arc::new(open::model(Path::new(model))?.value);
    let recording = open::recording(Path::new(recording))?.value;
    let job = Job::new(Arc::clone(&model), &recording, &request)?;
    let begin = std::time::Instant::now();
    let whole = job.run(&mut |_, _| {});
    let seconds = begin.elapsed().as_secs_f64();
    let free = Request { limits: false, ..request.clone() };
    let unlimited = Job::new(Arc::clone(&model), &recording, &free)?.run(&mut |_, _| {});
    let n = whole.answers.len();
    let iterations: u32 = whole.answers.iter().map(|a| a.iterations).sum();
    let rms = 1e3 * whole.summary().rms;
    println!(
        "{n} frames, {:.0} frames/s, {:.2} iterations a frame, {rms:.3} mm, {} failed",
        n as f64 / seconds,
        f64::from(iterations) / n as f64,
        whole.summary().failed.len()
    );
    let tracker = job.tracker();
    let mut scratch = Scratch::new(tracker);
    let (mut dice, mut worse, mut worst, mut looked) = (Dice(1), vec![], 1.0_f64, 0);
    for frame in (0..n).step_by(step) {
        looked += 1;
        let row = recording.frame(whole.frames.start + frame);
        let seen: Vec<_> =
            whole.labels.iter().map(|&l| row.get(l).and_then(|o| o.position())).collect();
        let answer = &whole.answers[frame];
        let mut best = (answer.minimised(), "tracked");
        let first = tracker.solve_first(&mut scratch, &seen, frame, 4);
        let mut offer = |f: f64, name| {
            if f < best.0 {
                best = (f, name)
            }
        };
        if first.status.is_solved() {
            offer(first.minimised(), "first guesses");
        }
        if within(&model, &unlimited.answers[frame].coordinates) {
            offer(unlimited.answers[frame].minimised(), "limits off");
        }
        for i in 0..9 {
            let near = if i % 2 == 0 { &first.coordinates } else { &answer.coordinates };
            let start = anywhere(tracker, near, &mut dice);
            let again = tracker.solve_frame(&mut scratch, &seen, frame, &start);
            if again.status.is_solved() {
                offer(again.minimised(), "at random");
            }
        }
        let ratio = answer.minimised() / best.0;
        worst = worst.max(ratio);
        if ratio > 1.001 && answer.minimised() > 1e-9 {
            worse.push((frame, ratio, best.1));
        }
    }
    println!("{} of {looked} frames above 1.001 times the best, worst {worst:.3}", worse.len());
    for (frame, ratio, name) in worse.iter().take(12) {
        println!("  frame {frame}: {ratio:.4} ({name})");
    }
    // Cuts.
    let mut cuts = vec![];
    let mut largest = std::collections::BTreeMap::<String, (f64, usize)>::new();
    for cut in 1..=20 {
        let at = cut * n / 21;
        let times = &whole.motion.times;
        let to = times[(at + 40).min(n - 1)];
        let part = Request { time_range: Some([times[at], to]), ..request.clone() };
        let Ok(job) = Job::new(Arc::clone(&model), &recording, &part) else { continue };
        let part = job.run(&mut |_, _| {});
        for (i, values) in part.motion.frames.iter().enumerate() {
            for id in model
                .coordinate_ids()
                .filter(|&id| model.coordinate(id).kind == CoordinateKind::Rotation)
            {
                let off = model.value(values, id) - model.value(&whole.motion.frames[at + i], id);
                let off = off.sin().atan2(off.cos()).abs().to_degrees();
                let key = model.coordinate_key(id);
                let entry = largest.entry(key).or_insert((0.0, 0));
                if off > entry.0 {
                    *entry = (off, at + i);
                }
            }
        }
        let ratio = |i: usize| part.answers[i].minimised() / whole.answers[at + i].minimised();
        cuts.push(
            (0..part.answers.len())
                .map(ratio)
                .fold(1.0, |m: f64, r| if (r - 1.0).abs() > (m - 1.0).abs() { r } else { m }),
        );
    }
    let mut largest: Vec<_> = largest.into_iter().collect();
    largest.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let (low, high) = cuts.iter().fold((1.0_f64, 1.0_f64), |(l, h), &r| (l.min(r), h.max(r)));
    println!("cuts: F of the part over that of the whole {low:.5} to {high:.5}");
    for (name, (off, frame)) in largest.iter().take(6) {
        println!("  {name}: {off:.3} degrees at frame {frame}");
    }
    Ok(())
}
