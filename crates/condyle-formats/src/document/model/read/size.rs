//! Size groups: segments that are scaled by one factor.

use super::ModelReader;
use crate::document::model::draft::{Draft, SizeDraft};
use crate::document::model::keys;
use crate::document::model::mirror::Mirror;
use crate::document::texts::Name;
use crate::document::tree::Entry;
use std::collections::HashSet;

impl ModelReader<'_> {
    pub(super) fn size(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let label = format!("size.{}", name.text);
        let fields = self.table(&entry.node, name.spot, label, keys::SIZE);
        let node = self.required(&fields, "segments", "the segments of the group");
        let segments = node.map(|node| self.names(node, "segments").0).unwrap_or_default();
        draft.sizes.push(SizeDraft { name, segments });
    }
}

/// Adds the mirrored segment of each listed one, unless it is listed in any group.
///
/// Groups keep their names: one factor scales both sides.
pub(super) fn both_sides(mirror: &Mirror, draft: &mut Draft) {
    let all = draft.sizes.iter().flat_map(|size| &size.segments);
    let listed: HashSet<String> = all.map(|name| name.text.clone()).collect();
    let there: HashSet<&str> = draft.segments.iter().map(|s| s.name.text.as_str()).collect();
    for size in &mut draft.sizes {
        let other = |name: &Name| {
            let text = format!("{}{}", name.text.strip_suffix(&mirror.from)?, mirror.to);
            (there.contains(text.as_str()) && !listed.contains(&text))
                .then_some(Name { text, spot: name.spot })
        };
        let others: Vec<Name> = size.segments.iter().filter_map(other).collect();
        size.segments.extend(others);
    }
}
