//! Writing: floats in Intel's order, with all parameters that were read.

use super::event::Origin;
use super::header::{FOUR_LETTERS, MOST_EVENTS};
use super::parameters::{Parameter, Parameters, Values};
use super::trial::{Column, Kind, Trial};
use condyle_diagnostics::Error;

/// The size of a block in bytes.
const BLOCK: usize = 512;

/// The longest name of a point or a channel in bytes.
const LONGEST: usize = 127;

/// Writes a trial with everything it holds: floats in Intel's order, in its own unit and axes.
///
/// Parameters are those of the trial, but those that describe its data are set: counts, rates, scales,
/// labels, and where the data start. A marker that was not seen is `0 0 0` with the word -1.
///
/// # Errors
///
/// `c3d/shape` if the parts do not fit together, `c3d/label` for a name of more than 127 bytes,
/// `c3d/too-large` if counts or parameters exceed what the format holds.
pub fn write(trial: &Trial) -> Result<Vec<u8>, Error> {
    check(trial)?;
    let parameters = described(trial);
    let section = section(&parameters)?;
    let data_block = 2 + section.len() / BLOCK;
    let mut file = header(trial, data_block)?;
    file.extend_from_slice(&section);
    patch_data_start(&mut file, &parameters, data_block)?;
    frames(trial, &mut file);
    file.resize(file.len().next_multiple_of(BLOCK), 0);
    Ok(file)
}

fn check(trial: &Trial) -> Result<(), Error> {
    let shape = |message: String| Err(Error::new("c3d/shape", message));
    let recording = &trial.recording;
    if let Some(mismatch) = recording.mismatch() {
        return shape(mismatch);
    }
    let frames = recording.frames();
    if frames == 0 {
        return shape("there are no frames".to_owned());
    }
    if trial.first_frame == 0 || trial.first_frame > u32::MAX as usize - frames {
        let message = format!("{frames} frames cannot be counted from {}", trial.first_frame);
        return Err(too_large(message, "the first frame is 1 or more, the last fits into 32 bits"));
    }
    let (markers, others) = (recording.labels.len(), trial.others.len());
    let known = trial.columns.iter().all(|column| match *column {
        Column::Marker(index) => index < markers,
        Column::Other(index) => index < others,
    });
    if !known || trial.columns.len() != markers + others {
        return shape("the columns do not name each marker and each other point once".to_owned());
    }
    if let Some(other) = trial.others.iter().find(|o| o.values.len() != frames) {
        let (label, values) = (&other.label, other.values.len());
        return shape(format!("`{label}` has {values} values in {frames} frames"));
    }
    let per_frame = trial.analog.channels.len() * trial.analog.per_frame;
    if frames.checked_mul(per_frame) != Some(trial.analog.stored.len()) {
        return shape(format!(
            "{frames} frames of {per_frame} analog numbers need {}, found {}",
            frames.saturating_mul(per_frame),
            trial.analog.stored.len()
        ));
    }
    if trial.columns.is_empty() && per_frame == 0 {
        return shape("there are neither points nor analog channels".to_owned());
    }
    let labels = trial.columns.iter().map(|column| trial.label(*column));
    let labels = labels.chain(trial.analog.channels.iter().map(|c| c.label.as_str()));
    for label in labels {
        if label.trim() != label || label.is_empty() || label.len() > LONGEST {
            let message = format!("`{label}` cannot be the name of a point or channel");
            let help = format!("1 to {LONGEST} bytes without blanks around them can");
            return Err(Error::new("c3d/label", message).with_help(help));
        }
    }
    Ok(())
}

