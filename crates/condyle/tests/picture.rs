//! Pictures of models.

use condyle::picture::{Focus, Posed, Sheet, Show, View, draw};
use condyle::render::{Canvas, palette};
use condyle::{Model, ModelBuilder, math::Vec3, open};

fn human() -> Model {
    open::model("human".as_ref()).expect("it is shipped").value
}

fn sheet(model: &Model) -> Sheet {
    Sheet { size: [300, 400], ..Sheet::new(vec![Posed::new(model.defaults())]) }
}

/// Where something is drawn.
fn covered(picture: &Canvas) -> Vec<(usize, usize)> {
    let all = (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
    all.filter(|&(x, y)| picture.at(x, y) != Some(palette::BACKGROUND)).collect()
}

/// Pixels that are more orange than any bone.
fn accented(picture: &Canvas) -> usize {
    let orange = |p: &&palette::Colour| i32::from(p[0]) - i32::from(p[2]) > 80;
    picture.pixels().iter().filter(orange).count()
}

#[test]
fn the_front_of_a_symmetric_body_is_symmetric() {
    let model = human();
    let front = Sheet { views: vec![View::named("front").unwrap()], ..sheet(&model) };
    let picture = draw(&model, &front).unwrap();
    let seen = covered(&picture);
    let other = seen.iter().filter(|&&(x, y)| picture.at(299 - x, y) == Some(palette::BACKGROUND));
    let off = other.count();
    assert!(seen.len() > 5000, "{}", seen.len());
    // Rounding at edges alone.
    assert!(off * 200 < seen.len(), "{off} of {}", seen.len());
}

#[test]
fn a_figure_is_as_high_in_every_view_as_it_is() {
    let model = human();
    let heights = ["front", "side", "back"].map(|view| {
        let view = Sheet { views: vec![View::named(view).unwrap()], ..sheet(&model) };
        let picture = draw(&model, &view).unwrap();
        // The ground is a line at the soles.
        let top = covered(&picture).iter().map(|&(_, y)| y).min().unwrap();
        400 - top
    });
    // 92 % of the height of the picture, of which a margin of 4 % is below: within a pixel or two.
    assert!(heights.iter().all(|h| h.abs_diff(384) <= 2), "{heights:?}");
}

/// The ellipsoids of that model reach half a metre below its bones.
#[test]
fn what_bones_glide_on_is_whole_in_the_picture() {
    let model = open::model("shoulder-shao2003".as_ref()).expect("it is shipped").value;
    let views = vec![View::named("front").unwrap()];
    let shown = Sheet { views, show: vec![Show::Bones, Show::Contacts], ..sheet(&model) };
    let picture = draw(&model, &shown).unwrap();
    // From the front the first and last rows have one colour, that of sky or ground, unless something reaches them.
    for y in [0, 399] {
        let reached = (0..300).filter(|&x| picture.at(x, y) != picture.at(0, y)).count();
        assert_eq!(reached, 0, "row {y}");
    }
}

#[test]
fn zoom_is_against_the_whole_figure() {
    // A bar of markers: a bone of 0.5 m from the joint to the marker.
    let mut b = ModelBuilder::new("bar");
    let bar = b.segment("bar", None);
    b.hinge("turn", bar, "angle", Vec3::Z);
    b.marker("end", Some(bar), Vec3::new(0.0, 0.5, 0.0));
    let model = b.build().unwrap();
    let joints = |zoom: Option<f64>| {
        let focus = Focus { names: vec!["bar".into()], zoom, highlight: false };
        let view = vec![View::named("front").unwrap()];
        let picture = draw(&model, &Sheet { views: view, focus, ..sheet(&model) }).unwrap();
        // The widest row with bones is as wide as its ball.
        let seen = covered(&picture);
        let grey = |&(x, y): &(usize, usize)| {
            let [r, _, b] = picture.at(x, y).unwrap();
            b.saturating_sub(r) > 25
        };
        let across: Vec<usize> = seen.into_iter().filter(grey).map(|(x, _)| x).collect();
        across.iter().max().map_or(0, |max| max - across.iter().min().unwrap())
    };
    let (once, twice) = (joints(Some(0.5)) as f64, joints(Some(1.0)) as f64);
    assert!((twice / once - 2.0).abs() < 0.25, "{once} {twice}");
}

#[test]
fn what_is_looked_at_is_in_the_accent_colour() {
    let model = human();
    let of = |names: &[&str], highlight| {
        let names = names.iter().map(|n| (*n).to_owned()).collect();
        let focus = Focus { names, zoom: Some(1.0), highlight };
        accented(&draw(&model, &Sheet { focus, ..sheet(&model) }).unwrap())
    };
    assert_eq!(of(&["femur_r"], false), 0);
    let (one, both) = (of(&["femur_r"], true), of(&["femur_r", "femur_l"], true));
    assert!(one > 100 && both > one, "{one} {both}");
}

#[test]
fn every_kind_of_thing_adds_something() {
    let model = human();
    let with = |show: Vec<Show>| draw(&model, &Sheet { show, ..sheet(&model) }).unwrap();
    let bones = with(vec![Show::Bones]);
    assert_eq!(with(vec![Show::Skin]), bones, "the knee has no skin");
    for (name, kind) in Show::ALL.into_iter().skip(2) {
        let differs = with(vec![Show::Bones, kind]);
        let off = bones.pixels().iter().zip(differs.pixels()).filter(|(a, b)| a != b).count();
        assert!(off > 100, "{name}: {off} pixels");
    }
}

#[test]
fn poses_and_views_make_a_grid() {
    let model = open::model("knee".as_ref()).expect("it is shipped").value;
    let posed = |angle: f64| Posed { stored: vec![angle], title: format!("{angle}") };
    let poses = vec![posed(0.0), posed(0.6), posed(1.2)];
    let views = vec![View::named("side").unwrap(), View::named("front").unwrap()];
    let grid = Sheet { views, size: [600, 400], ..Sheet::new(poses) };
    let picture = draw(&model, &grid).unwrap();
    assert_eq!((picture.width(), picture.height()), (600, 400));
    let seen = covered(&picture);
    for row in 0..2 {
        for column in 0..3 {
            let inside = |&&(x, y): &&(usize, usize)| x / 200 == column && y / 200 == row;
            assert!(seen.iter().filter(inside).count() > 200, "{row} {column}");
        }
    }
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let model = human();
    let fails = |sheet: Sheet| draw(&model, &sheet).unwrap_err();
    let focus = Focus { names: vec!["femr_r".into()], ..Focus::default() };
    let error = fails(Sheet { focus, ..sheet(&model) }).to_string();
    assert_eq!(error, "no segment or joint set is called `femr_r` (did you mean `femur_r`?)");
    for size in [[0, 0], [15, 400], [400, 15], [9000, 9000], [usize::MAX, 2]] {
        assert_eq!(fails(Sheet { size, ..sheet(&model) }).code(), "picture/size", "{size:?}");
    }
    assert_eq!(fails(Sheet { poses: vec![], ..sheet(&model) }).code(), "picture/poses");
    let short = Sheet::new(vec![Posed::new(vec![0.0])]);
    assert_eq!(fails(short).code(), "picture/poses");
}

#[test]
fn nothing_panics() {
    let all: Vec<Show> = Show::ALL.iter().map(|(_, kind)| *kind).collect();
    let models = ["shoulder", "shoulder-shao2003", "spine", "octopus", "knee-three-rotations"];
    for name in models {
        let model = open::model(name.as_ref()).expect("it is shipped").value;
        for value in [0.3, -50.0, f64::NAN, f64::INFINITY, 1e300] {
            let stored = vec![value; model.stored_len()];
            let poses = vec![Posed::new(stored), Posed::new(model.defaults())];
            let sheet = Sheet { show: all.clone(), size: [64, 48], ..Sheet::new(poses) };
            assert!(draw(&model, &sheet).is_ok(), "{name} at {value}");
        }
    }
    if let Ok(empty) = ModelBuilder::new("empty").build() {
        let sheet = Sheet { show: all, size: [16, 16], ..Sheet::new(vec![Posed::new(vec![])]) };
        assert!(draw(&empty, &sheet).is_ok());
    }
}
