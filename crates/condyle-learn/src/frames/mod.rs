//! Orientations of segments from markers: by a recipe that says which markers span a segment's axes.
//!
//! A frame has one axis that keeps its direction and a second that is made perpendicular to it; the third is their
//! cross product, so that all frames are right-handed:
//!
//! a = d₁/|d₁|,  b = (d₂ - (d₂·a) a)/|…|,  c = a × b, put at the axes that the recipe names.
//!
//! A direction goes from one place to another or is the normal of the plane through three; a place is a marker
//! or the mean of several. Where the two directions, or the edges of such a plane, are nearly parallel the
//! second axis is noise: with a straight elbow the plane of shoulder, elbow and wrist is undefined. Such frames of a
//! recording are left out and counted, and so are those without a marker that is needed.
//!
//! Rotations are those of the child's axes in the reference segment's, R_reference⁻¹ R_child: how the
//! trunk leans does not enter the range of a shoulder.

mod labels;
mod recipe;
#[cfg(test)]
mod tests;

pub use labels::{Guess, Guessed};
pub use recipe::{Axis, Direction, FrameRecipe, Place, Recipe};

use condyle_diagnostics::{Diagnostic, Error};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_motion::Recording;

/// Rotations of one segment in another, from one recording of any kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Orientated {
    /// The rotations of the child in the reference segment, in the order of the recording.
    pub rotations: Vec<Quat>,
    /// The frame of the recording of each.
    pub frames: Vec<usize>,
    /// Frames in which a marker was missing.
    pub missing: usize,
    /// Frames in which the axes were ill-conditioned.
    pub ill_conditioned: usize,
    /// Frames whose numbers are no rotation: not finite, or a quaternion of length 0.
    pub unusable: Vec<usize>,
    /// Frames whose quaternion is not of length 1 to a thousandth; it is made so.
    pub scaled: usize,
    /// Markers that were taken under another name.
    pub guesses: Vec<Guess>,
}

impl Orientated {
    /// What a person should know about it: how many frames were left out, and why.
    #[must_use]
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let all = self.given();
        let mut warnings = labels::warnings(&self.guesses);
        if self.missing > 0 {
            let message = format!("{} of {all} frames lack a marker of the recipe", self.missing);
            warnings.push(Diagnostic::note("recipe/missing", message));
        }
        if self.ill_conditioned > 0 {
            let message = format!(
                "{} of {all} frames are left out: directions that span a frame are nearly parallel",
                self.ill_conditioned
            );
            warnings.push(Diagnostic::note("recipe/ill-conditioned", message));
        }
        if let Some(first) = self.unusable.first() {
            let count = self.unusable.len();
            let message = format!(
                "{count} of {all} frames are left out: not finite, or of length 0; the first is frame {first}, counted from 0"
            );
            warnings.push(Diagnostic::warning("rotations/unusable", message));
        }
        if self.scaled > 0 {
            let message = format!(
                "{} of {all} quaternions are not of length 1 to a thousandth: they are made so",
                self.scaled
            );
            warnings.push(Diagnostic::warning("rotations/length", message));
        }
        warnings
    }

    /// How many frames the recording has.
    #[must_use]
    pub fn given(&self) -> usize {
        self.frames.len() + self.missing + self.ill_conditioned + self.unusable.len()
    }

    /// Takes a quaternion of a frame, whatever it is.
    pub(crate) fn push(&mut self, frame: usize, q: Quat) {
        let length = q.dot(q).sqrt();
        if !(length.is_finite() && length > 1e-9) {
            self.unusable.push(frame);
            return;
        }
        self.scaled += usize::from((length - 1.0).abs() > 1e-3);
        self.rotations.push(q.normalized());
        self.frames.push(frame);
    }
}

/// The markers of a recording that the places of a recipe are.
struct Found {
    places: Vec<(String, Vec<usize>)>,
    guesses: Vec<Guess>,
}