/// The parameters, with those that describe the data set to what is written.
fn described(trial: &Trial) -> Parameters {
    let mut all = trial.parameters.clone();
    let (recording, analog) = (&trial.recording, &trial.analog);
    let frames = recording.frames();
    let counted = |all: &mut Parameters, group: &str, name: &str, value: usize| {
        // Counts of 16 bits have no sign.
        if all.count(group, name) != Some(value.min(65535)) {
            let value = value.min(65535) as u16;
            all.set(group, name, Values::Integers(vec![value as i16]), &[]);
        }
    };
    counted(&mut all, "POINT", "USED", trial.columns.len());
    counted(&mut all, "POINT", "FRAMES", frames);
    if frames > 65535 || all.get("POINT", "LONG_FRAMES").is_some() {
        all.set("POINT", "LONG_FRAMES", Values::Floats(vec![frames as f32]), &[]);
    }
    let last = trial.first_frame + frames - 1;
    if last > 65535 || all.get("TRIAL", "ACTUAL_END_FIELD").is_some() {
        for (name, value) in [("ACTUAL_START_FIELD", trial.first_frame), ("ACTUAL_END_FIELD", last)]
        {
            let words = [(value & 0xffff) as u16 as i16, (value >> 16) as u16 as i16];
            all.set("TRIAL", name, Values::Integers(words.to_vec()), &[2]);
        }
    }
    let scale = if trial.scale == 0.0 { 1.0 } else { trial.scale.abs() };
    all.set("POINT", "SCALE", Values::Floats(vec![-scale]), &[]);
    all.set("POINT", "DATA_START", Values::Integers(vec![0]), &[]);
    if all.number("POINT", "RATE") != Some(recording.rate) {
        all.set("POINT", "RATE", Values::Floats(vec![recording.rate as f32]), &[]);
    }
    if condyle_motion::LengthUnit::from_name(&all.text("POINT", "UNITS")) != Some(recording.units) {
        all.set_texts("POINT", "UNITS", &[recording.units.name()]);
    }
    let labels: Vec<&str> = trial.columns.iter().map(|column| trial.label(*column)).collect();
    all.set_texts("POINT", "LABELS", &labels);
    for kind in Kind::ALL {
        let of_kind: Vec<&str> =
            trial.others.iter().filter(|o| o.kind == kind).map(|o| o.label.as_str()).collect();
        let listed = all.texts("POINT", kind.list());
        if of_kind.iter().any(|label| !listed.iter().any(|known| known == label)) {
            all.set_texts("POINT", kind.list(), &of_kind);
        }
    }
    counted(&mut all, "ANALOG", "USED", analog.channels.len());
    if all.number("ANALOG", "RATE") != Some(analog.rate) {
        all.set("ANALOG", "RATE", Values::Floats(vec![analog.rate as f32]), &[]);
    }
    if all.number("ANALOG", "GEN_SCALE") != Some(analog.scale) {
        all.set("ANALOG", "GEN_SCALE", Values::Floats(vec![analog.scale as f32]), &[]);
    }
    if !analog.channels.is_empty() {
        described_channels(trial, &mut all);
    }
    all
}

fn described_channels(trial: &Trial, all: &mut Parameters) {
    let channels = &trial.analog.channels;
    let labels: Vec<&str> = channels.iter().map(|c| c.label.as_str()).collect();
    all.set_texts("ANALOG", "LABELS", &labels);
    let starts_with = |list: &[f64], wanted: &[f64]| list.get(..wanted.len()) == Some(wanted);
    let scales: Vec<f64> = channels.iter().map(|c| c.scale).collect();
    if !starts_with(&all.numbers("ANALOG", "SCALE"), &scales) {
        all.set_numbers("ANALOG", "SCALE", &scales, false);
    }
    let unsigned = super::analog::unsigned(all);
    let offsets: Vec<f64> = channels
        .iter()
        .map(|c| {
            if unsigned && c.offset > 32767.0 || c.offset == 32768.0 {
                c.offset - 65536.0
            } else {
                c.offset
            }
        })
        .collect();
    if !starts_with(&all.numbers("ANALOG", "OFFSET"), &offsets) {
        let whole = offsets.iter().all(|o| o.fract() == 0.0 && (-32768.0..=32767.0).contains(o));
        all.set_numbers("ANALOG", "OFFSET", &offsets, whole);
    }
    let units: Vec<&str> = channels.iter().map(|c| c.unit.as_str()).collect();
    let known = all.texts("ANALOG", "UNITS");
    let same = units.iter().enumerate().all(|(i, unit)| known.get(i).map_or("", |k| k) == *unit);
    if !same {
        all.set_texts("ANALOG", "UNITS", &units);
    }
}

