//! What is wrong is said with its place, all at once.

use super::{errors, try_read};
use condyle_formats::document;
use proptest::prelude::*;

const HEAD: &str = "condyle = 1\nkind = \"model\"\n";

#[test]
fn many_errors_come_at_once_in_the_order_of_the_text() {
    let found = errors(
        "nmae = \"x\"\n[segment.a]\nparent = 3\nat = [1, 2]\n[segment.b]\nparent = \"zz\"\n\
         [joint.j]\ntype = \"hing\"\nsegment = \"b\"\n",
    );
    assert_eq!(
        found,
        [
            "line 3, column 1: unknown key `nmae` (did you mean `name`?)",
            "line 5, column 10: `parent` is a number (give a string)",
            "line 6, column 6: `at` has 2 numbers (give 3)",
            "line 8, column 10: unknown segment `zz` (name a segment of this model; omit it for \
             the \
             world)",
            "line 10, column 8: unknown type of joint `hing` (did you mean `hinge`?)",
        ]
    );
}

#[test]
fn what_the_builder_finds_has_a_place() {
    let found = errors(
        "[segment.a]\n[joint_set.j.coordinate.q]\nrange = [2, 1]\n\
         [joint_set.j.component.k.compensate]\nsegment = \"a\"\nancestors = [\"a\"]\n",
    );
    assert!(
        found[0].starts_with("line 4, column 25: coordinate `q` has a lower limit 2"),
        "{found:?}"
    );
    assert!(
        found[1].starts_with("line 6, column 24: port `ancestors` of component `k`"),
        "{found:?}"
    );
    let circle = errors(
        "[joint_set.j.component.a.map]\ninput = \"b\"\nfunction = 1\n\
         [joint_set.j.component.b.map]\ninput = \"a\"\nfunction = 2\n",
    );
    assert!(circle[0].starts_with("line "), "{circle:?}");
    assert!(circle[0].contains("j.a -> j.b -> j.a") || circle[0].contains("j.b -> j.a -> j.b"));
}

#[test]
fn an_error_stands_at_its_own_component_among_names_that_differ_by_case() {
    // `T` is whole and stands first; `t` weighs too much. Both joint sets have such a pair.
    let found = errors(
        "[segment.a]\n[segment.b]\nparent = \"a\"\n\
         [joint_set.j.component.T.compensate]\nsegment = \"b\"\nancestors = [\"a\"]\n\
         [joint_set.j.component.t.compensate]\nsegment = \"b\"\nancestors = [\"a\"]\nweight = 2\n\
         [joint_set.J.component.t.compensate]\nsegment = \"b\"\nancestors = [\"a\"]\n",
    );
    let place = "line 9, column 24: component `t` (compensate) of joint set `j` has the weight 2";
    assert!(found.len() == 1 && found[0].starts_with(place), "{found:?}");
}

#[test]
fn suggestions_are_sought_only_for_errors_that_are_kept() {
    // Each of 20 000 unknown parents compared with 20 000 names took two minutes.
    let segments: String =
        (0..20_000).map(|i| format!("[segment.bone_{i}]\nparent = \"bnoe_{i}\"\n")).collect();
    let start = std::time::Instant::now();
    let found = errors(&segments);
    let seconds = start.elapsed().as_secs_f64();
    assert_eq!(found.len(), 51);
    assert!(found[0].contains("unknown segment `bnoe_0` (did you mean `bone_0"), "{}", found[0]);
    assert_eq!(found[50], "and 19950 more errors");
    // Quadratic work takes over 100 s, so that even a busy machine tells the two apart.
    assert!(seconds < 5.0, "{seconds} s");
}

