//! A pose by goals: what should be where, by names.
//!
//! ```
//! use condyle::formats::document::goals;
//! use condyle::{open, posing};
//! let human = open::model("human".as_ref())?.value;
//! let text = r#"
//! condyle = 1
//! kind = "goals"
//! hold = "pelvis_*"
//! [point.hand]
//! point = "RFIN"
//! at = "LSHO"
//! "#;
//! let list = goals::read(text, &mut |_| Err("it stands alone".into()))?.value;
//! let posed = posing::pose(&human, &list, None)?;
//! assert!(posed.answer.is_met());
//! // The elbow is bent, and within its range.
//! let elbow = human.value(&posed.answer.coordinates, human.find_coordinate("elbow_flex_r")?);
//! assert!(elbow.to_degrees() > 60.0 && elbow.to_degrees() < 143.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What is minimised, and what nearest to rest means, is said at [`condyle_track::goal`].

use crate::tracking::fits_pattern;
use condyle_diagnostics::{Diagnostic, Error, did_you_mean};
use condyle_formats::document::goals::{GoalList, Named, NamedAim, NamedPoint};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, Mode, Model, Pose, Program, SegmentId};
pub use condyle_track::goal::{
    Aim, Anchor, Answer, By, Goal, Goals, MET, Miss, Rest, Side, follow, misses, solve,
};

/// A pose, and what was asked of it.
#[derive(Clone, Debug)]
pub struct Posed {
    /// What was asked, in terms of the model; its goals in the order of the list.
    pub goals: Goals,
    /// The pose and what each goal lacks.
    pub answer: Answer,
}

/// The legal pose of a model nearest to rest that meets goals, loops closed; where no pose does, the one
/// that misses them least.
///
/// `rest` has the stored numbers of all coordinates of a pose to be near; without it that is where the
/// model's postures rest, else its defaults.
///
/// # Errors
/// All names that the model does not have, and goals about axes of segments that are scaled or sheared,
/// with their places.
///
/// # Panics
/// If `rest` has not as many numbers as the model stores.
pub fn pose(model: &Model, list: &GoalList, rest: Option<&[f64]>) -> Result<Posed, Error> {
    let goals = resolve(model, list, rest)?;
    let answer = solve(model, &goals);
    Ok(Posed { goals, answer })
}

/// What a list asks of a model.
///
/// # Errors
/// As [`pose`].
///
/// # Panics
/// As [`pose`].
pub fn resolve(model: &Model, list: &GoalList, rest: Option<&[f64]>) -> Result<Goals, Error> {
    let mut near = Rest::of(model);
    if let Some(pose) = rest {
        near = near.around(model, pose);
    }
    let program = Program::compile(model);
    let mut at_rest = Pose::new(&program);
    let evaluated = program.evaluate(&near.pose, Mode::Open, &mut at_rest);
    evaluated.map_err(|error| Error::new("goals/rest", error.to_string()))?;
    let mut names = Names { model, program, at_rest, errors: vec![] };
    let mut goals = Goals { rest: near, limits: list.limits.unwrap_or(true), ..Goals::of(model) };
    for goal in &list.goals {
        if let Some(aim) = names.aim(&goal.aim) {
            if let Some(segment) = aim.deformed(&names.program) {
                let name = &model.segment(segment).name;
                let message =
                    format!("`{name}` is scaled or sheared, so its axes are at no right angles");
                let help = "name points of it instead";
                names.said(&goal.name, "goals/deformed", message, help.to_owned());
                continue;
            }
            goals.goals.push(Goal { aim, weight: goal.weight });
        }
    }
    for pattern in &list.hold {
        goals.held.extend(names.coordinates(pattern));
    }
    for (pattern, stiffness) in &list.stiffness {
        for id in names.coordinates(pattern) {
            goals.rest.stiffness[id.index()] = *stiffness;
        }
    }
    // In the order of the text.
    names.errors.sort_by_key(|e| e.place.and_then(|place| place.byte));
    Error::of(names.errors).map_or(Ok(goals), Err)
}

/// Names of a model, and what is wrong with those asked for.
struct Names<'m> {
    model: &'m Model,
    program: Program,
    at_rest: Pose,
    errors: Vec<Diagnostic>,
}

