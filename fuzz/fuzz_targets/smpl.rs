//! Any bytes as an archive of NumPy: no panic; a body is one of the trees, and frames of poses fit the model.
#![no_main]

use condyle_formats::smpl::{self, Rest, Tree};
use condyle_math::Vec3;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    if let Ok(read) = smpl::rest(data) {
        let model = read.value.model().expect("a body has all joints of its tree").value;
        assert!(Tree::of_len(model.segments().len()).is_some());
    }
    let joints = Tree::SmplX.joints().into_iter().enumerate();
    let joints = joints.map(|(index, (name, _))| (name, Vec3::new(0.1, index as f64 * 0.05, 0.0)));
    let Ok(read) = smpl::from_bytes(data, &Rest::new("steps", joints.collect())) else { return };
    let found = read.value;
    assert_eq!(found.motion.frames.len(), found.motion.times.len());
    assert!(found.motion.frames.iter().all(|frame| frame.len() == found.model.stored_len()));
    assert!(found.motion.frames.iter().flatten().all(|number| number.is_finite()));
});
