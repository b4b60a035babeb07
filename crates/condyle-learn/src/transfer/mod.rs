//! A law of one person's joint on another figure, by three landmarks of the parent (Pronost, Sandholm & Thalmann 2010, section
//! 4.2 and Figure 4).
//!
//! Their five steps, with L the landmarks' frame (its origin o and its axes Q, as columns), 1 the law's parent, 2 the target's:
//!
//! 1. three landmarks on the law's parent: at its origin, at the medial and at the lateral end of the joint's axis;
//! 2. the same three on the target's parent ([`Landmarks`]);
//! 3. the law is scaled by their distances ([`SizeRatios`]): S = diag(f), from equation (3), or each axis by its own;
//! 4. both landmark frames: z from the medial to the lateral end, to the right; y in their plane toward the origin; x forward;
//! 5. two rotations that take the target's joint into the law's angles, and back: with T the orientation of the child in its
//!    parent and T₀ the one in which the law's angles are 0
//!
//! ```text
//! R = A·T·B      A = Q₁·K·Q₂ᵀ      B = T₀ᵀ·Aᵀ      R = R(a₁, α₁)·R(a₂, α₂)·R(a₃, α₃), the order of the law
//! c = o₂ + Q₂·M·S·Q₁ᵀ·(d(α) - o₁)               where the child's joint is in the target's parent
//! ```
//!
//! M mirrors z and K turns by half a turn about z where one is a left and the other a right joint; else both are the identity.
//! Where the law was learned in its landmarks' frame, as `learn joint` makes it, Q₁ is the identity and o₁ is 0: then the
//! coefficients along x, y and z are simply multiplied.
//!
//! | module | what |
//! | --- | --- |
//! | `landmarks` | three landmarks and their frame |
//! | `asked` | which joint of a target is meant, and where its landmarks are |
//! | `onto` | the law in a model |

mod asked;
mod landmarks;
mod onto;
#[cfg(test)]
mod tests;

pub use asked::{Along, LandmarkPlace, LawFrame, Standing, TargetJoint};
pub use landmarks::Landmarks;

use crate::coupling::{LawFunction, ScaleRule, SizeRatios, scaled};
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::component::Region;

/// What a law is a function of.
#[derive(Clone, Debug, PartialEq)]
pub enum Driver {
    /// An angle of the joint itself, by its place in the order.
    Angle(usize),
    /// A coordinate of the target, of any joint.
    Coordinate(String),
}

/// A translation of the joint's centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// The law's name for it.
    pub name: String,
    /// The direction in the landmarks' axes, of length 1.
    pub along: Vec3,
    /// What its law was multiplied by.
    pub factor: f64,
    /// The scaled law, in metres.
    pub law: LawFunction,
}

/// A law made ready for the joint of another figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// What the laws are functions of, in their order.
    pub drivers: Vec<Driver>,
    /// The law's names for these.
    pub controls: Vec<String>,
    /// Where the controls were when the law was learned.
    pub region: Option<Region>,
    /// The order of the law's rotations.
    pub order: EulerOrder,
    /// The law's names of its angles.
    pub angles: [String; 3],
    /// The landmarks' frame in the target's parent.
    pub frame: Affine,
    /// A and B of step 5.
    pub to_law: [Mat3; 2],
    /// The part of the centre that no law moves, in the landmarks' axes (metres).
    pub fixed: Vec3,
    /// The translations of the centre.
    pub slides: Vec<Slide>,
    /// Laws of the joint's own angles, where these follow.
    pub turned: [Option<LawFunction>; 3],
    /// s₁ and s₂.
    pub ratios: SizeRatios,
    /// What laws along x, y and z of the landmarks' axes are multiplied by.
    pub factors: [f64; 3],
    /// Whether it goes from one side of the body to the other.
    pub mirrored: bool,
}

/// The laws of a joint, by the names of what follows.
#[derive(Clone, Copy, Debug)]
pub struct JointLaws<'a> {
    /// The coordinates in control.
    pub controls: &'a [String],
    /// Each coordinate that follows, with its law.
    pub laws: &'a [(&'a str, &'a LawFunction)],
    /// Where the controls were.
    pub region: Option<&'a Region>,
    /// Where the landmarks are, and which names are which angle and which translation.
    pub frame: &'a LawFrame,
}

/// Whether a coordinate of a law is the one that a frame names: by its name, or by its end, as `knee_r_flexion` is `flexion`.
fn is_named(coordinate: &str, name: &str) -> bool {
    let before = coordinate.strip_suffix(name);
    before.is_some_and(|before| before.is_empty() || before.ends_with(['_', '/', '.', ' ']))
}

