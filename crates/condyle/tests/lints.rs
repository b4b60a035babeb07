//! What `check` finds in rigs with one mistake each, and that it finds nothing once that is mended.

use condyle::formats::document;
use condyle::{Diagnostic, check};

/// A clavicle whose lift an abduction bounds, and an arm behind a cone; every part is used and fits.
const ARM: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
[segment.sternum]
[segment.clavicle]
parent = "sternum"
[segment.humerus]
parent = "clavicle"
at = [0, 0, 0.15]
[joint_set.s.coordinate]
lift = { range = [-30, 45] }
flexion = { range = [-60, 60] }
abduction = { range = [0, 90] }
[joint_set.s.component.bound.depend]
passive = "lift"
driver = "abduction"
in = "deg"
out = "deg"
lower = { lines = [[0, -10], [90, 23]] }
[joint_set.s.component.up.rotate]
angle = "bound"
axis = [1, 0, 0]
[joint_set.s.component.legal.cone]
angles = ["flexion", "abduction"]
axes = [[0, 0, 1], [-1, 0, 0]]
rest = [0, -1, 0]
projection = "toward_rest"
points = [
    { direction = [-1, -0.2, 0] },
    { direction = [0, 0.2, 1] },
    { direction = [1, -0.2, 0] },
    { direction = [0, -1, -0.5] },
]
[joint_set.s.component.flex.rotate]
angle = "legal"
axis = [0, 0, 1]
[joint_set.s.component.abduct.pivot]
angle = "legal.2"
axis = [-1, 0, 0]
centres = [{ to = 60, at = [0, 0, 0] }, { to = 90, at = [0, 0.004, 0] }]
[joint_set.s.component.level.compensate]
segment = "humerus"
ancestors = ["clavicle"]
[joint_set.s.output]
clavicle = "up"
humerus = ["level", "flex", "abduct"]
[marker.arm1]
segment = "humerus"
[marker.arm2]
segment = "humerus"
at = [0, -0.1, 0]
[marker.arm3]
segment = "humerus"
at = [0, -0.2, 0]
"#;

#[track_caller]
fn findings(text: &str) -> Vec<Diagnostic> {
    let read =
        document::read(text, &mut |_| Err("it stands alone".to_owned())).expect("a document");
    let mut findings = check::check(&read.value.model, &read.warnings);
    findings.iter_mut().for_each(|finding| read.value.locate(finding));
    findings
}

/// The arm with one passage written in another way has a finding at that passage's line.
#[track_caller]
fn found(from: &str, to: &str, code: &str) -> Diagnostic {
    assert!(ARM.contains(from), "the rig has no `{from}`");
    let findings = findings(&ARM.replacen(from, to, 1));
    let finding = findings.iter().find(|finding| finding.code == code);
    let finding = finding.unwrap_or_else(|| panic!("no {code} in {findings:#?}"));
    assert!(finding.place.is_some(), "it has no place: {finding}");
    finding.clone()
}

#[test]
fn a_rig_without_a_mistake_has_no_finding() {
    let all = findings(ARM);
    assert!(all.is_empty(), "{all:#?}");
}

#[test]
fn degrees_where_radians_are_read() {
    let said = found("in = \"deg\"\nout = \"deg\"\n", "", "lint/degrees");
    assert!(said.message.contains("arguments go to 90 radians"), "{said}");
    assert!(said.message.contains("bounds go to 23 radians"), "{said}");
    found("out = \"deg\"\n", "", "lint/degrees");
    // A map whose values drive a rotation, of a coordinate without a range.
    let text = ARM.replace("lift = { range = [-30, 45] }", "lift = {}").replace(
        "[joint_set.s.component.up.rotate]\nangle = \"bound\"",
        "[joint_set.s.component.up.rotate]\nangle = \"bent\"",
    ) + "[joint_set.s.component.bent.map]\ninput = \"bound\"\nfunction = { lines = [[0, 0], [90, 30]] }\n";
    assert!(findings(&text).iter().any(|finding| finding.code == "lint/degrees"));
}

