//! How the data are laid out: header, parameters and the length of the file are asked, and none is trusted.

use super::bytes::Source;
use super::header::{Header, block};
use super::parameters::{Parameters, Values};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};

/// Where the frames are and what is in each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    /// The byte of the first frame.
    pub(super) data: usize,
    pub(super) points: usize,
    /// Analog numbers in each frame.
    pub(super) analog: usize,
    /// Whether numbers are floats of 32 bits, not whole numbers of 16.
    pub(super) real: bool,
    pub(super) frames: usize,
}

impl Layout {
    /// Bytes of a number.
    fn width(&self) -> usize {
        if self.real { 4 } else { 2 }
    }

    /// Bytes of the points of a frame.
    pub(super) fn point_bytes(&self) -> usize {
        4 * self.points * self.width()
    }

    /// Bytes of a frame.
    pub(super) fn frame_bytes(&self) -> usize {
        self.point_bytes() + self.analog * self.width()
    }
}

/// The number of frames as several places state it, the most reliable first.
fn stated(header: &Header, parameters: &Parameters) -> Vec<usize> {
    let mut all = vec![];
    if let (Some(first), Some(last)) =
        (field(parameters, "ACTUAL_START_FIELD"), field(parameters, "ACTUAL_END_FIELD"))
    {
        all.push((last + 1).saturating_sub(first));
    }
    all.extend(parameters.count("POINT", "LONG_FRAMES"));
    all.push(header.frames());
    all.extend(parameters.count("POINT", "FRAMES"));
    all.retain(|frames| *frames > 0);
    all
}

/// A number of a frame in the group `TRIAL`: two words, the lower first, or a float.
pub(super) fn field(parameters: &Parameters, name: &str) -> Option<usize> {
    let values = &parameters.get("TRIAL", name)?.values;
    match values {
        Values::Integers(words) => {
            let low = usize::from(*words.first()? as u16);
            Some(low | usize::from(words.get(1).map_or(0, |&high| high as u16)) << 16)
        }
        _ => values.number(0).filter(|v| (0.0..4e9).contains(v)).map(|v| v as usize),
    }
}

/// Each value once, in their order.
fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut all = vec![];
    for value in values {
        if !all.contains(&value) {
            all.push(value);
        }
    }
    all
}

/// The layout with which a stated number of frames fills the file but for less than a block; else the one that
/// is stated first, with the frames that are there.
pub(super) fn find(
    source: &Source<'_>,
    header: &Header,
    parameters: &Parameters,
    end_of_parameters: usize,
    warnings: &mut Warnings,
) -> Result<Layout, Error> {
    let length = source.bytes.len();
    let starts = distinct([
        header.data,
        block(parameters.count("POINT", "DATA_START").unwrap_or(0)),
        end_of_parameters.div_ceil(512) * 512,
    ]);
    let starts: Vec<usize> = starts.into_iter().filter(|&s| s >= 512 && s < length).collect();
    if starts.is_empty() {
        let message =
            format!("the data should start behind the end of the file, at {}", header.data);
        return Err(Error::new("c3d/truncated", message).at(Place::at_byte(length as u64)));
    }
    let points = distinct(parameters.count("POINT", "USED").into_iter().chain([header.points]));
    let per_frame = parameters
        .count("ANALOG", "USED")
        .map(|channels| channels.saturating_mul(samples(header, parameters)));
    let analog = distinct([Some(header.analog), per_frame].into_iter().flatten());
    let scale = scale(header, parameters);
    let stored = if scale < 0.0 { [true, false] } else { [false, true] };
    let counts = stated(header, parameters);

    let mut first = None;
    let mut fitting = None;
    'search: for &data in &starts {
        for real in stored {
            for (&points, &analog) in points.iter().flat_map(|p| analog.iter().map(move |a| (p, a)))
            {
                let layout = Layout { data, points, analog, real, frames: 0 };
                let bytes = layout.frame_bytes();
                if bytes == 0 {
                    continue;
                }
                let room = (length - data) / bytes;
                let rest = |frames: usize| (length - data) - frames * bytes;
                first.get_or_insert(Layout { frames: room, ..layout });
                let fits = |frames: &usize| *frames <= room && rest(*frames) < 512;
                if let Some(&frames) = counts.iter().find(|frames| fits(frames)) {
                    fitting = Some(Layout { frames, ..layout });
                    break 'search;
                }
            }
        }
    }
    let Some(first) = first else {
        let message = "there are neither points nor analog channels";
        return Err(Error::new("c3d/no-data", message).at(Place::at_byte(2)));
    };
    let layout = fitting.unwrap_or_else(|| unfitting(source, first, &counts, warnings));
    if layout.frames == 0 {
        let message = "the file ends before its first frame";
        let error = Error::new("c3d/truncated", message).at(Place::at_byte(layout.data as u64));
        return Err(error.with_help(format!(
            "a frame of {} points and {} analog numbers takes {} bytes",
            layout.points,
            layout.analog,
            layout.frame_bytes()
        )));
    }
    say_differences(layout, header, parameters, scale, warnings);
    Ok(layout)
}

