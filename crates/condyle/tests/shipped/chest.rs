//! The shoulder blade against the ribs that the text ships, bone to bone.
//!
//! The blade is what its landmarks span: triangles from a point of its middle to each stretch of its border, and flat
//! ones from the trigonum to lower angle, neck and superior angle, which cut through where the bone bends away from
//! the ribs. The chest is the surface that the centrelines of ribs 1 to 10 span, half a rib (5 mm) farther out.

use crate::figure::{Draws, Figure};
use condyle::math::Vec3;
use condyle::mesh::Form;
use condyle::{Mode, Pose};

/// Half the height of a rib, in metres.
const HALF_RIB: f64 = 0.005;

/// Points of a surface with their outward normals.
struct Chest {
    points: Vec<(Vec3, Vec3)>,
}

impl Chest {
    /// The right half, where the ribs are in a pose, in the frame of the thorax.
    fn of(human: &Figure, pose: &Pose) -> Self {
        const ALONG: usize = 60;
        const BETWEEN: usize = 8;
        let mut lines = vec![];
        for level in 1..=10 {
            let name = format!("rib_{level}_r");
            let shape = human.model.shapes().iter().find(|s| {
                human.model.segment(s.segment).name == name && matches!(s.form, Form::Rib(_))
            });
            let shape = shape.expect("a rib");
            let Form::Rib(rib) = &shape.form else { unreachable!("a rib") };
            let back = pose.segment(human.id("thorax")).rigid_inverse();
            let line: Vec<Vec3> = rib
                .centreline()
                .into_iter()
                .map(|p| back * (pose.segment(shape.segment) * p))
                .collect();
            lines.push(evenly(&line, ALONG));
        }
        let row = |t: usize| -> Vec<Vec3> {
            let (rib, part) = (t / BETWEEN, (t % BETWEEN) as f64 / BETWEEN as f64);
            let below = (rib + 1).min(lines.len() - 1);
            (0..ALONG).map(|i| lines[rib][i] * (1.0 - part) + lines[below][i] * part).collect()
        };
        let rows: Vec<Vec<Vec3>> = (0..=(lines.len() - 1) * BETWEEN).map(row).collect();
        let mut points = vec![];
        for t in 0..rows.len() {
            let (up, down) = (t.saturating_sub(1), (t + 1).min(rows.len() - 1));
            for i in 1..ALONG - 1 {
                let across = rows[down][i] - rows[up][i];
                let along = rows[t][i + 1] - rows[t][i - 1];
                let mut normal = along.cross(across).normalized();
                // Outward: away from an axis within the half chest.
                let out = rows[t][i] - Vec3::new(-0.035, rows[t][i].y, 0.04);
                if normal.dot(out) < 0.0 {
                    normal = -normal;
                }
                // Near the spine ribs go inward of the processes that carry them.
                if rows[t][i].z > 0.018 {
                    points.push((rows[t][i] + normal * HALF_RIB, normal));
                }
            }
        }
        Self { points }
    }

    /// The distance of a point from the surface, negative within.
    fn distance(&self, point: Vec3) -> f64 {
        let nearest = self.points.iter().map(|(p, n)| ((point - *p).norm_squared(), *p, *n));
        let (square, p, normal) =
            nearest.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a surface has points");
        square.sqrt() * (point - p).dot(normal).signum()
    }
}

/// So many points at equal steps along a line.
fn evenly(line: &[Vec3], count: usize) -> Vec<Vec3> {
    let mut length = vec![0.0];
    for pair in line.windows(2) {
        length.push(length[length.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = length[length.len() - 1];
    let at = |k: usize| {
        let s = whole * k as f64 / (count - 1) as f64;
        let i = length.partition_point(|&l| l < s).clamp(1, line.len() - 1);
        let part = (s - length[i - 1]) / (length[i] - length[i - 1]).max(1e-12);
        line[i - 1] * (1.0 - part) + line[i] * part
    };
    (0..count).map(at).collect()
}

/// Points of the blade in the frame of the scapula: curved, and flat.
fn blade(human: &Figure) -> [Vec<Vec3>; 2] {
    let shape = human.model.shapes().iter().find(|s| s.name == "scapular_blade_r");
    let Form::Plate(plate) = &shape.expect("a blade").form else { panic!("a blade is a plate") };
    let at = |name: &str| human.landmark(name).1;
    let (ts, ai, sa) = (at("trigonum_r"), at("inferior_angle_r"), at("superior_angle_r"));
    // The border goes from the trigonum by the lower angle to the neck below and at the glenoid.
    let [.., low_neck, neck, _, _] = plate.outline[..] else { panic!("a border") };
    let fill = |[a, b, c]: [Vec3; 3], steps: usize| -> Vec<Vec3> {
        let mut points = vec![];
        for i in 0..=steps {
            for j in 0..=steps - i {
                let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                points.push(a + (b - a) * u + (c - a) * v);
            }
        }
        points
    };
    let border = &plate.outline;
    let curved = (0..border.len())
        .flat_map(|i| fill([plate.middle, border[i], border[(i + 1) % border.len()]], 4));
    let flat = [[ts, ai, low_neck], [ts, low_neck, neck], [ts, neck, sa]];
    [curved.collect(), flat.into_iter().flat_map(|t| fill(t, 5)).collect()]
}

#[test]
fn the_blade_glides_outside_the_ribs() {
    let human = Figure::shipped("human");
    let rest = human.pose(&human.set(&[]), Mode::Posed);
    let chest = Chest::of(&human, &rest);
    let [curved, flat] = blade(&human);
    let least = |pose: &Pose, points: &[Vec3]| {
        let scapula = human.in_thorax(pose, "scapula_r");
        points.iter().map(|p| chest.distance(scapula * *p)).fold(f64::INFINITY, f64::min)
    };
    // At rest and raised in three planes: 8 to 25 mm of muscle (serratus and subscapularis).
    for plane in [0.0, 40.0, 90.0] {
        for elevation in (0..=160).step_by(10) {
            let asked =
                [("shoulder_plane_r", plane), ("shoulder_elevation_r", f64::from(elevation))];
            let pose = human.pose(&human.degrees(&asked), Mode::Posed);
            let gap = least(&pose, &curved);
            assert!((0.008..0.025).contains(&gap), "{plane} {elevation}: {gap}");
            assert!(least(&pose, &flat) > 0.003, "{plane} {elevation}: {}", least(&pose, &flat));
        }
    }
    // Over the whole range.
    let mut draws = Draws(2026);
    let count = if cfg!(debug_assertions) { 400 } else { 10_000 };
    let names = ["plane", "elevation", "rotation"].map(|n| format!("shoulder_{n}_r"));
    let names: Vec<String> =
        names.into_iter().chain(["shrug_r".into(), "protraction_r".into()]).collect();
    let (mut deepest, mut nearest) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..count {
        let asked: Vec<(&str, f64)> = names
            .iter()
            .map(|name| {
                let [low, high] = human.range(name);
                (name.as_str(), low + (high - low) * draws.share())
            })
            .collect();
        let pose = human.pose(&human.degrees(&asked), Mode::Posed);
        deepest = deepest.min(least(&pose, &curved)).min(least(&pose, &flat));
        let trigonum = human.in_thorax(&pose, "scapula_r") * human.landmark("trigonum_r").1;
        nearest = nearest.min(trigonum.z);
    }
    println!(
        "{count} legal poses: the blade at {deepest:.4} m of the ribs, the trigonum at {nearest:.4} m"
    );
    assert!(deepest > -0.003, "{deepest}");
    assert!(nearest > 0.03, "{nearest}");
}
