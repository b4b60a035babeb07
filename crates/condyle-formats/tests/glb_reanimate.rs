//! Characters given back with another animation.

use condyle_formats::glb::{self, Driven, NodeMotion, NodeTrack, Old, Options};
use condyle_formats::{Animation, Error};
use condyle_model::{Mode, Pose, Program};
use serde_json::{Value, json};
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

fn options(animation: &str) -> Options {
    Options { animation: Some(animation.to_owned()), ..Options::default() }
}

fn alone(name: &str) -> Result<Vec<u8>, String> {
    Err(format!("`{name}` is not there"))
}

/// The JSON and the binary chunk of a GLB, by the layout of the specification.
fn parts(file: &[u8]) -> (Value, String, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let end = 20 + word(12);
    let text = std::str::from_utf8(&file[20..end]).unwrap();
    let binary = if file.len() > end { &file[end + 8..end + 8 + word(end)] } else { &[] };
    (serde_json::from_str(text).unwrap(), text.to_owned(), binary)
}

/// The farthest that a joint is from where it is in the other animation, over all frames.
fn apart(a: &Animation, b: &Animation) -> f64 {
    assert_eq!(a.motion.frames.len(), b.motion.frames.len());
    let (one, two) = (Program::compile(&a.model), Program::compile(&b.model));
    let (mut pose, mut other) = (Pose::new(&one), Pose::new(&two));
    let mut far: f64 = 0.0;
    for (x, y) in a.motion.frames.iter().zip(&b.motion.frames) {
        one.evaluate(x, Mode::Open, &mut pose).unwrap();
        two.evaluate(y, Mode::Open, &mut other).unwrap();
        for id in a.model.segment_ids() {
            let twin = b.model.find_segment(&a.model.segment(id).name).unwrap();
            for (p, q) in pose.segment(id).to_rows().iter().zip(other.segment(twin).to_rows()) {
                far = far.max((p - q).abs());
            }
        }
    }
    far
}

#[test]
fn a_character_comes_back_with_the_motion_and_all_else_as_it_was() {
    let Some(folder) = data() else { return };
    for (name, from, to) in [("greenman.glb", "1_idle", "2_move"), ("cesium_man.gltf", "1", "1")] {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let (from, to) = (options(from), options(to));
        // What one animation does is asked of the skeleton as another leaves it: both move the same nodes.
        let found = glb::read(&bytes, &from, &mut alone).unwrap().value;
        let target = glb::read(&bytes, &to, &mut alone).unwrap().value;
        assert_eq!(found.model.stored_len(), target.model.stored_len());
        let mut motion = glb::node_motion(&bytes, &to, &mut alone, &found.motion).unwrap();
        motion.name = "again".to_owned();
        let file = glb::reanimate(&bytes, &motion, Old::Replaced).unwrap();
        assert!(file.warned("glb/replaced"));
        let again = glb::from_bytes(&file.value).unwrap().value;
        let far = apart(&found, &again);
        println!("{name}: {far:.1e}");
        // Keys are in 32 bits.
        assert!(far < 3e-6, "{name}: {far}");

        let (after, text, binary) = parts(&file.value);
        assert_eq!(after["animations"].as_array().unwrap().len(), 1);
        assert_eq!(after["animations"][0]["name"], "again");
        if name.ends_with(".glb") {
            let (before, old_text, old_binary) = parts(&bytes);
            assert_eq!(&binary[..old_binary.len()], old_binary);
            for (key, value) in before.as_object().unwrap() {
                match key.as_str() {
                    "animations" | "buffers" => {}
                    "accessors" | "bufferViews" => {
                        let old = value.as_array().unwrap();
                        assert_eq!(&after[key].as_array().unwrap()[..old.len()], &old[..]);
                    }
                    _ => assert_eq!(&after[key], value, "{key}"),
                }
            }
            // Byte for byte, not only in meaning.
            let part = |text: &str| {
                let start = text.find("\"meshes\"").unwrap();
                text[start..start + 400].to_owned()
            };
            assert_eq!(part(&text), part(&old_text));
        }
    }
}

