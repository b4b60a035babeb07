//! Shipped models by name, and motions baked to plain bones.

use super::{Folder, number};
use serde_json::{Value, json};

/// A binary glTF file, read back with nothing but the format's own words.
struct Scene {
    json: Value,
    bytes: Vec<u8>,
}

impl Scene {
    fn read(folder: &Folder, name: &str) -> Self {
        let file = std::fs::read(folder.path().join(name)).expect("a scene");
        assert_eq!(&file[..4], b"glTF");
        let length = |at: usize| {
            u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize
        };
        let end = 20 + length(12);
        let json = serde_json::from_slice(&file[20..end]).expect("JSON");
        assert_eq!(&file[end + 4..end + 8], b"BIN\0");
        Self { json, bytes: file[end + 8..end + 8 + length(end)].to_vec() }
    }

    fn list(&self, key: &str) -> &[Value] {
        self.json[key].as_array().map_or(&[], Vec::as_slice)
    }

    /// The numbers of an accessor, all in one.
    fn numbers(&self, accessor: &Value) -> Vec<f64> {
        let accessor = &self.list("accessors")[index(accessor)];
        assert_eq!(accessor["componentType"], 5126, "32-bit numbers");
        let width = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC3") => 3,
            _ => 4,
        };
        let view = &self.list("bufferViews")[index(&accessor["bufferView"])];
        let start = view["byteOffset"].as_u64().unwrap_or(0) as usize;
        let count = width * index(&accessor["count"]);
        let bytes = &self.bytes[start..start + 4 * count];
        bytes
            .chunks_exact(4)
            .map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect()
    }

    /// Translation, rotation and scale of a node in a frame: of its channels, else its own.
    fn place(&self, node: usize, frame: usize) -> [Vec<f64>; 3] {
        let own = &self.list("nodes")[node];
        [("translation", 0.0), ("rotation", 0.0), ("scale", 1.0)].map(|(path, rest)| {
            for animation in self.list("animations") {
                for channel in animation["channels"].as_array().expect("channels") {
                    let target = &channel["target"];
                    if index(&target["node"]) == node && target["path"] == path {
                        let sampler = &animation["samplers"][index(&channel["sampler"])];
                        let width = if path == "rotation" { 4 } else { 3 };
                        let all = self.numbers(&sampler["output"]);
                        return all[width * frame..width * (frame + 1)].to_vec();
                    }
                }
            }
            match own[path].as_array() {
                Some(list) => list.iter().map(number).collect(),
                None if path == "rotation" => vec![0.0, 0.0, 0.0, 1.0],
                None => vec![rest; 3],
            }
        })
    }

    /// What a viewer multiplies: for each named node the three upper rows of its world transform.
    fn world(&self, frame: usize) -> Vec<(String, [[f64; 4]; 3])> {
        let nodes = self.list("nodes");
        let root = index(&self.list("scenes")[0]["nodes"][0]);
        let mut open =
            vec![(root, [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])];
        let mut all = vec![];
        while let Some((node, parent)) = open.pop() {
            let [t, q, s] = self.place(node, frame);
            let (x, y, z, w) = (q[0], q[1], q[2], q[3]);
            // The matrix of the specification of glTF 2.0: T·R·S.
            let r = [
                [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
                [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
                [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
            ];
            let mut world = [[0.0; 4]; 3];
            for (i, row) in world.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell = if j < 3 {
                        (0..3).map(|k| parent[i][k] * r[k][j] * s[j]).sum()
                    } else {
                        parent[i][3] + (0..3).map(|k| parent[i][k] * t[k]).sum::<f64>()
                    };
                }
            }
            let children = nodes[node]["children"].as_array();
            open.extend(children.into_iter().flatten().map(|child| (index(child), world)));
            all.push((nodes[node]["name"].as_str().expect("a name").to_owned(), world));
        }
        all
    }

    /// Asserts that the segments of one frame of `fk` are where the nodes are, to single precision: shipped models look
    /// along x and figures in glTF along z, so that (x, y, z) is (-z, y, x) there.
    #[track_caller]
    fn is_at(&self, frame: usize, fk: &Value, within: f64) {
        let segments = fk["frames"][frame]["segments"].as_object().expect("segments by name");
        let world = self.world(frame);
        for (name, rows) in segments {
            let (_, found) = world.iter().find(|(n, _)| n == name).expect(name);
            for (at, expected) in rows.as_array().expect("rows").iter().take(12).enumerate() {
                // Rows turn with the world; columns are the segment's own.
                let turned = match at / 4 {
                    0 => found[2][at % 4],
                    1 => found[1][at % 4],
                    _ => -found[0][at % 4],
                };
                let off = (turned - number(expected)).abs();
                assert!(off < within, "{name} in frame {frame}: {off}");
            }
        }
    }
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("a position") as usize
}

/// Rounding of 32-bit numbers (6e-8) along some thirty nodes, in lengths of about a metre.
const SINGLE: f64 = 2e-6;