fn too_large(message: String, help: &str) -> Error {
    Error::new("c3d/too-large", message).with_help(help)
}

/// The section in whole blocks.
fn section(parameters: &Parameters) -> Result<Vec<u8>, Error> {
    let mut section = vec![1, 0x50, 0, 84];
    if parameters.groups.len() > 127 {
        let message = format!("there are {} groups of parameters", parameters.groups.len());
        return Err(too_large(message, "a C3D file holds 127"));
    }
    for (index, group) in parameters.groups.iter().enumerate() {
        let id = index as i8 + 1;
        let mut body = vec![];
        text_with_length(&mut body, &group.description);
        record(&mut section, &group.name, group.locked, -id, &body)?;
        for parameter in &group.parameters {
            let body = body_of(parameter);
            record(&mut section, &parameter.name, parameter.locked, id, &body)?;
        }
    }
    section.push(0);
    section.resize(section.len().next_multiple_of(BLOCK), 0);
    let blocks = section.len() / BLOCK;
    let Ok(count) = u8::try_from(blocks) else {
        let message = format!("the parameters take {} bytes", section.len());
        return Err(too_large(message, "a C3D file holds 130560"));
    };
    if let Some(byte) = section.get_mut(2) {
        *byte = count;
    }
    Ok(section)
}

/// At most 255 bytes of a text behind their number.
fn text_with_length(body: &mut Vec<u8>, text: &str) {
    let bytes = text.as_bytes();
    let kept = bytes.get(..255).unwrap_or(bytes);
    body.push(kept.len() as u8);
    body.extend_from_slice(kept);
}

fn body_of(parameter: &Parameter) -> Vec<u8> {
    let kind: i8 = match parameter.values {
        Values::Letters(_) => -1,
        Values::Bytes(_) => 1,
        Values::Integers(_) => 2,
        Values::Floats(_) => 4,
    };
    let mut body = vec![kind as u8, parameter.sizes.len().min(255) as u8];
    body.extend(parameter.sizes.iter().take(255));
    match &parameter.values {
        Values::Letters(values) | Values::Bytes(values) => body.extend_from_slice(values),
        Values::Integers(values) => body.extend(values.iter().flat_map(|v| v.to_le_bytes())),
        Values::Floats(values) => body.extend(values.iter().flat_map(|v| v.to_le_bytes())),
    }
    text_with_length(&mut body, &parameter.description);
    body
}

fn record(
    section: &mut Vec<u8>,
    name: &str,
    locked: bool,
    id: i8,
    body: &[u8],
) -> Result<(), Error> {
    // A group without a name needs one in the file.
    let name = if name.is_empty() { "UNNAMED" } else { name };
    let bytes = name.as_bytes();
    let kept = bytes.get(..LONGEST).unwrap_or(bytes);
    let length = kept.len() as i8;
    section.push(if locked { -length } else { length } as u8);
    section.push(id as u8);
    section.extend_from_slice(kept);
    let Ok(offset) = u16::try_from(body.len() + 2) else {
        let message = format!("the parameter `{name}` takes {} bytes", body.len());
        return Err(too_large(message, "a C3D file holds 65533"));
    };
    section.extend_from_slice(&offset.to_le_bytes());
    section.extend_from_slice(body);
    Ok(())
}