/// A chain of two joints: one with a matrix, one whose rest is not that of its skin.
fn character() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "extras": {"mine": [1, 2.50]},
        "nodes": [
            {"name": "hip", "children": [1], "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1]},
            {"name": "knee", "translation": [0, 0.5, 0]},
        ],
        "skins": [{"joints": [0, 1]}],
        "animations": [{"name": "old", "channels": [], "samplers": []}],
    })
}

fn bend() -> NodeMotion {
    let half = 0.5f64.sqrt();
    let knee = NodeTrack {
        name: "knee".into(),
        rotations: vec![[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -2.0 * half, -2.0 * half]],
        ..NodeTrack::default()
    };
    let hip = NodeTrack {
        name: "hip".into(),
        translations: vec![[5.0, 6.0, 7.0], [5.0, 6.0, 8.0]],
        ..NodeTrack::default()
    };
    NodeMotion { times: vec![2.0, 2.5], tracks: vec![knee, hip], ..NodeMotion::default() }
}

#[test]
fn a_matrix_becomes_its_parts_and_old_animations_may_stay() {
    let bytes = serde_json::to_vec(&character()).unwrap();
    let file = glb::reanimate(&bytes, &bend(), Old::Kept).unwrap();
    let said: Vec<&str> = file.warnings.iter().map(|w| w.code).collect();
    assert_eq!(said, ["glb/matrix"]);
    let (after, _, binary) = parts(&file.value);
    let names: Vec<_> =
        after["animations"].as_array().unwrap().iter().map(|a| &a["name"]).collect();
    assert_eq!(names, ["condyle", "old"]);
    // A quarter turn about z, twice as large, at (5, 6, 7).
    let hip = &after["nodes"][0];
    assert!(hip.get("matrix").is_none());
    assert_eq!(hip["scale"], json!([2.0, 2.0, 2.0]));
    assert_eq!(hip["translation"], json!([5.0, 6.0, 7.0]));
    assert!((hip["rotation"][2].as_f64().unwrap() - 0.5f64.sqrt()).abs() < 1e-15);
    assert_eq!(after["extras"], character()["extras"]);
    // Two times, two rotations, two places: (2·1 + 2·4 + 2·3) numbers of four bytes.
    assert_eq!(binary.len(), 64);
    let found = glb::from_bytes(&file.value).unwrap().value;
    assert_eq!(found.motion.times, [0.0, 0.5]);
    let program = Program::compile(&found.model);
    let mut pose = Pose::new(&program);
    program.evaluate(&found.motion.frames[1], Mode::Open, &mut pose).unwrap();
    // The knee is 2·0.5 along the hip's y, which is -x; turned by a second quarter its x points along -x.
    let knee = pose.segment(found.model.find_segment("knee").unwrap());
    let at = knee.translation.to_array();
    assert!(at.iter().zip([4.0, 6.0, 8.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{at:?}");
    assert!((knee.linear.x.x + 1.0).abs() < 1e-6);
}

#[test]
fn buffers_inside_of_the_json_become_the_binary_chunk() {
    let mut json = character();
    json["buffers"] = json!([
        {"byteLength": 3, "uri": "data:application/octet-stream;base64,AQID"},
        {"byteLength": 4, "uri": "data:;base64,BAUGBw=="},
    ]);
    json["bufferViews"] = json!([
        {"buffer": 0, "byteLength": 2, "byteOffset": 1},
        {"buffer": 1, "byteLength": 4},
        {"buffer": 1, "byteLength": 2, "byteOffset": 2},
    ]);
    let bytes = serde_json::to_vec(&json).unwrap();
    let file = glb::reanimate(&bytes, &bend(), Old::Replaced).unwrap().value;
    let (after, _, binary) = parts(&file);
    // The second buffer begins at the next multiple of four.
    assert_eq!(binary[..8], [1, 2, 3, 0, 4, 5, 6, 7]);
    assert_eq!(after["buffers"], json!([{"byteLength": 8 + 64}]));
    let views = after["bufferViews"].as_array().unwrap();
    assert_eq!(views[0], json!({"buffer": 0, "byteLength": 2, "byteOffset": 1}));
    assert_eq!(views[1], json!({"buffer": 0, "byteLength": 4, "byteOffset": 4}));
    assert_eq!(views[2], json!({"buffer": 0, "byteLength": 2, "byteOffset": 6}));
    assert_eq!(glb::from_bytes(&file).unwrap().value.motion.frames.len(), 2);
}

#[test]
fn buffers_elsewhere_stay_and_the_keys_get_their_own() {
    let mut json = character();
    json["buffers"] = json!([{"byteLength": 3, "uri": "mesh.bin"}]);
    let bytes = serde_json::to_vec(&json).unwrap();
    let file = glb::reanimate(&bytes, &bend(), Old::Replaced).unwrap().value;
    let (after, _, binary) = parts(&file);
    assert_eq!(after["buffers"][0], json["buffers"][0]);
    assert_eq!(after["buffers"][1]["byteLength"], 64);
    assert!(binary.is_empty());
    assert_eq!(glb::from_bytes(&file).unwrap().value.motion.frames.len(), 2);
}

#[test]
fn what_does_not_fit_is_refused() {
    let bytes = serde_json::to_vec(&character()).unwrap();
    let code = |change: &dyn Fn(&mut NodeMotion)| {
        let mut motion = bend();
        change(&mut motion);
        glb::reanimate(&bytes, &motion, Old::Kept).map(|_| ()).map_err(|e: Error| e.code())
    };
    assert_eq!(code(&|_| {}), Ok(()));
    assert_eq!(code(&|m| m.times = vec![]), Err("glb/time"));
    assert_eq!(code(&|m| m.times[0] = 3.0), Err("glb/time"));
    assert_eq!(code(&|m| m.times[1] = f64::NAN), Err("glb/time"));
    assert_eq!(code(&|m| m.tracks[0].rotations.truncate(1)), Err("glb/track"));
    assert_eq!(code(&|m| m.tracks[0].rotations[1] = [0.0; 4]), Err("glb/pose"));
    assert_eq!(code(&|m| m.tracks[1].name = "knee".into()), Err("glb/track"));
    assert_eq!(code(&|m| m.tracks.iter_mut().for_each(|t| t.name = "kne".into())), Err("glb/node"));
    let mut partly = bend();
    partly.tracks[1].name = "hips".into();
    assert!(glb::reanimate(&bytes, &partly, Old::Kept).unwrap().warned("glb/node"));
}

#[test]
fn morphs_are_driven_by_their_names() {
    let mut json = character();
    json["nodes"][1]["mesh"] = json!(0);
    json["meshes"] = json!([{
        "primitives": [{"attributes": {}, "targets": [{}, {}]}],
        "weights": [0.25, 0.5],
        "extras": {"targetNames": ["frown", "smile"]},
    }]);
    let bytes = serde_json::to_vec(&json).unwrap();
    let mut motion = bend();
    let driven = |name: &str| Driven { name: name.into(), rest: 0.0, values: vec![0.0, 1.0] };
    motion.driven = vec![driven("smile"), driven("blink")];
    let file = glb::reanimate(&bytes, &motion, Old::Replaced).unwrap();
    let said = file.warnings.iter().find(|w| w.code == "glb/morph").unwrap();
    assert_eq!(said.message, "no mesh of the file has a morph `blink`");
    let (after, _, binary) = parts(&file.value);
    let animation = &after["animations"][0];
    let channels = animation["channels"].as_array().unwrap();
    let channel = channels.iter().find(|c| c["target"]["path"] == "weights").unwrap();
    assert_eq!(channel["target"]["node"], 1);
    let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
    let accessor = &after["accessors"][sampler["output"].as_u64().unwrap() as usize];
    let view = &after["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    let numbers = binary[start..start + 16].chunks_exact(4);
    let numbers: Vec<f32> = numbers.map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    // Both weights at each time; the one that nothing drives stays as the mesh has it.
    assert_eq!(numbers, [0.25, 0.0, 0.25, 1.0]);
}
