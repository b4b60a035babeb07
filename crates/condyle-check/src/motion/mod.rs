//! A motion against its model: where it leaves ranges and limits, contradicts couplings, opens loops or
//! jumps.
//!
//! Effective values are checked: a follower has the value that its leaders determine, and a column
//! that differs from it is a separate finding. Blank cells, and coordinates without a column, are
//! not checked. A rotation whose range is a circle has no end to be beyond.

mod jump;
mod learned;
mod limits;

pub use jump::Jump;
pub use learned::{Control, Extrapolated};
pub use limits::{Broken, Nearest};

use crate::closure::{Gap, gaps};
use crate::{amount, finding, length, listed, real_range, rounded, tolerance};
use condyle_diagnostics::{Diagnostic, Severity, Subject};
use condyle_model::component::Signal;
use condyle_model::evaluate::ClosureRows;
use condyle_model::{CoordinateId, CoordinateKind, Mode, Model, Pose, Program};
use condyle_motion::Motion;
use condyle_motion::columns::{cells, coordinate_name};
use condyle_motion::{AngleUnit, Table};
use jump::Turned;
use std::f64::consts::PI;

/// A coupled value may differ by this: a tenth of a degree, a tenth of a millimetre.
const DISAGREES: [f64; 2] = [0.1 * PI / 180.0, 1e-4];

/// One coordinate outside its range in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// The frame, counted from 0.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// The value, in radians or metres like all below.
    pub value: f64,
    /// The limit that it is beyond.
    pub limit: f64,
    /// How far beyond.
    pub by: f64,
    /// The nearest value that is valid.
    pub nearest: f64,
}

/// All frames in which one coordinate is outside its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Outside {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// In how many frames.
    pub frames: usize,
    /// First and last frame of every run.
    pub runs: Vec<[usize; 2]>,
    /// Where it is farthest out.
    pub worst: Violation,
    /// Whether the range is enforced, or only declared.
    pub enforced: bool,
    /// Where the limit comes from.
    pub source: String,
}

/// A coordinate that leaves what people reach on average: no fault, but worth a look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncommon {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// In how many frames.
    pub frames: usize,
    /// The frame in which it is farthest out, its time in seconds, and the value there.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// The value there, in radians or metres.
    pub value: f64,
    /// How far it is beyond.
    pub by: f64,
}

/// A follower whose column differs from the value that its leaders determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// The follower.
    pub coordinate: CoordinateId,
    /// In how many frames.
    pub frames: usize,
    /// The frame with the greatest difference, and its time.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// The value in the file in that frame.
    pub value: f64,
    /// The value that its leaders determine.
    pub expected: f64,
}

/// A loop that is open in some frames.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoop {
    /// The loop's name.
    pub name: String,
    /// In how many frames.
    pub frames: usize,
    /// The frame in which it is widest.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// Metres between the points there.
    pub metres: f64,
    /// Radians between the frames there.
    pub radians: f64,
    gap: Gap,
}

/// The result of checking a motion against its model.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct MotionCheck {
    /// How many frames there are.
    pub frames: usize,
    /// Frame by frame, every coordinate outside its range.
    pub violations: Vec<Violation>,
    /// The same for each coordinate, the farthest out (for its kind) first.
    pub outside: Vec<Outside>,
    /// Coordinates beyond what people reach on average, in the order of the model.
    pub uncommon: Vec<Uncommon>,
    /// Followers whose columns contradict their leaders.
    pub disagreements: Vec<Disagreement>,
    /// Limits of several numbers together that are broken, and contacts that leave their surface.
    pub broken: Vec<Broken>,
    /// Frames of which learned limits know nothing: in their holes, which is no violation.
    pub unseen: Vec<Broken>,
    /// Learned laws that are used where they were not learned.
    pub extrapolated: Vec<Extrapolated>,
    /// Loops that are open.
    pub open_loops: Vec<OpenLoop>,
    /// Jumps of rotations.
    pub jumps: Vec<Jump>,
    /// Coordinates without a column that nothing else determines.
    pub missing: Vec<CoordinateId>,
    /// Columns that match no coordinate.
    pub unknown: Vec<String>,
    /// Cells of coordinates that hold no number.
    pub blank: usize,
    /// All of it as diagnostics.
    pub findings: Vec<Diagnostic>,
}

/// The source of a limit, as text.
fn source(model: &Model, id: CoordinateId) -> String {
    let coordinate = model.coordinate(id);
    let held = if coordinate.range.enforced { "enforced" } else { "declared, not enforced" };
    match &coordinate.source {
        Some(source) => format!("{source} ({held})"),
        None => format!("the model's range ({held})"),
    }
}

