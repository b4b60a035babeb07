//! A free joint from a standing trial.
//!
//! As Pronost et al. 2010 have it (3.1, 3.2): landmarks give the joint's frame while the person stands; parent and child have
//! the same axes there, so that all angles are 0; six coordinates lead from the parent to the child, three translations of the
//! joint's centre along the parent's axes and three rotations in an order that is told. The parent moves freely in the
//! laboratory.
//!
//! Where a trial shows the joint moving, its axis or its centre may come from there ([`Functional`](super::Functional)), and the axes of
//! both segments from a recipe, such as those of the International Society of Biomechanics; parent and child have different axes
//! then, and the angles of the standing person are not 0.

use super::{Cluster, Functional};
use crate::frames::Recipe;
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::{CoordinateKind, JointSetId, Model, ModelBuilder, Signal};
use condyle_motion::Recording;

/// Flexion about z of the parent, adduction about the floating x, rotation about y of the child (Grood & Suntay 1983).
fn grood_suntay() -> EulerOrder {
    let zxy = |order: &&EulerOrder| order.axes() == [2, 0, 1];
    EulerOrder::ALL.iter().find(zxy).copied().unwrap_or(EulerOrder::XYZ)
}

/// How a free joint is made from a standing trial.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeJoint {
    /// A name for the joint.
    pub name: String,
    /// The parent and the child.
    pub segments: [String; 2],
    /// The markers of each.
    pub markers: [Vec<String>; 2],
    /// The marker at the parent's origin.
    pub origin: String,
    /// The marker at the medial end of the joint's axis, and at its lateral end; the centre is between them.
    pub ends: [String; 2],
    /// Whether the side is the left one, on which the lateral end is the left end.
    pub left: bool,
    /// The order of the rotations, and their names.
    pub order: EulerOrder,
    /// Names of the rotations, in that order.
    pub angles: [String; 3],
    /// The axes of the child and of its reference, which is the parent; without it both have those of the landmarks.
    pub axes: Option<Recipe>,
}

/// The frames of a joint in the laboratory while the person stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// The parent's, at its origin.
    pub parent: Affine,
    /// The child's, at the joint's centre.
    pub child: Affine,
}

impl FreeJoint {
    /// The right knee of Pronost et al. 2010: z along the epicondyles to the right (RMFE to RLFE), y in the plane of both and the great
    /// trochanter RGT upwards, x forward; rotations as Grood & Suntay 1983 order them: flexion about z of the thigh, adduction about the
    /// floating x, rotation about y of the shank.
    #[must_use]
    pub fn knee_pronost2010() -> Self {
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Self {
            name: "knee_r".to_owned(),
            segments: ["thigh_r".to_owned(), "shank_r".to_owned()],
            markers: [
                owned(&["RGT", "RLFE", "RMFE"]),
                owned(&["RTT", "RFH", "RMEDMAL", "RLATMAL"]),
            ],
            origin: "RGT".to_owned(),
            ends: ["RMFE".to_owned(), "RLFE".to_owned()],
            left: false,
            order: grood_suntay(),
            angles: ["flexion", "adduction", "rotation"].map(str::to_owned),
            axes: None,
        }
    }

    /// The frames of parent and child while the person stands, with the axis or the centre that a motion of the joint shows.
    ///
    /// z goes along the ends to the right, y in the plane of both and the origin upwards, x forward. An axis that was found takes the place
    /// of the ends; the centre is its point nearest to their middle. A centre that was found takes the place of the middle. A recipe of
    /// axes gives the directions, whatever the axis is.
    ///
    /// # Errors
    /// `calibration/marker` for a landmark that no frame of the trial shows, `calibration/frame` where the landmarks lie on a line;
    /// those of [`Recipe::standing`].
    pub fn frames(
        &self,
        standing: &Recording,
        functional: Option<&Functional>,
    ) -> Result<Standing, Error> {
        let of = |label: &String| {
            Cluster::standing(standing, &[label]).point(label).ok_or_else(|| {
                let message = format!("the standing trial shows no `{label}`");
                Error::new("calibration/marker", message)
                    .with_help("name the markers of the trial in the recipe")
            })
        };
        let [medial, lateral, top] = [of(&self.ends[0])?, of(&self.ends[1])?, of(&self.origin)?];
        let mut side = if self.left { medial - lateral } else { lateral - medial };
        let mut centre = (medial + lateral) * 0.5;
        match functional {
            None => {}
            Some(Functional::Centre(found)) => centre = found.place,
            Some(Functional::Axis(found)) => {
                let along = found.direction * found.direction.dot(side).signum();
                centre = found.place + along * along.dot(centre - found.place);
                side = along;
            }
        }
        let up = top - centre;
        let z = side.normalized();
        let y = up - z * z.dot(up);
        if !(side.norm() > 1e-6 && y.norm() > 0.05 * up.norm()) {
            let message = "the landmarks of the joint lie on a line";
            return Err(Error::new("calibration/frame", message));
        }
        let y = y.normalized();
        let landmarks = Mat3::from_columns(y.cross(z), y, z);
        let (parent, child) = match &self.axes {
            None => (landmarks, landmarks),
            Some(recipe) => {
                let (reference, child) = recipe.standing(standing)?;
                (reference.unwrap_or(landmarks), child)
            }
        };
        let at = |place, axes| Affine::from_translation(place) * Affine::from_rotation(axes);
        Ok(Standing { parent: at(top, parent), child: at(centre, child) })
    }

