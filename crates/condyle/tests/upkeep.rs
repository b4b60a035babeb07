//! Upkeep of recordings and tables beside SciPy, and what it must never do.

use condyle::upkeep::{Axes, Plan, Series, Step};
use condyle::{AngleUnit, LengthUnit, Observed, Recording, Table};
use serde_json::Value;

/// The signal of `oracles/upkeep/answers.py`.
fn signal(i: usize) -> f64 {
    let i = i as f64;
    (0.37 * i).sin() + 0.3 * (1.9 * i).cos() + 0.01 * i
}

fn uneven(i: usize) -> f64 {
    0.01 * i as f64 + 0.003 * (i as f64).sin()
}

fn series(time: impl Fn(usize) -> f64) -> Series {
    Series {
        times: (0..60).map(time).collect(),
        columns: vec![(0..60).map(signal).collect()],
        together: 1,
    }
}

fn answers(key: &str) -> Vec<f64> {
    let text = include_str!("../../../oracles/upkeep/answers.json");
    let all: Value = serde_json::from_str(text).expect("JSON");
    all[key].as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[track_caller]
fn near(found: &[f64], expected: &[f64], within: f64) {
    assert_eq!(found.len(), expected.len());
    for (row, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= within, "row {row}: {a} is not {b}");
    }
}

#[test]
fn low_pass_is_that_of_scipy() {
    for (hertz, key) in [(6.0, "low_pass_6"), (20.0, "low_pass_20")] {
        let mut all = series(|i| i as f64 / 100.0);
        Step::LowPass { hertz }.apply(&mut all).expect("even times");
        // Some hundred operations on numbers of size 1.
        near(&all.columns[0], &answers(key), 1e-12);
    }
}

#[test]
fn both_passes_leave_half_of_the_power() {
    // A long sine at the cut-off: its amplitude in the middle is 1/√2.
    for hertz in [4.0, 11.0] {
        let rate = 200.0;
        let times: Vec<f64> = (0..4000).map(|i| f64::from(i) / rate).collect();
        let wave = |t: &f64| (std::f64::consts::TAU * hertz * t).sin();
        let mut all =
            Series { columns: vec![times.iter().map(wave).collect()], times, together: 1 };
        Step::LowPass { hertz }.apply(&mut all).expect("even times");
        let middle = &all.columns[0][1500..2500];
        let power = 2.0 * middle.iter().map(|y| y * y).sum::<f64>() / middle.len() as f64;
        assert!((power - 0.5).abs() < 1e-9, "{power}");
    }
}

#[test]
fn gaps_are_filled_as_by_scipy_and_ends_are_not() {
    let gone = [1, 20, 21, 22, 40, 58];
    let mut all = series(uneven);
    for row in gone {
        all.columns[0][row] = f64::NAN;
    }
    let said = Step::Fill { seconds: 0.06 }.apply(&mut all).expect("a time");
    assert_eq!(said, "filled 4 gaps of up to 0.06 s, 6 values");
    near(&gone.map(|row| all.columns[0][row]), &answers("filled"), 1e-12);

    let mut all = series(|i| i as f64 / 100.0);
    for row in [0, 10, 11, 30, 31, 32, 33, 59] {
        all.columns[0][row] = f64::NAN;
    }
    // From frame 9 to 12 are 0.03 s, from 29 to 34 0.05 s.
    let said = Step::Fill { seconds: 0.03 }.apply(&mut all).expect("a time");
    assert_eq!(said, "filled 1 gap of up to 0.03 s, 2 values; 1 longer one was left");
    let missing: Vec<usize> = (0..60).filter(|&row| all.columns[0][row].is_nan()).collect();
    assert_eq!(missing, [0, 30, 31, 32, 33, 59]);
}

#[test]
fn other_rates_are_those_of_scipy_and_gaps_stay() {
    let mut all = series(uneven);
    Step::Resample { hertz: 37.0 }.apply(&mut all).expect("a rate");
    near(&all.columns[0], &answers("resampled_37"), 1e-12);
    for (n, expected) in [2, 3, 4].into_iter().zip(answers("short")) {
        let mut few = series(uneven);
        few.times.truncate(n);
        few.columns[0].truncate(n);
        let half = 2.0 / (uneven(1) - uneven(0));
        Step::Resample { hertz: half }.apply(&mut few).expect("a rate");
        near(&few.columns[0][1..2], &[expected], 1e-12);
    }
    // A gap from row 10 to 20: no new row within it.
    let mut all = series(|i| i as f64 / 100.0);
    all.columns[0][11..20].fill(f64::NAN);
    Step::Resample { hertz: 250.0 }.apply(&mut all).expect("a rate");
    for (time, value) in all.times.iter().zip(&all.columns[0]) {
        assert_eq!(value.is_nan(), *time > 0.1001 && *time < 0.1999, "{time}");
    }
}

