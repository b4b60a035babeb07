//! `condyle info`.

use super::{Folder, leg, near, number};
use serde_json::{Value, json};

fn names<'v>(list: &'v Value, key: &str) -> Vec<&'v str> {
    let items = list.as_array().expect("a list");
    items.iter().map(|item| item[key].as_str().expect("a name")).collect()
}

#[test]
fn a_model_for_programs() {
    let folder = Folder::with_leg("info-model");
    let run = folder.condyle(&["info", "leg.osim", "--json"]);
    assert_eq!(run.err, "");
    let info = run.json();
    assert_eq!(
        (&info["kind"], &info["name"], &info["up"]),
        (&json!("model"), &json!("leg"), &json!("y"))
    );
    let shank = json!({"name": "shank", "parent": "thigh", "joint_set": "knee"});
    assert_eq!(names(&info["segments"], "name"), ["thigh", "shank", "foot", "toes"]);
    assert_eq!(info["segments"][0]["parent"], Value::Null);
    assert_eq!(info["segments"][1], shank);
    let keys = ["hip_flexion", "knee_angle", "knee_slide", "ankle/flexion", "toe/flexion"];
    assert_eq!(names(&info["coordinates"], "key"), keys);
    let hip = json!({
        "key": "hip_flexion", "name": "hip_flexion", "joint_set": "hip", "kind": "rotation",
        "default": 0.0, "range": [-1.5, 2.0], "typical": null, "clamped": true, "circle": false, "locked": false,
        "drives": null,
        "follows": [],
    });
    assert_eq!(info["coordinates"][0], hip);
    assert_eq!(info["coordinates"][1]["clamped"], false);
    let slide = json!({
        "key": "knee_slide", "name": "knee_slide", "joint_set": "knee", "kind": "translation",
        "default": 0.0, "range": [null, null], "typical": null, "clamped": false, "circle": false,
        "locked": false, "drives": null, "follows": ["knee_angle"],
    });
    assert_eq!(info["coordinates"][2], slide);
    assert_eq!(info["coordinates"][3]["locked"], true);
    near(number(&info["coordinates"][3]["default"]), 0.1, 0.0);
    assert_eq!(info["closures"], json!([]));
    let shin = json!({"name": "SHIN", "segment": "shank", "point": [-0.04, -0.25, 0.0]});
    assert_eq!(info["markers"][4], shin);
    assert_eq!(info["markers"].as_array().map(Vec::len), Some(6));
}

#[test]
fn a_model_for_people() {
    let folder = Folder::with_leg("info-text");
    let text = folder.condyle(&["info", "leg.osim"]).expect(0);
    assert_eq!(
        text,
        "leg.osim: model `leg`, y up
4 segments, 4 joint sets, 5 coordinates (3 of them free), 0 loops, 6 markers

segments, each with the joint set that moves it
  thigh       hip
    shank     knee
      foot    ankle
        toes  toe

coordinates: default and range
  hip_flexion    rotation        0°   -85.94°  114.59°  clamped
  knee_angle     rotation        0°  -143.24°   11.46°
  knee_slide     translation   0 mm        -∞        ∞  follows knee_angle
  ankle/flexion  rotation     5.73°        -∞        ∞  locked
  toe/flexion    rotation        0°        -∞        ∞

markers
  thigh (3): HIP MID KNEE
  shank (3): TIBIA SHIN ANKLE
"
    );
}

#[test]
fn loops_are_listed() {
    let folder = Folder::new("info-loops");
    let constraint = "<ConstantDistanceConstraint name=\"rod\"><socket_body_1>/ground</socket_body_1>\
                      <socket_body_2>/bodyset/foot</socket_body_2>\
                      <constant_distance>0.3</constant_distance></ConstantDistanceConstraint>\
                      <PointConstraint name=\"pin\"><socket_body_1>/bodyset/shank</socket_body_1>\
                      <socket_body_2>/bodyset/toes</socket_body_2></PointConstraint>";
    let text = leg::osim().replacen(
        "<ConstraintSet><objects>",
        &format!("<ConstraintSet><objects>{constraint}"),
        1,
    );
    folder.write("loop.osim", text);
    let info = folder.condyle(&["info", "loop.osim", "--json"]).json();
    let rod = json!({
        "name": "rod", "kind": "distance", "rows": 1, "segments": [null, "foot"], "distance": 0.3,
    });
    assert_eq!(info["closures"][0], rod);
    let pin = json!({"name": "pin", "kind": "points", "rows": 3, "segments": ["shank", "toes"]});
    assert_eq!(info["closures"][1], pin);
    let text = folder.condyle(&["info", "loop.osim"]).expect(0);
    assert!(text.contains("rod  distance  the world to foot: 300 mm\n"), "{text}");
}

