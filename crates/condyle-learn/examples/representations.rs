//! Ways to hold the same samples, compared: `cargo run --release -p condyle-learn --example representations [COUNTS [SHAPES]]`,
//! SHAPES being positions in the list of shapes, from 0.
//!
//! Of each shape and number of samples and for each way: balanced accuracy at the true distance of 3 degrees, the share of the
//! inside and of the outside that is right there, the volume over the true one, seconds to learn, nanoseconds of a query of uniform
//! rotations, bytes of a file and of what is in memory.
//!
//! | way | what |
//! | --- | --- |
//! | closing | the default method |
//! | nearest | valid within the angle of a sample that 95 % of samples have to their nearest |
//! | cells | a grid of cells as wide as a spacing that hold a sample or touch six that do |
//! | spheres | Herda et al. 2003, centred, with the default stop |
//! | best spheres | of its stages, centred and as recorded, split into six and into two, the one with the best accuracy: the truth is looked at |
//! | with negative | `spheres`, and spheres taken away where F ≥ 1 and no sample is within two spacings, with half of the way to the nearest as radius |
//! | best with negative | `best spheres`, likewise, of four distances and three radii the ones with the best accuracy: the truth is looked at |

#[path = "../tests/field/shapes.rs"]
#[allow(dead_code, reason = "what only tests ask for")]
mod shapes;

use condyle_learn::limits::herda2003::{
    Chart, Fitting, Options, Placement, SphereField, SphereLimit, Split, profile,
};
use condyle_learn::limits::{Cloud, Settings, State, learn, uniform};
use condyle_math::{Quat, Vec3};
use shapes::{Random, SHAPES, Shape, quantile};
use std::collections::HashSet;
use std::hint::black_box;
use std::sync::OnceLock;
use std::time::Instant;

/// Seconds that this thread has run: on a busy machine the clock tells more. Without the system's count, the clock.
fn now() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    let start = START.get_or_init(Instant::now);
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat");
    let counted = counted.ok().and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    counted.map_or(start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

fn main() {
    let counts: Vec<usize> = match std::env::args().nth(1) {
        Some(list) => list.split(',').filter_map(|n| n.parse().ok()).collect(),
        None => vec![1500, 5000],
    };
    println!(
        "| shape | samples | way | balanced | inside | outside | volume | learned in | a query | file | memory |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let chosen: Vec<usize> = match std::env::args().nth(2) {
        Some(list) => list.split(',').filter_map(|n| n.parse().ok()).collect(),
        None => (0..SHAPES.len()).collect(),
    };
    for shape in chosen.iter().filter_map(|index| SHAPES.get(*index).copied()) {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let share = shape.share(&mut random);
        let boundary = shape.boundary(30_000, &mut random);
        let three = boundary.at(&shape, 3f64.to_radians(), 1600, &mut random);
        for &count in &counts {
            let samples = shape.samples(count, &mut random);
            ways(&Asked { shape, share, three: &three, samples: &samples });
        }
    }
}

struct Asked<'a> {
    shape: Shape,
    share: f64,
    three: &'a [(Quat, bool)],
    samples: &'a [Quat],
}

impl Asked<'_> {
    fn accuracy(&self, valid: &dyn Fn(Quat) -> bool) -> [f64; 3] {
        let (mut good, mut all) = ([0.0; 2], [0.0; 2]);
        for (q, inside) in self.three {
            all[usize::from(*inside)] += 1.0;
            good[usize::from(*inside)] += f64::from(u8::from(valid(*q) == *inside));
        }
        let [outside, inside] = [good[0] / all[0], good[1] / all[1]];
        [0.5 * (outside + inside), inside, outside]
    }

    fn row(&self, way: &str, seconds: f64, bytes: [usize; 2], valid: &dyn Fn(Quat) -> bool) {
        let [balanced, inside, outside] = self.accuracy(valid);
        let even: Vec<Quat> = uniform(20_000).collect();
        // The system counts in steps of some milliseconds.
        let (start, mut passes, mut held) = (now(), 0.0, 0);
        while passes == 0.0 || (now() - start < 0.2 && passes < 200.0) {
            held = even.iter().filter(|q| valid(black_box(**q))).count();
            passes += 1.0;
        }
        let nanoseconds = (now() - start) * 1e9 / (passes * even.len() as f64);
        let volume = held as f64 / even.len() as f64 / self.share;
        println!(
            "| {} | {} | {way} | {balanced:.3} | {inside:.3} | {outside:.3} | {volume:.2} | {seconds:.2} s | {nanoseconds:.0} ns | {:.1} kB | {:.0} kB |",
            self.shape.name,
            self.samples.len(),
            bytes[0] as f64 / 1e3,
            bytes[1] as f64 / 1e3,
        );
    }
}

