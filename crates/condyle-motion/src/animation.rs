//! A skeleton together with what it does.

use crate::Motion;
use condyle_model::Model;

/// A model and a motion of it, as files hold them that carry a skeleton and its motion together.
///
/// The frames of the motion have the numbers of the model's coordinates in the model's order: each frame
/// is [`Model::stored_len`] numbers long.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_motion::{Animation, Motion};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let motion = Motion { times: vec![0.0, 0.5], frames: vec![vec![0.0], vec![1.0]] };
/// let animation = Animation { model, motion };
/// assert_eq!(animation.motion.frames[1].len(), animation.model.stored_len());
/// assert_eq!(animation.rate(), Some(2.0));
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// The skeleton.
    pub model: Model,
    /// What it does; without frames in a file that holds a skeleton alone.
    pub motion: Motion,
}

impl Animation {
    /// Frames per second on average; `None` with fewer than two frames.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        let times = &self.motion.times;
        let span = times.last()? - times.first()?;
        (span > 0.0).then(|| (times.len() - 1) as f64 / span)
    }
}
