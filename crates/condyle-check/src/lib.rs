//! Checks of models and motions that can be read and posed but are inconsistent or implausible.
//!
//! One file for each group of rules. Every rule inspects a model and returns [`Diagnostic`]s; it
//! changes nothing and never fails. Rules report contradictions inside a file: a range that exceeds
//! the knots of a spline, a left side that differs from the right one, a default outside its range.
//! No rule encodes what a human body can do; limits with a source do that.
//!
//! | file | what it checks |
//! | --- | --- |
//! | `circle` | rotations whose range has no ends; the other rules know them |
//! | `range` | limits that cross, have no effect or look like degrees; defaults outside them |
//! | `domain` | functions used beyond their knots |
//! | `coupling` | followers driven out of their range, chains, coordinates that move nothing |
//! | `limit` | limits whose projection jumps inside declared ranges, contacts that do not touch, components that nothing uses |
//! | `depend` | bounds of one angle by another that cross |
//! | `wiring` | axes of cones, angles that pass by their limit, the order of factors |
//! | `unit` | numbers of components that look like degrees or millimetres |
//! | `rotation` | axes that are parallel, in the default pose or inside a range |
//! | `place` | joints and markers far from their segment, markers at the same point |
//! | `marker` | markers on ground, or on a segment of another body part or side |
//! | `closure` | loops that are open in the default pose |
//! | `names` | names that differ by case or spaces only |
//! | `symmetry` | left against right |
//! | [`motion`] | a motion against its model |
//!
//! To add a rule, write a function in the file of its subject and call it in that file's `check`;
//! add tests with a model that violates it and with one that does not.
//!
//! A finding is an *error* if the model contradicts itself, or a motion leaves a range that is
//! enforced; a *warning* if it is probably a mistake; a *note* if it is worth knowing.

mod circle;
mod closure;
mod coupling;
mod depend;
mod domain;
mod limit;
mod marker;
pub mod motion;
mod names;
mod place;
mod range;
mod reach;
mod rotation;
mod symmetry;
mod unit;
mod wiring;

pub use circle::circles;
use condyle_diagnostics::{Diagnostic, Severity, Subject, listed};
use condyle_model::component::{Component, Law, Signal};
use condyle_model::model::ComponentId;
use condyle_model::model::{CROSSING_RANGE, DEFAULT_OUTSIDE_RANGE, LOOKS_LIKE_DEGREES};
use condyle_model::{CoordinateId, CoordinateKind, Mode, Model, Pose, Program};
use reach::Reach;

/// Codes of reader warnings that a rule of this crate repeats with names and numbers.
const REPEATED: [&str; 3] = [CROSSING_RANGE, DEFAULT_OUTSIDE_RANGE, LOOKS_LIKE_DEGREES];

fn finding(
    severity: Severity,
    code: &'static str,
    subjects: impl IntoIterator<Item = Subject>,
    message: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::new(severity, code, message).about_all(subjects).with_help(help)
}

/// What readers say where a file does not state its unit, its axes or its rate: a guess is no fault of the figure.
const GUESSES: [&str; 3] = ["skeleton/unit", "skeleton/up", "amc/rate"];

/// Whether a finding makes a check fail: all but notes do, and but what was guessed as the file's format has no place for it.
pub fn counts(finding: &Diagnostic) -> bool {
    finding.severity > Severity::Note && !GUESSES.contains(&finding.code)
}

/// All findings about a model and the warnings of its reader, the worst first.
///
/// ```
/// use condyle_math::Vec3;
/// use condyle_model::{ModelBuilder, Range};
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// let (_, flexion) = b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// b.coordinate_mut(flexion).range = Range::new(0.0, 140.0);
/// let findings = condyle_check::check(&b.build().unwrap(), &[]);
/// assert_eq!(findings[0].code, "lint/degrees");
/// ```
pub fn check(model: &Model, warnings: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut findings: Vec<Diagnostic> =
        warnings.iter().filter(|said| !REPEATED.contains(&said.code)).cloned().collect();
    let subject = Inspected::new(model);
    range::check(&subject, &mut findings);
    domain::check(&subject, &mut findings);
    coupling::check(&subject, &mut findings);
    rotation::check(&subject, &mut findings);
    place::check(&subject, &mut findings);
    marker::check(&subject, &mut findings);
    closure::check(&subject, &mut findings);
    limit::check(&subject, &mut findings);
    depend::check(&subject, &mut findings);
    wiring::check(&subject, &mut findings);
    unit::check(&subject, &mut findings);
    names::check(&subject, &mut findings);
    symmetry::check(&subject, &mut findings);
    if !subject.reach.finished() {
        findings.push(finding(
            Severity::Note,
            "lint/unfinished",
            [],
            "there are so many couplings that some were not evaluated over their leaders' ranges",
            "findings about knots and followers may be incomplete",
        ));
    }
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    findings
}

/// A model with the data that most rules need.
struct Inspected<'m> {
    model: &'m Model,
    program: Program,
    /// The pose of the defaults, limits not applied.
    rest: Pose,
    /// The key of every coordinate.
    keys: Vec<String>,
    /// Rotations whose range has no ends.
    circles: Vec<CoordinateId>,
    reach: Reach<'m>,
}

