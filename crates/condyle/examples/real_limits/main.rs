//! Limits learned from real recordings, judged by others: the tables "Real recordings" of `docs/learned-limits.md`.
//!
//! `cargo run -p condyle --example real_limits -- FOLDER`, where the folder holds `shoulder/cmu01`, `shoulder/cmu02` and
//! `hip/right_hip_functional.c3d`. What it printed last is kept in `oracles/limits/real.md`.

mod simple;

use condyle::learn::limits;
use condyle::learn::limits::herda2003::{Histogram, Options, Placement, SphereLimit, Split};
use condyle::learn::limits::{Cloud, Field, SPACING, Settings, State, uniform};
use condyle::learning::{How, Take, Wanted, learn, take};
use condyle::math::{Quat, Vec3};
use condyle::{Mode, Pose, Program, open};
use simple::{Ball, Box, Random, beyond, quat_at};
use std::path::Path;

type Fault = std::boxed::Box<dyn std::error::Error>;

/// Takes of a joint of one person or of several.
struct Data {
    title: &'static str,
    /// The direction of the bone in the child's axes.
    bone: Vec3,
    takes: Vec<Take>,
}

fn main() -> Result<(), Fault> {
    let folder = std::env::args().nth(1).ok_or("give the folder of the recordings")?;
    let folder = Path::new(&folder);
    let cmu =
        |person: &str, takes: &[&str], joint: &str, reference: &str| -> Result<Vec<Take>, Fault> {
            let wanted = Wanted {
                joint: Some(joint.into()),
                reference: Some(reference.into()),
                ..Wanted::default()
            };
            let mut found = vec![];
            for name in takes {
                // Each subject has a skeleton of its own, found beside its takes.
                let path = folder.join(format!("shoulder/cmu{person}/{person}_{name}.amc"));
                found.push(take(&path, &wanted)?.value);
            }
            Ok(found)
        };
    for (joint, reference, title) in [
        ("rhumerus", "thorax", "right upper arm in the thorax"),
        ("lhumerus", "thorax", "left upper arm in the thorax"),
        ("rfemur", "root", "right thigh in the pelvis"),
    ] {
        let next = if joint == "rfemur" {
            "rtibia"
        } else if joint == "rhumerus" {
            "rradius"
        } else {
            "lradius"
        };
        let bone = bone(&folder.join("shoulder/cmu01/01.asf"), joint, next)?;
        let one = cmu("01", &["03", "09", "12", "13"], joint, reference)?;
        let two = cmu("02", &["05", "10"], joint, reference)?;
        let one = Data { title, bone, takes: one };
        let two = Data { title, bone, takes: two };
        println!("\n## {title}\n");
        described(&one, "CMU 01");
        described(&two, "CMU 02");
        let whole: Vec<&Take> = one.takes.iter().chain(&two.takes).collect();
        let near = Near::new(&whole)?;
        println!("\nTakes of 01 left out in turn:\n");
        folds(&one, &near, 4)?;
        for (a, b, names) in [(&one, &two, "01, tested on 02"), (&two, &one, "02, tested on 01")] {
            println!("\nTrained on {names}:\n");
            let train: Vec<&Take> = a.takes.iter().collect();
            let test: Vec<Quat> = b.takes.iter().flat_map(|t| t.found.rotations.clone()).collect();
            table(&[Fold { train: own(&train), test }], &near, a.bone)?;
        }
        if joint == "rhumerus" {
            histograms(&one, &two)?;
        }
    }
    let path = folder.join("hip/right_hip_functional.c3d");
    let recipe = open::recipe(Path::new("hip"))?.value;
    let wanted = Wanted { recipe: Some(("hip".into(), recipe)), ..Wanted::default() };
    let hip = Data {
        title: "right thigh in the pelvis, functional trial",
        bone: -Vec3::Y,
        takes: vec![take(&path, &wanted)?.value],
    };
    println!("\n## {}\n", hip.title);
    described(&hip, "hip");
    let near = Near::new(&hip.takes.iter().collect::<Vec<_>>())?;
    println!("\nEight blocks of time left out in turn:\n");
    folds(&hip, &near, 8)?;
    Ok(())
}