#[test]
fn bounds_that_cross() {
    let lower = "lower = { lines = [[0, -10], [90, 23]] }";
    let both = "lower = { lines = [[0, -10], [90, 23]] }\nupper = { lines = [[0, 40], [90, 10]] }";
    let said = found(lower, both, "lint/bounds-cross");
    assert!(said.message.contains("is 90°, the lower is 23° and the upper 10°"), "{said}");
    // The range of what is bounded ends below its bound.
    let said =
        found("lift = { range = [-30, 45] }", "lift = { range = [-30, 15] }", "lint/bounds-cross");
    assert!(said.message.contains("the lower is 23° and the upper 15°"), "{said}");
    // Also where there is an upper bound that does not cross the lower one.
    let text =
        ARM.replace(lower, &format!("{lower}\nupper = 45")).replace("[-30, 45]", "[-30, 15]");
    let found = findings(&text);
    assert!(found.iter().any(|finding| finding.code == "lint/bounds-cross"), "{found:?}");
}

#[test]
fn domains_that_end_before_the_range() {
    found("[90, 23]", "[60, 23]", "lint/beyond-knots");
    let said = found("{ to = 90, at", "{ to = 70, at", "lint/beyond-intervals");
    assert!(said.message.contains("may reach 90°, but its last interval ends at 70°"), "{said}");
}

#[test]
fn a_cone_that_does_not_fit_its_rotations() {
    let said =
        found("axes = [[0, 0, 1], [-1, 0, 0]]", "axes = [[0, 0, 1], [1, 0, 0]]", "lint/cone-axes");
    assert!(said.message.contains("180° apart"), "{said}");
    found(
        "[\"level\", \"flex\", \"abduct\"]",
        "[\"level\", \"abduct\", \"flex\"]",
        "lint/cone-order",
    );
    let points = &ARM[ARM.find("rest =").expect("a cone")
        ..ARM.find("[joint_set.s.component.flex").expect("a turn")];
    let narrow = "rest = [0, 1, 0]\npoints = [{ direction = [1, -1, 0] }, { direction = [0, -1, 1] }, \
                  { direction = [-1, -1, 0] }, { direction = [0, -1, -1] }]\n";
    found(points, narrow, "lint/cone-outside");
}

#[test]
fn an_angle_that_passes_by_its_limit() {
    let said = found("angle = \"legal.2\"", "angle = \"abduction\"", "lint/limit-bypassed");
    assert!(said.message.contains("`abduct` moves by `abduction` as it is asked for"), "{said}");
}

#[test]
fn compensations_out_of_order() {
    found(
        "[\"level\", \"flex\", \"abduct\"]",
        "[\"flex\", \"level\", \"abduct\"]",
        "lint/compensate-late",
    );
    let two = ARM.replace(
        "[segment.humerus]\nparent = \"clavicle\"",
        "[segment.scapula]\nparent = \"clavicle\"\n[segment.humerus]\nparent = \"scapula\"",
    ) + "[joint.acromial]\ntype = \"hinge\"\nsegment = \"scapula\"\naxis = [0, 1, 0]\n\
           [joint_set.s.component.inner.compensate]\nsegment = \"humerus\"\nancestors = [\"scapula\"]\n";
    let order = |list: &str| two.replace("[\"level\", \"flex\"", list);
    let codes = |text: &str| findings(text).iter().map(|f| f.code).collect::<Vec<_>>();
    // Outermost ancestor first: the two rotations then cancel both.
    assert_eq!(codes(&order("[\"level\", \"inner\", \"flex\"")), Vec::<&str>::new());
    assert_eq!(codes(&order("[\"inner\", \"level\", \"flex\"")), ["lint/compensate-order"]);
}

#[test]
fn markers_where_they_do_not_belong() {
    let said = found(
        "[marker.arm3]\nsegment = \"humerus\"",
        "[marker.arm3]\nsegment = \"sternum\"",
        "lint/stray-marker",
    );
    assert!(said.message.contains("2 joints away"), "{said}");
    found("[marker.arm3]\nsegment = \"humerus\"\n", "[marker.arm3]\n", "lint/ground-marker");
}

#[test]
fn lengths_in_millimetres() {
    found("at = [0, 0.004, 0]", "at = [0, 40, 0]", "lint/millimetres");
}

