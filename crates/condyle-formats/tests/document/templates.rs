//! What templates give is what the same tables give, written out.

use super::{errors, read, try_read};
use condyle_formats::document::{self, names};
use proptest::prelude::*;

const HEAD: &str = "condyle = 1\nkind = \"model\"\n";

fn with_head(body: &str) -> String {
    format!("{HEAD}{body}")
}

/// A column of two vertebrae with every use of a parameter.
const COLUMN: &str = r#"
angles = "deg"
constants = { gap = 0.002, height = 9 }

[template.vertebra]
parameters = ["name", "below", "level", "height", "turn", "range", "law"]
defaults = { range = [-5, "none"], law = { linear = [0.5, 0] } }
instances = [
    ["l2", "l3", 2, -0.0368, [0, 0, -7]],
    { name = "l1", below = "l2", level = 1, height = "2 * $gap", turn = [0, 0, "3 * $gap"], law = 0.25, range = [-1, 1] },
]

[template.vertebra.segment]
"{name}" = { parent = "{below}", at = [0, "-$height - 0.5 * $gap", "$height"], turn = "$turn" }

[template.vertebra.joint_set.spine.coordinate]
"{name}_q" = { range = "$range", source = "page {level} of {{x}}, $gap" }

[template.vertebra.joint_set.spine.component]
"share_{level}".map = { input = "{name}_q", functions = [{ linear = [1, 0] }, "$law"] }
"{name}_turn".rotate = { angle = "share_{level}.2", axis = [0, 0, -1] }

[template.vertebra.joint_set.spine.output]
"{name}" = ["{name}_turn"]

[template.vertebra.marker]
"{name}_{below}" = { segment = "$name", at = [0, 0, "$level"] }
"#;

const WRITTEN_OUT: &str = r#"
angles = "deg"
[segment.l3]
[segment.l2]
parent = "l3"
at = [0, 0.0358, -0.0368]
turn = [0, 0, -7]
[segment.l1]
parent = "l2"
at = [0, -0.005, 0.004]
turn = [0, 0, 0.006]
[joint_set.spine.coordinate.l2_q]
range = [-5, "none"]
source = "page 2 of {x}, $gap"
[joint_set.spine.coordinate.l1_q]
range = [-1, 1]
source = "page 1 of {x}, $gap"
[joint_set.spine.component.share_2.map]
input = "l2_q"
functions = [{ linear = [1, 0] }, { linear = [0.5, 0] }]
[joint_set.spine.component.l2_turn.rotate]
angle = "share_2.2"
axis = [0, 0, -1]
[joint_set.spine.component.share_1.map]
input = "l1_q"
functions = [{ linear = [1, 0] }, 0.25]
[joint_set.spine.component.l1_turn.rotate]
angle = "share_1.2"
axis = [0, 0, -1]
[joint_set.spine.output]
l2 = "l2_turn"
l1 = "l1_turn"
[marker.l2_l3]
segment = "l2"
at = [0, 0, 2]
[marker.l1_l2]
segment = "l1"
at = [0, 0, 1]
"#;

#[test]
fn an_instance_is_its_template_with_its_values() {
    let text = with_head(&format!("{COLUMN}[segment.l3]\n"));
    let found = try_read(&text).unwrap();
    assert_eq!(found.warnings, []);
    assert_eq!(found.value.model, read(&with_head(WRITTEN_OUT)));
}

