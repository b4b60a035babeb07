//! From bytes to a skeleton and its motion.

use super::body;
use super::layout::{Arrays, Layout, layout};
use super::rest::Rest;
use crate::skeleton::{Assumed, Place};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::UpAxis;
use condyle_motion::{Animation, Motion};
use std::f64::consts::FRAC_PI_2;

/// Taken where a file does not say how many frames are in a second.
const USUAL_RATE: f64 = 30.0;
/// A motion takes at most so many times the file's size ...
const MOTION_PER_BYTE: usize = 5;
/// ... and this many bytes: with what is inflated no more than 8 times the file and 64 MB.
const MOTION_BASE: usize = 36 << 20;
/// At most so many frames are looked at for the axis that points up.
const LOOKED_AT: usize = 301;
/// The pelvis is upright where its own y points along an axis on average by that much.
const UPRIGHT: f64 = 0.5;
/// Farther than that many units from where it begins nobody walks in metres.
const FAR: f64 = 100.0;

/// Reads poses for a body; what they do not state is guessed.
///
/// # Errors
/// As [`from_bytes_with`].
pub fn from_bytes(bytes: &[u8], rest: &Rest) -> Result<Read<Animation>, Error> {
    from_bytes_with(bytes, rest, &Assumed::default())
}

/// Reads poses for a body, with what is known of them.
///
/// Frames are at rest of [`Rest`] turned by the rotation of each joint, the motion turned so that y is up. A
/// quaternion is that of the two signs that is nearer to the one of the frame before.
///
/// # Errors
/// `smpl/archive` of what is no archive, `smpl/array` of arrays that do not fit, `smpl/objects` of those that are
/// pickled, `smpl/no-poses`, `smpl/body` of a body without poses, `smpl/rest` of places that are not known,
/// `smpl/size`.
pub fn from_bytes_with(
    bytes: &[u8],
    rest: &Rest,
    assumed: &Assumed,
) -> Result<Read<Animation>, Error> {
    let mut warnings = Warnings::default();
    let mut arrays = Arrays::open(bytes)?;
    if body::is_body(bytes) {
        let message = "the file holds a body, no poses";
        return Err(Error::new("smpl/no-poses", message).with_help("give it with --model"));
    }
    let layout = layout(&mut arrays, &mut warnings)?;
    told(&layout, rest, &mut warnings);
    let (skeleton, places, said) = rest.skeleton(layout.tree, &layout.betas)?;
    warnings.extend(said.into_iter().collect());
    let read = skeleton.build()?;
    warnings.extend(read.warnings);
    let pelvis = match rest.is_body() {
        true => places.first().copied().unwrap_or(Vec3::ZERO),
        false => Vec3::ZERO,
    };
    let mut motion = frames(bytes.len(), &layout, pelvis, assumed, &mut warnings)?;
    let turn = up(&motion, &layout, assumed, &mut warnings);
    turned(&mut motion, turn);
    let value = Animation { model: read.value, motion };
    Ok(Read { value, warnings: warnings.finish() })
}

/// What the file says it is, and what is not known of the body.
fn told(layout: &Layout<'_>, rest: &Rest, warnings: &mut Warnings) {
    let tree = layout.tree;
    let gender = layout.gender.as_ref().map_or(String::new(), |word| format!(", {word}"));
    let betas = match layout.betas.len() {
        0 => String::new(),
        count => format!(", {count} betas"),
    };
    let message = format!("{}: {} joints{gender}{betas}", tree.title(), tree.len());
    warnings.push(Diagnostic::note("smpl/layout", message));
    if rest.is_body() {
        if layout.betas.len() > rest.shapes() {
            let message = format!(
                "of {} betas the body knows {}: the others are left out",
                layout.betas.len(),
                rest.shapes()
            );
            warnings.push(Diagnostic::warning("smpl/betas", message));
        }
        return;
    }
    let message = format!(
        "the file does not say where joints are: they are those of {}, not of the person (some centimetres), and \
         the pelvis is put at `trans` (in a body of SMPL it is beside it by some decimetres)",
        rest.name()
    );
    let help = "give the body with --model: one of SMPL (.npz), or any model whose bones have names that are known";
    warnings.push(Diagnostic::warning("smpl/rest", message).with_help(help));
}