impl Found {
    fn new(recipe: &Recipe, recording: &Recording, subject: Option<&str>) -> Result<Self, Error> {
        let mut found = Self { places: vec![], guesses: vec![] };
        for name in recipe.places() {
            let markers = match recipe.points.iter().find(|point| point.name == name) {
                Some(place) => &place.markers[..],
                None => std::slice::from_ref(&name),
            };
            let mut labels = vec![];
            for marker in markers {
                let (label, guess) = labels::label(recipe, recording, marker, subject)?;
                labels.push(label);
                found.guesses.extend(guess.filter(|guess| !found.guesses.contains(guess)));
            }
            found.places.push((name, labels));
        }
        Ok(found)
    }

    fn place(&self, name: &str, recording: &Recording, frame: usize) -> Option<Vec3> {
        let (_, markers) = self.places.iter().find(|(place, _)| place == name)?;
        let mut sum = Vec3::zero();
        for &marker in markers {
            sum += Vec3::from(recording.position(frame, marker)?);
        }
        Some(sum * (1.0 / markers.len() as f64))
    }
}

/// Why a frame gives no rotation.
enum Failed {
    Missing,
    IllConditioned,
}

impl Recipe {
    /// The rotations that a recording shows.
    ///
    /// # Errors
    /// As [`rotations_of`](Self::rotations_of).
    ///
    /// ```
    /// use condyle_learn::frames::{Axis, Direction, FrameRecipe, Recipe};
    /// use condyle_motion::Recording;
    /// let between = |from: &str, to: &str| Direction::Between { from: from.into(), to: to.into() };
    /// let recipe = Recipe {
    ///     child: FrameRecipe {
    ///         name: "humerus".into(),
    ///         kept: (Axis::Y, between("elbow", "shoulder")),
    ///         second: (Axis::Z, between("inner", "outer")),
    ///     },
    ///     ..Recipe::default()
    /// };
    /// let recording = Recording {
    ///     labels: ["shoulder", "elbow", "inner", "outer"].map(str::to_owned).to_vec(),
    ///     times: vec![0.0],
    ///     // The arm hangs turned outward by a right angle: its z points forward, along x.
    ///     positions: [[0.0, 1.4, 0.2], [0.0, 1.1, 0.2], [-0.03, 1.1, 0.2], [0.04, 1.1, 0.2]]
    ///         .map(Into::into)
    ///         .to_vec(),
    ///     ..Recording::default()
    /// };
    /// let found = recipe.rotations(&recording)?;
    /// assert!((found.rotations[0].log().y - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn rotations(&self, recording: &Recording) -> Result<Orientated, Error> {
        self.rotations_of(recording, None)
    }

    /// The rotations of one of several people in a recording: those whose labels begin with the name of the
    /// subject and a colon.
    ///
    /// A marker is found by its name; else without `Subject:`, else ignoring case, each a guess with a
    /// warning.
    ///
    /// # Errors
    /// `recipe/marker` if the recording lacks a marker of the recipe, or two fit.
    pub fn rotations_of(
        &self,
        recording: &Recording,
        subject: Option<&str>,
    ) -> Result<Orientated, Error> {
        let found = Found::new(self, recording, subject)?;
        let least = self.least_angle.sin();
        let mut said = Orientated { guesses: found.guesses.clone(), ..Orientated::default() };
        for frame in 0..recording.frames() {
            let place = |name: &str| found.place(name, recording, frame).ok_or(Failed::Missing);
            let rotation = axes(&self.child, least, &place).and_then(|child| {
                Ok(match &self.reference {
                    Some(reference) => axes(reference, least, &place)?.transpose() * child,
                    None => child,
                })
            });
            match rotation {
                Ok(rotation) => said.push(frame, Quat::from_mat3(rotation)),
                Err(Failed::Missing) => said.missing += 1,
                Err(Failed::IllConditioned) => said.ill_conditioned += 1,
            }
        }
        Ok(said)
    }

    /// The axes of the reference, if the recipe has one, and of the child, as columns in the laboratory, of a person who stands: each place
    /// is the mean of its markers over all frames that show them.
    ///
    /// # Errors
    /// `recipe/marker` if the recording lacks a marker of the recipe, or shows it in no frame; `recipe/ill-conditioned` where directions are
    /// nearly parallel.
    pub fn standing(&self, recording: &Recording) -> Result<(Option<Mat3>, Mat3), Error> {
        let found = Found::new(self, recording, None)?;
        let mean = |marker: usize| {
            let seen: Vec<Vec3> = (0..recording.frames())
                .filter_map(|frame| recording.position(frame, marker).map(Vec3::from))
                .collect();
            let sum = seen.iter().fold(Vec3::zero(), |sum, place| sum + *place);
            (!seen.is_empty()).then(|| sum * (1.0 / seen.len() as f64))
        };
        let place = |name: &str| {
            let (_, markers) =
                found.places.iter().find(|(place, _)| place == name).ok_or(Failed::Missing)?;
            let mut sum = Vec3::zero();
            for &marker in markers {
                sum += mean(marker).ok_or(Failed::Missing)?;
            }
            Ok(sum * (1.0 / markers.len() as f64))
        };
        let least = self.least_angle.sin();
        let of = |frame: &FrameRecipe| {
            axes(frame, least, &place).map_err(|failed| match failed {
                Failed::Missing => {
                    let message = format!("no frame shows all markers of `{}`", frame.name);
                    Error::new("recipe/marker", message)
                }
                Failed::IllConditioned => {
                    let message =
                        format!("directions that span `{}` are nearly parallel", frame.name);
                    Error::new("recipe/ill-conditioned", message)
                }
            })
        };
        Ok((self.reference.as_ref().map(of).transpose()?, of(&self.child)?))
    }
}

