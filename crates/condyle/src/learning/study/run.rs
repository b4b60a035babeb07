//! One person with one kind of skin: from a standing trial to laws.

use super::Plan;
use crate::learning::arms::{Seen, best};
use crate::learning::coupling::tracked;
use crate::tracking::Request;
use condyle_diagnostics::Error;
use condyle_learn::arms::{Centre, Leg, Sizes};
use condyle_learn::calibration::FreeJoint;
use condyle_learn::coupling::{Groups, Laws, Samples, Scope, Settings, learn};
use condyle_learn::study::{BestLinear, Kind, Person, Skin};
use condyle_model::{CoordinateId, Model};
use condyle_motion::Recording;

/// The coordinates of the knee: angles, then places.
pub(super) const ANGLES: [&str; 3] = ["knee_r_flexion", "knee_r_adduction", "knee_r_rotation"];
pub(super) const PLACES: [&str; 3] = ["knee_r_tx", "knee_r_ty", "knee_r_tz"];

/// What was learned from one person's gaits or crouches.
#[derive(Clone, Debug)]
pub struct Learned {
    /// The laws of the three places.
    pub laws: Laws,
    /// What other kinds of knees take from the same frames.
    pub centre: Centre,
    /// The linear laws nearest to the truth on the same frames.
    pub truth: Vec<BestLinear>,
    /// The slope of each place over flexion alone, whatever the other angles do meanwhile, as tracked and as it is true, in
    /// metres per radian: of a knee whose angles all follow flexion that alone is determined.
    pub along: [[f64; 3]; 2],
    /// The mean over frames of the distance between the centre that tracking found and that of the laws, in metres (Table 2 of
    /// Pronost et al. 2010).
    pub deviation: f64,
    /// The same by a law for each variety of the motion, where there are several.
    pub deviation_by_variety: Option<f64>,
    /// The root mean square over frames of how far angles that tracking found are from those of the bones, in radians.
    pub angle_errors: [f64; 3],
    /// The mean over frames of the root mean square of markers that the free knee leaves, in metres.
    pub left: f64,
    /// Frames that are used, and frames that were tracked badly.
    pub frames: [usize; 2],
}

/// One person with one kind of skin.
#[derive(Clone, Debug)]
pub struct Run {
    /// Which person, from 0.
    pub person: usize,
    /// Their skin.
    pub skin: Skin,
    /// The model whose knee is free.
    pub free: Model,
    /// The sizes of the thigh in the standing trial.
    pub sizes: Sizes,
    /// Laws of gaits and of crouches.
    pub learned: [Learned; 2],
    /// Some of the frames of crouches: the angles in radians, and how far the centre is from that of the law, in metres.
    pub cloud: Vec<([f64; 3], f64)>,
    /// Knees compared on trials that no law has seen.
    pub unseen: Vec<super::Followed>,
}

/// The best constant centre is sought over so many frames.
const FEW: usize = 200;
/// At most so many frames are kept for the figure.
const CLOUD: usize = 3000;

/// The coordinates of a knee that are meant, angles first.
pub(super) fn meant(model: &Model) -> Result<Vec<CoordinateId>, Error> {
    ANGLES.iter().chain(&PLACES).map(|name| model.find_coordinate(name)).collect()
}

