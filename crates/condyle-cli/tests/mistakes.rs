//! Typical mistakes of a rig's author, one a file: each is found, with its line and what is likely meant.
//! The files are in the shared data; where that is absent these tests say so and end.

mod command;

use command::Folder;
use std::path::{Path, PathBuf};

/// The rigs beside the repository; `None` where they are absent.
fn rigs() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/rigs");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

/// A file, the exit code, where, and words of what is said.
type Case = (&'static str, i32, &'static str, &'static [&'static str]);

const CASES: &[Case] = &[
    ("01_misspelt_key", 2, ":7:1", &["parnt", "did you mean `parent`?"]),
    ("02_degrees_but_no_angles", 1, "line 14", &["looks like degrees", "angles = \"deg\""]),
    ("04_lengths_mm", 1, "line 6", &["lint/millimetres", "420 m"]),
    ("05_segment_cycle", 2, ":5:10", &["their own ancestors"]),
    ("06_component_cycle", 2, ":18:24", &["in a circle", "s.bound -> s.back"]),
    ("07_missing_port", 2, ":18:24", &["no `passive`"]),
    ("08_port_wrong_type", 2, ":24:9", &["`arm` is a transform, not a scalar"]),
    ("09_axis_zero", 2, ":13:8", &["`axis` has length 0", "[0, 0, 1]"]),
    ("11_axis_letter", 2, ":13:8", &["write [0, 0, 1]"]),
    ("12_intervals_overlap", 2, ":30:41", &["interval 2", "in rising order"]),
    ("13_interval_no_to_inner", 2, ":30:12", &["no `to`", "only the last"]),
    ("14_intervals_too_short", 1, "line 27", &["lint/beyond-intervals", "ends at 90°"]),
    ("15_cone_rest_outside", 1, "line 12", &["lint/cone-outside", "`rest` is on the far side"]),
    ("17_cone_hidden_edge", 2, ":20:5", &["visible from the rest direction"]),
    ("18_cone_one_twist_no_rest_twist", 2, ":17:5", &["none at rest", "`twist` beside `rest`"]),
    ("19_cone_axes_mismatch", 1, "line 26", &["lint/cone-axes", "90° apart"]),
    ("21_cone_output_4", 2, ":30:9", &["numbered from 1 to 3"]),
    ("22_compensate_not_ancestor", 2, ":32:24", &["not an ancestor"]),
    ("24_depend_in_deg", 1, "line 18", &["out = \"deg\""]),
    ("25_depend_degrees_silently", 1, "line 18", &["lint/degrees", "in = \"deg\"", "180 radians"]),
    ("28_contact_axis_mm", 1, "line 14", &["lint/millimetres", "were these millimetres?"]),
    ("29_contact_not_ancestor", 2, ":14:24", &["not an ancestor of `scap`"]),
    ("30_contact_no_in", 1, "line 14", &["lint/degrees", "in = \"deg\""]),
    ("31_contact_pair_missing_at", 2, ":25:5", &["no `at`"]),
    ("32_contact_before_not_output", 1, "line 14", &["lint/contact-before", "`upward`"]),
    ("34_mirror_suffix", 1, "line 4", &["the mirror does nothing", "from = \"_r\""]),
    ("35_mirror_unsuffixed_coordinate", 1, "line 9", &["same name on both sides", "flex_r"]),
    ("37_hand_mirror_wrong_sign", 1, "line 16", &["lint/not-mirrored", "`add_l`, `rot_l`"]),
    ("38_two_joints_one_segment", 2, ":18:11", &["moved by `knee` and by `k2`"]),
    ("39_output_unknown_segment", 2, ":37:1", &["did you mean `clav`?"]),
    ("40_unused_component", 1, "line 32", &["lint/unused-component", "`undo`"]),
    ("41_unused_coordinate", 1, "line 12", &["`extra` moves no segment"]),
    ("43_spline_domain", 1, "line 13", &["lint/beyond-knots", "ends at 90°"]),
    ("44_toml_missing_quote", 2, ":7:10", &["text stands in quotes: \"thigh\""]),
    ("46_euler_order_bad", 2, ":12:9", &["unknown rotation order `zzx`"]),
    ("47_universal_one_axis", 2, ":13:1", &["no `axes`", "give its `axes`"]),
    ("48_wrong_count_coordinates", 2, ":13:15", &["has 2 names", "3 coordinates"]),
    ("49_no_version", 2, ":1:1", &["no line `condyle = 1`"]),
    ("50_kind_typo", 2, ":2:8", &["did you mean `model`?"]),
    ("51_follows_cycle", 2, ":1", &["flex_r -> add_r -> flex_r"]),
    ("52_matrix_not_rotation", 2, ":9:10", &["a reflection", "determinant is -1"]),
    ("54_comma_decimal", 2, ":8:6", &["has 4 numbers", "decimals have a point"]),
    ("56_axis_nonunit_fine", 0, "", &["no findings"]),
    ("57_map_input_list", 2, ":40:9", &["`input` is a list", "combine"]),
    ("58_s1_names", 2, ":18:30", &["did you mean `depend`?"]),
    ("59_driver_called_on", 2, ":20:1", &["did you mean `driver`?"]),
    ("60_lower_bare_list", 2, ":21:9", &["{ lines = [...] }"]),
    ("61_centre_key", 2, ":30:1", &["unknown key `center`", "`centres`"]),
    ("62_rotate_with_centre", 2, ":26:1", &["of kind pivot"]),
    ("63_nan", 2, ":8:10", &["not a finite number"]),
    ("64_weight_2", 2, ":32:24", &["weight 2", "from 0"]),
    ("65_scale_below_compensate", 2, ":35:24", &["stretches or shears"]),
    ("66_forgot_output", 1, "line 11", &["lint/unused-component", "`bend`"]),
    ("67_world_axis_letter_case", 2, ":11:8", &["did you mean `hinge`?"]),
    ("68_twist_swapped", 2, ":16:9", &["exchange the two"]),
    ("70_cone_duplicate_first_last", 2, ":18:5", &["same direction"]),
    ("71_shoulder_axis", 2, ":9:6", &["did you mean `deg`?", "give one function as `function`"]),
    ("72", 0, "", &["no findings"]),
    ("dk", 1, "line 9", &["lint/bounds-cross", "lint/beyond-knots"]),
];

