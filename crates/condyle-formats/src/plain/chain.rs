//! Chains of plain joints.

use super::rule::{Rules, Value};
use condyle_math::{Affine, Mat3, Quat, Vec3};
use condyle_model::SegmentId;
use condyle_model::model::ComponentId;

/// One part of a chain.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A frame fixed in the one before it.
    Fixed(Affine),
    /// A turn about an axis through the origin.
    Turn {
        /// The axis, of length 1.
        axis: Vec3,
        /// The angle.
        value: Value,
    },
    /// A slide along an axis.
    Slide {
        /// The axis, of length 1.
        axis: Vec3,
        /// The distance.
        value: Value,
    },
    /// An orientation, by its position among those of the tree, or its inverse.
    Ball {
        /// Which.
        orientation: usize,
        /// Whether it turns back.
        inverse: bool,
    },
}

/// The chain of one segment.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its segment.
    pub segment: SegmentId,
    /// The segment's name.
    pub name: String,
    /// The name of its joint: that of the joint set, where it moves nothing else.
    pub joint: String,
    /// The link it hangs from, by its position.
    pub parent: Option<usize>,
    /// From the parent to the segment.
    pub steps: Vec<Step>,
    /// What of it is measured.
    pub measured: Option<Measured>,
}

/// A part of a chain that no rule computes: a frame at rest, three slides and three turns about x, y, z.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The position of its first step, the frame at rest.
    pub at: usize,
    /// That frame.
    pub rest: Affine,
    /// The values of its slides and turns.
    pub slots: [Value; 6],
    /// The values that it depends on, as far as they are known.
    pub drivers: Vec<Value>,
    /// The components that it is made of.
    pub components: Vec<ComponentId>,
    /// What it is, for messages.
    pub what: String,
}

impl Step {
    /// Its transform at values, and at orientations by their positions.
    pub fn transform(&self, values: &[f64], orientation: &dyn Fn(usize) -> Quat) -> Affine {
        let at = |v: Value| values.get(v).copied().unwrap_or(0.0);
        match *self {
            Self::Fixed(frame) => frame,
            Self::Turn { axis, value } => {
                Affine::from_rotation(Mat3::rotation_about(axis, at(value).sin_cos()))
            }
            Self::Slide { axis, value } => Affine::from_translation(axis * at(value)),
            Self::Ball { orientation: which, inverse } => {
                let turn = orientation(which).to_mat3();
                Affine::from_rotation(if inverse { turn.transpose() } else { turn })
            }
        }
    }

    /// The step that undoes it.
    pub fn inverse(&self) -> Self {
        match *self {
            Self::Fixed(frame) => Self::Fixed(frame.rigid_inverse()),
            Self::Turn { axis, value } => Self::Turn { axis: -axis, value },
            Self::Slide { axis, value } => Self::Slide { axis: -axis, value },
            Self::Ball { orientation, inverse } => Self::Ball { orientation, inverse: !inverse },
        }
    }

    /// The step without translation; nothing of a slide.
    pub fn rotation(&self) -> Option<Self> {
        match self {
            Self::Fixed(frame) => Some(Self::Fixed(Affine::from_rotation(frame.linear))),
            Self::Slide { .. } => None,
            other => Some(other.clone()),
        }
    }

    /// The value that it moves by.
    pub fn value(&self) -> Option<Value> {
        match self {
            Self::Turn { value, .. } | Self::Slide { value, .. } => Some(*value),
            Self::Fixed(_) | Self::Ball { .. } => None,
        }
    }
}

/// A chain with neighbouring frames joined, constant motions fixed, and motions that undo each other left out.
pub fn simplified(steps: &[Step], rules: &Rules) -> Vec<Step> {
    let mut out: Vec<Step> = vec![];
    for step in steps {
        let step = match step.value().and_then(|value| rules.as_constant(value).map(|c| (value, c)))
        {
            Some((value, constant)) => {
                let mut values = vec![0.0; value + 1];
                values[value] = constant;
                Step::Fixed(step.transform(&values, &|_| Quat::IDENTITY))
            }
            None => step.clone(),
        };
        match (out.last_mut(), &step) {
            (_, Step::Fixed(frame)) if is_identity(frame) => continue,
            (Some(Step::Fixed(before)), Step::Fixed(frame)) => {
                *before = *before * *frame;
                if is_identity(before) {
                    out.pop();
                }
                continue;
            }
            (Some(before), after) if undoes(before, after) => {
                out.pop();
                continue;
            }
            _ => out.push(step),
        }
    }
    out
}

/// The values that a chain depends on: motions that others undo are left out, in whatever order they do.
pub(super) fn moving(steps: &[Step], count: usize) -> Vec<Value> {
    let mut candidates: Vec<Value> = steps.iter().filter_map(Step::value).collect();
    candidates.sort_unstable();
    candidates.dedup();
    // Numbers without any relation to each other.
    let number = |k: usize| 0.9 * ((k * k + 3 * k) as f64 * 0.618_034).fract() - 0.4;
    let whole = |values: &[f64]| {
        let turned = |which: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| number(3 * which + axis));
            Quat::exp(Vec3::new(x, y, z)).normalized()
        };
        steps.iter().fold(Affine::IDENTITY, |so_far, step| so_far * step.transform(values, &turned))
    };
    let mut values: Vec<f64> = (0..count).map(number).collect();
    let start = whole(&values);
    candidates.retain(|&value| {
        let before = values[value];
        values[value] = before + 0.3;
        let moved = whole(&values);
        values[value] = before;
        let apart = |a: Vec3, b: Vec3| (a - b).norm();
        apart(start.translation, moved.translation) > 1e-12
            || apart(start.linear.x, moved.linear.x) > 1e-12
            || apart(start.linear.y, moved.linear.y) > 1e-12
            || apart(start.linear.z, moved.linear.z) > 1e-12
    });
    candidates
}

fn undoes(before: &Step, after: &Step) -> bool {
    match (before, after) {
        (Step::Turn { axis, value }, Step::Turn { axis: back, value: same })
        | (Step::Slide { axis, value }, Step::Slide { axis: back, value: same }) => {
            value == same && (*axis + *back).norm() < 1e-15
        }
        (Step::Ball { orientation, inverse }, Step::Ball { orientation: same, inverse: other }) => {
            orientation == same && inverse != other
        }
        _ => false,
    }
}

/// Whether a frame is the identity up to rounding.
pub(crate) fn is_identity(frame: &Affine) -> bool {
    let near = |a: Vec3, b: Vec3| (a - b).norm() < 1e-15;
    near(frame.translation, Vec3::ZERO)
        && near(frame.linear.x, Vec3::X)
        && near(frame.linear.y, Vec3::Y)
        && near(frame.linear.z, Vec3::Z)
}
