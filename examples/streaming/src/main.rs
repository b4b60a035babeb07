//! Markers come in one frame at a time, as from a camera system at 100 Hz, and a posture comes out.
//!
//! The only dependency is `condyle`, without readers of files and without threads, so the same
//! program runs in a browser. Model and tracker live in one struct; every type has a name.

use condyle::math::Vec3;
use condyle::tracking::{
    FrameAnswer, FrameStatus, MarkerTarget, Rules, Stream, Targets, Tracker, Wanted,
};
use condyle::{CoordinateId, Error, Mode, Model, ModelBuilder, Pose, Posture, Program, Range};
use std::sync::Arc;

/// What such a program keeps from frame to frame.
struct Session {
    model: Arc<Model>,
    stream: Stream,
    pose: Pose,
    /// The last answer that could be used.
    last: Option<FrameAnswer>,
}

impl Session {
    fn new(model: Model) -> Self {
        let model = Arc::new(model);
        let markers = (0..model.markers().len()).map(|marker| MarkerTarget { marker, weight: 1.0 });
        let targets = Targets { markers: markers.collect(), ..Targets::default() };
        let tracker: Arc<Tracker> =
            Arc::new(Tracker::new(Arc::clone(&model), targets, Rules::default()));
        let pose = Pose::new(tracker.program());
        Self { model, stream: Stream::new(tracker), pose, last: None }
    }

    /// One frame of markers in, in the model's order; the transforms of all segments out.
    fn frame(&mut self, seen: &[Option<[f64; 3]>]) -> (FrameStatus, &Pose) {
        let answer = self.stream.next(seen);
        let status = answer.status;
        if status.is_solved() {
            self.last = Some(answer.clone());
        }
        let program: &Program = self.stream.tracker().program();
        let coordinates = &self.stream.answer().coordinates;
        program.evaluate(coordinates, Mode::Open, &mut self.pose).expect("one number a coordinate");
        (status, &self.pose)
    }
}

/// An arm with a ball at the shoulder and a hinge at the elbow.
fn arm() -> Result<(Model, CoordinateId), Error> {
    let mut b = ModelBuilder::new("arm");
    let upper = b.segment("upper_arm", None);
    b.ball_joint("shoulder", upper);
    let fore = b.segment("forearm", Some(upper));
    b.place_joint(fore, Vec3::new(0.0, -0.30, 0.0));
    let (_, flexion) = b.hinge("elbow", fore, "flexion", Vec3::Z);
    b.coordinate_mut(flexion).range = Range::new(0.0, 2.6);
    for (name, x, y, z) in [("lateral", 0.02, -0.30, 0.04), ("front", 0.05, -0.15, 0.0)] {
        b.marker(name, Some(upper), Vec3::new(x, y, z));
    }
    for (name, x, y, z) in [("radial", 0.02, -0.25, 0.03), ("ulnar", -0.02, -0.25, -0.02)] {
        b.marker(name, Some(fore), Vec3::new(x, y, z));
    }
    Ok((b.build()?, flexion))
}

fn main() {
    let (model, flexion) = arm().expect("the arm is whole");
    // What the cameras see: a known motion, with one marker hidden for a while.
    let program = Program::compile(&model);
    let mut truth = Pose::new(&program);
    let mut session = Session::new(model);
    let model = Arc::clone(&session.model);
    let mut largest = 0.0f64;
    for frame in 0..100 {
        let angle = 1.0 + 0.8 * (f64::from(frame) * 0.06).sin();
        let mut posture = Posture::of_defaults(&model);
        posture.set(flexion, angle);
        program.evaluate(posture.stored(), Mode::Open, &mut truth).expect("the same model");
        let seen: Vec<Option<[f64; 3]>> = model
            .markers()
            .iter()
            .map(|marker| Some((truth.frame(marker.segment) * marker.point).to_array()))
            .enumerate()
            .map(|(index, place)| place.filter(|_| index != 0 || !(40..60).contains(&frame)))
            .collect();
        let (status, _) = session.frame(&seen);
        assert_eq!(status, FrameStatus::Solved, "frame {frame}");
        let found = model.value(&session.stream.answer().coordinates, flexion);
        largest = largest.max((found - angle).abs());
    }
    // Markers without noise: what is left is the solver's tolerance.
    assert!(largest < 1e-4, "the elbow is off by {largest} rad");
    assert!(session.last.is_some());
    assert_eq!(Wanted::Constant(0.5).at(0), Some(0.5));
    println!("100 frames, one by one: the elbow within {:.2e} rad", largest);
}
