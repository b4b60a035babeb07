//! What happened when: heel strikes, lift-offs, and whatever else somebody marked.

use super::parameters::Parameters;

/// Where an event is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Origin {
    /// In the group `EVENT`.
    #[default]
    Group,
    /// In the header, which has room for 18 with four letters each.
    Header,
}

/// An event.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Event {
    /// What happened: `Foot Strike`.
    pub label: String,
    /// On which side, or of what kind: `Left`; may be blank.
    pub context: String,
    /// Whose; may be blank.
    pub subject: String,
    /// Seconds, on the clock of the recording's times.
    pub time: f64,
    /// Whether programs should show it; always true of those of the group.
    pub shown: bool,
    /// Where it is written.
    pub origin: Origin,
}

/// The events of the group `EVENT`, whose times are minutes and seconds.
pub(super) fn of_group(parameters: &Parameters) -> Vec<Event> {
    let all = |name: &str| parameters.texts("EVENT", name);
    let (labels, contexts, subjects) = (all("LABELS"), all("CONTEXTS"), all("SUBJECTS"));
    let times = parameters.numbers("EVENT", "TIMES");
    let used = parameters.count("EVENT", "USED").unwrap_or(times.len() / 2);
    let at = |texts: &[String], index: usize| texts.get(index).cloned().unwrap_or_default();
    let pairs = times.as_chunks::<2>().0.iter().take(used).enumerate();
    let events = pairs.map(|(index, [minutes, seconds])| Event {
        label: at(&labels, index),
        context: at(&contexts, index),
        subject: at(&subjects, index),
        time: 60.0 * minutes + seconds,
        shown: true,
        origin: Origin::Group,
    });
    events.filter(|event| event.time.is_finite()).collect()
}
