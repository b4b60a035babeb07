//! `condyle learn limits`, `condyle limits query`, `condyle limits report` and `condyle limits engine`.

use super::{Folder, near, number};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Even numbers from 0 to 1: the fractional parts of multiples of powers of the plastic number's relative in three dimensions.
fn spread(index: usize) -> [f64; 3] {
    // The root of x⁴ = x + 1, whose powers are the most irrational together (Roberts 2018).
    const G: f64 = 1.220_744_084_605_759_5;
    [1, 2, 3].map(|power| (0.5 + index as f64 / G.powi(power)).fract())
}

/// x, y, z, w of the turn by an angle about an axis.
fn turn(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let [x, y, z] = axis.map(|c| c * (0.5 * angle).sin());
    [x, y, z, (0.5 * angle).cos()]
}

/// Rotations spread evenly over all turns by less than 60 degrees: the volume within an angle θ goes as θ - sin θ.
fn ball(count: usize) -> Vec<[f64; 4]> {
    let most = 60f64.to_radians();
    (0..count)
        .map(|index| {
            let [a, b, c] = spread(index);
            let wanted = a * (most - most.sin());
            let (mut low, mut high) = (0.0, most);
            for _ in 0..60 {
                let middle: f64 = 0.5 * (low + high);
                if middle - middle.sin() < wanted { low = middle } else { high = middle }
            }
            let (z, around) = (2.0 * b - 1.0, 2.0 * PI * c);
            let r = (1.0 - z * z).sqrt();
            turn([r * around.cos(), r * around.sin(), z], low)
        })
        .collect()
}

fn csv(rotations: &[[f64; 4]]) -> String {
    let mut text = "qx,qy,qz,qw\n".to_owned();
    for [x, y, z, w] in rotations {
        let _ = writeln!(text, "{x},{y},{z},{w}");
    }
    text
}

/// The angle between two rotations in degrees.
fn apart(a: [f64; 4], b: [f64; 4]) -> f64 {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    (2.0 * dot.abs().min(1.0).acos()).to_degrees()
}

/// Twelve directions, those of an icosahedron's corners.
fn directions() -> Vec<[f64; 3]> {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let length = (1.0 + golden * golden).sqrt();
    let (a, b) = (1.0 / length, golden / length);
    [[a, b], [a, -b], [-a, b], [-a, -b]]
        .into_iter()
        .flat_map(|[a, b]| [[0.0, a, b], [a, b, 0.0], [b, 0.0, a]])
        .collect()
}