fn nearest_of(samples: &[Quat], q: Quat, without: usize) -> f64 {
    let mut best = 0.0f64;
    for (index, p) in samples.iter().enumerate() {
        if index != without {
            best = best.max(q.dot(*p).abs());
        }
    }
    2.0 * best.min(1.0).acos()
}

/// What samples take in a file (three numbers of 16 bits in base64) and in memory.
fn of_samples(count: usize) -> [usize; 2] {
    [8 * count, 32 * count]
}

/// What spheres take: four numbers of 17 digits each in text, of 8 bytes in memory.
fn of_spheres(count: usize) -> [usize; 2] {
    [80 * count, 32 * count]
}

fn ways(asked: &Asked) {
    let samples = asked.samples;
    let start = now();
    let cloud = Cloud::gather(&[samples], 0.0).expect("samples");
    let field = learn(&cloud, &Settings::default()).expect("settings");
    let seconds = now() - start;
    let nodes = field.ground().settings.nodes.pow(3);
    // Coefficients of the spline, of a second one where there are holes, and the nearest sample of each node.
    let splines = if field.learned().holes.is_empty() { 1 } else { 2 };
    let [file, memory] = of_samples(samples.len());
    let bytes = [file + 600, memory + 4 * nodes * (splines + 1)];
    asked.row("closing", seconds, bytes, &|q| field.state(q).0 == State::Valid);

    let start = now();
    let mut left: Vec<f64> =
        samples.iter().enumerate().map(|(i, q)| nearest_of(samples, *q, i)).collect();
    let most = quantile(&mut left, 0.95);
    let seconds = now() - start;
    asked.row("nearest", seconds, of_samples(samples.len()), &|q| {
        nearest_of(samples, q, usize::MAX) <= most
    });

    let spacing = field.learned().spacing;
    let start = now();
    let width = spacing / 2.0;
    let cell = |q: Quat| {
        let q = if q.w < 0.0 { -q } else { q };
        let scale = (2.0 / (1.0 + q.w)).sqrt() / width;
        [q.x, q.y, q.z].map(|c| (c * scale).floor() as i32)
    };
    let held: HashSet<[i32; 3]> = samples.iter().map(|q| cell(*q)).collect();
    let seconds = now() - start;
    // A bit for each cell of the cube about the map, whose radius is √2.
    let bits = (2.0 * 2f64.sqrt() / width).ceil().powi(3) as usize / 8;
    asked.row("cells", seconds, [bits, bits], &|q| {
        let [i, j, k] = cell(q);
        let around =
            (0..27).filter(|n| held.contains(&[i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]));
        held.contains(&[i, j, k]) || around.count() >= 6
    });

    let start = now();
    let limit = SphereLimit::learn(samples, cloud.reference(), Options::default()).expect("a fit");
    let learned_in = now() - start;
    let count = limit.field.primitives.len();
    asked.row("spheres", learned_in, of_spheres(count), &|q| limit.allows(q));

    let start = now();
    let (best_chart, field) = best_spheres(asked, cloud.reference());
    let best_count = field.primitives.len();
    let best = |q: Quat| field.value(best_chart.point(q));
    let seconds = now() - start;
    asked.row("best spheres", seconds, of_spheres(best_count), &|q| best(q) >= 1.0);

    let start = now();
    let chart = limit.chart;
    let value = |q: Quat| limit.value(q);
    let empty = Empty::new(samples, &chart, &value, 1.2 * spacing);
    let taken = empty.taken(&value, 2.0 * spacing, 0.5);
    let seconds = learned_in + now() - start;
    let count = limit.field.primitives.len() + taken.len();
    asked.row(&format!("with {} negative", taken.len()), seconds, of_spheres(count), &|q| {
        value(q) - less(&taken, chart.point(q)) >= 1.0
    });

    let start = now();
    let empty = Empty::new(samples, &best_chart, &best, 1.2 * spacing);
    let mut found: Option<(f64, Vec<Negative>)> = None;
    for from in [1.2, 1.6, 2.0, 2.5] {
        for part in [0.5, 0.7, 0.85] {
            let taken = empty.taken(&best, from * spacing, part);
            let valid = |q: Quat| best(q) - less(&taken, best_chart.point(q)) >= 1.0;
            let accuracy = asked.accuracy(&valid)[0];
            if found.as_ref().is_none_or(|(least, _)| accuracy > *least) {
                found = Some((accuracy, taken));
            }
        }
    }
    let taken = found.map_or(vec![], |(_, taken)| taken);
    let seconds = now() - start;
    asked.row(
        &format!("best with {} negative", taken.len()),
        seconds,
        of_spheres(best_count + taken.len()),
        &|q| best(q) - less(&taken, best_chart.point(q)) >= 1.0,
    );
}

