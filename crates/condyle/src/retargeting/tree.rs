//! The parts of a human by the tree of the bones alone, where no names tell them.
//!
//! A pelvis has two like limbs that hang down, a chest two that do not, and a neck. Of the two sides the right
//! is the one on the right of where the feet point.

use condyle_diagnostics::Error;
use condyle_math::Vec3;
use condyle_model::{Mode, Model, Pose, Program, SegmentId, UpAxis};
use condyle_track::retarget::{Body, Part, Side};

/// Bones at rest.
struct Tree<'m> {
    model: &'m Model,
    children: Vec<Vec<SegmentId>>,
    places: Vec<Vec3>,
    up: Vec3,
    /// For each bone the lowest and the highest point of what hangs on it, and the length of its longest chain.
    lowest: Vec<f64>,
    highest: Vec<f64>,
    longest: Vec<f64>,
}

impl<'m> Tree<'m> {
    fn of(model: &'m Model) -> Self {
        let program = Program::compile(model);
        let mut pose = Pose::new(&program);
        let evaluated = program.evaluate(&model.defaults(), Mode::Open, &mut pose);
        debug_assert!(evaluated.is_ok(), "defaults have the model's length");
        let up = match model.up() {
            UpAxis::Y => Vec3::Y,
            UpAxis::Z => Vec3::Z,
        };
        let count = model.segments().len();
        let mut children = vec![vec![]; count];
        let places: Vec<Vec3> = model
            .segment_ids()
            .map(|id| pose.segment(id) * model.segment(id).joint_in_segment.translation)
            .collect();
        for id in model.segment_ids() {
            if let Some(parent) = model.segment(id).parent {
                children[parent.index()].push(id);
            }
        }
        let mut lowest: Vec<f64> = places.iter().map(|place| place.dot(up)).collect();
        let mut highest = lowest.clone();
        let mut longest = vec![0.0; count];
        for id in model.parents_first().into_iter().rev() {
            if let Some(parent) = model.segment(id).parent {
                let (own, of) = (id.index(), parent.index());
                lowest[of] = lowest[of].min(lowest[own]);
                highest[of] = highest[of].max(highest[own]);
                let length = longest[own] + (places[own] - places[of]).norm();
                longest[of] = f64::max(longest[of], length);
            }
        }
        Self { model, children, places, up, lowest, highest, longest }
    }

    fn height(&self, id: SegmentId) -> f64 {
        self.places[id.index()].dot(self.up)
    }

    /// The bone with the longest chain beyond it.
    fn main_child(&self, id: SegmentId) -> Option<SegmentId> {
        let reach = |child: &&SegmentId| {
            self.longest[child.index()]
                + (self.places[child.index()] - self.places[id.index()]).norm()
        };
        self.children[id.index()].iter().max_by(|a, b| reach(a).total_cmp(&reach(b))).copied()
    }

    /// From a bone outwards, always along the longest chain.
    fn chain(&self, from: SegmentId) -> Vec<SegmentId> {
        let mut chain = vec![from];
        let mut here = from;
        while let Some(next) = self.main_child(here) {
            chain.push(next);
            here = next;
        }
        chain
    }

    /// Of the children of a bone the two whose chains are most alike, of those that `fit`.
    fn pair(&self, id: SegmentId, fit: impl Fn(SegmentId) -> bool) -> Option<[SegmentId; 2]> {
        let children: Vec<SegmentId> =
            self.children[id.index()].iter().copied().filter(|child| fit(*child)).collect();
        let mut best: Option<(f64, [SegmentId; 2])> = None;
        for (number, &a) in children.iter().enumerate() {
            for &b in &children[number + 1..] {
                let [x, y] = [a, b].map(|child| self.longest[child.index()]);
                let unlike = (x - y).abs() + (self.height(a) - self.height(b)).abs();
                let apart = (self.places[a.index()] - self.places[b.index()]).norm();
                let whole = x + y + apart;
                if whole > 1e-9 && unlike < 0.2 * whole && best.is_none_or(|(most, _)| whole > most)
                {
                    best = Some((whole, [a, b]));
                }
            }
        }
        best.map(|(_, pair)| pair)
    }
}

