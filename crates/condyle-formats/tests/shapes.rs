//! What bones look like, in documents.

use condyle_formats::document;
use condyle_math::Vec3;
use condyle_mesh::{Finish, Form};
use condyle_model::Model;

fn read(text: &str) -> Result<Model, String> {
    let read = document::read(text, &mut |_| Err("it stands alone".into()));
    read.map(|read| read.value.model).map_err(|error| error.to_string())
}

fn model(text: &str) -> Model {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// A thigh with one shape of each form on the right, and a band to the shank.
const LEG: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
mirror = { plane = "z", from = "_r", to = "_l" }
constants = { shaft = 0.4 }
[segment]
thigh_r = {}
shank_r = { parent = "thigh_r", at = [0.01, "-$shaft", 0.02] }
[joint.knee_r]
type = "hinge"
segment = "shank_r"
axis = [0, 0, -1]
coordinates = ["knee_r"]
coordinate.knee_r = { range = [0, 150], typical = [0, 140] }
[marker]
insertion_r = { segment = "shank_r", at = [0.03, -0.06, 0.01] }
TT_r = "insertion_r"
skin_r = { like = "insertion_r", at = [0.01, 0, 0] }
[shape]
head_r = { segment = "thigh_r", ball = { at = [0, 0, 0.01], radii = 0.024, turn = [10, 20, 30] } }
plug_r = { segment = "thigh_r", box = { size = [0.01, 0.02, 0.03], turn = [0, 40, 0] }, finish = "joint" }
shaft_r = { segment = "thigh_r", tube = [[0, 0, 0.04, 0.02], [0.02, "-0.5 * $shaft", 0.03, 0.012, 0.014], [0.01, -0.38, 0.02, 0.03, 0.02]], across = [1, 0, 0] }
wing_r = { segment = "thigh_r", plate = { outline = [[0, 0, 0], [0, 0.1, 0.02], [0, 0.1, 0.02], [0.1, 0, 0.01], [0.05, -0.03, 0]], middle = [0.03, 0.02, 0.02], thickness = 0.006 } }
rib_r = { segment = "thigh_r", rib = { at = [0, 0.1, 0], chord = 0.2, peak = [0.3, 0.44], angle = 110, proximal = -0.4, distal = -0.5, pump = 35, swing = 20, plane = 5, radii = [0.003, 0.006] } }
band_r = { segment = "thigh_r", tube = [[0.02, -0.3, 0.02, 0.004], "insertion_r"], finish = "cartilage" }
"#;

#[test]
fn a_written_document_has_the_same_shapes() {
    let model = model(LEG);
    assert_eq!(model.shapes().len(), 12);
    let again = read(&document::write(&model)).expect("what was written");
    assert_eq!(again, model);
    assert_eq!(model.coordinates()[0].typical, Some([0.0, 140f64.to_radians()]));
}

#[test]
fn the_other_side_is_the_mirror_image() {
    let model = model(LEG);
    let form = |name: &str| {
        let shape = model.shapes().iter().find(|s| s.name == name).expect(name);
        let side = if name.ends_with("_r") { "thigh_r" } else { "thigh_l" };
        assert_eq!(model.segment(shape.segment).name, side);
        shape.form.clone()
    };
    for name in ["head", "plug", "shaft", "wing", "rib"] {
        let (right, left) = (form(&format!("{name}_r")).mesh(), form(&format!("{name}_l")).mesh());
        let (volume, mirrored) = (right.volume(), left.volume());
        // Quadrilaterals are cut along the other diagonal.
        assert!(
            volume > 0.0 && (volume / mirrored - 1.0).abs() < 2e-3,
            "{name}: {volume} {mirrored}"
        );
        // Every corner of the one has its image among those of the other, up to how finely both are cut.
        let mean = |mesh: &condyle_mesh::Mesh| {
            let mut sum = Vec3::ZERO;
            for &p in &mesh.positions {
                sum += p;
            }
            sum * (1.0 / mesh.positions.len() as f64)
        };
        let (a, b) = (mean(&right), mean(&left));
        assert!((a - Vec3::new(b.x, b.y, -b.z)).norm() < 1e-9, "{name}: {a:?} {b:?}");
    }
    let band = model.shapes().iter().find(|s| s.name == "band_l").expect("the left band");
    let (shank, end) = band.until.expect("it hangs between two");
    assert_eq!(
        (model.segment(shank).name.as_str(), end),
        ("shank_l", Vec3::new(0.03, -0.06, -0.01))
    );
    assert_eq!(band.finish, Finish::Cartilage);
}

#[test]
fn shapes_grow_with_their_segments() {
    let model = model(LEG);
    let thigh = model.find_segment("thigh_r").expect("a thigh");
    let factors: Vec<f64> =
        model.segment_ids().map(|id| if id == thigh { 1.5 } else { 1.0 }).collect();
    let grown = model.scaled(&factors);
    for (shape, larger) in model.shapes().iter().zip(grown.shapes()) {
        let factor: f64 = if shape.segment == thigh { 1.5 } else { 1.0 };
        let (small, large) = (shape.form.mesh(), larger.form.mesh());
        if matches!(shape.form, Form::Ball(_) | Form::Tube(_) | Form::Rib(_)) {
            // More corners fit around what is thicker.
            let ratio = large.volume() / small.volume();
            assert!((ratio / factor.powi(3) - 1.0).abs() < 0.06, "{}: {ratio}", shape.name);
        } else {
            for (p, q) in small.positions.iter().zip(&large.positions) {
                assert!((*p * factor - *q).norm() < 1e-9, "{}", shape.name);
            }
        }
    }
    // The band's end is a point of the shank, which did not grow.
    let end =
        |model: &Model| model.shapes().iter().find(|s| s.name == "band_r").and_then(|s| s.until);
    assert_eq!(end(&model), end(&grown));
}

#[test]
fn a_name_stands_for_the_place_of_a_marker() {
    let model = model(LEG);
    let place = |name: &str| {
        let marker = model.markers().iter().find(|m| m.name == name).expect(name);
        (marker.segment.map(|s| model.segment(s).name.as_str()), marker.point)
    };
    assert_eq!(place("TT_r"), (Some("shank_r"), Vec3::new(0.03, -0.06, 0.01)));
    assert_eq!(place("TT_l"), (Some("shank_l"), Vec3::new(0.03, -0.06, -0.01)));
    assert_eq!(place("skin_l"), (Some("shank_l"), Vec3::new(0.04, -0.06, -0.01)));
    // A copy says so too, but for a marker that was moved to a place of its own.
    let written = document::write(&model);
    assert!(written.contains("[marker.TT_r]\nlike = \"insertion_r\"\n"), "{written}");
    let moved: Vec<_> =
        model.markers().iter().map(|m| (m.name == "TT_r").then_some(Vec3::X)).collect();
    let moved = model.with_markers_at(&moved);
    assert!(
        document::write(&moved).contains("[marker.TT_r]\nsegment = \"shank_r\"\nat = [1, 0, 0]\n")
    );
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    let cases = [
        ("TT_r = \"insertion_r\"", "TT_r = \"insertoin_r\"", "unknown marker `insertoin_r`"),
        ("TT_r = \"insertion_r\"", "TT_r = \"skin_r\"", "`skin_r` is itself another name"),
        ("finish = \"joint\"", "finish = \"bnoe\"", "did you mean `bone`"),
        ("radii = 0.024", "radii = -0.024", "sizes are positive"),
        ("[0, 0, 0.04, 0.02], ", "[0, 0, 0.02], ", "a point of a tube has four or five numbers"),
        ("thickness = 0.006", "thick = 0.006", "unknown key `thick`"),
        ("peak = [0.3, 0.44]", "peak = [1.3, 0.44]", "the peak of a rib is between its ends"),
        ("angle = 110", "angle = 20", "the inner angle of a rib"),
        ("typical = [0, 140]", "typical = [140, 0]", "`typical` is not [lowest, highest]"),
        ("segment = \"thigh_r\", box", "segment = \"thigh_r\", plate = {}, box", "this shape has"),
    ];
    for (from, to, said) in cases {
        let text = LEG.replacen(from, to, 1);
        assert_ne!(text, LEG, "{from}");
        let error = read(&text).expect_err(to);
        assert!(error.contains(said), "{to}: {error}");
    }
}