/// Learns from a person's trials.
pub(super) fn run(
    plan: &Plan,
    person: &Person,
    index: usize,
    skin: Skin,
    step: &mut (dyn FnMut() + Send),
) -> Result<Run, Error> {
    let trials = &plan.trials;
    let (joint, standing) = (FreeJoint::knee_pronost2010(), trials.standing(person).recording);
    let free = joint.model(&standing)?;
    let sizes =
        Sizes::of(&joint, &standing).unwrap_or(Sizes { length: person.thigh, width: person.width });
    let coordinates = meant(&free)?;
    let leg = Leg::of(&free, "knee_r")?;
    let request = Request { threads: plan.threads, ..Request::default() };
    let columns: Vec<String> = ANGLES.iter().chain(&PLACES).map(|c| (*c).to_owned()).collect();
    let gathered =
        |gait: bool, step: &mut (dyn FnMut() + Send)| -> Result<(Samples, Learned), Error> {
            let mut samples = Samples { columns: columns.clone(), trials: vec![] };
            let mut truth: Vec<[f64; 6]> = vec![];
            let mut errors = [0.0; 3];
            let (mut compared, mut left, mut bad_frames) = (0usize, 0.0, 0);
            let mut wanted = trials.wanted(false);
            wanted.retain(|(kind, _)| (*kind == Kind::Gait) == gait);
            let mut few = Recording::default();
            let each = FEW.div_ceil(wanted.len().max(1));
            for (kind, number) in wanted {
                let take = plan.take(person, (kind, number), false, skin)?;
                let (rows, bad, rms) =
                    tracked(&free, &coordinates, &take.recording, &request, &mut |_, _| {})?;
                let frames = rows.len() / columns.len();
                if bad == 0 {
                    for (row, truth) in rows.chunks_exact(columns.len()).zip(&take.truth) {
                        for angle in 0..3 {
                            errors[angle] += (row[angle] - truth[angle]).powi(2);
                        }
                    }
                    compared += frames;
                }
                left += rms.unwrap_or(0.0) * frames as f64;
                bad_frames += bad;
                samples.add(&take.name, Groups::of_name(&take.name), &rows, bad);
                add_few(&mut few, &take.recording, each);
                truth.extend(take.truth);
                step();
            }
            let laws = learn(&samples, &[], &[0, 1, 2], &[3, 4, 5], &Settings::default())?;
            let frames = samples.frames();
            let along = |rows: &mut dyn Iterator<Item = &[f64]>| {
                let rows: Vec<&[f64]> = rows.collect();
                [3, 4, 5].map(|place| slope(&rows, place))
            };
            let tracked_rows = samples.trials.iter();
            let mut tracked_rows = tracked_rows.flat_map(|t| t.values.chunks_exact(columns.len()));
            let mut centre = Centre::from_laws(&laws, [3, 4, 5].map(|c| mean(&samples.column(c))))?;
            let seen = [Seen { leg: &leg, recording: few, factors: [1.0; 3] }];
            centre.best = Some(best(&seen, centre.mean, &request)?);
            let learned = Learned {
                centre,
                along: [along(&mut tracked_rows), along(&mut truth.iter().map(|row| &row[..]))],
                truth: (0..3).map(|place| BestLinear::of(&truth, place)).collect(),
                deviation: mean(&deviations(&samples, &laws, None)),
                deviation_by_variety: by_variety(&samples, &laws),
                angle_errors: errors.map(|sum| (sum / compared.max(1) as f64).sqrt()),
                left: left / frames.max(1) as f64,
                frames: [frames, bad_frames],
                laws,
            };
            Ok((samples, learned))
        };
    let (_, gait) = gathered(true, step)?;
    let (samples, crouch) = gathered(false, step)?;
    let far = deviations(&samples, &crouch.laws, None);
    let rows = samples.trials.iter().flat_map(|trial| trial.values.chunks_exact(columns.len()));
    let every = far.len().div_ceil(CLOUD).max(1);
    let cloud = rows.zip(far).step_by(every);
    let cloud = cloud.map(|(row, far)| ([row[0], row[1], row[2]], far)).collect();
    Ok(Run { person: index, skin, free, sizes, learned: [gait, crouch], cloud, unseen: vec![] })
}

/// Adds some frames of a recording, evenly spaced, to those of others with the same labels.
fn add_few(few: &mut Recording, more: &Recording, count: usize) {
    if few.labels.is_empty() {
        *few = Recording { times: vec![], positions: vec![], ..more.clone() };
    }
    for k in 0..count.min(more.frames()) {
        few.positions.extend_from_slice(more.frame(k * more.frames() / count));
        few.times.push(few.times.len() as f64 / few.rate);
    }
}

/// How far the centre is from that of laws, frame by frame; of the laws of one variety on its own trials.
fn deviations(samples: &Samples, laws: &Laws, variety: Option<&str>) -> Vec<f64> {
    let width = samples.columns.len();
    let coefficients: Vec<Vec<f64>> = laws
        .laws
        .iter()
        .filter_map(|law| match variety {
            None => Some([&[law.intercept], &law.coefficients[..]].concat()),
            Some(name) => law
                .scoped
                .iter()
                .find(|scoped| scoped.scope == Scope::SubMotion && scoped.name == name)
                .map(|scoped| scoped.coefficients.clone()),
        })
        .collect();
    if coefficients.len() < 3 {
        return vec![];
    }
    let trials = samples.trials.iter();
    let trials = trials.filter(|t| variety.is_none_or(|name| t.groups.sub_motion == name));
    let rows = trials.flat_map(|trial| trial.values.chunks_exact(width));
    rows.map(|row| {
        let square = |place: usize| {
            let c = &coefficients[place];
            (c[0] + c[1] * row[0] + c[2] * row[1] + c[3] * row[2] - row[3 + place]).powi(2)
        };
        (square(0) + square(1) + square(2)).sqrt()
    })
    .collect()
}

fn by_variety(samples: &Samples, laws: &Laws) -> Option<f64> {
    let mut names: Vec<&str> =
        samples.trials.iter().map(|t| t.groups.sub_motion.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let all: Vec<f64> =
        names.iter().flat_map(|name| deviations(samples, laws, Some(name))).collect();
    (names.len() > 1 && !all.is_empty()).then(|| mean(&all))
}

/// The slope of a column over the first.
fn slope(rows: &[&[f64]], column: usize) -> f64 {
    let n = rows.len().max(1) as f64;
    let mean = |c: usize| rows.iter().map(|row| row[c]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(column));
    let both: f64 = rows.iter().map(|row| (row[0] - x) * (row[column] - y)).sum();
    both / rows.iter().map(|row| (row[0] - x).powi(2)).sum::<f64>()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
