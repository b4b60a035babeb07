//! Any bytes as a model: no panic, and a model that can be posed, with a Jacobian of the same pose.
#![no_main]

use condyle_formats::opensim::{geometry, model};
use condyle_model::evaluate::ClosureRows;
use condyle_model::{Jacobian, Mode, Pose, Program};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = model::read(data) else { return };
    let model = read.value;
    let _ = geometry::read(data, &mut |_| Err("it is not given".to_owned()));
    let program = Program::compile(&model);
    let stored = model.defaults();
    assert!(stored.iter().all(|value| value.is_finite()), "defaults are numbers");
    let (mut plain, mut posed) = (Pose::new(&program), Pose::new(&program));
    program.evaluate(&stored, Mode::Open, &mut plain).expect("defaults fit the program");
    let mut jacobian = Jacobian::new(&program);
    program.evaluate_with_jacobian(&stored, &mut posed, &mut jacobian).expect("so they do here");
    for id in model.segment_ids() {
        let bits = |pose: &Pose| pose.segment(id).to_rows().map(|x| (x + 0.0).to_bits());
        let finite = plain.segment(id).to_rows().iter().all(|x| x.is_finite());
        assert!(!finite || bits(&plain) == bits(&posed), "one pose, however it is evaluated");
        assert_eq!(model.find_segment(&model.segment(id).name), Ok(id));
    }
    for id in model.coordinate_ids() {
        assert_eq!(model.find_coordinate(&model.coordinate_key(id)), Ok(id));
    }
    let mut rows = ClosureRows::new(&model);
    rows.update(&model, &program, &posed, Some(&jacobian));
    assert_eq!(rows.derivatives.len(), rows.len() * model.tangent_len());
    program.evaluate(&stored, Mode::Posed, &mut plain).expect("defaults fit the program");
});
