//! write, then read: the same model, to the last number of its parts.

use super::{grow, pose_in, read};
use condyle_formats::document;
use condyle_formats::opensim::model as osim;
use condyle_math::function::{Curve, PiecewiseLinear};
use condyle_math::{Affine, Vec3};
use condyle_model::model::Condition;
use condyle_model::{Closure, Law, Mode, Model, ModelBuilder, Range, UpAxis};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

/// Texts and numbers of what `Debug` prints, in turns: a text, a number, a text, and so on.
fn parted(printed: &str) -> (Vec<&str>, Vec<f64>) {
    let (mut texts, mut numbers) = (vec![], vec![]);
    let (mut start, mut at) = (0, 0);
    let bytes = printed.as_bytes();
    while at < bytes.len() {
        let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
        let first = digit(at) || bytes[at] == b'-' && digit(at + 1);
        let within =
            at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || b"_.".contains(&bytes[at - 1]));
        if !first || within {
            at += 1;
            continue;
        }
        let end = (at + 1..bytes.len())
            .find(|&end| !(digit(end) || b".e-".contains(&bytes[end])))
            .unwrap_or(bytes.len());
        if let Ok(number) = printed[at..end].parse() {
            texts.push(&printed[start..at]);
            numbers.push(number);
            start = end;
        }
        at = end;
    }
    texts.push(&printed[start..]);
    (texts, numbers)
}

/// Every field of two models: what is no number is the same, numbers to rounding. Frames are angles in the text, and
/// directions are made of length 1 again.
fn every_field(a: &Model, b: &Model, what: &str) {
    let printed = [format!("{a:?}"), format!("{b:?}")];
    let [(texts, numbers), (other_texts, others)] = [parted(&printed[0]), parted(&printed[1])];
    for (place, (a, b)) in texts.iter().zip(&other_texts).enumerate() {
        let before = texts[place.saturating_sub(30)..place].concat();
        assert_eq!(a, b, "{what}, behind {before}");
    }
    assert_eq!(numbers.len(), others.len(), "{what}");
    for (place, (a, b)) in numbers.iter().zip(&others).enumerate() {
        let near = (a - b).abs() <= 1e-12 * (1.0 + a.abs());
        let before = texts[place.saturating_sub(30)..=place].concat();
        assert!(near, "{what}: {a} and {b}, behind {before}");
    }
}

#[test]
fn a_field_that_differs_is_seen() {
    assert_eq!(
        parted("a_1: [-1.5e-3, x2], b: 7"),
        (vec!["a_1: [", ", x2], b: ", ""], vec![-1.5e-3, 7.0])
    );
    let one = |x: f64| {
        let mut b = ModelBuilder::new("one");
        let a = b.segment("a", None);
        b.marker("m", Some(a), Vec3::new(0.1, x, 0.3));
        b.build().unwrap()
    };
    every_field(&one(0.2), &one(0.2 + 1e-14), "rounding");
    assert!(std::panic::catch_unwind(|| every_field(&one(0.2), &one(0.2 + 1e-9), "")).is_err());
}

/// Every field, and poses.
fn same(a: &Model, b: &Model, stored: &[f64], what: &str) {
    every_field(a, b, what);
    same_but_names(a, b, stored, what);
}