#[test]
fn what_the_document_says_itself_is_kept() {
    let own = "[segment.l3]\n[segment.l2]\nat = [1, 2, 3]\njoint_at = [4, 5, 6]\n\
               [joint_set.spine.coordinate.l1_q]\nrange = [-2, 2]\nlocked = true\n";
    let model = read(&with_head(&format!("{COLUMN}{own}")));
    let l2 = model.segment(model.find_segment("l2").unwrap());
    assert_eq!(l2.joint_in_parent.translation.to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(l2.joint_in_segment.translation.to_array(), [4.0, 5.0, 6.0]);
    // The turn of the template stays.
    let tilt = l2.joint_in_parent.linear.at(1, 0).asin().to_degrees();
    assert!((tilt + 7.0).abs() < 1e-12, "{tilt}");
    let l1 = model.coordinates().iter().find(|c| c.name == "l1_q").unwrap();
    assert!(l1.locked && l1.range.upper == Some(2f64.to_radians()));
    assert_eq!(l1.source.as_deref(), Some("page 1 of {x}, $gap"));
}

#[test]
fn the_other_side_is_mirrored_from_instances() {
    let fingers = r#"
mirror = { plane = "z", from = "_r", to = "_l" }
[template.finger]
parameters = "name"
instances = ["index", "ring"]
[template.finger.segment]
"{name}_r" = { parent = "hand_r", at = [0.1, 0, 0.02] }
[template.finger.joint."{name}_r"]
type = "hinge"
segment = "{name}_r"
axis = [0, 1, 0]
coordinates = ["{name}_r"]
[segment.hand_r]
"#;
    let model = read(&with_head(fingers));
    let there = |name: &str| model.segment(model.find_segment(name).unwrap()).joint_in_parent;
    assert_eq!(there("ring_l").translation.to_array(), [0.1, 0.0, -0.02]);
    assert_eq!(model.coordinates().len(), 4);
}

/// A template in degrees whose rows stand in a document in radians.
#[test]
fn an_included_template_gets_its_rows_from_the_document() {
    let part = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\n[template.bone]\n\
                parameters = [\"name\", \"tilt\", \"turn\"]\n[template.bone.segment.\"{name}\"]\n\
                turn = [0, 0, \"$tilt\"]\njoint_turn = \"$turn\"\nparent = \"{name}_of\"\n";
    let text = with_head(
        "include = \"bone.toml\"\n[template.bone]\ninstances = [[\"a\", 90, [0, 0, 90]]]\n",
    );
    let mut include = |_: &str| Ok(part.to_owned());
    let errors = document::read(&text, &mut include).unwrap_err();
    assert_eq!(
        errors[0].to_string(),
        "line 3, column 11: bone.toml:9:10: unknown segment `a_of`, in instance `a` of template \
         `bone` (line 5) (name a segment of this model; omit it for the world)"
    );
    let model = document::read(&format!("{text}[segment.a_of]\n"), &mut include).unwrap();
    let model = model.value.model;
    let bone = model.segment(model.find_segment("a").unwrap());
    for frame in [bone.joint_in_parent, bone.joint_in_segment] {
        assert!((frame.linear.at(1, 0) - 1.0).abs() < 1e-15, "{frame:?}");
    }
}

#[test]
fn rows_of_an_included_text_are_named_with_their_file() {
    let part = "condyle = 1\nkind = \"model\"\n[template.bone]\nparameters = [\"name\", \"below\"]\n\
                instances = [[\"a\", \"b\"]]\n[template.bone.segment.\"{name}\"]\n\
                parent = \"$below\"\nat = [0, 1]\n";
    let text = with_head("include = \"bone.toml\"\n");
    let errors = document::read(&text, &mut |_| Ok(part.to_owned())).unwrap_err();
    let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "line 3, column 11: bone.toml:8:6: `at` has 2 numbers, in instance `a` of template \
             `bone` (bone.toml:5) (give 3)",
            "line 3, column 11: bone.toml:5:20: unknown segment `b`, which is `below` of template \
             `bone` (bone.toml:7) (name a segment of this model; omit it for the world)",
        ]
    );
}

#[test]
fn what_is_not_used_is_warned_of() {
    let text = with_head(
        "[template.a]\nparameters = [\"name\", \"size\"]\ninstances = [[\"x\", 1]]\n\
         [template.a.segment.\"{name}\"]\n[template.b]\nparameters = [\"name\"]\n\
         [template.b.segment.\"{name}\"]\n",
    );
    let warnings = try_read(&text).unwrap().warnings;
    let said: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "line 4, column 23: template `a` does not use `size` (write \"$size\" for its value, \
             {size} in a name)",
            "line 7, column 11: template `b` has no instances (list them as `instances`: a row of \
             values for each)",
        ]
    );
}

/// Names that only some rows get wrong are told apart, up to three; a mistake of the template is told
/// once, whatever the number of rows.
#[test]
fn mistakes_of_rows_and_of_templates_are_told_apart() {
    let rows = |count: usize, wrong: usize| -> String {
        (0..count).map(|i| format!("[{i}, {}],", if i < wrong { "true" } else { "1" })).collect()
    };
    let body = |count, wrong| {
        format!(
            "[template.a]\nparameters = [\"n\", \"x\"]\ninstances = [{}]\n\
             [template.a.segment.\"s{{n}}\"]\nat = [0, 0, \"2 * $x\"]\n",
            rows(count, wrong)
        )
    };
    let found = errors(&body(500, 5));
    assert_eq!(found.len(), 4);
    let second = "line 7, column 13: `$x` is a boolean, not a number, in instance `1` of template \
                  `a` (line 5) (give a number in the instance)";
    assert_eq!(found[1], second);
    assert_eq!(found[3], "and 2 more errors");
    let found = errors(&body(500, 500));
    let every = "line 7, column 13: `$x` is a boolean, not a number, in every instance of template \
                 `a` (give a number in the instance)";
    assert_eq!(found, [every]);
}

