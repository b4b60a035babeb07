//! Motions brought within limits: files of tables and of foreign skeletons, with what was broken and changed.
//!
//! What the nearest legal motion is, is said at [`condyle_track::constrain`].

use condyle_check::motion::{self, MotionCheck};
use condyle_model::Model;
use condyle_motion::columns::cells;
use condyle_motion::{Motion, Table};
pub use condyle_track::constrain::{Change, Constrained, Fate, Pace, Step, changes, constrain};

/// A number that differs by less, in radians or metres, is that of the file.
const SAME: f64 = 1e-12;

/// A motion before and after, beside its limits.
#[derive(Clone, Debug)]
pub struct Repair {
    /// The motion within limits.
    pub legal: Constrained,
    /// What was done to each coordinate.
    pub changes: Vec<Change>,
    /// What the motion broke.
    pub before: MotionCheck,
    /// What it still breaks.
    pub after: MotionCheck,
}

impl Repair {
    /// Brings a motion within the limits of its model.
    ///
    /// ```
    /// use condyle::constraining::Repair;
    /// use condyle::{ModelBuilder, Motion, Range, math::Vec3};
    /// let mut b = ModelBuilder::new("arm");
    /// let forearm = b.segment("forearm", None);
    /// let (_, flexion) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
    /// b.coordinate_mut(flexion).range = Range::new(0.0, 2.5);
    /// let model = b.build()?;
    /// let motion = Motion { times: vec![0.0, 0.1], frames: vec![vec![2.75], vec![2.25]] };
    /// let repair = Repair::of(&model, &motion, &mut |_| {});
    /// assert_eq!(repair.legal.motion.frames, [[2.5], [2.25]]);
    /// assert_eq!((repair.before.violations.len(), repair.after.violations.len()), (1, 0));
    /// assert_eq!(repair.changes[0].most, 0.25);
    /// # Ok::<(), condyle::Error>(())
    /// ```
    pub fn of(model: &Model, motion: &Motion, progress: &mut dyn FnMut(usize)) -> Self {
        let check = |motion: &Motion| {
            let mut checked = motion::check(model, &motion.to_table(model, "motion"));
            // A jump is no broken limit.
            checked.forget_jumps();
            checked
        };
        let legal = constrain(model, motion, Pace::default(), progress);
        let changes = changes(model, motion, &legal.motion);
        let (before, after) = (check(motion), check(&legal.motion));
        Self { legal, changes, before, after }
    }
}

/// Puts a motion back into the table that it was read from: cells of coordinates that are the same, and columns of
/// something else, stay to the bit.
pub fn put_back(table: &mut Table, model: &Model, before: &Motion, after: &Motion) {
    let width = table.columns.len();
    for cell in cells(model, table) {
        let Some(column) = cell.column else { continue };
        for (row, (from, to)) in before.frames.iter().zip(&after.frames).enumerate() {
            let (from, to) = (from[cell.place], to[cell.place]);
            if (from - to).abs() > SAME
                && let Some(number) = table.values.get_mut(row * width + column)
                && number.is_finite()
            {
                *number = to / cell.factor;
            }
        }
    }
}

/// A motion of one model as that of another with coordinates of the same names, the other ones at their defaults.
pub fn carried_over(from: &Model, motion: &Motion, to: &Model) -> Motion {
    let places: Vec<_> = to
        .coordinate_ids()
        .filter_map(|id| {
            let key = to.coordinate_key(id);
            let same = from.coordinate_ids().find(|&own| from.coordinate_key(own) == key)?;
            let (own, place) = (from.stored_range(same), to.stored_range(id));
            (own.len() == place.len()).then_some((own, place))
        })
        .collect();
    let defaults = to.defaults();
    let frames = motion.frames.iter().map(|frame| {
        let mut other = defaults.clone();
        for (own, place) in &places {
            other[place.clone()].copy_from_slice(&frame[own.clone()]);
        }
        other
    });
    Motion { times: motion.times.clone(), frames: frames.collect() }
}
