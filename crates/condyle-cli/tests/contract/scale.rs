//! `condyle scale`.

use super::{Folder, leg, near, number};
use serde_json::Value;

/// The leg of [`leg`] made larger: thigh and shank times 1.1 and 0.95, the hip where it is.
const FACTORS: [f64; 2] = [1.1, 0.95];

/// The leg as a document with two size groups, and a standing person with longer bones.
fn folder(name: &str) -> Folder {
    let folder = Folder::with_leg(name);
    folder.condyle(&["convert", "leg.osim", "leg.toml"]).expect(0);
    let groups = "\n[size.thigh]\nsegments = [\"thigh\"]\n[size.shank]\nsegments = [\"shank\"]\n";
    let text = folder.read("leg.toml") + groups;
    folder.write("leg.toml", text).write("static.trc", standing(5));
    folder
}

/// Where a marker of the larger leg is in the world, in metres, with hip and knee at 0.1 and -0.2.
fn place(index: usize) -> [f64; 2] {
    let (_, segment, [x, y]) = leg::MARKERS[index];
    let [thigh, shank] = FACTORS;
    let (h, k): (f64, f64) = (0.1, -0.2);
    let turned = |angle: f64, [x, y]: [f64; 2]| {
        let (s, c) = angle.sin_cos();
        [c * x - s * y, s * x + c * y]
    };
    let in_thigh = match segment {
        "thigh" => [thigh * x, thigh * y],
        _ => {
            let [x, y] = turned(k, [shank * x, shank * y]);
            // The slide of 0.02·k and the knee at 0.4 m are lengths of the thigh.
            [thigh * 0.02 * k + x, -thigh * 0.4 + y]
        }
    };
    let [x, y] = turned(h, in_thigh);
    [x, 1.0 + y]
}

fn standing(frames: usize) -> String {
    let names: Vec<&str> = leg::MARKERS.iter().map(|m| m.0).collect();
    let count = names.len();
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\tstatic.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n\
         100\t100\t{frames}\t{count}\tm\nFrame#\tTime\t{}\n\t\tX1\tY1\tZ1\n\n",
        names.join("\t\t\t")
    );
    for frame in 0..frames {
        text += &format!("{}\t{}", frame + 1, frame as f64 / 100.0);
        for index in 0..count {
            let [x, y] = place(index);
            text += &format!("\t{x}\t{y}\t0");
        }
        text.push('\n');
    }
    text
}

#[test]
fn a_static_trial_of_c3d_scales_as_its_trc_does() {
    let folder = folder("scale-c3d");
    // Floats of 32 bits are in the C3D; the TRC made of it holds the same.
    folder.condyle(&["convert", "static.trc", "static.c3d"]).expect(0);
    folder.condyle(&["convert", "static.c3d", "again.trc"]).expect(0);
    let [one, two] = ["static.c3d", "again.trc"].map(|trial| {
        let run = ["scale", "leg.toml", "--static", trial, "-o", "anna.toml", "--json"];
        let report = folder.condyle(&run).json();
        (report["groups"].clone(), report["body"].clone(), folder.read("anna.toml"))
    });
    assert_eq!(one, two);
    // Between nothing and the truth, 1.1 and 0.95, by what bones are thought to differ.
    let thigh = number(&one.0[0]["factor"]) / number(&one.0[1]["factor"]);
    assert!(thigh > 1.1 && thigh < FACTORS[0] / FACTORS[1], "{thigh}");
}

