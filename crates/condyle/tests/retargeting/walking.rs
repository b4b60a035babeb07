//! Feet of a generated walk, whose stands are known.

use crate::figure::Figure;
use crate::{carried, places};
use condyle::math::{Quat, Vec3};
use condyle::model::CoordinateKind;
use condyle::model::model::Facing;
use condyle::retargeting::{Options, standing};
use condyle::{Model, Motion};

/// Lengths of thigh and shank of the figure, and the height of its ankles, in metres.
const BONE: f64 = 0.42;
const ANKLE: f64 = 0.08;
/// Hips are so far above the ankles, go forward at 1 m/s, and a foot stands from 22 cm before them to 22 cm behind.
const HIPS: f64 = 0.79;
const HALF_STEP: f64 = 0.22;

/// Where an ankle is at a phase of a stride of two halves: forward of the hips, and above its height when it stands.
fn ankle(phase: f64) -> (f64, f64) {
    let share = phase.rem_euclid(2.0);
    if share < 1.0 {
        return (HALF_STEP * (1.0 - 2.0 * share), 0.0);
    }
    let share = share - 1.0;
    // From a stand to a stand, in the world twice as far as between hips and foot.
    let smooth = share * share * (3.0 - 2.0 * share);
    let forward = -HALF_STEP + 4.0 * HALF_STEP * smooth - 2.0 * HALF_STEP * share;
    (forward, 0.12 * (std::f64::consts::PI * share).sin().powi(2))
}

/// Hips on a straight line; the legs by the law of cosines, the feet level.
fn walk(model: &Model, figure: &Figure) -> Motion {
    let world = figure.world();
    let [ty, tz] = ["ty", "tz"].map(|name| model.find_coordinate(name).unwrap());
    let balls: Vec<_> = model
        .coordinate_ids()
        .filter(|id| model.coordinate(*id).kind == CoordinateKind::Orientation)
        .collect();
    let mut motion = Motion::default();
    for frame in 0..300 {
        let t = f64::from(frame) * 0.01;
        let mut stored = model.defaults();
        *model.value_mut(&mut stored, ty) -= 2.0 * BONE - HIPS;
        *model.value_mut(&mut stored, tz) += t;
        // A half of a stride is 44 cm of way.
        let phase = t / (2.0 * HALF_STEP);
        for (hip, own) in [(13, phase), (17, phase + 1.0)] {
            let (forward, above) = ankle(own);
            let down = HIPS - above;
            let far = forward.hypot(down);
            let thigh = forward.atan2(down) + (0.5 * far / BONE).acos();
            let knee = 2.0 * (0.5 * far / BONE).acos();
            for (bone, about_right) in [(hip, thigh), (hip + 1, -knee), (hip + 2, knee - thigh)] {
                let turn = Quat::exp(world * Vec3::new(0.0, 0.0, about_right));
                stored[model.stored_range(balls[bone])].copy_from_slice(&turn.to_array());
            }
        }
        motion.times.push(t);
        motion.frames.push(stored);
    }
    motion
}

/// The largest way along the ground from where a stand began, over the stands of the source.
fn slides(source: &[Vec<Vec3>], moved: &[Vec<Vec3>], times: &[f64]) -> (usize, f64) {
    let (mut stands, mut most) = (0, 0.0_f64);
    for joint in [15, 16, 19, 20] {
        let points: Vec<Vec3> = source.iter().map(|frame| frame[joint]).collect();
        for run in standing(&points, times, Vec3::Y) {
            stands += 1;
            let first = moved[run.start][joint];
            for frame in run {
                let way = moved[frame][joint] - first;
                most = most.max(way.x.hypot(way.z));
            }
        }
    }
    (stands, most)
}

#[test]
fn feet_of_a_walk_stand_where_the_sources_do() {
    let figure = Figure::default();
    let model = figure.model();
    let motion = walk(&model, &figure);
    let own = places(&model, &motion);
    // The generator's own feet: planted ankles do not move.
    let planted = |frame: usize| (frame as f64 * 0.01 / (2.0 * HALF_STEP)).rem_euclid(2.0) < 1.0;
    for frame in (1..300).filter(|frame| planted(*frame) && planted(frame - 1)) {
        let step = own[frame][15] - own[frame - 1][15];
        let height = own[frame][15].y;
        assert!(step.norm() < 1e-9 && (height - ANKLE).abs() < 1e-9, "frame {frame}");
    }
    let (stands, source) = slides(&own, &own, &motion.times);
    // 3 s are 6.8 half strides: each foot stands three or four times, with ankle and ball.
    assert!((12..=16).contains(&stands), "{stands}");
    for target in [
        Figure { legs: 0.8, thigh: 0.06, facing: Facing::PlusX, ..figure },
        Figure { legs: 1.2, thigh: -0.05, odd_axes: true, foot: 0.10, ..figure },
    ] {
        let other = target.model();
        let free = carried(&model, &motion, &other, Options::default());
        let (_, left) = slides(&own, &places(&other, &free.motion), &motion.times);
        assert!(left < source * target.legs.max(1.0) + 0.005, "{target:?}: {left} m, {source}");
        // The report's own figures are of the same stands.
        assert_eq!(free.report.sliding.stands, stands);
        assert!((free.report.sliding.target[1] - left).abs() < 1e-6);
        let pinned =
            carried(&model, &motion, &other, Options { pin_feet: true, ..Options::default() });
        let (_, left) = slides(&own, &places(&other, &pinned.motion), &motion.times);
        assert!(left < 0.002, "{target:?}, pinned: {left} m");
    }
}

#[test]
fn a_walk_on_the_man_stands_too() {
    let figure = Figure::default();
    let model = figure.model();
    let motion = walk(&model, &figure);
    let own = places(&model, &motion);
    let human = condyle::open::model("human".as_ref()).unwrap().value;
    let (_, source) = slides(&own, &own, &motion.times);
    for (pin_feet, most) in [(false, source + 0.005), (true, 0.01)] {
        let there = carried(&model, &motion, &human, Options { pin_feet, ..Options::default() });
        let sliding = there.report.sliding;
        assert!(sliding.stands >= 12 && sliding.target[1] < most, "{pin_feet}: {sliding:?}");
    }
}
