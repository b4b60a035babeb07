//! Tracking a recording whose motion is known.

use condyle::Observed;
use condyle::formats::Recording;
use condyle::tracking::{PostureRequest, Request, Swap, Tracking, track};
use condyle::{CoordinateKind, Model, Motion};

#[path = "../src/commands/demo/figure.rs"]
mod figure;

use figure::{Flaws, record, walk, walker};

fn run(model: &Model, recording: &Recording, request: &Request) -> Tracking {
    track(model, recording, request, &mut |_, _| {}).unwrap()
}

/// Root mean square and largest difference of all rotations, in degrees.
fn angle_errors(model: &Model, a: &Motion, b: &Motion) -> (f64, f64) {
    let (mut sum, mut max, mut n) = (0.0, 0.0_f64, 0.0);
    for (x, y) in a.frames.iter().zip(&b.frames) {
        for id in model.coordinate_ids() {
            if model.coordinate(id).kind == CoordinateKind::Rotation {
                let off = (model.value(x, id) - model.value(y, id)).to_degrees();
                sum += off * off;
                max = max.max(off.abs());
                n += 1.0;
            }
        }
    }
    (f64::sqrt(sum / n), max)
}

#[test]
fn a_clean_recording_gives_the_motion_back() {
    let model = walker();
    let truth = walk(&model, 150, 100.0);
    let flaws = Flaws { noise: 0.0, missing: 0.0, swap: None, seed: 3 };
    let tracking = run(&model, &record(&model, &truth, &flaws), &Request::default());
    let (rms, max) = angle_errors(&model, &tracking.motion(), &truth);
    // Left to the tolerance: a relative decrease of 1e-6 of nothing much.
    assert!(rms < 1e-3 && max < 0.02, "{rms} {max}");
    assert!(tracking.answers.iter().all(|a| a.status.is_solved()));
}

#[test]
fn noise_is_averaged_and_gaps_are_bridged() {
    let model = walker();
    let truth = walk(&model, 300, 100.0);
    let flaws = Flaws { noise: 0.002, missing: 0.05, swap: None, seed: 5 };
    let recording = record(&model, &truth, &flaws);
    assert!(recording.missing() > 300, "the recording has gaps");
    let tracking = run(&model, &recording, &Request::default());
    let (rms, max) = angle_errors(&model, &tracking.motion(), &truth);
    // Markers 5 to 15 cm from their axes, 2 mm of noise on two to four of them a joint: 0.5 to 1.5
    // degrees. Where a gap leaves a foot one marker its angles are far off for a moment, so the
    // largest error says nothing.
    assert!(rms < 1.5, "{rms} (largest {max})");
    assert!(tracking.summary().failed.is_empty());
    // Three coordinates of noise a marker, less what 33 free coordinates absorb of 135.
    let expected = 0.002 * f64::sqrt(3.0 * (1.0 - 33.0 / 135.0));
    let found = tracking.summary().rms;
    assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
}

#[test]
fn swapped_labels_are_found_and_put_right() {
    let model = walker();
    let truth = walk(&model, 200, 100.0);
    let labels = ["R.Knee".to_owned(), "L.Knee".to_owned()];
    let flaws = Flaws { noise: 0.001, missing: 0.02, swap: Some((labels, 60..110)), seed: 7 };
    let recording = record(&model, &truth, &flaws);
    let plain = run(&model, &recording, &Request::default());
    let robust = run(&model, &recording, &Request { robust: true, ..Request::default() });
    let [swap] = &robust.swaps[..] else { panic!("{:?}", robust.swaps) };
    let Swap { labels, frames } = swap;
    let mut names = labels.clone();
    names.sort();
    assert_eq!(names, ["L.Knee".to_owned(), "R.Knee".to_owned()]);
    assert!(frames.start.abs_diff(60) <= 12 && frames.end.abs_diff(110) <= 12, "{frames:?}");
    let (off_plain, _) = angle_errors(&model, &plain.motion(), &truth);
    let (off_robust, _) = angle_errors(&model, &robust.motion(), &truth);
    assert!(off_robust < 1.0 && off_plain > 3.0 * off_robust, "{off_plain} {off_robust}");
    // Without the option nothing is reported and nothing is changed.
    assert!(plain.swaps.is_empty());
}

