//! The frames: their number, their time, and a row of numbers for each.

use crate::text::{Line, cell, number, with_comma};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};

/// Taken where a file does not say how long a frame is.
const USUAL_FRAME_TIME: f64 = 1.0 / 30.0;
/// A frame is not that long: it is a number of frames per second.
const RATE_FROM: f64 = 10.0;

/// What stands behind MOTION.
#[derive(Debug, Default)]
pub(super) struct Head {
    frames: Option<f64>,
    frame_time: Option<f64>,
    place: Option<Place>,
}

impl Head {
    /// Takes what a line states; whether it is such a line and no row.
    fn take(&mut self, line: &Line<'_>) -> bool {
        let mut rest = line.text.trim_start_matches(|c: char| c.is_whitespace() || c == '\0');
        let mut any = false;
        loop {
            let length = rest.find(|c: char| !c.is_alphabetic() && !c.is_whitespace());
            let (key, after) = rest.split_at(length.unwrap_or(rest.len()));
            let key: String = key.split_whitespace().collect::<String>().to_ascii_lowercase();
            // A cell such as `nan` begins no key.
            if !matches!(
                key.as_str(),
                "frames" | "frame" | "frametime" | "frametimes" | "framerate"
            ) {
                return any;
            }
            any = true;
            let after = after.trim_start_matches(|c: char| c.is_whitespace() || ":=".contains(c));
            let length = after.find(char::is_whitespace).unwrap_or(after.len());
            let (word, next) = after.split_at(length);
            let value = number(word).or_else(|| with_comma(word));
            match key.as_str() {
                "frames" | "frame" => self.frames = value,
                "framerate" => self.frame_time = value.map(|rate| 1.0 / rate),
                _ => self.frame_time = value,
            }
            self.place = Some(line.place());
            rest = next.trim_start();
        }
    }

    /// Seconds of one frame.
    fn seconds(&self, warnings: &mut Warnings) -> f64 {
        let place = self.place.unwrap_or(Place::at_line(1));
        let mut warn = |message: String| {
            let said = Diagnostic::warning("bvh/frame-time", message).at(place);
            warnings.push(said.with_help("correct `Frame Time:` if that is wrong"));
        };
        match self.frame_time {
            Some(time) if time.is_finite() && time >= RATE_FROM => {
                warn(format!("a frame time of {time} s is taken as {time} frames per second"));
                1.0 / time
            }
            Some(time) if time.is_finite() && time > 0.0 => time,
            Some(time) => {
                warn(format!("a frame time of {time} s is taken as 1/30 s"));
                USUAL_FRAME_TIME
            }
            None => {
                warn("the frame time is not stated: taken as 1/30 s".to_owned());
                USUAL_FRAME_TIME
            }
        }
    }
}

/// The rows as they are written.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) frame_time: f64,
    /// The numbers of all channels, frame by frame.
    pub(super) frames: Vec<Vec<f64>>,
}

fn separates(c: char) -> bool {
    c.is_whitespace() || matches!(c, ';' | '\0')
}

/// The cells of a row, with commas between them or in them.
fn cells<'a>(text: &'a str, width: usize) -> Vec<&'a str> {
    let trim = |cell: &'a str| cell.trim_matches(',');
    let words = text.split(separates).map(trim).filter(|cell| !cell.is_empty());
    if !text.contains(',') || words.clone().count() == width {
        return words.collect();
    }
    let all = text.split(|c| separates(c) || c == ',');
    all.filter(|cell| !cell.is_empty()).collect()
}

