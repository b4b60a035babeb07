//! Numbers that are made of others, and functions of them.

use super::{errors, pose, read};

const HEAD: &str = "condyle = 1\nkind = \"model\"\n";

#[test]
fn a_number_is_a_product_of_numbers_and_constants() {
    let text = format!(
        "{HEAD}constants = {{ stature = 1.75, thigh = \"0.245 * $stature\", twice = \"2*$thigh\" \
         }}\n\
         [segment.a]\nat = [\"$thigh\", \"-$thigh * 2\", \" - 0.5 * $twice * $stature \"]\n\
         joint_at = [\"2 * 3\", \"1e-3*4\", \"-.5 * 2\"]\n"
    );
    let model = read(&text);
    let a = &model.segments()[0];
    let thigh = 0.245 * 1.75;
    let at = a.joint_in_parent.translation.to_array();
    let expected = [thigh, -thigh * 2.0, -0.5 * (2.0 * thigh) * 1.75];
    assert!(at.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{at:?}");
    assert_eq!(a.joint_in_segment.translation.to_array(), [6.0, 0.004, -1.0]);
}

#[test]
fn a_number_is_a_sum_of_products() {
    let text = format!(
        "{HEAD}constants = {{ thigh = 0.4, height = \"$thigh + 0.0108\" }}\n\
         [segment.a]\nat = [\"-$thigh - 0.0108\", \"$height - 2 * $thigh + 1\", \"1e-3 * 1 - \
         -2\"]\n"
    );
    let at = read(&text).segments()[0].joint_in_parent.translation.to_array();
    let expected = [-0.4108, 0.4108 - 0.8 + 1.0, 2.001];
    assert!(at.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{at:?}");
}

#[test]
fn the_including_document_has_the_last_word_on_constants() {
    let part = format!(
        "{HEAD}constants = {{ stature = 1.75, thigh = \"0.2 * $stature\" }}\n[segment.a]\nat = \
         [\"$thigh\", 0, 0]\n"
    );
    let text = format!("{HEAD}include = [\"part.toml\"]\nconstants = {{ stature = 2 }}\n");
    let read = condyle_formats::document::read(&text, &mut |_| Ok(part.clone())).unwrap();
    let at = read.value.model.segments()[0].joint_in_parent.translation;
    assert!((at.x - 0.4).abs() < 1e-15, "{at:?}");
}

#[test]
fn what_is_no_product_is_refused_once() {
    let found = errors(
        "constants = { a = \"$b\", b = 2, c = \"$c\" }\n[segment.s]\nat = [\"$a\", \"2 * -3\", \"$ \
         b\"]\n\
         joint_at = [\"inf * 2\", \"2\", \"$\"]\n",
    );
    let product = "(write a product of numbers and constants, such as \"0.245 * $stature\")";
    assert_eq!(
        found,
        [
            "line 3, column 19: constant `$b` is defined further down (move it up: a constant may \
             use only those above it)"
                .to_owned(),
            "line 3, column 36: constant `$c` is defined further down (move it up: a constant may \
             use only those above it)"
                .to_owned(),
            format!("line 5, column 13: `-3` is neither a number nor a constant {product}"),
            "line 5, column 23: unknown constant `$ b` (define it in the table \
             `constants`)"
                .to_owned(),
            format!("line 6, column 13: `inf` is neither a number nor a constant {product}"),
            "line 6, column 24: `joint_at` is a string (give a number)".to_owned(),
            "line 6, column 29: unknown constant `$` (define it in the table \
             `constants`)"
                .to_owned(),
        ]
    );
}

#[test]
fn ends_are_two_slopes_through_the_middle() {
    let text = format!(
        "{HEAD}[segment.s]\n[joint_set.j.coordinate.q]\nkind = \"other\"\n\
         [joint_set.j.component.m.map]\ninput = \"q\"\nout = \"deg\"\n\
         functions = [{{ ends = [-30, 75] }}, {{ ends = [4, 9], factor = -1 }}]\n\
         [joint_set.j.component.x.translate]\ndistance = \"m\"\naxis = [1, 0, 0]\n\
         [joint_set.j.component.y.translate]\ndistance = \"m.2\"\naxis = [0, 1, 0]\n\
         [joint_set.j.output]\ns = [\"x\", \"y\"]\n"
    );
    let model = read(&text);
    for q in [-1.0, -0.4, 0.0, 0.3, 1.0, 1.5] {
        // From lo at -1 through 0 to hi at 1, and on with the same slopes.
        let expected = |lo: f64, hi: f64| if q < 0.0 { -lo * q } else { hi * q };
        let t = pose(&model, &[q])[0];
        assert!((t[3].to_degrees() - expected(-30.0, 75.0)).abs() < 1e-12, "{q}: {}", t[3]);
        assert!((t[7].to_degrees() + expected(4.0, 9.0)).abs() < 1e-12, "{q}: {}", t[7]);
    }
}
