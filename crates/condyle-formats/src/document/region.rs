//! Where a law was learned: `{ low, high, centre, inverse, distance }`, in radians and metres.

use super::fields::{Fields, Reader};
use super::model::{number, numbers};
use super::tree::Node;
use condyle_model::component::Region;

/// The keys of a region.
const REGION: &[&str] = &["low", "high", "centre", "inverse", "distance"];

impl Reader<'_> {
    /// A region of so many controls.
    pub(super) fn region(&mut self, node: &Node, label: &str, controls: usize) -> Option<Region> {
        let fields = self.table(node, node.spot, label.to_owned(), REGION);
        let [low, high, centre] =
            ["low", "high", "centre"].map(|key| self.for_each(&fields, key, controls));
        let inverse = self.required(&fields, "inverse", "the inverse covariance, row by row");
        let inverse = inverse.and_then(|node| {
            let rows = self.list(node, "inverse")?;
            let rows: Vec<Option<Vec<f64>>> =
                rows.iter().map(|row| self.numbers(row, "inverse")).collect();
            let rows: Vec<Vec<f64>> = rows.into_iter().collect::<Option<_>>()?;
            if rows.len() != controls || rows.iter().any(|row| row.len() != controls) {
                let message = format!("`inverse` is no matrix of {controls} rows and columns");
                self.length(node.spot, message, "give a list of rows");
                return None;
            }
            Some(rows.concat())
        });
        let distance = self.required(&fields, "distance", "the greatest distance of a frame");
        let distance = distance.and_then(|node| self.number(node, "distance"));
        let region = Region {
            low: low?,
            high: high?,
            centre: centre?,
            inverse: inverse?,
            distance: distance?,
        };
        if !region.is_of(controls) {
            let message = format!("`{label}` is no region");
            let help = "give finite numbers, `low` not above `high`, and a `distance` from 0";
            self.texts.error(node.spot, "document/region", message, help);
            return None;
        }
        Some(region)
    }

    /// A number for each of so many controls.
    fn for_each(&mut self, fields: &Fields<'_>, key: &str, controls: usize) -> Option<Vec<f64>> {
        let node = self.required(fields, key, "a number for each input")?;
        let list = self.numbers(node, key)?;
        if list.len() != controls {
            let message = format!("`{key}` has {} numbers", list.len());
            self.length(node.spot, message, format!("give {controls}, one for each input"));
            return None;
        }
        Some(list)
    }
}

/// The lines of a region.
pub(super) fn region_lines(region: &Region) -> Vec<String> {
    let count = region.centre.len().max(1);
    let rows: Vec<String> = region.inverse.chunks(count).map(numbers).collect();
    vec![
        format!("low = {}", numbers(&region.low)),
        format!("high = {}", numbers(&region.high)),
        format!("centre = {}", numbers(&region.centre)),
        format!("inverse = [{}]", rows.join(", ")),
        format!("distance = {}", number(region.distance)),
    ]
}