#[test]
fn a_subject_stands_where_the_person_stood() {
    let folder = folder("scale-subject");
    let arguments = ["scale", "leg.toml", "--static", "static.trc", "-o", "anna.toml", "--json"];
    let report = folder.condyle(&arguments).json();
    let groups = report["groups"].as_array().expect("groups");
    assert_eq!(groups.len(), 2);
    // With exact markers the truth costs what the prior asks for it: both logarithms lie as far from
    // their mean, in units of 8 %. The minimum costs no more, and in a quadratic of inverse curvature
    // C no coordinate lies farther than the root of cost·C from it; 5 % more for what is not quadratic.
    let prior = 2.0 * ((FACTORS[0] / FACTORS[1]).ln() / 2.0 / 0.08).powi(2);
    for ((group, name), factor) in groups.iter().zip(["thigh", "shank"]).zip(FACTORS) {
        assert_eq!(group["name"], name);
        let (found, spread) = (number(&group["factor"]), number(&group["spread"]));
        near(found.ln(), factor.ln(), 1.05 * prior.sqrt() * spread);
        let length = number(&group["length_m"]);
        near(number(&group["change_m"]), length * (number(&group["factor"]) - 1.0), 1e-12);
    }
    // The knee is 0.4 m below the hip; the ankle 0.4 m below the knee.
    near(number(&groups[0]["length_m"]), 0.4, 1e-12);
    near(number(&groups[1]["length_m"]), 0.4, 1e-12);
    let [thigh, shank, body] =
        [&groups[0], &groups[1], &report["body"]].map(|f| number(&f["factor"]));
    assert!(shank < body && body < thigh && thigh / shank < FACTORS[0] / FACTORS[1]);
    let (before, after) = (number(&report["rms_before_m"]), number(&report["rms_after_m"]));
    assert!(after < before && after < 0.015 * (prior / 6.0).sqrt(), "{before} {after}");
    assert_eq!((&report["markers_used"], &report["status"]), (&6.into(), &"solved".into()));
    assert!(folder.read("anna.toml").contains("\nname = \"anna\"\n"));
    assert!(folder.read("anna.toml").contains("[size.shank]\nsegments = [\"shank\"]"));

    folder
        .condyle(&["track", "anna.toml", "static.trc", "-o", "w.csv", "--report", "r.json"])
        .expect(0);
    let tracked: Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert!(number(&tracked["rms_m"]) < 1e-4, "{tracked}");
    let info = folder.condyle(&["info", "anna.toml", "--json"]).json();
    assert_eq!(info["name"], "anna");

    let again = folder.read("anna.toml");
    folder.condyle(&arguments).expect(0);
    assert_eq!(folder.read("anna.toml"), again);
}

#[test]
fn the_table_names_groups_and_markers() {
    let folder = folder("scale-table");
    let run = ["scale", "leg.toml", "--static", "static.trc", "-o", "anna.toml", "--keep-markers"];
    let text = folder.condyle(&run).expect(0);
    assert!(text.contains("\n  thigh  1.0") || text.contains("\n  thigh  1.1"), "{text}");
    assert!(text.contains("mm of 400.0\n") && text.contains("6 markers: "), "{text}");
    assert!(text.contains("farthest off:\n"), "{text}");
    let printed = folder.condyle(&["scale", "leg.toml", "--static", "static.trc", "-o", "-"]);
    assert!(printed.expect(0).starts_with("condyle = 1\nkind = \"model\"\nname = \"leg\"\n"));
}

/// A model with the marker sets of many laboratories has hundreds that one trial does not use.
#[test]
fn of_many_unused_markers_a_few_are_named() {
    let folder = folder("scale-unused");
    let spare = |i| format!("[marker.spare_{i}]\nsegment = \"thigh\"\nat = [0.0, {i}e-3, 0.0]\n");
    let more: String = (0..40).map(spare).collect();
    folder.write("leg.toml", folder.read("leg.toml") + &more);
    let run = ["scale", "leg.toml", "--static", "static.trc", "-o", "anna.toml"];
    let text = folder.condyle(&run).expect(0);
    assert!(text.contains("  40 markers of the model not used: `spare_0`, `spare_1`, "), "{text}");
    assert!(text.contains(" and 34 more\n") && !text.contains("spare_39"), "{text}");
    let json = folder.condyle(&[&run[..], &["--json"]].concat()).json();
    assert_eq!(json["markers_unused"].as_array().map(Vec::len), Some(40), "{json}");
}

