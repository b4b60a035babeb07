//! A simple human figure built in Rust, a walk for it, and synthetic recordings of both.
//!
//! Demonstrations, benches and tests use it: a body whose motion is known exactly.
//! Segment lengths are the fractions of stature of Drillis & Contini (in Winter, *Biomechanics and
//! Motor Control of Human Movement*); the knee glides as in Yamaguchi & Zajac 1989 and carries a
//! patella as in Rajagopal et al. 2016. Ranges, marker places and the walk are illustrative.

use condyle::math::Vec3;
use condyle::math::function::{Curve, Function, SimmSpline};
use condyle::model::{JointSetId, Signal};
use condyle::{
    CoordinateId, CoordinateKind, Mode, Model, ModelBuilder, Motion, Observed, Program, Range,
    Recording, SegmentId,
};
use std::f64::consts::TAU;

/// Stature of the figure in metres.
const STATURE: f64 = 1.75;

/// Facing x, y up, z to the right.
const SIDES: [(&str, f64); 2] = [("r", 1.0), ("l", -1.0)];

/// The figure: 15 segments, 35 coordinates of which two follow, 45 markers.
pub(crate) fn walker() -> Model {
    let mut figure = Figure { b: ModelBuilder::new("walker") };
    let pelvis = figure.trunk();
    for (side, sign) in SIDES {
        figure.leg(pelvis, side, sign);
    }
    match figure.b.build() {
        Ok(model) => model,
        // The parts are constants; the first test that runs finds a mistake in them.
        Err(findings) => panic!("the figure is wrong: {findings:?}"),
    }
}

struct Figure {
    b: ModelBuilder,
}

impl Figure {
    /// A coordinate with a range in degrees.
    fn angle(&mut self, set: JointSetId, name: &str, degrees: [f64; 2]) -> CoordinateId {
        let id = self.b.coordinate(set, name, CoordinateKind::Rotation);
        let [lower, upper] = degrees.map(f64::to_radians);
        self.b.coordinate_mut(id).range = Range::new(lower, upper);
        self.b.coordinate_mut(id).source = Some("illustrative".to_owned());
        id
    }

    /// A joint of consecutive rotations about given axes.
    fn rotations(&mut self, name: &str, segment: SegmentId, turns: &[(&str, Vec3, [f64; 2])]) {
        let set = self.b.joint_set(name);
        let mut factors = vec![];
        for &(coordinate, axis, degrees) in turns {
            let angle = self.angle(set, coordinate, degrees);
            factors.push(self.b.rotate(set, &format!("{coordinate}_turn"), angle, axis));
        }
        let whole = self.b.product(set, "motion", factors);
        self.b.output(set, segment, whole);
    }

    fn part(&mut self, name: &str, parent: SegmentId, at: [f64; 3]) -> SegmentId {
        let segment = self.b.segment(name, Some(parent));
        self.b.place_joint(segment, Vec3::from(at) * STATURE);
        segment
    }

    /// Markers at places given as fractions of stature.
    fn markers(&mut self, segment: SegmentId, list: &[(&str, [f64; 3])]) {
        for (name, at) in list {
            self.b.marker(name, Some(segment), Vec3::from(*at) * STATURE);
        }
    }