/// Every placeholder repeats a name of 10 000 letters: 200 rows would give 400 MB.
#[test]
fn the_size_of_all_instances_is_bounded() {
    let name = "n".repeat(10_000);
    let rows: String = (0..200).map(|i| format!("[{i}, \"{name}\"],")).collect();
    let uses: String =
        (0..200).map(|i| format!("[template.a.segment.\"{{a}}_{{b}}_{i}\"]\n")).collect();
    let body = format!("[template.a]\nparameters = [\"a\", \"b\"]\ninstances = [{rows}]\n{uses}");
    let found = errors(&body);
    let said = "line 3, column 11: the instances of template `a` are too large (write fewer, or \
                shorter names: all have at most 16777216 bytes)";
    assert_eq!(found, [said]);
    // One list that is given as a whole is counted wherever it is used.
    let list = format!("[{}]", "1, ".repeat(50_000));
    let uses: String =
        (0..10).map(|i| format!("[template.a.segment.s{i}]\nat = \"$list\"\n")).collect();
    let body = format!("[template.a]\nparameters = [\"list\"]\ninstances = [[{list}]]\n{uses}");
    assert!(errors(&body)[0].contains("too large"));
}

#[test]
fn saving_keeps_templates_and_changing_fills_them_in() {
    let text = with_head(&format!(
        "{COLUMN}[segment.l3]\n[size]\nall = {{ segments = [\"l1\", \"l2\"] }}\n"
    ));
    let document = try_read(&text).unwrap().value;
    assert_eq!(document.text, text);
    let scaled = document.model.scaled(&[1.25, 1.25, 1.25]);
    assert_ne!(scaled, document.model);
    for model in [document.model, scaled] {
        let written = document::write(&model);
        assert!(!written.contains("template") && !written.contains("$height"), "{written}");
        let again = read(&written);
        assert_eq!(again.markers(), model.markers());
        assert_eq!(again.segments().len(), model.segments().len());
        for (a, b) in again.segments().iter().zip(model.segments()) {
            assert_eq!(a.joint_in_parent.translation, b.joint_in_parent.translation);
        }
    }
}

#[test]
fn other_kinds_of_documents_have_no_templates() {
    let text = "condyle = 1\nkind = \"names\"\n[template.a]\nparameters = []\n";
    let errors = names::read(text, &mut |_| Err(String::new())).unwrap_err();
    assert_eq!(errors.iter().count(), 1);
    assert!(errors[0].to_string().starts_with("line 3, column 2: unknown key `template`"));
}

proptest! {
    /// Any strings in the place of names, values and uses: no panic, and every error has a line.
    #[test]
    fn any_template_is_read(
        parameters in prop::collection::vec("[ab{}$.]{0,3}", 0..3),
        cells in prop::collection::vec(prop::sample::select(vec![
            "1", "\"a\"", "\"$b\"", "[1, 2, 3]", "{ a = 1 }", "true", "\"2 * $c\"", "nan", "1979-05-27",
        ]), 0..6),
        key in "[ab{}$]{0,8}",
        value in "[ab{}$* -]{0,8}",
    ) {
        let list = |items: &[String]| format!("[{}]", items.join(", "));
        let names: Vec<String> = parameters.iter().map(|p| format!("\"{p}\"")).collect();
        let rows: Vec<String> = cells.chunks(2).map(|row| format!("[{}]", row.join(", "))).collect();
        let loose: Vec<String> = cells.iter().map(|&cell| cell.to_owned()).collect();
        for rows in [list(&rows), list(&loose)] {
            let text = with_head(&format!(
                "constants = {{ c = 2 }}\n[template.t]\nparameters = {}\ninstances = {rows}\n\
                 [template.t.segment.\"{key}\"]\nparent = \"{value}\"\nat = [\"{value}\", \"$a\", 0]\n\
                 turn = \"$b\"\n[template.t.marker.\"{key}{{a}}\"]\nat = \"$a\"\n[segment.a]\n",
                list(&names),
            ));
            if let Err(errors) = try_read(&text) {
                prop_assert!(errors.iter().all(|e| e.place.is_some_and(|p| p.line > 0)), "{errors}");
            }
        }
    }
}
