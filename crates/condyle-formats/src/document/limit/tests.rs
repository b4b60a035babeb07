use super::*;
use condyle_learn::limits::learn;
use condyle_math::Vec3;

/// Rotations of a fixed sequence, uniform (Shoemake 1992).
struct Rotations(u64);

impl Rotations {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn next(&mut self) -> Quat {
        let (u, v, w) = (self.unit(), self.unit(), self.unit());
        let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
        let (s, t) = (std::f64::consts::TAU * v, std::f64::consts::TAU * w);
        Quat { x: a * s.sin(), y: a * s.cos(), z: b * t.sin(), w: b * t.cos() }
    }
}

fn alone(_: &str) -> Result<String, String> {
    Err("it stands alone".into())
}

fn again(text: &str) -> LearnedLimit {
    read(text, &mut alone).unwrap_or_else(|error| panic!("{error}")).value
}

/// All turns by up to 70 degrees but those near one of them, from two takes.
fn learned() -> LearnedLimit {
    let mut random = Rotations(3);
    let hole = Quat::exp(Vec3::new(0.3, 0.2, -0.1));
    let samples: Vec<Quat> = std::iter::repeat_with(|| random.next())
        .filter(|q| q.angle_to(Quat::IDENTITY) < 70f64.to_radians())
        .filter(|q| q.angle_to(hole) > 30f64.to_radians())
        .take(3000)
        .collect();
    let (one, two) = samples.split_at(600);
    let cloud = Cloud::gather(&[one, two], 0.01).unwrap();
    let about = About {
        name: "hip \"left\"".into(),
        child: "femur_l".into(),
        reference: Some("pelvis".into()),
        source: "a sequence of random numbers".into(),
        population: "none".into(),
        frames: "axes as drawn".into(),
        takes: vec!["one".into(), "two".into()],
    };
    let settings = Settings { nodes: 40, ..Settings::default() };
    field::limit(&cloud, &settings, about).unwrap()
}

#[test]
fn what_is_saved_and_read_answers_as_what_was_learned() {
    let limit = learned();
    let text = write(&limit);
    let again = again(&text);
    assert_eq!(again.about(), limit.about());
    assert_eq!(again.ground(), limit.ground());
    assert_eq!(again.learned(), limit.learned());
    assert_eq!(write(&again), text);
    let (mut random, mut states) = (Rotations(5), [0; 3]);
    for _ in 0..2000 {
        let q = Quat::exp(random.next().log() * 0.6);
        let (one, two) = (limit.field().answer(q), again.field().answer(q));
        assert_eq!(one.state, two.state);
        // It is the same arithmetic on the same numbers; 0.05 degrees would be the promise.
        assert_eq!((one.distance, one.nearest), (two.distance, two.nearest));
        assert_eq!(one.evidence, two.evidence);
        states[one.state as usize] += 1;
    }
    assert!(states.into_iter().all(|count| count > 20), "{states:?}");
    // And what the file says was learned was.
    assert_eq!(again.field().learned(), limit.learned());
}

#[test]
fn the_rotations_that_were_given_are_within_a_hundredth_of_a_degree() {
    let mut random = Rotations(9);
    let take: Vec<Quat> = (0..500).map(|_| random.next()).collect();
    let cloud = Cloud::gather(&[&take], 0.0).unwrap();
    let ground = field::ground(&cloud, &Settings::default()).unwrap();
    for (given, held) in take.iter().zip(&ground.samples) {
        assert!(given.angle_to(*held).to_degrees() < 0.01);
    }
}

#[test]
fn thirty_thousand_samples_are_less_than_a_megabyte() {
    let mut random = Rotations(1);
    let take: Vec<Quat> = (0..30_000).map(|_| random.next()).collect();
    let cloud = Cloud::gather(&[&take], 0.0).unwrap();
    let ground = Arc::new(field::ground(&cloud, &Settings::default()).unwrap());
    let limit = LearnedLimit::new(About::default(), ground, None, field::made);
    // 8 letters of base64 for 6 bytes, a line end for a hundred.
    let expected = 30_000 * 8 / 100 * 101;
    let size = write(&limit).len();
    assert!((expected..expected + 1000).contains(&size), "{size}");
}

#[test]
fn rotations_alone_are_a_limit() {
    let text = "condyle = 1\nkind = \"limit\"\nangles = \"deg\"\nchild = \"a\"\n\
                samples.rotations = [[0, 0, 0, 1], [0, 0.0872, 0, 0.9962], [0, 0.1736, 0, -0.9848]]\n\
                learning = { nodes = 48, radii = [20, 50], layer = 4 }\n";
    let limit = again(text);
    assert_eq!(limit.ground().takes, [3]);
    let settings = limit.ground().settings;
    assert!((settings.gap.unwrap() - 4f64.to_radians()).abs() < 1e-15);
    // From 50 degrees about x the samples are 50 degrees away, less the layer.
    let far = limit.field().distance(Quat::from_axis_angle(Vec3::X, 50f64.to_radians()));
    assert!((far.to_degrees() + 46.0).abs() < 4.0, "{}", far.to_degrees());
    let saved = again(&write(&limit));
    assert_eq!(saved.ground(), limit.ground());
}

