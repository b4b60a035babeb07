//! Skeletons with their motion: a file that is both a model and a motion.

use super::Folder;
use serde_json::Value;

/// A hip that turns about z by 90° in its second frame, with a shank 40 units below.
const LEG: &str = "HIERARCHY\nROOT hip\n{\nOFFSET 0 90 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation \
    Xrotation Yrotation\nJOINT shank\n{\nOFFSET 0 -40 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n\
    OFFSET 0 -50 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 90 0 0 0 0 0 0 0\n0 90 0 90 0 0 0 0 0\n";

fn translation(frame: &Value, segment: &str) -> [f64; 3] {
    let rows = &frame["segments"][segment];
    [3, 7, 11].map(|place| rows[place].as_f64().expect("a number"))
}

#[test]
fn its_own_motion_is_posed_and_the_unit_is_told_or_guessed_aloud() {
    let folder = Folder::new("skeleton-fk");
    folder.write("leg.bvh", LEG);
    let guessed = folder.condyle(&["fk", "leg.bvh"]);
    assert!(guessed.err.contains("--length-unit"), "{}", guessed.err);
    let told = folder.condyle(&["fk", "leg.bvh", "--length-unit", "cm"]);
    assert_eq!(told.err, "");
    let frames = told.json();
    assert_eq!(frames["frames"].as_array().map(Vec::len), Some(2));
    assert_eq!(frames["frames"][1]["time"], 0.5);
    // Turned by 90° about z, the shank that hung down points along +x.
    let shank = translation(&frames["frames"][1], "shank");
    for (found, expected) in shank.iter().zip([0.4, 0.9, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{shank:?}");
    }
    let millimetres = folder.condyle(&["fk", "leg.bvh", "--length-unit", "mm"]).json();
    assert!((translation(&millimetres["frames"][0], "shank")[1] - 0.05).abs() < 1e-12);
}

#[test]
fn it_becomes_a_model_a_motion_a_recording_and_a_skeleton_again() {
    let folder = Folder::new("skeleton-convert");
    folder.write("leg.bvh", LEG);
    for output in ["leg.toml", "leg.json", "leg.osim", "leg.mot", "leg.csv", "leg.trc", "leg.glb"] {
        folder.condyle(&["convert", "leg.bvh", output, "--length-unit", "cm"]).expect(0);
    }
    // The model and the motion alone make the same skeleton.
    let whole = ["convert", "leg.bvh", "whole.bvh", "--length-unit", "cm"];
    folder.condyle(&whole).expect(0);
    let parts = ["convert", "leg.mot", "parts.bvh", "--model", "leg.toml", "--length-unit", "cm"];
    folder.condyle(&parts).expect(0);
    assert_eq!(folder.read("whole.bvh"), folder.read("parts.bvh"));
    assert!(
        folder
            .read("whole.bvh")
            .ends_with("Frames: 2\nFrame Time: 0.5\n0 90 0 0 0 0 0 0 0\n0 90 0 90 0 0 0 0 0\n")
    );
    // A turn by 90° in one frame is a finding.
    let check = folder.condyle(&["check", "leg.bvh", "--length-unit", "cm", "--json"]).expect(1);
    let check: Value = serde_json::from_str(&check).expect("JSON");
    assert_eq!(check["motion"]["frames"], 2);
    assert_eq!(check["motion"]["jumps"][0]["coordinate"], "hip/rz");
    let info = folder.condyle(&["info", "leg.bvh", "--json"]).json();
    assert_eq!(info["kind"], "animation");
    assert_eq!(info["motion"]["rows"], 2);
}

#[test]
fn a_take_needs_its_skeleton() {
    let folder = Folder::new("skeleton-take");
    let skeleton = ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n:bonedata\n begin\n \
        name femur\n direction 0 -1 0\n length 7\n axis 0 0 0 XYZ\n dof rx\n end\n:hierarchy\n begin\n \
        root femur\n end\n";
    folder.write("anna.asf", skeleton);
    let take = ":DEGREES\n1\nroot 0 0 0 0 0 0\nfemur 90\n";
    folder.write("takes/b_1.amc", take).write("c_1.amc", take);
    let alone = folder.condyle(&["info", "takes/b_1.amc"]);
    assert_eq!(alone.code, 2);
    assert!(alone.err.contains("--skeleton"), "{}", alone.err);
    let beside = folder.condyle(&["fk", "c_1.amc", "--frame-rate", "60"]);
    assert!(beside.err.contains("anna.asf"), "{}", beside.err);
    let told = ["convert", "takes/b_1.amc", "-", "--to", "csv", "--frame-rate", "60"];
    for skeleton in ["--skeleton", "--model"] {
        let run = folder.condyle(&[&told[..], &[skeleton, "anna.asf"]].concat());
        assert_eq!(run.err, "");
        assert!(run.expect(0).contains("femur/rx"));
    }
}

#[test]
fn a_take_is_written_as_a_take() {
    let folder = Folder::new("skeleton-take-written");
    let skeleton = ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n:bonedata\n begin\n \
        name femur\n direction 0 -1 0\n length 7\n axis 0 0 0 XYZ\n dof rx\n end\n:hierarchy\n begin\n \
        root femur\n end\n";
    let take = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 17.5 0 0 0 0\nfemur 90\n2\nroot 0 17.25 0 0 10 0\nfemur 45\n";
    folder.write("anna.asf", skeleton).write("anna_1.amc", take);
    // Through itself, and through a table.
    folder.condyle(&["convert", "anna_1.amc", "again.amc"]).expect(0);
    assert_eq!(folder.read("again.amc"), take);
    folder.condyle(&["convert", "anna_1.amc", "a.csv"]).expect(0);
    folder.condyle(&["convert", "a.csv", "third.amc", "--model", "anna.asf"]).expect(0);
    assert_eq!(folder.read("third.amc"), take);
    folder.write("leg.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n");
    let none = folder.condyle(&["convert", "leg.bvh", "leg.amc"]);
    assert_eq!(none.code, 2);
    assert!(none.err.contains("--onto"), "{}", none.err);
}

#[test]
fn a_model_goes_to_bvh_looking_along_z_and_a_skeleton_as_it_is() {
    let folder = Folder::new("skeleton-facing");
    // A model looks along +x unless it says otherwise: its nose is 10 cm ahead.
    let model = "condyle = 1\nkind = \"model\"\nname = \"nose\"\n[segment]\nhead = { at = [0, 1.6, 0] }\n\
                 nose = { parent = \"head\", at = [0.1, 0, 0] }\n";
    folder.write("nose.toml", model);
    let nose = |file: &str| {
        let found = folder.condyle(&["fk", file, "--length-unit", "cm", "--up-axis", "y"]).json();
        translation(&found["frames"][0], "nose")
    };
    folder.condyle(&["convert", "nose.toml", "nose.bvh", "--length-unit", "cm"]).expect(0);
    for (found, expected) in nose("nose.bvh").iter().zip([0.0, 1.6, 0.1]) {
        assert!((found - expected).abs() < 1e-9, "{:?}", nose("nose.bvh"));
    }
    // With z up it looks against y then, as that is the same figure turned upright.
    let upright = model.replace("kind = \"model\"\n", "kind = \"model\"\nup = \"z\"\n");
    folder.write("up.toml", upright.replace("[0, 1.6, 0]", "[0, 0, 1.6]"));
    folder.condyle(&["convert", "up.toml", "up.bvh", "--length-unit", "cm"]).expect(0);
    let found = folder.condyle(&["fk", "up.bvh", "--length-unit", "cm", "--up-axis", "z"]).json();
    let found = translation(&found["frames"][0], "nose");
    for (found, expected) in found.iter().zip([0.0, -0.1, 1.6]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    // One that was read from a skeleton file looks where it looked.
    let text = "HIERARCHY\nROOT head\n{\nOFFSET 0 160 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT nose\n{\n\
                OFFSET 10 0 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 1 0 0\n}\n}\n}\nMOTION\nFrames: 1\n\
                Frame Time: 0.1\n0 0 0\n";
    folder.write("aside.bvh", text);
    let again = ["convert", "aside.bvh", "again.bvh", "--length-unit", "cm", "--up-axis", "y"];
    folder.condyle(&again).expect(0);
    assert!((nose("again.bvh")[0] - 0.1).abs() < 1e-9, "{:?}", nose("again.bvh"));
}
