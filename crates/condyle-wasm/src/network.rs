//! The components of a joint set as a graph, with what flows through it.

use crate::answer::{Answer, Fault, sentence};
use crate::stage::Stage;
use condyle::Signal;
use serde_json::{Value, json};

impl Stage {
    /// `{"set": number}` to the components of a joint set: what each reads at which port, and which segments
    /// the set moves by which.
    pub(crate) fn network(&self, question: &Value) -> Result<Answer, Fault> {
        let model = &self.model;
        let wanted = question["set"].as_u64().unwrap_or(u64::MAX) as usize;
        let Some(set) = model.joint_set_ids().find(|set| set.index() == wanted) else {
            return Err(sentence(format!("there is no joint set {wanted}")));
        };
        let source = |signal: Signal| match signal {
            Signal::Coordinate(id) => json!({ "coordinate": id.index() }),
            Signal::Output(id, output) => json!({ "component": id.index(), "output": output }),
            Signal::Segment(id) => json!({ "segment": id.index() }),
        };
        let components: Vec<Value> = model
            .components_of(set)
            .map(|id| {
                let component = &model.components()[id.index()];
                let inputs: Vec<Value> = component
                    .ports()
                    .map(|(port, signal)| json!({ "port": port.name, "from": source(signal) }))
                    .collect();
                json!({
                    "id": id.index(),
                    "name": component.name,
                    "kind": component.law.kind().name,
                    "inputs": inputs,
                })
            })
            .collect();
        let outputs: Vec<Value> = model
            .outputs_of(set)
            .map(|(segment, signal)| json!({ "segment": segment.index(), "from": source(signal) }))
            .collect();
        let names: Vec<&str> = model.components().iter().map(|c| &c.name[..]).collect();
        Ok(Answer::of(&json!({ "components": components, "outputs": outputs, "names": names })))
    }

    /// `{"actor": 0, "set": number}` to the numbers that each component of the joint set gives now.
    pub(crate) fn live(&self, question: &Value) -> Result<Answer, Fault> {
        let actor = question["actor"].as_u64().unwrap_or(0) as usize;
        let wanted = question["set"].as_u64().unwrap_or(u64::MAX) as usize;
        let Some(actor) = self.actors.get(actor) else {
            return Err(sentence(format!("there is no pose {actor}")));
        };
        let model = &self.model;
        let own = model
            .component_ids()
            .filter(|id| model.components()[id.index()].joint_set.index() == wanted);
        let values: serde_json::Map<String, Value> = own
            .map(|id| {
                let numbers: Vec<f64> = self.program.outputs(&actor.pose, id).collect();
                (id.index().to_string(), json!(numbers))
            })
            .collect();
        Ok(Answer::of(&Value::Object(values)))
    }
}