/// Compares every frame of a table with its model.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::{ModelBuilder, Range};
/// use condyle_motion::{AngleUnit, Table};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// let (_, flexion) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// b.coordinate_mut(flexion).range = Range::new(0.0, 140f64.to_radians());
/// let model = b.build().unwrap();
/// let table = Table {
///     columns: vec!["flexion".into()],
///     times: vec![0.0, 0.01, 0.02],
///     values: vec![120.0, 143.5, 138.0],
///     angle_unit: AngleUnit::Degrees,
///     ..Table::default()
/// };
/// let check = condyle_check::motion::check(&model, &table);
/// assert_eq!((check.violations.len(), check.violations[0].frame), (1, 1));
/// assert!((check.violations[0].by.to_degrees() - 3.5).abs() < 1e-9);
/// ```
pub fn check(model: &Model, table: &Table) -> MotionCheck {
    let mut check = MotionCheck { frames: table.rows(), ..MotionCheck::default() };
    let (motion, _) = Motion::from_table(model, table);
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let mut rows = ClosureRows::new(model);
    let cells = cells(model, table);
    check.columns(
        model,
        table,
        &cells.iter().map(|c| (c.coordinate, c.column)).collect::<Vec<_>>(),
    );
    // Which stored numbers the file gives in a frame, and which followers are determined by some.
    let mut given = vec![false; model.stored_len()];
    let judged = judged(
        model,
        &cells.iter().filter(|c| c.column.is_some()).map(|c| c.coordinate).collect::<Vec<_>>(),
    );
    let mut watch = limits::Watch::new(model, &program);
    let mut learned = learned::Learned::new(model);
    let mut turned = Turned::new(model, &program);
    let mut before: Option<Vec<f64>> = None;
    let mut gaps_of = vec![];
    for (frame, (&time, stored)) in motion.times.iter().zip(&motion.frames).enumerate() {
        given.fill(false);
        for cell in &cells {
            if let Some(column) = cell.column {
                let there = table.value(frame, column).is_some_and(f64::is_finite);
                given[cell.place] = there;
                check.blank += usize::from(!there);
            }
        }
        // The buffers are made for this program.
        let _ = program.evaluate(stored, Mode::Open, &mut pose);
        watch.frame(frame, time, &pose);
        learned.frame(frame, time, &pose);
        turned.frame(&pose);
        for id in model.coordinate_ids() {
            let place = model.stored_range(id).start;
            let follows = model.coordinate(id).follows.is_some();
            let value = pose.coordinate(model, id)[0];
            if judged[id.index()] && (given[place] || follows) {
                check.range(model, id, frame, time, value);
            }
            if given[place] || follows {
                check.typical(model, id, frame, time, value);
            }
            if follows && given[place] {
                let degrees = table.angle_unit == AngleUnit::Degrees;
                check.coupling(model, id, [frame as f64, time, stored[place], value], degrees);
            }
            if !follows
                && given[place]
                && let Some(before) = before.as_deref().filter(|b| b[place].is_finite())
            {
                check.jump(model, id, frame, time, [before, stored], &turned);
            }
        }
        // A blank cell is no value to compare with.
        let marked = stored.iter().zip(&given).map(|(&v, &g)| if g { v } else { f64::NAN });
        before = Some(marked.collect());
        if !rows.is_empty() {
            rows.update(model, &program, &pose, None);
            gaps_of.push((frame, time, gaps(model, &rows)));
        }
    }
    check.loops(model, &gaps_of);
    check.summarise(model);
    check.say(model, table, &motion, watch.say().chain(learned.say()));
    check.extrapolated = learned.found;
    check.broken = watch.broken;
    check.unseen = watch.unknown;
    check
}

/// Coordinates whose values come from the file: given ones, and followers of given ones.
fn judged(model: &Model, given: &[CoordinateId]) -> Vec<bool> {
    let reach = crate::reach::Reach::new(model);
    let circles = crate::circles(model);
    model
        .coordinate_ids()
        .map(|id| {
            real_range(model, id).is_some()
                && !circles.contains(&id)
                && match model.coordinate(id).follows {
                    None => given.contains(&id),
                    Some(_) => {
                        reach.leaders(Signal::Coordinate(id)).iter().any(|l| given.contains(l))
                    }
                }
        })
        .collect()
}

impl MotionCheck {
    /// Columns that are missing, and columns that match no coordinate.
    fn columns(&mut self, model: &Model, table: &Table, cells: &[(CoordinateId, Option<usize>)]) {
        let free = |id: CoordinateId| {
            let coordinate = model.coordinate(id);
            coordinate.follows.is_none() && !coordinate.locked
        };
        for &(id, column) in cells {
            if column.is_none() && free(id) && self.missing.last() != Some(&id) {
                self.missing.push(id);
            }
        }
        let used = |column: usize| cells.iter().any(|(_, c)| *c == Some(column));
        let names = table.columns.iter().enumerate();
        let unknown = names.filter(|(i, name)| !used(*i) && coordinate_name(name).is_some());
        self.unknown = unknown.map(|(_, name)| name.clone()).collect();
    }