/// The first layout with the frames that are there, or the largest number stated that leaves something behind.
fn unfitting(
    source: &Source<'_>,
    first: Layout,
    counts: &[usize],
    warnings: &mut Warnings,
) -> Layout {
    let room = first.frames;
    // Counts of 16 bits start anew at 65536, or stay at 65535; less than a block may follow the last frame.
    let anew = counts.iter().filter(|count| room >= 65536 && **count <= 65535).find_map(|count| {
        let surplus = (room - count) % 65536;
        (surplus * first.frame_bytes() < 512).then_some(room - surplus)
    });
    let most = counts.iter().copied().max().unwrap_or(0);
    let frames = match (anew, most) {
        (Some(frames), _) => Some(frames),
        (None, 0) => Some(without_padding(source, first)),
        (None, 65535) if room > 65535 => Some(without_padding(source, first)),
        _ => None,
    };
    if let Some(frames) = frames {
        let message =
            format!("the number of frames is taken from the length of the file: {frames}");
        warnings.push(Diagnostic::warning("c3d/frames", message));
        return Layout { frames, ..first };
    }
    if most > room {
        let message = format!("{most} frames are stated, but the file ends after {room}");
        let said = Diagnostic::warning("c3d/truncated", message);
        warnings.push(said.with_help("those that are there are read"));
        return first;
    }
    let message = format!("{most} frames are stated, and more bytes follow than those take");
    warnings.push(Diagnostic::warning("c3d/frames", message).with_help("the rest is not read"));
    Layout { frames: most, ..first }
}

/// The frames that are there without those that are only zeros in what fills the last block.
fn without_padding(source: &Source<'_>, layout: Layout) -> usize {
    let bytes = layout.frame_bytes();
    let most = 511 / bytes;
    let is_zero = |frame: usize| {
        let start = layout.data + frame * bytes;
        let frame = source.bytes.get(start..start + bytes);
        frame.is_some_and(|frame| frame.iter().all(|byte| *byte == 0))
    };
    let zeros = (0..layout.frames).rev().take(most).take_while(|frame| is_zero(*frame)).count();
    layout.frames - zeros
}

fn say_differences(
    layout: Layout,
    header: &Header,
    parameters: &Parameters,
    scale: f64,
    warnings: &mut Warnings,
) {
    let mut say = |what: &str, stated: Vec<(&str, Option<usize>)>, used: usize| {
        if stated.iter().any(|(_, value)| value.is_some_and(|value| value != used)) {
            let told: Vec<String> = stated
                .iter()
                .filter_map(|(place, value)| value.map(|value| format!("{value} by {place}")))
                .collect();
            let message = format!("{what}: {}", told.join(", "));
            let help = format!("{used} is used, which the length of the file fits best");
            warnings.push(Diagnostic::warning("c3d/counts", message).with_help(help));
        }
    };
    let by_trial = field(parameters, "ACTUAL_START_FIELD")
        .zip(field(parameters, "ACTUAL_END_FIELD"))
        .map(|(first, last)| (last + 1).saturating_sub(first));
    let used = parameters.count("POINT", "USED");
    say("points", vec![("the header", Some(header.points)), ("POINT:USED", used)], layout.points);
    say("analog numbers in a frame", vec![("the header", Some(header.analog))], layout.analog);
    // Counts of 16 bits cannot say more.
    let short = |count: usize| (layout.frames <= 65535).then_some(count);
    say(
        "frames",
        vec![
            ("the header", short(header.frames())),
            ("POINT:FRAMES", parameters.count("POINT", "FRAMES").and_then(short)),
            ("POINT:LONG_FRAMES", parameters.count("POINT", "LONG_FRAMES")),
            ("TRIAL", by_trial),
        ],
        layout.frames,
    );
    if layout.real != (scale < 0.0) {
        let kind = if layout.real { "floats" } else { "whole numbers" };
        let message = format!("the scale {scale} does not fit the size of the numbers");
        let help = format!("they are {kind}, by the length of the file");
        warnings.push(Diagnostic::warning("c3d/scale", message).with_help(help));
    }
}

/// The scale of points: the parameter, else the header; its sign tells whether numbers are floats.
pub(super) fn scale(header: &Header, parameters: &Parameters) -> f64 {
    let stated = [parameters.number("POINT", "SCALE"), Some(f64::from(header.scale))];
    let valid = |v: &f64| v.is_finite() && *v != 0.0;
    stated.into_iter().flatten().find(valid).unwrap_or(0.0)
}

/// Analog samples in each frame: by the header, else by the rates; 1 where nothing tells.
pub(super) fn samples(header: &Header, parameters: &Parameters) -> usize {
    if header.samples > 0 {
        return header.samples;
    }
    let rates = parameters.number("ANALOG", "RATE").zip(parameters.number("POINT", "RATE"));
    let ratio = rates.map_or(1.0, |(analog, points)| analog / points);
    if ratio.is_finite() && (1.0..65535.0).contains(&ratio) { ratio.round() as usize } else { 1 }
}
