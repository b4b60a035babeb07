//! Where the recorded markers come from.

/// The recorded markers of each frame, in the order of the marker tasks.
pub trait Recorded: Sync {
    /// Writes the markers of a frame.
    fn targets(&self, frame: usize, targets: &mut Vec<Option<[f64; 3]>>);
}

impl<F: Fn(usize, &mut Vec<Option<[f64; 3]>>) + Sync> Recorded for F {
    fn targets(&self, frame: usize, targets: &mut Vec<Option<[f64; 3]>>) {
        self(frame, targets);
    }
}