/// Places of the pelvis and rotations of all joints, along the axes of the file.
fn frames(
    size: usize,
    layout: &Layout<'_>,
    pelvis: Vec3,
    assumed: &Assumed,
    warnings: &mut Warnings,
) -> Result<Motion, Error> {
    let joints = layout.tree.len();
    let stored = 3 + 4 * joints;
    let needed = layout.frames.saturating_mul(8 * (stored + 4));
    if needed > size.saturating_mul(MOTION_PER_BYTE).saturating_add(MOTION_BASE) {
        let message = format!("{} frames are too many for a file of {size} bytes", layout.frames);
        let help = "it is packed unusually well: split it, or store it without compression";
        return Err(Error::new("smpl/size", message).with_help(help));
    }
    let rate = layout.rate.or(assumed.rate).unwrap_or_else(|| {
        let message =
            format!("the file does not say how many frames are in a second: {USUAL_RATE}");
        let said = Diagnostic::warning("smpl/rate", message);
        warnings.push(said.with_help("give it with --frame-rate"));
        USUAL_RATE
    });
    let mut blocks = vec![];
    for block in &layout.blocks {
        blocks.push((block, block.rows()?));
    }
    let places = match &layout.places {
        Some(array) if array.shape.len() == 1 => Some(array.rows(None)?),
        Some(array) if array.shape.len() == 3 && array.shape.first() == Some(&1) => {
            Some(array.rows(1)?)
        }
        Some(array) => Some(array.rows(0)?),
        None => {
            let message = "the file holds no `trans`: the pelvis stays in place";
            warnings.push(Diagnostic::warning("smpl/places", message));
            None
        }
    };
    let mut before = vec![0.0; stored];
    for quaternion in before.get_mut(3..).unwrap_or_default().chunks_exact_mut(4) {
        quaternion[3] = 1.0;
    }
    let mut missing = 0usize;
    let mut improper = 0usize;
    let mut frames = Vec::with_capacity(layout.frames);
    for frame in 0..layout.frames {
        if let Some(rows) = &places {
            let row = frame.min(rows.count.saturating_sub(1));
            let place = [0, 1, 2].map(|axis| rows.get(row, axis));
            match place.iter().all(|x| x.is_finite()) {
                true => before[..3].copy_from_slice(&place),
                false => missing += 1,
            }
        }
        for (block, rows) in &blocks {
            let row = frame.min(rows.count.saturating_sub(1));
            for joint in 0..block.joints {
                let at = 3 + 4 * (block.first + joint);
                let Some(own) = before.get_mut(at..at + 4) else { continue };
                let number = |part: usize| match block.matrices {
                    true => rows.get(row, 9 * joint + part),
                    false => rows.get(row, 3 * joint + part),
                };
                let turn = match block.matrices {
                    false => Quat::exp(Vec3::new(number(0), number(1), number(2))),
                    true => {
                        let column = |c: usize| Vec3::new(number(c), number(3 + c), number(6 + c));
                        let matrix = Mat3::from_columns(column(0), column(1), column(2));
                        let (turn, off) = Place::turn(matrix);
                        improper += usize::from(off > 1e-3);
                        Quat::from_mat3(turn)
                    }
                };
                let numbers = turn.to_array();
                if !numbers.iter().all(|x| x.is_finite()) {
                    missing += 1;
                    continue;
                }
                let along: f64 = numbers.iter().zip(own.iter()).map(|(a, b)| a * b).sum();
                let sign = if along < 0.0 { -1.0 } else { 1.0 };
                for (kept, new) in own.iter_mut().zip(numbers) {
                    *kept = sign * new;
                }
            }
        }
        frames.push(before.clone());
    }
    if missing > 0 {
        let message = format!("{missing} rotations or places are no finite numbers");
        let help = "they keep those of the frame before";
        warnings.push(Diagnostic::warning("smpl/missing", message).with_help(help));
    }
    if improper > 0 {
        let message = format!("{improper} matrices are no rotations: the nearest ones are taken");
        warnings.push(Diagnostic::warning("smpl/matrices", message));
    }
    if places.is_some() {
        let unit = unit(&frames, layout, assumed, warnings) / layout.scale;
        for frame in &mut frames {
            for (axis, place) in frame.iter_mut().take(3).enumerate() {
                *place = *place * unit + pelvis.to_array()[axis];
            }
        }
    }
    let times = (0..frames.len()).map(|frame| frame as f64 / rate).collect();
    Ok(Motion { times, frames })
}