    fn range(&mut self, model: &Model, id: CoordinateId, frame: usize, time: f64, value: f64) {
        let Some((lower, upper)) = real_range(model, id) else { return };
        let nearest = value.max(lower).min(upper);
        let by = (value - nearest).abs();
        if by > tolerance(model.coordinate(id).kind) {
            let limit = nearest;
            self.violations.push(Violation {
                coordinate: id,
                frame,
                time,
                value,
                limit,
                by,
                nearest,
            });
        }
    }

    fn typical(&mut self, model: &Model, id: CoordinateId, frame: usize, time: f64, value: f64) {
        let Some([low, high]) = model.coordinate(id).typical else { return };
        let by = (low - value).max(value - high);
        if by <= tolerance(model.coordinate(id).kind) {
            return;
        }
        match self.uncommon.iter_mut().find(|u| u.coordinate == id) {
            Some(known) => {
                known.frames += 1;
                if by > known.by {
                    (known.frame, known.time, known.value, known.by) = (frame, time, value, by);
                }
            }
            None => {
                self.uncommon.push(Uncommon { coordinate: id, frames: 1, frame, time, value, by })
            }
        }
    }

    fn coupling(
        &mut self,
        model: &Model,
        id: CoordinateId,
        [frame, time, value, expected]: [f64; 4],
        degrees: bool,
    ) {
        let kind = model.coordinate(id).kind;
        let allowed = DISAGREES[usize::from(kind != CoordinateKind::Rotation)];
        let by = (value - expected).abs();
        // What is neither an angle nor a length is written as it is by some programs, as an angle by others.
        let as_angle = degrees
            && kind == CoordinateKind::Other
            && (value.to_radians() - expected).abs() <= DISAGREES[0];
        if by <= allowed || as_angle {
            return;
        }
        let here = Disagreement {
            coordinate: id,
            frames: 1,
            frame: frame as usize,
            time,
            value,
            expected,
        };
        match self.disagreements.iter_mut().find(|d| d.coordinate == id) {
            Some(known) => {
                let frames = known.frames + 1;
                if by > (known.value - known.expected).abs() {
                    *known = here;
                }
                known.frames = frames;
            }
            None => self.disagreements.push(here),
        }
    }

    fn loops(&mut self, model: &Model, frames: &[(usize, f64, Vec<Gap>)]) {
        for (index, closure) in model.closures().iter().enumerate() {
            let open = frames.iter().filter(|(_, _, gaps)| gaps[index].is_open());
            let worst = open.clone().max_by(|a, b| a.2[index].size().total_cmp(&b.2[index].size()));
            if let Some((frame, time, gaps)) = worst {
                let gap = gaps[index];
                self.open_loops.push(OpenLoop {
                    name: closure.name.clone(),
                    frames: open.count(),
                    frame: *frame,
                    time: *time,
                    metres: gap.metres,
                    radians: gap.radians,
                    gap,
                });
            }
        }
    }

    fn summarise(&mut self, model: &Model) {
        let mut by_coordinate: Vec<Vec<&Violation>> = vec![vec![]; model.coordinates().len()];
        for violation in &self.violations {
            by_coordinate[violation.coordinate.index()].push(violation);
        }
        for (id, own) in model.coordinate_ids().zip(by_coordinate) {
            let Some(&&worst) = own.iter().max_by(|a, b| a.by.total_cmp(&b.by)) else { continue };
            let mut runs: Vec<[usize; 2]> = vec![];
            for violation in &own {
                match runs.last_mut() {
                    Some(run) if run[1] + 1 == violation.frame => run[1] = violation.frame,
                    _ => runs.push([violation.frame; 2]),
                }
            }
            self.outside.push(Outside {
                coordinate: id,
                frames: own.len(),
                runs,
                worst,
                enforced: model.coordinate(id).range.enforced,
                source: source(model, id),
            });
        }
        let weight = |o: &Outside| o.worst.by / tolerance(model.coordinate(o.coordinate).kind);
        self.outside
            .sort_by(|a, b| b.enforced.cmp(&a.enforced).then(weight(b).total_cmp(&weight(a))));
    }

