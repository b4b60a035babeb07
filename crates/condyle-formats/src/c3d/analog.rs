//! Analog channels: force platforms, muscles, switches.

use super::layout::Layout;
use super::parameters::Parameters;
use crate::text::distinct;
use condyle_diagnostics::{Diagnostic, Warnings};
use condyle_motion::Table;

/// One analog channel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Channel {
    /// Its name; no two channels have the same.
    pub label: String,
    /// The unit of its values, as it is written; may be blank.
    pub unit: String,
    /// What a step of the stored numbers is worth, before [`Analog::scale`].
    pub scale: f64,
    /// The stored number that means zero.
    pub offset: f64,
}

/// All analog channels with their samples as they are stored.
#[derive(Debug, Clone, Default)]
pub struct Analog {
    /// The channels.
    pub channels: Vec<Channel>,
    /// Samples per second.
    pub rate: f64,
    /// Samples in each frame of the recording.
    pub per_frame: usize,
    /// The scale of all channels, `ANALOG:GEN_SCALE`.
    pub scale: f64,
    /// The numbers that are stored, sample by sample, one for each channel.
    pub stored: Vec<f32>,
}

/// Stored numbers are compared by their bits, so that what is not a number equals itself.
impl PartialEq for Analog {
    fn eq(&self, other: &Self) -> bool {
        let bits = |analog: &Self| analog.stored.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        self.channels == other.channels
            && self.rate == other.rate
            && self.per_frame == other.per_frame
            && self.scale == other.scale
            && bits(self) == bits(other)
    }
}

impl Analog {
    /// How many samples each channel has.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.stored.len().checked_div(self.channels.len()).unwrap_or(0)
    }

    /// A sample of a channel in its unit: (stored - offset) · scale of the channel · scale of all.
    #[must_use]
    pub fn value(&self, sample: usize, channel: usize) -> Option<f64> {
        let known = self.channels.get(channel)?;
        let at = sample.checked_mul(self.channels.len())?.checked_add(channel)?;
        let stored = f64::from(*self.stored.get(at)?);
        Some((stored - known.offset) * known.scale * self.scale)
    }

    /// All samples of a channel in its unit; none if there is no such channel.
    #[must_use]
    pub fn values(&self, channel: usize) -> Vec<f64> {
        let Some(known) = self.channels.get(channel) else { return vec![] };
        let stored = self.stored.iter().skip(channel).step_by(self.channels.len());
        stored.map(|&v| (f64::from(v) - known.offset) * known.scale * self.scale).collect()
    }

    /// All samples of all channels in their units, in the order of [`stored`](Self::stored), put behind what is in a
    /// vector of the caller: one that is used again needs no new memory.
    ///
    /// ```
    /// use condyle_formats::c3d::{Analog, Channel};
    /// let channel = |scale, offset| Channel { scale, offset, ..Channel::default() };
    /// let analog = Analog {
    ///     channels: vec![channel(0.5, 0.0), channel(2.0, 100.0)],
    ///     scale: 10.0,
    ///     stored: vec![1.0, 101.0, 2.0, 90.0],
    ///     ..Analog::default()
    /// };
    /// let mut values = vec![];
    /// analog.scaled_to(&mut values);
    /// assert_eq!(values, [5.0, 20.0, 10.0, -200.0]);
    /// ```
    pub fn scaled_to(&self, values: &mut Vec<f64>) {
        let width = self.channels.len();
        if width == 0 {
            return;
        }
        // Short rows are laid end to end, so that the loop over one is long enough for whole registers.
        let rows = 64usize.div_ceil(width);
        let laid = |part: fn(&Channel) -> f64| -> Vec<f64> {
            let of_one = self.channels.iter().map(part);
            of_one.cycle().take(rows * width).collect()
        };
        let (offsets, scales) = (laid(|channel| channel.offset), laid(|channel| channel.scale));
        let whole = self.stored.len() - self.stored.len() % width;
        values.reserve(whole);
        for block in self.stored.get(..whole).unwrap_or_default().chunks(rows * width) {
            let steps = offsets.iter().zip(&scales);
            let scaled = block.iter().zip(steps);
            values.extend(
                scaled.map(|(&v, (offset, scale))| (f64::from(v) - offset) * scale * self.scale),
            );
        }
    }

    /// All channels over time, in their units, the first sample at `start` seconds.
    #[must_use]
    pub fn to_table(&self, start: f64) -> Table {
        let mut values = vec![];
        self.scaled_to(&mut values);
        let rate = if self.rate > 0.0 { self.rate } else { 1.0 };
        Table {
            columns: self.channels.iter().map(|c| c.label.clone()).collect(),
            times: (0..self.samples()).map(|sample| start + sample as f64 / rate).collect(),
            values,
            ..Table::default()
        }
    }
}