#[test]
fn a_model_without_groups_grows_as_a_whole() {
    let folder = folder("scale-whole");
    let run = folder.condyle(&[
        "scale",
        "leg.osim",
        "--static",
        "static.trc",
        "-o",
        "anna.toml",
        "--json",
    ]);
    assert!(run.err.contains("the model names no size groups"), "{}", run.err);
    let report = run.json();
    assert_eq!(report["groups"], Value::Array(vec![]));
    let body = number(&report["body"]["factor"]);
    assert!(body > FACTORS[1] && body < FACTORS[0], "{body}");
}

#[test]
fn what_cannot_be_used_is_refused() {
    let folder = folder("scale-refused");
    let scale = |trial: &str, more: &[&str]| {
        let arguments = ["scale", "leg.toml", "--static", trial];
        folder.condyle(&[&arguments[..], more].concat()).refused()
    };
    let subject = ["-o", "anna.toml"];
    let said = scale("static.trc", &["--setup", "scale.xml", "-o", "anna.osim"]);
    assert!(said.contains("end it in .toml"), "{said}");
    assert!(scale("static.trc", &["-o", "anna.osim"]).contains("end it in .toml"));
    assert!(scale("static.trc", &["-o", "-", "--json"]).contains("standard output"));
    assert!(scale("gone.trc", &subject).contains("gone.trc"));
    assert!(scale("leg.toml", &subject).contains("leg.toml"));
    let mut strangers = standing(2);
    for (index, (name, ..)) in leg::MARKERS.iter().enumerate() {
        strangers = strangers.replace(name, &format!("X{index}"));
    }
    folder.write("strangers.trc", strangers);
    assert!(scale("strangers.trc", &subject).contains("share no marker that is seen"));
    let mut few = standing(2);
    for name in ["HIP", "MID", "KNEE", "SHIN"] {
        few = few.replace(name, &name.to_lowercase().replace('i', "y").replace('k', "c"));
    }
    folder.write("few.trc", few);
    let said = scale("few.trc", &subject);
    assert!(said.contains("3 markers are the fewest, and 2 can be used (TIBIA, ANKLE)"), "{said}");
    assert!(!folder.path().join("anna.toml").exists());
}

/// A setup that measures the bones of the leg, and places its markers.
const SETUP: &str = r#"<OpenSimDocument Version="40000"><ScaleTool name="anna"><mass>20</mass>
<ModelScaler><scaling_order>measurements</scaling_order><MeasurementSet><objects>
<Measurement name="thigh"><MarkerPairSet><objects><MarkerPair><markers>HIP KNEE</markers></MarkerPair>
<MarkerPair><markers>HIP MID</markers></MarkerPair></objects></MarkerPairSet>
<BodyScaleSet><objects><BodyScale name="thigh"><axes>X Y</axes></BodyScale></objects></BodyScaleSet></Measurement>
<Measurement name="shank"><MarkerPairSet><objects><MarkerPair><markers>TIBIA ANKLE</markers></MarkerPair></objects></MarkerPairSet>
<BodyScaleSet><objects><BodyScale name="shank"><axes>X Y Z</axes></BodyScale></objects></BodyScaleSet></Measurement>
</objects></MeasurementSet><marker_file>static.trc</marker_file></ModelScaler>
<MarkerPlacer><marker_file>static.trc</marker_file></MarkerPlacer></ScaleTool></OpenSimDocument>"#;

