//! Whether other starts find better postures than tracking did:
//! `cargo run --release --example other_starts -- MODEL RECORDING [STEP [SETUP]] [--limits-off]`.
//!
//! Every STEP-th frame is solved alone from ten starts (the first guesses, and random postures within the
//! ranges), and without limits; answers that are within the ranges compete. Then the recording is cut at
//! twenty places, and what is tracked from there on is compared with the whole: the fit, and the angles that
//! the markers determine. The printed ratio is that
//! of F + P.
//!
//! A jump is a change between neighbouring frames of over 60° in a segment's orientation, or in a rotation's
//! number, where the answer continued from the frame before fits as well (F + P at most 1.001 times as large).

use condyle::formats::Recording;
use condyle::math::Quat;
use condyle::model::{CoordinateId, CoordinateKind, Mode};
use condyle::tracking::{Job, Request, Scratch, Tracker, Tracking, Trust};
use condyle::{Model, Pose, open};
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

/// Whether no rotation is more than half a turn beyond its range as the file states it, enforced or not: where a
/// knee is wound off the ends of its splines, there is no knee.
fn described(model: &Model, stored: &[f64]) -> bool {
    let beyond = |id: CoordinateId| {
        let (range, value) = (model.coordinate(id).range, model.value(stored, id));
        let half = std::f64::consts::PI;
        range.lower.is_some_and(|lower| value < lower - half)
            || range.upper.is_some_and(|upper| value > upper + half)
    };
    let mut rotations =
        model.coordinate_ids().filter(|&id| model.coordinate(id).kind == CoordinateKind::Rotation);
    !rotations.any(beyond)
}

fn within(model: &Model, stored: &[f64]) -> bool {
    let legal = |id| model.coordinate(id).range.distance(model.value(stored, id)) >= -1e-9;
    model.coordinate_ids().all(legal)
}

/// Beyond this a segment, or the number of a rotation, has jumped.
const JUMP: f64 = std::f64::consts::FRAC_PI_3;

/// The frames that jump although the answer continued from the frame before fits as well, and why.
fn needless_jumps(
    job: &Job<'_>,
    tracking: &Tracking,
    recording: &Recording,
) -> Vec<(usize, String)> {
    let tracker = job.tracker();
    let (model, program) = (tracker.model(), tracker.program());
    let (mut pose, mut scratch) = (Pose::new(program), Scratch::new(tracker));
    let mut turns = |stored: &[f64]| -> Vec<Quat> {
        let _ = program.evaluate(stored, Mode::Open, &mut pose);
        model.segment_ids().map(|id| Quat::from_mat3(pose.segment(id).linear)).collect()
    };
    let mut jumps = vec![];
    for frame in 0..tracking.answers.len().saturating_sub(1) {
        let [a, b] = [frame, frame + 1].map(|f| tracking.answers.coordinates(f));
        let [p, q] = [a, b].map(&mut turns);
        let segment = p.iter().zip(&q).map(|(p, q)| p.angle_to(*q)).enumerate();
        let segment = segment.max_by(|x, y| x.1.total_cmp(&y.1)).filter(|(_, turn)| *turn > JUMP);
        let rotation = |id: &CoordinateId| {
            model.coordinate(*id).kind == CoordinateKind::Rotation
                && (model.value(a, *id) - model.value(b, *id)).abs() > JUMP
        };
        let rotation = model.coordinate_ids().find(rotation);
        if segment.is_none() && rotation.is_none() {
            continue;
        }
        let row = recording.frame(tracking.frames.start + frame + 1);
        let seen: Vec<_> =
            tracking.labels.iter().map(|&l| row.get(l).and_then(|o| o.position())).collect();
        let continued = tracker.solve_frame(&mut scratch, &seen, frame + 1, a);
        let ratio =
            (continued.minimised() + 1e-12) / (tracking.answers.at(frame + 1).minimised() + 1e-12);
        if continued.status.is_solved() && ratio <= 1.001 {
            let segment = segment.map(|(i, turn)| {
                format!("{} turns by {:.0} degrees, ", model.segments()[i].name, turn.to_degrees())
            });
            let rotation = rotation.map(|id| {
                let values = [a, b].map(|stored| model.value(stored, id).to_degrees());
                format!("{} from {:.0} to {:.0}, ", model.coordinate_key(id), values[0], values[1])
            });
            let what = [segment, rotation].into_iter().flatten().collect::<String>();
            jumps.push((frame + 1, format!("{what}continued {ratio:.6}")));
        }
    }
    jumps
}