#[test]
fn rates_of_change_are_those_of_numpy() {
    let mut all = series(uneven);
    Step::Differentiate.apply(&mut all).expect("times increase");
    // Differences of numbers of size 1 over 0.01 s.
    near(&all.columns[0], &answers("differentiated"), 1e-10);
}

#[test]
fn a_recording_is_turned_filtered_and_cut() {
    let seen = |i: usize| Observed::from([i as f64, 2.0, 0.5]);
    let mut recording = Recording {
        labels: vec!["LASI".into()],
        rate: 100.0,
        times: (0..50).map(|i| i as f64 / 100.0).collect(),
        positions: (0..50).map(|i| if i == 25 { Observed::MISSING } else { seen(i) }).collect(),
        units: LengthUnit::Millimetre,
        confidences: None,
    };
    let plan = Plan {
        axes: Some("x,z,-y".parse::<Axes>().expect("axes")),
        fill: Some(0.02),
        low_pass: Some(10.0),
        resample: Some(50.0),
        crop: Some((0.1, 0.3)),
        differentiate: false,
    };
    let done = plan.recording(&mut recording).expect("a plan");
    assert_eq!((recording.rate, recording.frames()), (50.0, 11));
    assert_eq!((done.steps.len(), done.warnings.len()), (5, 0), "{done:?}");
    assert_eq!(done.steps[1], "filled 1 gap of up to 0.02 s, 1 value");
    // A line passes a zero-lag filter as it is, away from the ends; y up is the former z.
    for (row, time) in recording.times.iter().enumerate() {
        let [x, y, z] = recording.position(row, 0).expect("seen");
        assert!(
            (x - 100.0 * time).abs() < 1e-6 && (y - 0.5).abs() < 1e-12 && (z + 2.0).abs() < 1e-12
        );
    }
    let fast = Plan { resample: Some(10.0), ..Plan::default() };
    let done = fast.recording(&mut recording).expect("a plan");
    assert_eq!(done.warnings[0].code, "upkeep/aliasing");
    let speeds = Plan { differentiate: true, ..Plan::default() };
    assert!(speeds.recording(&mut recording).is_err());
}

#[test]
fn angles_that_wrap_are_unwound_and_quaternions_refused() {
    let mut table = Table {
        columns: vec!["pelvis_rotation".into(), "pelvis_tx".into()],
        times: (0..40).map(|i| f64::from(i) / 100.0).collect(),
        values: (0..40)
            .flat_map(|i| [(f64::from(i) * 10.0 + 170.0) % 360.0 - 180.0, 0.1])
            .collect(),
        angle_unit: AngleUnit::Degrees,
        ..Table::default()
    };
    table.values[2 * 7] = f64::NAN;
    let plan = Plan { fill: Some(0.1), ..Plan::default() };
    let done = plan.table(&mut table).expect("a plan");
    assert_eq!(done.steps[0], "took whole turns out of 1 column");
    // The same straight line as without wrapping, on which the gap is filled.
    for row in 0..40 {
        let expected = row as f64 * 10.0 - 10.0;
        assert!((table.values[2 * row] - expected).abs() < 1e-9, "{row}");
    }
    table.columns = vec!["hip_qw".into(), "hip_qx".into(), "hip_qy".into(), "hip_qz".into()];
    table.times.truncate(20);
    assert!(plan.table(&mut table).is_err_and(|e| e.to_string().contains("`hip_qw`")));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let refused = |step: Step, time: fn(usize) -> f64| step.apply(&mut series(time)).is_err();
    let even = |i: usize| i as f64 / 100.0;
    for hertz in [0.0, -1.0, 50.0, f64::NAN] {
        assert!(refused(Step::LowPass { hertz }, even));
    }
    assert!(refused(Step::LowPass { hertz: 6.0 }, |i| (i * i) as f64));
    assert!(refused(Step::Resample { hertz: 1e9 }, even));
    assert!(refused(Step::Resample { hertz: 10.0 }, |_| 1.0));
    assert!(refused(Step::Crop { from: 2.0, to: 3.0 }, even));
    assert!(refused(Step::Crop { from: 0.3, to: 0.2 }, even));
    assert!(refused(Step::Fill { seconds: 0.0 }, even));
    assert!(refused(Step::Differentiate, |_| 1.0));
    for axes in ["x,z,y", "x,x,y", "x,y", "x,y,w", "-x,y,z", ""] {
        assert!(axes.parse::<Axes>().is_err(), "{axes}");
    }
}
