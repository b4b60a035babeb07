//! Numbers that are not plain: constants, includes, templates, mirrored sides, shipped models.

use super::{apart, path, posed};
use condyle::formats::document::edit::{Editing, Origin, Refused, WayKind};
use condyle::{Mode, shipped};

const LEG: &str = r#"condyle = 1
kind = "model"
angles = "deg"
constants = { thigh = 0.42, half = "0.5 * $thigh" } # of one person
mirror = { plane = "z", from = "_r", to = "_l" }

[segment.femur_r]
at = [0.00, -0.066, 0.083] # 83 mm to the right
[segment.tibia_r]
parent = "femur_r"
at = [0, "-$thigh", 0]
turn = [0, 12.50, 0]
[segment.patella_r]
parent = "femur_r"
at = ["0.05 * $thigh", "-2 * $half + 0.01", 0]

[joint.knee_r]
type = "hinge"
segment = "tibia_r"
axis = [0, 0, -1]
coordinates = ["knee_r"]
coordinate.knee_r = { range = [0.0, 140], default = 5 }
"#;

fn leg() -> Editing {
    Editing::read("leg.toml", LEG, &mut |_| Err("none".into()), &|_| true).unwrap()
}

/// What an edit makes of the text.
fn set(editing: &Editing, at: &str, value: f64, way: Option<WayKind>) -> String {
    editing
        .set(&path(at), value, way)
        .unwrap_or_else(|why| panic!("{at}: {why}"))
        .next
        .text()
        .to_owned()
}

#[test]
fn values_have_the_units_of_their_text_and_say_where_they_are() {
    let leg = leg();
    let found = |at: &str| {
        let value = leg.find(&path(at)).unwrap_or_else(|| panic!("{at}"));
        (value.value, value.unit, value.line, value.column, value.origin.name())
    };
    assert_eq!(found("segment.femur_r.at.2"), (0.083, "m", 8, 21, "plain"));
    assert_eq!(found("segment.tibia_r.turn.1"), (12.5, "deg", 12, 12, "plain"));
    assert_eq!(found("segment.tibia_r.at.1"), (-0.42, "m", 11, 10, "constant"));
    assert_eq!(found("joint.knee_r.coordinate.knee_r.range.1"), (140.0, "deg", 22, 37, "plain"));
    assert_eq!(found("constants.thigh"), (0.42, "", 4, 23, "plain"));
    // 2 * 0.5 * 0.42 - 0.01 below.
    assert!((leg.find(&path("segment.patella_r.at.1")).unwrap().value + 0.41).abs() < 1e-15);
}

#[test]
fn an_expression_keeps_its_constant_unless_another_way_is_named() {
    let leg = leg();
    // 0.0294 = 0.07 * 0.42.
    let text = set(&leg, "segment.patella_r.at.0", 0.0294, None);
    assert_eq!(text, LEG.replace("\"0.05 * $thigh\"", "\"0.07 * $thigh\""));
    let text = set(&leg, "segment.patella_r.at.0", 0.0225, Some(WayKind::Constant));
    assert_eq!(text, LEG.replace("thigh = 0.42", "thigh = 0.45"));
    let text = set(&leg, "segment.patella_r.at.0", 0.03, Some(WayKind::Number));
    assert_eq!(text, LEG.replace("\"0.05 * $thigh\"", "0.03"));
    // The term that stands alone: -0.42 + 0.02.
    let text = set(&leg, "segment.patella_r.at.1", -0.40, None);
    assert_eq!(text, LEG.replace("+ 0.01\"", "+ 0.02\""));
    // Over the definition of another constant.
    let text = set(&leg, "segment.patella_r.at.1", -0.49, Some(WayKind::Constant));
    assert_eq!(text, LEG.replace("thigh = 0.42", "thigh = 0.5"));
    // What is a share of a constant does not change the constant unless that is asked for: it comes last.
    let ways = &leg.find(&path("segment.patella_r.at.0")).unwrap().ways;
    let kinds: Vec<_> = ways.iter().map(|way| way.kind).collect();
    assert_eq!(kinds, [WayKind::Factor, WayKind::Number, WayKind::Constant]);
    // A constant alone has no number of its own, and says what else follows.
    let ways = &leg.find(&path("segment.tibia_r.at.1")).unwrap().ways;
    assert_eq!(ways[0].kind, WayKind::Constant);
    assert_eq!(
        ways[0].sentence,
        "writes constant `thigh` (leg.toml:4), which 3 other numbers follow, too"
    );
    assert_eq!(
        ways[1].sentence,
        "writes a number in place of \"-$thigh\" at leg.toml:11, which then no longer follows thigh"
    );
}

