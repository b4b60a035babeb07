//! Models and setups as people have them, through the command.
//!
//! All vary one arm of two pins and its exact recording, sh = 0.3 sin(0.3 i) and el = 0.5 + 0.04 i in
//! frame i, so that what is read rightly leaves a residual of 0 mm.

mod command;

use command::{Answer, Folder};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What should come of a file.
enum Outcome {
    /// The truth, with this many markers, in these frames.
    Truth { markers: u64, frames: std::ops::Range<usize> },
    /// The elbow follows the shoulder, whatever the recording.
    Coupled,
    /// This exit code, with these words on a stream.
    Says(i32, &'static [&'static str]),
}

const TRUTH: Outcome = Outcome::Truth { markers: 4, frames: 0..11 };
/// One marker is not used.
const THREE: Outcome = Outcome::Truth { markers: 3, frames: 0..11 };

/// Every model and setup of the cases, with what should come of it.
const CASES: &[(&str, Outcome)] = &[
    ("00-base/arm.osim", TRUTH),
    ("01-components/coupler_in_components.osim", Outcome::Coupled),
    ("01-components/joint_in_components.osim", TRUTH),
    ("01-components/marker_in_components.osim", TRUTH),
    ("02-sdf-markers/arm.osim", TRUTH),
    ("02-sdf-markers/station.osim", TRUTH),
    ("04-ampersand/arm.osim", TRUTH),
    ("04-ampersand/plain.osim", TRUTH),
    ("05-iktool/arm.osim", TRUTH),
    ("05-iktool/setup.xml", TRUTH),
    ("06-time-range/arm.osim", TRUTH),
    ("06-time-range/default.xml", TRUTH),
    ("06-time-range/inner.xml", Outcome::Truth { markers: 4, frames: 2..8 }),
    ("06-time-range/off.xml", Outcome::Truth { markers: 4, frames: 2..8 }),
    ("06-time-range/reversed.xml", Outcome::Says(2, &["`0.07 0.02` is reversed", "`0.02 0.07`"])),
    ("06-time-range/unassigned.xml", TRUTH),
    ("14-tasks/absent.xml", THREE),
    ("14-tasks/apply_false.xml", THREE),
    ("14-tasks/extra.xml", THREE),
    // Without a setup the marker that is 22 cm off counts like the others.
    ("14-tasks/arm.osim", Outcome::Says(0, &["D  "])),
    ("17-scale-factors/arm_v1.osim", TRUTH),
    ("18-ground-markers/arm.osim", Outcome::Says(1, &["nothing can move", "lie on the ground"])),
    ("26-encodings/TrueFalse.osim", TRUTH),
    ("26-encodings/arm.osim", TRUTH),
    ("26-encodings/bom.osim", TRUTH),
    ("26-encodings/commas.osim", TRUTH),
    ("26-encodings/comment_dashes.osim", TRUTH),
    ("26-encodings/cp1252_declared_utf8.osim", TRUTH),
    (
        "26-encodings/deccomma.osim",
        Outcome::Says(2, &["`-0,1`", "the decimal separator is a point"]),
    ),
    ("26-encodings/latin1.osim", TRUTH),
    ("26-encodings/leadingspace.osim", TRUTH),
    ("26-encodings/parens.osim", TRUTH),
    ("26-encodings/trailing_junk.osim", TRUTH),
    ("26-encodings/utf16.osim", TRUTH),
    ("28-undetermined/arm.osim", Outcome::Says(0, &["held at rest: el_flex"])),
];

fn cases() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/reading");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the shared cases are absent");
    None
}

#[test]
fn every_model_and_setup_of_the_cases_comes_out_right() {
    let Some(cases) = cases() else { return };
    let folder = Folder::new("reading-cases");
    let mut seen = 0;
    for (name, outcome) in CASES {
        let path = cases.join(name);
        if !path.exists() {
            println!("skipped: {name} is absent");
            continue;
        }
        seen += 1;
        let beside = |file: &str| {
            let own = path.with_file_name(file);
            let own = if own.exists() { own } else { cases.join("00-base").join(file) };
            own.to_str().expect("a path is text").to_owned()
        };
        let path = path.to_str().expect("a path is text");
        let (trial, arm) = (beside("trial.trc"), beside("arm.osim"));
        let arguments: &[&str] = match path.ends_with(".xml") {
            true => &["track", &arm, &trial, "--setup", path],
            false => &["track", path, &trial],
        };
        judge(&folder, name, arguments, outcome);
    }
    assert!(seen > 0, "none of the cases is there");
}