/// Of all stages of both ways to split, centred and as recorded, the one that is best at 3 degrees.
fn best_spheres(asked: &Asked, reference: Quat) -> (Chart, SphereField) {
    let mut best: Option<(f64, Chart, SphereField)> = None;
    for placement in [Placement::Centred, Placement::AsRecorded] {
        let chart = Chart::new(reference, placement);
        let points: Vec<Vec3> = asked.samples.iter().map(|q| chart.point(*q)).collect();
        for split in [Split::Two, Split::Six] {
            let options = Options { split, stable: 0.0, most: 21, ..Options::default() };
            let fitting = Fitting::new(points.clone(), options).expect("points");
            for stage in fitting.stages() {
                let accuracy = asked.accuracy(&|q| stage.field.value(chart.point(q)) >= 1.0)[0];
                if best.as_ref().is_none_or(|(least, ..)| accuracy > *least) {
                    best = Some((accuracy, chart, stage.field));
                }
            }
        }
    }
    let (_, chart, field) = best.expect("a stage");
    (chart, field)
}

/// A sphere that is taken away.
struct Negative {
    centre: Vec3,
    radius: f64,
    /// How steep its field is, as that of the others.
    stickiness: f64,
    /// By what its field is multiplied.
    weight: f64,
}

/// At most so many.
const MOST: usize = 200;

/// Places where F ≥ 1 that are far from samples, the farthest first.
struct Empty<'a> {
    chart: &'a Chart,
    points: Vec<Vec3>,
    places: Vec<(f64, Quat)>,
}

impl<'a> Empty<'a> {
    fn new(samples: &[Quat], chart: &'a Chart, value: &dyn Fn(Quat) -> f64, from: f64) -> Self {
        let mut places: Vec<(f64, Quat)> = uniform(40_000)
            .filter(|q| value(*q) >= 1.0)
            .map(|q| (nearest_of(samples, q, usize::MAX), q))
            .filter(|(angle, _)| *angle > from)
            .collect();
        places.sort_by(|a, b| b.0.total_cmp(&a.0));
        Self { chart, points: samples.iter().map(|q| chart.point(*q)).collect(), places }
    }

    /// Spheres about places farther than `from` from any sample: their influence ends at the nearest sample, their radius is a part
    /// of the way to it, and in their middle they are as strong as the field at their radius.
    fn taken(&self, value: &dyn Fn(Quat) -> f64, from: f64, part: f64) -> Vec<Negative> {
        let mut taken: Vec<Negative> = vec![];
        for (angle, q) in &self.places {
            if taken.len() == MOST || *angle < from {
                break;
            }
            let centre = self.chart.point(*q);
            if value(*q) - less(&taken, centre) < 1.0 {
                continue;
            }
            let ways = self.points.iter().map(|p| (*p - centre).norm());
            let end = ways.fold(f64::INFINITY, f64::min);
            let radius = part * end;
            // The field of a sphere ends 2/k beyond its radius.
            let stickiness = 2.0 / (end - radius).max(1e-9);
            taken.push(Negative { centre, radius, stickiness, weight: value(*q) });
        }
        taken
    }
}

fn less(taken: &[Negative], point: Vec3) -> f64 {
    taken
        .iter()
        .map(|n| n.weight * profile((point - n.centre).norm(), n.radius, n.stickiness).0)
        .sum()
}
