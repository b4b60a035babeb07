//! Which pairs of motions the second derivative has, and the groups of markers that both move.
//!
//! An entry of the Hessian is a sum over groups g of `tⱼ · (I_g tₖ)`. Groups far out on a limb share the
//! twists of all that comes before it, so the moments of all groups that a pair moves are added first,
//! as with composite rigid bodies, and each pair is multiplied out once.

use super::marker::Group;
use super::moments::{Moments, pair};
use condyle_model::Jacobian;
use condyle_solve::least_squares::LocalModel;
use std::collections::BTreeMap;

/// The pairs of one motion with itself and with those before it in the chain, over one set of groups.
#[derive(Clone, Debug)]
struct Row {
    set: usize,
    twist: u32,
    /// The unknown, where the set is that of all groups that the twist moves.
    whole: Option<u32>,
    /// The end of its pairs in [`Pairs::earlier`].
    end: usize,
}

/// All pairs of motions of groups that do not deform.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    /// Sets of groups whose moments are added.
    pub sets: Vec<Vec<usize>>,
    rows: Vec<Row>,
    /// (twist, place in the Hessian) of the earlier motion of each pair.
    earlier: Vec<(u32, u32)>,
}

impl Pairs {
    /// Lists the pairs for `n` unknowns.
    pub(crate) fn new(groups: &[Group], n: usize) -> Self {
        let mut known: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        // For each twist its unknown and the groups that it moves.
        let mut moved: BTreeMap<u32, (u32, Vec<usize>)> = BTreeMap::new();
        for (g, group) in groups.iter().enumerate().filter(|(_, g)| !g.deforms) {
            for &(unknown, twist) in &group.entries {
                moved.entry(twist).or_insert((unknown, vec![])).1.push(g);
            }
        }
        let mut pairs = Self::default();
        for (&twist, (unknown, whole)) in &moved {
            // For each earlier twist the groups that both move, then the twists of each set.
            let mut both: BTreeMap<u32, (u32, Vec<usize>)> = BTreeMap::new();
            for &g in whole {
                for &(other, earlier) in groups[g].entries.iter().filter(|e| e.1 <= twist) {
                    both.entry(earlier).or_insert((other, vec![])).1.push(g);
                }
            }
            let mut of_set: BTreeMap<usize, Vec<(u32, u32)>> = BTreeMap::new();
            let mut of_whole = usize::MAX;
            for (earlier, (other, common)) in both {
                let next = known.len();
                let set = *known.entry(common).or_insert(next);
                if earlier == twist {
                    of_whole = set;
                }
                let place = (*unknown).max(other) as usize * n + (*unknown).min(other) as usize;
                of_set.entry(set).or_default().push((earlier, place as u32));
            }
            for (set, earlier) in of_set {
                pairs.earlier.extend(earlier);
                let whole = (set == of_whole).then_some(*unknown);
                pairs.rows.push(Row { set, twist, whole, end: pairs.earlier.len() });
            }
        }
        pairs.sets = vec![vec![]; known.len()];
        known.into_iter().for_each(|(groups, set)| pairs.sets[set] = groups);
        pairs
    }

    /// Adds `scale` times gradient and Hessian; where these should be curved, what Gauss and Newton leave out
    /// as well: ω of the earlier motion times the lever of the later one.
    ///
    /// `moments` are those of the groups, `summed` a buffer with a place for each set.
    ///
    /// Twists are numbered along the chain. Where one coordinate moves several joints of a path, or several
    /// alternate along it, this order is not exact; what is wrong then is the power of the errors along a
    /// commutator of two motions, which vanishes at the minimum where the commutator is itself a motion of
    /// the model. The curvature of functions of a coordinate is left out.
    pub(crate) fn add(
        &self,
        jacobian: &Jacobian,
        moments: &[Moments],
        summed: &mut [Moments],
        scale: f64,
        local: &mut LocalModel,
    ) {
        for (sum, groups) in summed.iter_mut().zip(&self.sets) {
            *sum = Moments::ZERO;
            groups.iter().for_each(|&g| sum.join(&moments[g]));
        }
        let mut begin = 0;
        for row in &self.rows {
            let moments = &summed[row.set];
            let twist = jacobian.twist(row.twist);
            let (force, torque) = moments.momentum(twist);
            let (force, mut torque) = (force * scale, torque * scale);
            if let Some(unknown) = row.whole {
                local.gradient[unknown as usize] += scale * moments.power(twist);
            }
            if local.curved {
                // Both are multiplied by ω of the earlier motion.
                torque += moments.lever(twist) * scale;
            }
            for &(earlier, place) in &self.earlier[begin..row.end] {
                local.hessian[place as usize] += pair(jacobian.twist(earlier), (force, torque));
            }
            begin = row.end;
        }
    }
}