/// Runs a tracking and compares what it wrote with what should come of it.
fn judge(folder: &Folder, name: &str, arguments: &[&str], outcome: &Outcome) {
    let arguments = [arguments, &["-o", "out.csv", "--report", "out.json"]].concat();
    let answer = folder.condyle(&arguments);
    let text = said(&answer);
    match outcome {
        Outcome::Says(code, words) => {
            assert_eq!(answer.code, *code, "{name}: {text}");
            for word in *words {
                assert!(text.contains(word), "{name}: `{word}` is missing in {text}");
            }
        }
        Outcome::Truth { markers, frames } => {
            assert_eq!(answer.code, 0, "{name}: {text}");
            let report = report(folder);
            let rms = report["rms_m"].as_f64().expect("an RMS");
            assert!(rms < 1e-7, "{name}: {} mm", rms * 1e3);
            assert_eq!(report["markers_used"].as_u64(), Some(*markers), "{name}");
            let found = angles(folder);
            assert_eq!(found.len(), frames.len(), "{name}");
            for (&[sh, el], i) in found.iter().zip(frames.clone()) {
                let i = i as f64;
                let off = [sh - 0.3 * (0.3 * i).sin(), el - (0.5 + 0.04 * i)];
                assert!(off.iter().all(|x| x.abs() < 1e-5), "{name}: {off:?} in frame {i}");
            }
        }
        Outcome::Coupled => {
            assert_eq!(answer.code, 0, "{name}: {text}");
            for [sh, el] in angles(folder) {
                assert!((el - 2.0 * sh).abs() < 1e-9, "{name}: {sh} {el}");
            }
        }
    }
}

fn said(answer: &Answer) -> String {
    format!("{}{}", String::from_utf8_lossy(&answer.out), answer.err)
}