    fn trunk(&mut self) -> SegmentId {
        let pelvis = self.b.segment("pelvis", None);
        let set = self.b.joint_set("ground_pelvis");
        let mut factors = vec![];
        for (name, axis) in [("pelvis_tx", Vec3::X), ("pelvis_ty", Vec3::Y), ("pelvis_tz", Vec3::Z)]
        {
            let distance = self.b.coordinate(set, name, CoordinateKind::Translation);
            if axis == Vec3::Y {
                self.b.coordinate_mut(distance).default[0] = 0.57 * STATURE;
            }
            factors.push(self.b.translate(set, &format!("{name}_slide"), distance, axis));
        }
        let turns =
            [("pelvis_tilt", Vec3::Z), ("pelvis_list", Vec3::X), ("pelvis_rotation", Vec3::Y)];
        for (name, axis) in turns {
            let angle = self.b.coordinate(set, name, CoordinateKind::Rotation);
            factors.push(self.b.rotate(set, &format!("{name}_turn"), angle, axis));
        }
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, pelvis, motion);
        self.markers(
            pelvis,
            &[
                ("R.ASIS", [0.04, 0.05, 0.07]),
                ("L.ASIS", [0.04, 0.05, -0.07]),
                ("R.PSIS", [-0.08, 0.055, 0.03]),
                ("L.PSIS", [-0.08, 0.055, -0.03]),
            ],
        );
        let torso = self.part("torso", pelvis, [-0.03, 0.06, 0.0]);
        self.rotations(
            "back",
            torso,
            &[
                ("lumbar_extension", Vec3::Z, [-60.0, 30.0]),
                ("lumbar_bending", Vec3::X, [-35.0, 35.0]),
                ("lumbar_rotation", Vec3::Y, [-45.0, 45.0]),
            ],
        );
        self.markers(
            torso,
            &[
                ("C7", [-0.035, 0.25, 0.0]),
                ("T10", [-0.06, 0.12, 0.0]),
                ("CLAV", [0.055, 0.22, 0.0]),
                ("STRN", [0.075, 0.14, 0.0]),
            ],
        );
        let head = self.part("head", torso, [-0.005, 0.28, 0.0]);
        self.rotations(
            "neck",
            head,
            &[("neck_flexion", Vec3::Z, [-50.0, 60.0]), ("neck_rotation", Vec3::Y, [-80.0, 80.0])],
        );
        self.markers(
            head,
            &[
                ("R.Head", [0.05, 0.09, 0.04]),
                ("L.Head", [0.05, 0.09, -0.04]),
                ("Top.Head", [0.0, 0.13, 0.0]),
            ],
        );
        for (side, sign) in SIDES {
            self.arm(torso, side, sign);
        }
        pelvis
    }

    fn arm(&mut self, torso: SegmentId, side: &str, sign: f64) {
        let name = |part: &str| format!("{part}_{side}");
        let upper = side.to_uppercase();
        let humerus = self.part(&name("humerus"), torso, [0.0, 0.228, 0.115 * sign]);
        self.rotations(
            &name("shoulder"),
            humerus,
            &[
                (&name("arm_flexion"), Vec3::Z, [-60.0, 170.0]),
                (&name("arm_adduction"), Vec3::X * sign, [-170.0, 30.0]),
                (&name("arm_rotation"), Vec3::Y * sign, [-80.0, 80.0]),
            ],
        );
        self.markers(
            humerus,
            &[
                (&format!("{upper}.Shoulder"), [0.0, 0.025, 0.01 * sign]),
                (&format!("{upper}.Arm"), [0.02, -0.09, 0.03 * sign]),
                (&format!("{upper}.Elbow"), [0.0, -0.186, 0.025 * sign]),
                (&format!("{upper}.Elbow.Medial"), [0.0, -0.186, -0.025 * sign]),
            ],
        );
        let forearm = self.part(&name("forearm"), humerus, [0.0, -0.186, 0.0]);
        self.rotations(
            &name("elbow"),
            forearm,
            &[
                (&name("elbow_flexion"), Vec3::Z, [0.0, 150.0]),
                (&name("pronation"), Vec3::Y * sign, [-80.0, 80.0]),
            ],
        );
        self.markers(
            forearm,
            &[
                (&format!("{upper}.Forearm"), [0.02, -0.06, 0.02 * sign]),
                (&format!("{upper}.Wrist.Radial"), [0.018, -0.146, 0.0]),
                (&format!("{upper}.Wrist.Ulnar"), [-0.018, -0.146, 0.0]),
            ],
        );
    }

    fn leg(&mut self, pelvis: SegmentId, side: &str, sign: f64) {
        let name = |part: &str| format!("{part}_{side}");
        let upper = side.to_uppercase();
        let femur = self.part(&name("femur"), pelvis, [-0.03, -0.04, 0.0477 * sign]);
        self.rotations(
            &name("hip"),
            femur,
            &[
                (&name("hip_flexion"), Vec3::Z, [-30.0, 120.0]),
                (&name("hip_adduction"), Vec3::X * sign, [-45.0, 30.0]),
                (&name("hip_rotation"), Vec3::Y * sign, [-45.0, 45.0]),
            ],
        );
        self.markers(
            femur,
            &[
                (&format!("{upper}.Thigh.Upper"), [0.045, -0.08, 0.02 * sign]),
                (&format!("{upper}.Thigh.Front"), [0.055, -0.15, 0.0]),
                (&format!("{upper}.Knee"), [0.0, -0.24, 0.033 * sign]),
                (&format!("{upper}.Knee.Medial"), [0.0, -0.24, -0.033 * sign]),
            ],
        );
        let tibia = self.part(&name("tibia"), femur, [0.0, -0.245, 0.0]);
        let flexion = self.knee(tibia, side);
        self.patella(femur, side, flexion);
        self.markers(
            tibia,
            &[
                (&format!("{upper}.Tibia"), [0.03, -0.04, 0.0]),
                (&format!("{upper}.Shank"), [0.01, -0.12, 0.03 * sign]),
                (&format!("{upper}.Ankle"), [0.0, -0.245, 0.022 * sign]),
                (&format!("{upper}.Ankle.Medial"), [0.0, -0.24, -0.022 * sign]),
            ],
        );
        let foot = self.part(&name("foot"), tibia, [0.0, -0.246, 0.0]);
        self.rotations(
            &name("ankle"),
            foot,
            &[
                (&name("ankle_flexion"), Vec3::Z, [-50.0, 25.0]),
                (&name("subtalar"), Vec3::new(0.78, 0.6, -0.12 * sign) * sign, [-25.0, 25.0]),
            ],
        );
        self.markers(
            foot,
            &[
                (&format!("{upper}.Heel"), [-0.035, -0.02, 0.0]),
                (&format!("{upper}.Toe"), [0.1, -0.03, -0.01 * sign]),
            ],
        );
    }

    /// A knee whose tibia glides forwards and down as it bends (Yamaguchi & Zajac 1989).
    fn knee(&mut self, tibia: SegmentId, side: &str) -> CoordinateId {
        let set = self.b.joint_set(&format!("knee_{side}"));
        let flexion = self.angle(set, &format!("knee_flexion_{side}"), [0.0, 120.0]);
        // Flexion in degrees to metres, relative to the straight leg.
        let forwards = spline(&[
            (0.0, 0.0),
            (20.0, 0.0035),
            (40.0, 0.00662),
            (60.0, 0.0086),
            (80.0, 0.00861),
            (120.0, 0.0013),
        ]);
        let up = spline(&[
            (0.0, 0.0),
            (20.0, -0.00178),
            (30.0, -0.00318),
            (70.0, -0.01238),
            (120.0, -0.02678),
        ]);
        let x = self.b.map(set, "forwards", flexion, forwards);
        let y = self.b.map(set, "up", flexion, up);
        let factors = vec![
            self.b.translate(set, "glide", x, Vec3::X),
            self.b.translate(set, "sink", y, Vec3::Y),
            self.b.rotate(set, "bend", flexion, -Vec3::Z),
        ];
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, tibia, motion);
        flexion
    }

    /// The patella follows the knee around the femur (Rajagopal et al. 2016).
    fn patella(&mut self, femur: SegmentId, side: &str, flexion: CoordinateId) {
        let patella = self.part(&format!("patella_{side}"), femur, [0.0, -0.245, 0.0]);
        let set = self.b.joint_set(&format!("patellofemoral_{side}"));
        let angle = self.b.coordinate(set, &format!("patella_angle_{side}"), CoordinateKind::Other);
        let follow = self.b.map(set, "follow", flexion, Function::identity());
        self.b.follow(angle, follow);
        let knots = |values: [f64; 4]| {
            let [a, b, c, d] = values;
            spline(&[(0.0, a), (45.0, b), (90.0, c), (120.0, d)])
        };
        let angle = Signal::Coordinate(angle);
        let turn =
            self.b.map(set, "turn", angle, knots([0.001137, -0.496173, -1.263786, -1.786335]));
        let x = self.b.map(set, "x", angle, knots([0.0524, 0.025628, -0.0088, -0.0227]));
        let y = self.b.map(set, "y", angle, knots([-0.0108, -0.038302, -0.0349, -0.0187]));
        let factors = vec![
            self.b.translate(set, "forwards", x, Vec3::X),
            self.b.translate(set, "upwards", y, Vec3::Y),
            self.b.rotate(set, "tip", turn, Vec3::Z),
        ];
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, patella, motion);
    }
}