/// Reads the rows of so many channels, the first of them what is left of the line of MOTION. `resting` are
/// the numbers of all channels at rest, for what the first row leaves out.
pub(super) fn read<'a>(
    first: Option<Line<'a>>,
    lines: impl Iterator<Item = Line<'a>> + Clone,
    resting: &[f64],
    warnings: &mut Warnings,
) -> Result<Rows, Error> {
    let width = resting.len();
    let mut head = Head::default();
    let mut rows: Vec<(Line<'a>, usize)> = vec![];
    let mut total = 0usize;
    for line in first.into_iter().chain(lines).filter(|line| !line.is_blank()) {
        if head.take(&line) {
            continue;
        }
        let count = cells(line.text, width).len();
        total += count;
        rows.push((line, count));
    }
    let frame_time = head.seconds(warnings);
    if width == 0 {
        return Ok(Rows { frame_time, frames: vec![] });
    }
    let uneven = rows.iter().any(|(_, count)| *count != width);
    let whole = total.is_multiple_of(width).then_some(total / width);
    let stated = |count: usize| head.frames == Some(count as f64);
    let broken = uneven && whole.is_some_and(|count| stated(count) && count != rows.len());
    let frames = if broken {
        warnings.push(Diagnostic::warning(
            "bvh/broken-rows",
            format!("the rows are broken into {} lines, and put together", rows.len()),
        ));
        together(&rows, width)?
    } else {
        one_by_one(&rows, total, resting, warnings)?
    };
    if head.frames.is_some_and(|stated| stated != frames.len() as f64) {
        let stated = head.frames.unwrap_or(0.0);
        let message = format!("{stated} frames are stated, {} are there", frames.len());
        let said = Diagnostic::warning("bvh/frame-count", message).with_help("the rows rule");
        warnings.push(said.at(head.place.unwrap_or(Place::at_line(1))));
    }
    let mut frames = frames;
    fill(&mut frames, resting, warnings);
    Ok(Rows { frame_time, frames })
}

/// The number in a cell; NaN where there is none, an error for a word.
fn value(line: &Line<'_>, text: &str) -> Result<f64, Error> {
    let value = cell(text).or_else(|| with_comma(text));
    value.map(|v| if v.is_finite() { v } else { f64::NAN }).ok_or_else(|| {
        let message = format!("`{text:.40}` is no number");
        Error::new("bvh/number", message).at(line.place_of(text))
    })
}

fn together(rows: &[(Line<'_>, usize)], width: usize) -> Result<Vec<Vec<f64>>, Error> {
    let mut frames: Vec<Vec<f64>> = vec![];
    for (line, _) in rows {
        for text in cells(line.text, width) {
            let value = value(line, text)?;
            match frames.last_mut().filter(|frame| frame.len() < width) {
                Some(frame) => frame.push(value),
                None => frames.push(vec![value]),
            }
        }
    }
    Ok(frames)
}

fn one_by_one(
    rows: &[(Line<'_>, usize)],
    total: usize,
    resting: &[f64],
    warnings: &mut Warnings,
) -> Result<Vec<Vec<f64>>, Error> {
    let width = resting.len();
    // Rows that are far too short would take more memory than the file is large.
    if rows.len().saturating_mul(width) > 2 * total + (1 << 20) {
        let message = format!("{} rows of {width} channels hold only {total} numbers", rows.len());
        let place = rows.first().map_or(Place::at_line(1), |(line, _)| line.place());
        return Err(Error::new("bvh/short-rows", message).at(place));
    }
    let mut frames: Vec<Vec<f64>> = Vec::with_capacity(rows.len());
    for (line, count) in rows {
        if *count != width {
            warnings.add("bvh/row-length", || {
                let help = match *count < width {
                    true => "the other channels keep the numbers of the row before",
                    false => "the numbers behind the last channel are left out",
                };
                let message = format!("{count} numbers in a row of {width} channels");
                Diagnostic::warning("bvh/row-length", message).at(line.place()).with_help(help)
            });
        }
        let mut frame = Vec::with_capacity(width);
        for text in cells(line.text, width).into_iter().take(width) {
            frame.push(value(line, text)?);
        }
        if let Some(rest) = resting.get(frame.len()..) {
            let before = frames.last().and_then(|before| before.get(frame.len()..));
            frame.extend_from_slice(before.unwrap_or(rest));
        }
        frames.push(frame);
    }
    Ok(frames)
}

/// Numbers that are missing are those of the frame before.
fn fill(frames: &mut [Vec<f64>], resting: &[f64], warnings: &mut Warnings) {
    let mut missing = 0usize;
    let mut before: Vec<f64> = resting.to_vec();
    for frame in frames.iter_mut() {
        for (value, kept) in frame.iter_mut().zip(&mut before) {
            if value.is_nan() {
                missing += 1;
                *value = *kept;
            }
            *kept = *value;
        }
    }
    if missing > 0 {
        let message = format!("{missing} cells hold no finite number");
        let said = Diagnostic::warning("bvh/missing", message);
        warnings.push(said.with_help("they keep the number of the row before"));
    }
}