/// Metres in a unit of `trans`.
fn unit(
    frames: &[Vec<f64>],
    layout: &Layout<'_>,
    assumed: &Assumed,
    warnings: &mut Warnings,
) -> f64 {
    if let Some(metres) = assumed.metres_per_unit {
        return metres;
    }
    if layout.scale != 1.0 {
        let message = format!("places are divided by the `scaling` {} of the file", layout.scale);
        warnings.push(Diagnostic::note("smpl/scaling", message));
        return 1.0;
    }
    let Some(first) = frames.first() else { return 1.0 };
    let apart = |frame: &Vec<f64>| {
        let steps = frame.iter().zip(first).take(3).map(|(a, b)| (a - b).abs());
        steps.fold(0.0, f64::max)
    };
    let farthest = frames.iter().map(apart).fold(0.0, f64::max);
    if farthest > FAR {
        let message = format!("`trans` goes {farthest:.0} units far: they are taken as metres");
        let help = "give the unit with --length-unit (m, cm, mm)";
        warnings.push(Diagnostic::warning("smpl/unit", message).with_help(help));
    }
    1.0
}

/// The turn that makes y the axis that points up.
fn up(motion: &Motion, layout: &Layout<'_>, assumed: &Assumed, warnings: &mut Warnings) -> Quat {
    let turn = |angle: f64| Quat::from_axis_angle(Vec3::X, angle);
    match assumed.up {
        Some(UpAxis::Y) => return turn(0.0),
        Some(UpAxis::Z) => return turn(-FRAC_PI_2),
        None => {}
    }
    let every = motion.frames.len().div_ceil(LOOKED_AT).max(1);
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for frame in motion.frames.iter().step_by(every) {
        let Some(&[x, y, z, w]) = frame.get(3..7).and_then(|four| four.first_chunk::<4>()) else {
            continue;
        };
        sum += Quat { x, y, z, w }.to_mat3() * Vec3::Y;
        count += 1.0;
    }
    let mean = sum * (1.0 / f64::max(count, 1.0));
    let help = "give the axis with --up-axis (y or z)";
    let mut say = |severity: fn(&'static str, String) -> Diagnostic, message: String| {
        warnings.push(severity("skeleton/up", message).with_help(help));
    };
    let (note, warning) = (
        |code: &'static str, message: String| Diagnostic::note(code, message),
        |code: &'static str, message: String| Diagnostic::warning(code, message),
    );
    let points = |along: f64| format!("the pelvis is upright along {{}} ({along:.2} on average)");
    if mean.z >= UPRIGHT {
        let message = points(mean.z).replace("{}", "z");
        // That is what AMASS does, which tells the rate of the recording.
        let severity = if layout.recorded { note } else { warning };
        say(severity, format!("{message}: turned so that y is up"));
        return turn(-FRAC_PI_2);
    }
    if mean.y >= UPRIGHT {
        let message = format!("{}: y is up", points(mean.y).replace("{}", "y"));
        say(if layout.recorded { warning } else { note }, message);
        return turn(0.0);
    }
    if mean.y <= -UPRIGHT {
        let message = points(mean.y).replace("{}", "-y");
        say(warning, format!("{message}, as in a camera's view: turned so that y is up"));
        return turn(2.0 * FRAC_PI_2);
    }
    let which = if layout.recorded { "z, as in AMASS" } else { "y, as in SMPL's own space" };
    say(warning, format!("the pelvis is not upright along an axis: up is taken to be {which}"));
    turn(if layout.recorded { -FRAC_PI_2 } else { 0.0 })
}

/// Turns the whole motion.
fn turned(motion: &mut Motion, turn: Quat) {
    if turn.w == 1.0 {
        return;
    }
    let matrix = turn.to_mat3();
    for frame in &mut motion.frames {
        let Some(&[px, py, pz, x, y, z, w]) = frame.first_chunk::<7>() else { continue };
        let place = matrix * Vec3::new(px, py, pz);
        let own = turn * Quat { x, y, z, w };
        let numbers = place.to_array().into_iter().chain(own.to_array());
        for (kept, new) in frame.iter_mut().zip(numbers) {
            *kept = new;
        }
    }
}