/// The first block.
fn header(trial: &Trial, data_block: usize) -> Result<Vec<u8>, Error> {
    let (recording, analog) = (&trial.recording, &trial.analog);
    let count = |what: &str, value: usize| {
        u16::try_from(value)
            .map_err(|_| too_large(format!("there are {value} {what}"), "a C3D file holds 65535"))
    };
    let mut block = vec![0u8; BLOCK];
    let mut put = |at: usize, bytes: &[u8]| {
        if let Some(place) = block.get_mut(at..at + bytes.len()) {
            place.copy_from_slice(bytes);
        }
    };
    let first = trial.first_frame;
    let last = first + recording.frames() - 1;
    let scale = if trial.scale == 0.0 { 1.0 } else { trial.scale.abs() };
    put(0, &[2, 0x50]);
    put(2, &count("points", trial.columns.len())?.to_le_bytes());
    let numbers = analog.channels.len() * analog.per_frame;
    put(4, &count("analog numbers in a frame", numbers)?.to_le_bytes());
    // Larger numbers are in the group TRIAL.
    put(6, &(first.min(65535) as u16).to_le_bytes());
    put(8, &(last.min(65535) as u16).to_le_bytes());
    put(10, &trial.filled_gap.to_le_bytes());
    put(12, &(-scale).to_le_bytes());
    put(16, &count("blocks before the data", data_block)?.to_le_bytes());
    put(18, &count("analog samples in a frame", analog.per_frame)?.to_le_bytes());
    put(20, &(recording.rate as f32).to_le_bytes());
    put(298, &FOUR_LETTERS.to_le_bytes());
    let events = trial.header_events.iter().filter(|e| e.origin == Origin::Header);
    let events: Vec<_> = events.take(MOST_EVENTS).collect();
    put(300, &(events.len() as u16).to_le_bytes());
    for (index, event) in events.iter().enumerate() {
        put(304 + 4 * index, &(event.time as f32).to_le_bytes());
        put(376 + index, &[u8::from(!event.shown)]);
        let mut label = [b' '; 4];
        for (letter, byte) in label.iter_mut().zip(event.label.bytes()) {
            *letter = byte;
        }
        put(396 + 4 * index, &label);
    }
    Ok(block)
}

/// Writes where the data start into the parameter that says so.
fn patch_data_start(
    file: &mut [u8],
    parameters: &Parameters,
    data_block: usize,
) -> Result<(), Error> {
    let mut with_start = parameters.clone();
    let start = u16::try_from(data_block).unwrap_or(u16::MAX);
    with_start.set("POINT", "DATA_START", Values::Integers(vec![start as i16]), &[]);
    let section = section(&with_start)?;
    if let Some(place) = file.get_mut(BLOCK..BLOCK + section.len()) {
        place.copy_from_slice(&section);
    }
    Ok(())
}

/// All frames.
fn frames(trial: &Trial, file: &mut Vec<u8>) {
    let (recording, analog) = (&trial.recording, &trial.analog);
    let markers = recording.labels.len();
    let per_frame = analog.channels.len() * analog.per_frame;
    file.reserve_exact(recording.frames() * (16 * trial.columns.len() + 4 * per_frame) + BLOCK);
    for frame in 0..recording.frames() {
        let row = recording.frame(frame);
        for column in &trial.columns {
            let (place, word) = match *column {
                Column::Marker(index) => {
                    let place = row.get(index).and_then(|p| p.position());
                    let place =
                        place.map(|p| trial.up.back(p).map(|x| in_unit(recording.units, x) as f32));
                    let word = trial.words.get(frame * markers + index).copied();
                    (place, word.filter(|word| *word >= 0.0).unwrap_or(0.0))
                }
                Column::Other(index) => {
                    let other = trial.others.get(index);
                    let value = other.and_then(|o| o.values.get(frame)).copied();
                    let word = other.and_then(|o| o.words.get(frame)).copied().unwrap_or(0.0);
                    (value.filter(|_| word >= 0.0), word)
                }
            };
            let seen = place.filter(|place| place.iter().all(|x| x.is_finite()));
            let (place, word) = seen.map_or(([0.0; 3], -1.0), |place| (place, word));
            for number in [place[0], place[1], place[2], word] {
                file.extend_from_slice(&number.to_le_bytes());
            }
        }
        let samples = analog.stored.get(frame * per_frame..(frame + 1) * per_frame);
        for number in samples.unwrap_or_default() {
            file.extend_from_slice(&number.to_le_bytes());
        }
    }
}

/// A length in a unit, to the nearest double: a float that was read comes back as it was.
fn in_unit(unit: condyle_motion::LengthUnit, length: f64) -> f64 {
    length / unit.to_metres(1.0)
}
