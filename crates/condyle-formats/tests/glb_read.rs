//! Skeletons of glTF: places of joints beside those that the formulas of the specification give.

use condyle_formats::glb::{self, Options};
use condyle_formats::{Animation, Error, Read};
use condyle_model::{Mode, Pose, Program};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The folder of shared data beside the repository; `None` where it is absent.
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models/gltf");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

fn read(bytes: &[u8], animation: Option<&str>) -> Result<Read<Animation>, Error> {
    let options = Options { animation: animation.map(str::to_owned), ..Options::default() };
    glb::read(bytes, &options, &mut |name| Err(format!("`{name}` is not there")))
}

/// Joints of a file at a time: where they are, and where they should be.
fn farthest(bytes: &[u8], answer: &Value) -> f64 {
    let number = answer["animation"].as_u64().map(|number| number.to_string());
    let found = read(bytes, number.as_deref()).unwrap().value;
    let time = answer["time"].as_f64().unwrap();
    let stored = match found.motion.frames.is_empty() {
        true => found.model.defaults(),
        false => {
            found.motion.at(&found.model, time).unwrap_or_else(|| panic!("no frame at {time}"))
        }
    };
    let program = Program::compile(&found.model);
    let mut pose = Pose::new(&program);
    program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
    let mut far: f64 = 0.0;
    for (name, place) in answer["joints"].as_object().unwrap() {
        let id = found.model.find_segment(name).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let at = pose.segment(id).translation.to_array();
        for (x, expected) in at.iter().zip(place.as_array().unwrap()) {
            far = far.max((x - expected.as_f64().unwrap()).abs());
        }
    }
    far
}

fn oracle() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracles/glb/evaluate.json");
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn every_kind_of_sampler_and_accessor_gives_the_places_of_the_specification() {
    let oracle = oracle();
    let bytes = serde_json::to_vec(&oracle["made"]).unwrap();
    let mut far: f64 = 0.0;
    let mut compared = 0;
    for answer in oracle["answers"].as_array().unwrap() {
        // All of these times are on frames: keys, or 60 a second between them.
        if answer["file"] == "made" {
            far = far.max(farthest(&bytes, answer));
            compared += 1;
        }
    }
    println!("largest difference {far:.1e} m in {compared} poses");
    assert_eq!(compared, 6);
    assert!(far < 1e-7, "{far}");
}

#[test]
fn real_files_have_their_joints_where_the_specification_puts_them() {
    let Some(folder) = data() else { return };
    let (mut far, mut compared): (f64, _) = (0.0, 0);
    for answer in oracle()["answers"].as_array().unwrap() {
        let name = answer["file"].as_str().unwrap();
        if name != "made" {
            let here = farthest(&std::fs::read(folder.join(name)).unwrap(), answer);
            assert!(here < 2e-6, "{name} {} {}: {here}", answer["animation"], answer["time"]);
            far = far.max(here);
            compared += 1;
        }
    }
    println!("largest difference {far:.1e} m in {compared} poses");
    assert_eq!(compared, 42);
}

#[test]
fn the_broken_samples_of_the_validator_are_refused_or_repaired_for_their_defect() {
    let Some(folder) = data() else { return };
    let expected: &[(&str, Result<&[&str], &str>)] = &[
        ("animation__sampler_output_count_invalid", Err("glb/keys")),
        // Its accessors have no bytes, so both times are 0.
        ("animation__valid", Ok(&["glb/time"])),
        // Its buffer does not come with it.
        ("animation_data__quaternion_non_unit_values", Err("glb/buffer")),
        ("node__node_skin_without_skinned_mesh", Ok(&[])),
        ("skin__empty_joints_array", Err("glb/no-joints")),
        ("skin__ibm_invalid_count", Ok(&["glb/bind", "glb/bind", "glb/bind"])),
        ("skin__no_common_root", Ok(&["glb/roots"])),
        ("skin__unresolved_joint", Err("glb/reference")),
        ("skin__valid", Ok(&["glb/bind"])),
        ("skin_data__invalid_ibm", Ok(&["glb/bind"])),
    ];
    for (name, expected) in expected {
        let bytes = std::fs::read(folder.join(format!("odd/{name}.gltf"))).unwrap();
        match (read(&bytes, None), expected) {
            (Ok(found), Ok(codes)) => {
                let said: Vec<&str> = found.warnings.iter().map(|w| w.code).collect();
                assert_eq!(said, *codes, "{name}");
            }
            (Err(error), Err(code)) => assert_eq!(error.code(), *code, "{name}: {error}"),
            (found, _) => panic!("{name}: {found:?}"),
        }
    }
}

