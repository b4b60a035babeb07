//! The first block of a file: counts, rate, where the data are, and a few events.

use super::bytes::Source;
use super::event::{Event, Origin};
use super::parameters::text;

/// The number that says that labels of events have four letters.
pub(super) const FOUR_LETTERS: u16 = 12345;

/// How many events a header has room for.
pub(super) const MOST_EVENTS: usize = 18;

/// What the first 512 bytes say; none of it is trusted.
#[derive(Debug, Clone)]
pub(super) struct Header {
    pub(super) points: usize,
    /// Analog numbers in each frame, of all channels.
    pub(super) analog: usize,
    pub(super) first: usize,
    pub(super) last: usize,
    /// The longest gap that was filled.
    pub(super) gap: u16,
    pub(super) scale: f32,
    /// The byte at which the data start.
    pub(super) data: usize,
    /// Analog samples in each frame.
    pub(super) samples: usize,
    pub(super) rate: f32,
    pub(super) events: Vec<Event>,
}

/// The start of a block that is counted from 1; 0 is none.
pub(super) fn block(number: usize) -> usize {
    number.saturating_sub(1) * 512
}

impl Header {
    /// `None` if there are less than 24 bytes.
    pub(super) fn read(source: &Source<'_>) -> Option<Self> {
        let word = |number: usize| source.u16(2 * (number - 1)).map(usize::from);
        Some(Self {
            points: word(2)?,
            analog: word(3)?,
            first: word(4)?,
            last: word(5)?,
            gap: source.u16(10)?,
            scale: source.f32(12)?,
            data: block(word(9)?),
            samples: word(10)?,
            rate: source.f32(20)?,
            events: events(source).unwrap_or_default(),
        })
    }

    /// Its frames by the numbers of the first and the last.
    pub(super) fn frames(&self) -> usize {
        (self.last + 1).saturating_sub(self.first)
    }
}

/// The events of the header: words 150 to 234.
fn events(source: &Source<'_>) -> Option<Vec<Event>> {
    if source.u16(2 * 149)? != FOUR_LETTERS {
        return None;
    }
    let count = usize::from(source.u16(2 * 150)?).min(MOST_EVENTS);
    let event = |index: usize| {
        let label = text(source.bytes.get(396 + 4 * index..400 + 4 * index)?);
        let time = f64::from(source.f32(304 + 4 * index)?);
        let shown = source.u8(376 + index)? == 0;
        let event = Event { label, time, shown, origin: Origin::Header, ..Event::default() };
        (time.is_finite()).then_some(event)
    };
    Some((0..count).filter_map(event).collect())
}