#[test]
fn a_ball_of_rotations_is_learned_and_asked() {
    let folder = Folder::new("limits-ball");
    folder.write("cloud.csv", csv(&ball(5000)));
    let learn = ["learn", "limits", "cloud.csv", "-o", "L.toml", "--report", "R.json"];
    let run = folder.condyle(&learn);
    assert!(run.expect(0).contains("independent of each other"));
    let report: serde_json::Value = serde_json::from_str(&folder.read("R.json")).expect("JSON");
    assert_eq!(report["samples"], 5000);
    // (θ - sin θ)/π of all rotations turn by less than θ.
    let share = (PI / 3.0 - (PI / 3.0).sin()) / PI;
    near(number(&report["valid_share"]) / share, 1.0, 0.04);
    // Queries at 57 and 63 degrees in twelve directions, in another order of columns, with a comment.
    let mut text = "# asked=twice\nqw,qz,label,qy,qx\n".to_owned();
    for degrees in [57.0f64, 63.0] {
        for axis in directions() {
            let [x, y, z, w] = turn(axis, degrees.to_radians());
            // -q is the same rotation.
            let sign = if axis[0] > 0.0 { -1.0 } else { 1.0 };
            let _ = writeln!(text, "{},{},{degrees},{},{}", sign * w, sign * z, sign * y, sign * x);
        }
    }
    folder.write("asked.csv", text);
    let run = folder.condyle(&["limits", "query", "L.toml", "asked.csv", "-o", "out.csv"]);
    let said = run.expect(0);
    assert!(said.contains("24 rotations: 12 valid, 12 invalid, 0 unknown"), "{said}");
    let out = folder.read("out.csv");
    let mut lines = out.lines();
    let head = "qw,qz,label,qy,qx,state,distance_deg,nx,ny,nz,nw,evidence";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 24);
    for (index, row) in rows.iter().enumerate() {
        let cell = |i: usize| row[i].parse::<f64>().unwrap_or_else(|_| panic!("{row:?}"));
        let (state, expected) = if index < 12 { ("valid", 3.0) } else { ("invalid", -3.0) };
        assert_eq!(row[5], state, "{row:?}");
        near(cell(6), expected, 1.5);
        let nearest = [7, 8, 9, 10].map(cell);
        let truth = turn(directions()[index % 12], 57f64.to_radians());
        let boundary = turn(directions()[index % 12], 60f64.to_radians());
        let off = if index < 12 { apart(nearest, truth) } else { apart(nearest, boundary) };
        // Inside, the nearest is itself.
        assert!(off < if index < 12 { 1e-5 } else { 1.5 }, "{off}: {row:?}");
        // 5000 samples are 5.6 degrees apart on average.
        assert!((0.0..15.0).contains(&cell(11)));
    }
    // The same in JSON, and on standard output.
    let json = folder.condyle(&["limits", "query", "L.toml", "asked.csv", "--json"]).json();
    assert_eq!((&json["valid"], &json["invalid"]), (&12.into(), &12.into()));
    assert_eq!(json["rotations"][20]["state"], "invalid");
    near(number(&json["rotations"][20]["distance_deg"]), -3.0, 1.5);
    let run = folder.condyle(&["limits", "query", "L.toml", "asked.csv"]);
    assert_eq!(run.expect(0), out);
    // The report: the share, by 200 000 even rotations, and the same in three systems.
    let json = folder.condyle(&["limits", "report", "L.toml", "L.toml", "--json"]).json();
    near(number(&json["share"]) / share, 1.0, 0.04);
    for system in json["systems"].as_array().expect("systems") {
        near(number(&system["share"]) / number(&json["share"]), 1.0, 0.01);
    }
    near(number(&json["axes"][0]["forward_deg"]), 60.0, 3.0);
    near(number(&json["largest_angle_deg"]), 120.0, 4.0);
    // The bounds are of chance, narrow for so many even samples.
    let [low, high] = ["low", "high"].map(|end| number(&json["share_95"][end]));
    assert!(low < high && high - low < 0.05 * share, "{low} to {high}");
    near(number(&json["compared"]["in_common"]), 1.0, 1e-12);
    assert_eq!(number(&json["compared"]["largest_distance_deg"]), 0.0);
    let text = folder.condyle(&["limits", "report", "L.toml"]).expect(0);
    assert!(text.contains("% of all rotations (95 %"), "{text}");
}

/// A curve that fills turns about z and x by up to 50 and 30 degrees.
fn curve(take: usize, frames: usize) -> String {
    let mut text = "time,qx,qy,qz,qw\n".to_owned();
    for frame in 0..frames {
        let t = 0.02 * frame as f64 + 10.0 * take as f64;
        let (a, b) = (50.0 * (1.1 * t).sin(), 30.0 * (0.37 * t).cos());
        let [_, _, z, w] = turn([0.0, 0.0, 1.0], f64::to_radians(a));
        let [x, _, _, v] = turn([1.0, 0.0, 0.0], f64::to_radians(b));
        // The product of a turn about z and one about x.
        let _ = writeln!(text, "{},{},{},{},{}", 0.01 * frame as f64, w * x, z * x, z * v, w * v);
    }
    text
}

