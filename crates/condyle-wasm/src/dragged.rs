//! A point that is dragged, and the body that follows it.

use crate::answer::{Answer, Fault, sentence};
use crate::goals::kept;
use crate::stage::Stage;
use condyle::math::Vec3;
use condyle::posing::{Aim, Goal, Goals, follow};
use condyle::{CoordinateId, SegmentId};
use serde_json::{Value, json};

impl Stage {
    /// `{"actor": 0, "segment": number, "point": [x, y, z], "target": [x, y, z], "hold": [coordinate, …]}`: moves the
    /// pose so that a point of a segment comes as near to a place as limits and loops allow, from where it is. The
    /// pose where dragging began is the one to stay near to; `"drop"` ends it. The answer says how far off the
    /// point is. Goals that stay (`"goals"`) hold meanwhile, in place of `hold`; the answer says what each of them lacks.
    pub(crate) fn dragged(&mut self, question: &Value) -> Result<Answer, Fault> {
        let number = question["actor"].as_u64().unwrap_or(0) as usize;
        let point = vector(&question["point"]).ok_or_else(|| sentence("no point is dragged"))?;
        let target = vector(&question["target"]).ok_or_else(|| sentence("there is no target"))?;
        let segment = question["segment"].as_u64().unwrap_or(u64::MAX) as usize;
        let segment = self.model.segment_ids().nth(segment);
        let segment = segment.ok_or_else(|| sentence("there is no such segment"))?;
        let Some(actor) = self.actors.get_mut(number) else {
            return Err(sentence(format!("there is no pose {number}")));
        };
        let held = question["hold"].as_array().map_or(&[][..], |list| list);
        let held: Vec<CoordinateId> = held
            .iter()
            .filter_map(|index| self.model.coordinate_ids().nth(index.as_u64()? as usize))
            .collect();
        let pins = self.goals.as_ref().map(kept);
        let weight = pins.as_ref().map(|_| 1.0);
        let goals = self.drag.get_or_insert_with(|| {
            let mut goals = Goals::of(&self.model);
            goals.rest = goals.rest.around(&self.model, &actor.effective);
            goals
        });
        goals.held = held;
        if let Some(pins) = &pins {
            // Goals say what carries the body.
            goals.held.clone_from(&pins.held);
            goals.rest.stiffness.clone_from(&pins.rest.stiffness);
        }
        let aim = Aim::Point { point: (Some(segment), point), at: (None, target) };
        goals.goals = pins.map_or_else(Vec::new, |pins| pins.goals);
        goals.goals.push(Goal { aim, weight });
        let Some(answer) = follow(&self.model, goals, &actor.effective) else {
            return Err(sentence("the pose cannot be evaluated"));
        };
        // A descent may end a hair outside of a limit, and in the middle of a loop: what is shown is legal.
        let iterations = answer.iterations;
        if answer.closure_error <= 1e-4 {
            self.move_to(number, &answer.coordinates, true);
        }
        let off = self.off(number, segment, point, target);
        Ok(Answer::of(
            &json!({ "off": off, "iterations": iterations, "goals": self.lacking(number) }),
        ))
    }

    /// How far a point is from a place, in metres.
    fn off(&self, actor: usize, segment: SegmentId, point: Vec3, target: Vec3) -> f64 {
        (self.actors[actor].pose.segment(segment) * point - target).norm()
    }
}

/// Three numbers.
pub(crate) fn vector(value: &Value) -> Option<Vec3> {
    let list = value.as_array()?;
    let numbers: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
    let three: [f64; 3] = numbers.try_into().ok()?;
    three.iter().all(|x| x.is_finite()).then(|| three.into())
}

#[cfg(test)]
mod tests {
    use crate::stage::Stage;
    use serde_json::{Value, json};

    /// A hand that is led 30 cm forward and up arrives; one led to the moon stays within its limits.
    #[test]
    fn a_hand_follows_and_no_limit_breaks() {
        let human = condyle::shipped::read("human").expect("it is shipped").value.model;
        let hand = human.markers().iter().find(|m| m.name == "RFIN").expect("a marker").clone();
        let segment = hand.segment.expect("it is on a hand");
        let mut stage = Stage::new(human);
        let start = stage.actors[0].pose.segment(segment) * hand.point;
        let hold: Vec<usize> = (0..6).collect();
        let led = |stage: &mut Stage, to: [f64; 3]| {
            let question = json!({
                "ask": "drag", "segment": segment.index(), "point": hand.point.to_array(),
                "target": to, "hold": hold,
            });
            let answer = stage.ask(&question.to_string()).expect("it is dragged");
            let answer: Value = serde_json::from_str(&answer.text).expect("JSON");
            answer["off"].as_f64().expect("a number")
        };
        let mut off = 1.0;
        for step in 1..=10 {
            let share = 0.03 * f64::from(step);
            let to = [start.x + share, start.y + share, start.z];
            off = led(&mut stage, to);
        }
        assert!(off < 1e-3, "{off}");
        let off = led(&mut stage, [100.0, 0.0, 0.0]);
        assert!(off > 90.0);
        for id in stage.model.coordinate_ids() {
            let (low, high) = stage.model.coordinate(id).range.bounds();
            let value = stage.model.value(&stage.actors[0].effective, id);
            assert!(
                low - 1e-9 <= value && value <= high + 1e-9,
                "{}",
                stage.model.coordinate_key(id)
            );
        }
        for row in 0..stage.program.limit_row_len() {
            assert!(stage.actors[0].pose.limit_row(row) > -1e-6);
        }
    }
}
