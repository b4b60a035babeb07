//! Reading: header, parameters, layout, then all frames.

use super::analog::{self, Analog};
use super::bytes::{Processor, Source};
use super::header::{Header, block};
use super::layout::{self, Layout};
use super::parameters::Parameters;
use super::section;
use super::trial::{Column, Kind, Other, Storage, Trial, missing_word};
use super::vertical::{self, Up};
use crate::text::distinct;
use condyle_diagnostics::{Diagnostic, Error, Place, Read, Warnings};
use condyle_motion::{LengthUnit, Observed, Recording};

/// Reads all that a C3D file holds; see [the module](super) for what is repaired.
///
/// # Errors
///
/// `c3d/not-c3d`, `c3d/truncated` (no whole frame is there), `c3d/no-data` (neither points nor channels),
/// `c3d/unit` (none is stated, and the size of the data does not tell it).
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Trial>, Error> {
    let mut warnings = Warnings::default();
    let (source, start) = open(bytes, &mut warnings)?;
    let truncated = || Error::new("c3d/truncated", "the file ends in its header");
    let header = Header::read(&source).ok_or_else(truncated)?;
    // A place of the data that cannot be right bounds nothing.
    let limit = if header.data > start + 4 { header.data } else { bytes.len() };
    let (parameters, end) = section::read(&source, start + 4, limit, &mut warnings);
    let layout = layout::find(&source, &header, &parameters, end, &mut warnings)?;
    let rate = rate(&header, &parameters, &mut warnings);
    let per_frame = layout::samples(&header, &parameters);
    let mut analog = analog::channels(&parameters, layout, per_frame, rate, &mut warnings);
    let scale =
        whole_scale(&header, layout, layout::scale(&header, &parameters) as f32, &mut warnings);
    if scale == 0.0 && !layout.real {
        let message = "POINT:SCALE is missing or zero";
        let said = Diagnostic::warning("c3d/scale", message);
        warnings.push(said.with_help("whole numbers are taken as they are"));
    }
    let scale = if scale == 0.0 { 1.0 } else { scale.abs() };

    let mut points = Points::new(&parameters, layout, &mut warnings);
    let decoder = Decoder { source, layout, scale, unsigned: analog::unsigned(&parameters) };
    let sample = decoder.sample(&points);
    let unit = unit(&parameters, &points, &sample, &mut warnings)?;
    let up = vertical::find(&parameters, &sample, unit.to_metres(1.0), &mut warnings);
    analog.stored.reserve_exact(layout.frames * layout.analog);
    points.reserve(layout.frames);
    decoder.read(&mut points, &mut analog, unit, up);

    let mut first = layout::field(&parameters, "ACTUAL_START_FIELD").unwrap_or(header.first).max(1);
    if first + layout.frames > u32::MAX as usize {
        // A number of 32 bits has to hold the last frame too, or the file cannot be written again.
        let message = format!("frame {first} is stated to be the first of {}", layout.frames);
        let said = Diagnostic::warning("c3d/first-frame", message);
        warnings.push(said.with_help("frames are counted from 1"));
        first = 1;
    }
    let time = |frame: usize| (first - 1 + frame) as f64 / rate;
    let recording = Recording {
        labels: points.labels,
        rate,
        times: (0..layout.frames).map(time).collect(),
        positions: points.positions,
        units: unit,
        confidences: None,
    };
    let trial = Trial {
        recording,
        words: points.words,
        others: points.others,
        columns: points.columns,
        analog,
        header_events: header.events,
        parameters,
        first_frame: first,
        filled_gap: header.gap,
        scale,
        up,
        storage: Storage { processor: source.processor, whole: !layout.real },
    };
    Ok(Read { value: trial, warnings: warnings.finish() })
}

/// The scale of whole numbers: that of the header where it differs from the parameter, as header and frames are
/// written together and parameters by many programs.
fn whole_scale(header: &Header, layout: Layout, stated: f32, warnings: &mut Warnings) -> f32 {
    let (ours, theirs) = (header.scale.abs(), stated.abs());
    let differ = ours.is_finite() && ours > 0.0 && (ours - theirs).abs() > 0.01 * ours;
    if layout.real || !differ || theirs == 0.0 {
        return stated;
    }
    let message = format!("the scale is {ours} by the header, {theirs} by POINT:SCALE");
    warnings
        .push(Diagnostic::warning("c3d/scale", message).with_help("that of the header is used"));
    ours
}

