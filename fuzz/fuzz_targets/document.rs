//! Any text as a document: no panic; a kind that does not contradict the reader; as a model, errors
//! that can be shown, and the same model after writing and reading again; as a limit or a law likewise.
#![no_main]

use condyle_formats::document::{Kind, kind, law, limit, read_with, render, write};
use condyle_math::{Affine, Mat3, Scalar, Vec3};
use condyle_model::component::{MotionLaw, Registry};
use condyle_model::{Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

/// A user's law: a turn with a lift.
#[derive(Debug)]
struct Cam(f64);

impl MotionLaw for Cam {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let (s, c) = inputs[0].sin_cos();
        let turn = Mat3::identity().rotated_z((s, c));
        Affine::new(turn, Vec3::new(S::zero(), (S::one() - c).scale(self.0), S::zero()))
    }
}

fuzz_target!(|data: &[u8]| {
    let mut registry = Registry::default();
    registry.register("cam", &["angle"], |parameters| {
        let lift = parameters.get("lift").and_then(|v| v.first()).ok_or("it needs a `lift`")?;
        Ok(Cam(*lift))
    });
    let found = kind(data);
    let text = String::from_utf8_lossy(data);
    if found == Some(Kind::Limit) {
        match limit::read(&text, &mut |_| Err("nothing there".to_owned())) {
            Ok(read) => {
                // The field is not made: that takes a second.
                let limit = read.value;
                assert!(limit.ground().samples.iter().all(|q| (q.dot(*q) - 1.0).abs() < 1e-9));
                if limit.ground().known.is_none() {
                    return;
                }
                let again = limit::read(&limit::write(&limit), &mut |_| Err(String::new()));
                assert_eq!(again.expect("it was written").value.ground(), limit.ground());
            }
            Err(errors) => assert!(!errors.is_empty()),
        }
        return;
    }
    if found == Some(Kind::Law) {
        match law::read(&text, &mut |_| Err("nothing there".to_owned())) {
            Ok(read) => {
                let written = law::write(&read.value);
                let again = match law::read(&written, &mut |_| Err(String::new())) {
                    Ok(again) => again.value,
                    Err(errors) => panic!("{}\n{written}", render("written", &written, &errors)),
                };
                assert_eq!(again.laws.len(), read.value.laws.len());
                assert_eq!(law::write(&again), written);
            }
            Err(errors) => assert!(render("text", &text, &errors).lines().count() >= errors.len()),
        }
        return;
    }
    // The text includes itself under other names, at most three times.
    let mut left = 3;
    let mut include = |name: &str| {
        left -= 1;
        if left < 0 || name.len() > 20 {
            Err("nothing there".to_owned())
        } else {
            Ok(text.to_string())
        }
    };
    let model = match read_with(&text, &mut include, &registry) {
        Ok(read) => {
            assert!(found == Some(Kind::Model) || data.len() >= 1 << 16);
            read.value.model
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            assert!(render("text", &text, &errors).lines().count() >= errors.len());
            return;
        }
    };
    let written = write(&model);
    let again = match read_with(&written, &mut |_| Err(String::new()), &registry) {
        Ok(read) => read.value.model,
        Err(errors) => panic!("{}\n{written}", render("written", &written, &errors)),
    };
    assert_eq!(model.coordinates(), again.coordinates());
    assert_eq!(model.markers(), again.markers());
    if model.components().len() > 200 || model.segments().len() > 200 {
        return;
    }
    let pose = |model: &condyle_model::Model| {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        program.evaluate(&model.defaults(), Mode::Open, &mut pose).expect("defaults fit");
        model.segment_ids().map(|id| pose.segment(id).to_rows()).collect::<Vec<_>>()
    };
    for (a, b) in pose(&model).into_iter().flatten().zip(pose(&again).into_iter().flatten()) {
        // Huge numbers and sharp curves magnify what rounding leaves of a turn or an axis.
        assert!(!a.is_finite() || a.abs() > 1e6 || !b.is_finite() || (a - b).abs() < 1.0 + a.abs());
    }
});
