//! What is lost where a limit is replaced.

use super::Region;
use condyle_math::Quat;

/// Rotations that are judged wrongly in one way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lost {
    /// Their share of all rotations.
    pub share: f64,
    /// Their share as a part of what the field allows.
    pub of_field: f64,
    /// How far they are from the field's boundary, in radians: the mean, what 95 % are within, and the largest.
    pub mean: f64,
    /// What 95 % of them are within.
    pub most: f64,
    /// The largest.
    pub largest: f64,
}

/// What is lost where a field is replaced, by rotations that no fit has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loss {
    /// The share of all rotations that the field allows.
    pub field: f64,
    /// The share that its replacement allows.
    pub allowed: f64,
    /// Outside the field and allowed.
    pub accepts: Lost,
    /// Inside the field and refused.
    pub rejects: Lost,
    /// Over how many even rotations this was counted.
    pub count: usize,
}

impl Loss {
    /// Counted over the rotations of a region.
    #[must_use]
    pub fn of(region: &Region, allows: impl Fn(Quat) -> bool) -> Self {
        let (mut accepts, mut rejects, mut allowed) = (vec![], vec![], 0usize);
        for (rotation, distance) in &region.judged {
            let asked = allows(*rotation);
            allowed += usize::from(asked);
            match (asked, *distance >= 0.0) {
                (true, false) => accepts.push(-distance),
                (false, true) => rejects.push(*distance),
                _ => {}
            }
        }
        let count = region.judged.len();
        let lost = |depths: Vec<f64>| lost(depths, count, region.share);
        Self {
            field: region.share,
            allowed: allowed as f64 / count.max(1) as f64,
            accepts: lost(accepts),
            rejects: lost(rejects),
            count,
        }
    }

    /// False accepts and rejects together, as a part of what the field allows.
    #[must_use]
    pub fn both(&self) -> f64 {
        self.accepts.of_field + self.rejects.of_field
    }
}

fn lost(mut depths: Vec<f64>, count: usize, field: f64) -> Lost {
    depths.sort_by(f64::total_cmp);
    let share = depths.len() as f64 / count.max(1) as f64;
    let at = |part: f64| {
        let last = depths.len().saturating_sub(1);
        depths.get((part * last as f64).round() as usize).copied().unwrap_or(0.0)
    };
    Lost {
        share,
        of_field: if field > 0.0 { share / field } else { 0.0 },
        mean: depths.iter().fold(0.0, |sum, d| sum + d) / depths.len().max(1) as f64,
        most: at(0.95),
        largest: at(1.0),
    }
}
