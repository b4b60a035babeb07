//! Relations between answers that hold whatever the right answer is, on random bodies and recordings: another
//! order, other names, a turned, mirrored or larger world, time that runs backwards.

mod body;
mod trial;

use body::{Body, Dice};
use condyle_math::{Quat, Vec3};
use std::sync::OnceLock;
use trial::{Against, FRAMES, Off, Rows, Tracked, compare, recorded};

/// How many bodies each relation is tried on.
fn seeds() -> std::ops::Range<u64> {
    let n = std::env::var("BODIES").ok().and_then(|n| n.parse().ok()).unwrap_or(24);
    0..n
}

struct Trial {
    truth: Vec<Vec<f64>>,
    rows: Rows,
    plain: Tracked<'static>,
}

/// The bodies with their recordings, tracked as they are.
fn trials() -> &'static [Trial] {
    static TRIALS: OnceLock<Vec<Trial>> = OnceLock::new();
    TRIALS.get_or_init(|| {
        let trial = |seed| {
            let body: &'static Body = Box::leak(Box::new(Body::random(seed)));
            let (truth, rows) = recorded(body, seed);
            let plain = Tracked::plain(body, &rows);
            Trial { truth, rows, plain }
        };
        seeds().map(trial).collect()
    })
}

fn same(_: usize, turn: Quat) -> Quat {
    turn
}

fn against(seed: usize) -> Against<'static> {
    Against { frame: &|frame| Some(frame), image: &same, growth: 1.0, case: format!("body {seed}") }
}

fn all(rows: &Rows, mut change: impl FnMut(&mut Vec<Option<[f64; 3]>>)) -> Rows {
    let mut rows = rows.clone();
    rows.iter_mut().for_each(&mut change);
    rows
}

fn mapped(rows: &Rows, change: impl Fn(Vec3) -> Vec3) -> Rows {
    all(rows, |row| {
        for place in row.iter_mut().flatten() {
            *place = change(Vec3::from(*place)).to_array();
        }
    })
}

/// Tries a relation on all bodies and prints how far it is off.
fn relation(name: &str, mut try_one: impl FnMut(usize, &Trial) -> Off) -> Off {
    let mut off = Off::default();
    for (seed, trial) in trials().iter().enumerate() {
        let one = try_one(seed, trial);
        if std::env::var("EACH").is_ok() && (one.fit > 1e-6 || one.turn > 1e-4 || one.statuses > 0) {
            println!("   {name}: {one:?}");
        }
        off.add(one);
    }
    println!(
        "{name}: fit {:.1e} ({}), turn {:.1e} rad ({}), number {:.1e} ({}), {} statuses, {} joints, {} undetermined",
        off.fit, off.at[0], off.turn, off.at[1], off.number, off.at[2], off.statuses, off.compared, off.undetermined
    );
    off
}

fn bits(a: &Tracked<'_>, b: &Tracked<'_>, case: usize) {
    for (frame, (a, b)) in a.answers.iter().zip(&b.answers).enumerate() {
        assert_eq!(a.coordinates, b.coordinates, "body {case} frame {frame}");
        assert_eq!(a.minimised(), b.minimised(), "body {case} frame {frame}");
    }
}

#[test]
fn recorded_markers_in_another_order() {
    relation("recorded order", |seed, trial| {
        let order = Dice(seed as u64).shuffled(trial.plain.body.points_len());
        let rows = all(&trial.rows, |row| *row = order.iter().map(|&i| row[i]).collect());
        let tracker = trial.plain.body.tracker(&order, &[]);
        compare(&trial.plain, &Tracked::of(trial.plain.body, tracker, &rows, None), &against(seed))
    });
}

#[test]
fn other_names_markers_nobody_records_and_weight_nought() {
    relation("names", |seed, trial| {
        let dice = &mut Dice(seed as u64);
        let plain = &trial.plain;
        let mut body = plain.body.clone();
        body.prefix = "another_";
        body.marker_order = dice.shuffled(body.points_len());
        body.unused = vec![dice.vector(0.5), dice.vector(0.5)];
        let other = Tracked::plain(&body, &trial.rows);
        bits(plain, &other, seed);
        // Markers of weight 0 are seen where they cannot be.
        let n = body.points_len();
        let all_points: Vec<usize> = (0..n).collect();
        let mut targets = body.tracker(&all_points, &[]).targets().clone();
        targets.markers.push(targets.markers[0].clone());
        targets.markers[n].weight = 0.0;
        let rows = all(&trial.rows, |row| row.push(Some([9.0, -4.0, 1.0])));
        let tracker = condyle_track::Tracker::new(body.build(), targets, Default::default());
        let weightless = Tracked::of(&body, tracker, &rows, None);
        bits(plain, &weightless, seed);
        compare(plain, &weightless, &against(seed))
    });
}