/// From the joint of a segment to that of the next, in the segment's axes.
fn bone(skeleton: &Path, joint: &str, next: &str) -> Result<Vec3, Fault> {
    let model = open::model(skeleton)?.value;
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&model.defaults(), Mode::Open, &mut pose)?;
    let [a, b] = [model.find_segment(joint)?, model.find_segment(next)?].map(|s| pose.segment(s));
    let along = b.translation - a.translation;
    Ok((a.linear.transpose() * along).normalized())
}

fn described(data: &Data, who: &str) {
    for take in &data.takes {
        let found = &take.found;
        println!(
            "- {who}, {}: {} frames of {} ({} missing, {} ill-conditioned)",
            take.name,
            found.rotations.len(),
            found.given(),
            found.missing,
            found.ill_conditioned
        );
    }
    // How far each take is from all others.
    for (index, own) in data.takes.iter().enumerate() {
        let others: Vec<Quat> = data
            .takes
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index)
            .flat_map(|(_, take)| take.found.rotations.iter().copied().step_by(4))
            .collect();
        if others.is_empty() {
            continue;
        }
        let mut far: Vec<f64> = own
            .found
            .rotations
            .iter()
            .step_by(10)
            .map(|q| simple::nearest(*q, &others).to_degrees())
            .collect();
        far.sort_by(f64::total_cmp);
        println!(
            "- {}: nearest frame of the person's other takes {:.1}° away at the median, {:.1}° at 95 %, {:.1}° at most",
            own.name,
            limits::percentile(&far, 0.5),
            limits::percentile(&far, 0.95),
            limits::percentile(&far, 1.0)
        );
    }
}

/// What a method is trained on, takes kept apart, and what it is tested on.
struct Fold {
    train: Vec<Vec<Quat>>,
    test: Vec<Quat>,
}

fn own(takes: &[&Take]) -> Vec<Vec<Quat>> {
    takes.iter().map(|take| take.found.rotations.clone()).collect()
}

fn folds(data: &Data, near: &Near, parts: usize) -> Result<(), Fault> {
    let pieces: Vec<Vec<Quat>> = match &data.takes[..] {
        [one] => {
            let all = &one.found.rotations;
            all.chunks(all.len().div_ceil(parts)).map(<[Quat]>::to_vec).collect()
        }
        takes => takes.iter().map(|take| take.found.rotations.clone()).collect(),
    };
    let folds: Vec<Fold> = (0..pieces.len())
        .map(|out| Fold {
            train: pieces
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != out)
                .map(|(_, p)| p.clone())
                .collect(),
            test: pieces[out].clone(),
        })
        .collect();
    table(&folds, near, data.bone)
}

/// Rotations at known distances from the nearest sample of a whole cloud.
struct Near([(f64, Vec<Quat>); 4]);

impl Near {
    fn new(takes: &[&Take]) -> Result<Self, Fault> {
        let all: Vec<&[Quat]> = takes.iter().map(|take| &take.found.rotations[..]).collect();
        let cloud = Cloud::gather(&all, 0.5f64.to_radians())?;
        let mut random = Random::new(14);
        Ok(Self([5.0, 10.0, 20.0, 40.0].map(|degrees: f64| {
            (degrees, quat_at(degrees.to_radians(), cloud.rotations(), 1500, &mut random))
        })))
    }
}

/// One method's row: coverage, volume, rejections, all means over folds.
#[derive(Default)]
struct Row {
    covered: f64,
    tested: f64,
    volume: f64,
    rejected: [f64; 4],
    folds: f64,
}