#[test]
fn takes_are_left_out_and_rows_that_are_no_rotations_told() {
    let folder = Folder::new("limits-takes");
    for take in 0..4 {
        let mut text = curve(take, 600);
        if take == 2 {
            text.push_str("6,0,0,0,0\n6.01,nan,0,0,1\n6.02,0,0,0,2\n");
        }
        folder.write(&format!("take{take}.csv"), text);
    }
    let files = ["take0.csv", "take1.csv", "take2.csv", "take3.csv"];
    let mut learn = vec!["learn", "limits"];
    learn.extend(files);
    learn.extend([
        "--joint",
        "hand",
        "--reference",
        "forearm",
        "-o",
        "L.toml",
        "--report",
        "R.json",
    ]);
    let run = folder.condyle(&learn);
    assert!(run.err.contains("take2.csv:602: 2 of 603 rotations are left out"), "{}", run.err);
    assert!(run.err.contains("1 of 603 quaternions are not of length 1"), "{}", run.err);
    let said = run.expect(0);
    assert!(
        said.contains("hand in forearm") && said.contains("4 takes left out in turn"),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("R.json")).expect("JSON");
    assert_eq!(report["takes"][2]["unusable"], 2);
    assert_eq!((&report["takes"][2]["used"], &report["frames"]), (&601.into(), &2403.into()));
    // Two degrees between samples along a curve.
    assert_eq!(report["thinned_deg"], 2.0);
    assert!(number(&report["samples"]) < 1600.0, "{report}");
    assert_eq!(report["left_out"]["whole_takes"], true);
    // Turns about two axes have no volume, so that all are outside what others show; half are in the layer.
    assert!(number(&report["left_out"]["inside_closing"]) < 0.2);
    assert!(number(&report["left_out"]["inside_with_offset"]) >= 0.5);
    assert!(number(&report["offset_deg"]) >= 2.0);
    // Asked about rows that are none, the others are answered.
    folder.write("asked.csv", "qx,qy,qz,qw\n0,0,0,1\n0,0,0,0\n0,1,0,0\n");
    let run = folder.condyle(&["limits", "query", "L.toml", "asked.csv", "-o", "-"]);
    assert!(run.err.contains("asked.csv:3: 1 of 3 rows are no rotations"), "{}", run.err);
    let out = run.expect(0);
    let rows: Vec<&str> = out.lines().skip(1).collect();
    assert!(rows[0].starts_with("0,0,0,1,valid,"), "{out}");
    assert_eq!(rows[1], "0,0,0,0,,,,,,,");
    // Half a turn about y is far from turns about z and x.
    assert!(rows[2].starts_with("0,1,0,0,invalid,-"), "{out}");
}

#[test]
fn spheres_of_the_paper_are_learned_written_and_asked() {
    let folder = Folder::new("limits-herda");
    folder.write("cloud.csv", csv(&ball(1500)));
    let learn = ["learn", "limits", "cloud.csv", "--method", "herda2003", "-o", "S.toml"];
    assert!(folder.condyle(&learn).expect(0).contains("spheres, E ="));
    let mut text = "qx,qy,qz,qw\n".to_owned();
    for degrees in [30f64, 90.0, 175.0] {
        let [x, y, z, w] = turn([0.0, 0.6, 0.8], degrees.to_radians());
        let _ = writeln!(text, "{x},{y},{z},{w}");
    }
    folder.write("asked.csv", text);
    let json = folder.condyle(&["limits", "query", "S.toml", "asked.csv", "--json"]).json();
    let states: Vec<&str> =
        [0, 1, 2].map(|i| json["rotations"][i]["state"].as_str().expect("a state")).to_vec();
    assert_eq!(states, ["valid", "invalid", "invalid"]);
    // Outward of 0.5 (60 degrees) + 2/k its field is zero and it finds nothing: sin(87.5°) = 0.999.
    assert!(json["rotations"][2]["nearest"].is_null(), "{json}");
    let said = folder.condyle(&["limits", "report", "S.toml"]).refused();
    assert!(said.contains("--method closing"), "{said}");
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let folder = Folder::with_leg("limits-refused");
    folder.write("empty.csv", "qx,qy,qz,qw\n0,0,0,0\n");
    let said = folder.condyle(&["learn", "limits", "empty.csv", "-o", "L.toml"]).refused();
    assert!(said.contains("there are no rotations"), "{said}");
    folder.write("few.csv", "qx,qy,qz\n0,0,0\n");
    let said = folder.condyle(&["learn", "limits", "few.csv", "-o", "L.toml"]).refused();
    assert!(said.contains("neither qx, qy, qz, qw nor sensors"), "{said}");
    folder.write("motion.mot", "walk\nversion=1\nnRows=2\nnColumns=2\ninDegrees=yes\nendheader\ntime\thip_flexion\n0\t10\n1\t20\n");
    let motion = [
        "learn",
        "limits",
        "motion.mot",
        "--model",
        "leg.osim",
        "--joint",
        "thigh",
        "-o",
        "L.toml",
    ];
    let learned = folder.condyle(&motion);
    assert!(learned.err.contains("2 rotations that differ say little"), "{}", learned.err);
    assert_eq!(learned.code, 0, "{}", learned.err);
    let wrong = [
        "learn",
        "limits",
        "motion.mot",
        "--model",
        "leg.osim",
        "--joint",
        "thihg",
        "-o",
        "L.toml",
    ];
    let said = folder.condyle(&wrong).refused();
    assert!(said.contains("did you mean `thigh`?"), "{said}");
    let recipe = ["learn", "limits", "motion.mot", "--recipe", "hpi", "-o", "L.toml"];
    assert!(folder.condyle(&recipe).refused().contains("shipped are: hip, "));
    let ending = ["learn", "limits", "motion.mot", "-o", "L.json"];
    assert!(folder.condyle(&ending).refused().contains("end it in .toml"));
    folder.condyle(&["limits", "query", "leg.osim", "few.csv"]).refused();
}

