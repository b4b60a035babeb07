//! AMC: the frames of a take.

use super::figure::{Figure, figure};
use super::words::{Row, rows, value};
use crate::skeleton::Assumed;
use crate::text::decode;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, listed};
use condyle_motion::{Animation, Motion};

/// Frames per second of the Carnegie Mellon recordings, taken where it is not told.
pub(super) const USUAL_RATE: f64 = 120.0;

/// Reads an AMC file with the ASF file of its skeleton: the model and its motion.
///
/// # Errors
/// Those of [`read`](super::read) for the skeleton; `amc/number`, `amc/grammar` and `amc/no-frame` with their
/// places, `amc/short-frames` of what no program writes.
///
/// ```
/// use condyle_formats::{asf, skeleton::Assumed};
/// let skeleton = ":units\n length 0.45\n:root\n order TX TY TZ RX RY RZ\n:bonedata\n begin\n name femur\n\
///     direction 0 -1 0\n length 7\n dof rx\n end\n:hierarchy\n begin\n root femur\n end\n";
/// let take = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 4.5 0 0 0 0\nfemur 90\n";
/// let assumed = Assumed { rate: Some(60.0), ..Assumed::default() };
/// let read = asf::with_skeleton(take.as_bytes(), skeleton.as_bytes(), &assumed)?.value;
/// assert!((read.motion.frames[0][1] - 4.5 / 0.45 * 0.0254).abs() < 1e-12);
/// assert_eq!(read.motion.frames[0][6], 90f64.to_radians());
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn with_skeleton(
    take: &[u8],
    skeleton: &[u8],
    assumed: &Assumed,
) -> Result<Read<Animation>, Error> {
    let read = figure(skeleton, assumed)?;
    let decoded = decode(take)?;
    let mut warnings = Warnings::default();
    warnings.extend(read.warnings);
    warnings.extend(decoded.warnings);
    let figure = read.value;
    let mut frames = Frames::new(&figure, &mut warnings);
    for row in rows(&decoded.value) {
        frames.take(&row)?;
    }
    let motion = frames.finish(assumed)?;
    let value = Animation { model: figure.model, motion };
    Ok(Read { value, warnings: warnings.finish() })
}

/// The frames as they are read.
struct Frames<'a> {
    figure: &'a Figure,
    warnings: &'a mut Warnings,
    degrees: bool,
    /// The numbers of frames.
    numbers: Vec<f64>,
    frames: Vec<Vec<f64>>,
    /// How many numbers there were.
    cells: usize,
    /// Whether the rows that come belong to a frame that counts.
    open: bool,
    /// Which stored numbers the open frame has.
    has: Vec<bool>,
    /// Cells that frames left out.
    kept: usize,
    unknown: Vec<String>,
    /// The number of the last frame as it is written, and what is added to it.
    written: Option<f64>,
    shift: f64,
}

impl<'a> Frames<'a> {
    fn new(figure: &'a Figure, warnings: &'a mut Warnings) -> Self {
        Self {
            figure,
            warnings,
            degrees: figure.degrees,
            numbers: vec![],
            frames: vec![],
            cells: 0,
            open: false,
            has: vec![false; figure.model.stored_len()],
            kept: 0,
            unknown: vec![],
            written: None,
            shift: 0.0,
        }
    }

    fn take(&mut self, row: &Row<'_>) -> Result<(), Error> {
        let mut words = row.words();
        let Some(first) = words.next() else { return Ok(()) };
        if let Some(keyword) = first.strip_prefix(':') {
            match keyword.to_ascii_lowercase().as_str() {
                "degrees" => self.degrees = true,
                "radians" => self.degrees = false,
                _ => {}
            }
            return Ok(());
        }
        let number = value(first).filter(|number| number.is_finite());
        if let (Some(number), None) = (number, words.next()) {
            return self.begin(number, row);
        }
        if self.frames.is_empty() {
            let message = format!("`{first:.40}` stands before the number of the first frame");
            return Err(Error::new("amc/grammar", message).at(row.place()));
        }
        if !self.open {
            return Ok(());
        }
        self.bone(first, row)
    }

