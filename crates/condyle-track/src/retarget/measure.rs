//! How near the target comes.

use super::body::Part;
use super::question::{Plan, foot_points};
use super::sampled::Sampled;
use super::stance::unit;
use super::{Humanoid, Options, Posed};
use condyle_math::{Quat, Vec3};
use condyle_model::{CoordinateId, CoordinateKind, Program, SegmentId};
use condyle_motion::Motion;
use std::collections::BTreeSet;
use std::ops::Range;

/// How far a part is off, over all frames, in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The part by its name, or `trunk`: the line from between the hips to between the shoulders as these rest on the
    /// chest; where one of the figures has no two of these to the neck.
    pub name: String,
    /// Whether it is a line that points somewhere; else an orientation.
    pub line: bool,
    /// The mean angle.
    pub mean: f64,
    /// The angle that 95 % of the frames are below.
    pub most: f64,
    /// The mean over the frames in which nothing that moves the part is at a limit; not a number where there is
    /// none.
    pub inside: f64,
    /// The share of these frames.
    pub share: f64,
}

/// How far points of feet move while they stand, in metres: from where each stand began, along the ground.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Sliding {
    /// How many stands of ankles and balls of the feet.
    pub stands: usize,
    /// The median and the largest, in the source.
    pub source: [f64; 2],
    /// The same in the target.
    pub target: [f64; 2],
    /// The largest excess of the target's over the source's.
    pub excess: f64,
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Lines and orientations, in the order of the parts.
    pub fits: Vec<Fit>,
    /// Parts that the source has and the target has not, and the other way round.
    pub unmatched: [Vec<Part>; 2],
    /// The number of frames.
    pub frames: usize,
    /// Coordinates that are at a limit, with the number of frames, most first; none without limits.
    pub limited: Vec<(String, usize)>,
    /// The target's size by the source's.
    pub size: f64,
    /// Feet that stand.
    pub sliding: Sliding,
}

/// Nearer than this to a limit is at it, in radians or metres.
const AT: f64 = 1e-6;

