//! Posture terms: what is wrong with them, and what scaling makes of them.

use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, ModelBuilder, PostureTerm};

fn term(name: &str, sum: Vec<(CoordinateId, f64)>) -> PostureTerm {
    PostureTerm { name: name.to_owned(), sum, rest: 0.02, stiffness: 1e-5, source: None }
}

#[test]
fn a_posture_of_distances_rests_farther_out_in_a_larger_body() {
    let mut b = ModelBuilder::new("knee");
    let thigh = b.segment("thigh", None);
    let patella = b.segment("patella", Some(thigh));
    let (_, angle) = b.hinge("hip", thigh, "angle", Vec3::Z);
    let set = b.joint_set("kneecap");
    let glide = b.coordinate(set, "glide", CoordinateKind::Translation);
    let up = b.translate(set, "up", glide, Vec3::Y);
    b.output(set, patella, up);
    b.posture(term("distance", vec![(glide, 2.0)]));
    b.posture(term("angle", vec![(angle, 1.0)]));
    b.posture(term("both", vec![(angle, 1.0), (glide, 1.0)]));
    let scaled = b.build().expect("a knee").scaled(&[1.2, 3.0]);
    let rests: Vec<f64> = scaled.postures().iter().map(|p| p.rest).collect();
    // The patella glides in the thigh, which has factor 1.2; a mixture is left as it is.
    assert_eq!(rests, [0.02 * 1.2, 0.02, 0.02]);
}

#[test]
fn errors_of_postures_are_all_said() {
    let mut b = ModelBuilder::new("arm");
    let arm = b.segment("arm", None);
    let hand = b.segment("hand", Some(arm));
    let (_, angle) = b.hinge("elbow", arm, "elbow", Vec3::Z);
    let (_, ball) = b.ball_joint("wrist", hand);
    let good = term("good", vec![(angle, 0.5)]);
    assert_eq!(
        {
            let mut b = b.clone();
            b.posture(good.clone());
            b.build().map(|model| model.postures().to_vec()).expect("nothing is wrong with it")
        },
        std::slice::from_ref(&good)
    );
    let sums = [vec![], vec![(ball, 1.0)], vec![(angle, 0.0)], vec![(angle, 1.0), (angle, 2.0)]];
    for (number, sum) in sums.into_iter().enumerate() {
        b.posture(PostureTerm { name: format!("sum {number}"), sum, ..good.clone() });
    }
    for stiffness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        b.posture(PostureTerm { name: format!("k {stiffness}"), stiffness, ..good.clone() });
    }
    b.posture(PostureTerm { name: "rest".to_owned(), rest: f64::NAN, ..good.clone() });
    b.posture(good.clone());
    b.posture(good);
    let errors = b.build().expect_err("ten terms are wrong").into_diagnostics();
    let said: Vec<&str> = errors.iter().map(|e| e.message.as_str()).collect();
    assert_eq!(
        said,
        [
            "posture `sum 0` names no coordinate",
            "`orientation` in posture `sum 1` is an orientation",
            "the factor of `elbow` in posture `sum 2` is 0",
            "`elbow` is twice in posture `sum 3`",
            "the stiffness of posture `k 0` is 0",
            "the stiffness of posture `k -1` is -1",
            "the stiffness of posture `k NaN` is NaN",
            "the stiffness of posture `k inf` is inf",
            "the rest value of posture `rest` is NaN",
            "two postures are named `good`",
        ]
    );
}