#[test]
fn postures_and_circles_are_listed() {
    let folder = Folder::new("info-postures");
    folder.write(
        "arm.toml",
        "condyle = 1\nkind = \"model\"\nangles = \"deg\"\n\
         [segment.arm]\n[segment.hand]\nparent = \"arm\"\n\
         [joint.shoulder]\ntype = \"hinge\"\nsegment = \"arm\"\naxis = [0, 0, 1]\n\
         coordinate.angle = { range = [-180, 180] }\n\
         [joint.wrist]\ntype = \"hinge\"\nsegment = \"hand\"\naxis = [0, 1, 0]\n\
         coordinate.angle = {}\n\
         [posture.bend]\nsum = { \"wrist.angle\" = 1 }\nrest = 10\nstiffness = 1e-5\n\
         source = \"a paper\"\n\
         [posture.both]\nsum = { \"shoulder.angle\" = -1, \"wrist.angle\" = 2.5 }\nrest = 0\nstiffness = 3e-5\n",
    );
    let text = folder.condyle(&["info", "arm.toml"]).expect(0);
    assert!(text.contains("-180°  180°  clamped, a circle\n"), "{text}");
    let listed = "\npostures, which tracking holds: sum of coordinates, rest, stiffness\n  \
                  bend  wrist/angle                        10°  1e-5\n  \
                  both  -shoulder/angle + 2.5 wrist/angle   0°  3e-5\n";
    assert!(text.contains(listed), "{text}");
    let info = folder.condyle(&["info", "arm.toml", "--json"]).json();
    let circles = info["coordinates"].as_array().expect("a list").iter().map(|c| &c["circle"]);
    assert_eq!(circles.collect::<Vec<_>>(), [&json!(true), &json!(false)]);
    let posture = &info["postures"][0];
    near(number(&posture["rest"]), 10f64.to_radians(), 1e-15);
    assert_eq!(
        (&posture["name"], &posture["sum"], &posture["stiffness"], &posture["source"]),
        (&json!("bend"), &json!({ "wrist/angle": 1.0 }), &json!(1e-5), &json!("a paper"))
    );
    assert_eq!(info["postures"][1]["sum"], json!({ "shoulder/angle": -1.0, "wrist/angle": 2.5 }));
}

#[test]
fn a_recording_and_its_gaps() {
    let folder = Folder::new("info-recording");
    // MID is missing in frames 3, 4 and 8, ANKLE in frame 0.
    let trc = leg::trc(11, |frame, marker| !matches!((marker, frame), (1, 3 | 4 | 8) | (5, 0)));
    folder.write("a.trc", trc);
    let info = folder.condyle(&["info", "a.trc", "--json"]).json();
    assert_eq!((&info["kind"], &info["unit"]), (&json!("recording"), &json!("mm")));
    assert_eq!((&info["frames"], &info["rate"]), (&json!(11), &json!(100.0)));
    near(number(&info["duration"]), 0.1, 1e-15);
    let names = names(&info["markers"], "name");
    assert_eq!(names, ["HIP", "MID", "KNEE", "TIBIA", "SHIN", "ANKLE"]);
    let missing = |i: usize| {
        let marker = &info["markers"][i];
        [&marker["missing_frames"], &marker["gaps"], &marker["longest_gap"]].map(number)
    };
    assert_eq!([missing(0), missing(1), missing(5)], [[0.0; 3], [3.0, 2.0, 2.0], [1.0; 3]]);
    let text = folder.condyle(&["info", "a.trc"]).expect(0);
    assert!(text.starts_with("a.trc: marker recording\n11 frames at 100 Hz, 0.100 s"), "{text}");
    assert!(text.contains("\n  MID    3  27.3 %  2  2\n  ANKLE  1   9.1 %  1  1\n"), "{text}");
}