/// Whether stored whole numbers have no sign.
pub(super) fn unsigned(parameters: &Parameters) -> bool {
    parameters.text("ANALOG", "FORMAT").eq_ignore_ascii_case("UNSIGNED")
}

/// The channels without their samples.
pub(super) fn channels(
    parameters: &Parameters,
    layout: Layout,
    per_frame: usize,
    rate: f64,
    warnings: &mut Warnings,
) -> Analog {
    let count = match layout.analog % per_frame {
        0 => layout.analog / per_frame,
        _ => layout.analog,
    };
    let per_frame = layout.analog.checked_div(count).unwrap_or(per_frame);
    if count == 0 {
        return Analog {
            per_frame,
            rate: rate * per_frame as f64,
            scale: 1.0,
            ..Analog::default()
        };
    }
    let labels = parameters.texts("ANALOG", "LABELS");
    let name = |index: usize| match labels.get(index).map(String::as_str) {
        None | Some("") => "unnamed",
        Some(label) => label,
    };
    let unnamed = (0..count).filter(|&index| name(index) == "unnamed").count();
    if unnamed > 0 {
        let message = format!("{unnamed} of {count} analog channels have no name");
        let said = Diagnostic::warning("c3d/unnamed", message);
        warnings.push(said.with_help("they are called `unnamed`"));
    }
    let names = distinct((0..count).map(name), |index, other| {
        if name(index) == "unnamed" {
            return;
        }
        warnings.add("c3d/duplicate-channel", || {
            let message = format!("two analog channels are called `{}`", name(index));
            let said = Diagnostic::warning("c3d/duplicate-channel", message);
            said.with_help(format!("the later one is read as `{other}`"))
        });
    });
    let units = parameters.texts("ANALOG", "UNITS");
    let scales = parameters.numbers("ANALOG", "SCALE");
    let offsets = parameters.numbers("ANALOG", "OFFSET");
    let unsigned = unsigned(parameters);
    let mut unscaled = 0;
    let channels = names.into_iter().enumerate().map(|(index, label)| {
        let scale = scales.get(index).copied().filter(|s| s.is_finite()).unwrap_or_else(|| {
            unscaled += 1;
            1.0
        });
        let offset = offsets.get(index).copied().filter(|o| o.is_finite()).unwrap_or(0.0);
        // No float of a channel is near -32768: the word of 16 bits has no sign.
        let wrapped = unsigned && offset < 0.0 || layout.real && offset == -32768.0;
        let offset = if wrapped { offset + 65536.0 } else { offset };
        Channel { label, unit: units.get(index).cloned().unwrap_or_default(), scale, offset }
    });
    let channels: Vec<Channel> = channels.collect();
    if unscaled > 0 {
        let message = format!("{unscaled} of {count} analog channels have no scale");
        warnings.push(Diagnostic::warning("c3d/analog-scale", message).with_help("taken as 1"));
    }
    let stated = parameters.number("ANALOG", "GEN_SCALE");
    let scale = stated.filter(|s| s.is_finite() && *s != 0.0).unwrap_or_else(|| {
        let message = "ANALOG:GEN_SCALE is missing or zero";
        warnings.push(Diagnostic::warning("c3d/analog-scale", message).with_help("taken as 1"));
        1.0
    });
    Analog { channels, rate: rate * per_frame as f64, per_frame, scale, stored: vec![] }
}