/// Tells the processor and where the parameters start.
fn open<'b>(bytes: &'b [u8], warnings: &mut Warnings) -> Result<(Source<'b>, usize), Error> {
    let [number, key, ..] = *bytes else {
        return Err(Error::new("c3d/not-c3d", "the file has less than two bytes"));
    };
    if key != 0x50 {
        let message = format!("the second byte is {key}, not 80");
        let error = Error::new("c3d/not-c3d", message).at(Place::at_byte(1));
        return Err(error.with_help("this is not a C3D file"));
    }
    let start = block(number.into());
    let start = if start == 0 { 512 } else { start };
    let Some(&code) = bytes.get(start + 3) else {
        let message = "the file ends before its parameters";
        return Err(Error::new("c3d/truncated", message).at(Place::at_byte(bytes.len() as u64)));
    };
    let processor = Processor::from_code(code).unwrap_or_else(|| {
        let message = format!("the processor {code} is unknown");
        let said = Diagnostic::warning("c3d/processor", message);
        warnings.push(said.at(Place::at_byte(start as u64 + 3)).with_help("taken as Intel (84)"));
        Processor::Intel
    });
    Ok((Source { bytes, processor }, start))
}

/// Frames per second.
fn rate(header: &Header, parameters: &Parameters, warnings: &mut Warnings) -> f64 {
    let stated = [parameters.number("POINT", "RATE"), Some(f64::from(header.rate))];
    let valid = |rate: &f64| rate.is_finite() && *rate > 0.0;
    stated.into_iter().flatten().find(valid).unwrap_or_else(|| {
        let said = Diagnostic::warning("c3d/rate", "there is no number of frames per second");
        warnings.push(said.with_help("100 are taken"));
        100.0
    })
}

/// The points that are read so far.
struct Points {
    labels: Vec<String>,
    columns: Vec<Column>,
    positions: Vec<Observed>,
    words: Vec<f32>,
    others: Vec<Other>,
}

impl Points {
    fn new(parameters: &Parameters, layout: Layout, warnings: &mut Warnings) -> Self {
        let labels = parameters.texts("POINT", "LABELS");
        let name = |index: usize| match labels.get(index).map(String::as_str) {
            None | Some("") => "unnamed",
            Some(label) => label,
        };
        let unnamed = (0..layout.points).filter(|&index| name(index) == "unnamed").count();
        if unnamed > 0 {
            let message = format!("{unnamed} of {} points have no name", layout.points);
            let said = Diagnostic::warning("c3d/unnamed", message);
            warnings.push(said.with_help("they are called `unnamed`"));
        }
        let names = distinct((0..layout.points).map(name), |index, other| {
            let name = name(index);
            if name != "unnamed" {
                warnings.add("c3d/duplicate-name", || {
                    let message = format!("two points are called `{name}`");
                    let said = Diagnostic::warning("c3d/duplicate-name", message);
                    said.with_help(format!("the later one is read as `{other}`"))
                });
            }
        });
        let listed: Vec<(Kind, std::collections::HashSet<String>)> = Kind::ALL
            .into_iter()
            .map(|kind| (kind, parameters.texts("POINT", kind.list()).into_iter().collect()))
            .collect();
        let mut points = Self {
            labels: vec![],
            columns: Vec::with_capacity(layout.points),
            positions: vec![],
            words: vec![],
            others: vec![],
        };
        for (index, label) in names.into_iter().enumerate() {
            let kind = listed.iter().find(|(_, labels)| labels.contains(name(index)));
            points.columns.push(match kind {
                Some(&(kind, _)) => {
                    let unit = parameters.text("POINT", kind.unit());
                    let (values, words) = (vec![], vec![]);
                    points.others.push(Other { label, kind, unit, values, words });
                    Column::Other(points.others.len() - 1)
                }
                None => {
                    points.labels.push(label);
                    Column::Marker(points.labels.len() - 1)
                }
            });
        }
        points
    }

    fn reserve(&mut self, frames: usize) {
        self.positions.reserve_exact(frames * self.labels.len());
        self.words.reserve_exact(frames * self.labels.len());
        for other in &mut self.others {
            other.values.reserve_exact(frames);
            other.words.reserve_exact(frames);
        }
    }
}

