//! Robust tracking of recordings whose faults are known.

use condyle::formats::Recording;
use condyle::math::Vec3;
use condyle::model::Mode;
use condyle::tracking::{Fault, Request, Tracking, track};
use condyle::{CoordinateKind, Model, Motion, Observed};
use std::f64::consts::TAU;
use std::ops::Range;

#[path = "../src/commands/demo/figure.rs"]
mod figure;

use figure::{walk, walker};

const FRAMES: usize = 120;

/// Two seconds of a walk; each marker lies up to 26 mm beside its place on the model (15 mm an axis) all
/// the time, which is no fault, and has a noise of up to 2 mm an axis.
fn recording(model: &Model) -> Recording {
    let points = model.markers().iter().zip(1..);
    let spread = |seed: f64| (seed * 12.9898).sin();
    let beside = |i: f64| Vec3::new(spread(i), spread(i + 0.3), spread(i + 0.7)) * 0.015;
    let points: Vec<_> = points.map(|(m, i)| Some(m.point + beside(f64::from(i)))).collect();
    let placed = model.with_markers_at(&points);
    let motion: Motion = walk(model, FRAMES, 60.0);
    let mut recording = motion.virtual_markers(&placed, Mode::Open).unwrap();
    let positions = recording.positions.iter_mut().filter_map(Observed::position_mut);
    for (i, x) in positions.flatten().enumerate() {
        *x += 0.002 * spread(0.1 * i as f64);
    }
    recording
}

fn run(model: &Model, recording: &Recording, robust: bool) -> Tracking {
    let request = Request { robust, ..Request::default() };
    track(model, recording, &request, &mut |_, _| {}).unwrap()
}

fn label(recording: &Recording, name: &str) -> usize {
    recording.marker(name).unwrap_or_else(|| panic!("{name} is not among {:?}", recording.labels))
}

/// Each label is given the positions of the next one of its cycle.
fn exchange(recording: &mut Recording, cycle: &[&str], frames: Range<usize>) {
    let cycle: Vec<usize> = cycle.iter().map(|name| label(recording, name)).collect();
    let width = recording.labels.len();
    for frame in frames {
        let row = &mut recording.positions[frame * width..(frame + 1) * width];
        cycle.windows(2).for_each(|pair| row.swap(pair[0], pair[1]));
    }
}

fn set(recording: &mut Recording, name: &str, frames: Range<usize>, to: impl Fn(Vec3) -> Vec3) {
    let (label, width) = (label(recording, name), recording.labels.len());
    for frame in frames {
        let at = &mut recording.positions[frame * width + label];
        let place = Vec3::from(at.position().unwrap());
        *at = Observed::from(to(place).to_array());
    }
}

/// The largest difference of an angle, in degrees.
fn most(model: &Model, a: &Tracking, b: &Tracking) -> f64 {
    let ids = model.coordinate_ids();
    let ids = ids.filter(|id| model.coordinate(*id).kind == CoordinateKind::Rotation);
    let [a, b] = [a, b].map(Tracking::motion);
    let frames = || a.frames.iter().zip(&b.frames);
    let turn = |off: f64| (off - TAU * (off / TAU).round()).abs();
    ids.flat_map(|id| frames().map(move |(x, y)| turn(model.value(x, id) - model.value(y, id))))
        .fold(0.0, f64::max)
        .to_degrees()
}