fn report(folder: &Folder) -> Value {
    let text = std::fs::read_to_string(folder.path().join("out.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

/// sh and el of every frame, in radians.
fn angles(folder: &Folder) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(folder.path().join("out.csv")).expect("a motion");
    let mut lines = text.lines().map(|line| line.split(',').map(str::trim).collect::<Vec<_>>());
    let names = lines.next().expect("a header");
    let column = |name: &str| names.iter().position(|n| *n == name).expect("a coordinate");
    let [sh, el] = [column("sh_flex"), column("el_flex")];
    lines.map(|cells| [sh, el].map(|i| cells[i].parse().expect("an angle"))).collect()
}

/// The arm, written by this test, in pieces that can be varied.
fn arm(credits: &str, joint: &str, markers: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><Model name="arm"><credits>{credits}</credits><BodySet><objects>
<Body name="upper"/><Body name="lower"/></objects></BodySet><JointSet><objects><PinJoint name="sh">
<socket_parent_frame>p</socket_parent_frame><socket_child_frame>/bodyset/upper</socket_child_frame>
<coordinates><Coordinate name="sh_flex"/></coordinates><frames><PhysicalOffsetFrame name="p">
<socket_parent>/ground</socket_parent><translation>0 1.4 0</translation></PhysicalOffsetFrame>
</frames></PinJoint>{joint}</objects></JointSet>{markers}</Model></OpenSimDocument>"#
    )
}

const ELBOW: &str = r#"<PinJoint name="el"><socket_parent_frame>p</socket_parent_frame>
<socket_child_frame>/bodyset/lower</socket_child_frame><coordinates><Coordinate name="el_flex"/>
</coordinates><frames><PhysicalOffsetFrame name="p"><socket_parent>/bodyset/upper</socket_parent>
<translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames></PinJoint>"#;

/// The markers: name, body, place.
const MARKERS: [(&str, &str, [f64; 3]); 4] = [
    ("A", "upper", [0.0, -0.1, 0.03]),
    ("B", "upper", [0.03, -0.3, 0.0]),
    ("C", "lower", [0.0, -0.1, 0.03]),
    ("D", "lower", [0.03, -0.25, 0.0]),
];

fn marker_set() -> String {
    let marker = |(name, body, [x, y, z]): &(&str, &str, [f64; 3])| {
        format!(
            "<Marker name='{name}'><socket_parent_frame>/bodyset/{body}</socket_parent_frame>\
             <location>{x} {y} {z}</location></Marker>"
        )
    };
    let list: String = MARKERS.iter().map(marker).collect();
    format!("<MarkerSet><objects>{list}</objects></MarkerSet>")
}

/// The exact recording of the arm, in millimetres.
fn recording() -> String {
    let mut text = "PathFileType\t4\t(X/Y/Z)\tt.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\t\
        OrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n100\t100\t11\t4\tmm\t100\t1\t11\n\
        Frame#\tTime\tA\t\t\tB\t\t\tC\t\t\tD\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\tX4\tY4\tZ4\n\n"
        .to_owned();
    for i in 0..11 {
        let (sh, el) = (0.3 * (0.3 * f64::from(i)).sin(), 0.5 + 0.04 * f64::from(i));
        text.push_str(&format!("{}\t{}", i + 1, f64::from(i) / 100.0));
        for (_, body, [x, y, z]) in MARKERS {
            let turned =
                |a: f64, x: f64, y: f64| (a.cos() * x - a.sin() * y, a.sin() * x + a.cos() * y);
            let (x, y) = match body {
                "upper" => turned(sh, x, y),
                _ => {
                    let (x, y) = turned(el, x, y);
                    turned(sh, x, y - 0.3)
                }
            };
            for value in [x, 1.4 + y, z] {
                text.push_str(&format!("\t{:.12}", value * 1e3));
            }
        }
        text.push('\n');
    }
    text
}

#[test]
fn xml_as_people_type_it_is_read() {
    let folder = Folder::new("reading-xml");
    folder.write("t.trc", recording());
    let plain = arm("", ELBOW, &marker_set());
    let spoilt: &[(&str, String)] = &[
        ("ampersand", arm("R&D, a < b, &nbsp; &#1;", ELBOW, &marker_set())),
        ("control", arm("x\u{1}\u{b}y", ELBOW, &marker_set())),
        ("commas", plain.replace("0 1.4 0", "0, 1.4, 0").replace("0 -0.3 0", "~[0,-0.3,0]")),
        ("end", format!("{plain}\n<x a='1'/> junk & more")),
        ("padded", format!("{plain}\n\0\0\0\x1a")),
        ("comment", plain.replace("<BodySet>", "<!-- a -- b ---><BodySet>")),
        ("nested", plain.replace("<BodySet>", "<F::P name='x'/><BodySet>")),
    ];
    for (name, text) in spoilt {
        assert_ne!(text, &plain, "{name}");
        folder.write("a.osim", text);
        judge(&folder, name, &["track", "a.osim", "t.trc"], &TRUTH);
    }
    let utf16: Vec<u8> = plain.encode_utf16().flat_map(u16::to_le_bytes).collect();
    folder.write("a.osim", utf16);
    judge(&folder, "utf-16", &["track", "a.osim", "t.trc"], &TRUTH);
}

#[test]
fn setups_that_opensim_runs_are_run() {
    let folder = Folder::new("reading-setups");
    folder.write("t.trc", recording()).write("a.osim", arm("", ELBOW, &marker_set()));
    let tool = |inside: &str| {
        format!(
            "<OpenSimDocument><InverseKinematicsTool>{inside}</InverseKinematicsTool></OpenSimDocument>"
        )
    };
    let time = |range: &str| tool(&format!("<time_range>{range}</time_range>"));
    let old = "<IKTool><IKTrialSet><objects><IKTrial><time_range>0.02 0.07</time_range></IKTrial>\
               </objects></IKTrialSet></IKTool>";
    let within = Outcome::Truth { markers: 4, frames: 2..8 };
    let one = Outcome::Truth { markers: 4, frames: 5..6 };
    for (setup, outcome) in [
        (tool(""), &TRUTH),
        (tool("<IKTaskSet/>"), &TRUTH),
        (tool("<IKTaskSet><objects/></IKTaskSet>"), &TRUTH),
        (time(""), &TRUTH),
        (time("Unassigned"), &TRUTH),
        (time("-1 -1"), &TRUTH),
        (time("-1.#INF 1.#INF"), &TRUTH),
        (time("0.02, 0.07"), &within),
        (time("0.05 0.05"), &one),
        (old.to_owned(), &within),
        (time("0 9"), &Outcome::Says(0, &["reach beyond the recording", "0.1 s"])),
        (time("5 9"), &Outcome::Says(2, &["no frame lies between 5 and 9 s", "from 0 to 0.1 s"])),
        (time("0.052 0.058"), &Outcome::Says(2, &["the nearest frames are at 0.05 and 0.06 s"])),
        (time("0.07 0.02"), &Outcome::Says(2, &["reversed"])),
        (time("0.07"), &Outcome::Says(2, &["holds 1 numbers"])),
        (time("soon later"), &Outcome::Says(2, &["`soon` in <time_range> is not a number"])),
    ] {
        folder.write("s.xml", &setup);
        judge(&folder, &setup, &["track", "a.osim", "t.trc", "--setup", "s.xml"], outcome);
    }
    // The tasks alone, in a set without any.
    folder.write("s.xml", "<OpenSimDocument><IKTaskSet><objects/></IKTaskSet></OpenSimDocument>");
    judge(&folder, "tasks", &["track", "a.osim", "t.trc", "--setup", "s.xml"], &TRUTH);
}

#[test]
fn a_marker_set_is_found_beside_its_model() {
    let folder = Folder::new("reading-files");
    let model = arm("", ELBOW, "<MarkerSet file='sets/m.xml'/>");
    folder.write("t.trc", recording()).write("models/a.osim", model);
    folder.write("models/sets/m.xml", marker_set());
    judge(&folder, "beside", &["track", "models/a.osim", "t.trc"], &TRUTH);
    folder.write("models/sets/m.xml", "<MarkerSet/>");
    let says = Outcome::Says(2, &["the model has no markers"]);
    judge(&folder, "empty", &["track", "models/a.osim", "t.trc"], &says);
}