#[test]
fn markers_give_rotations_by_a_recipe() {
    let folder = Folder::new("limits-recipe");
    // A pelvis that leans and a thigh that is raised forward by up to 60 degrees and outward by up to 20.
    let labels = ["RASI", "LASI", "RPSI", "LPSI", "Ann:RGT", "rlfe", "RMFE"];
    let mut text = "PathFileType\t4\t(X/Y/Z)\tw.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n100\t100\t400\t7\tm\t100\t1\t400\nFrame#\tTime".to_owned();
    for label in labels {
        let _ = write!(text, "\t{label}\t\t");
    }
    text.push_str("\n\t");
    for i in 1..=7 {
        let _ = write!(text, "\tX{i}\tY{i}\tZ{i}");
    }
    text.push('\n');
    for frame in 0..400 {
        let t = 0.05 * f64::from(frame);
        let (lift, out) = (0.5 + 0.5 * (1.7 * t).sin(), 0.35 * (0.6 * t).cos());
        let (s, c, so, co) = (lift.sin(), lift.cos(), out.sin(), out.cos());
        // Rz(lift) · Rx(out), seen in a pelvis whose back and front spines are in its x-z plane.
        let thigh = |p: [f64; 3]| {
            let (y, z) = (co * p[1] - so * p[2], so * p[1] + co * p[2]);
            [c * p[0] - s * y, s * p[0] + c * y, z]
        };
        let points = [
            [0.1, 0.0, 0.12],
            [0.1, 0.0, -0.12],
            [-0.08, 0.0, 0.05],
            [-0.08, 0.0, -0.05],
            thigh([0.0, 0.0, 0.0]),
            thigh([0.0, -0.4, 0.05]),
            thigh([0.0, -0.4, -0.05]),
        ];
        let lean = 0.2 * t.sin();
        let _ = write!(text, "{}\t{}", frame + 1, 0.01 * f64::from(frame));
        for [x, y, z] in points {
            let (x, y) = (lean.cos() * x - lean.sin() * y, lean.sin() * x + lean.cos() * y);
            let _ = write!(text, "\t{x}\t{y}\t{z}");
        }
        text.push('\n');
    }
    folder.write("w.trc", text);
    let run = folder.condyle(&["learn", "limits", "w.trc", "--recipe", "hip", "-o", "L.toml"]);
    assert!(run.err.contains("under other names"), "{}", run.err);
    assert!(run.expect(0).contains("femur in pelvis"));
    // In the pelvis, whatever it leans: raised by 30 degrees as recorded, by 110 as not.
    let mut asked = "qx,qy,qz,qw\n".to_owned();
    for degrees in [30f64, 110.0] {
        let [x, y, z, w] = turn([0.0, 0.0, 1.0], degrees.to_radians());
        let _ = writeln!(asked, "{x},{y},{z},{w}");
    }
    folder.write("asked.csv", asked);
    let json = folder.condyle(&["limits", "query", "L.toml", "asked.csv", "--json"]).json();
    assert_eq!(json["rotations"][0]["state"], "valid");
    assert_eq!(json["rotations"][1]["state"], "invalid");
    // It was raised to 57.3 degrees.
    let far = number(&json["rotations"][1]["distance_deg"]);
    assert!(far < -35.0 && far > -53.0, "{far}");
}

