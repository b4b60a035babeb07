//! Skeletons of quaternion balls, as used in games and motion capture.

use crate::random::Random;
use condyle_math::Vec3;
use condyle_model::{Model, ModelBuilder};

/// A root and one ball joint for every further node; node i has the parent `parents[i]`.
pub fn balls(parents: &[usize]) -> Model {
    let mut b = ModelBuilder::new("balls");
    let mut nodes = vec![b.segment("root", None)];
    for (i, &parent) in parents.iter().enumerate().skip(1) {
        let node = b.segment(&format!("bone{i}"), Some(nodes[parent]));
        b.place_joint(node, Vec3::new(0.01, 0.08, -0.005 * (i % 3) as f64));
        b.ball_joint(&format!("joint{i}"), node);
        nodes.push(node);
    }
    b.build().unwrap_or_else(|findings| panic!("the chain is well formed: {findings:?}"))
}

/// The parents of a chain of this many joints.
pub fn line(joints: usize) -> Vec<usize> {
    (0..=joints).map(|i| i.saturating_sub(1)).collect()
}

/// The parents of a body of 60 joints: a spine of 7 with two legs of 4 at its root, and at its end
/// a neck of 3 and two arms of 4 with five fingers of 3 and one palm bone each.
pub fn body() -> Vec<usize> {
    let mut parents = line(7);
    let hang = |parents: &mut Vec<usize>, from: usize, length: usize| {
        let mut last = from;
        for _ in 0..length {
            parents.push(last);
            last = parents.len() - 1;
        }
        last
    };
    hang(&mut parents, 0, 4);
    hang(&mut parents, 0, 4);
    hang(&mut parents, 7, 3);
    for _ in 0..2 {
        let hand = hang(&mut parents, 7, 4);
        hang(&mut parents, hand, 2);
        (0..5).for_each(|_| _ = hang(&mut parents, hand, 3));
    }
    parents
}

/// Different poses: the stored numbers of all orientations, of length 1.
pub fn poses(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let mut random = Random::new(7);
    (0..count)
        .map(|_| {
            (0..model.stored_len() / 4)
                .flat_map(|_| {
                    let v = Vec3::new(random.signed(), random.signed(), random.signed());
                    condyle_math::Quat::exp(v).to_array()
                })
                .collect()
        })
        .collect()
}
