//! Any bytes as a setup of scaling and as a model to be scaled: no panic, and what is scaled can be read.
#![no_main]

use condyle_formats::opensim::scale::{Factors, Rules, model_of, scale, whole, with_marker_set};
use condyle_formats::opensim::scale_setup;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    if let Ok(read) = scale_setup::read(data, &mut |_| Err("nothing there".to_owned())) {
        assert!(read.value.mass.is_none_or(|mass| mass > 0.0));
        if let Some(scaler) = read.value.scaler {
            assert!(scaler.time_range.is_none_or(|[start, end]| start <= end));
        }
    }
    // The file includes itself.
    let own = String::from_utf8_lossy(data).into_owned();
    let Ok(text) = whole(data, &mut |_| Ok(own.clone())) else { return };
    let names = ["a", "b0", "thigh", "forearm", "pelvis"];
    let factors: Factors = names.iter().map(|name| (name.to_string(), [1.1, 0.9, 1.2])).collect();
    for as_opensim in [false, true] {
        let rules = Rules { as_opensim, mass: Some(70.0), preserve_mass: as_opensim };
        if let Ok(scaled) = scale(&text.value, &factors, &rules, &mut |m| m.defaults()) {
            assert!(model_of(&scaled.value.text).is_ok());
        }
    }
    let _ = with_marker_set(&text.value, data);
});