pub(super) fn report(
    target: Humanoid<'_>,
    plan: &Plan,
    sampled: &Sampled,
    motion: &Motion,
    options: Options,
) -> Report {
    let mut posed = Posed::new(target.model);
    let program = Program::compile(target.model);
    let rows = if options.limits { program.limit_row_len() } else { 0 };
    let mut lines: Vec<Vec<f64>> = vec![vec![]; plan.lines.len()];
    let mut turns: Vec<Vec<f64>> = vec![vec![]; plan.turns.len()];
    let points = foot_points(target, sampled);
    let mut places: Vec<Vec<Vec3>> = vec![vec![]; points.len()];
    let bounds = bounds(target, options);
    // For each frame the directions that a limit holds, and for each coordinate in how many frames.
    let mut held: Vec<BTreeSet<u32>> = vec![];
    let mut counts = vec![0_usize; target.model.coordinates().len()];
    for (frame, stored) in motion.frames.iter().enumerate() {
        let Ok(pose) = posed.at(stored) else { continue };
        let mut here = BTreeSet::new();
        for &(id, lower, upper) in &bounds {
            let value = target.model.value(pose.effective(), id);
            if value < lower + AT || value > upper - AT {
                here.extend(target.model.tangent_range(id).map(|direction| direction as u32));
            }
        }
        for row in (0..rows).filter(|row| pose.limit_row(*row) < AT) {
            here.extend(program.limit_row_directions(row).iter().map(|(d, _)| *d));
        }
        for id in target.model.coordinate_ids() {
            if target.model.tangent_range(id).any(|d| here.contains(&(d as u32))) {
                counts[id.index()] += 1;
            }
        }
        held.push(here);
        for (line, angles) in plan.lines.iter().zip(&mut lines) {
            let along = unit(line.to.placed(pose) - line.from.placed(pose));
            angles.push(angle(along, line.wanted[frame]));
        }
        for (turn, angles) in plan.turns.iter().zip(&mut turns) {
            let axes = crate::target::rotation_of(pose.segment(turn.segment).linear);
            angles.push(Quat::from_mat3(axes).angle_to(turn.wanted[frame]));
        }
        for ((_, _, anchor), places) in points.iter().zip(&mut places) {
            places.push(anchor.placed(pose));
        }
    }
    // A part is at a limit where a joint between it and the root is.
    let limited = |segment: SegmentId| -> Vec<bool> {
        let own = program.segment_directions(segment);
        held.iter().map(|held| own.iter().any(|(d, _)| held.contains(d))).collect()
    };
    let lines = plan.lines.iter().zip(lines).map(|(line, angles)| {
        // Hands and fingers follow what is turned; collar bones are asked for by their lines alone.
        let whole = line.weight > 0.2;
        (whole, fit(&line.name, true, angles, &limited(line.to.segment)))
    });
    let told = |part: Part| matches!(part, Part::Pelvis | Part::Chest | Part::Head | Part::Hand(_));
    let turns = plan.turns.iter().zip(turns).map(|(turn, angles)| {
        (told(turn.part), fit(&turn.part.name(), false, angles, &limited(turn.segment)))
    });
    let fits = lines.chain(turns).filter(|(told, _)| *told).map(|(_, fit)| fit).collect();
    let slides: Vec<[f64; 2]> = points
        .iter()
        .zip(&places)
        .flat_map(|((_, part, _), own)| {
            let runs = sampled.stands.get(part).map_or(&[][..], Vec::as_slice);
            let theirs = sampled.placed.get(part).map_or(&[][..], Vec::as_slice);
            runs.iter().map(move |run| [theirs, own].map(|of| slid(of, run, sampled.up)))
        })
        .collect();
    let ids = target.model.coordinate_ids().zip(&counts).filter(|(_, count)| **count > 0);
    let mut named: Vec<(String, usize)> =
        ids.map(|(id, count)| (target.model.coordinate_key(id), *count)).collect();
    named.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let spread = |which: usize| {
        let mut all: Vec<f64> = slides.iter().map(|both| both[which]).collect();
        all.sort_by(f64::total_cmp);
        [all.get(all.len() / 2).copied().unwrap_or(0.0), all.last().copied().unwrap_or(0.0)]
    };
    Report {
        fits,
        unmatched: plan.unmatched.clone(),
        frames: motion.frames.len(),
        limited: named,
        size: sampled.size,
        sliding: Sliding {
            stands: slides.len(),
            source: spread(0),
            target: spread(1),
            excess: slides.iter().map(|[a, b]| b - a).fold(0.0, f64::max),
        },
    }
}

/// The angle between two directions, from its sine and cosine.
fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// How far a point goes from where it began, along the ground.
fn slid(places: &[Vec3], run: &Range<usize>, up: Vec3) -> f64 {
    let Some(&first) = places.get(run.start) else { return 0.0 };
    let away = places.get(run.clone()).unwrap_or_default().iter().map(|place| {
        let way = *place - first;
        (way - up * up.dot(way)).norm()
    });
    away.fold(0.0, f64::max)
}

fn fit(name: &str, line: bool, angles: Vec<f64>, limited: &[bool]) -> Fit {
    let mean = |sum: (f64, usize)| sum.0 / sum.1 as f64;
    let add = |(sum, count): (f64, usize), angle: &f64| (sum + angle, count + 1);
    let inside = angles.iter().zip(limited).filter(|(_, limited)| !**limited);
    let within = inside.map(|(angle, _)| angle).fold((0.0, 0), add);
    let (inside, share) = (mean(within), within.1 as f64 / angles.len().max(1) as f64);
    let all = mean(angles.iter().fold((0.0, 0), add));
    let mut sorted = angles;
    sorted.sort_by(f64::total_cmp);
    let most = sorted.get(sorted.len() * 95 / 100).copied().unwrap_or(0.0);
    Fit { name: name.to_owned(), line, mean: all, most, inside, share }
}

/// The ranges of coordinates that the question moves, where limits hold.
fn bounds(target: Humanoid<'_>, options: Options) -> Vec<(CoordinateId, f64, f64)> {
    if !options.limits {
        return vec![];
    }
    let model = target.model;
    let free = model.coordinate_ids().filter(|&id| {
        let coordinate = model.coordinate(id);
        !coordinate.locked
            && coordinate.follows.is_none()
            && coordinate.kind == CoordinateKind::Rotation
    });
    free.map(|id| {
        let (lower, upper) = model.coordinate(id).range.bounds();
        (id, lower, upper)
    })
    .collect()
}