/// A spline of an angle, through knots given in degrees.
fn spline(knots: &[(f64, f64)]) -> Function {
    let (x, y) = knots.iter().map(|&(degrees, y)| (degrees.to_radians(), y)).unzip();
    match SimmSpline::new(x, y) {
        Ok(spline) => Curve::SimmSpline(spline).into(),
        Err(error) => panic!("the figure's spline is wrong: {error}"),
    }
}

/// A walk: every coordinate a smooth function of time, within the ranges.
///
/// `rate` in frames per second. One stride takes 1.1 s and 1.3 m.
pub(crate) fn walk(model: &Model, frames: usize, rate: f64) -> Motion {
    let mut motion = Motion::default();
    let program = Program::compile(model);
    for frame in 0..frames {
        let time = frame as f64 / rate;
        let mut stored = model.defaults();
        for id in model.coordinate_ids() {
            let coordinate = model.coordinate(id);
            if coordinate.follows.is_none() {
                let value = stride(&coordinate.name, time);
                let moved = if coordinate.kind == CoordinateKind::Rotation {
                    value.to_radians()
                } else {
                    value
                };
                let value = model.value_mut(&mut stored, id);
                *value = coordinate.range.nearest(*value + moved);
            }
        }
        motion.times.push(time);
        motion.frames.push(stored);
    }
    motion.make_effective(&program, Mode::Open);
    motion
}

