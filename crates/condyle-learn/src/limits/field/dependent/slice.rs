//! The closing of a cloud at one value of the driver.

use super::super::nearest::{Ball, Nearest, Nodes};
use condyle_math::Quat;

/// A little more than every angle there is, for what has no boundary.
const EVERYWHERE: f32 = 4.0;

/// Signed distances to the boundary of the closing, in radians, positive inside; `retreats` are how much farther away samples count,
/// for they were taken at other values of the driver.
///
/// 1. d(x) is the least of angle + retreat over the samples. Where d(x) ≥ radius, the ball about x of radius d(x) is empty.
/// 2. What no empty ball covers is inside, deep by the least of angle to a centre less the ball's radius.
/// 3. Outside, the distance is the angle to what is inside; a sample itself is a place inside that is its retreat away.
pub(super) fn slice(
    nodes: &Nodes<'_>,
    samples: &[Quat],
    retreats: &[f64],
    radius: f64,
) -> Vec<f32> {
    let (mut balls, mut seeds) = (vec![], vec![]);
    for (q, retreat) in samples.iter().zip(retreats) {
        // What is farther away than balls are wide is no part of any boundary.
        if *retreat < radius {
            let index = balls.len() as u32;
            seeds.extend(nodes.lattice.around(*q).map(|node| (node, index)));
            balls.push(Ball::new(*q, -retreat));
        }
    }
    let near = nodes.nearest(&balls, seeds.iter().copied());
    let inner = inside(nodes, &near, radius);
    for (node, q) in nodes.rotations.iter().enumerate() {
        let Some(q) = q else { continue };
        let depth = inner.get(node).copied().unwrap_or(-1.0);
        if depth >= 0.0 {
            seeds.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, f64::from(depth)));
        }
    }
    let mut value = nodes.nearest(&balls, seeds.into_iter()).value;
    for (value, q) in value.iter_mut().zip(nodes.rotations) {
        *value = if q.is_some() { -*value } else { f32::NAN };
    }
    value
}

/// How deep each node is below what empty balls cover.
fn inside(nodes: &Nodes<'_>, near: &Nearest, radius: f64) -> Vec<f32> {
    let (mut balls, mut seeds) = (vec![], vec![]);
    for (node, (q, far)) in nodes.rotations.iter().zip(&near.value).enumerate() {
        let Some(q) = q else { continue };
        if f64::from(*far) >= radius {
            seeds.push((node, balls.len() as u32));
            balls.push(Ball::new(*q, f64::from(*far)));
        }
    }
    if balls.is_empty() {
        let value = |q: &Option<Quat>| if q.is_some() { EVERYWHERE } else { f32::INFINITY };
        return nodes.rotations.iter().map(value).collect();
    }
    nodes.nearest(&balls, seeds.into_iter()).value
}