#[test]
fn ports_are_checked_by_type_and_name() {
    let found = errors(
        "[segment.s]\n[joint_set.hip.coordinate.flexion]\n[joint_set.knee.component.t.rotate]\n\
         angle = \"flexion\"\naxis = [0, 0, 1]\n[joint_set.knee.component.u.product]\n\
         factors = [\"hip.flexion\", \"t.2\", \"hip.flexoin\"]\n[joint_set.knee.output]\nz = \
         \"t\"\n",
    );
    assert_eq!(
        found,
        [
            "line 6, column 9: unknown name `flexion` (did you mean `hip.flexion`?)",
            "line 9, column 12: `hip.flexion` is a scalar, not a transform (name a component such \
             as rotate, translate or product)",
            "line 9, column 27: `t.2` names an output that does not exist (its outputs are \
             numbered from 1 to 1)",
            "line 9, column 34: unknown name `hip.flexoin` (did you mean `hip.flexion`?)",
            "line 11, column 1: unknown segment `z` (name a segment of this model; omit it for the \
             world)",
        ]
    );
}

#[test]
fn a_model_faces_along_an_axis() {
    let text = "condyle = 1\nkind = \"model\"\nfacing = \"-z\"\n[segment.head]\n[joint_set.face.coordinate.smile]\nkind = \"other\"\ndrives = \"mouth smile\"\n";
    let model = super::read(text);
    assert_eq!(model.facing().name(), "-z");
    assert_eq!(model.coordinates()[0].drives.as_deref(), Some("mouth smile"));
    let again = super::read(&condyle_formats::document::write(&model));
    assert_eq!((again.facing(), again.coordinates()), (model.facing(), model.coordinates()));
    // With z up a document names the axis that is meant, and the name of the world with y up is known.
    for name in ["-y", "+z"] {
        let text = text.replace("facing = \"-z\"", &format!("up = \"z\"\nfacing = \"{name}\""));
        let model = super::read(&text);
        assert_eq!(model.facing().name_in(model.up()), "-y");
        let written = condyle_formats::document::write(&model);
        assert!(written.contains("facing = \"-y\""), "{written}");
        assert_eq!(super::read(&written).facing(), model.facing());
    }
    let wrong = text.replace("-z", "-y");
    assert!(condyle_formats::document::read(&wrong, &mut |_| Err("alone".into())).is_err());
    let wrong = text.replace("-z", "forward");
    let error = condyle_formats::document::read(&wrong, &mut |_| Err("alone".into())).unwrap_err();
    assert_eq!(
        error[0].to_string(),
        "line 3, column 10: unknown direction `forward` (give the axis along which the character looks: \
         \"+x\", \"-x\", \"+z\" or \"-z\"; where z is up \"+y\" or \"-y\")"
    );
}

#[test]
fn the_head_says_what_a_document_is() {
    let one = |text: &str| try_read(text).unwrap_err()[0].to_string();
    assert!(one("").contains("begin with the lines `condyle = 1`"));
    assert!(one("condyle = 2").contains("version of the format"));
    assert!(one("condyle = 1").contains("kinds are: `model`, `limit`"));
    assert!(one("condyle = 1\nkind = \"limit\"").contains("of kind `limit`, not a model"));
    assert!(one("condyle = 1\nkind = \"modl\"").contains("did you mean `model`?"));
    assert!(one("condyle = 1\nkind = \"model\"\nkind = \"model\"").contains("duplicate key"));
}

#[test]
fn includes_are_told_apart() {
    let part = |name: &str| match name {
        "parts/arm.toml" => Ok(format!("{HEAD}include = [\"hand.toml\"]\n[segment.arm]\nat = 3\n")),
        "parts/hand.toml" => Ok(format!("{HEAD}include = [\"../main.toml\", \"arm.toml\"]\n")),
        "main.toml" => Ok(format!("{HEAD}[segment.deep]\n")),
        other => Err(format!("{other} is not there")),
    };
    let text = format!("{HEAD}include = [\"parts/arm.toml\", \"gone.toml\"]\n");
    let found = document::read(&text, &mut |name| part(name)).unwrap_err();
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert!(
        found[0].starts_with("line 3, column 12: parts/hand.toml:3:28: texts include each other")
    );
    assert!(found[0].contains("parts/arm.toml -> parts/hand.toml -> parts/arm.toml"), "{found:?}");
    assert!(found[1].starts_with("line 3, column 12: parts/arm.toml:5:6: `at` is a number"));
    assert!(found[2].contains("`gone.toml` cannot be included: gone.toml is not there"));
}