#[test]
fn frames_without_markers_are_marked_and_the_run_goes_on() {
    let model = walker();
    let truth = walk(&model, 90, 100.0);
    let flaws = Flaws { noise: 0.001, missing: 0.0, swap: None, seed: 9 };
    let mut recording = record(&model, &truth, &flaws);
    let width = recording.labels.len();
    recording.positions[30 * width..45 * width].fill(Observed::MISSING);
    let tracking = run(&model, &recording, &Request::default());
    let failed: Vec<usize> = tracking.summary().failed.iter().map(|f| f.frame).collect();
    assert_eq!(failed, (30..45).collect::<Vec<_>>());
    let (rms, _) = angle_errors(
        &model,
        &Motion { times: vec![], frames: tracking.motion().frames[45..].to_vec() },
        &Motion { times: vec![], frames: truth.frames[45..].to_vec() },
    );
    assert!(rms < 1.0, "{rms}");
}

#[test]
fn an_answer_does_not_depend_on_where_the_recording_was_cut() {
    let model = walker();
    let truth = walk(&model, 200, 100.0);
    let recording =
        record(&model, &truth, &Flaws { noise: 0.002, missing: 0.03, swap: None, seed: 11 });
    let whole = run(&model, &recording, &Request::default());
    let part =
        run(&model, &recording, &Request { time_range: Some([0.5, 1.5]), ..Request::default() });
    assert_eq!(part.frames, 50..151);
    let same = Motion { times: vec![], frames: whole.motion().frames[50..151].to_vec() };
    let (_, max) = angle_errors(&model, &part.motion(), &same);
    assert!(max < 0.02, "{max} degrees");
}

#[test]
fn postures_and_values_are_asked_for_by_name() {
    // The first angle of the figure, asked to rest where the markers do not have it.
    let model = walker();
    let truth = walk(&model, 70, 100.0);
    let recording =
        record(&model, &truth, &Flaws { noise: 0.0, missing: 0.0, swap: None, seed: 13 });
    let id = model.coordinate_ids().find(|&id| {
        let coordinate = model.coordinate(id);
        coordinate.kind == CoordinateKind::Rotation && !coordinate.locked
    });
    let name = model.coordinate_key(id.unwrap());
    let place = model.stored_range(id.unwrap()).start;
    let at = |request: &Request| run(&model, &recording, request);
    let free = at(&Request::default());
    // So stiff that markers of a few centimetres have no say.
    let stiff = |rest: f64| Request {
        postures: vec![
            PostureRequest {
                coordinates: vec![(name.clone(), 2.0)],
                rest: Some(rest),
                stiffness: 1e4,
            },
            PostureRequest {
                coordinates: vec![("nose".to_owned(), 1.0)],
                rest: None,
                stiffness: 1.0,
            },
        ],
        ..Request::default()
    };
    let held = at(&stiff(0.3));
    let value = |t: &Tracking| t.motion().frames[69][place];
    assert!((value(&held) - 0.15).abs() < 1e-4, "{}", value(&held));
    assert!((value(&free) - value(&held)).abs() > 0.01, "{}", value(&free));
    let (summary, report) = (held.summary(), held.report(&model));
    assert!(summary.objective > free.summary().objective && summary.objective_posture > 0.0);
    assert_eq!((free.summary().objective_posture, &report.summary), (0.0, &summary));
    let [said] = &held.warnings[..] else { panic!("{:?}", held.warnings) };
    assert!(said.code == "track/unknown-coordinate" && said.message.contains("`nose`"), "{said}");
    let error = track(
        &model,
        &recording,
        &Request { time_range: Some([7.0, 8.0]), ..Request::default() },
        &mut |_, _| {},
    );
    assert_eq!(error.unwrap_err().code(), "track/no-frames");
}