#[test]
fn the_mirrored_side_follows_and_is_set_on_the_written_one() {
    let leg = leg();
    let left = path("segment.femur_l.at.2");
    assert!(leg.is_mirrored(&left) && !leg.is_mirrored(&path("segment.femur_r.at.2")));
    let edited = leg.set(&left, 0.09, None).unwrap();
    assert_eq!(edited.next.text(), LEG.replace("0.083", "0.09"));
    assert_eq!(edited.mirrored, [left]);
    let model = &edited.next.document().model;
    let z = |name: &str| {
        let pose = posed(model, Mode::Open);
        pose.iter().find(|(n, _)| n == name).unwrap().1[11]
    };
    assert_eq!((z("femur_r"), z("femur_l")), (0.09, -0.09));
    let coordinate = path("joint.knee_l.coordinate.knee_l.range.1");
    assert_eq!(
        set(&leg, "joint.knee_l.coordinate.knee_l.range.1", 150.0, None),
        LEG.replace("140", "150")
    );
    assert!(leg.is_mirrored(&coordinate));
}

#[test]
fn what_could_not_be_read_any_more_is_refused_with_its_place() {
    let leg = leg();
    let Err(Refused::Fault { error, text, .. }) =
        leg.set(&path("joint.knee_r.coordinate.knee_r.range.1"), -150.0, None)
    else {
        panic!("a range that ends below where it begins")
    };
    assert!(text.contains("[0.0, -150]"));
    assert_eq!(error[0].place.unwrap().line, 22);
    let far = leg.set(&path("segment.tibia_r.at.7"), 1.0, None).unwrap_err();
    assert_eq!(far.to_string(), "there is no number `segment.tibia_r.at[7]`");
    assert!(leg.set(&path("segment.tibia_r.at.0"), f64::NAN, None).is_err());
}

#[test]
fn a_value_that_stays_keeps_its_digits() {
    assert_eq!(set(&leg(), "segment.tibia_r.turn.1", 12.5, None), LEG);
}

#[test]
fn included_values_change_in_their_file_or_in_a_line_of_the_document() {
    let root = "condyle = 1\nkind = \"model\"\nangles = \"rad\"\ninclude = [\"leg.toml\"]\n";
    let mut include = |_: &str| Ok(LEG.to_owned());
    let editing = Editing::read("whole.toml", root, &mut include, &|_| true).unwrap();
    let turn = path("segment.tibia_r.turn.1");
    let value = editing.find(&turn).unwrap();
    assert_eq!((value.value, value.unit, value.file.as_str()), (12.5, "deg", "leg.toml"));
    assert_eq!(value.origin, Origin::Include);
    let in_file = editing.set(&turn, 90.0, None).unwrap();
    assert_eq!(in_file.next.source("leg.toml").unwrap().text, LEG.replace("12.50", "90"));
    assert_eq!(in_file.next.text(), root);
    // The document's own angles are radians: a right angle is pi / 2.
    let over = editing.set(&turn, 90.0, Some(WayKind::Override)).unwrap();
    let line = "\n[segment.tibia_r]\nturn = [0, 1.5707963267948966, 0]\n";
    assert_eq!(over.next.text(), format!("{root}{line}"));
    let (a, b) = (
        posed(&in_file.next.document().model, Mode::Posed),
        posed(&over.next.document().model, Mode::Posed),
    );
    assert!(apart(&a, &b) < 1e-15);
    // What stands in its place is a number of the document itself from then on.
    let again = over.next.set(&turn, 1.5, None).unwrap();
    assert_eq!(again.next.text(), format!("{root}{}", line.replace("1.5707963267948966", "1.5")));
    // Expressions are copied as they are.
    let at = over.next.set(&path("segment.tibia_r.at.2"), 0.001, Some(WayKind::Override)).unwrap();
    assert!(at.next.text().contains("at = [0, \"-$thigh\", 0.001]"), "{}", at.next.text());
}

#[test]
fn values_of_templates_change_in_their_row_or_in_all_instances_or_in_one() {
    let text = r#"condyle = 1
kind = "model"
[template.disc]
parameters = ["name", "below", "height"]
instances = [
    ["l3", "pelvis", 0.0368],
    ["l2", "l3", 0.0360], # thinner
]
[template.disc.segment]
"{name}" = { parent = "{below}", at = [0.01, "$height", "-0.5 * $height"] }
[segment.pelvis]
"#;
    let editing =
        Editing::read("spine.toml", text, &mut |_| Err("none".into()), &|_| true).unwrap();
    assert_eq!(set(&editing, "segment.l2.at.1", 0.04, None), text.replace("0.0360", "0.04"));
    assert_eq!(set(&editing, "segment.l2.at.0", 0.02, None), text.replace("[0.01", "[0.02"));
    assert_eq!(set(&editing, "segment.l3.at.2", -0.0092, None), text.replace("-0.5 *", "-0.25 *"));
    assert_eq!(
        set(&editing, "segment.l3.at.2", -0.02, Some(WayKind::Row)),
        text.replace("0.0368", "0.04")
    );
    assert_eq!(
        set(&editing, "segment.l2.at.0", 0.02, Some(WayKind::Override)),
        format!("{text}\n[segment.l2]\nat = [0.02, 0.0360, -0.018]\n")
    );
    let ways = &editing.find(&path("segment.l2.at.0")).unwrap().ways;
    assert_eq!(
        ways[0].sentence,
        "changes template `disc` itself (spine.toml:10), in all 2 instances"
    );
}