/// Two thighs, with a mirror or written by hand.
const HIPS: &str = r#"
condyle = 1
kind = "model"
angles = "deg"
mirror = { plane = "z", from = "_r", to = "_l" }
[segment.pelvis]
[segment.femur_r]
parent = "pelvis"
at = [-0.07, -0.066, 0.083]
[joint.hip_r]
type = "euler"
segment = "femur_r"
order = "zxy"
coordinates = ["flexion_r", "adduction_r", "rotation_r"]
"#;

#[test]
fn mirrors_that_do_not_do_what_is_meant() {
    assert_eq!(findings(HIPS), []);
    let codes = |text: &str| findings(text).iter().map(|f| f.code).collect::<Vec<_>>();
    assert_eq!(codes(&HIPS.replace("\"_r\", to", "\"_R\", to")), ["model/mirror"]);
    let unnamed =
        HIPS.replace("[\"flexion_r\", \"adduction_r\", \"rotation_r\"]", "[\"f\", \"a\", \"r\"]");
    assert_eq!(codes(&unnamed), ["model/mirror-names"]);
    // By hand: with the same axes on both sides, adduction on one is abduction on the other.
    let mirror = "mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n";
    let right = HIPS.replace(mirror, "");
    let left = right[right.find("[segment.femur_r]").expect("a thigh")..].replace("_r", "_l");
    let copied = format!("{right}{}", left.replace("0.083", "-0.083"));
    assert_eq!(codes(&copied), ["lint/not-mirrored"]);
    let turned = copied.replacen(
        "order = \"zxy\"\ncoordinates = [\"flexion_l\"",
        "axes = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]\ncoordinates = [\"flexion_l\"",
        1,
    );
    assert_eq!(codes(&turned), Vec::<&str>::new());
    // Both thighs on the right.
    assert!(codes(&format!("{right}{left}")).contains(&"lint/same-side"));
}

#[test]
fn matrices_that_are_no_rotations() {
    let frame = |matrix: &str| {
        let text = HIPS.replace("at = [-0.07", &format!("matrix = {matrix}\nat = [-0.07"));
        document::read(&text, &mut |_| Err(String::new())).map(|read| read.warnings)
    };
    let message = |matrix: &str| frame(matrix).expect_err("an error")[0].to_string();
    assert!(message("[[1, 0, 0], [0, 0, 1], [0, 1, 0]]").contains("determinant is -1"));
    assert!(message("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]").contains("determinant is 0"));
    assert!(message("[[2, 0, 0], [0, 1, 0], [0, 0, 1]]").contains("lengths 2, 1, 1"));
    // Three decimals of 30 degrees: cos² + sin² is 1 - 0.00004.
    let rounded = frame("[[0.866, -0.5, 0], [0.5, 0.866, 0], [0, 0, 1]]").expect("rounding");
    assert_eq!(rounded[0].code, "document/rotation");
    assert_eq!(frame("[[0, -1, 0], [1, 0, 0], [0, 0, 1]]").expect("a quarter turn"), []);
}

#[test]
fn an_including_text_overrides_values() {
    let outer = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\ninclude = [\"hips.toml\"]\n\
                 [joint.hip_r.coordinate.flexion_r]\nrange = [-20, 120]\n\
                 [segment.femur_r]\nat = [0, -0.1, 0.09]\n";
    let mut include = |name: &str| match name {
        "hips.toml" => Ok(HIPS.to_owned()),
        other => Err(format!("there is no {other}")),
    };
    let model = document::read(outer, &mut include).expect("a model").value.model;
    for name in ["flexion_r", "flexion_l"] {
        let id = model.find_coordinate(name).expect("a coordinate");
        assert_eq!(model.coordinate(id).range.upper, Some(120f64.to_radians()), "{name}");
    }
    let left = model.find_segment("femur_l").expect("a thigh");
    assert_eq!(model.segment(left).joint_in_parent.translation.to_array(), [0.0, -0.1, -0.09]);
    // Two included texts that differ are still a mistake.
    let both = "condyle = 1\nkind = \"model\"\ninclude = [\"a.toml\", \"b.toml\"]\n";
    let mut include = |name: &str| {
        let x = if name == "a.toml" { 1 } else { 2 };
        Ok(format!("condyle = 1\nkind = \"model\"\n[segment.a]\nat = [{x}, 0, 0]\n"))
    };
    let errors = document::read(both, &mut include).expect_err("a contradiction");
    assert!(errors[0].message.contains("`at` is also given by another included text"), "{errors}");
}
