//! What stands beside the bones, as `condyle render` draws it.

use crate::answer::Answer;
use crate::stage::Stage;
use condyle::picture::{self, Focus, Show};
use condyle::{Error, render};
use serde_json::{Value, json};

impl Stage {
    /// `{"actor": 0, "show": ["limits", …], "at": ["shoulder_r"], "unit": metres}` to surfaces, lines and
    /// labels of that pose.
    pub(crate) fn signs(&self, question: &Value) -> Result<Answer, Error> {
        let words = |key: &str| question[key].as_array().map_or(&[][..], |list| list);
        let actor = question["actor"].as_u64().unwrap_or(0) as usize;
        let unit = question["unit"].as_f64().filter(|unit| *unit > 0.0).unwrap_or(0.05);
        let show = words("show").iter().filter_map(Value::as_str);
        let show: Vec<Show> = show.map(Show::named).collect::<Result<_, _>>()?;
        let names = words("at").iter().filter_map(Value::as_str).map(str::to_owned);
        let focus = Focus { names: names.collect(), zoom: None, highlight: false };
        let stored = match self.actors.get(actor) {
            Some(actor) => &actor.effective,
            None => return Err(Error::new("page/actor", format!("there is no pose {actor}"))),
        };
        let figure = (&self.model, &self.program, &self.figure, &self.reaches);
        let scene = picture::signs(figure, stored, &show, &focus, unit)?;
        Ok(numbers(&scene))
    }
}

/// A scene as the page draws it.
fn numbers(scene: &render::Scene) -> Answer {
    let mut answer = Answer::default();
    let colour = |[r, g, b]: [u8; 3]| u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b);
    let mut surfaces = vec![];
    for surface in &scene.surfaces {
        surfaces.push(json!({
            "positions": answer.floats(surface.positions.iter().flatten().copied()),
            "normals": answer.floats(surface.normals.iter().flatten().copied()),
            "triangles": answer.corners(surface.triangles.iter().flatten().copied()),
            "colour": colour(surface.colour),
            "opacity": surface.opacity,
        }));
    }
    let mut lines = vec![];
    for line in &scene.lines {
        lines.push(json!({
            "points": answer.floats(line.points.iter().flatten().copied()),
            "width": line.width,
            "colour": colour(line.colour),
            "opacity": line.opacity,
            "through": line.through,
        }));
    }
    let labels = scene.labels.iter();
    let labels: Vec<Value> = labels
        .map(|label| json!({ "at": label.at, "text": label.text, "colour": colour(label.colour) }))
        .collect();
    answer.text = json!({ "surfaces": surfaces, "lines": lines, "labels": labels }).to_string();
    answer
}
