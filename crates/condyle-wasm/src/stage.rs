//! A model on the page, and its poses.

use crate::answer::{Answer, Fault, fault, sentence};
use crate::keyed::Keyed;
use condyle::math::Affine;
use condyle::picture::Reaches;
use condyle::posing::Goals;
use condyle::{Figure, Mode, Model, Pose, Program, legal};
use serde_json::Value;

/// A model, ready to be posed.
#[derive(Debug)]
pub struct Stage {
    /// The model.
    pub model: Model,
    pub(crate) program: Program,
    /// What its bones look like.
    pub(crate) figure: Figure,
    /// What learned limits reach, worked out once.
    pub(crate) reaches: Reaches,
    /// Where segments at the defaults come from: the inverse of each one's place there.
    back: Vec<Affine>,
    /// Poses of it, side by side or over each other; there is one at least.
    pub actors: Vec<Actor>,
    /// What is dragged now.
    pub(crate) drag: Option<Goals>,
    /// The goals that are kept.
    pub(crate) goals: Option<Goals>,
    /// The key poses that are on the timeline.
    pub(crate) keyed: Option<Keyed>,
}

/// A pose of the model, in buffers that stay where they are.
#[derive(Debug)]
pub struct Actor {
    /// The stored numbers that are asked for: the page writes here.
    pub asked: Vec<f64>,
    /// The numbers that limits and couplings leave of them.
    pub effective: Vec<f64>,
    /// How surfaces at the defaults come to this pose: for each segment sixteen numbers, column by column.
    pub moves: Vec<f32>,
    /// Where segments are in the world: sixteen numbers each, row by row, as `condyle fk` gives them.
    pub places: Vec<f64>,
    pub(crate) pose: Pose,
}

impl Stage {
    /// A model at its defaults.
    #[must_use]
    pub fn new(model: Model) -> Self {
        let program = Program::compile(&model);
        let figure = Figure::new(&model);
        let back = figure.neutral.iter().map(|neutral| {
            let linear = neutral.linear.inverse();
            Affine::new(linear, -(linear * neutral.translation))
        });
        let back = back.collect();
        let reaches = Reaches::default();
        let mut stage = Self {
            model,
            program,
            figure,
            reaches,
            back,
            actors: vec![],
            drag: None,
            goals: None,
            keyed: None,
        };
        stage.add_actor();
        stage
    }

    /// One more pose of the model, at its defaults; its number.
    pub fn add_actor(&mut self) -> usize {
        let (asked, segments) = (self.model.defaults(), self.model.segments().len());
        self.actors.push(Actor {
            effective: asked.clone(),
            asked,
            moves: vec![0.0; 16 * segments],
            places: vec![0.0; 16 * segments],
            pose: Pose::new(&self.program),
        });
        self.pose(self.actors.len() - 1, true);
        self.actors.len() - 1
    }

    /// Evaluates a pose: within all limits, or as it is asked. Whether it could be; else it stays as it was.
    pub fn pose(&mut self, actor: usize, within_limits: bool) -> bool {
        let Some(actor) = self.actors.get_mut(actor) else { return false };
        let Actor { asked, pose, .. } = actor;
        if asked.iter().any(|number| !number.is_finite()) {
            return false;
        }
        let evaluated = match within_limits {
            true => legal::evaluate(&self.model, &self.program, asked, pose).is_ok(),
            false => self.program.evaluate(asked, Mode::Open, pose).is_ok(),
        };
        if evaluated {
            actor.hand_out(&self.back);
        }
        evaluated
    }

    /// Answers a question in JSON, `{"ask": WHAT, …}`.
    ///
    /// # Errors
    /// What is wrong, as JSON, where nothing is asked that is known.
    pub fn ask(&mut self, question: &str) -> Result<Answer, Fault> {
        let question: Value =
            serde_json::from_str(question).map_err(|error| sentence(error.to_string()))?;
        match question["ask"].as_str().unwrap_or("") {
            "describe" => Ok(self.described()),
            "bones" => Ok(self.bones()),
            "signs" => self.signs(&question).map_err(|error| fault(&error)),
            "network" => self.network(&question),
            "live" => self.live(&question),
            "drag" => self.dragged(&question),
            "drop" => {
                self.drag = None;
                Ok(Answer::default())
            }
            "actor" => Ok(Answer::of(&Value::from(self.add_actor()))),
            "goals" => self.goals(&question),
            "lacking" => {
                let actor = question["actor"].as_u64().unwrap_or(0) as usize;
                Ok(Answer::of(&Value::from(self.lacking(actor))))
            }
            "keys" => self.keys(&question),
            "keyed" => self.keyed(&question),
            "check" => self.checked(&question),
            "save" => self.saved(&question),
            other => Err(sentence(format!("nothing is asked by `{other}`"))),
        }
    }
}