/// A coordinate's offset from its default at a time: degrees or metres.
fn stride(name: &str, time: f64) -> f64 {
    let (base, half) = match name.rsplit_once('_') {
        Some((base, "l")) => (base, 0.5),
        Some((base, "r")) => (base, 0.0),
        _ => (name, 0.0),
    };
    let phase = TAU * (time / 1.1 + half);
    let wave = |size: f64, times: f64, shift: f64| size * (times * phase + shift).sin();
    match base {
        "pelvis_tx" => 1.3 / 1.1 * time,
        "pelvis_ty" => -0.02 + wave(0.02, 2.0, 0.4),
        "pelvis_tz" => wave(0.02, 1.0, 0.0),
        "pelvis_tilt" => -4.0 + wave(2.0, 2.0, 0.3),
        "pelvis_list" => wave(4.0, 1.0, 0.5),
        "pelvis_rotation" => wave(6.0, 1.0, 1.2),
        "lumbar_extension" => -6.0 + wave(3.0, 2.0, 1.0),
        "lumbar_bending" => wave(5.0, 1.0, -2.5),
        "lumbar_rotation" => wave(9.0, 1.0, -1.9),
        "neck_flexion" => 5.0 + wave(2.0, 2.0, 0.0),
        "neck_rotation" => wave(4.0, 1.0, 0.8),
        "hip_flexion" => 10.0 + wave(24.0, 1.0, 1.2),
        "hip_adduction" => wave(5.0, 1.0, 0.4),
        "hip_rotation" => wave(5.0, 1.0, 2.0),
        "knee_flexion" => 26.0 + wave(21.0, 1.0, -0.4) + wave(9.0, 2.0, 1.0),
        "ankle_flexion" => wave(11.0, 1.0, 2.4) + wave(5.0, 2.0, 0.0),
        "subtalar" => wave(6.0, 1.0, 0.9),
        "arm_flexion" => 5.0 + wave(20.0, 1.0, -1.9),
        "arm_adduction" => -12.0 + wave(3.0, 2.0, 0.0),
        "arm_rotation" => wave(8.0, 1.0, 0.7),
        "elbow_flexion" => 30.0 + wave(14.0, 1.0, -1.6),
        "pronation" => 20.0 + wave(10.0, 1.0, 0.2),
        _ => 0.0,
    }
}

/// The flaws of a synthetic recording.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Flaws {
    /// Standard deviation of the noise on every marker coordinate, in metres.
    pub(crate) noise: f64,
    /// Share of the frames of each marker that fall into gaps.
    pub(crate) missing: f64,
    /// Two labels that are swapped, and the frames in which they are.
    pub(crate) swap: Option<([String; 2], std::ops::Range<usize>)>,
    /// The seed of the random numbers.
    pub(crate) seed: u64,
}

