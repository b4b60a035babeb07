//! What limits the rotation of a segment as a whole: a learned field, or a cone with twist.

use super::super::figure::Figure;
use super::{cone, field};
use condyle_math::Quat;
use condyle_model::component::{FieldLimit, JointCone, Swinging};
use condyle_model::evaluate::Bound;
use condyle_model::limit::{Limit, MOST_LIMITED};
use condyle_model::{Law, Pose, SegmentId};

/// A limit of rotations.
pub(in super::super) struct Judged<'a> {
    pub(in super::super) bound: &'a Bound,
    law: Kind<'a>,
    /// The numbers beside the rotation, as they are now.
    numbers: Vec<f64>,
    /// What it is of, in words.
    pub(in super::super) title: String,
}

enum Kind<'a> {
    Field(&'a FieldLimit),
    Cone(&'a JointCone),
}

impl<'a> Judged<'a> {
    /// The limit of one of some segments: a field before a cone.
    pub(in super::super) fn of(figure: &'a Figure, segments: &[SegmentId]) -> Option<Self> {
        let components = figure.model.components();
        let own = |bound: &'a Bound| {
            let numbers: Vec<f64> = figure.pose.bounded(bound).collect();
            let component = &components[bound.component.index()];
            let (law, segment) = match &component.law {
                Law::Field(law) => {
                    let now = field::rotation(&numbers)?;
                    (Kind::Field(law), field::turned(figure, bound, now)?.0)
                }
                Law::Cone(law) if !matches!(law.of, Swinging::Directions(_)) => {
                    let turned = |numbers: &[f64]| cone::rotation(law, numbers);
                    let said = cone::Said { rotation: &turned, off: &|a, b| cone::off(law, a, b) };
                    let now = turned(&numbers)?;
                    (Kind::Cone(law), cone::frame(figure, bound, &said, now)?.0)
                }
                _ => return None,
            };
            let title = format!("{} by {}", figure.model.segment(segment).name, component.name);
            segments.contains(&segment).then_some(Self { bound, law, numbers, title })
        };
        let mut all: Vec<Self> = figure.program.bounds().iter().filter_map(own).collect();
        let first = all.iter().position(|one| matches!(one.law, Kind::Field(_))).unwrap_or(0);
        (!all.is_empty()).then(|| all.swap_remove(first))
    }

    /// The signed distance to the boundary, in radians: of a cone the least of its rows.
    pub(in super::super) fn distance(&self, q: Quat) -> f64 {
        match self.law {
            Kind::Field(law) => {
                let mut asked = [0.0; MOST_LIMITED];
                asked.iter_mut().zip(&self.numbers).for_each(|(to, from)| *to = *from);
                asked[..4].copy_from_slice(&q.to_array());
                law.distance(&asked[..self.numbers.len().min(MOST_LIMITED)])
            }
            Kind::Cone(law) => {
                let rows = law.cone.rows(q.to_mat3());
                rows.into_iter().map(|(value, _)| value).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// What else the distance depends on.
    pub(in super::super) fn others(&self) -> &[f64] {
        match self.law {
            Kind::Field(_) => self.numbers.get(4..).unwrap_or_default(),
            Kind::Cone(_) => &[],
        }
    }

    /// The rotation of a pose, and its distance.
    pub(in super::super) fn at(&self, pose: &Pose) -> Option<(Quat, f64)> {
        let numbers: Vec<f64> = pose.bounded(self.bound).collect();
        let turned = match self.law {
            Kind::Field(_) => field::rotation(&numbers)?,
            Kind::Cone(law) => cone::rotation(law, &numbers)?,
        };
        let q = Quat::from_mat3(turned);
        match self.law {
            Kind::Field(law) => Some((q, law.distance(&numbers))),
            Kind::Cone(_) => Some((q, self.distance(q))),
        }
    }

    /// The nearest rotation that is allowed, as the limit moves a pose to it.
    pub(in super::super) fn nearest(&self, pose: &Pose) -> Option<Quat> {
        let numbers: Vec<f64> = pose.bounded(self.bound).collect();
        let turned = match self.law {
            Kind::Field(law) => field::rotation(&law.legal(&numbers)?[..numbers.len()])?,
            Kind::Cone(law) => law.cone.legal(cone::rotation(law, &numbers)?).rotation,
        };
        Some(Quat::from_mat3(turned))
    }

    /// The rotations that it was learned from.
    pub(in super::super) fn samples(&self) -> Vec<Quat> {
        match self.law {
            Kind::Field(law) => {
                let samples = law.limit.ground().samples.iter();
                samples.map(|q| law.outward(*q).normalized()).collect()
            }
            Kind::Cone(_) => vec![],
        }
    }
}
