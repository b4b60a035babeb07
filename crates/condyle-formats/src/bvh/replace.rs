//! A file with other numbers where its motion was changed.

use super::hierarchy::{self, Words};
use super::read::{resting, skeleton, stored};
use super::rows;
use crate::skeleton::{Assumed, length_unit};
use crate::text::{decode, lines};
use condyle_diagnostics::{Error, Warnings};
use condyle_motion::Motion;
use std::fmt::Write;

/// A number that differs by less, in radians or metres, is that of the file.
const SAME: f64 = 1e-12;

/// The text of a BVH file with another motion of its skeleton: the hierarchy stays to the letter, and of the rows each
/// number whose coordinate is the same.
///
/// `assumed` is what the motion was read with; it has as many frames as the file.
///
/// # Errors
/// What [`from_bytes_with`](super::from_bytes_with) refuses; `bvh/frames` if the motion is not of this file.
///
/// ```
/// use condyle_formats::{bvh, skeleton::Assumed};
/// let text = "HIERARCHY\nROOT arm {\n OFFSET 0 0 0\n CHANNELS 2 Zrotation Xrotation\n End Site { OFFSET 0 -1 0 } }\n\
///             MOTION\nFrames: 2\nFrame Time: 0.5\n30 1.50\n60 2.50\n";
/// let mut motion = bvh::from_bytes(text.as_bytes())?.value.motion;
/// motion.frames[1][0] = 45f64.to_radians();
/// let other = bvh::with_motion(text.as_bytes(), &Assumed::default(), &motion)?;
/// assert!(other.starts_with(&text[..text.find("Frames").unwrap()]));
/// assert!(other.ends_with("30 1.5\n45 2.5\n"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn with_motion(bytes: &[u8], assumed: &Assumed, motion: &Motion) -> Result<String, Error> {
    let decoded = decode(bytes)?.value;
    // What is odd in the file was said when it was read.
    let mut warnings = Warnings::default();
    let mut words = Words::new(lines(&decoded));
    let (joints, has_motion) = hierarchy::read(&mut words, &mut warnings)?;
    let at_rest: Vec<f64> = joints.iter().flat_map(resting).collect();
    let (first, rest) = words.into_lines();
    if !has_motion {
        return Err(Error::new("bvh/frames", "there is no MOTION in the file"));
    }
    let head = first.map_or(decoded.len(), |line| line.start);
    let rows = rows::read(first, rest, &at_rest, &mut warnings)?;
    let unit = length_unit(&skeleton(&joints, &mut warnings), assumed, &mut warnings);
    let stored = stored(&joints, &rows, unit, &mut warnings);
    let fits = motion.frames.iter().all(|frame| frame.len() == stored.len());
    if motion.frames.len() != rows.frames.len() || !fits {
        let message = format!("the motion is not one of the {} frames", rows.frames.len());
        return Err(Error::new("bvh/frames", message));
    }
    let mut text = decoded.get(..head).unwrap_or_default().trim_end().to_owned();
    let _ = write!(text, "\nFrames: {}\nFrame Time: {}\n", rows.frames.len(), rows.frame_time);
    for (mut row, frame) in rows.frames.into_iter().zip(&motion.frames) {
        for (stored, &value) in stored.iter().zip(frame) {
            let Some(number) = row.get_mut(stored.column) else { continue };
            if (stored.value(*number) - value).abs() > SAME {
                *number = stored.number(value);
            }
        }
        for (column, number) in row.iter().enumerate() {
            let _ = write!(text, "{}{number}", if column > 0 { " " } else { "" });
        }
        text.push('\n');
    }
    Ok(text)
}
