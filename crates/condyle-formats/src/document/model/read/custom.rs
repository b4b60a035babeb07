//! Components whose law is registered by the program that reads the document.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::tree::Value;
use condyle_diagnostics::did_you_mean;
use condyle_model::Law;
use condyle_model::component::Parameters;

impl ModelReader<'_> {
    pub(super) fn custom(&mut self, fields: &Fields<'_>) -> Option<Law> {
        let parameters = self.parameters(fields);
        let node = self.required(fields, "law", "the name of a registered law")?;
        let law = self.text(node, "law")?;
        let Some(wanted) = self.laws.inputs(&law.text) else {
            // The registry's message lists its laws.
            let refused = self.laws.make(&law.text, Parameters::new());
            let message = refused.err().unwrap_or_else(|| format!("unknown law `{}`", law.text));
            let otherwise = || "register it in the program that reads this document".to_owned();
            let help = did_you_mean(&law.text, self.laws.names(), otherwise);
            self.texts.error(law.spot, "model/law", message, help);
            return None;
        };
        let wanted = wanted.join(", ");
        let takes = self.laws.inputs(&law.text).map_or(0, <[String]>::len);
        let given = fields.get("inputs").map(|node| match &node.value {
            Value::List(list) => (node.spot, list.len()),
            _ => (node.spot, 1),
        });
        let mut sound = true;
        if let Some((spot, given)) = given
            && given != takes
        {
            let inputs = if takes == 1 { "input" } else { "inputs" };
            let message = format!("law `{}` takes {takes} {inputs}, not {given}", law.text);
            let help = format!("connect, in this order: {wanted}");
            self.texts.error(spot, "model/arity", message, help);
            sound = false;
        }
        match self.laws.make(&law.text, parameters?) {
            Ok(custom) => Some(Law::Custom(custom)).filter(|_| sound),
            Err(why) => {
                let spot = fields.get("parameters").map_or(fields.spot, |node| node.spot);
                let message = format!("law `{}` does not accept its parameters: {why}", law.text);
                let help =
                    "give `parameters` as numbers or lists of numbers, in metres and radians";
                self.texts.error(spot, "model/law", message, help);
                None
            }
        }
    }

    /// Numbers and lists of numbers by name, without conversion of units.
    fn parameters(&mut self, fields: &Fields<'_>) -> Option<Parameters> {
        let Some(node) = fields.get("parameters") else { return Some(Parameters::new()) };
        if !matches!(node.value, Value::Table(_)) {
            self.wrong(node, "parameters", "a table such as { lift = 0.02 }");
            return None;
        }
        let mut all = Some(Parameters::new());
        for entry in self.entries(node, "parameters") {
            let (key, node) = (&entry.key.text, &entry.node);
            let numbers = match &node.value {
                Value::List(_) => self.numbers(node, key),
                _ => self.number(node, key).map(|number| vec![number]),
            };
            match (numbers, &mut all) {
                (Some(numbers), Some(all)) => _ = all.insert(key.clone(), numbers),
                _ => all = None,
            }
        }
        all
    }
}
