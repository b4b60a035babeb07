//! What stands beside the bones, as `condyle render` draws it.

use crate::answer::Answer;
use crate::stage::Stage;
use condyle::picture::{self, Focus, Show};
use condyle::render::palette;
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

    /// `{"set": 3, "frames": [[…], …]}` to what limits the rotations of a joint set in the space of quaternions, with
    /// the path of a motion; `{"set": 3, "actor": 0}` to the rotation that is asked for there. Of a set without such a
    /// limit the title is null.
    pub(crate) fn rotations(&self, question: &Value) -> Result<Answer, Error> {
        let set = question["set"].as_u64().unwrap_or(u64::MAX);
        let mut ids = self.model.joint_set_ids();
        let none = || with_points(&render::Scene::default(), &[], Value::Null);
        let Some(set) = ids.find(|id| id.index() as u64 == set) else { return Ok(none()) };
        let figure = (&self.model, &self.program, &self.figure, &self.reaches);
        if let Some(actor) = question["actor"].as_u64() {
            let Some(actor) = self.actors.get(actor as usize) else { return Ok(none()) };
            let now = picture::rotation(figure, &actor.asked, set)?;
            return Ok(now.map_or_else(none, |scene| numbers(&scene)));
        }
        let row = |row: &Value| Some(row.as_array()?.iter().filter_map(Value::as_f64).collect());
        let frames: Vec<Vec<f64>> =
            question["frames"].as_array().into_iter().flatten().filter_map(row).collect();
        let found = picture::rotations(figure, &self.model.defaults(), set, &frames)?;
        Ok(found.map_or_else(none, |found| {
            let clouds = [
                (&found.samples[..], palette::LEADER, 2.0),
                (&found.surface[..], palette::AXIS_Z, 5.0),
            ];
            with_points(&found.scene, &clouds, Value::from(found.title))
        }))
    }
}

/// A scene as the page draws it.
fn numbers(scene: &render::Scene) -> Answer {
    with_points(scene, &[], Value::Null)
}

/// The same with points, each kind with its colour and size in pixels, and a title.
fn with_points(
    scene: &render::Scene,
    points: &[(&[condyle::math::Vec3], [u8; 3], f64)],
    title: Value,
) -> Answer {
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
    let mut clouds = vec![];
    for (places, of, size) in points {
        let places = answer.floats(places.iter().flat_map(|p| p.to_array()));
        clouds.push(json!({ "points": places, "colour": colour(*of), "size": size }));
    }
    answer.text = json!({
        "surfaces": surfaces,
        "lines": lines,
        "labels": labels,
        "clouds": clouds,
        "title": title,
    })
    .to_string();
    answer
}