/// The unit of length: stated, or told by the size of the markers.
fn unit(
    parameters: &Parameters,
    points: &Points,
    sample: &[[f64; 3]],
    warnings: &mut Warnings,
) -> Result<LengthUnit, Error> {
    let stated = parameters.text("POINT", "UNITS");
    if let Some(unit) = LengthUnit::from_name(&stated) {
        return Ok(unit);
    }
    if points.labels.is_empty() || sample.is_empty() {
        return Ok(LengthUnit::Millimetre);
    }
    // Frame by frame, as far as the sample goes.
    let width = points.labels.len().min(sample.len());
    let rows = sample.len() / width;
    let recording = Recording {
        labels: points.labels.iter().take(width).cloned().collect(),
        times: vec![0.0; rows],
        positions: sample.iter().take(rows * width).map(|p| Observed::from(*p)).collect(),
        ..Recording::default()
    };
    let message = match stated.as_str() {
        "" => "the file states no unit of length".to_owned(),
        _ => format!("`{stated}` is not a unit of length"),
    };
    let size = recording.extent().unwrap_or_else(|| recording.reach());
    let unit = recording.unit_by_size().ok_or_else(|| {
        let message = format!("{message}, and a span of {size:.4} does not tell it");
        let help = "it may be a body in cm or a hand in mm: write the unit as POINT:UNITS";
        Error::new("c3d/unit", message).with_help(help)
    })?;
    let help = format!("the markers span {size:.4} units, taken as {}", unit.name());
    warnings.push(Diagnostic::warning("c3d/unit", message).with_help(help));
    Ok(unit)
}

/// Makes numbers of the bytes of frames.
struct Decoder<'b> {
    source: Source<'b>,
    layout: Layout,
    scale: f32,
    unsigned: bool,
}

impl Decoder<'_> {
    fn frame(&self, index: usize) -> (&[u8], &[u8]) {
        let size = self.layout.frame_bytes();
        let start = self.layout.data + index * size;
        let bytes = self.source.bytes.get(start..start + size).unwrap_or_default();
        bytes.split_at_checked(self.layout.point_bytes()).unwrap_or_default()
    }

    /// The places of markers in up to 64 frames, in the file's own axes and unit, without zeros.
    fn sample(&self, points: &Points) -> Vec<[f64; 3]> {
        let step = self.layout.frames.div_ceil(64).max(1);
        let mut row = vec![];
        let mut places = vec![];
        for frame in (0..self.layout.frames).step_by(step) {
            self.points(self.frame(frame).0, &mut row);
            for (point, column) in row.iter().zip(&points.columns) {
                let [x, y, z, word] = *point;
                let place = [x, y, z].map(f64::from);
                let seen = word >= 0.0 && place != [0.0; 3] && place.iter().all(|x| x.is_finite());
                if seen && matches!(column, Column::Marker(_)) {
                    places.push(place);
                }
            }
        }
        places
    }

    /// The points of a frame: x, y, z and the word.
    fn points(&self, bytes: &[u8], row: &mut Vec<[f32; 4]>) {
        row.clear();
        let processor = self.source.processor;
        match (self.layout.real, processor) {
            (true, Processor::Intel) => row.extend(bytes.as_chunks::<16>().0.iter().map(intel)),
            (true, _) => row.extend(
                bytes
                    .as_chunks::<4>()
                    .0
                    .as_chunks::<4>()
                    .0
                    .iter()
                    .map(|p| p.map(|b| processor.f32(b))),
            ),
            (false, _) => row.extend(bytes.as_chunks::<2>().0.as_chunks::<4>().0.iter().map(|p| {
                let [x, y, z, word] = p.map(|b| f32::from(processor.u16(b) as i16));
                [x * self.scale, y * self.scale, z * self.scale, word]
            })),
        }
    }

    fn samples(&self, bytes: &[u8], stored: &mut Vec<f32>) {
        let processor = self.source.processor;
        match (self.layout.real, processor, self.unsigned) {
            (true, Processor::Intel, _) => {
                stored.extend(bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)));
            }
            (true, _, _) => {
                stored.extend(bytes.as_chunks::<4>().0.iter().map(|b| processor.f32(*b)))
            }
            (false, _, true) => {
                stored.extend(bytes.as_chunks::<2>().0.iter().map(|b| f32::from(processor.u16(*b))))
            }
            (false, _, false) => stored.extend(
                bytes.as_chunks::<2>().0.iter().map(|b| f32::from(processor.u16(*b) as i16)),
            ),
        }
    }

    fn read(&self, points: &mut Points, analog: &mut Analog, unit: LengthUnit, up: Up) {
        // Loops without a choice in them, for what most files are.
        match (unit, up) {
            (LengthUnit::Millimetre, Up::Y) => self.read_with(points, analog, thousandth, |p| p),
            (LengthUnit::Millimetre, Up::Z) => {
                self.read_with(points, analog, thousandth, |[x, y, z]| [x, z, 0.0 - y]);
            }
            (LengthUnit::Metre, Up::Y) => self.read_with(points, analog, f64::from, |p| p),
            (LengthUnit::Metre, Up::Z) => {
                self.read_with(points, analog, f64::from, |[x, y, z]| [x, z, 0.0 - y]);
            }
            _ => {
                let metres = |x: f32| unit.to_metres(f64::from(x));
                self.read_with(points, analog, metres, |p| up.turned(p));
            }
        }
    }

    fn read_with(
        &self,
        points: &mut Points,
        analog: &mut Analog,
        metres: impl Fn(f32) -> f64,
        turned: impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let marker = |point: &[f32; 4]| {
            let [x, y, z, _] = *point;
            let place = turned([metres(x), metres(y), metres(z)]);
            if is_seen(*point) { Observed::from(place) } else { Observed::MISSING }
        };
        let mut row: Vec<[f32; 4]> = Vec::with_capacity(self.layout.points);
        let Points { columns, positions, words, others, .. } = points;
        for frame in 0..self.layout.frames {
            let (of_points, of_channels) = self.frame(frame);
            self.points(of_points, &mut row);
            if others.is_empty() {
                positions.extend(row.iter().map(marker));
                words.extend(row.iter().map(|point| word(*point)));
            } else {
                for (point, column) in row.iter().zip(columns.iter()) {
                    let [x, y, z, _] = *point;
                    match *column {
                        Column::Marker(_) => {
                            positions.push(marker(point));
                            words.push(word(*point));
                        }
                        Column::Other(index) => {
                            if let Some(other) = others.get_mut(index) {
                                let seen = is_seen(*point);
                                other.values.push(if seen { [x, y, z] } else { [0.0; 3] });
                                other.words.push(word(*point));
                            }
                        }
                    }
                }
            }
            self.samples(of_channels, &mut analog.stored);
        }
    }
}