#[test]
fn an_osim_comes_back_as_itself() {
    let folder = folder("scale-osim");
    folder.write("scale.xml", SETUP);
    let run = ["scale", "leg.osim", "--setup", "scale.xml", "-o", "anna.osim", "--report", "r.md"];
    let report = folder.condyle(&[&run[..], &["--json"]].concat()).json();
    // Both markers of a pair move with their bone: a ratio of distances is its factor.
    let [thigh, shank] = FACTORS;
    for (body, factors) in [("thigh", [thigh, thigh, 1.0]), ("shank", [shank; 3])] {
        for (axis, factor) in factors.into_iter().enumerate() {
            near(number(&report["bodies"][body]["factors"][axis]), factor, 1e-9);
        }
    }
    assert_eq!(report["measurements"][0]["pairs"][0]["markers"][1], "KNEE");
    // The person is the scaled leg, so it fits, and nothing is left to be moved.
    near(number(&report["placed"]["rms_m"]), 0.0, 1e-6);
    let text = folder.read("anna.osim");
    assert_eq!(text.lines().count(), folder.read("leg.osim").lines().count());
    let knee = text.split("name=\"knee_place\"").nth(1).expect("the knee's frame");
    let [_, y, _] = three(knee.split("<translation>").nth(1).expect("a translation"));
    near(y, -0.4 * thigh, 1e-9);
    assert!(folder.read("r.md").contains("| shank | 0.9500 | 0.9500 | 0.9500 |"));
    folder
        .condyle(&["track", "anna.osim", "static.trc", "-o", "w.csv", "--report", "r.json"])
        .expect(0);
    let tracked: Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert!(number(&tracked["rms_m"]) < 1e-5, "{tracked}");
}

fn three(text: &str) -> [f64; 3] {
    let words = text.split('<').next().expect("numbers").split_whitespace();
    let numbers: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

/// The same leg as a document, by the same setup: it tracks the person as the scaled file does.
#[test]
fn a_document_is_scaled_by_a_setup() {
    let folder = folder("scale-document-setup");
    folder.write("scale.xml", SETUP);
    let run = ["scale", "leg.toml", "--setup", "scale.xml", "-o", "anna.toml", "--json"];
    let report = folder.condyle(&run).json();
    let [thigh, shank] = FACTORS;
    for (body, factors) in [("thigh", [thigh, thigh, 1.0]), ("shank", [shank; 3])] {
        for (axis, factor) in factors.into_iter().enumerate() {
            near(number(&report["bodies"][body]["factors"][axis]), factor, 1e-9);
        }
    }
    near(number(&report["placed"]["rms_m"]), 0.0, 1e-6);
    folder
        .condyle(&["track", "anna.toml", "static.trc", "-o", "w.csv", "--report", "r.json"])
        .expect(0);
    let tracked: Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert!(number(&tracked["rms_m"]) < 1e-5, "{tracked}");
}

#[test]
fn what_a_setup_cannot_do_is_said() {
    let folder = folder("scale-setup-wrong");
    folder.write("scale.xml", SETUP);
    let says = |arguments: &[&str], message: &str| {
        let run = folder.condyle(&[&["scale"], arguments].concat());
        let error = run.refused();
        assert!(error.contains(message), "{error}");
    };
    let setup = ["--setup", "scale.xml"];
    let with = |more: &[&'static str]| [more, &setup[..]].concat();
    says(&with(&["leg.osim", "-o", "anna.toml"]), "end it in .osim");
    says(&with(&["leg.toml", "-o", "anna.osim"]), "end it in .toml");
    says(&with(&["leg.toml", "--mass", "70", "-o", "anna.toml"]), "have no masses");
    says(&["leg.osim", "-o", "anna.osim"], "--static");
    says(&["leg.osim", "--setup", "leg.osim", "-o", "a.osim"], "there is no <ScaleTool>");
    says(&["leg.osim", "--static", "static.trc", "--mass", "70", "-o", "a.toml"], "--setup");
    says(&with(&["leg.osim", "--mass", "0", "-o", "anna.osim"]), "mass");
    folder.write("none.xml", SETUP.replace("static.trc", ""));
    says(&["leg.osim", "--setup", "none.xml", "-o", "anna.osim"], "<marker_file>");
    folder.write("names.xml", SETUP.replace("HIP MID", "HIP MIDDLE"));
    let run = folder.condyle(&["scale", "leg.osim", "--setup", "names.xml", "-o", "anna.osim"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let error = run.err;
    assert!(error.contains("measurement `thigh` is not used: `MIDDLE` is no marker"), "{error}");
}