/// The cycles found, each from its alphabetically first label on, with their frames.
fn cycles(tracking: &Tracking) -> Vec<(Vec<&str>, Range<usize>)> {
    let mut found: Vec<_> = tracking
        .swaps
        .iter()
        .map(|swap| {
            let mut labels: Vec<&str> = swap.labels.iter().map(String::as_str).collect();
            let first = (0..labels.len()).min_by_key(|&i| labels[i]).unwrap();
            labels.rotate_left(first);
            (labels, swap.frames.clone())
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

#[test]
fn constant_offsets_are_no_faults() {
    let model = walker();
    let recording = recording(&model);
    let (plain, robust) = (run(&model, &recording, false), run(&model, &recording, true));
    assert!(robust.swaps.is_empty() && robust.faulty.is_empty(), "{:?}", robust.faulty);
    assert_eq!(plain.motion(), robust.motion());
    assert_eq!(plain.answers, robust.answers);
    assert!(plain.summary().max > 0.020, "the markers lie beside their places");
}

#[test]
fn exchanged_labels_are_put_right_from_one_frame_to_the_whole_trial() {
    let model = walker();
    let clean = recording(&model);
    let reference = run(&model, &clean, false);
    let names: Vec<&str> = clean.labels.iter().map(String::as_str).collect();
    // Pairs of markers far apart along the list, so of different segments.
    let pair = |i: usize| [names[i], names[(i + 20) % names.len()]];
    let cases: Vec<(Vec<Vec<&str>>, Range<usize>)> = vec![
        (vec![pair(3).to_vec()], 40..41),
        (vec![pair(3).to_vec(), pair(8).to_vec()], 10..25),
        (vec![pair(0).to_vec(), pair(5).to_vec(), pair(10).to_vec()], 60..FRAMES),
        ((0..4).map(|i| pair(4 * i).to_vec()).collect(), 0..FRAMES / 2),
        (vec![vec![names[2], names[19], names[33]]], 70..71),
        (vec![vec![names[6], names[24], names[41]]], 30..80),
        (vec![pair(12).to_vec()], 0..FRAMES),
    ];
    for (exchanged, frames) in cases {
        let mut faulty = clean.clone();
        exchanged.iter().for_each(|cycle| exchange(&mut faulty, cycle, frames.clone()));
        let (plain, robust) = (run(&model, &faulty, false), run(&model, &faulty, true));
        let mut truth: Vec<_> = exchanged
            .into_iter()
            .map(|mut cycle| {
                let first = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap();
                cycle.rotate_left(first);
                (cycle, frames.clone())
            })
            .collect();
        truth.sort_by(|a, b| a.0.cmp(&b.0));
        assert_eq!(cycles(&robust), truth);
        assert!(robust.faulty.is_empty(), "{:?}", robust.faulty);
        let (off, plain_off) =
            (most(&model, &robust, &reference), most(&model, &plain, &reference));
        // The same markers as in the clean recording, so the same answers but for the tolerance.
        assert!(off < 0.1 && plain_off > 2.0, "{truth:?}: {off} (plain {plain_off}) degrees");
    }
}

#[test]
fn markers_that_jump_stay_behind_or_are_lost_are_left_out() {
    let model = walker();
    let clean = recording(&model);
    let reference = run(&model, &clean, false);
    let knee = clean.labels.iter().find(|l| l.contains("Knee")).unwrap().clone();
    let cases: [(Fault, Range<usize>); 4] = [
        (Fault::Elsewhere, 50..51),
        (Fault::Elsewhere, 0..FRAMES / 2),
        (Fault::AtOrigin, 90..FRAMES),
        (Fault::Frozen, 20..60),
    ];
    for (fault, frames) in cases {
        let mut faulty = clean.clone();
        let at = frames.start * clean.labels.len() + label(&clean, &knee);
        let first = Vec3::from(clean.positions[at].position().unwrap());
        set(&mut faulty, &knee, frames.clone(), |place| match fault {
            Fault::AtOrigin => Vec3::ZERO,
            Fault::Frozen => first,
            _ => place + Vec3::new(0.08, 0.10, -0.04),
        });
        let (plain, robust) = (run(&model, &faulty, false), run(&model, &faulty, true));
        assert!(robust.swaps.is_empty(), "{:?}", robust.swaps);
        let [found] = &robust.faulty[..] else { panic!("{fault:?}: {:?}", robust.faulty) };
        assert_eq!((&found.label, found.fault), (&knee, fault));
        // What stays behind is a fault only when the body has moved on by what a marker may stray.
        let width = clean.labels.len();
        for frame in frames.start..found.frames.start {
            let place = clean.positions[frame * width + label(&clean, &knee)].position().unwrap();
            let moved = (Vec3::from(place) - first).norm();
            assert!(fault == Fault::Frozen && moved < 0.040, "{fault:?} {frame}: {moved}");
        }
        assert_eq!(found.frames.end, frames.end, "{fault:?}");
        let (off, plain_off) =
            (most(&model, &robust, &reference), most(&model, &plain, &reference));
        // One marker less on a thigh or shank that has three to five more.
        assert!(off < 2.0 && plain_off > off, "{fault:?}: {off} (plain {plain_off}) degrees");
    }
}

#[test]
fn a_frame_alone_is_changed_only_by_what_is_far_off() {
    let model = walker();
    let clean = recording(&model);
    let mut one = Recording {
        times: clean.times[30..31].to_vec(),
        positions: clean.frame(30).to_vec(),
        ..clean.clone()
    };
    let (plain, robust) = (run(&model, &one, false), run(&model, &one, true));
    assert_eq!(plain.motion(), robust.motion());
    let said: Vec<&str> = robust.warnings.iter().map(|w| w.code).collect();
    assert_eq!(said, ["track/unknown-offsets"]);
    let name = clean.labels[5].clone();
    set(&mut one, &name, 0..1, |place| place + Vec3::Y * 0.5);
    let mended = run(&model, &one, true);
    assert_eq!(mended.faulty.iter().map(|f| &f.label).collect::<Vec<_>>(), [&name]);
    assert!(most(&model, &mended, &plain) < 5.0);
}

#[test]
fn the_answer_does_not_depend_on_the_number_of_threads() {
    let model = walker();
    let mut faulty = recording(&model);
    let names: Vec<String> = [7, 31].map(|i| faulty.labels[i].clone()).to_vec();
    exchange(&mut faulty, &[&names[0], &names[1]], 20..50);
    let on = |threads| {
        let request = Request { robust: true, threads: Some(threads), ..Request::default() };
        track(&model, &faulty, &request, &mut |_, _| {}).unwrap()
    };
    let (one, three) = (on(1), on(3));
    assert_eq!((one.motion(), one.swaps), (three.motion(), three.swaps));
}
