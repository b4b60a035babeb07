//! Markers that the page has, tracked with the model as it is now, and how far a tracking has come.

use crate::answer::{Answer, Fault, fault, sentence};
use crate::shown::Shown;
use crate::stage::Stage;
use condyle::tracking::{Request, track};
use condyle::{Observed, Recording};
use serde_json::{Value, json};

/// Tells the page how many frames of how many are tracked.
#[cfg(all(target_arch = "wasm32", not(feature = "readers")))]
pub(crate) use crate::border::told;

/// Nobody hears of it but a page.
#[cfg(not(all(target_arch = "wasm32", not(feature = "readers"))))]
pub(crate) fn told(_done: usize, _of: usize) {}

impl Stage {
    /// `{"names": […], "times": […], "positions": [x, y, z, …]}`, metres, row by row, null for what is not seen: coordinates of the
    /// frames, as a dropped recording has them.
    pub(crate) fn track(&self, question: &Value) -> Result<Answer, Fault> {
        let words = question["names"].as_array().map_or(&[][..], |list| list);
        let labels: Vec<String> =
            words.iter().filter_map(|name| Some(name.as_str()?.to_owned())).collect();
        let list = question["times"].as_array().map_or(&[][..], |list| list);
        let times: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
        let numbers = question["positions"].as_array().map_or(&[][..], |list| list);
        if labels.is_empty() || times.is_empty() || numbers.len() != 3 * labels.len() * times.len()
        {
            return Err(sentence(
                "a recording has names, times, and three numbers for each marker",
            ));
        }
        let place = |three: &[Value]| -> Option<[f64; 3]> {
            let three: Vec<f64> = three.iter().filter_map(Value::as_f64).collect();
            three.try_into().ok()
        };
        let positions = numbers.chunks_exact(3).map(|three| Observed::from(place(three))).collect();
        let span = times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0);
        let rate = if span > 0.0 { (times.len() - 1) as f64 / span } else { 100.0 };
        let recording = Recording { labels, rate, times, positions, ..Recording::default() };
        let tracking = track(&self.model, &recording, &Request::default(), &mut told);
        let tracking = tracking.map_err(|error| fault(&error))?;
        let shown = Shown::tracked(String::new(), &self.model, &recording, &tracking);
        let mut answer = Answer::default();
        let motion = shown.to_json(|numbers| answer.floats(numbers));
        answer.text = json!({ "motion": motion }).to_string();
        Ok(answer)
    }
}

#[cfg(test)]
mod tests {
    use crate::stage::Stage;
    use serde_json::{Value, json};

    /// Markers of the posed model itself lead back to its poses.
    #[test]
    fn markers_give_the_poses_that_they_are_of() {
        let model = condyle::shipped::read("legs").expect("it is shipped").value.model;
        let mut stage = Stage::new(model);
        let knee = stage.model.find_coordinate("knee_angle_r").expect("a knee");
        let place = stage.model.stored_range(knee).start;
        let times = [0.0, 0.1, 0.2];
        let names: Vec<String> = stage.model.markers().iter().map(|m| m.name.clone()).collect();
        let mut positions: Vec<f64> = vec![];
        for time in times {
            stage.actors[0].asked[place] = 0.3 + time;
            assert!(stage.pose(0, true));
            let pose = &stage.actors[0].pose;
            let at = |m: &condyle::model::Marker| (pose.frame(m.segment) * m.point).to_array();
            positions.extend(stage.model.markers().iter().flat_map(at));
        }
        let question =
            json!({ "ask": "track", "names": names, "times": times, "positions": positions });
        let answer = stage.ask(&question.to_string()).expect("it is tracked");
        let text: Value = serde_json::from_str(&answer.text).expect("JSON");
        let start = text["motion"]["values"][0].as_u64().expect("a place") as usize;
        let width = stage.model.stored_len();
        for (frame, time) in times.iter().enumerate() {
            let at = start + 4 * (frame * width + place);
            let bytes = answer.numbers[at..at + 4].try_into().expect("four bytes");
            let own = f64::from(f32::from_le_bytes(bytes));
            assert!((own - 0.3 - time).abs() < 1e-3, "{own}");
        }
        assert!(
            stage
                .ask(r#"{"ask": "track", "names": ["a"], "times": [0], "positions": [1]}"#)
                .is_err()
        );
    }
}
