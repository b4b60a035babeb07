//! Where a joint is, from a trial in which it moves.
//!
//! Clusters of a standing trial say in every frame of the motion where parent and child went from there: the child in the parent
//! is Pᵢ⁻¹·Cᵢ, in the laboratory of the standing trial, and the identity while the person stands. A centre or an axis that is fixed in
//! both has two places there, one by each segment: they differ by what the skin moved, and their middle is taken.

use super::{Centre, Cluster, Screw};
use condyle_diagnostics::Error;
use condyle_math::{Affine, Vec3};
use condyle_motion::Recording;

/// Fewest frames that show both segments.
const FEWEST: usize = 10;
/// An axis needs a turn of so much, in radians: 20 degrees, at which 5 mm of skin on 0.1 m are a seventh of it.
const LEAST_TURN: f64 = 0.35;
/// A centre whose worst direction is so many times less determined than its best is an axis.
const WORST_CONDITION: f64 = 60.0;

/// What a motion of a joint shows of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Functional {
    /// A centre: of a hip or a shoulder.
    Centre(FunctionalCentre),
    /// An axis: of a knee or an elbow.
    Axis(FunctionalAxis),
}

/// A centre, seen from the laboratory of the standing trial.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionalCentre {
    /// Its place, in metres.
    pub place: Vec3,
    /// How far its places in parent and child are apart, in metres.
    pub apart: f64,
    /// The root mean square distance of both over the motion, in metres.
    pub rms: f64,
    /// Its condition, as [`Centre::condition`].
    pub condition: f64,
    /// How many frames showed both segments.
    pub frames: usize,
}

/// An axis, seen from the laboratory of the standing trial.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionalAxis {
    /// Its direction, of length 1.
    pub direction: Vec3,
    /// A point of it, in metres.
    pub place: Vec3,
    /// The angle between its directions in parent and child, in radians.
    pub apart: f64,
    /// The root mean square distance of the child's point from the parent's axis, in metres.
    pub rms: f64,
    /// The root mean square angle by which the axis turns, in radians: what is not a hinge.
    pub wobble: f64,
    /// By how much the joint turned about it, in radians.
    pub turned: f64,
    /// How many frames showed both segments.
    pub frames: usize,
}

impl Functional {
    /// The centre of a joint that moves in a trial.
    ///
    /// # Errors
    /// `calibration/frames` where fewer than ten frames show three markers of both segments; `calibration/axis` where the motion
    /// is nearly about one axis, along which the centre is anywhere.
    pub fn centre(
        standing: &Recording,
        motion: &Recording,
        markers: &[Vec<String>; 2],
    ) -> Result<Self, Error> {
        let relative = relative(standing, motion, markers)?;
        let centre = Centre::of(&relative)?;
        if centre.condition > WORST_CONDITION {
            let message = format!(
                "the joint turns nearly about one axis (condition {:.0}): its centre is anywhere along it",
                centre.condition
            );
            let help = "record it turning about two axes, or take its axis";
            return Err(Error::new("calibration/axis", message).with_help(help));
        }
        Ok(Self::Centre(FunctionalCentre {
            place: (centre.in_parent + centre.in_child) * 0.5,
            apart: (centre.in_parent - centre.in_child).norm(),
            rms: centre.rms,
            condition: centre.condition,
            frames: relative.len(),
        }))
    }

    /// The axis of a joint that moves in a trial.
    ///
    /// # Errors
    /// `calibration/frames` as for a centre; `calibration/turn` where it turns by less than 20 degrees or about no one axis.
    pub fn axis(
        standing: &Recording,
        motion: &Recording,
        markers: &[Vec<String>; 2],
    ) -> Result<Self, Error> {
        let relative = relative(standing, motion, markers)?;
        let turn = |message: String| {
            let help = "record it bending by at least 20 degrees, some times";
            Error::new("calibration/turn", message).with_help(help)
        };
        let screw =
            Screw::of(&relative).ok_or_else(|| turn("the joint turns about no axis".to_owned()))?;
        let least = screw.angles.iter().copied().fold(f64::INFINITY, f64::min);
        let most = screw.angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let turned = most - least;
        if turned < LEAST_TURN {
            let message = format!(
                "the joint turns by {:.0} degrees: too little for its axis",
                turned.to_degrees()
            );
            return Err(turn(message));
        }
        let sum = screw.axis_in_parent + screw.axis_in_child;
        let direction = sum.normalized();
        // Both points are anywhere along their axis: at the same height over the laboratory's origin they can be compared.
        let level = |point: Vec3| point - direction * direction.dot(point);
        Ok(Self::Axis(FunctionalAxis {
            direction,
            place: (level(screw.point_in_parent) + level(screw.point_in_child)) * 0.5,
            apart: screw.axis_in_parent.cross(screw.axis_in_child).norm().clamp(0.0, 1.0).asin(),
            rms: screw.rms,
            wobble: screw.wobble,
            turned,
            frames: relative.len(),
        }))
    }

    /// What is said of it: how sure it is.
    #[must_use]
    pub fn describe(&self) -> String {
        match self {
            Self::Centre(c) => format!(
                "centre from {} frames: fixed to {:.1} mm, condition {:.0}, where the person stands {:.1} mm apart in both segments",
                c.frames,
                1e3 * c.rms,
                c.condition,
                1e3 * c.apart
            ),
            Self::Axis(a) => format!(
                "axis from {} frames, a turn of {:.0} degrees: fixed to {:.1} mm and {:.1} degrees, where the person stands {:.1} degrees \
                 apart in both segments",
                a.frames,
                a.turned.to_degrees(),
                1e3 * a.rms,
                a.wobble.to_degrees(),
                a.apart.to_degrees()
            ),
        }
    }
}

/// Where the child went in the parent, frame by frame.
fn relative(
    standing: &Recording,
    motion: &Recording,
    markers: &[Vec<String>; 2],
) -> Result<Vec<Affine>, Error> {
    let [parent, child] = markers.each_ref().map(|labels| {
        let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
        Cluster::standing(standing, &labels)
    });
    let both = |frame| Some((parent.pose(motion, frame)?.0, child.pose(motion, frame)?.0));
    let relative: Vec<Affine> = (0..motion.frames())
        .filter_map(both)
        .map(|(parent, child)| parent.rigid_inverse() * child)
        .collect();
    if relative.len() < FEWEST {
        let message = format!(
            "{} of {} frames show three markers of both segments",
            relative.len(),
            motion.frames()
        );
        let help = "name markers that both trials have";
        return Err(Error::new("calibration/frames", message).with_help(help));
    }
    Ok(relative)
}