#[test]
fn rotations_without_length_one_are_normalised_and_told() {
    // As `quaternion_non_unit_values` of the validator's tests, with its buffer: (1, 1, 1, 1) and (0, 0, 0, 2).
    let keys: [f32; 10] = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 2.0];
    let bytes: Vec<u8> = keys.iter().flat_map(|x| x.to_le_bytes()).collect();
    let text = r#"{"asset": {"version": "2.0"}, "nodes": [{"name": "a"}],
        "buffers": [{"uri": "k.bin", "byteLength": 40}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                      {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
        "animations": [{"samplers": [{"input": 0, "output": 1}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]}"#;
    let read = glb::read(text.as_bytes(), &Options::default(), &mut |_| Ok(bytes.clone())).unwrap();
    assert!(read.warned("glb/rotation"));
    assert_eq!(read.value.motion.frames, [[0.5; 4], [0.0, 0.0, 0.0, 1.0]]);
}

/// A figure of twelve joints, each a step above the one before.
fn tower(step: f64, rest: &str) -> String {
    let node = |i: usize| {
        let children = if i < 11 { format!(r#", "children": [{}]"#, i + 1) } else { String::new() };
        format!(r#"{{"name": "j{i}", "translation": [0, {step}, 0]{children}{rest}}}"#)
    };
    let nodes: Vec<String> = (0..12).map(node).collect();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{}], "skins": [{{"joints": [0,1,2,3,4,5,6,7,8,9,10,11]}}]}}"#,
        nodes.join(", ")
    )
}

#[test]
fn a_figure_in_centimetres_is_told_and_read_in_metres() {
    let found = read(tower(15.0, "").as_bytes(), None).unwrap();
    assert!(found.warned("skeleton/unit"));
    let model = found.value.model;
    let step = model.segment(model.find_segment("j3").unwrap()).joint_in_parent.translation;
    assert!((step.y - 0.15).abs() < 1e-15);
    let found = read(tower(0.15, "").as_bytes(), None).unwrap();
    assert_eq!(found.warnings, []);
}

#[test]
fn scales_that_never_change_go_into_lengths() {
    let text = tower(15.0, "").replacen(
        r#""name": "j0""#,
        r#""name": "j0", "scale": [0.01, 0.01, 0.01]"#,
        1,
    );
    let found = read(text.as_bytes(), None).unwrap();
    let said: Vec<&str> = found.warnings.iter().map(|w| w.code).collect();
    assert_eq!(said, ["skeleton/scale"]);
    let model = found.value.model;
    let place =
        |name| model.segment(model.find_segment(name).unwrap()).joint_in_parent.translation.y;
    // The scaled node itself stands in its parent's lengths.
    assert_eq!((place("j0"), place("j1"), place("j11")), (15.0, 0.15, 0.15));
}

#[test]
fn trees_that_are_none_are_refused() {
    let text = |nodes: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": {nodes}, "skins": [{{"joints": [0]}}]}}"#
        )
    };
    let code = |nodes: &str| read(text(nodes).as_bytes(), None).map(|_| ()).unwrap_err().code();
    assert_eq!(code(r#"[{"children": [1]}, {"children": [0]}]"#), "glb/cycle");
    assert_eq!(code(r#"[{"children": [0]}]"#), "glb/cycle");
    assert_eq!(code(r#"[{"children": [5]}]"#), "glb/reference");
    assert_eq!(code(r#"[{"children": 5}]"#), "glb/json");
    assert_eq!(code(r#"[{"scale": [1, 1]}]"#), "glb/json");
    let two = read(text(r#"[{}, {"children": [0]}, {"children": [0]}]"#).as_bytes(), None).unwrap();
    assert!(two.warned("glb/parents"));
    // Ten thousand nodes, each below the one before.
    let deep: Vec<String> = (1..10_000).map(|i| format!(r#"{{"children": [{i}]}}"#)).collect();
    assert!(read(text(&format!("[{}, {{}}]", deep.join(","))).as_bytes(), None).is_ok());
}

#[test]
fn damaged_containers_are_told_apart() {
    let text = tower(0.1, "");
    let mut json = text.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut file = b"glTF".to_vec();
    file.extend([2, 0, 0, 0]);
    file.extend(word(20 + json.len()));
    file.extend(word(json.len()));
    file.extend(b"JSON");
    file.extend(&json);
    assert_eq!(read(&file, None).unwrap().warnings, []);
    let mut longer = file.clone();
    longer.extend([0; 4]);
    assert!(read(&longer, None).unwrap().warned("glb/length"));
    assert_eq!(read(&file[..file.len() - 9], None).unwrap_err().code(), "glb/chunk");
    assert_eq!(read(&file[..10], None).unwrap_err().code(), "glb/chunk");
    file[4] = 1;
    assert_eq!(read(&file, None).unwrap_err().code(), "glb/version");
    assert_eq!(read(b"{}", None).unwrap_err().code(), "glb/json");
    assert_eq!(
        read(b"{\"asset\": {\"version\": \"2.0\"}}", None).unwrap_err().code(),
        "glb/no-skeleton"
    );
    assert_eq!(read(b"{\"asset\": ", None).unwrap_err().code(), "glb/json");
}

#[test]
fn animations_are_chosen_by_name_or_number() {
    let Some(folder) = data() else { return };
    let bytes = std::fs::read(folder.join("greenman.glb")).unwrap();
    // Keys of each animation, by the counts of its accessors.
    for (wanted, frames) in
        [(None, 4), (Some("1_idle"), 60), (Some("3"), 30), (Some("3_attack"), 20)]
    {
        let found = read(&bytes, wanted).unwrap();
        assert_eq!(found.value.motion.frames.len(), frames, "{wanted:?}");
        assert_eq!(found.warned("glb/animations"), wanted.is_none());
    }
    let error = read(&bytes, Some("2_mvoe")).unwrap_err();
    assert_eq!(error.to_string(), "there is no animation `2_mvoe` (did you mean `2_move`?)");
}
