//! `condyle transfer`.

use super::{Folder, near, number};
use serde_json::Value;

const LAW: &str = r#"
condyle = 1
kind = "law"
control = ["flexion"]
[law.tx]
function = { slopes = [0.01], intercept = 0.0 }
[law.ty]
function = { slopes = [-0.02], intercept = -0.4 }
[law.tz]
function = { slopes = [0.0], intercept = 0.0 }
[joint]
origin = [0, 0, 0]
medial = [0, -0.4, -0.05]
lateral = [0, -0.4, 0.05]
"#;

/// A leg twice as large, whose knee is a quaternion.
const FIGURE: &str = r#"
condyle = 1
kind = "model"
[segment.thigh]
at = [0, 1, 0]
[segment.shank]
parent = "thigh"
at = [0, -0.8, 0]
[joint.knee]
segment = "shank"
type = "ball"
"#;

const LANDMARKS: &str = r#"
condyle = 1
kind = "landmarks"
[target]
joint = "shank"
origin = "thigh"
medial = { near = "shank", by = [0, 0, -0.1] }
lateral = [0, -0.8, 0.1]
"#;

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("law.toml", LAW).write("figure.toml", FIGURE).write("L.toml", LANDMARKS);
    folder
}

#[test]
fn a_law_is_scaled_and_drives_a_quaternion() {
    let folder = folder("transfer");
    let all =
        ["transfer", "law.toml", "--onto", "figure.toml", "--landmarks", "L.toml", "-o", "M.toml"];
    let more = ["--report", "R.json", "--expressions", "E.txt", "--blender", "D.py"];
    let run = folder.condyle(&[&all[..], &more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    for step in ["1. ", "2. ", "3. ", "4. ", "5. "] {
        assert!(run.err.contains(step), "{}", run.err);
    }
    let report: Value = serde_json::from_str(&folder.read("R.json")).unwrap();
    near(number(&report["s1"]), 2.0, 1e-12);
    near(number(&report["s2"]), 2.0, 1e-12);
    assert!(
        folder.read("E.txt").contains("ty = (-0.8) + (-0.04) * flexion"),
        "{}",
        folder.read("E.txt")
    );
    assert!(folder.read("D.py").contains("driver_namespace"));
    // 90 degrees about z, to the right: the knee goes 2·0.01·π/2 forward and 2·0.02·π/2 down.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    folder.write("P.json", format!("{{\"orientation\": [0, 0, {half}, {half}]}}"));
    let pose = folder.condyle(&["fk", "M.toml", "--pose", "P.json", "--json"]).json();
    let shank = &pose["frames"][0]["segments"]["shank"];
    near(number(&shank[3]), 0.01 * std::f64::consts::PI, 1e-12);
    near(number(&shank[7]), 1.0 - 0.8 - 0.02 * std::f64::consts::PI, 1e-12);
    near(number(&shank[0]), 0.0, 1e-12);
    // Equation 3 has the same factors here.
    let mean = folder.condyle(&[&all[..], &["--scale", "mean"]].concat());
    assert!(mean.err.contains("along x by 2.0000"), "{}", mean.err);
}

#[test]
fn what_does_not_fit_is_said() {
    let folder = folder("transfer-wrong");
    folder.write("wide.toml", LANDMARKS.replace("-0.1]", "-0.3]").replace("0.1]", "0.3]"));
    let all = |landmarks: &str, output: &str| {
        folder.condyle(&[
            "transfer",
            "law.toml",
            "--onto",
            "figure.toml",
            "--landmarks",
            landmarks,
            "-o",
            output,
        ])
    };
    let run = all("wide.toml", "M.toml");
    assert!(run.code == 0 && run.err.contains("not of the law's shape"), "{}", run.err);
    let said = all("L.toml", "M.osim").refused();
    assert!(said.contains("only an .osim comes back as one"), "{said}");
    let said = all("L.toml", "M.glb").refused();
    assert!(said.contains("`convert` bakes"), "{said}");
    folder.write("other.toml", LANDMARKS.replace("\"shank\"\n", "\"shnk\"\n"));
    let said = all("other.toml", "M.toml").refused();
    assert!(said.contains("did you mean `shank`?"), "{said}");
    folder.write("bare.toml", LAW.split("[joint]").next().unwrap());
    let bare =
        ["transfer", "bare.toml", "--onto", "figure.toml", "--landmarks", "L.toml", "-o", "M.toml"];
    let said = folder.condyle(&bare).refused();
    assert!(said.contains("neither the law nor the landmarks"), "{said}");
    // Without landmarks the model must have the law's coordinates.
    let said = folder
        .condyle(&["transfer", "law.toml", "--onto", "figure.toml", "-o", "M.toml"])
        .refused();
    assert!(said.contains("unknown coordinate"), "{said}");
}
