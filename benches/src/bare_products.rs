//! The lower bound of every evaluation: the products of transforms computed before.

use condyle_math::{Affine, Quat, Vec3};
use std::hint::black_box;

/// Fixed local transforms and the products along a tree.
#[derive(Clone, Debug)]
pub struct BareProducts {
    parents: Vec<usize>,
    local: Vec<Affine>,
    world: Vec<Affine>,
}

impl BareProducts {
    /// A tree whose node 0 is the root and whose node i has the parent `parents[i]`, a node before
    /// it.
    pub fn new(parents: Vec<usize>) -> Self {
        let local: Vec<Affine> = (0..parents.len())
            .map(|i| {
                let turn = Vec3::new(0.1, 0.02 * (i % 7) as f64, -0.05);
                Affine::new(Quat::exp(turn).to_mat3(), Vec3::new(0.0, 0.1, 0.01))
            })
            .collect();
        Self { world: local.clone(), parents, local }
    }

    /// `world[i] = world[parent] · local[i]` for every node but the root.
    ///
    /// The frame stays in registers along a chain, as in an optimal program.
    pub fn run(&mut self) {
        let local = black_box(&self.local[..]);
        let mut nodes = self.parents.iter().zip(local).enumerate().skip(1).peekable();
        while let Some(&(_, (&parent, _))) = nodes.peek() {
            let (mut frame, mut last) = (self.world[parent], parent);
            while let Some(&(i, (&parent, local))) = nodes.peek()
                && parent == last
            {
                frame = frame * *local;
                self.world[i] = frame;
                last = i;
                nodes.next();
            }
        }
        black_box(&mut self.world);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_follow_the_tree() {
        let mut bare = BareProducts::new(vec![0, 0, 1, 1]);
        bare.run();
        let [root, a, b, c] = [bare.world[0], bare.local[1], bare.local[2], bare.local[3]];
        assert_eq!(bare.world[1..], [root * a, root * a * b, root * a * c]);
    }
}