#[test]
fn a_name_does_where_a_file_does() {
    let folder = Folder::new("shipped-name");
    let info = folder.condyle(&["info", "legs", "--json"]).json();
    assert_eq!((&info["kind"], &info["name"]), (&json!("model"), &json!("legs")));
    let checked = folder.condyle(&["check", "legs"]);
    assert_eq!(checked.expect(0), "legs: no findings\n");
    folder.write("p.json", r#"{"knee_angle_r": 1.0}"#);
    let fk = folder.condyle(&["fk", "legs", "--pose", "p.json"]).json();
    assert!(fk["frames"][0]["segments"]["tibia_l"].is_array());
    assert_eq!(folder.condyle(&["bench", "knee", "--json"]).json()["model"], "knee");
    // A file of that name comes first, whatever it is.
    folder.write("legs", "");
    let said = folder.condyle(&["info", "legs"]).refused();
    assert!(said.contains("legs: the ending names no format"), "{said}");
    // A folder is no file.
    std::fs::create_dir(folder.path().join("spine")).expect("a folder");
    assert_eq!(folder.condyle(&["info", "spine", "--json"]).json()["name"], "spine");
    let said = folder.condyle(&["fk", "knee.toml"]).refused();
    assert!(said.ends_with("(`knee` without an ending is a shipped model)\n"), "{said}");
}

#[test]
fn an_unknown_name_is_told_the_known_ones() {
    let folder = Folder::new("shipped-unknown");
    for command in
        [&["info", "lgs"][..], &["check", "lgs"], &["fk", "lgs"], &["convert", "lgs", "a.glb"]]
    {
        let said = folder.condyle(command).refused();
        let start =
            "error: `lgs` is neither a file nor a shipped model (did you mean `legs`? shipped are ";
        assert!(said.starts_with(start), "{said}");
        for name in ["arms", "knee", "octopus", "spine-shao2003"] {
            assert!(said.contains(name), "{said}");
        }
    }
    let said = folder.condyle(&["convert", "spine", "spine.mot"]).refused();
    assert!(said.contains("spine: cannot be converted to .mot"), "{said}");
}

#[test]
fn a_copy_reads_alone() {
    let folder = Folder::new("shipped-copy");
    folder.condyle(&["convert", "spine", "my_spine.toml"]).expect(0);
    let text = folder.read("my_spine.toml");
    assert!(text.starts_with("# ") && text.contains("\n# "), "comments stay");
    folder.condyle(&["convert", "my_spine.toml", "again.toml"]).expect(0);
    assert_eq!(folder.read("again.toml"), text);
    // The legs include a knee; a copy holds it.
    let copy = folder.condyle(&["convert", "legs", "-", "--to", "toml"]).expect(0);
    assert!(!copy.contains("include ="), "{copy}");
    folder.write("my_legs.toml", copy);
    folder.write("p.json", r#"{"knee_angle_r": 1.2, "hip_flexion_l": 0.4, "ankle_angle_r": -0.3}"#);
    let posed = |model| folder.condyle(&["fk", model, "--pose", "p.json"]).json();
    let (own, copy) = (posed("legs"), posed("my_legs.toml"));
    for (name, rows) in own["frames"][0]["segments"].as_object().expect("segments") {
        let others = copy["frames"][0]["segments"][name].as_array().expect(name);
        for (a, b) in rows.as_array().expect("rows").iter().zip(others) {
            assert!((number(a) - number(b)).abs() < 1e-14, "{name}");
        }
    }
}

#[test]
fn at_rest_a_model_is_a_still_scene() {
    let folder = Folder::new("shipped-still");
    for name in ["human", "spine", "octopus"] {
        folder.condyle(&["convert", name, "still.glb"]).expect(0);
        let scene = Scene::read(&folder, "still.glb");
        assert_eq!(scene.list("animations").len(), 0);
        scene.is_at(0, &folder.condyle(&["fk", name]).json(), SINGLE);
    }
}

#[test]
fn a_motion_is_baked_to_plain_bones() {
    let folder = Folder::new("shipped-baked");
    let mot = "m\ninDegrees=yes\nendheader\n\
               time\thip_flexion_r\tknee_angle_r\thip_adduction_l\tknee_angle_l\n\
               0\t10\t5\t-3\t20\n0.5\t50\t90\t10\t130\n1\t-10\t60\t20\t0\n";
    folder.write("m.mot", mot);
    let run = folder.condyle(&["convert", "m.mot", "m.glb", "--model", "legs"]);
    assert!(run.err.contains("these coordinates keep their defaults"), "{}", run.err);
    run.expect(0);
    let scene = Scene::read(&folder, "m.glb");
    let fk = folder.condyle(&["fk", "legs", "--motion", "m.mot"]).json();
    (0..3).for_each(|frame| scene.is_at(frame, &fk, SINGLE));
    // No bone of a leg changes its size.
    let paths = |path: &str| {
        let channels = scene.list("animations")[0]["channels"].as_array().expect("channels");
        channels.iter().filter(|c| c["target"]["path"] == path).count()
    };
    assert!(paths("rotation") > 0);
    assert_eq!(paths("scale"), 0);
}

#[test]
fn poses_are_baked_with_what_stretches() {
    let folder = Folder::new("shipped-poses");
    let poses = r#"[
        {"mantle/stretch": 1.5, "mantle/sway": 0.4, "head/roll": 0.5, "arm_1_r/curl": 0.7},
        {"mantle/breath": 0.8, "arm_1_r/curl": 1.1, "arm_1_r/stretch": 1.6, "arm_4_l/sway": 0.5},
        {"arm_1_r/fold": 1.5, "arm_1_r/fold_at": 2.4, "arm_1_r/stretch": 0.8, "funnel/aim": 0.6}
    ]"#;
    folder.write("p.json", poses);
    let run = folder.condyle(&["convert", "p.json", "p.glb", "--model", "octopus"]);
    assert_eq!(run.err, "");
    run.expect(0);
    let scene = Scene::read(&folder, "p.glb");
    let fk = folder.condyle(&["fk", "octopus", "--pose", "p.json"]).json();
    (0..3).for_each(|frame| scene.is_at(frame, &fk, SINGLE));
    // The six pieces of flesh of one arm and the mantle change their size, nothing else.
    let channels = scene.list("animations")[0]["channels"].as_array().expect("channels");
    let sized = channels.iter().filter(|c| c["target"]["path"] == "scale").count();
    assert_eq!(sized, 7);
    // The same poses as a table, whose times are their numbers.
    let text = folder.condyle(&["convert", "p.json", "-", "--to", "csv", "--model", "octopus"]);
    let text = text.expect(0);
    assert!(text.lines().last().is_some_and(|row| row.starts_with("2,")), "{text}");
    let said = folder.condyle(&["convert", "p.json", "q.glb"]).refused();
    assert!(said.contains("p.json: without --model poses cannot be converted to .glb"), "{said}");
    folder.write("q.json", r#"[{}, {"arm_1_r/crul": 1}]"#);
    let said = folder.condyle(&["convert", "q.json", "q.glb", "--model", "octopus"]).refused();
    assert!(said.contains("q.json: pose 1: ") && said.contains("arm_1_r/curl"), "{said}");
}

#[test]
fn with_limits_on_the_nearest_posture_is_baked() {
    let folder = Folder::new("shipped-limits");
    folder.write(
        "p.json",
        r#"[{"knee_angle_r": 9.0, "hip_flexion_l": -4.0}, {"knee_angle_r": 0.5}]"#,
    );
    for (limits, differ) in [("off", false), ("on", true)] {
        let arguments = ["convert", "p.json", "p.glb", "--model", "legs", "--limits", limits];
        folder.condyle(&arguments).expect(0);
        let scene = Scene::read(&folder, "p.glb");
        let fk =
            |limits| folder.condyle(&["fk", "legs", "--pose", "p.json", "--limits", limits]).json();
        (0..2).for_each(|frame| scene.is_at(frame, &fk(limits), SINGLE));
        assert_eq!(fk("off")["frames"][0] != fk(limits)["frames"][0], differ);
    }
    // A table gets what took effect: hip flexion goes back by 40 degrees at most.
    let arguments = ["convert", "p.json", "-", "--to", "mot", "--model", "legs", "--limits", "on"];
    let text = folder.condyle(&arguments).expect(0);
    let mut lines = text.lines().skip_while(|line| !line.starts_with("time"));
    let column = lines.next().expect("names").split('\t').position(|n| n == "hip_flexion_l");
    let value = lines.next().expect("a row").split('\t').nth(column.expect("the hip"));
    let value: f64 = value.expect("a cell").parse().expect("a number");
    assert!((value + 40.0).abs() < 1e-12, "{value}");
    folder.write("m.mot", "m\nendheader\ntime\tx\n0\t1\n");
    let said = folder.condyle(&["convert", "m.mot", "m.csv", "--limits", "on"]).refused();
    assert!(said.contains("m.mot: without --model there are no limits to apply"), "{said}");
}

#[test]
fn what_a_bone_cannot_say_is_said() {
    let folder = Folder::new("shipped-shear");
    let text = "condyle = 1\nkind = \"model\"\n[segment.hat]\n[joint.lean]\ntype = \"shear\"\n\
                segment = \"hat\"\nalong = [1, 0, 0]\nacross = [0, 1, 0]\n";
    folder.write("hat.toml", text);
    folder.write("p.json", r#"[{}, {"amount": 0.4}]"#);
    let run = folder.condyle(&["convert", "p.json", "p.glb", "--model", "hat.toml"]);
    // How far the shear is from any rotation with sizes: its polar decomposition leaves sin(atan(s/2)) twice beside
    // the diagonal.
    let left = 100.0 * 2f64.sqrt() * 0.2f64.atan().sin();
    let said = format!(
        "warning: p.glb: sheared segments hang on a second node each: `hat`; most is sheared `hat` in frame 1, by \
         {left:.2} %"
    );
    assert!(run.err.starts_with(&said), "{}", run.err);
    run.expect(0);
}
