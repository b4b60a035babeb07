//! `condyle diff`.

use super::{Folder, leg, near, number};
use serde_json::{Value, json};

fn coordinate<'v>(diff: &'v Value, name: &str) -> &'v Value {
    let list = diff["coordinates"].as_array().expect("a list");
    list.iter().find(|c| c["name"] == name).unwrap_or_else(|| panic!("{name} in {diff}"))
}

fn csv(rows: usize, step: f64, hip: impl Fn(f64) -> f64) -> String {
    let line = |row: usize| format!("{},{}\n", row as f64 * step, hip(row as f64 * step));
    "time,hip_flexion\n".to_owned() + &(0..rows).map(line).collect::<String>()
}

#[test]
fn one_motion_in_two_units_is_one_motion() {
    let folder = Folder::with_leg("diff-units");
    folder.write("a.mot", leg::mot(9));
    folder.condyle(&["convert", "a.mot", "b.csv", "--model", "leg.osim"]).expect(0);
    let run = folder.condyle(&["diff", "a.mot", "b.csv", "--model", "leg.osim", "--json"]);
    assert!(
        run.err.contains("b.csv: the unit of angles is not stated: taken as radians"),
        "{}",
        run.err
    );
    let diff = run.json();
    assert_eq!((&diff["frames"], &diff["time"]), (&json!(9), &json!([0.0, 0.08])));
    for name in ["hip_flexion", "knee_angle"] {
        assert_eq!(coordinate(&diff, name)["unit"], "deg");
        near(number(&coordinate(&diff, name)["largest"]), 0.0, 1e-13);
    }
    assert_eq!(diff["only_in_a"], json!([]));
    assert_eq!(diff["only_in_b"], json!(["knee_slide", "ankle/flexion", "toe/flexion"]));
    // Without the model nobody knows which columns are angles.
    let run = folder.condyle(&["diff", "a.mot", "b.csv", "--json"]);
    assert!(run.err.contains("a.mot has degrees, b.csv has radians"), "{}", run.err);
    let largest = number(&coordinate(&run.json(), "knee_angle")["largest"]);
    near(
        largest,
        (0..9)
            .map(|f| leg::knee(f as f64 / 100.0))
            .map(|k| (k.to_degrees() - k).abs())
            .fold(0.0, f64::max),
        1e-12,
    );
}

#[test]
fn mean_rms_and_largest_by_formula() {
    let folder = Folder::with_leg("diff-numbers");
    // Differences of 0.1, 0.1, 0.4 rad.
    folder.write("a.csv", "time,hip_flexion,knee_slide\n0,0,0\n1,0,0\n2,0,0\n");
    folder.write("b.csv", "time,hip_flexion,knee_slide\n0,0.1,0\n1,-0.1,0.002\n2,0.3,0\n");
    let arguments = ["diff", "a.csv", "b.csv", "--model", "leg.osim"];
    let diff = folder.condyle(&[&arguments[..], &["--json"]].concat()).json();
    let hip = coordinate(&diff, "hip_flexion");
    near(number(&hip["mean"]), 0.1f64.to_degrees(), 1e-13);
    near(number(&hip["rms"]), (0.11f64 / 3.0).sqrt().to_degrees(), 1e-13);
    near(number(&hip["largest"]), 0.3f64.to_degrees(), 1e-13);
    near(number(&hip["largest_time"]), 2.0, 0.0);
    let slide = coordinate(&diff, "knee_slide");
    assert_eq!((&slide["unit"], &slide["largest_time"]), (&json!("m"), &json!(1.0)));
    near(number(&slide["largest"]), 0.002, 0.0);
    let text = folder.condyle(&arguments).expect(0);
    assert!(text.starts_with("b.csv minus a.csv: 3 frames from 0 to 2 s\n"), "{text}");
    let row = text.lines().nth(2).expect("a row").split_whitespace().collect::<Vec<_>>();
    assert_eq!(row, ["hip_flexion", "deg", "5.729578", "10.971306", "17.188734", "2", "s"]);
}

#[test]
fn times_are_matched_by_straight_lines_inside_the_overlap() {
    let folder = Folder::new("diff-times");
    let line = |t: f64| 0.5 + 2.0 * t;
    // A at 100 Hz over 1 s; B at 30 Hz until 0.5 s, and off by 0.25 there.
    folder
        .write("a.csv", csv(101, 0.01, line))
        .write("b.csv", csv(16, 1.0 / 30.0, |t| line(t) + 0.25));
    let diff = folder.condyle(&["diff", "a.csv", "b.csv", "--json"]).json();
    assert_eq!((&diff["frames"], &diff["time"]), (&json!(51), &json!([0.0, 0.5])));
    near(number(&coordinate(&diff, "hip_flexion")["mean"]), 0.25, 1e-12);
    near(number(&coordinate(&diff, "hip_flexion")["largest"]), 0.25, 1e-12);
}

#[test]
fn columns_by_path_and_cells_without_numbers() {
    let folder = Folder::with_leg("diff-columns");
    folder.write(
        "a.sto",
        "a\ninDegrees=no\nendheader\ntime\t/jointset/ankle/flexion/value\t/jointset/toe/flexion/value\n\
         0\t0.1\t0.2\n1\tnan\t0.2\n",
    );
    folder.write("b.csv", "time,ankle/flexion,toe/flexion,extra\n0,0.1,0.3,1\n1,5,0.3,1\n");
    let diff = folder.condyle(&["diff", "a.sto", "b.csv", "--model", "leg.osim", "--json"]).json();
    let ankle = coordinate(&diff, "ankle/flexion");
    assert_eq!((&ankle["frames"], &ankle["largest"]), (&json!(1), &json!(0.0)));
    near(number(&coordinate(&diff, "toe/flexion")["mean"]), 0.1f64.to_degrees(), 1e-13);
    assert_eq!(diff["only_in_b"], json!(["extra"]));
}

#[test]
fn motions_that_cannot_be_compared() {
    let folder = Folder::new("diff-refused");
    folder
        .write("a.csv", "time,a\n0,1\n1,1\n")
        .write("b.csv", "time,b\n0,1\n")
        .write("c.csv", "time,a\n5,1\n");
    let said = folder.condyle(&["diff", "a.csv", "b.csv"]).refused();
    assert!(
        said.contains("have no coordinate in common: the first has a, …; the second b"),
        "{said}"
    );
    let said = folder.condyle(&["diff", "a.csv", "c.csv"]).refused();
    assert!(
        said.contains("do not overlap in time: a.csv has 0 to 1 s, c.csv has 5 to 5 s"),
        "{said}"
    );
    assert!(folder.condyle(&["diff", "a.csv", "none.csv"]).refused().contains("No such file"));
}
