//! Findings about the texts of a document. What is wrong in a template is said once, not for each
//! of its instances.

use super::texts::{Context, Spot};
use condyle_diagnostics::Diagnostic;
use std::collections::{HashMap, HashSet};

/// How many instances of one template are named in findings about one of its places.
const MOST_INSTANCES: usize = 3;
/// How many places of templates are told apart.
const MOST_GROUPS: usize = 200;

/// Errors, or warnings.
pub(super) struct Findings {
    /// How many are kept; more than that have a common cause.
    most: usize,
    kept: Vec<(Spot, Diagnostic)>,
    surplus: usize,
    /// How many were said before.
    repeated: usize,
    groups: HashMap<Key, Group>,
    /// How many findings there are with a code at a spot of an instance.
    ordinals: HashMap<(Spot, &'static str), u32>,
}

/// A spot of a template, the code of a finding, and how many of that code the same instance has
/// there already.
type Key = (Spot, &'static str, u32);

/// Findings of the same kind in instances of one template.
struct Group {
    /// Their places among those kept.
    kept: Vec<usize>,
    count: usize,
    /// The instances of the template.
    of: usize,
    template: String,
}

impl Findings {
    pub(super) fn new(most: usize) -> Self {
        let (groups, ordinals) = (HashMap::new(), HashMap::new());
        Self { most, kept: vec![], surplus: 0, repeated: 0, groups, ordinals }
    }

    /// Adds what `say` says, if it is kept.
    pub(super) fn add(
        &mut self,
        spot: Spot,
        code: &'static str,
        context: Option<&Context>,
        say: impl FnOnce() -> Diagnostic,
    ) {
        let Some(Context::Instance { template, of, .. }) = context else {
            if self.kept.len() >= self.most {
                self.surplus += 1;
                return;
            }
            let said = say();
            // A value that a template uses in many places is wrong once.
            let again = |(other, known): &(Spot, Diagnostic)| {
                other.within(0) == spot.within(0) && *known == said
            };
            match self.kept.iter().any(again) {
                true => self.repeated += 1,
                false => self.kept.push((spot, said)),
            }
            return;
        };
        if self.groups.len() >= MOST_GROUPS {
            self.surplus += 1;
            return;
        }
        let ordinal = self.ordinals.entry((spot, code)).or_default();
        let key = (spot.within(0), code, *ordinal);
        *ordinal += 1;
        let group = self.groups.entry(key).or_insert_with(|| Group {
            kept: vec![],
            count: 0,
            of: *of,
            template: template.clone(),
        });
        group.count += 1;
        if group.kept.len() < MOST_INSTANCES && self.kept.len() < self.most {
            group.kept.push(self.kept.len());
            self.kept.push((spot, say()));
        }
    }

    /// How many were added.
    pub(super) fn count(&self) -> usize {
        let grouped = self.groups.values().map(|g| g.count - g.kept.len()).sum::<usize>();
        self.kept.len() + self.surplus + self.repeated + grouped
    }

    /// All that is kept, with what `beside` adds to the message at a spot, and the number of others.
    pub(super) fn finish(self, beside: impl Fn(Spot) -> String) -> (Vec<Diagnostic>, usize) {
        let mut surplus = self.surplus;
        let mut kept: Vec<Option<(Spot, Diagnostic)>> = self.kept.into_iter().map(Some).collect();
        for group in self.groups.values() {
            let skeletons = group.kept.iter().filter_map(|&i| kept[i].as_ref()).map(skeleton);
            let skeletons: HashSet<String> = skeletons.collect();
            let everywhere = group.count == group.of && group.of > 1 && skeletons.len() == 1;
            match (&group.kept[..], everywhere) {
                ([first, others @ ..], true) => {
                    others.iter().for_each(|&other| kept[other] = None);
                    if let Some((spot, said)) = &mut kept[*first] {
                        // What is said of all instances names none of them.
                        *spot = spot.within(0);
                        let all = format!(", in every instance of template `{}`", group.template);
                        said.message.push_str(&all);
                    }
                }
                (some, _) => surplus += group.count - some.len(),
            }
        }
        let said = |(spot, mut said): (Spot, Diagnostic)| {
            said.message.push_str(&beside(spot));
            said
        };
        (kept.into_iter().flatten().map(said).collect(), surplus)
    }
}

/// A message without what it quotes.
fn skeleton((_, said): &(Spot, Diagnostic)) -> String {
    let mut quoted = false;
    let outside = |c: &char| {
        quoted ^= matches!(c, '`' | '[' | ']');
        !quoted
    };
    said.message.chars().filter(outside).collect()
}
