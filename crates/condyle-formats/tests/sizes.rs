//! Size groups of model documents: what is listed, what the mirror adds, that writing keeps them.

use condyle_formats::document;
use condyle_model::Model;

fn read(text: &str) -> Result<Model, Vec<String>> {
    let text = format!("condyle = 1\nkind = \"model\"\n{text}");
    let read = document::read(&text, &mut |_| Err("there is none".to_owned()));
    read.map(|read| read.value.model)
        .map_err(|errors| errors.iter().map(|e| e.message.clone()).collect())
}

/// The groups by name, with the names of their segments.
fn groups(model: &Model) -> Vec<(&str, Vec<&str>)> {
    let names = |ids: &[condyle_model::SegmentId]| -> Vec<&str> {
        ids.iter().map(|&id| model.segment(id).name.as_str()).collect()
    };
    model.size_groups().iter().map(|g| (g.name.as_str(), names(&g.segments))).collect()
}

const LEGS: &str = "mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n\
    segment = { pelvis = {}, femur_r = { parent = \"pelvis\" }, patella_r = { parent = \"femur_r\" } }\n";

#[test]
fn the_other_side_is_listed_too() {
    let model = read(&format!(
        "{LEGS}[size]\nbody = {{ segments = \"pelvis\" }}\nthigh = {{ segments = [\"femur_r\", \"patella_r\"] }}"
    ));
    let model = model.expect("two groups");
    let expected =
        [("body", vec!["pelvis"]), ("thigh", vec!["femur_r", "patella_r", "femur_l", "patella_l"])];
    assert_eq!(groups(&model), expected);
    let again = document::read(&document::write(&model), &mut |_| Err("alone".to_owned()));
    assert_eq!(again.expect("what was written").value.model, model);
}

#[test]
fn a_side_that_is_listed_itself_stays_where_it_is() {
    let sizes = "[size.right]\nsegments = [\"femur_r\"]\n[size.left]\nsegments = [\"femur_l\"]\n";
    let model = read(&format!("{LEGS}{sizes}")).expect("a group a side");
    assert_eq!(groups(&model), [("right", vec!["femur_r"]), ("left", vec!["femur_l"])]);
}

#[test]
fn what_is_listed_twice_is_refused() {
    let refused = |sizes: &str| read(&format!("{LEGS}{sizes}")).expect_err(sizes);
    let twice = "[size.thigh]\nsegments = [\"femur_r\", \"femur_r\"]";
    // Its other side is brought twice as well.
    assert_eq!(refused(twice)[0], "segment `femur_r` is listed twice");
    let both = "[size.a]\nsegments = [\"pelvis\"]\n[size.b]\nsegments = [\"pelvis\"]";
    assert_eq!(refused(both), ["segment `pelvis` is also in size group `a`"]);
    assert_eq!(refused("[size.a]\nsegments = [\"toes_r\"]"), ["unknown segment `toes_r`"]);
}