#[test]
fn depth_is_bounded() {
    for text in [
        format!("{HEAD}a = {}", "[".repeat(100_000)),
        format!("{HEAD}a = {}", "{a = ".repeat(100_000)),
        format!("{HEAD}{} = 1", vec!["a"; 100_000].join(".")),
        format!("{HEAD}[{}]", vec!["a"; 100_000].join(".")),
        format!("{HEAD}a = \"\n{}", "[".repeat(100_000)),
        format!("{HEAD}{}", "[a]\n".repeat(10_000)),
    ] {
        assert!(try_read(&text).is_err());
    }
}

#[test]
fn what_reads_a_broken_component_is_not_blamed() {
    let found = errors(
        "[segment.s]\n[joint_set.j.component.k.cone]\nangles = [\"q\"]\norder = \"zxy\"\n\
         rest = [0, 1, 0]\npoints = []\n[joint_set.j.component.t.rotate]\nangle = \"k.2\"\n\
         axis = [0, 0, 1]\n[joint_set.j.component.u.rotate]\nangle = \"j.k\"\naxis = [1, 0, 0]\n",
    );
    assert_eq!(
        found,
        [
            "line 5, column 10: `angles` has 1 names (give three angles, or two if the bone does \
             not twist)",
            "line 8, column 10: 0 points do not enclose an area (give at least 3, in order around \
             `rest`)",
        ]
    );
}

#[test]
fn what_reads_a_broken_joint_is_not_blamed() {
    let found = errors(
        "[segment.s]\n[joint.a]\ntype = \"euler\"\nsegment = \"s\"\n[joint_set.b.coordinate.q]\n\
         follows = \"a.first\"\n",
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("line 4, column 8: [joint.a] has no `order`"), "{found:?}");
}

#[test]
fn what_both_sides_share_is_told_once() {
    let found = errors(
        "mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n[segment.s_r]\n\
         [joint_set.j_r.component.k.compensate]\nsegment = \"s_r\"\nancestors = [\"rips\"]\n",
    );
    let once = "line 7, column 14: unknown segment `rips` (name a segment of this model; omit it for \
                the world)";
    assert_eq!(found, [once]);
}

#[test]
fn a_component_is_found_in_its_own_joint_set() {
    let found = errors(
        "[segment.a]\n[segment.b]\nparent = \"a\"\n\
         [joint_set.a.component.k.compensate]\nsegment = \"b\"\nancestors = [\"a\"]\n\
         [joint_set.b.component.k.compensate]\nsegment = \"b\"\nancestors = [\"a\"]\nweight = 2\n",
    );
    assert!(found[0].starts_with("line 9, column 24: component `k`"), "{found:?}");
}

#[test]
fn products_of_products_are_bounded() {
    let mut body = "[segment.s]\n[joint_set.j.component.p0.place]\nat = [1, 0, 0]\n".to_owned();
    for i in 1..64 {
        let last = i - 1;
        body += &format!(
            "[joint_set.j.component.p{i}.product]\nfactors = [\"p{last}\", \"p{last}\"]\n"
        );
    }
    body += "[joint_set.j.output]\ns = \"p63\"\n";
    assert!(errors(&body)[0].contains("products of products"));
}

proptest! {
    #[test]
    fn rendering_takes_any_place_and_any_text(
        text in "\\PC{0,40}(\n\\PC{0,300}){0,3}", line in 0usize..6, column in 0usize..400,
    ) {
        let said = condyle_formats::Diagnostic::warning("x/y", "odd")
            .at(condyle_formats::Place::at(line, column)).with_help("help");
        let shown = document::render("n", &text, &[said]);
        prop_assert!(shown.contains("odd") && shown.contains("help"));
    }

    #[test]
    fn any_text_is_read_without_a_panic(body in "([a-z\\[\\]{}=.,\"'#\n \
    $0-9-]|segment|joint_set|at = ){0,80}") {
        let text = format!("{HEAD}{body}");
        if try_read(&text).is_ok() {
            prop_assert_eq!(document::kind(&text), Some(document::Kind::Model));
        }
    }
}