#[test]
fn segments_in_another_order() {
    relation("segments", |seed, trial| {
        let mut body = trial.plain.body.clone();
        body.order = Dice(seed as u64).shuffled(body.parts_len());
        compare(&trial.plain, &Tracked::plain(&body, &trial.rows), &against(seed))
    });
}

#[test]
fn a_turned_and_moved_world() {
    relation("turned world", |seed, trial| {
        let dice = &mut Dice(seed as u64);
        let (turn, moved) = (Quat::exp(dice.vector(2.5)), dice.vector(2.0));
        let rows = mapped(&trial.rows, |p| turn.to_mat3() * p + moved);
        let image = |part: usize, own: Quat| if part == 0 { turn * own } else { own };
        let other = Tracked::plain(trial.plain.body, &rows);
        compare(&trial.plain, &other, &Against { image: &image, ..against(seed) })
    });
}

#[test]
fn a_mirrored_world() {
    relation("mirrored", |seed, trial| {
        let body = trial.plain.body.mirrored();
        let rows = mapped(&trial.rows, |p| Vec3::new(p.x, p.y, -p.z));
        let image = |_: usize, q: Quat| Quat { x: -q.x, y: -q.y, ..q };
        let other = Tracked::plain(&body, &rows);
        compare(&trial.plain, &other, &Against { image: &image, ..against(seed) })
    });
}

#[test]
fn a_larger_world() {
    relation("twice the size", |seed, trial| {
        let body = trial.plain.body.resized(2.0);
        let rows = mapped(&trial.rows, |p| p * 2.0);
        let other = Tracked::plain(&body, &rows);
        compare(&trial.plain, &other, &Against { growth: 4.0, ..against(seed) })
    });
}

#[test]
fn time_backwards() {
    relation("backwards", |seed, trial| {
        let mut rows = trial.rows.clone();
        rows.reverse();
        let other = Tracked::plain(trial.plain.body, &rows);
        let frame = |frame| Some(FRAMES - 1 - frame);
        compare(&trial.plain, &other, &Against { frame: &frame, ..against(seed) })
    });
}

#[test]
fn cuts() {
    relation("cuts", |seed, trial| {
        let mut off = Off::default();
        for cut in [1, 13, 37, 64, 65, 100, 127, 140, 149] {
            let rows = trial.rows[cut..].to_vec();
            let other = Tracked::plain(trial.plain.body, &rows);
            let frame = |frame: usize| frame.checked_sub(cut);
            let case = format!("body {seed} cut at {cut}");
            off.add(compare(&trial.plain, &other, &Against { frame: &frame, case, ..against(seed) }));
        }
        off
    });
}

#[test]
fn other_chunks() {
    for length in [16, FRAMES] {
        relation(&format!("chunks of {length}"), |seed, trial| {
            let all: Vec<usize> = (0..trial.plain.body.points_len()).collect();
            let tracker = trial.plain.body.tracker(&all, &[]);
            let other = Tracked::of(trial.plain.body, tracker, &trial.rows, Some(length));
            compare(&trial.plain, &other, &against(seed))
        });
    }
}

#[test]
fn markers_twice_at_half_weight() {
    relation("twice at half weight", |seed, trial| {
        let n = trial.plain.body.points_len();
        let twice: Vec<usize> = Dice(seed as u64).shuffled(n).into_iter().take(n / 2).collect();
        let all_points: Vec<usize> = (0..n).collect();
        let rows = all(&trial.rows, |row| row.extend(twice.iter().map(|&i| row[i]).collect::<Vec<_>>()));
        let tracker = trial.plain.body.tracker(&all_points, &twice);
        compare(&trial.plain, &Tracked::of(trial.plain.body, tracker, &rows, None), &against(seed))
    });
}

#[test]
fn weights_times_a_constant() {
    for factor in [4.0, 3.0, 1e6] {
        relation(&format!("weights times {factor}"), |seed, trial| {
            let body = trial.plain.body.reweighed(factor);
            let other = Tracked::plain(&body, &trial.rows);
            if factor == 4.0 {
                bits(&trial.plain, &other, seed);
            }
            compare(&trial.plain, &other, &against(seed))
        });
    }
}

#[test]
fn loops_that_hold_anyway() {
    relation("redundant loops", |seed, trial| {
        let mut body = trial.plain.body.clone();
        body.redundant = true;
        compare(&trial.plain, &Tracked::plain(&body, &trial.rows), &against(seed))
    });
}

