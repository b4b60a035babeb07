//! Goals of a pose, as `condyle pose MODEL GOALS.toml` has them.

use crate::answer::{Answer, Fault, fault, sentence};
use crate::stage::Stage;
use condyle::formats::document::goals::{self, GoalList, NamedAim, NamedPoint};
use condyle::posing::{Goals, Miss, follow, misses, resolve, solve};
use condyle::{CoordinateKind, Model, shipped};
use serde_json::{Map, Value, json};

impl Stage {
    /// `{"text": document of goals, "rest": stored numbers or null, "actor": 0, "way": "search"|"follow"|"look"}`: the goals stay, and
    /// dragging keeps them. `search` finds the pose that `condyle pose` does, `follow` goes there from the present one by
    /// a single descent, `look` moves nothing. The answer says what each goal lacks. An empty text lets goals go.
    pub(crate) fn goals(&mut self, question: &Value) -> Result<Answer, Fault> {
        let text = question["text"].as_str().unwrap_or("");
        self.goals = None;
        if text.is_empty() {
            return Ok(Answer::of(&json!({ "goals": [], "met": true })));
        }
        let rest = question["rest"].as_array();
        let rest: Option<Vec<f64>> =
            rest.map(|list| list.iter().filter_map(Value::as_f64).collect());
        let fits = rest.as_ref().is_none_or(|rest| rest.len() == self.model.stored_len());
        if !fits {
            return Err(sentence("a pose to be near has all stored numbers of the model"));
        }
        let goals = list(text).and_then(|list| {
            resolve(&self.model, &list, rest.as_deref()).map_err(|error| fault(&error))
        })?;
        let number = question["actor"].as_u64().unwrap_or(0) as usize;
        let none = || sentence(format!("there is no pose {number}"));
        let actor = self.actors.get(number).ok_or_else(none)?;
        let solved = match question["way"].as_str() {
            Some("search") => Some(solve(&self.model, &goals)),
            Some("follow") => follow(&self.model, &goals, &actor.effective),
            _ => None,
        };
        let found = solved.as_ref().map(|answer| answer.coordinates.clone());
        if let Some(coordinates) = found {
            // What lets limits go is shown so.
            self.move_to(number, &coordinates, goals.limits);
        }
        let shown = misses(&self.model, &goals, &self.actors[number].effective);
        let answer = json!({
            "goals": shown.iter().map(lacking).collect::<Vec<_>>(),
            "met": solved.as_ref().map(condyle::posing::Answer::is_met),
            "closure_error": solved.as_ref().map(|answer| answer.closure_error),
        });
        self.goals = Some(goals);
        Ok(Answer::of(&answer))
    }

    /// Moves an actor to a pose, if that can be evaluated; else it stays.
    pub(crate) fn move_to(&mut self, number: usize, coordinates: &[f64], within_limits: bool) {
        let before = self.actors[number].asked.clone();
        self.actors[number].asked.copy_from_slice(coordinates);
        if !self.pose(number, within_limits) {
            self.actors[number].asked.copy_from_slice(&before);
            self.pose(number, within_limits);
        }
    }

    /// What the goals that stay lack at the pose of an actor.
    pub(crate) fn lacking(&self, actor: usize) -> Vec<Value> {
        let Some(goals) = &self.goals else { return vec![] };
        let Some(actor) = self.actors.get(actor) else { return vec![] };
        let found = misses(&self.model, goals, &actor.effective);
        found.iter().map(lacking).collect()
    }
}

fn lacking(miss: &Miss) -> Value {
    json!({ "off": miss.off, "angle": miss.angle, "met": miss.is_met() })
}

fn list(text: &str) -> Result<GoalList, Fault> {
    let mut include = |name: &str| {
        let own = shipped::included(name).map(str::to_owned);
        own.map_err(|_| format!("`{name}` is another file, which a page cannot open"))
    };
    Ok(goals::read(text, &mut include).map_err(|error| fault(&error))?.value)
}