/// Which rotation of another posture is farthest off, in its range.
fn farthest(model: &Model, a: &[f64], b: &[f64]) -> String {
    let rotations =
        model.coordinate_ids().filter(|&id| model.coordinate(id).kind == CoordinateKind::Rotation);
    let off = |id: &CoordinateId| (model.value(a, *id) - model.value(b, *id)).abs();
    let Some(id) = rotations.max_by(|x, y| off(x).total_cmp(&off(y))) else {
        return String::new();
    };
    let (lower, upper) = model.coordinate(id).range.bounds();
    let [a, b, lower, upper] =
        [model.value(a, id), model.value(b, id), lower, upper].map(f64::to_degrees);
    format!("{} {a:.1} there {b:.1} in {lower:.0} to {upper:.0}", model.coordinate_key(id))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let all = arguments.len();
    arguments.retain(|argument| argument != "--limits-off");
    let limits = arguments.len() == all;
    let [model, recording, rest @ ..] = &arguments[..] else {
        return Err("give a model and a recording".into());
    };
    let step: usize = rest.first().map_or(Ok(10), |s| s.parse())?;
    let request = match rest.get(1) {
        Some(path) => Request::from_setup(&open::setup(Path::new(path))?.value),
        None => Request::default(),
    };
    let request = Request { threads: Some(1), time_range: None, limits, ..request };
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
        let answer = whole.answers.at(frame);
        let mut best = (answer.minimised(), "tracked", String::new());
        let first = tracker.solve_first(&mut scratch, &seen, frame, 4);
        let mut offer = |f: f64, name, stored: &[f64]| {
            if f < best.0 {
                best = (f, name, farthest(&model, &answer.coordinates, stored))
            }
        };
        if first.status.is_solved() {
            offer(first.minimised(), "first guesses", &first.coordinates);
        }
        let other = unlimited.answers.at(frame);
        if within(&model, &other.coordinates) {
            offer(other.minimised(), "limits off", &other.coordinates);
        }
        for i in 0..9 {
            let near = if i % 2 == 0 { &first.coordinates } else { &answer.coordinates };
            let start = anywhere(tracker, near, &mut dice);
            let again = tracker.solve_frame(&mut scratch, &seen, frame, &start);
            if again.status.is_solved() && described(&model, &again.coordinates) {
                offer(again.minimised(), "at random", &again.coordinates);
            }
        }
        let ratio = answer.minimised() / best.0;
        worst = worst.max(ratio);
        if ratio > 1.001 && answer.minimised() > 1e-9 {
            worse.push((frame, ratio, best.1, best.2));
        }
    }
    println!("{} of {looked} frames above 1.001 times the best, worst {worst:.3}", worse.len());
    for (frame, ratio, name, what) in worse.iter().take(12) {
        println!("  frame {frame}: {ratio:.4} ({name}: {what})");
    }
    let jumps = needless_jumps(&job, &whole, &recording);
    println!("{} jumps where going on fits as well", jumps.len());
    for (frame, what) in jumps.iter().take(6) {
        println!("  frame {frame}: {what}");
    }
    // Cuts.
    let mut cuts = vec![];
    let mut largest = std::collections::BTreeMap::<String, (f64, usize)>::new();
    for cut in 1..=20 {
        let at = cut * n / 21;
        let times = &whole.times;
        let to = times[(at + 40).min(n - 1)];
        let part = Request { time_range: Some([times[at], to]), ..request.clone() };
        let Ok(job) = Job::new(Arc::clone(&model), &recording, &part) else { continue };
        let part = job.run(&mut |_, _| {});
        for (i, values) in part.motion().frames.iter().enumerate() {
            for id in model
                .coordinate_ids()
                .filter(|&id| model.coordinate(id).kind == CoordinateKind::Rotation)
                .filter(|id| whole.trust_in(at + i)[id.index()] == Trust::Determined)
            {
                let off =
                    model.value(values, id) - model.value(whole.answers.coordinates(at + i), id);
                let off = off.sin().atan2(off.cos()).abs().to_degrees();
                let key = model.coordinate_key(id);
                let entry = largest.entry(key).or_insert((0.0, 0));
                if off > entry.0 {
                    *entry = (off, at + i);
                }
            }
        }
        let ratio =
            |i: usize| part.answers.at(i).minimised() / whole.answers.at(at + i).minimised();
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
