//! Meshes that models name, against OpenSim (`oracles/geometry`).

use condyle_formats::opensim::{geometry, model};
use condyle_model::{Mode, Pose, Program};

#[test]
fn meshes_stand_where_opensim_has_them() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/geometry");
    let answers = std::fs::read_to_string(format!("{folder}/meshes.json")).expect("it is kept");
    let answers: serde_json::Value = serde_json::from_str(&answers).expect("JSON");
    // Where OpenSim converts old files it writes new frames in six digits.
    for (name, count, near) in [("new", 4, 1e-9), ("old", 3, 2e-6)] {
        let bytes = std::fs::read(format!("{folder}/{name}.osim")).expect("it is kept");
        let model = model::read(&bytes).expect("a model").value;
        let meshes = geometry::read(&bytes, &mut |name| Err(name.to_owned())).expect("meshes");
        assert!(meshes.warnings.is_empty(), "{:?}", meshes.warnings);
        assert_eq!(meshes.value.len(), count, "{name}");
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        program.evaluate(&model.defaults(), Mode::Open, &mut pose).expect("its length");
        for mesh in &meshes.value {
            let segment = mesh.segment.as_ref().expect("a body");
            let segment = model.find_segment(segment).expect("it is there");
            let found = (pose.segment(segment) * mesh.place).to_rows();
            let expected = answers[name][&mesh.file].as_array().expect(&mesh.file);
            for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
                let expected = expected.as_f64().expect("a number");
                let file = &mesh.file;
                assert!(
                    (found - expected).abs() < near,
                    "{name} {file} {place}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn what_is_hidden_or_nowhere_is_left_out() {
    let body = |name: &str, meshes: &str| {
        format!("<Body name='{name}'><attached_geometry>{meshes}</attached_geometry></Body>")
    };
    let text = format!(
        "<OpenSimDocument Version='40000'><Model name='m'><defaults>{}</defaults><BodySet><objects>{}</objects></BodySet>\
         </Model></OpenSimDocument>",
        body("default", "<Mesh name='a'><mesh_file>default.vtp</mesh_file></Mesh>"),
        body(
            "arm",
            "<Mesh name='b'><Appearance><visible>false</visible></Appearance><mesh_file>hidden.vtp</mesh_file></Mesh>\
             <Mesh name='c'><socket_frame>/bodyset/leg</socket_frame><mesh_file>nowhere.vtp</mesh_file></Mesh>\
             <Mesh name='d'><socket_frame>/ground</socket_frame><mesh_file>floor.vtp</mesh_file></Mesh>\
             <Mesh name='e'><mesh_file></mesh_file></Mesh><Mesh name='f'><mesh_file>arm.vtp</mesh_file></Mesh>"
        )
    );
    let read = geometry::read(text.as_bytes(), &mut |name| Err(name.to_owned())).expect("meshes");
    let found: Vec<_> =
        read.value.iter().map(|mesh| (mesh.segment.as_deref(), mesh.file.as_str())).collect();
    assert_eq!(found, [(None, "floor.vtp"), (Some("arm"), "arm.vtp")]);
    assert_eq!(read.warnings.iter().map(|w| w.code).collect::<Vec<_>>(), ["geometry/frame"]);
}