    fn begin(&mut self, number: f64, row: &Row<'_>) -> Result<(), Error> {
        self.close();
        if let Some(before) = self.written.replace(number) {
            if number == before {
                self.warnings.add("amc/repeated", || {
                    let message = format!("frame {number} comes twice: the first counts");
                    Diagnostic::warning("amc/repeated", message).at(row.place())
                });
                return Ok(());
            }
            if number < before {
                self.shift += before + 1.0 - number;
                self.warnings.add("amc/back", || {
                    let message = format!("frame {number} follows {before}: it is counted on");
                    Diagnostic::warning("amc/back", message).at(row.place())
                });
            } else if number > before + 1.0 {
                self.warnings.add("amc/missing-frames", || {
                    let message = format!("frames between {before} and {number} are missing");
                    let help = "their times are left out";
                    Diagnostic::warning("amc/missing-frames", message)
                        .at(row.place())
                        .with_help(help)
                });
            }
        }
        let width = self.figure.model.stored_len();
        // Frames that leave nearly all out would take more memory than the file is large.
        if self.frames.len().saturating_mul(width) > 2 * self.cells + (1 << 20) {
            let message = format!("{} frames hold only {} numbers", self.frames.len(), self.cells);
            return Err(Error::new("amc/short-frames", message).at(row.place()));
        }
        let before = self.frames.last().cloned();
        self.frames.push(before.unwrap_or_else(|| self.figure.model.defaults()));
        self.numbers.push(number + self.shift);
        self.open = true;
        self.has.fill(false);
        Ok(())
    }

    fn bone(&mut self, name: &str, row: &Row<'_>) -> Result<(), Error> {
        let Some(places) = self.figure.places.get(&name.to_ascii_lowercase()) else {
            if !self.unknown.iter().any(|known| known == name) && self.unknown.len() < 1000 {
                self.unknown.push(name.to_owned());
            }
            return Ok(());
        };
        let Some(frame) = self.frames.last_mut() else { return Ok(()) };
        let angle = if self.degrees { 1f64.to_radians() } else { 1.0 };
        let mut count = 0;
        for word in row.words().skip(1) {
            count += 1;
            let Some(Some((place, is_angle))) = places.get(count - 1) else { continue };
            let number = value(word).ok_or_else(|| {
                let message = format!("`{word:.40}` is no number");
                Error::new("amc/number", message).at(row.line.place_of(word))
            });
            let number = match number {
                Ok(number) if number.is_finite() => number,
                Err(error) if crate::text::cell(word).is_none() => return Err(error),
                // Not a number: the number of the frame before stays.
                _ => continue,
            };
            let factor = if *is_angle { angle } else { self.figure.unit };
            if let (Some(stored), Some(has)) = (frame.get_mut(*place), self.has.get_mut(*place)) {
                *stored = number * factor;
                *has = true;
            }
            self.cells += 1;
        }
        if name.eq_ignore_ascii_case("root") {
            let position = self.figure.position.to_array();
            for (place, axis) in &self.figure.steps {
                if let Some(stored) = frame.get_mut(*place).filter(|_| self.has[*place]) {
                    *stored += position[*axis];
                }
            }
        }
        if count != places.len() {
            self.warnings.add("amc/row-length", || {
                let message = format!("`{name}` has {count} numbers of {}", places.len());
                Diagnostic::warning("amc/row-length", message).at(row.place())
            });
        }
        Ok(())
    }

    /// Ends the open frame.
    fn close(&mut self) {
        if std::mem::replace(&mut self.open, false) {
            self.kept += self.has.iter().filter(|has| !**has).count();
        }
    }

    fn finish(mut self, assumed: &Assumed) -> Result<Motion, Error> {
        self.close();
        if self.frames.is_empty() {
            let message = "there is no frame";
            let help = "a frame is a line with its number, and a line for each bone";
            return Err(Error::new("amc/no-frame", message).with_help(help));
        }
        if self.kept > 0 {
            let message = format!("{} numbers of bones are left out by their frames", self.kept);
            let said = Diagnostic::warning("amc/missing", message);
            self.warnings.push(said.with_help("they keep those of the frame before"));
        }
        if !self.unknown.is_empty() {
            let message = format!("the skeleton has no {}", listed(&self.unknown));
            let said = Diagnostic::warning("amc/unknown", message);
            self.warnings.push(said.with_help("these rows are left out: is it another skeleton?"));
        }
        let rate = assumed.rate.unwrap_or(USUAL_RATE);
        if assumed.rate.is_none() {
            let message = format!("the rate is not stated: taken as {USUAL_RATE} frames a second");
            let said = Diagnostic::warning("amc/rate", message);
            self.warnings.push(said.with_help("give it with --frame-rate"));
        }
        let first = self.numbers.first().copied().unwrap_or(0.0);
        let times = self.numbers.iter().map(|number| (number - first) / rate).collect();
        Ok(Motion { times, frames: self.frames })
    }
}
