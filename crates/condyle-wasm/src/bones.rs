//! The surfaces of bones, once: the page moves them by the matrices of segments.

use crate::answer::Answer;
use crate::stage::Stage;
use condyle::mesh::Finish;
use condyle::render::palette;
use serde_json::{Value, json};

impl Stage {
    /// All parts in one surface at the defaults: corners with normals, colours, the two segments that carry
    /// each and the share of the second, and triangles; for each part where its own are.
    pub(crate) fn bones(&self) -> Answer {
        let mut answer = Answer::default();
        let parts = &self.figure.parts;
        let colour = |finish: Finish| match finish {
            Finish::Bone => palette::BONE,
            Finish::Cartilage => palette::CARTILAGE,
            Finish::Joint => palette::JOINT,
            Finish::Accent => palette::ACCENT,
            Finish::Marker => palette::MARKER,
        };
        let positions = parts.iter().flat_map(|part| &part.mesh.positions);
        let positions = answer.floats(positions.flat_map(|p| p.to_array()));
        let normals = parts.iter().flat_map(|part| &part.mesh.normals);
        let normals = answer.floats(normals.flat_map(|n| n.to_array()));
        let colours = answer.floats(parts.iter().flat_map(|part| {
            let own = colour(part.finish).map(f64::from);
            part.mesh.positions.iter().flat_map(move |_| own.map(|channel| channel / 255.0))
        }));
        let carriers = answer.floats(parts.iter().flat_map(|part| {
            let own = part.segments.map(|id| id.index() as f64);
            part.mesh.positions.iter().enumerate().flat_map(move |(corner, _)| {
                [own[0], own[1], part.weights.get(corner).copied().unwrap_or(0.0)]
            })
        }));
        let mut first = 0;
        let triangles = parts.iter().flat_map(|part| {
            let before = first;
            first += part.mesh.positions.len() as u32;
            part.mesh.triangles.iter().flatten().map(move |corner| before + corner)
        });
        let triangles: Vec<u32> = triangles.collect();
        let triangles = answer.corners(triangles);
        let (mut corner, mut triangle) = (0, 0);
        let list: Vec<Value> = parts
            .iter()
            .map(|part| {
                let start = [corner, triangle];
                corner += part.mesh.positions.len();
                triangle += part.mesh.triangles.len();
                json!({
                    "name": part.name,
                    "segments": part.segments.map(|id| id.index()),
                    "corners": [start[0], corner],
                    "triangles": [start[1], triangle],
                })
            })
            .collect();
        answer.text = json!({
            "positions": positions,
            "normals": normals,
            "colours": colours,
            "carriers": carriers,
            "triangles": triangles,
            "parts": list,
        })
        .to_string();
        answer
    }
}