/// Of a ball of 60 degrees MuJoCo's ball joint is right, and cones are not; the reach cone as a document loads, and what it
/// allows at the identity is what the query calls valid.
#[test]
fn a_limit_is_told_to_engines() {
    let folder = Folder::new("limits-engine");
    folder.write("cloud.csv", csv(&ball(3000)));
    folder.condyle(&["learn", "limits", "cloud.csv", "-o", "L.toml"]).expect(0);
    let json =
        folder.condyle(&["limits", "engine", "L.toml", "--json", "--directions", "8"]).json();
    let engines = json["engines"].as_array().expect("engines");
    let of = |law: &str| engines.iter().find(|e| e["law"] == law).expect("the law");
    let joint = &of("mujoco ball")["settings"]["joint"][0];
    assert_eq!(joint["type"], "ball");
    near(number(&joint["range"][1]).to_degrees(), 60.0, 1.5);
    let lost = |fitted: &serde_json::Value| {
        let part = |name: &str| number(&fitted["loss"][name]["of_field"]);
        part("false_accepts") + part("false_rejects")
    };
    assert!(lost(of("mujoco ball")) < 0.05, "{}", lost(of("mujoco ball")));
    // The best circular cone with a twist: of a ball of 60 degrees at least a tenth is judged wrongly.
    assert!(lost(of("jolt cone")) > 0.1 && lost(of("jolt pyramid")) > lost(of("jolt cone")));
    // (θ - sin θ)/π of all rotations turn by less than θ.
    near(number(&json["field_share"]) / ((PI / 3.0 - (PI / 3.0).sin()) / PI), 1.0, 0.05);
    assert_eq!(json["reach_cone"]["directions"].as_array().map(Vec::len), Some(8));
    // Files: the format follows from the ending; inside, nothing is accepted that is not valid.
    let run = ["limits", "engine", "L.toml", "--directions", "8", "--inside", "-o"];
    let with = |path| run.iter().copied().chain([path]).collect::<Vec<&str>>();
    let said = folder.condyle(&with("T.toml")).expect(0);
    assert!(said.contains("accepts 0.0 %") && !said.contains("accepts 1"), "{said}");
    let model = folder.condyle(&["info", "T.toml", "--json"]).json();
    assert_eq!(model["segments"].as_array().map(Vec::len), Some(2));
    let text = folder.condyle(&["check", "T.toml"]).expect(0);
    assert!(text.contains("no findings"), "{text}");
    let lines = folder.read("T.csv");
    let rows: Vec<&str> = lines.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows[0], "azimuth_deg,swing_deg,dx,dy,dz,twist_min_deg,twist_max_deg");
    assert_eq!(rows.len(), 9);
    // What cannot be.
    let refused = folder.condyle(&with("T.xml")).refused();
    assert!(refused.contains(".json, .csv or .toml"), "{refused}");
    let refused = folder.condyle(&["limits", "engine", "L.toml", "--directions", "5"]).refused();
    assert!(refused.contains("6"), "{refused}");
    let refused = folder.condyle(&["limits", "engine", "L.toml", "--bone", "0,0,0"]).refused();
    assert!(refused.contains("not all 0"), "{refused}");
}

/// The directions that a bone reaches as a scene: a colour for each corner, and the twists of the two colours in the node's name. Of
/// turns by up to 60 degrees the bone twists by ±60 at rest and not at all at the boundary.
#[test]
fn a_limit_is_drawn_as_a_surface() {
    let folder = Folder::new("limits-mesh");
    folder.write("cloud.csv", csv(&ball(1500)));
    folder.condyle(&["learn", "limits", "cloud.csv", "-o", "L.toml"]).expect(0);
    let said = folder.condyle(&["limits", "mesh", "L.toml", "-o", "M.glb"]).expect(0);
    let most = said.split("(yellow) to ").nth(1).and_then(|rest| rest.split('\u{b0}').next());
    near(most.and_then(|n| n.parse().ok()).expect("degrees"), 120.0, 5.0);
    let bytes = std::fs::read(folder.path().join("M.glb")).expect("a file");
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("COLOR_0") && text.contains("(green-blue)"));
    let run = ["limits", "mesh", "L.toml", "--space", "quaternion", "-o", "Q.glb"];
    let said = folder.condyle(&run).expect(0);
    assert!(said.contains("closed"), "{said}");
    let refused = folder.condyle(&["limits", "mesh", "L.toml", "-o", "M.obj"]).refused();
    assert!(refused.contains(".glb"), "{refused}");
}
