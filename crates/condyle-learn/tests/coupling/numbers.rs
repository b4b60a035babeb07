//! Numbers of NumPy and SciPy: `oracles/coupling/regression.py`.

use condyle_learn::coupling::{Basis, Groups, Samples, Settings, learn, t_quantile};
use serde_json::Value;

fn oracle() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/coupling/regression.json");
    serde_json::from_str(&std::fs::read_to_string(path).expect("kept answers")).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[track_caller]
fn near(what: &str, found: f64, expected: f64, relative: f64) {
    let most = relative * expected.abs().max(1e-6);
    assert!((found - expected).abs() <= most, "{what}: found {found}, expected {expected}");
}

/// Both are computed in double precision: they agree to rounding times the condition of the terms (below 40).
#[test]
fn coefficients_intervals_and_errors_are_those_of_numpy() {
    for answer in oracle()["answers"].as_array().expect("answers") {
        let name = answer["name"].as_str().expect("a name");
        let columns = ["a", "b", "y"].map(str::to_owned).to_vec();
        let mut samples = Samples { columns, trials: vec![] };
        let (y, trials) = (numbers(&answer["y"]), numbers(&answer["trials"]));
        let rows: Vec<Vec<f64>> =
            answer["controls"].as_array().expect("rows").iter().map(numbers).collect();
        for trial in 0..=trials[trials.len() - 1] as usize {
            let own = (0..y.len()).filter(|i| trials[*i] == trial as f64);
            let values: Vec<f64> = own.flat_map(|i| [rows[i][0], rows[i][1], y[i]]).collect();
            samples.add(&format!("t_{trial}"), Groups::of_name("t"), &values, 0);
        }
        let basis = Basis::named(answer["basis"].as_str().expect("a basis")).expect("a basis");
        let settings = Settings { basis, ridge: 0.0 };
        let laws = learn(&samples, &[], &[0, 1], &[2], &settings).expect("laws");
        let law = &laws.laws[0];
        let expected = numbers(&answer["coefficients"]);
        near(name, law.intercept, expected[0], 1e-9);
        for (found, expected) in law.coefficients.iter().zip(&expected[1..]) {
            near(name, *found, *expected, 1e-9);
        }
        let intervals = answer["ci95"].as_array().expect("intervals");
        assert_eq!(intervals.len(), law.ci95.len());
        for (found, expected) in law.ci95.iter().zip(intervals) {
            let ends = numbers(expected);
            near(name, found[0], ends[0], 1e-8);
            near(name, found[1], ends[1], 1e-8);
        }
        for (found, expected) in law.freedom.iter().zip(numbers(&answer["freedom"])) {
            near(name, *found, expected, 1e-8);
        }
        for (found, expected) in law.partial_r2.iter().zip(numbers(&answer["partial_r2"])) {
            near(name, *found, expected, 1e-9);
        }
        let of = |key: &str| answer[key].as_f64().expect("a number");
        near(name, law.r2, of("r2"), 1e-10);
        near(name, law.rmse, of("rmse"), 1e-10);
        near(name, law.left_out.as_ref().expect("trials").rmse, of("left_out_rmse"), 1e-9);
        near(name, laws.condition, of("condition"), 1e-10);
        let settings = Settings { basis, ridge: 0.05 };
        let shrunk = learn(&samples, &[], &[0, 1], &[2], &settings).expect("laws");
        for (found, expected) in
            shrunk.laws[0].coefficients.iter().zip(numbers(&answer["ridge_0_05"]))
        {
            near(name, *found, expected, 1e-9);
        }
    }
}

#[test]
fn quantiles_are_those_of_scipy() {
    for row in oracle()["t"].as_array().expect("quantiles") {
        let row = numbers(row);
        near("t", t_quantile(row[0], row[1]), row[2], 1e-9);
    }
}
