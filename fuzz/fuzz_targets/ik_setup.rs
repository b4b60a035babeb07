//! Any bytes as a setup of inverse kinematics: no panic, and no weight that is not one.
#![no_main]

use condyle_formats::opensim::setup::{self, IkTaskSet, IkTasks};
use libfuzzer_sys::fuzz_target;

fn check(tasks: &IkTaskSet) {
    let weights = tasks.markers.iter().map(|task| task.weight);
    for weight in weights.chain(tasks.coordinates.iter().map(|task| task.weight)) {
        assert!(weight >= 0.0 && weight.is_finite());
    }
}

fuzz_target!(|data: &[u8]| {
    if let Ok(read) = setup::from_bytes(data) {
        assert!(read.value.constraint_weight >= 0.0);
        assert!(read.value.time_range.is_none_or(|[start, end]| start <= end));
        if let IkTasks::Inline(tasks) = &read.value.tasks {
            check(tasks);
        }
    }
    if let Ok(read) = setup::tasks_from_bytes(data) {
        check(&read.value);
    }
});