impl Transfer {
    /// Steps 3 to 5: the laws scaled and turned into the landmarks' frame of a target. `at_zero` is the orientation of the child in
    /// the target's parent where the law's angles are 0; `elsewhere` gives the target's name for a control that is none of the
    /// joint's angles.
    ///
    /// # Errors
    /// `transfer/landmarks` where three landmarks make no frame; `transfer/law` where no law gives a translation that should follow,
    /// or a law of something else is there.
    pub fn new(
        joint: &JointLaws<'_>,
        target: Landmarks,
        at_zero: Mat3,
        rule: ScaleRule,
        elsewhere: &dyn Fn(&str) -> String,
    ) -> Result<Self, Error> {
        let own = joint.frame.landmarks;
        let (first, second) = (own.frame()?, target.frame()?);
        let ratios = SizeRatios::between(own.points(), target.points())?;
        let factors = ratios.factors(rule);
        let mirrored = own.left != target.left;
        let half = match mirrored {
            true => Mat3::from_columns(-Vec3::X, -Vec3::Y, Vec3::Z),
            false => Mat3::IDENTITY,
        };
        let side = if mirrored { -1.0 } else { 1.0 };
        let stretch = Vec3::new(factors[0], factors[1], side * factors[2]);
        let angle = |name: &str| joint.frame.angles.iter().position(|own| is_named(name, own));
        let drivers = joint.controls.iter().map(|name| match angle(name) {
            Some(k) => Driver::Angle(k),
            None => Driver::Coordinate(elsewhere(name)),
        });
        let mut fixed = stretch.times(first.linear.transpose() * -first.translation);
        let mut slides = vec![];
        let mut used = vec![];
        for (along, axis) in joint.frame.centre.iter().zip(Vec3::UNITS) {
            let direction = stretch.times(first.linear.transpose() * axis);
            let name = match along {
                Along::Fixed(place) => {
                    fixed += direction * *place;
                    continue;
                }
                Along::Follows(name) => name,
            };
            let law = joint.laws.iter().find(|(dependent, _)| is_named(dependent, name));
            let Some((dependent, function)) = law else {
                let message = format!("no law gives the translation `{name}`");
                let help = "name the coordinates that follow along x, y and z of the law's parent in `centre`, or give a \
                            number in metres for one that does not";
                return Err(Error::new("transfer/law", message).with_help(help));
            };
            used.push(*dependent);
            let factor = direction.norm();
            slides.push(Slide {
                name: (*dependent).to_owned(),
                along: direction * (1.0 / factor),
                factor,
                law: scaled(function, factor),
            });
        }
        let mut turned = [None, None, None];
        for (dependent, function) in joint.laws {
            match angle(dependent) {
                Some(k) => turned[k] = Some((*function).clone()),
                None if used.contains(dependent) => {}
                None => {
                    let message =
                        format!("`{dependent}` is no angle and no translation of the joint");
                    let help = "name it in `angles` or `centre`, or transfer a law without it";
                    return Err(Error::new("transfer/law", message).with_help(help));
                }
            }
        }
        let a = first.linear * half * second.linear.transpose();
        Ok(Self {
            drivers: drivers.collect(),
            controls: joint.controls.to_vec(),
            region: joint.region.cloned(),
            order: joint.frame.order,
            angles: joint.frame.angles.clone(),
            frame: second,
            to_law: [a, at_zero.transpose() * a.transpose()],
            fixed,
            slides,
            turned,
            ratios,
            factors,
            mirrored,
        })
    }

    /// The joint's centre in the landmarks' axes, in metres, for controls in their order.
    #[must_use]
    pub fn centre(&self, controls: &[f64]) -> Vec3 {
        self.slides
            .iter()
            .fold(self.fixed, |sum, slide| sum + slide.along * slide.law.value(controls))
    }

    /// The law's angles for an orientation of the child in the target's parent, in radians.
    #[must_use]
    pub fn angles_of(&self, child_in_parent: Mat3) -> [f64; 3] {
        self.order.from_mat3(self.to_law[0] * child_in_parent * self.to_law[1])
    }

    /// The orientation of the child in the target's parent for the law's angles.
    #[must_use]
    pub fn orientation(&self, angles: [f64; 3]) -> Mat3 {
        let [a, b] = self.to_law;
        a.transpose() * self.order.to_mat3(angles) * b.transpose()
    }

    /// Moves the centre by a fixed step so that it is at this point of the target's parent where the controls are `at`: the joint stays
    /// where the target has it, and the law says only how it travels.
    pub fn hold(&mut self, point: Vec3, at: &[f64]) {
        let wanted = self.frame.rigid_inverse() * point;
        self.fixed += wanted - self.centre(at);
    }
}