/// The parts that the tree tells.
pub(super) fn guess(model: &Model) -> Result<Body, Error> {
    let tree = Tree::of(model);
    let fail = || {
        let message = format!(
            "model `{}` is not known to be a human: no table names its bones, and they are no trunk with two legs",
            model.name()
        );
        Error::new("retarget/names", message)
            .with_help("say which bones are which with --names TABLE (see docs/retarget.md)")
    };
    // The pelvis is where two like chains go to the lowest points of the figure.
    let all = || model.parents_first().into_iter();
    let floor = tree.lowest.iter().copied().fold(f64::INFINITY, f64::min);
    let top = tree.highest.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let tall = (top - floor).max(1e-9);
    let to_floor = |id: SegmentId| tree.lowest[id.index()] < floor + 0.1 * tall;
    let pelvis = all()
        .filter_map(|id| {
            Some((id, tree.pair(id, |c| to_floor(c) && tree.longest[c.index()] > 0.0)?))
        })
        .next_back();
    let (pelvis, legs) = pelvis.ok_or_else(fail)?;
    // The chest is above, where two like chains go to the sides.
    let sideways = |id: SegmentId| !to_floor(id) && tree.longest[id.index()] > 0.1 * tall;
    let chest = all()
        .filter(|&id| {
            id != legs[0] && id != legs[1] && tree.height(id) > tree.height(pelvis) - 1e-9
        })
        .filter_map(|id| Some((id, tree.pair(id, sideways)?)))
        .max_by(|(a, _), (b, _)| tree.height(*a).total_cmp(&tree.height(*b)));
    // Two limbs alone are no human.
    let (chest, arms) = chest.ok_or_else(fail)?;
    let mut body = Body::default();
    body.set(model, Part::Pelvis, pelvis);
    let feet: Vec<Vec<SegmentId>> = legs.iter().map(|leg| tree.chain(*leg)).collect();
    let sides = tree.sides(&feet);
    for (chain, side) in feet.iter().zip(sides) {
        let chain = tree.leg_of(chain);
        let parts = [Part::Thigh(side), Part::Shank(side), Part::Foot(side), Part::Toes(side)];
        for (part, id) in parts.into_iter().zip(chain) {
            body.set(model, part, id);
        }
    }
    body.set(model, Part::Chest, chest);
    for arm in arms {
        let chain = tree.chain(arm);
        let Some(&last) = chain.last() else { continue };
        let nearer = |side: Side| {
            let own = legs[sides.iter().position(|s| *s == side).unwrap_or(0)];
            let across = tree.places[own.index()] - tree.places[pelvis.index()];
            across.dot(tree.places[last.index()] - tree.places[chest.index()])
        };
        let side = if nearer(Side::Right) >= nearer(Side::Left) { Side::Right } else { Side::Left };
        let parts = [Part::UpperArm(side), Part::Forearm(side), Part::Hand(side)];
        let (clavicle, limb) = tree.arm_of(&chain);
        if let Some(clavicle) = clavicle {
            body.set(model, Part::Clavicle(side), clavicle);
        }
        for (part, id) in parts.into_iter().zip(limb) {
            body.set(model, part, id);
        }
    }
    let up: Vec<SegmentId> = tree.children[chest.index()]
        .iter()
        .copied()
        .filter(|child| !arms.contains(child) && tree.highest[child.index()] > tree.height(chest))
        .collect();
    let neck =
        up.into_iter().max_by(|a, b| tree.highest[a.index()].total_cmp(&tree.highest[b.index()]));
    if let Some(neck) = neck {
        match tree.chain(neck)[..] {
            [head] => body.set(model, Part::Head, head),
            [neck, head, ..] => {
                body.set(model, Part::Neck, neck);
                body.set(model, Part::Head, head);
            }
            [] => {}
        }
    }
    let mut spine = vec![];
    let mut here = model.segment(chest).parent;
    while let Some(id) = here.filter(|id| *id != pelvis) {
        spine.push(id);
        here = model.segment(id).parent;
    }
    if here == Some(pelvis) {
        for (number, id) in spine.iter().rev().take(24).enumerate() {
            body.set(model, Part::Spine(number as u8), *id);
        }
    }
    Ok(body)
}

impl Tree<'_> {
    /// Which of two legs is which, by where their feet and knees point.
    fn sides(&self, feet: &[Vec<SegmentId>]) -> [Side; 2] {
        let level = |v: Vec3| v - self.up * self.up.dot(v);
        let mut ahead = Vec3::ZERO;
        for chain in feet {
            let places: Vec<Vec3> =
                self.leg_of(chain).iter().map(|id| self.places[id.index()]).collect();
            if let [_, _, ankle, toes, ..] = places[..] {
                ahead += level(toes - ankle);
            }
            // A knee is in front of the line from hip to ankle, if anywhere.
            if let [hip, knee, ankle, ..] = places[..] {
                let along = (ankle - hip).normalized();
                let out = knee - hip;
                ahead += level(out - along * along.dot(out));
            }
        }
        if ahead.norm() < 1e-3 * self.longest.iter().copied().fold(0.0, f64::max) {
            ahead = self.model.facing().ahead(self.model.up());
        }
        let right = ahead.cross(self.up);
        let at = |which: usize| {
            let first = feet.get(which).and_then(|chain| chain.first());
            first.map_or(0.0, |id| self.places[id.index()].dot(right))
        };
        if at(0) >= at(1) { [Side::Right, Side::Left] } else { [Side::Left, Side::Right] }
    }

    /// A leg without what leads to its hip: the longest two bones in a row are thigh and shank.
    fn leg_of(&self, chain: &[SegmentId]) -> Vec<SegmentId> {
        chain[self.longest_two(chain)..].to_vec()
    }

    /// The collar bone if there is one, and an arm.
    fn arm_of(&self, chain: &[SegmentId]) -> (Option<SegmentId>, Vec<SegmentId>) {
        let start = self.longest_two(chain);
        (start.checked_sub(1).map(|before| chain[before]), chain[start..].to_vec())
    }

    /// Where the two bones in a row begin that are longest together.
    fn longest_two(&self, chain: &[SegmentId]) -> usize {
        let length =
            |a: SegmentId, b: SegmentId| (self.places[b.index()] - self.places[a.index()]).norm();
        let sums = chain
            .windows(3)
            .map(|three| length(three[0], three[1]).min(length(three[1], three[2])));
        let best = sums.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        best.map_or(0, |(start, _)| start)
    }
}
