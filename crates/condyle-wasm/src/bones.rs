//! The surfaces of bones, once: the page moves them by the matrices of segments.

use crate::answer::Answer;
use crate::stage::Stage;
use condyle::Part;
use condyle::geometry::Skin;
use condyle::mesh::Finish;
use condyle::render::palette;
use serde_json::{Value, json};

impl Stage {
    /// The parts of the model's own figure, as [`surfaces`] has them.
    pub(crate) fn bones(&self) -> Answer {
        surfaces(&self.figure.parts)
    }
}

/// All parts in one surface at the defaults: corners with normals, colours, the two segments that carry
/// each and the share of the second, and triangles; for each part where its own are.
#[must_use]
pub fn surfaces(parts: &[Part]) -> Answer {
    let mut answer = Answer::default();
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

/// All skins in one surface as they were modelled: corners with normals and colours, what carries each of them and how much
/// each of the four counts, triangles; what carries, each with its segment and the transform from the surface to it, column by
/// column.
#[must_use]
pub fn skins(skins: &[Skin]) -> Answer {
    let mut answer = Answer::default();
    let positions = skins.iter().flat_map(|skin| &skin.mesh.positions);
    let positions = answer.floats(positions.flat_map(|p| p.to_array()));
    let normals = skins.iter().flat_map(|skin| &skin.mesh.normals);
    let normals = answer.floats(normals.flat_map(|n| n.to_array()));
    let colours = answer.floats(skins.iter().flat_map(|skin| {
        let own = skin.colour.unwrap_or(palette::SKIN).map(|channel| f64::from(channel) / 255.0);
        skin.mesh.positions.iter().flat_map(move |_| own)
    }));
    let weights = skins.iter().flat_map(|skin| skin.weights.iter().flatten());
    let weights = answer.floats(weights.map(|weight| f64::from(*weight)));
    let mut before = 0;
    let carriers: Vec<u32> = skins
        .iter()
        .flat_map(|skin| {
            let first = before;
            before += skin.holds.len() as u32;
            skin.carriers.iter().flatten().map(move |carrier| first + u32::from(*carrier))
        })
        .collect();
    let carriers = answer.corners(carriers);
    let mut before = 0;
    let triangles: Vec<u32> = skins
        .iter()
        .flat_map(|skin| {
            let first = before;
            before += skin.mesh.positions.len() as u32;
            skin.mesh.triangles.iter().flatten().map(move |corner| first + corner)
        })
        .collect();
    let triangles = answer.corners(triangles);
    let holds: Vec<Value> = skins
        .iter()
        .flat_map(|skin| &skin.holds)
        .map(|hold| {
            let m = hold.bind;
            let columns = [(m.linear.x, 0), (m.linear.y, 0), (m.linear.z, 0), (m.translation, 1)];
            let bind: Vec<f64> = columns
                .into_iter()
                .flat_map(|(column, last)| column.to_array().into_iter().chain([f64::from(last)]))
                .collect();
            json!({ "segment": hold.segment.map(|id| id.index()), "bind": bind })
        })
        .collect();
    answer.text = json!({
        "positions": positions,
        "normals": normals,
        "colours": colours,
        "weights": weights,
        "carriers": carriers,
        "triangles": triangles,
        "holds": holds,
    })
    .to_string();
    answer
}