/// The goals of a dragged point beside those that are kept.
pub(crate) fn kept(goals: &Goals) -> Goals {
    let mut goals = goals.clone();
    for goal in &mut goals.goals {
        // What is to be met exactly gives way to what is dragged by a thousandth of it.
        goal.weight.get_or_insert(HELD);
    }
    goals
}

/// The weight of goals without one while something is dragged with a weight of 1.
const HELD: f64 = 1e3;

/// A document of goals as the page has them: its own keys, lengths in metres and angles in radians.
pub(crate) fn described(text: &str, model: Option<&Model>) -> Result<Value, Fault> {
    let list = list(text)?;
    let goals: Vec<Value> = list
        .goals
        .iter()
        .map(|goal| {
            let mut fields = Map::new();
            fields.insert("kind".into(), goal.aim.kind().into());
            fields.insert("name".into(), goal.name.text.clone().into());
            aim(&goal.aim, model, &mut fields);
            if let Some(weight) = goal.weight {
                fields.insert("weight".into(), weight.into());
            }
            Value::Object(fields)
        })
        .collect();
    let hold: Vec<&str> = list.hold.iter().map(|name| &name.text[..]).collect();
    let stiffness: Vec<Value> =
        list.stiffness.iter().map(|(name, value)| json!([name.text, value])).collect();
    let limits = list.limits.unwrap_or(true);
    Ok(json!({ "goals": goals, "hold": hold, "stiffness": stiffness, "limits": limits }))
}

fn point(point: &NamedPoint) -> Value {
    match point {
        NamedPoint::Marker(name) => json!(name.text),
        NamedPoint::OfSegment(segment, at) => {
            json!({ "segment": segment.text, "at": at.to_array() })
        }
        NamedPoint::World(at) => json!(at.to_array()),
        NamedPoint::Rest => json!("rest"),
    }
}