    fn say(
        &mut self,
        model: &Model,
        table: &Table,
        motion: &Motion,
        limits: impl Iterator<Item = Diagnostic>,
    ) {
        let mut findings = vec![];
        let key = |id: CoordinateId| model.coordinate_key(id);
        let shown = |id: CoordinateId, value: f64| amount(model.coordinate(id).kind, value);
        let frames = |n: usize| if n == 1 { "1 frame".to_owned() } else { format!("{n} frames") };
        for outside in &self.outside {
            let (id, worst) = (outside.coordinate, outside.worst);
            findings.push(finding(
                if outside.enforced { Severity::Error } else { Severity::Warning },
                "motion/outside-range",
                [Subject::Coordinate(key(id))],
                format!(
                    "`{}` is outside its range in {}; most in frame {} ({} s): {}, {} beyond {}",
                    key(id),
                    frames(outside.frames),
                    worst.frame,
                    rounded(worst.time, 4),
                    shown(id, worst.value),
                    shown(id, worst.by),
                    shown(id, worst.limit),
                ),
                format!(
                    "nearest valid value {}; limit: {}",
                    shown(id, worst.nearest),
                    outside.source
                ),
            ));
        }
        findings.extend(limits);
        self.uncommon.sort_by_key(|u| u.coordinate.index());
        for u in &self.uncommon {
            let coordinate = model.coordinate(u.coordinate);
            let [low, high] = coordinate.typical.unwrap_or_default();
            let source = coordinate.source.as_deref().unwrap_or("the model");
            findings.push(finding(
                Severity::Note,
                "motion/uncommon",
                [Subject::Coordinate(key(u.coordinate))],
                format!(
                    "`{}` is beyond what people reach on average in {}; most in frame {} ({} s): {}",
                    key(u.coordinate),
                    frames(u.frames),
                    u.frame,
                    rounded(u.time, 4),
                    shown(u.coordinate, u.value),
                ),
                format!(
                    "people reach {} to {}: {source}",
                    shown(u.coordinate, low),
                    shown(u.coordinate, high)
                ),
            ));
        }
        for d in &self.disagreements {
            findings.push(finding(
                Severity::Warning,
                "motion/coupled",
                [Subject::Coordinate(key(d.coordinate))],
                format!(
                    "`{}` differs from the value that its leaders determine in {}; most in frame \
                     {} ({} s): {} instead of {}",
                    key(d.coordinate),
                    frames(d.frames),
                    d.frame,
                    rounded(d.time, 4),
                    shown(d.coordinate, d.value),
                    shown(d.coordinate, d.expected)
                ),
                "programs that use the column as it is will show another posture",
            ));
        }
        for open in &self.open_loops {
            findings.push(finding(
                Severity::Warning,
                "motion/open-loop",
                [Subject::Closure(open.name.clone())],
                format!(
                    "loop `{}` is open in {}; most in frame {} ({} s), by {}",
                    open.name,
                    frames(open.frames),
                    open.frame,
                    rounded(open.time, 4),
                    open.gap.shown()
                ),
                "track with the model's constraints, or with a greater constraint weight",
            ));
        }
        self.say_jumps(model, &mut findings);
        if !self.missing.is_empty() {
            let names: Vec<String> = self.missing.iter().map(|&id| key(id)).collect();
            let message = format!("no column for {}", listed(&names));
            let help = "these coordinates keep their defaults";
            let names = names.into_iter().map(Subject::Coordinate);
            findings.push(finding(Severity::Warning, "motion/missing", names, message, help));
        }
        if !self.unknown.is_empty() {
            findings.push(finding(
                Severity::Warning,
                "motion/unknown",
                self.unknown.iter().cloned().map(Subject::Column),
                format!("the model has no coordinate for {}", listed(&self.unknown)),
                "these columns are ignored: does the motion belong to this model?",
            ));
        }
        if self.blank > 0 {
            findings.push(finding(
                Severity::Warning,
                "motion/blank",
                [],
                format!("{} cells hold no number", self.blank),
                "the coordinates keep their defaults there",
            ));
        }
        let far = farthest_angle(model, motion);
        if table.angle_unit != AngleUnit::Degrees && far > 4.0 * PI {
            findings.push(finding(
                Severity::Warning,
                "motion/units",
                [],
                format!(
                    "the file does not state degrees, but angles reach {} radians",
                    rounded(far, 1)
                ),
                "if they are degrees, write inDegrees=yes in the header",
            ));
        }
        self.findings = findings;
    }

    /// Whether the motion passes the check: no finding is an error or a warning.
    pub fn holds(&self) -> bool {
        !self.findings.iter().any(crate::counts)
    }
}

impl OpenLoop {
    /// The gap as text.
    pub fn shown(&self) -> String {
        if self.metres > 0.0 && self.radians == 0.0 {
            length(self.metres)
        } else {
            self.gap.shown()
        }
    }
}

/// The greatest absolute angle of a motion.
fn farthest_angle(model: &Model, motion: &Motion) -> f64 {
    let mut most = 0.0f64;
    for id in model.coordinate_ids() {
        if model.coordinate(id).kind == CoordinateKind::Rotation {
            most = motion.frames.iter().map(|f| model.value(f, id).abs()).fold(most, f64::max);
        }
    }
    most
}