impl Actor {
    /// Copies the pose to where the page reads it.
    fn hand_out(&mut self, back: &[Affine]) {
        self.effective.copy_from_slice(self.pose.effective());
        let frames = self.pose.segments().iter().zip(back);
        let out = self.moves.chunks_exact_mut(16).zip(self.places.chunks_exact_mut(16));
        for ((frame, back), (moves, places)) in frames.zip(out) {
            let moved = *frame * *back;
            let columns = [moved.linear.x, moved.linear.y, moved.linear.z, moved.translation];
            for (column, (values, last)) in columns.iter().zip([0.0, 0.0, 0.0, 1.0]).enumerate() {
                let [x, y, z] = values.to_array();
                for (row, value) in [x, y, z, last].into_iter().enumerate() {
                    moves[4 * column + row] = value as f32;
                }
            }
            let columns = [frame.linear.x, frame.linear.y, frame.linear.z, frame.translation];
            for (column, values) in columns.iter().enumerate() {
                for (row, value) in values.to_array().into_iter().enumerate() {
                    places[4 * row + column] = value;
                }
            }
            places[12..].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn stage(name: &str) -> Stage {
        Stage::new(condyle::shipped::read(name).expect("it is shipped").value.model)
    }

    #[test]
    fn what_is_asked_beyond_a_range_stops_there() {
        let mut stage = stage("knee");
        let knee = stage.model.find_coordinate("knee_angle_r").unwrap();
        let upper = stage.model.coordinate(knee).range.upper.unwrap();
        let place = stage.model.stored_range(knee).start;
        stage.actors[0].asked[place] = upper + 1.0;
        assert!(stage.pose(0, true));
        assert_eq!(stage.actors[0].effective[place], upper);
        assert!(stage.pose(0, false));
        assert_eq!(stage.actors[0].effective[place], upper + 1.0);
        // What is no number leaves the pose as it was.
        stage.actors[0].asked[place] = f64::NAN;
        assert!(!stage.pose(0, true));
        assert_eq!(stage.actors[0].effective[place], upper + 1.0);
    }

    #[test]
    fn a_surface_at_the_defaults_moves_with_its_segment() {
        let mut stage = stage("knee");
        // At the defaults nothing moves: the identity.
        for (index, value) in stage.actors[0].moves.iter().enumerate() {
            let one = f32::from(u8::from(index % 16 % 5 == 0));
            assert!((value - one).abs() < 1e-6, "{index}: {value}");
        }
        stage.actors[0].asked[0] += 0.5;
        stage.pose(0, true);
        // A corner of the tibia, by the matrix and by the library.
        let tibia = stage.model.find_segment("tibia_r").unwrap();
        let part = stage.figure.parts.iter().find(|p| p.segments[0] == tibia).unwrap();
        let corner = part.mesh.positions[5].to_array();
        let posed = stage.figure.posed(part, &stage.actors[0].pose).positions[5].to_array();
        let m = &stage.actors[0].moves[16 * tibia.index()..];
        for row in 0..3 {
            let sum: f64 = (0..3).map(|c| f64::from(m[4 * c + row]) * corner[c]).sum();
            assert!((sum + f64::from(m[12 + row]) - posed[row]).abs() < 1e-6);
        }
    }

    #[test]
    fn questions_that_are_none_are_refused() {
        let mut stage = stage("knee");
        for question in ["", "{", "[]", "{}", r#"{"ask": 3}"#, r#"{"ask": "all"}"#] {
            assert!(stage.ask(question).is_err(), "{question}");
        }
        for ask in [
            "describe", "bones", "signs", "network", "live", "drag", "check", "save", "keys",
            "keyed",
        ] {
            // Without what belongs to it, a question has some answer or a fault, and no panic.
            let _ = stage.ask(&format!(r#"{{"ask": "{ask}"}}"#));
        }
    }
}
