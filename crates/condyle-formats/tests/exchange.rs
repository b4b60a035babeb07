//! Resolved models in JSON: what is kept, what is refused, and that no input breaks the reader.

#[allow(dead_code, reason = "the model crate's tests use more of it")]
#[path = "../../condyle-model/tests/random_models/grow.rs"]
mod grow;

use condyle_formats::{Content, Format, Id, exchange};
use condyle_math::Vec3;
use condyle_model::component::Rotate;
use condyle_model::{Law, Model, ModelBuilder};
use proptest::prelude::*;

/// Every kind of component once, as other authors get it.
const CONFORMANCE: &str = include_str!("../../../docs/exchange/conformance.json");

fn read(text: &str) -> Result<Model, String> {
    match exchange::read(text.as_bytes()) {
        Ok(read) => Ok(read.value),
        Err(error) => Err(error.to_string()),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn random_models_are_kept_to_the_last_bit(seed in any::<u64>()) {
        let (model, _) = grow::random_model_with_loops(seed);
        let text = exchange::write(&model);
        let again = exchange::read_with(text.as_bytes(), &grow::registry()).unwrap().value;
        prop_assert!(exchange::write(&again) == text, "seed {seed}");
        prop_assert!(again.segments() == model.segments(), "seed {seed}");
        prop_assert!(again.closures() == model.closures(), "seed {seed}");
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0usize..40, "[\\[\\]{}\",:0-9enul.\\-]{0,12}"), 1..4),
    ) {
        let mut text = CONFORMANCE.as_bytes().to_vec();
        for (at, length, put) in cuts {
            let at = at.index(text.len());
            let end = (at + length).min(text.len());
            text.splice(at..end, put.into_bytes());
        }
        let _ = exchange::read(&text);
    }
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    for (old, new, said) in [
        ("\"condyle_model\": 1", "\"condyle_model\": 2", "unknown version of resolved models"),
        (
            "\"kind\":\"shear\"",
            "\"kind\":\"sheer\"",
            "components[33].kind: unknown `sheer` (did you mean `shear`?)",
        ),
        (
            "\"coordinate\":\"line/reach\"",
            "\"coordinate\":\"line/raech\"",
            "unknown `line/raech` (did you mean `line/reach`?)",
        ),
        (
            "\"radii\":[0.07,0.15,0.09]",
            "\"radii\":[0.07,\"0.15\",0.09]",
            ".parameters.radii[1]: there is a text, not a number (give a number)",
        ),
        (
            "\"parent\":\"base\"",
            "\"parent\":\"bsae\"",
            "segments[1].parent: unknown `bsae` (did you mean `base`?)",
        ),
        ("\"up\": \"y\"", "\"up\": \"x\"", "up: unknown `x` (known are: y, z)"),
    ] {
        assert!(CONFORMANCE.contains(old), "{old}");
        let error = read(&CONFORMANCE.replacen(old, new, 1)).unwrap_err();
        assert!(error.contains(said), "{error}");
    }
    let twice = CONFORMANCE.replacen("\"name\":\"slide\"", "\"name\":\"hinge\"", 1);
    assert!(read(&twice).unwrap_err().contains("it is there twice"));
    // Keys that are not known, and the order of evaluation, are passed over.
    let more = CONFORMANCE.replacen("\n\"order\"", "\"author\": \"someone\", \"old_order\"", 1);
    assert!(exchange::write(&read(&more).unwrap()) == CONFORMANCE);
}

#[test]
fn many_small_objects_are_refused_before_they_are_made() {
    // 3 bytes each, and some 700 where they are parsed.
    let text = format!("{{\"condyle_model\": 1, \"segments\": [{}{{}}]}}", "{},".repeat(1 << 20));
    let error = read(&text).unwrap_err();
    assert!(error.contains("too many objects"), "{error}");
}

#[test]
fn a_name_that_is_there_twice_gets_a_number() {
    let mut b = ModelBuilder::new("arm");
    let [upper, fore] = ["upper", "fore"].map(|name| b.segment(name, None));
    let (set, angle) = b.hinge("arm", upper, "turn", Vec3::Z);
    let again = Law::Rotate(Rotate { axis: Vec3::X });
    let motion = b.component(set, "turn", again, vec![angle.into()]);
    b.output(set, fore, motion);
    let text = exchange::write(&b.build().unwrap());
    // The coordinate has the name, too.
    for path in ["arm/turn", "arm/turn_2", "arm/turn_3"] {
        assert!(text.contains(&format!("\"path\":\"{path}\"")), "{text}");
    }
    assert_eq!(exchange::write(&read(&text).unwrap()), text);
}

#[test]
fn models_and_poses_are_told_apart() {
    for (text, model) in [
        (CONFORMANCE, true),
        ("{\"flexion\": 0.5}", false),
        ("[{\"flexion\": 0.5}]", false),
        // Written by a program that sorts keys.
        ("{\"closures\": [], \"condyle_model\": 1}", true),
    ] {
        let format = Format::of_bytes(text.as_bytes()).unwrap();
        assert_eq!(format.id, Id::Poses);
        let content = format.read(text.as_bytes(), &mut |_| Err("alone".into())).unwrap().value;
        assert_eq!(matches!(content, Content::Model(_)), model, "{text:.40}");
    }
}
