//! A joint with six coordinates, and its model for each arm.

use super::{Arm, Centre, PLANAR_LENGTH, planar};
use crate::coupling::{LawFunction, apply};
use condyle_diagnostics::Error;
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, Law, Model, ModelBuilder, SegmentId, Signal};

/// A model of two segments and a joint between them that has six coordinates: three angles and three places of its centre
/// along the parent's axes.
#[derive(Clone, Debug)]
pub struct Leg {
    model: Model,
    /// Angles in the model's order, then places along x, y and z.
    coordinates: [CoordinateId; 6],
    /// Which of the angles is flexion, about z, and 1 where it turns about +z.
    flexion: (usize, f64),
    segments: [SegmentId; 2],
}

impl Leg {
    /// The leg of a model whose joint is called so.
    ///
    /// Flexion is the first angle about z; without one it is the first angle, about whatever axis.
    ///
    /// # Errors
    /// `arms/joint` where no joint has that name, or where it has not three angles and three places along x, y and z, or moves not
    /// one segment that has a parent.
    ///
    /// ```
    /// use condyle_learn::arms::{Arm, Leg};
    /// # use condyle_learn::calibration::FreeJoint;
    /// # use condyle_motion::{Observed, Recording};
    /// # let markers = [
    /// #     ("RGT", [0.02, 0.90, 0.17]),
    /// #     ("RLFE", [0.0, 0.48, 0.14]),
    /// #     ("RMFE", [0.0, 0.48, 0.04]),
    /// #     ("RTT", [0.06, 0.41, 0.10]),
    /// #     ("RFH", [-0.03, 0.42, 0.15]),
    /// #     ("RMEDMAL", [-0.01, 0.08, 0.06]),
    /// #     ("RLATMAL", [-0.03, 0.07, 0.13]),
    /// # ];
    /// # let standing = Recording {
    /// #     labels: markers.iter().map(|(name, _)| (*name).to_owned()).collect(),
    /// #     times: vec![0.0],
    /// #     positions: markers.iter().map(|(_, place)| Observed::from(*place)).collect(),
    /// #     ..Recording::default()
    /// # };
    /// // Seven markers of a person who stands.
    /// let leg = Leg::of(&FreeJoint::knee_pronost2010().model(&standing)?, "knee_r")?;
    /// let hinge = leg.arm(Arm::Hinge, None)?;
    /// let free = |name: &str| !hinge.coordinate(hinge.find_coordinate(name).unwrap()).locked;
    /// assert!(free("knee_r_flexion") && !free("knee_r_adduction") && !free("knee_r_tx"));
    /// // The centre is 0.42 m below the trochanter while the person stands.
    /// assert!((leg.standing()[1] + 0.42).abs() < 0.01);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn of(model: &Model, joint: &str) -> Result<Self, Error> {
        let wrong = |message: String| {
            Error::new("arms/joint", message)
                .with_help("make the model from a standing trial with `condyle learn joint`")
        };
        let set = model
            .joint_set_ids()
            .find(|set| model.joint_sets()[set.index()].name == joint)
            .ok_or_else(|| wrong(format!("no joint is called `{joint}`")))?;
        let moved: Vec<SegmentId> = model.outputs_of(set).map(|(segment, _)| segment).collect();
        let [child] = moved[..] else {
            return Err(wrong(format!("`{joint}` moves {} segments, not one", moved.len())));
        };
        let Some(parent) = model.segment(child).parent else {
            return Err(wrong(format!("the segment that `{joint}` moves has no parent")));
        };
        // The axis of each coordinate is that of the component that reads it.
        let axis = |id: CoordinateId| {
            let reader =
                model.components_of(set).find(|c| model.reads(*c) == [Signal::from(id)])?;
            match &model.components()[reader.index()].law {
                Law::Rotate(rotate) => Some(rotate.axis),
                Law::Translate(translate) => Some(translate.axis),
                _ => None,
            }
        };
        let of_kind = |kind: CoordinateKind| -> Vec<CoordinateId> {
            let all = model.coordinates_of(set);
            all.filter(|id| model.coordinate(*id).kind == kind).collect()
        };
        let angles = of_kind(CoordinateKind::Rotation);
        let places = of_kind(CoordinateKind::Translation);
        let along = [Vec3::X, Vec3::Y, Vec3::Z]
            .map(|direction| places.iter().copied().find(|id| axis(*id) == Some(direction)));
        let (&[a, b, c], [Some(x), Some(y), Some(z)]) = (&angles[..], along) else {
            let message = format!("`{joint}` has not three angles and three places along x, y, z");
            return Err(wrong(message));
        };
        let about_z = angles.iter().enumerate().find_map(|(at, id)| {
            let axis = axis(*id)?;
            (axis == Vec3::Z || axis == -Vec3::Z).then_some((at, axis.z))
        });
        Ok(Self {
            model: model.clone(),
            coordinates: [a, b, c, x, y, z],
            flexion: about_z.unwrap_or((0, 1.0)),
            segments: [parent, child],
        })
    }

    /// The model, whose six coordinates are free.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The angles in the joint's order, then the places along x, y and z of the parent.
    #[must_use]
    pub fn coordinates(&self) -> [CoordinateId; 6] {
        self.coordinates
    }

    /// Their keys: the columns of samples.
    #[must_use]
    pub fn keys(&self) -> [String; 6] {
        self.coordinates.map(|id| self.model.coordinate_key(id))
    }

    /// The six values in a frame of a motion of the model, or of an arm's.
    #[must_use]
    pub fn values(&self, stored: &[f64]) -> [f64; 6] {
        self.coordinates.map(|id| self.model.value(stored, id))
    }

    /// The parent and the child.
    #[must_use]
    pub fn segments(&self) -> [SegmentId; 2] {
        self.segments
    }

    /// The names of the markers of the parent and of the child.
    #[must_use]
    pub fn markers(&self) -> [Vec<&str>; 2] {
        self.segments.map(|segment| {
            let markers = self.model.markers().iter();
            markers.filter(|m| m.segment == Some(segment)).map(|m| m.name.as_str()).collect()
        })
    }

    /// Where the centre is in the parent while the person stands, in metres.
    #[must_use]
    pub fn standing(&self) -> [f64; 3] {
        [3, 4, 5].map(|place| self.model.coordinate(self.coordinates[place]).default[0])
    }

    /// How large the planar knee is here: the distance of the centre from the parent's origin along y over that of the source.
    #[must_use]
    pub fn planar_factor(&self) -> f64 {
        self.standing()[1].abs() / PLANAR_LENGTH
    }

    /// The model of an arm; what was learned is asked of those that [take something from recordings](Arm::is_learned).
    ///
    /// # Errors
    /// `arms/centre` where nothing was learned for an arm that needs it; those of [`planar`] and [`apply`].
    pub fn arm(&self, arm: Arm, centre: Option<&Centre>) -> Result<Model, Error> {
        let learned = || {
            let message = format!("the arm `{}` needs what was learned", arm.name());
            centre.ok_or_else(|| Error::new("arms/centre", message))
        };
        let mut model = match arm {
            Arm::Free => self.model.clone(),
            Arm::Hinge => self.hinge()?,
            Arm::Planar => self.planar()?,
            Arm::Fixed => self.fixed(learned()?.mean)?,
            Arm::FixedBest => {
                let message = "the arm `fixed-best` needs the best centre of recordings";
                let best = learned()?.best;
                self.fixed(best.ok_or_else(|| Error::new("arms/centre", message))?)?
            }
            Arm::FixedC4 => self.fixed(learned()?.at_zero())?,
            Arm::Learned => {
                let centre = learned()?;
                let keys = self.keys();
                let laws: Vec<(&str, &LawFunction)> =
                    keys[3..].iter().map(String::as_str).zip(&centre.laws).collect();
                apply(&self.model, &keys[..3], Some(&centre.region), &laws)?
            }
        };
        model.set_name(&format!("{}-{}", self.model.name(), arm.name()));
        Ok(model)
    }

    fn locked_but_flexion(&self) -> ModelBuilder {
        let mut b = ModelBuilder::from(self.model.clone());
        for (at, id) in self.coordinates.into_iter().enumerate() {
            b.coordinate_mut(id).locked = at != self.flexion.0;
        }
        b
    }

    fn hinge(&self) -> Result<Model, Error> {
        self.locked_but_flexion().build()
    }

    fn planar(&self) -> Result<Model, Error> {
        let (at, sense) = self.flexion;
        let [x, y, _] = self.standing();
        let flexion = self.coordinates[at];
        let from = self.model.coordinate(flexion).default[0];
        let glides = planar(self.planar_factor(), sense, from, Some([x, y]))?;
        let mut b = self.locked_but_flexion();
        let set = self.model.coordinate(flexion).joint_set;
        for (place, glide) in self.coordinates[3..].iter().zip(glides) {
            let name = format!("{}_glide", self.model.coordinate(*place).name);
            let glide = b.map(set, &name, flexion, glide);
            b.coordinate_mut(*place).locked = false;
            b.follow(*place, glide);
        }
        b.build()
    }

    fn fixed(&self, centre: [f64; 3]) -> Result<Model, Error> {
        let mut b = ModelBuilder::from(self.model.clone());
        for (place, value) in self.coordinates[3..].iter().zip(centre) {
            b.coordinate_mut(*place).default[0] = value;
            b.coordinate_mut(*place).locked = true;
        }
        b.build()
    }
}
