//! Where the recorded markers come from.

/// The recorded positions of each frame, in the order of the marker targets.
pub trait Recorded: Sync {
    /// Writes those of a frame, in metres; `None` where a marker was not seen.
    fn positions(&self, frame: usize, seen: &mut Vec<Option<[f64; 3]>>);
}

impl<F: Fn(usize, &mut Vec<Option<[f64; 3]>>) + Sync> Recorded for F {
    fn positions(&self, frame: usize, seen: &mut Vec<Option<[f64; 3]>>) {
        self(frame, seen);
    }
}