/// The axes of a segment in the laboratory, as columns.
fn axes(
    frame: &FrameRecipe,
    least: f64,
    place: &dyn Fn(&str) -> Result<Vec3, Failed>,
) -> Result<Mat3, Failed> {
    let (first, a) = (frame.kept.0, direction(&frame.kept.1, least, place)?);
    let (second, d) = (frame.second.0, direction(&frame.second.1, least, place)?);
    let across = d - a * d.dot(a);
    // Both are of length 1, so that this is the sine of the angle between them.
    if across.norm() < least.max(1e-9) {
        return Err(Failed::IllConditioned);
    }
    let b = across.normalized();
    let third = 3 - first as usize - second as usize;
    // x × y = z and so on in cycles; against the cycle the sign turns.
    let cyclic = (second as usize + 3 - first as usize) % 3 == 1;
    let c = if cyclic { a.cross(b) } else { b.cross(a) };
    let mut columns = [Vec3::zero(); 3];
    columns[first as usize] = a;
    columns[second as usize] = b;
    columns[third] = c;
    let [x, y, z] = columns;
    Ok(Mat3::from_columns(x, y, z))
}

/// A direction of length 1.
fn direction(
    direction: &Direction,
    least: f64,
    place: &dyn Fn(&str) -> Result<Vec3, Failed>,
) -> Result<Vec3, Failed> {
    let unit = |v: Vec3, least: f64| match v.norm() {
        length if length > least => Ok(v * (1.0 / length)),
        _ => Err(Failed::IllConditioned),
    };
    match direction {
        Direction::Between { from, to } => unit(place(to)? - place(from)?, 1e-6),
        Direction::Normal { points: [a, b, c] } => {
            let (a, b, c) = (place(a)?, place(b)?, place(c)?);
            let (ab, ac) = (unit(b - a, 1e-6)?, unit(c - a, 1e-6)?);
            unit(ab.cross(ac), least.max(1e-9))
        }
    }
}