impl<'m> Inspected<'m> {
    fn new(model: &'m Model) -> Self {
        let program = Program::compile(model);
        let mut rest = Pose::new(&program);
        // Both buffers are made for this program.
        let _ = program.evaluate(&model.defaults(), Mode::Open, &mut rest);
        let keys = model.coordinate_keys();
        let circles = circles(model);
        Self { model, program, rest, keys, circles, reach: Reach::new(model) }
    }

    fn key(&self, id: CoordinateId) -> String {
        self.keys[id.index()].clone()
    }

    fn kind(&self, id: CoordinateId) -> CoordinateKind {
        self.model.coordinate(id).kind
    }

    /// What a signal measures: of a coordinate its kind; of an output what it passes on, or what it is used
    /// as.
    fn kind_of(&self, signal: Signal) -> CoordinateKind {
        let mut signal = signal;
        // As deep as components follow each other; a model has no circles.
        for _ in 0..self.model.components().len() + 1 {
            let Signal::Output(id, output) = signal else { break };
            let component = &self.model.components()[id.index()];
            match &component.law {
                Law::Angles(_) => return CoordinateKind::Rotation,
                law if law.bounds() => match component.inputs.get(output as usize) {
                    Some(&passed) => signal = passed,
                    None => return CoordinateKind::Other,
                },
                _ => return self.used_as(signal),
            }
        }
        match signal {
            Signal::Coordinate(id) => self.kind(id),
            _ => CoordinateKind::Other,
        }
    }

    /// What an output is used as: an angle, a distance, the value of a coordinate, or something else.
    fn used_as(&self, signal: Signal) -> CoordinateKind {
        for component in self.model.components() {
            let kind = match component.law {
                Law::Rotate(_) | Law::Pivot(_) => CoordinateKind::Rotation,
                Law::Cone(_) if !component.at("angles").is_empty() => CoordinateKind::Rotation,
                Law::Translate(_) => CoordinateKind::Translation,
                _ => continue,
            };
            if component.values().any(|input| input == signal) {
                return kind;
            }
        }
        let mut coordinates = self.model.coordinates().iter();
        let follower = coordinates.find(|c| c.follows == Some(signal));
        follower.map_or(CoordinateKind::Other, |c| c.kind)
    }

    /// The least and the greatest value that a signal takes while its leaders run through their ranges.
    fn range_of(&self, signal: Signal) -> Option<(f64, f64)> {
        let taken = self.reach.taken(signal)?;
        let [least, greatest] = taken.extremes()?;
        Some((least.1, greatest.1))
    }

    /// One output of a component, as others read it.
    fn output(&self, component: &Component, output: usize) -> Option<Signal> {
        let same = |id: &ComponentId| std::ptr::eq(&self.model.components()[id.index()], component);
        self.model.component_ids().find(same).map(|id| Signal::Output(id, output as u32))
    }

    /// A value of a coordinate with its unit.
    fn shown(&self, id: CoordinateId, value: f64) -> String {
        amount(self.kind(id), value)
    }
}

/// A limit beyond this, in radians or metres, means that there is no limit.
const NO_LIMIT: f64 = 1000.0;

/// Both limits of a coordinate, if they limit anything.
fn real_range(model: &Model, id: CoordinateId) -> Option<(f64, f64)> {
    let coordinate = model.coordinate(id);
    let (lower, upper) = (coordinate.range.lower?, coordinate.range.upper?);
    let real = coordinate.kind != CoordinateKind::Orientation
        && lower <= upper
        && lower.abs().max(upper.abs()) <= NO_LIMIT;
    real.then_some((lower, upper))
}

/// Values that differ by less than this count as equal: 0.01 degrees, 0.01 mm.
fn tolerance(kind: CoordinateKind) -> f64 {
    match kind {
        CoordinateKind::Rotation | CoordinateKind::Orientation => 0.01f64.to_radians(),
        CoordinateKind::Translation => 1e-5,
        CoordinateKind::Scale | CoordinateKind::Other => 1e-4,
    }
}

/// A value with its unit: degrees, millimetres, or metres from one metre up.
fn amount(kind: CoordinateKind, value: f64) -> String {
    match kind {
        CoordinateKind::Rotation | CoordinateKind::Orientation => {
            format!("{}°", rounded(value.to_degrees(), 2))
        }
        CoordinateKind::Translation if value.abs() >= 1.0 => format!("{} m", rounded(value, 3)),
        CoordinateKind::Translation => format!("{} mm", rounded(1e3 * value, 2)),
        CoordinateKind::Scale | CoordinateKind::Other => rounded(value, 4),
    }
}

/// A length in millimetres, or metres from one metre up.
fn length(value: f64) -> String {
    amount(CoordinateKind::Translation, value)
}

/// A few decimals, without zeros at the end or a minus before zero.
fn rounded(value: f64, decimals: usize) -> String {
    if value.abs() >= 1e7 {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.decimals$}");
    let trimmed = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if trimmed == "-0" { "0".to_owned() } else { trimmed.to_owned() }
}