impl Names<'_> {
    fn said(&mut self, name: &Named, code: &'static str, message: String, help: String) {
        let said = Diagnostic { place: name.place, ..Diagnostic::error(code, message) };
        self.errors.push(said.with_help(help));
    }

    /// Reports an error of a look-up at the place of the name.
    fn known<T>(&mut self, name: &Named, found: Result<T, Error>) -> Option<T> {
        let placed = |said: Diagnostic| Diagnostic { place: name.place, ..said };
        found.map_err(|e| self.errors.extend(e.into_diagnostics().into_iter().map(placed))).ok()
    }

    fn segment(&mut self, name: &Named) -> Option<SegmentId> {
        let found = self.model.find_segment(&name.text);
        self.known(name, found)
    }

    /// A segment, or the world without a name; `None` after an error.
    fn frame(&mut self, name: Option<&Named>) -> Option<Option<SegmentId>> {
        match name {
            Some(name) => self.segment(name).map(Some),
            None => Some(None),
        }
    }

    fn coordinate(&mut self, name: &Named) -> Option<CoordinateId> {
        let found = self.model.find_coordinate(&name.text);
        let id = self.known(name, found)?;
        if self.model.coordinate(id).kind == CoordinateKind::Orientation {
            let message = format!("`{}` is an orientation, not one number", name.text);
            let help = "give the orientation of its segment as a goal";
            self.said(name, "goals/orientation", message, help.to_owned());
            return None;
        }
        Some(id)
    }

    /// The coordinates whose key or name fits a pattern.
    fn coordinates(&mut self, pattern: &Named) -> Vec<CoordinateId> {
        let model = self.model;
        if !pattern.text.contains('*') {
            let found = model.find_coordinate(&pattern.text);
            return self.known(pattern, found).into_iter().collect();
        }
        let keys = model.coordinate_keys();
        let fits = |id: &CoordinateId| {
            fits_pattern(&pattern.text, &keys[id.index()])
                || fits_pattern(&pattern.text, &model.coordinate(*id).name)
        };
        let found: Vec<CoordinateId> = model.coordinate_ids().filter(fits).collect();
        if found.is_empty() {
            let message = format!("no coordinate fits `{}`", pattern.text);
            let all = || "`condyle info MODEL` lists them".to_owned();
            let help = did_you_mean(&pattern.text, keys.iter().map(String::as_str), all);
            self.said(pattern, "goals/unknown-coordinate", message, help);
        }
        found
    }

    /// A point; one at rest is where `own` is.
    fn point(&mut self, point: &NamedPoint, own: Option<Anchor>) -> Option<Anchor> {
        match point {
            NamedPoint::World(point) => Some((None, *point)),
            NamedPoint::OfSegment(segment, point) => Some((Some(self.segment(segment)?), *point)),
            NamedPoint::Rest => {
                let (segment, point) = own?;
                Some((None, self.at_rest.frame(segment) * point))
            }
            NamedPoint::Marker(name) => {
                let markers = self.model.markers();
                if let Some(marker) = markers.iter().find(|m| m.name == name.text) {
                    return Some((marker.segment, marker.point));
                }
                let message = format!("unknown marker `{}`", name.text);
                let all = || match markers {
                    [] => "the model has none: give { segment = \"…\", at = [x, y, z] }".to_owned(),
                    _ => "`condyle info MODEL` lists them".to_owned(),
                };
                let help = did_you_mean(&name.text, markers.iter().map(|m| m.name.as_str()), all);
                self.said(name, "goals/unknown-marker", message, help);
                None
            }
        }
    }

    fn aim(&mut self, aim: &NamedAim) -> Option<Aim> {
        Some(match aim {
            NamedAim::Point { point, at } => {
                let point = self.point(point, None);
                let at = self.point(at, point);
                Aim::Point { point: point?, at: at? }
            }
            NamedAim::Distance { points: [first, second], distance } => {
                let [first, second] = [first, second].map(|point| self.point(point, None));
                Aim::Distance { points: [first?, second?], distance: *distance }
            }
            NamedAim::Orientation { segment, relative_to, rotation } => {
                let segment = self.segment(segment);
                let relative_to = self.frame(relative_to.as_ref())?;
                let segment = segment?;
                let rotation = rotation.unwrap_or_else(|| {
                    let [own, other] =
                        [Some(segment), relative_to].map(|id| self.at_rest.frame(id).linear);
                    Quat::from_mat3(other.transpose() * own)
                });
                Aim::Orientation { segment, relative_to, rotation }
            }
            NamedAim::Axis { segment, axis, relative_to, along } => {
                let segment = self.segment(segment);
                let relative_to = self.frame(relative_to.as_ref())?;
                Aim::Axis { segment: segment?, axis: *axis, relative_to, along: *along }
            }
            NamedAim::Look { segment, axis, through, at } => {
                let segment = self.segment(segment);
                let at = self.point(at, None)?;
                Aim::Look { segment: segment?, axis: *axis, through: *through, at }
            }
            NamedAim::Plane { point, relative_to, origin, normal, above } => {
                let point = self.point(point, None);
                let frame = self.frame(relative_to.as_ref())?;
                let (origin, normal): (Anchor, Vec3) = ((frame, *origin), *normal);
                let side = if *above { Side::Above } else { Side::On };
                Aim::Plane { point: point?, origin, normal, side }
            }
            NamedAim::Coordinate { coordinate, value } => {
                Aim::Coordinate { coordinate: self.coordinate(coordinate)?, value: *value }
            }
        })
    }
}