/// Names, order, ranges, locks, couplings, markers and loops are kept exactly, poses to rounding.
fn same_but_names(a: &Model, b: &Model, stored: &[f64], what: &str) {
    assert_eq!(a.name(), b.name(), "{what}");
    assert_eq!((a.up(), a.facing()), (b.up(), b.facing()), "{what}");
    assert_eq!(a.joint_sets(), b.joint_sets(), "{what}");
    assert_eq!(a.coordinates(), b.coordinates(), "{what}");
    assert_eq!(a.markers(), b.markers(), "{what}");
    assert_eq!(a.postures(), b.postures(), "{what}");
    assert_eq!(a.closures().len(), b.closures().len(), "{what}");
    for (a, b) in a.closures().iter().zip(b.closures()) {
        assert_eq!(a.condition.rows(), b.condition.rows(), "{what}");
        if !matches!(a.condition, Condition::Frames { .. }) {
            assert_eq!(a.condition, b.condition, "{what}");
        }
    }
    assert_eq!(a.segments().len(), b.segments().len(), "{what}");
    for (a, b) in a.segments().iter().zip(b.segments()) {
        assert_eq!((&a.name, a.parent, a.joint_set), (&b.name, b.parent, b.joint_set), "{what}");
    }
    assert_eq!(a.components().len(), b.components().len(), "{what}");
    for (a, b) in a.components().iter().zip(b.components()) {
        assert_eq!(a.law.kind(), b.law.kind(), "{what}");
        // These are kept to the last number; others hold directions that are made of length 1.
        if let Law::Cone(_) | Law::Custom(_) | Law::Curve(_) = a.law {
            assert_eq!((&a.law, &a.inputs), (&b.law, &b.inputs), "{what}: {}", a.name);
        }
    }
    for mode in [Mode::Open, Mode::Posed] {
        let (a, b) = (pose_in(mode, a, stored), pose_in(mode, b, stored));
        for (index, (a, b)) in a.iter().zip(b).enumerate() {
            for (a, b) in a.iter().zip(b) {
                let near = (a - b).abs() <= 1e-12 * (1.0 + a.abs());
                assert!(near || !a.is_finite(), "{what}: {mode:?}, segment {index}: {a} and {b}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn random_models_are_kept(seed in any::<u64>()) {
        let (model, stored) = grow::random_model_with_loops(seed);
        let text = document::write(&model);
        let again = read(&text);
        same(&model, &again, &stored, &format!("seed {seed}"));
        // What was written once is written the same again.
        prop_assert_eq!(document::write(&again).lines().count(), text.lines().count());
    }
}

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            models(&path, found);
        } else if path.extension().is_some_and(|e| e == "osim") {
            found.push(path);
        }
    }
}

#[test]
fn models_of_opensim_are_kept() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        println!("skipped: shared data absent");
        return;
    }
    let mut found = vec![];
    models(&folder, &mut found);
    let mut kept = 0;
    for path in found {
        let Ok(model) = osim::read(&std::fs::read(&path).unwrap()) else { continue };
        let model = model.value;
        let again = read(&document::write(&model));
        // Away from the defaults, each coordinate by another amount.
        let moved: Vec<f64> = model
            .defaults()
            .iter()
            .enumerate()
            .map(|(i, v)| v + 0.1 * ((i * 7 % 11) as f64 - 5.0) / 5.0)
            .collect();
        let name = path.file_name().unwrap().to_string_lossy();
        same(&model, &again, &model.defaults(), &name);
        same(&model, &again, &moved, &name);
        kept += 1;
    }
    assert!(kept > 20, "{kept} models were read");
}

#[test]
fn odd_names_and_every_closure_are_kept() {
    let mut b = ModelBuilder::new("quote \" and \\ and \n line");
    b.up(UpAxis::Z);
    let base = b.segment("a.b c", None);
    let tip = b.segment("", Some(base));
    b.place_joint(tip, Vec3::new(0.0, -0.0, 1e-300));
    let (_, first) = b.hinge("set.with.dots", base, "angle.2", Vec3::Z);
    let (set, second) = b.hinge("1", tip, "2", Vec3::X);
    b.coordinate_mut(second).source = Some("Grood & Suntay 1983, Δ \u{7} \u{7f}".to_owned());
    b.coordinate_mut(second).range = Range { lower: None, upper: Some(1e-9), enforced: false };
    let lines = PiecewiseLinear::new(vec![0.0, 0.5, 0.5], vec![1.0, 2.0, -3.5]).unwrap();
    let lines = condyle_math::function::Function::from(Curve::PiecewiseLinear(lines));
    let led = b.map(set, "map.of.it", first, lines.clone());
    b.follow(second, led);
    b.marker("m.1", None, Vec3::new(1.0, 2.0, 3.0));
    let at = [(Some(base), Vec3::X), (None, Vec3::Y)];
    for condition in [
        Condition::Points { at },
        Condition::Distance { at, distance: 0.25 },
        Condition::Frames {
            at: [(Some(tip), Affine::from_translation(Vec3::Z)), (None, Affine::IDENTITY)],
        },
        Condition::Coupling { follower: first, driver: second, function: lines },
    ] {
        b.closure(Closure { name: "same name".to_owned(), condition });
    }
    let model = b.build().unwrap();
    let again = read(&document::write(&model));
    // Components and loops of one name get two.
    same_but_names(&model, &again, &[0.3, 0.0], "odd names");
    assert_eq!(model.closures()[2].condition, again.closures()[2].condition);
    assert_eq!(again.closures()[1].name, "same name_2");
}

