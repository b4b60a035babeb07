//! AMC written: the frames of a motion as a take of its skeleton.

use super::figure::{Figure, figure};
use crate::skeleton::Assumed;
use crate::text::decimal;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_motion::Motion;
use std::fmt::Write as _;

/// Writes a motion of a skeleton as a take: a line a bone in the order of the hierarchy, its numbers in the order of
/// the bone's `dof`.
///
/// The motion is one of the model that [`read`](super::read) makes of the same bytes with the same [`Assumed`].
/// Angles are in degrees or radians as the skeleton has them, lengths in its unit, and numbers have as many digits as tell
/// them apart. Frames are numbered by their times; the format has no place for the rate.
///
/// # Warnings
/// `amc/rate` with the rate that a reader must be told, where it is not 120 frames a second; `amc/times` where frames are
/// not at even times, to which theirs are brought.
///
/// # Errors
/// `amc/width` if frames do not have the model's numbers, `amc/no-frame`, `amc/not-finite`; those of
/// [`read`](super::read) for the skeleton.
///
/// ```
/// use condyle_formats::{asf, skeleton::Assumed};
/// let skeleton = b":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n position 0 1 0\n:bonedata\n\
///     begin\n name femur\n direction 0 -1 0\n length 7\n dof rz rx\n end\n:hierarchy\n begin\n root femur\n end\n";
/// let assumed = Assumed { rate: Some(60.0), ..Assumed::default() };
/// let take = b":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 4.5 0 0 0 0\nfemur 90 -45\n";
/// let read = asf::with_skeleton(take, skeleton, &assumed)?.value;
/// let written = asf::write(&read.motion, skeleton, &assumed)?.value;
/// assert!(written.ends_with("femur 90 -45\n"), "{written}");
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(motion: &Motion, skeleton: &[u8], assumed: &Assumed) -> Result<Read<String>, Error> {
    let figure = figure(skeleton, assumed)?.value;
    let mut warnings = Warnings::default();
    let width = figure.model.stored_len();
    if motion.frames.is_empty() {
        return Err(Error::new("amc/no-frame", "the motion has no frame"));
    }
    for (number, frame) in motion.frames.iter().enumerate() {
        if frame.len() != width {
            let message =
                format!("frame {number} has {} numbers, the skeleton {width}", frame.len());
            let help = "a take is written of a motion of the same skeleton";
            return Err(Error::new("amc/width", message).with_help(help));
        }
        if let Some(place) = frame.iter().position(|value| !value.is_finite()) {
            let message = format!("number {place} of frame {number} is not finite");
            return Err(Error::new("amc/not-finite", message));
        }
    }
    let unit = if figure.degrees { "DEGREES" } else { "RADIANS" };
    let mut text = format!(":FULLY-SPECIFIED\n:{unit}\n");
    for (number, frame) in numbers(&motion.times, &mut warnings).zip(&motion.frames) {
        let _ = writeln!(text, "{number}");
        for bone in &figure.order {
            line(&mut text, &figure, bone, frame);
        }
    }
    Ok(Read { value: text, warnings: warnings.finish() })
}

/// The numbers of a bone; nothing for one without a dof.
fn line(text: &mut String, figure: &Figure, bone: &str, frame: &[f64]) {
    let Some(places) = figure.places.get(&bone.to_ascii_lowercase()) else { return };
    if places.is_empty() {
        return;
    }
    text.push_str(bone);
    let position = figure.position.to_array();
    for place in places {
        let number = match place {
            // A second `l` is none.
            None => 0.0,
            Some((place, is_angle)) => {
                let stored = frame.get(*place).copied().unwrap_or(0.0);
                let step = figure.steps.iter().find(|(step, _)| step == place);
                match (is_angle, step) {
                    (true, _) if figure.degrees => as_read(stored, 1f64.to_radians(), 0.0),
                    (true, _) => stored,
                    (false, Some((_, axis))) => as_read(stored, figure.unit, position[*axis]),
                    (false, None) => as_read(stored, figure.unit, 0.0),
                }
            }
        };
        text.push(' ');
        text.push_str(&decimal(number));
    }
    text.push('\n');
}

/// The number that a reader makes a stored one of, `number * factor + offset`: of the neighbours of the quotient the one
/// with the fewest digits that gives the very same, else the nearest.
fn as_read(stored: f64, factor: f64, offset: f64) -> f64 {
    let near = (stored - offset) / factor;
    // What was written with a dozen digits is found again.
    let short = format!("{near:.12e}").parse::<f64>().unwrap_or(near);
    let tried = [short, near, near.next_up(), near.next_down()];
    let off = |number: &f64| (number * factor + offset - stored).abs();
    let exact = tried.iter().find(|number| off(number) == 0.0);
    exact.copied().unwrap_or(near)
}

/// The number of each frame, the first of which is 1.
fn numbers<'t>(times: &'t [f64], warnings: &mut Warnings) -> impl Iterator<Item = u64> + 't {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.retain(|step| step.is_finite() && *step > 0.0);
    steps.sort_by(f64::total_cmp);
    let step = steps.get(steps.len() / 2).copied().unwrap_or(1.0 / super::take::USUAL_RATE);
    let rate = 1.0 / step;
    if (rate - super::take::USUAL_RATE).abs() > 1e-3 * super::take::USUAL_RATE {
        // Times have few digits in most files.
        let rate = if (rate - rate.round()).abs() < 1e-4 * rate { rate.round() } else { rate };
        let message = format!("takes do not state their rate, which is {rate} frames a second");
        let help = format!("tell it to who reads this file (--frame-rate {rate})");
        warnings.push(Diagnostic::note("amc/rate", message).with_help(help));
    }
    let first = times.first().copied().unwrap_or(0.0);
    let off = |time: f64| {
        let frames = (time - first) / step;
        (frames - frames.round()).abs()
    };
    let uneven = times.iter().filter(|time| off(**time) > 0.1).count();
    if uneven > 0 {
        let message = format!("{uneven} of {} frames are not at even times", times.len());
        let help = "they are numbered by the nearest; `condyle upkeep --rate` resamples before";
        warnings.push(Diagnostic::warning("amc/times", message).with_help(help));
    }
    let mut last = 0u64;
    times.iter().map(move |time| {
        // A cast of what is negative or no number is 0.
        let number = ((time - first) / step).round().min(1e12) as u64 + 1;
        last = number.max(last + 1);
        last
    })
}
