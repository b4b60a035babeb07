//! Poses and motions as files.

use crate::answer::{Answer, Fault, fault, said, sentence};
use crate::checked::motion;
use crate::stage::Stage;
use condyle::formats::{bvh, csv, glb, sto};
use condyle::{AngleUnit, Mode, Motion, Read, encode, scene};
use serde_json::{Value, json};

impl Stage {
    /// `{"format": "glb", "name": …, "times": […], "frames": [[…], …]}` to a file: its bytes are the answer's numbers.
    /// Without times it is the pose of the actor that is named.
    pub(crate) fn saved(&self, question: &Value) -> Result<Answer, Fault> {
        let name = question["name"].as_str().unwrap_or("pose");
        let motion = match question["times"].is_array() {
            true => motion(&self.model, question)?,
            false => self.still(question)?,
        };
        let mut table = motion.to_table(&self.model, name);
        let written = match question["format"].as_str().unwrap_or("") {
            "glb" => {
                let Read { value, warnings } = scene::baked(&self.model, &motion, Mode::Open, None);
                glb::write(&value).map(|value| Read { value, warnings })
            }
            "bvh" => {
                let ahead = encode::ahead(&self.model);
                let written = bvh::write(&ahead, &motion, Mode::Open, bvh::USUAL_UNIT);
                written.map(|read| read.map(String::into_bytes))
            }
            "mot" => sto::write(&table).map(|text| Read::clean(text.into_bytes())),
            "csv" => {
                // A table for programs: the units of the library.
                table.values = motion.frames.concat();
                table.angle_unit = AngleUnit::Radians;
                csv::write(&table).map(|text| Read::clean(text.into_bytes()))
            }
            other => return Err(sentence(format!("the page saves no `{other}`"))),
        };
        let Read { value, warnings } = written.map_err(|error| fault(&error))?;
        let warnings: Vec<Value> = warnings.iter().map(said).collect();
        Ok(Answer { text: json!({ "warnings": warnings }).to_string(), numbers: value })
    }

    fn still(&self, question: &Value) -> Result<Motion, Fault> {
        let actor = question["actor"].as_u64().unwrap_or(0) as usize;
        let actor = self.actors.get(actor).ok_or_else(|| sentence("there is no such pose"))?;
        Ok(Motion { times: vec![0.0], frames: vec![actor.effective.clone()] })
    }
}