#[test]
fn every_mistake_is_found() {
    let Some(rigs) = rigs() else { return };
    let folder = Folder::new("mistakes");
    let mut wrong = vec![];
    for (name, code, place, words) in CASES {
        let path = rigs.join("mistakes").join(format!("{name}.toml"));
        let run = folder.condyle(&["check", path.to_str().expect("a path of text")]);
        let said = format!("{}{}", String::from_utf8_lossy(&run.out), run.err);
        if run.code != *code || !said.contains(place) || words.iter().any(|w| !said.contains(w)) {
            wrong.push(format!(
                "{name}: exit {}, expected {code}, {place}, {words:?}\n{said}",
                run.code
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // No file is without a case.
    let files = std::fs::read_dir(rigs.join("mistakes")).expect("a folder");
    for file in files {
        let path = file.expect("a file").path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        let is_model = path.extension().is_some_and(|ending| ending == "toml");
        assert!(!is_model || CASES.iter().any(|case| case.0 == stem), "{stem} has no case");
    }
}

#[test]
fn rigs_written_by_hand_are_sound_and_their_broken_poses_are_found() {
    let Some(rigs) = rigs() else { return };
    let folder = Folder::new("rigs");
    let path = |name: &str| rigs.join(name).to_str().expect("a path of text").to_owned();
    for name in ["cervical", "shoulder", "knee", "insect", "s4joints", "misc", "deform", "both"] {
        let run = folder.condyle(&["check", &path(&format!("{name}.toml")), "--json"]);
        let answer: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
        let findings = answer["findings"].as_array().expect("findings");
        assert!(findings.iter().all(|f| f["severity"] != "error"), "{name}: {findings:?}");
    }
    // A bone far outside its cone, with and without a map before the cone.
    let limits = |model: &str, poses: &str| {
        let run = folder.condyle(&["check", &path(model), &path(poses), "--json"]);
        assert_eq!(run.code, 1, "{model}: {}", run.err);
        let answer: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
        answer["motion"]["limits"].as_array().expect("limits").clone()
    };
    let (direct, mapped) = (limits("direct.toml", "d.json"), limits("mapped.toml", "d.json"));
    for list in [&direct, &mapped] {
        let cone = list.iter().find(|l| l["limit"] == "legal").expect("the cone is broken");
        assert_eq!(cone["frame"], 0);
        // The direction: 2 rad of abduction from -y; the cone's corner there is at 45 degrees.
        let by = cone["by"].as_f64().expect("a number");
        assert!((by - (2.0 - 45f64.to_radians())).abs() < 0.02, "{by}");
        assert!(list.iter().any(|l| l["limit"] == "bound"), "the bound is broken, too");
    }
    assert_eq!(direct[0]["by"], mapped[0]["by"]);
    // Under limits both are written with the same coordinates.
    let written = |model: &str, out: &str| {
        let (model, poses) = (path(model), path("d.json"));
        let run = folder.condyle(&["convert", &poses, out, "--model", &model, "--limits", "on"]);
        assert_eq!(run.code, 0, "{}", run.err);
        let text = std::fs::read_to_string(folder.path().join(out)).expect("a file");
        let numbers =
            text.lines().last().expect("a row").split('\t').map(|cell| cell.trim().to_owned());
        numbers.map(|cell| cell.parse::<f64>().expect("a number")).collect::<Vec<_>>()
    };
    let (a, b) = (written("direct.toml", "direct.mot"), written("mapped.toml", "mapped.mot"));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    // How far the scapula is from the ribs: the closest points of the ellipsoid by Lagrange's multiplier,
    // computed in another program from the posed points.
    let gaps = limits("shoulder.toml", "gap.json");
    let contact =
        gaps.iter().find(|l| l["kind"] == "contact").expect("the scapula leaves the ribs");
    let found =
        contact["gaps"].as_array().expect("two").iter().filter_map(serde_json::Value::as_f64);
    for (found, expected) in found.zip([0.010115, 0.015938]) {
        assert!((found - expected).abs() < 2e-6, "{found}, expected {expected}");
    }
    // There something reads what is asked beside the cone: the file cannot give that pose, and says so.
    let (model, poses) = (path("shoulder.toml"), path("gap.json"));
    let run = folder.condyle(&["convert", &poses, "held.csv", "--model", &model, "--limits", "on"]);
    assert!(run.code == 0 && run.err.contains("1 of 1 frames are not given"), "{}", run.err);
}

/// A thigh in a cone, a shank whose twist its flexion bounds, a foot within an ellipse, a hand that a sum
/// bounds, and a blade that touches a sphere of 100 mm.
const RIG: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
[segment.pelvis]
[segment.thigh]
parent = "pelvis"
[joint_set.hip.coordinate]
flexion = {}
adduction = {}
[joint_set.hip.component]
asked.map = { input = "flexion", function = { linear = [1, 0] } }
legal.cone = { angles = ["asked", "adduction"], axes = [[0, 0, 1], [1, 0, 0]], rest = [0, -1, 0], subdivisions = 0, points = [{ direction = [1, -1, 0] }, { direction = [0, -1, 1] }, { direction = [-1, -1, 0] }, { direction = [0, -1, -1] }] }
flex.rotate = { angle = "legal", axis = [0, 0, 1] }
adduct.rotate = { angle = "legal.2", axis = [1, 0, 0] }
[joint_set.hip.output]
thigh = ["flex", "adduct"]
[segment.shank]
parent = "thigh"
at = [0, -0.4, 0]
[joint_set.knee.coordinate]
bend = { range = [0, 140] }
turn = {}
[joint_set.knee.component]
held.depend = { passive = "turn", driver = "bend", in = "deg", out = "deg", lower = { lines = [[0, 0], [140, -14]] }, upper = { lines = [[0, 0], [140, 28]] } }
about.rotate = { angle = "bend", axis = [0, 0, -1] }
twist.rotate = { angle = "held", axis = [0, 1, 0] }
[joint_set.knee.output]
shank = ["about", "twist"]
[segment.foot]
parent = "shank"
at = [0, -0.4, 0]
[joint_set.ankle.coordinate]
point = {}
tilt = {}
[joint_set.ankle.component]
round.ellipse = { first = "point", second = "tilt", half_axes = [40, 20], in = "deg" }
a.rotate = { angle = "round", axis = [0, 0, 1] }
b.rotate = { angle = "round.2", axis = [1, 0, 0] }
[joint_set.ankle.output]
foot = ["a", "b"]
[segment.blade]
parent = "pelvis"
at = [0, 0.1, 0]
[joint_set.girdle.coordinate]
away = { kind = "translation" }
[joint_set.girdle.component]
slide.translate = { distance = "away", axis = [0, 1, 0] }
touch.contact = { segment = "blade", surface = "pelvis", at = [0, 0.1, 0.15], radii = [0.1, 0.1, 0.1], axis = [1, 0, 0], before = "slide", pairs = [{ first = [0, 0.05, 0], second = [0.05, 0, 0] }], most_gap = 0.08 }
[joint_set.girdle.output]
blade = ["slide", "touch"]
"#;

#[test]
fn a_motion_is_held_against_every_limit() {
    let folder = Folder::new("limits-of-a-motion");
    folder.write("rig.toml", RIG);
    let degrees = |x: f64| x.to_radians();
    // Frame 0 holds; frame 1 breaks the cone by 70 - 45 degrees, and the bound: at 70 degrees of bend the
    // twist may reach 14; frame 2 the ellipse: (0, 30) is 10 beyond its half axis of 20.
    let poses = serde_json::json!([
        { "flexion": degrees(40.0) },
        { "flexion": degrees(70.0), "bend": degrees(70.0), "turn": degrees(20.0) },
        { "tilt": degrees(30.0) },
        { "away": 0.4 },
    ]);
    folder.write("poses.json", poses.to_string());
    let run = folder.condyle(&["check", "rig.toml", "poses.json", "--json"]);
    assert_eq!(run.code, 1, "{}", run.err);
    let answer: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
    let limits = answer["motion"]["limits"].as_array().expect("limits");
    let of = |name: &str| {
        limits.iter().find(|l| l["limit"] == name).unwrap_or_else(|| panic!("{name}: {limits:?}"))
    };
    let near = |found: &serde_json::Value, expected: f64, room: f64| {
        let found = found.as_f64().expect("a number");
        assert!((found - expected).abs() < room, "{found}, expected {expected}");
    };
    near(&of("legal")["by"], degrees(25.0), 1e-9);
    near(&of("legal")["nearest"][0]["nearest"], degrees(45.0), 1e-6);
    assert_eq!(of("legal")["nearest"][0]["name"], "asked");
    near(&of("held")["by"], degrees(6.0), 1e-9);
    near(&of("held")["nearest"][0]["nearest"], degrees(14.0), 1e-9);
    near(&of("round")["by"], degrees(10.0), 1e-6);
    near(&of("round")["nearest"][1]["nearest"], degrees(20.0), 1e-6);
    for (name, frame) in [("legal", 1), ("held", 1), ("round", 2), ("touch", 3)] {
        assert_eq!(of(name)["frame"], frame, "{name}");
        assert_eq!(of(name)["frames"], 1, "{name}");
    }
    // 0.4 m up along the slide: the blade is at (0, 0.5, 0), 0.427 m from the middle of the sphere, its
    // points at 0.05 m from it come no nearer than 0.427 - 0.05 - 0.1 m.
    let gap = (0.4f64.hypot(0.15)) - 0.15;
    near(&of("touch")["gaps"][0], gap, 1e-6);
    near(
        &of("touch")["by"],
        of("touch")["gaps"]
            .as_array()
            .expect("two")
            .iter()
            .filter_map(serde_json::Value::as_f64)
            .fold(0.0, |a: f64, b| a.max(b.abs()))
            - 0.08,
        1e-9,
    );
    // Written within limits, the poses hold, also behind the map, and stay as they are.
    let within = |from: &str, to: &str| {
        let run = folder.condyle(&["convert", from, to, "--model", "rig.toml", "--limits", "on"]);
        assert_eq!(run.code, 0, "{}", run.err);
        std::fs::read_to_string(folder.path().join(to)).expect("a file")
    };
    folder
        .write("three.json", serde_json::json!(poses.as_array().expect("poses")[..3]).to_string());
    let once = within("three.json", "once.csv");
    let twice = within("once.csv", "twice.csv");
    let numbers = |text: &str| -> Vec<f64> {
        let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
        rows.flat_map(|row| row.split(',').map(|cell| cell.parse().expect("a number"))).collect()
    };
    for (a, b) in numbers(&once).iter().zip(numbers(&twice)) {
        assert!((a - b).abs() < 1e-9, "{a} {b}\n{once}\n{twice}");
    }
    let run = folder.condyle(&["check", "rig.toml", "once.csv", "--json"]);
    let answer: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
    let left = answer["motion"]["limits"].as_array().expect("limits");
    assert!(left.iter().all(|l| l["kind"] == "contact"), "{left:?}");
}
