//! The coordinates of one model at one time.

use condyle_model::{CoordinateId, Model};

/// The stored numbers of all coordinates of a model, set and read by coordinate.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::ModelBuilder;
/// use condyle_motion::Posture;
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// let (_, flexion) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let mut posture = Posture::of_defaults(&model);
/// posture.set(flexion, 1.2);
/// assert_eq!(posture.get(flexion), 1.2);
/// assert_eq!(posture.stored(), [1.2]);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Posture<'m> {
    model: &'m Model,
    stored: Vec<f64>,
}

impl<'m> Posture<'m> {
    /// Every coordinate at its default.
    #[must_use]
    pub fn of_defaults(model: &'m Model) -> Self {
        Self { model, stored: model.defaults() }
    }

    /// The value of a coordinate of one number, in radians or metres; of an orientation its x.
    #[must_use]
    pub fn get(&self, id: CoordinateId) -> f64 {
        self.model.value(&self.stored, id)
    }

    /// Sets a coordinate of one number, in radians or metres.
    pub fn set(&mut self, id: CoordinateId, value: f64) {
        *self.model.value_mut(&mut self.stored, id) = value;
    }

    /// All numbers of a coordinate: one, or x, y, z, w of an orientation.
    pub fn numbers_mut(&mut self, id: CoordinateId) -> &mut [f64] {
        &mut self.stored[self.model.stored_range(id)]
    }

    /// The numbers of all coordinates, in the model's order, as a program evaluates them.
    #[must_use]
    pub fn stored(&self) -> &[f64] {
        &self.stored
    }

    /// The same, by value.
    #[must_use]
    pub fn into_stored(self) -> Vec<f64> {
        self.stored
    }
}