/// The markers of a model along a motion, as a laboratory might have recorded them.
pub(crate) fn record(model: &Model, motion: &Motion, flaws: &Flaws) -> Recording {
    let recording = motion.virtual_markers(model, Mode::Open);
    debug_assert!(recording.is_ok(), "a motion fits its model");
    let Ok(mut recording) = recording else { return Recording::default() };
    let mut dice = Dice(flaws.seed);
    let (frames, count) = (motion.frames.len(), recording.labels.len());
    let positions = &mut recording.positions;
    for [x, y, z] in positions.iter_mut().filter_map(Observed::position_mut) {
        let noise = Vec3::new(dice.normal(), dice.normal(), dice.normal()) * flaws.noise;
        (*x, *y, *z) = (*x + noise.x, *y + noise.y, *z + noise.z);
    }
    // Gaps of about a tenth of a second, as when an arm hides a marker.
    let length = 12.min(frames.max(1));
    let gaps = (flaws.missing * frames as f64 / length as f64).round() as usize;
    for marker in 0..count {
        for _ in 0..gaps {
            let start = dice.below(frames.saturating_sub(length).max(1));
            for frame in start..(start + length).min(frames) {
                positions[frame * count + marker] = Observed::MISSING;
            }
        }
    }
    if let Some((pair, range)) = &flaws.swap {
        let place = |name: &String| recording.labels.iter().position(|l| l == name);
        if let [Some(a), Some(b)] = [place(&pair[0]), place(&pair[1])] {
            for frame in range.clone().filter(|f| *f < frames) {
                positions.swap(frame * count + a, frame * count + b);
            }
        }
    }
    recording
}

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers everywhere.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    fn even(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.even() * n as f64) as usize
    }

    /// Normal with mean 0 and deviation 1, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.even()).ln()).sqrt();
        radius * (TAU * self.even()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle::Pose;

    #[test]
    fn the_walk_keeps_to_the_ranges_and_the_feet_to_the_ground() {
        let model = walker();
        assert_eq!(model.markers().len(), 45);
        let motion = walk(&model, 110, 100.0);
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let foot = model.find_segment("foot_r").unwrap();
        let mut lowest = f64::INFINITY;
        for frame in &motion.frames {
            for id in model.coordinate_ids() {
                let value = model.value(frame, id);
                assert!(model.coordinate(id).range.distance(value) >= 0.0);
            }
            program.evaluate(frame, Mode::Open, &mut pose).unwrap();
            lowest = lowest.min(pose.segment(foot).translation.y);
        }
        // The ankle of a person of 1.75 m is 0.039 of that above the ground.
        assert!((lowest - 0.039 * STATURE).abs() < 0.08, "{lowest}");
    }

    #[test]
    fn the_patella_lies_where_the_published_knots_put_it() {
        let model = walker();
        let program = Program::compile(&model);
        let mut pose = Pose::new(&program);
        let flexion = model.find_coordinate("knee_flexion_r").unwrap();
        let mut stored = model.defaults();
        *model.value_mut(&mut stored, flexion) = 90f64.to_radians();
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        let [femur, patella] = ["femur_r", "patella_r"].map(|n| model.find_segment(n).unwrap());
        let place = pose.segment(femur).rigid_inverse() * pose.segment(patella).translation;
        // Rajagopal et al. 2016 at 90 degrees, from the end of a femur of 0.245 statures.
        let published = Vec3::new(-0.0088, -0.0349 - 0.245 * STATURE, 0.0);
        assert!((place - published).norm() < 1e-12, "{place:?}");
    }

    #[test]
    fn noise_has_the_size_that_was_asked_for() {
        let model = walker();
        let motion = walk(&model, 200, 100.0);
        let flaws = Flaws { noise: 0.0, missing: 0.0, swap: None, seed: 1 };
        let clean = record(&model, &motion, &flaws);
        let noisy = record(&model, &motion, &Flaws { noise: 0.002, ..flaws });
        let squares: f64 = clean
            .positions
            .iter()
            .zip(&noisy.positions)
            .filter_map(|(a, b)| Some((a.position()?, b.position()?)))
            .map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>())
            .sum();
        // 200 · 45 · 3 draws: the deviation is known to half a percent.
        let deviation = (squares / (3.0 * clean.positions.len() as f64)).sqrt();
        assert!((deviation - 0.002).abs() < 0.00003, "{deviation}");
    }
}