/// The four floats of a point.
#[inline]
fn intel(bytes: &[u8; 16]) -> [f32; 4] {
    // One load; of an array of arrays the compiler makes calls.
    let bits = u128::from_le_bytes(*bytes);
    [
        f32::from_bits(bits as u32),
        f32::from_bits((bits >> 32) as u32),
        f32::from_bits((bits >> 64) as u32),
        f32::from_bits((bits >> 96) as u32),
    ]
}

/// Whether a point is there: its word is not negative, and its numbers are numbers.
#[inline]
fn is_seen([x, y, z, word]: [f32; 4]) -> bool {
    // A word that is no number says nothing of the marker.
    let stated = (word >= 0.0) | word.is_nan();
    stated & x.is_finite() & y.is_finite() & z.is_finite()
}

/// The word of a point that is kept.
#[inline]
fn word(point: [f32; 4]) -> f32 {
    if is_seen(point) { point[3].max(0.0) } else { missing_word(true) }
}

/// A float divided by 1000, to the nearest double, without a division.
///
/// A thousandth is the sum of a number of 29 bits, whose product with the 24 of a float is exact, and a rest
/// whose product is off by less than 2^-82 of the result. So near to the middle of two doubles no quotient by
/// 125 lies: such a quotient is at least 2^-61 away from it.
#[inline]
fn thousandth(length: f32) -> f64 {
    const HIGH: f64 = f64::from_bits(0.001f64.to_bits() & !((1 << 24) - 1));
    // The rest of 0.001 that a double leaves, 0.001 - fl(0.001) = -2.0816681711721685e-20, belongs to it.
    const LOW: f64 = (0.001 - HIGH) - 2.081_668_171_172_168_5e-20;
    let length = f64::from(length);
    length * HIGH + length * LOW
}

/// Whether bytes look like a C3D file.
pub(crate) fn is_c3d(bytes: &[u8]) -> bool {
    let [number, 0x50, ..] = *bytes else { return false };
    let start = block(usize::from(number).max(2));
    bytes.get(start + 3).is_some_and(|code| Processor::from_code(*code).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thousandth_is_that_of_a_division() {
        // Every 29th float of a binade, and some of all others.
        let mut bits = 0x3f80_0000u32;
        while bits < 0x4000_0000 {
            let x = f32::from_bits(bits);
            assert_eq!(thousandth(x), f64::from(x) / 1000.0, "{x}");
            bits += 29;
        }
        for exponent in 0..255u32 {
            for fraction in (0..1 << 23).step_by(104_729) {
                let x = f32::from_bits(exponent << 23 | fraction);
                assert_eq!(thousandth(x), f64::from(x) / 1000.0, "{x:e}");
                assert_eq!(thousandth(-x), f64::from(-x) / 1000.0, "{x:e}");
            }
        }
    }
}
