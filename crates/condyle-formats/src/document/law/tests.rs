use super::*;
use condyle_learn::coupling::{Groups, Samples, Settings, learn};

fn alone(_: &str) -> Result<String, String> {
    Err("it stands alone".into())
}

fn learned(basis: Basis) -> LawDocument {
    let columns = ["hip/flexion", "rotation", "t x"].map(str::to_owned).to_vec();
    let mut samples = Samples { columns, trials: vec![] };
    for trial in 0..4 {
        let rows: Vec<f64> = (0..60)
            .flat_map(|i| {
                let t = 0.13 * f64::from(i) + f64::from(trial);
                let (a, b) = (t.sin(), 0.3 * (1.7 * t).cos());
                [a, b, 0.4 + 0.03 * a - 0.01 * b + 0.002 * (9.0 * t).sin()]
            })
            .collect();
        samples.add(&format!("gait {trial}"), Groups::of_name("gait"), &rows, 0);
    }
    let kinds = [Some(CoordinateKind::Rotation), None, Some(CoordinateKind::Translation)];
    let settings = Settings { basis, ridge: 0.0 };
    let mut laws = learn(&samples, &kinds, &[0, 1], &[2], &settings).unwrap();
    laws.about.name = "knee \"left\"".into();
    laws.about.frames = "model leg, joint knee".into();
    LawDocument::from(&laws)
}

#[test]
fn what_is_written_is_read_again() {
    for basis in [Basis::Linear, Basis::Polynomial(2), Basis::Spline(4)] {
        let document = learned(basis);
        let text = write(&document);
        let again = read(&text, &mut alone).unwrap_or_else(|e| panic!("{e}\n{text}")).value;
        assert_eq!(again, document, "{text}");
        assert_eq!(write(&again), text);
    }
}

#[test]
fn faults_are_placed() {
    let head = "condyle = 1\nkind = \"law\"\n";
    for (text, said) in [
        ("[law.tx]\nfunction = { slopes = [1] }", "[] has no `control`"),
        ("control = \"a\"", "[] has no `law`"),
        ("control = \"a\"\n[law.tx]", "[law.tx] has no `function`"),
        (
            "control = \"a\"\n[law.tx]\nfunction = { slopes = [1, 2] }",
            "line 5, column 12: `function` takes 2 numbers",
        ),
        (
            "control = [\"a\", \"b\"]\n[law.tx]\nparts = [1]",
            "line 5, column 9: `parts` has 1 functions",
        ),
        (
            "control = \"a\"\nkinds = [\"rotated\"]\n[law.tx]\nfunction = { slopes = [1] }",
            "line 4, column 10: unknown kind of coordinate `rotated`",
        ),
        (
            "control = \"a\"\n[law.tx]\nfunction = { slopes = [1] }\n[region]\nlow = [2]\nhigh = [1]\ncentre = [0]\n\
             inverse = [[1]]\ndistance = 1",
            "`region` is no region",
        ),
        (
            "control = \"a\"\n[law.tx]\nfunction = { slopes = [1] }\n[region]\nlow = [0]\nhigh = [1]\ncentre = [0]\n\
             inverse = [[1, 2]]\ndistance = 1",
            "`inverse` is no matrix of 1 rows and columns",
        ),
        (
            "control = \"a\"\n[law.tx]\nfunction = { slopes = [1] }\n[learning]\nbasis = \"cubic\"",
            "line 7, column 9: unknown basis `cubic`",
        ),
    ] {
        let error = read(&format!("{head}{text}"), &mut alone).unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}
