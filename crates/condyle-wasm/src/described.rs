//! A model in words and numbers: what the page makes its controls from.

use crate::answer::Answer;
use crate::stage::Stage;
use condyle::model::UpAxis;
use condyle::render::palette;
use serde_json::{Value, json};

impl Stage {
    /// Segments, joint sets with their coordinates, markers and colours.
    pub(crate) fn described(&self) -> Answer {
        let model = &self.model;
        let keys = model.coordinate_keys();
        let index = |id: Option<condyle::SegmentId>| id.map(condyle::SegmentId::index);
        let segments: Vec<Value> = model
            .segments()
            .iter()
            .map(|segment| {
                json!({
                    "name": segment.name,
                    "parent": index(segment.parent),
                    "set": segment.joint_set.map(|set| set.index()),
                    "joint": segment.joint_in_segment.translation.to_array(),
                })
            })
            .collect();
        let coordinates: Vec<Value> = model
            .coordinate_ids()
            .map(|id| {
                let coordinate = model.coordinate(id);
                let range = coordinate.range;
                let stored = model.stored_range(id);
                json!({
                    "key": keys[id.index()],
                    "name": coordinate.name,
                    "set": coordinate.joint_set.index(),
                    "kind": coordinate.kind.name(),
                    "place": stored.start,
                    "lower": range.lower,
                    "upper": range.upper,
                    "enforced": range.enforced,
                    "typical": coordinate.typical,
                    "default": coordinate.default[..stored.len()],
                    "follows": coordinate.follows.is_some(),
                    "locked": coordinate.locked,
                    "drives": coordinate.drives,
                    "source": coordinate.source,
                    "moves": self.first_moved(id),
                })
            })
            .collect();
        let markers: Vec<Value> = model
            .markers()
            .iter()
            .map(|marker| {
                json!({
                    "name": marker.name,
                    "segment": index(marker.segment),
                    "point": marker.point.to_array(),
                })
            })
            .collect();
        let sets: Vec<&str> = model.joint_sets().iter().map(|set| &set.name[..]).collect();
        let colours: serde_json::Map<String, Value> = palette::ALL
            .iter()
            .map(|(name, [r, g, b])| ((*name).to_owned(), json!(format!("#{r:02x}{g:02x}{b:02x}"))))
            .collect();
        Answer::of(&json!({
            "name": model.name(),
            "up": match model.up() { UpAxis::Y => "y", UpAxis::Z => "z" },
            "ahead": model.facing().direction().to_array(),
            "stored": model.stored_len(),
            "segments": segments,
            "sets": sets,
            "coordinates": coordinates,
            "markers": markers,
            "closures": model.closures().len(),
            "colours": colours,
        }))
    }

    /// The first segment from the root that a coordinate moves, whatever its joint set.
    fn first_moved(&self, id: condyle::CoordinateId) -> Option<usize> {
        let directions = self.model.tangent_range(id);
        let moves = |segment: &condyle::SegmentId| {
            let own = self.program.segment_directions(*segment);
            own.iter().any(|(direction, _)| directions.contains(&(*direction as usize)))
        };
        self.model.parents_first().into_iter().find(moves).map(|segment| segment.index())
    }
}