    /// How far a marker of the joint is from its mean in the standing trial at most, in metres: of a person who stands still
    /// some millimetres.
    #[must_use]
    pub fn unrest(&self, standing: &Recording) -> f64 {
        let mut most = 0.0f64;
        for label in self.markers.iter().flatten().chain([&self.origin]).chain(&self.ends) {
            let Some(mean) = Cluster::standing(standing, &[label]).point(label) else { continue };
            let Some(marker) = standing.marker(label) else { continue };
            for frame in 0..standing.frames() {
                if let Some(place) = standing.position(frame, marker) {
                    most = most.max((Vec3::from(place) - mean).norm());
                }
            }
        }
        most
    }

    /// The model: parent and child with their markers where the standing trial has them.
    ///
    /// # Errors
    /// Those of [`Self::frames`]; `calibration/cluster` where a segment has fewer than three markers in the trial.
    pub fn model(&self, standing: &Recording) -> Result<Model, Error> {
        self.model_at(standing, &self.frames(standing, None)?)
    }

    /// The same with frames that are given.
    ///
    /// # Errors
    /// `calibration/cluster` where a segment has fewer than three markers in the trial.
    pub fn model_at(&self, standing: &Recording, frames: &Standing) -> Result<Model, Error> {
        let Standing { parent: parent_frame, child: joint } = *frames;
        let mut b = ModelBuilder::new(&self.name);
        let [above, below] = &self.segments;
        let parent = b.segment(above, None);
        let child = b.segment(below, Some(parent));
        let (ground, knee) = (b.joint_set(&format!("{above}_free")), b.joint_set(&self.name));
        let names = ["x", "y", "z"];
        let free = names.map(|axis| (format!("{above}_t{axis}"), format!("{above}_r{axis}")));
        let (places, turns): (Vec<String>, Vec<String>) = free.into_iter().unzip();
        let place = six(&mut b, ground, &places, &turns, EulerOrder::XYZ, parent_frame);
        b.output(ground, parent, place);
        let places = names.map(|axis| format!("{}_t{axis}", self.name));
        let turns = self.angles.clone().map(|angle| format!("{}_{angle}", self.name));
        let start = parent_frame.rigid_inverse() * joint;
        let place = six(&mut b, knee, &places, &turns, self.order, start);
        b.output(knee, child, place);
        for (segment, (frame, labels)) in
            [parent, child].into_iter().zip([parent_frame, joint].into_iter().zip(&self.markers))
        {
            let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
            let cluster = Cluster::standing(standing, &labels).within(frame);
            if cluster.labels.len() < 3 {
                let message = format!(
                    "the standing trial shows {} of the markers {}",
                    cluster.labels.len(),
                    condyle_diagnostics::listed(&labels)
                );
                return Err(Error::new("calibration/cluster", message)
                    .with_help("a segment needs three markers that are not on a line"));
            }
            for (label, point) in cluster.labels.iter().zip(&cluster.points) {
                b.marker(label, Some(segment), *point);
            }
        }
        b.build()
    }
}

/// Three translations and three rotations, which at their defaults give a transform.
fn six(
    b: &mut ModelBuilder,
    set: JointSetId,
    places: &[String],
    turns: &[String],
    order: EulerOrder,
    start: Affine,
) -> Signal {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut parts = vec![];
    for ((name, axis), value) in places.iter().zip(axes).zip(start.translation.to_array()) {
        let id = b.coordinate(set, name, CoordinateKind::Translation);
        b.coordinate_mut(id).default[0] = value;
        parts.push(b.translate(set, &format!("{name}_along"), id, axis));
    }
    let values = order.from_mat3(start.linear);
    for ((name, axis), value) in turns.iter().zip(order.axes()).zip(values) {
        let id = b.coordinate(set, name, CoordinateKind::Rotation);
        b.coordinate_mut(id).default[0] = value;
        parts.push(b.rotate(set, &format!("{name}_about"), id, axes[axis]));
    }
    b.product(set, "motion", parts)
}