impl Row {
    fn add(&mut self, fold: &Fold, near: &Near, valid: &dyn Fn(Quat) -> bool) {
        self.covered += fold.test.iter().filter(|q| valid(**q)).count() as f64;
        self.tested += fold.test.len() as f64;
        let count = 40_000;
        self.volume += uniform(count).filter(|q| valid(*q)).count() as f64 / count as f64;
        for (sum, (_, far)) in self.rejected.iter_mut().zip(&near.0) {
            let out = far.iter().filter(|q| !valid(**q)).count() as f64;
            *sum += out / far.len().max(1) as f64;
        }
        self.folds += 1.0;
    }

    fn coverage(&self) -> f64 {
        self.covered / self.tested
    }

    fn print(&self, name: &str) {
        let [a, b, c, d] = self.rejected.map(|sum| sum / self.folds);
        println!(
            "| {name} | {:.3} | {:.2} % | {a:.2} | {b:.2} | {c:.2} | {d:.2} |",
            self.coverage(),
            1e2 * self.volume / self.folds
        );
    }
}

fn table(folds: &[Fold], near: &Near, bone: Vec3) -> Result<(), Fault> {
    println!("| method | held-out frames valid | volume | rejected at 5° | 10° | 20° | 40° |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let mut ours = Row::default();
    let mut unknown = 0.0;
    let offsets: [f64; 7] = [0.0, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0];
    let mut curve: Vec<Row> = offsets.iter().map(|_| Row::default()).collect();
    let readings = [
        ("herda2003, centred, six, to 11 spheres", Placement::Centred, Split::Six, 0.0, 11),
        ("herda2003, centred, two, stable", Placement::Centred, Split::Two, 0.05, 31),
        ("herda2003, as recorded, six, to 11 spheres", Placement::AsRecorded, Split::Six, 0.0, 11),
    ];
    let mut herda: Vec<Row> = readings.iter().map(|_| Row::default()).collect();
    let mut boxes = Row::default();
    let mut orders = vec![];
    let mut gaps = vec![];
    for fold in folds {
        let takes: Vec<Take> = fold
            .train
            .iter()
            .map(|rotations| Take {
                name: String::new(),
                found: condyle::learn::frames::Orientated {
                    rotations: rotations.clone(),
                    ..Default::default()
                },
                child: "child".into(),
                reference: None,
                frames: String::new(),
            })
            .collect();
        let learned = learn(&takes, &How::default(), "")?;
        let field: &Field = learned.limit.field();
        gaps.push(format!("{:.1}°", field.learned().gap.to_degrees()));
        ours.add(fold, near, &|q| field.state(q).0 == State::Valid);
        let holes = fold.test.iter().filter(|q| field.state(**q).0 == State::Unknown).count();
        unknown += holes as f64;
        let slices: Vec<&[Quat]> = fold.train.iter().map(Vec::as_slice).collect();
        let cloud = Cloud::gather(&slices, SPACING)?;
        let bare =
            limits::learn(&cloud, &Settings { gap: Some(0.0), hole: None, ..Settings::default() })?;
        for (offset, row) in offsets.iter().zip(&mut curve) {
            let most = -offset.to_radians();
            row.add(fold, near, &|q| bare.distance(q) >= most);
        }
        for ((_, placement, split, stable, most), row) in readings.iter().zip(&mut herda) {
            let options = Options {
                placement: *placement,
                split: *split,
                stable: *stable,
                most: *most,
                ..Options::default()
            };
            let spheres = SphereLimit::learn(cloud.rotations(), cloud.reference(), options)
                .map_err(|error| error.to_string())?;
            row.add(fold, near, &|q| spheres.allows(q));
        }
        let raw: Vec<Quat> = fold.train.iter().flatten().copied().collect();
        let found = Box::smallest(&raw);
        orders.push(found.name());
        boxes.add(fold, near, &|q| found.holds(q));
    }
    ours.print(&format!("**closing, offset from left-out takes** ({})", gaps.join(", ")));
    for (offset, row) in offsets.iter().zip(&curve) {
        row.print(&format!("closing and {offset}°, holes filled"));
    }
    for ((name, ..), row) in readings.iter().zip(&herda) {
        row.print(name);
    }
    boxes.print(&format!("Euler ranges, the order with the least volume ({})", orders.join(", ")));
    // A circular cone with a range of twist, scaled until as many held-out frames are inside as in ours.
    let balls: Vec<Ball> = folds
        .iter()
        .map(|fold| {
            let slices: Vec<&[Quat]> = fold.train.iter().map(Vec::as_slice).collect();
            let cloud = Cloud::gather(&slices, SPACING)?;
            Ok(Ball::of(&cloud, bone))
        })
        .collect::<Result<_, Fault>>()?;
    let held = |scale: f64| {
        let inside: usize = folds
            .iter()
            .zip(&balls)
            .map(|(fold, ball)| fold.test.iter().filter(|q| ball.holds(**q, scale)).count())
            .sum();
        inside as f64 / ours.tested
    };
    let scale = beyond(&held, ours.coverage());
    let mut cone = Row::default();
    for (fold, ball) in folds.iter().zip(&balls) {
        cone.add(fold, near, &|q| ball.holds(q, scale));
    }
    cone.print(&format!("circular cone and twist, {scale:.2} of the data's, at equal coverage"));
    println!("\nOf the held-out frames {:.2} % are called unknown.", 1e2 * unknown / ours.tested);
    Ok(())
}

/// Figure 12 of the paper: values on the subject that was learned from and on another.
fn histograms(one: &Data, two: &Data) -> Result<(), Fault> {
    for (a, b, names) in [(one, two, ["01", "02"]), (two, one, ["02", "01"])] {
        let slices: Vec<&[Quat]> = a.takes.iter().map(|t| &t.found.rotations[..]).collect();
        let cloud = Cloud::gather(&slices, SPACING)?;
        let options = Options { split: Split::Six, stable: 0.0, most: 11, ..Options::default() };
        let spheres = SphereLimit::learn(cloud.rotations(), cloud.reference(), options)
            .map_err(|error| error.to_string())?;
        let learned = learn(&a.takes, &How::default(), "")?;
        println!(
            "\nField values of herda2003 (F, at least 1 is inside) and distances of ours (degrees), learned from {}, on the frames of {} and of {}, in percent:\n",
            names[0], names[0], names[1]
        );
        let of = |data: &Data| -> Vec<Quat> {
            data.takes.iter().flat_map(|t| t.found.rotations.clone()).collect()
        };
        let (own, other) = (of(a), of(b));
        let percent = |values: Vec<f64>, from: f64, to: f64, bins: usize| -> Vec<f64> {
            let count = values.len() as f64;
            let histogram = Histogram::of(values, from, to, bins);
            histogram.counts.iter().map(|n| 1e2 * *n as f64 / count).collect()
        };
        let f = |frames: &[Quat]| {
            percent(frames.iter().map(|q| spheres.value(*q)).collect(), 0.0, 3.0, 12)
        };
        let d = |frames: &[Quat]| {
            let field = learned.limit.field();
            percent(
                frames.iter().map(|q| field.distance(*q).to_degrees()).collect(),
                -30.0,
                30.0,
                12,
            )
        };
        println!(
            "| F | on {} | on {} | distance | on {} | on {} |",
            names[0], names[1], names[0], names[1]
        );
        println!("| --- | --- | --- | --- | --- | --- |");
        let (fo, fx, d_o, dx) = (f(&own), f(&other), d(&own), d(&other));
        for i in 0..12 {
            let (low, deg) = (0.25 * i as f64, -30.0 + 5.0 * i as f64);
            println!(
                "| {low:.2} to {:.2} | {:.1} | {:.1} | {deg:.0}° to {:.0}° | {:.1} | {:.1} |",
                low + 0.25,
                fo[i],
                fx[i],
                deg + 5.0,
                d_o[i],
                dx[i]
            );
        }
    }
    Ok(())
}