#[test]
fn postures_are_written_with_their_coordinates_where_they_can_be() {
    let text = r#"
condyle = 1
kind = "model"
angles = "deg"
mirror = { plane = "z", from = "_r", to = "_l" }
[segment.trunk]
[segment.arm_r]
parent = "trunk"
[joint.neck]
type = "hinge"
segment = "trunk"
axis = [0, 0, 1]
coordinates = ["flexion"]
[joint.shoulder_r]
type = "universal"
segment = "arm_r"
axes = [[0, 0, 1], [1, 0, 0]]
coordinates = ["flexion", "lift_r"]
coordinate.flexion = { stiffness = 2e-5, source = "a paper" }
coordinate.lift_r = { default = 5, rest = 30, stiffness = 1e-5 }
[posture.level_r]
sum = { "neck.flexion" = 1, "shoulder_r.flexion" = -0.5, lift_r = 0.25 }
rest = 18
stiffness = 3e-5
"#;
    let model = read(text);
    let found: Vec<(&str, f64, f64)> =
        model.postures().iter().map(|p| (p.name.as_str(), p.rest, p.stiffness)).collect();
    // 18 and 30 degrees; those of the right side first, then the other side's with the same numbers.
    let (a, b) = (18f64.to_radians(), 30f64.to_radians());
    let expected = [
        ("shoulder_r.flexion", 0.0, 2e-5),
        ("shoulder_r.lift_r", b, 1e-5),
        ("shoulder_l.flexion", 0.0, 2e-5),
        ("shoulder_l.lift_l", b, 1e-5),
        ("level_r", a, 3e-5),
        ("level_l", a, 3e-5),
    ];
    assert_eq!(found, expected);
    assert_eq!(model.postures()[0].source.as_deref(), Some("a paper"));
    let names = |index: usize| -> Vec<(String, f64)> {
        let sum = &model.postures()[index].sum;
        sum.iter().map(|&(id, factor)| (model.coordinate_key(id), factor)).collect()
    };
    let all = |names: [(&str, f64); 3]| names.map(|(n, a)| (n.to_owned(), a)).to_vec();
    assert_eq!(
        names(4),
        all([("neck/flexion", 1.0), ("shoulder_r/flexion", -0.5), ("lift_r", 0.25)])
    );
    // What is shared keeps its factor.
    assert_eq!(
        names(5),
        all([("neck/flexion", 1.0), ("shoulder_l/flexion", -0.5), ("lift_l", 0.25)])
    );
    let written = document::write(&model);
    assert_eq!(written.matches("[posture.").count(), 2, "{written}");
    assert_eq!(read(&written), model);
}

#[test]
fn a_document_is_saved_as_it_was_written() {
    let text = "# mine\ncondyle = 1\nkind = \"model\"\n\n[segment.a]   # one bone\n";
    let document = super::try_read(text).unwrap().value;
    assert_eq!(document.text, text);
    let expanded = document::Document::of(document.model.clone());
    assert_eq!(read(&expanded.text), document.model);
}