#[test]
fn lines_that_stand_in_place_of_shipped_values_change_the_model_as_its_own_text_would() {
    let mut count = 0;
    for name in shipped::names().filter(|name| *name != "human") {
        let root =
            format!("condyle = 1\nkind = \"model\"\nangles = \"deg\"\ninclude = [\"{name}\"]\n");
        let editing = Editing::read("mine.toml", &root, &mut super::part, &|_| false).unwrap();
        let own = super::shipped_as_own(name);
        for value in editing.values().iter().step_by(29) {
            assert_eq!(value.origin, Origin::Shipped);
            let Some(way) = value.ways.iter().find(|way| way.kind == WayKind::Override) else {
                continue;
            };
            let new = if value.value == 0.0 { 0.002 } else { value.value * 1.002 };
            let told = format!("{name}: {:?}, which {}", value.path, way.sentence);
            let own_way = own
                .find(&value.path)
                .unwrap()
                .ways
                .iter()
                .map(|way| way.kind)
                .find(|kind| matches!(kind, WayKind::Here | WayKind::File | WayKind::Number));
            let Some(own_way) = own_way else { continue };
            let over = match editing.set(&value.path, new, Some(way.kind)) {
                Ok(over) => over,
                Err(Refused::Fault { .. }) => continue,
                Err(why) => panic!("{told}: {why}"),
            };
            let own =
                own.set(&value.path, new, Some(own_way)).unwrap_or_else(|e| panic!("{told}: {e}"));
            for mode in [Mode::Posed, Mode::Open] {
                let (a, b) = (&over.next.document().model, &own.next.document().model);
                assert!(apart(&posed(a, mode), &posed(b, mode)) < 1e-12, "{told}");
            }
            assert!(over.next.text().starts_with(&root), "{told}");
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
}

#[test]
fn wires_components_and_segments_are_added_where_they_belong() {
    let text = "condyle = 1\r\nkind = \"model\"\r\n[segment.arm]\r\n[joint_set.elbow.coordinate]\r\nbend = { range = [0, 2] } # radians\r\n[joint_set.elbow.component]\r\nturn.rotate = { angle = \"bend\", axis = [0, 0, 1] }\r\n[joint_set.elbow.output]\r\narm = \"turn\"\r\n";
    let editing = Editing::read("arm.toml", text, &mut |_| Err("none".into()), &|_| true).unwrap();
    let keys = |path: &str| path.split('.').map(str::to_owned).collect::<Vec<_>>();
    // A new component beside others, then the wire from it.
    let half = "{ input = \"bend\", function = { linear = [0.5, 0] } }";
    let added = editing.put(&keys("joint_set.elbow.component.half.map"), half).unwrap();
    let expected = format!("\r\n[joint_set.elbow.component.half]\r\nmap = {half}\r\n");
    assert_eq!(added.next.text(), format!("{text}{expected}"));
    let wired =
        added.next.put(&keys("joint_set.elbow.component.turn.rotate.angle"), "\"half\"").unwrap();
    assert_eq!(
        wired.next.text(),
        added.next.text().replace("angle = \"bend\"", "angle = \"half\"")
    );
    assert_eq!((wired.change.old.as_str(), wired.change.new.as_str()), ("\"bend\"", "\"half\""));
    // A key into a table that is there, in braces or not.
    let source = editing.put(&keys("joint_set.elbow.coordinate.bend.source"), "\"me\"").unwrap();
    assert_eq!(source.next.text(), text.replace("[0, 2] }", "[0, 2], source = \"me\" }"));
    let more = editing
        .put(
            &keys("joint_set.elbow.component.more.combine"),
            "{ inputs = [\"bend\"], function = { slopes = [1] } }",
        )
        .unwrap();
    let intercept = more
        .next
        .put(&keys("joint_set.elbow.component.more.combine.function.intercept"), "0.1")
        .unwrap();
    assert!(intercept.next.text().ends_with("function = { slopes = [1], intercept = 0.1 } }\r\n"));
    let parent = editing.put(&keys("segment.arm.at"), "[0, 1, 0]").unwrap();
    assert!(
        parent.next.text().contains("[segment.arm]\r\nat = [0, 1, 0]"),
        "{}",
        parent.next.text()
    );
    // What is wrong is refused: an unknown port, a table that is there, no TOML.
    let wrong = editing.put(&keys("joint_set.elbow.component.turn.rotate.angle"), "\"none\"");
    assert!(matches!(wrong, Err(Refused::Fault { .. })));
    assert!(matches!(editing.put(&keys("segment.arm"), "{}"), Err(Refused::Impossible(_))));
    assert!(matches!(
        editing.put(&keys("segment.arm.at"), "[0, 1\nx = 2"),
        Err(Refused::Impossible(_))
    ));
}