#[test]
fn learning_a_ground_again_is_learning_a_cloud() {
    let limit = learned();
    let cloud = Cloud::gather(&[&limit.ground().samples], 0.0).unwrap();
    let field = learn(&cloud, &limit.ground().settings).unwrap();
    let (spacing, known) = (field.learned().spacing, limit.learned().spacing);
    assert!((spacing / known - 1.0).abs() < 0.02);
}

#[test]
fn faults_are_placed() {
    let head = "condyle = 1\nkind = \"limit\"\nchild = \"a\"\n";
    for (text, said) in [
        (
            "[samples]\nrotations = [[0, 0, 0, 1], [0, 0, 0, 0]]",
            "line 5, column 28: a rotation of `rotations` has length 0, not 1",
        ),
        ("[samples]\nrotations = [[0, 0, 0, 2]]", "has length 2, not 1"),
        (
            "[samples]\nrotations = [[nan, 0, 0, 1]]",
            "line 5, column 15: `rotations` is not a finite number",
        ),
        ("[samples]\nrotations = [[0, 0, 1]]", "`rotations` has 3 numbers"),
        ("[samples]\nrotations = []", "there are no rotations"),
        ("", "[] has no `samples`"),
        ("[samples]\npacked = \"AAAA!\"", "line 5, column 10: `packed` is no base64"),
        ("[samples]\npacked = \"AAAA\"", "`packed` has 3 bytes, which is no multiple of 6"),
        ("[samples]\npacked = \"AAAAAAAA\"", "rotation 0 of `packed` is none: [0, 0, 0]"),
        (
            "[samples]\nrotations = [[0, 0, 0, 1]]\ntakes = [2]",
            "`takes` sum up to 2, but there are 1 rotations",
        ),
        (
            "[samples]\nrotations = [[0, 0, 0, 1]]\naxes = [[0, 0, 0, 1], [0, 0, 0, 0.5]]",
            "a rotation of `axes` has length 0.5",
        ),
        (
            "[samples]\nrotations = [[0, 0, 0, 1]]\n[learned]\ngap = 0.1",
            "[learned] has not all of `spacing`, `radius`, `gap`",
        ),
        ("[samples]\nrotations = [[0, 0, 0, 1]]\n[learning]\nnodes = 1000", "`nodes` is 1000"),
        (
            "[samples]\nrotations = [[0, 0, 0, 1]]\n[learning]\nmethod = \"clsing\"",
            "unknown value `clsing`",
        ),
    ] {
        let error = read(&format!("{head}{text}"), &mut alone).unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}

const TURNS: &str = r#"
condyle = 1
kind = "limit"
angles = "deg"
child = "humerus_r"
source = "drawn by hand"
[shape]
axes = [[-1, 0, 0], [0, 0, 1], [0, -1, 0]]
first = [-9, 160]
second = { first = [0, 180], lower = [-43, 17], upper = [153, 123] }
third = { first = [0, 90], second = [0, 90], lower = [[-90, -100], [-20, -10]], upper = [[60, 10], [100, 100]] }
beyond = 5
"#;

#[test]
fn formulas_are_read_and_written() {
    let limit = again(TURNS);
    let shape = limit.ground().shape.as_deref().unwrap();
    // -90 + 7 a/9 - f/9 + 2 a f/810 at a = 45 and f = 45: -55 exactly; 60 + 4 a/9 - 5 f/9 + 5 a f/810: 67.5.
    let ends = shape.third().at(45f64.to_radians(), 45f64.to_radians()).map(f64::to_degrees);
    assert!((ends[0] + 55.0).abs() < 1e-12 && (ends[1] - 67.5).abs() < 1e-12, "{ends:?}");
    let written = write(&limit);
    let twice = again(&written);
    let near = |one: &[f64], two: &[f64]| one.iter().zip(two).all(|(a, b)| (a - b).abs() < 1e-12);
    let other = twice.ground().shape.as_deref().unwrap();
    assert!(near(shape.third().lower(), other.third().lower()));
    assert!(near(shape.second().upper(), other.second().upper()));
    assert_eq!(other.axes(), shape.axes());
    assert!((other.beyond().to_degrees() - 5.0).abs() < 1e-12);
    assert_eq!(write(&twice), written);
    assert_eq!(twice.about(), limit.about());
}

#[test]
fn formulas_that_are_none_are_refused() {
    for (from, to, said) in [
        ("first = [-9, 160]", "first = [160, -9]", "limit/shape"),
        ("[0, 0, 1]", "[1, 0, 1]", "limit/shape"),
        ("upper = [[60, 10], [100, 100]]", "upper = [[60, 10], [100]]", "document/length"),
        ("upper = [[60, 10], [100, 100]]", "upper = [60, 10, 100]", "limit/shape"),
        ("beyond = 5", "beyond = 500", "limit/shape"),
        ("beyond = 5", "nodes = 3", "limit/settings"),
        ("beyond = 5", "samples = {}", "document/unknown-key"),
        ("[shape]", "[samples]\nrotations = [[0, 0, 0, 1]]\n[shape]", "document/exclusive"),
    ] {
        assert!(TURNS.contains(from), "{from}");
        let error = read(&TURNS.replace(from, to), &mut alone).unwrap_err();
        assert!(error.iter().any(|e| e.code == said), "{said}: {error}");
    }
}