fn aim(aim: &NamedAim, model: Option<&Model>, fields: &mut Map<String, Value>) {
    let mut put = |key: &str, value: Value| {
        if !value.is_null() {
            fields.insert(key.to_owned(), value);
        }
    };
    match aim {
        NamedAim::Point { point: own, at } => {
            put("point", point(own));
            put("at", point(at));
        }
        NamedAim::Distance { points, distance } => {
            put("points", points.iter().map(point).collect());
            put("distance", json!(distance));
        }
        NamedAim::Orientation { segment, relative_to, rotation } => {
            put("segment", json!(segment.text));
            put("in", json!(relative_to.as_ref().map(|name| &name.text)));
            match rotation {
                Some(rotation) => put("quaternion", json!(rotation.to_array())),
                None => put("turn", json!("rest")),
            }
        }
        NamedAim::Axis { segment, axis, relative_to, along } => {
            put("segment", json!(segment.text));
            put("axis", json!(axis.to_array()));
            put("in", json!(relative_to.as_ref().map(|name| &name.text)));
            put("along", json!(along.to_array()));
        }
        NamedAim::Look { segment, axis, through, at } => {
            put("segment", json!(segment.text));
            put("axis", json!(axis.to_array()));
            put("through", json!(through.to_array()));
            put("at", point(at));
        }
        NamedAim::Plane { point: own, relative_to, origin, normal, above } => {
            put("point", point(own));
            put("in", json!(relative_to.as_ref().map(|name| &name.text)));
            put("origin", json!(origin.to_array()));
            put("normal", json!(normal.to_array()));
            put("side", json!(if *above { "above" } else { "on" }));
        }
        NamedAim::Coordinate { coordinate, value } => {
            put("value", json!(value));
            let kind = model.and_then(|model| {
                let id = model.find_coordinate(&coordinate.text).ok()?;
                Some(model.coordinate(id).kind)
            });
            match kind {
                Some(CoordinateKind::Translation) => put("unit", json!("m")),
                Some(CoordinateKind::Rotation) => put("unit", json!("rad")),
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::stage::Stage;
    use condyle::posing;
    use serde_json::{Value, json};

    const FEET: &str = include_str!("../../../examples/goals/hand-on-shoulder.toml");

    fn human() -> Stage {
        Stage::new(condyle::shipped::read("human").expect("it is shipped").value.model)
    }

    fn asked(stage: &mut Stage, question: &Value) -> Value {
        let answer = stage.ask(&question.to_string()).expect("it is answered");
        serde_json::from_str(&answer.text).expect("JSON")
    }

    /// The pose is that of the facade, and so of `condyle pose`; evaluating it within limits moves nothing.
    #[test]
    fn goals_are_met_as_by_the_command() {
        let mut stage = human();
        let list = super::list(FEET).expect("goals");
        let native = posing::pose(&stage.model, &list, None).expect("a pose").answer;
        let question = json!({ "ask": "goals", "text": FEET, "way": "search" });
        let answer = asked(&mut stage, &question);
        assert_eq!(answer["met"], json!(native.is_met()));
        assert_eq!(answer["goals"].as_array().map(Vec::len), Some(6));
        for (own, native) in stage.actors[0].effective.iter().zip(&native.coordinates) {
            assert!((own - native).abs() < 1e-9, "{own} {native}");
        }
        let described = super::described(FEET, Some(&stage.model)).expect("goals");
        assert_eq!(described["goals"][0]["at"]["segment"], json!("scapula_l"));
    }

    /// Both feet are held while a hand is led away, at last beyond reach: the feet stay to 2 mm, and no limit is broken.
    #[test]
    fn feet_that_are_held_stay_while_a_hand_is_dragged() {
        let feet: String = FEET.split("[look.eyes]").next().unwrap_or_default().replace(
            "[point.hand]
point = \"RFIN\"
at = { segment = \"scapula_l\", at = [0, 0.03, 0] }",
            "",
        );
        let mut stage = human();
        asked(&mut stage, &json!({ "ask": "goals", "text": feet, "way": "look" }));
        let hand =
            stage.model.markers().iter().find(|m| m.name == "RFIN").expect("a marker").clone();
        let segment = hand.segment.expect("it is on a hand");
        let start = stage.actors[0].pose.segment(segment) * hand.point;
        let mut offs = vec![];
        for step in 1..=12 {
            let by = 0.05 * f64::from(step);
            let question = json!({
                "ask": "drag", "segment": segment.index(), "point": hand.point.to_array(),
                "target": [start.x + by, start.y - by, start.z], "hold": [],
            });
            let answer = asked(&mut stage, &question);
            for goal in answer["goals"].as_array().expect("goals") {
                let off = goal["off"].as_f64().expect("a number");
                assert!(off < 2e-3, "step {step}: a foot is off by {off}");
            }
            offs.push(answer["off"].as_f64().expect("a number"));
            for id in stage.model.coordinate_ids() {
                let (low, high) = stage.model.coordinate(id).range.bounds();
                let value = stage.model.value(&stage.actors[0].effective, id);
                assert!(low - 1e-9 <= value && value <= high + 1e-9);
            }
            for row in 0..stage.program.limit_row_len() {
                assert!(stage.actors[0].pose.limit_row(row) > -1e-6);
            }
        }
        // Twenty centimetres forward and down is within reach of one who stands and bends.
        assert!(offs[2] < 5e-3, "{offs:?}");
    }

    #[test]
    fn wrong_goals_are_said() {
        let mut stage = human();
        for text in
            ["[", "condyle = 1\nkind = \"goals\"\n[point.a]\npoint = \"nose\"\nat = [0, 0, 0]\n"]
        {
            let question = json!({ "ask": "goals", "text": text });
            assert!(stage.ask(&question.to_string()).is_err(), "{text}");
        }
        let short = json!({ "ask": "goals", "text": FEET, "rest": [1, 2] });
        assert!(stage.ask(&short.to_string()).is_err());
    }
}