/// Which of these frames fit worse than from the true posture, by how much.
fn missed(tracked: &Tracked<'_>, truth: &[Vec<f64>], rows: &Rows) -> Vec<(usize, f64)> {
    let mut scratch = condyle_track::Scratch::new(&tracked.tracker);
    let mut missed = vec![];
    for (frame, answer) in tracked.answers.iter().enumerate() {
        let best = tracked.tracker.solve_frame(&mut scratch, &rows[frame], frame, &truth[frame]);
        let ratio = (answer.minimised() + 1e-12) / (best.minimised() + 1e-12);
        if best.status.is_solved() && answer.status.is_solved() && ratio > 1.001 {
            missed.push((frame, ratio));
        }
    }
    missed
}

#[test]
fn the_true_posture() {
    let (mut frames, mut total) = (0, 0);
    for (seed, trial) in trials().iter().enumerate() {
        let missed = missed(&trial.plain, &trial.truth, &trial.rows);
        total += trial.rows.len();
        frames += missed.len();
        if !missed.is_empty() {
            println!("   truth: body {seed}: {} frames, first {:?}", missed.len(), &missed[..missed.len().min(4)]);
        }
    }
    println!("truth: {frames} of {total} frames above 1.001 times");
}

#[test]
fn each_frame_alone() {
    let (mut frames, mut total) = (0, 0);
    for (seed, trial) in trials().iter().enumerate() {
        let mut scratch = condyle_track::Scratch::new(&trial.plain.tracker);
        let mut missed = vec![];
        for frame in (0..FRAMES).step_by(5) {
            let alone = trial.plain.tracker.solve_first(&mut scratch, &trial.rows[frame], frame, 4);
            let best = trial.plain.tracker.solve_frame(&mut scratch, &trial.rows[frame], frame, &trial.truth[frame]);
            let ratio = (alone.minimised() + 1e-12) / (best.minimised() + 1e-12);
            total += 1;
            if best.status.is_solved() && alone.status.is_solved() && ratio > 1.001 {
                missed.push((frame, ratio));
                if std::env::var("EACH").is_ok() && missed.len() < 3 {
                    let plain = &trial.plain;
                    println!("body {seed} frame {frame} ratio {ratio} F {:.2e} {:?} {:?}", best.minimised(), alone.status, best.status);
                    let fake = |answer: &condyle_track::FrameAnswer| Tracked { body: plain.body, tracker: plain.tracker.clone(), answers: vec![answer.clone()], trust: vec![] };
                    let (a, b) = (fake(&alone), fake(&best));
                    for part in 0..plain.body.parts_len() {
                        let off = a.turns(0)[part].angle_to(b.turns(0)[part]);
                        println!("    part {part} off {off:.3} alone {:.3?} best {:.3?} {}", a.numbers(0, part), b.numbers(0, part), plain.body.describe(part));
                    }
                }
            }
        }
        frames += missed.len();
        if !missed.is_empty() {
            println!("   alone: body {seed}: {} frames, first {:?}", missed.len(), &missed[..missed.len().min(4)]);
        }
    }
    println!("alone: {frames} of {total} frames above 1.001 times");
}

#[test]
fn probe() {
    let Ok(what) = std::env::var("PROBE") else { return };
    let words: Vec<usize> = what.split(' ').map(|w| w.parse().unwrap()).collect();
    let (seed, from, to, length, cut) = (words[0], words[1], words[2], words[3], words[4]);
    let body = Body::random(seed as u64);
    let (truth, rows) = recorded(&body, seed as u64);
    for part in 0..body.parts_len() {
        println!("{part}: {}", body.describe(part));
    }
    let all: Vec<usize> = (0..body.points_len()).collect();
    let plain = Tracked::plain(&body, &rows);
    let part_rows = rows[cut..].to_vec();
    let other = Tracked::of(&body, body.tracker(&all, &[]), &part_rows, Some(length));
    let mut scratch = condyle_track::Scratch::new(&plain.tracker);
    for frame in from..to {
        let best = plain.tracker.solve_frame(&mut scratch, &rows[frame], frame, &truth[frame]);
        let alone = plain.tracker.solve_first(&mut scratch, &rows[frame], frame, 4);
        let seen = rows[frame].iter().flatten().count();
        println!("frame {frame} seen {seen} truth {:.3e} plain {:.3e} other {:.3e} alone {:.3e}", best.minimised(), plain.answers[frame].minimised(), other.answers[frame - cut].minimised(), alone.minimised());
        let fake = Tracked { body: &body, tracker: plain.tracker.clone(), answers: vec![best], trust: vec![] };
        for part in 0..body.parts_len() {
            let (a, b, t) = (plain.turns(frame)[part], other.turns(frame - cut)[part], fake.turns(0)[part]);
            if a.angle_to(b) > 0.0001 || a.angle_to(t) > 0.0001 {
                println!("    part {part} plain {:.5?} other {:.5?} truth {:.5?} {}", plain.numbers(frame, part), other.numbers(frame - cut, part), fake.numbers(0, part), plain.determines(frame, part));
            }
        }
    }
}
