//! Every layout of keypoints from its file to a motion of `human`.

use super::Folder;
use condyle::formats::keypoints::{SETS, canonical};
use condyle::math::Vec3;
use condyle::{Mode, Model, Pose, Program, shipped};
use serde_json::{Value, json};

/// Where the points of a set are on the model in its default posture; `None` for those that it does not have.
fn places(model: &Model, points: &[&str]) -> Vec<Option<Vec3>> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    program.evaluate(&model.defaults(), Mode::Open, &mut pose).expect("defaults");
    let place = |point: &&str| {
        let name = format!("keypoint.{}", canonical(point)?);
        let marker = model.markers().iter().find(|marker| marker.name == name)?;
        Some(pose.segment(marker.segment?) * marker.point)
    };
    points.iter().map(place).collect()
}

/// How sure a point is: ankles are seen badly.
fn confidence(point: &str) -> f64 {
    if canonical(point).is_some_and(|part| part.ends_with("ankle")) { 0.5 } else { 0.9 }
}

#[test]
fn every_set_in_every_layout_drives_the_human() {
    let folder = Folder::new("keypoints");
    let model = shipped::read("human").expect("it is shipped").value.model;
    for wanted in ["COCO-17", "BODY_25", "Halpe-26"] {
        let same = |name: &str| {
            let plain = |text: &str| text.to_lowercase().replace(['-', '_', ' '], "");
            plain(name) == plain(wanted)
        };
        let set = SETS.iter().find(|set| same(set.name)).unwrap_or_else(|| panic!("no {wanted}"));
        let places = places(&model, set.points);
        let known = places.iter().flatten().count();
        assert!(known >= 15, "{wanted}: {known} of {} are on the model", set.points.len());
        let frame: Vec<[f64; 4]> = places
            .iter()
            .zip(set.points)
            .map(|(place, point)| match place {
                Some(at) => [at.x, at.y, at.z, confidence(point)],
                None => [0.0; 4],
            })
            .collect();
        let one = json!({ "people": [{ "person_id": [-1], "pose_keypoints_3d": frame.concat() }] });
        folder.write("in.json", json!([one, one, one]).to_string());
        let axes = ["x", "y", "z", "score"];
        let head = set.points.iter().flat_map(|point| axes.map(|axis| format!("{point}_{axis}")));
        let mut table = format!("time,{}\n", head.collect::<Vec<_>>().join(","));
        for row in 0..3 {
            let cells: Vec<String> = frame.iter().flatten().map(f64::to_string).collect();
            table += &format!("{},{}\n", f64::from(row) / 30.0, cells.join(","));
        }
        folder.write("in.csv", table);
        for input in ["in.json", "in.csv"] {
            let info = folder.condyle(&["info", input, "--json"]).json();
            assert_eq!(info["kind"], "recording", "{wanted}, {input}");
            for (marker, point) in
                info["markers"].as_array().expect("a list").iter().zip(set.points)
            {
                assert_eq!(&marker["name"], point, "{wanted}, {input}");
                let mean = marker["mean_confidence"].as_f64().expect("a number");
                let seen = marker["missing_frames"] == 0;
                let expected = if seen { confidence(point) } else { 0.0 };
                assert!((mean - expected).abs() < 1e-12, "{wanted}, {input}, {point}: {mean}");
            }
            let text = folder.condyle(&["info", input]).expect(0);
            assert!(text.contains("mean confidence") && text.contains("0.50"), "{text}");
            let track = ["track", "human", input, "-o", "out.csv", "--report", "report.json"];
            folder.condyle(&track).expect(0);
            let report: Value =
                serde_json::from_str(&folder.read("report.json")).expect("a report");
            // The points are those of the model itself; a weak prior toward defaults pulls nowhere else.
            let rms = report["rms_m"].as_f64().expect("a number");
            assert_eq!(report["frames"], 3, "{wanted}, {input}");
            assert!(rms < 1e-3, "{wanted}, {input}: {rms} m");
        }
    }
}

#[test]
fn a_guessed_unit_is_no_finding_that_counts() {
    let folder = Folder::new("keypoints-guess");
    // A hip in the middle of its range, a leg of 84 units.
    let text = "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n\
        JOINT knee\n{\nOFFSET 0 -42 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 -42 0\n}\n}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0\n0 0 0 1\n";
    folder.write("leg.bvh", text);
    let check = folder.condyle(&["check", "leg.bvh", "--json"]);
    let told: Value = check.json();
    let codes: Vec<&str> = told["findings"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|finding| finding["severity"] != "note")
        .filter_map(|finding| finding["code"].as_str())
        .collect();
    assert_eq!(codes, ["skeleton/unit"], "{told}");
    folder.condyle(&["check", "leg.bvh"]).expect(0);
}
