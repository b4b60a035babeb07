//! How far a tree is from its model.

use super::{Legal, Tree};
use condyle_math::{Affine, Quat};
use condyle_model::Model;

/// The largest difference of a link from its segment, both in the parent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkError {
    /// Of the origin, in metres.
    pub length: f64,
    /// Of the orientation, in radians.
    pub angle: f64,
}

impl LinkError {
    /// The difference of two transforms.
    pub fn between(a: Affine, b: Affine) -> Self {
        let turn = Quat::from_mat3(a.linear.transpose() * b.linear);
        let angle = 2.0 * turn.vector().norm().atan2(turn.w.abs());
        Self { length: (a.translation - b.translation).norm(), angle }
    }

    /// The larger of both, part by part.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { length: self.length.max(other.length), angle: self.angle.max(other.angle) }
    }
}

/// The largest difference of each link over so many legal poses, in the order of the links.
pub fn measure(model: &Model, tree: &Tree, poses: usize) -> Vec<LinkError> {
    let mut errors = vec![LinkError::default(); tree.links.len()];
    let mut legal = Legal::new(model, 77);
    for number in 0..poses {
        let (stored, pose) = if number == 0 { legal.rest() } else { legal.next_pose() };
        let pose = pose.clone();
        let pose = &pose;
        let variables = tree.variables_at(model, &stored);
        let values = tree.values_at(model, pose, &variables);
        for (link, error) in tree.links.iter().zip(&mut errors) {
            let part = link.measured.as_ref();
            if part.is_some_and(|part| !legal.keeps(&part.components)) {
                continue;
            }
            let said = tree.link_transform(link, &values, pose, model);
            *error =
                error.or(LinkError::between(pose.segment_in_parent(model, link.segment), said));
        }
    }
    errors
}
