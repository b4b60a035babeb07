//! Key poses: a motion between poses at given times, as `condyle convert KEYS.json OUT --rate N` makes it.

use crate::answer::{Answer, Fault, fault, said, sentence};
use crate::stage::Stage;
use condyle::formats::poses;
use condyle::{Interpolation, Keys, Mode, Motion, Pose};
use serde_json::{Value, json};

/// The most numbers of a motion on the page, which has its memory only.
const MOST_NUMBERS: f64 = 2e7;

/// What is between key poses of a model.
#[derive(Debug)]
pub(crate) struct Keyed {
    keys: Keys,
    between: Interpolation,
}

impl Stage {
    /// `{"poses": [{"time": seconds, …}, …], "between": "spline"|"linear", "rate": frames a second}`: key poses as their
    /// file has them. They stay, for `"keyed"`, and the answer is their motion at that rate: `times`, and in the
    /// numbers, of eight bytes each, what couplings make of each frame.
    pub(crate) fn keys(&mut self, question: &Value) -> Result<Answer, Fault> {
        self.keyed = None;
        let text = question["poses"].to_string();
        let read = poses::read(text.as_bytes()).map_err(|error| fault(&error))?;
        let keys = read.value.keys(&self.model).map_err(|error| fault(&error))?;
        let between = match question["between"].as_str() {
            Some("linear") => Interpolation::Linear,
            _ => Interpolation::Spline,
        };
        let rate = question["rate"].as_f64().unwrap_or(f64::NAN);
        let span = keys.times.last().unwrap_or(&0.0) - keys.times.first().unwrap_or(&0.0);
        if span * rate * self.model.stored_len() as f64 > MOST_NUMBERS {
            return Err(sentence(format!("{rate} frames a second of {span} s: give a lower rate")));
        }
        let motion = keys.sample(&self.model, rate, between).map_err(|error| fault(&error))?;
        let remarks: Vec<Value> = read.value.remarks(&self.model).iter().map(said).collect();
        self.keyed = Some(Keyed { keys, between });
        let motion = self.coupled(motion);
        let mut answer = Answer::of(&json!({ "times": motion.times, "warnings": remarks }));
        answer.numbers = motion.frames.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        Ok(answer)
    }

    /// `{"actor": 0, "time": seconds}`: writes what the key poses ask at a time into the pose of an actor.
    pub(crate) fn keyed(&mut self, question: &Value) -> Result<Answer, Fault> {
        let none = || sentence("there are no key poses");
        let time = question["time"].as_f64().ok_or_else(|| sentence("a time is in seconds"))?;
        let number = question["actor"].as_u64().unwrap_or(0) as usize;
        let Keyed { keys, between } = self.keyed.as_ref().ok_or_else(none)?;
        let motion = keys.at(&self.model, vec![time], *between).map_err(|error| fault(&error))?;
        let actor = self.actors.get_mut(number);
        let actor = actor.ok_or_else(|| sentence(format!("there is no pose {number}")))?;
        let frame = motion.frames.first().ok_or_else(none)?;
        actor.asked.copy_from_slice(frame);
        Ok(Answer::default())
    }

    /// A motion with those coordinates that follow others where they follow to.
    fn coupled(&self, mut motion: Motion) -> Motion {
        let mut pose = Pose::new(&self.program);
        for frame in &mut motion.frames {
            if self.program.evaluate(frame, Mode::Open, &mut pose).is_ok() {
                frame.copy_from_slice(pose.effective());
            }
        }
        motion
    }
}

#[cfg(test)]
mod tests {
    use crate::stage::Stage;
    use serde_json::{Value, json};

    fn stage() -> Stage {
        Stage::new(condyle::shipped::read("knee").expect("it is shipped").value.model)
    }

    #[test]
    fn a_knee_goes_between_its_keys() {
        let mut stage = stage();
        let poses = json!([
            { "time": 0, "knee_angle_r": 0.0, "between": "linear" },
            { "time": 0.5, "knee_angle_r": "-30 deg" },
            { "time": 1.5, "knee_angle_r": -1.0 },
        ]);
        let question = json!({ "ask": "keys", "poses": poses, "rate": 4 });
        let answer = stage.ask(&question.to_string()).expect("they are keys");
        let text: Value = serde_json::from_str(&answer.text).expect("JSON");
        assert_eq!(text["times"].as_array().map(Vec::len), Some(7));
        assert_eq!(answer.numbers.len(), 7 * 8 * stage.model.stored_len());
        let knee = stage.model.find_coordinate("knee_angle_r").expect("a knee");
        let place = stage.model.stored_range(knee).start;
        let second = &answer.numbers[8 * (stage.model.stored_len() + place)..][..8];
        let second = f64::from_le_bytes(second.try_into().expect("eight bytes"));
        // On a line to -30°: half of it after half of the time.
        let half = -15f64.to_radians();
        assert!((second - half).abs() < 1e-15, "{second}");
        stage.ask(r#"{"ask": "keyed", "time": 0.25}"#).expect("there are keys");
        assert!((stage.actors[0].asked[place] - half).abs() < 1e-15);
    }

    #[test]
    fn what_are_no_keys_is_refused() {
        let mut stage = stage();
        assert!(stage.ask(r#"{"ask": "keyed", "time": 0.25}"#).is_err());
        for poses in
            [r#"[]"#, r#"{}"#, r#"[{"time": 0, "nose": 1}]"#, r#"[{"time": 0}, {"time": 0}]"#]
        {
            let question = format!(r#"{{"ask": "keys", "rate": 60, "poses": {poses}}}"#);
            assert!(stage.ask(&question).is_err(), "{poses}");
        }
        let question = r#"{"ask": "keys", "rate": 0, "poses": [{"time": 0}, {"time": 1}]}"#;
        assert!(stage.ask(question).is_err());
    }
}