#[test]
fn a_table_and_its_extremes() {
    let folder = Folder::new("info-table");
    folder.write(
        "t.mot",
        "x\ninDegrees=yes\nendheader\ntime\tknee\tempty\n0.5\t-5.5\t\n1.5\t12.25\t\n",
    );
    let info = folder.condyle(&["info", "t.mot", "--json"]).json();
    let expected = json!({
        "kind": "table", "name": "x", "rows": 2, "columns": ["knee", "empty"],
        "ranges": [[-5.5, 12.25], null], "angle_unit": "degrees", "time": [0.5, 1.5],
    });
    assert_eq!(info, expected);
    let text = folder.condyle(&["info", "t.mot"]).expect(0);
    assert!(text.contains("2 rows from 0.5 to 1.5 s, 2 columns, angles in degrees\n"), "{text}");
    assert!(
        text.contains("\n  knee   -5.500000  12.250000\n  empty          -          -\n"),
        "{text}"
    );
    folder.write("t.csv", "time,a\n0,1\n");
    let text = folder.condyle(&["info", "t.csv"]).expect(0);
    assert!(text.contains("unit of angles not stated"), "{text}");
}

#[test]
fn an_xml_file_says_what_it_is() {
    let folder = Folder::with_leg("info-xml");
    let tasks = "<IKTaskSet><objects><IKMarkerTask name=\"HIP\"><weight>2.5</weight></IKMarkerTask>\
                 <IKCoordinateTask name=\"knee_angle\"><weight>3</weight><value_type>manual_value\
                 </value_type><value>0.5</value></IKCoordinateTask></objects></IKTaskSet>";
    let tool = format!(
        "<OpenSimDocument><InverseKinematicsTool name=\"walk\"><model_file>leg.osim</model_file>\
         <time_range>0.5 1.5</time_range>{tasks}</InverseKinematicsTool></OpenSimDocument>"
    );
    folder.write("tool.xml", tool).write("tasks.xml", tasks).write("leg.xml", leg::osim());
    let tool = folder.condyle(&["info", "tool.xml", "--json"]).json();
    assert_eq!((&tool["kind"], &tool["name"]), (&json!("ik_setup"), &json!("walk")));
    assert_eq!(
        (&tool["model_file"], &tool["time_range"]),
        (&json!("leg.osim"), &json!([0.5, 1.5]))
    );
    let hip = json!({"name": "HIP", "apply": true, "weight": 2.5});
    let knee = json!({"name": "knee_angle", "apply": true, "weight": 3.0, "target": 0.5});
    assert_eq!((&tool["marker_tasks"][0], &tool["coordinate_tasks"][0]), (&hip, &knee));
    let tasks = folder.condyle(&["info", "tasks.xml", "--json"]).json();
    let expected = json!({"kind": "ik_tasks", "marker_tasks": [hip], "coordinate_tasks": [knee]});
    assert_eq!(tasks, expected);
    let text = folder.condyle(&["info", "tool.xml"]).expect(0);
    assert!(text.contains("  time   from 0.5 to 1.5 s\n"), "{text}");
    let model = folder.condyle(&["info", "leg.xml", "--json"]).json();
    assert_eq!(model, folder.condyle(&["info", "leg.osim", "--json"]).json());
    folder.write("other.xml", "\n <a/>");
    assert_eq!(
        folder.condyle(&["info", "other.xml"]).refused(),
        "error: other.xml:2:2: the file holds no <Model>, no <InverseKinematicsTool> and no \
         <IKTaskSet> (give a model, or a setup of OpenSim's inverse kinematics)\n"
    );
}

#[test]
fn files_that_cannot_be_read() {
    let folder = Folder::new("info-refused");
    let said = folder.condyle(&["info", "none.trc"]).refused();
    assert!(said.starts_with("error: none.trc: No such file"), "{said}");
    let said = folder.write("a.txt", "a").condyle(&["info", "a.txt"]).refused();
    assert!(said.starts_with("error: a.txt: the ending names no format"), "{said}");
    assert_eq!(folder.condyle(&["info"]).code, 2);
}
