//! The shipped legs and arms against the numbers that they were made of.

use condyle::formats::document;
use condyle::lint;
use condyle::math::{Affine, EulerOrder, Mat3, Vec3};
use condyle::{Mode, Model, Pose, Program, SegmentId};

const KNEE: &str = include_str!("../models/knee.toml");
const LEGS: &str = include_str!("../models/legs.toml");
const ARMS: &str = include_str!("../models/arms.toml");

/// The stature that both documents are for, in metres.
const STATURE: f64 = 1.75;

const FINGERS: [&str; 4] = ["index", "middle", "ring", "little"];

/// A document made ready.
struct Figure {
    model: Model,
    program: Program,
}

impl Figure {
    fn read(text: &str) -> Self {
        let include = &mut |path: &str| match path {
            "knee.toml" => Ok(KNEE.to_owned()),
            "legs.toml" => Ok(LEGS.to_owned()),
            "arms.toml" => Ok(ARMS.to_owned()),
            other => Err(format!("`{other}` is not shipped")),
        };
        let read = document::read(text, include).expect("a model");
        assert_eq!(read.warnings, []);
        let model = read.value.model;
        let program = Program::compile(&model);
        Self { model, program }
    }

    /// The pose of stored numbers as they are, limits not applied.
    fn pose(&self, stored: &[f64]) -> Pose {
        let mut pose = Pose::new(&self.program);
        self.program.evaluate(stored, Mode::Open, &mut pose).expect("buffers of this program");
        pose
    }

    /// The pose with some coordinates set in degrees, the others at 0.
    fn at(&self, degrees: &[(&str, f64)]) -> Pose {
        let mut stored = vec![0.0; self.model.stored_len()];
        for (key, value) in degrees {
            let id = self.model.find_coordinate(key).expect(key);
            stored[self.model.stored_range(id).start] = value.to_radians();
        }
        self.pose(&stored)
    }

    fn id(&self, segment: &str) -> SegmentId {
        self.model.find_segment(segment).expect(segment)
    }

    /// What the joint of a segment does in a pose.
    fn motion(&self, pose: &Pose, segment: SegmentId) -> Affine {
        let s = self.model.segment(segment);
        let joint_in_world = pose.frame(s.parent) * s.joint_in_parent;
        joint_in_world.rigid_inverse() * pose.segment(segment) * s.joint_in_segment
    }

    /// Where a marker is in a pose.
    fn marker(&self, pose: &Pose, name: &str) -> Vec3 {
        let marker = self.model.markers().iter().find(|m| m.name == name).expect(name);
        pose.frame(marker.segment) * marker.point
    }

    /// A point and a direction of the axis about which a joint turns when one coordinate leaves 0,
    /// in the world of the pose at 0.
    fn axis(&self, key: &str, segment: &str) -> (Vec3, Vec3) {
        let rest = self.at(&[]).segment(self.id(segment));
        let moved = self.at(&[(key, 1.0)]).segment(self.id(segment)) * rest.rigid_inverse();
        let turn = moved.linear.log();
        let (angle, along) = (turn.norm(), turn.normalized());
        // The point nearest to the origin: p = (t + cot(angle / 2) a × t) / 2 for t across a.
        let t = moved.translation;
        assert!(t.dot(along).abs() < 1e-12, "{key} slides");
        ((t + along.cross(t) * (1.0 / (0.5 * angle).tan())) * 0.5, along)
    }
}

fn apart(a: Affine, b: Affine) -> f64 {
    a.to_rows().iter().zip(b.to_rows()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// How far two lines are from each other.
fn between((p, a): (Vec3, Vec3), (q, b): (Vec3, Vec3)) -> f64 {
    a.cross(b).normalized().dot(q - p).abs()
}

/// How far a point is from a line.
fn beside(point: Vec3, (p, a): (Vec3, Vec3)) -> f64 {
    a.cross(point - p).norm()
}

fn degrees_between(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

/// Numbers in [-1, 1] that are the same in every run (xorshift).
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// All coordinates somewhere in their ranges.
    fn inside(&mut self, model: &Model) -> Vec<f64> {
        let inside = |c: &condyle::Coordinate, at: f64| {
            let (low, high) = (c.range.lower.unwrap_or(-1.0), c.range.upper.unwrap_or(1.0));
            low + (high - low) * (0.5 + 0.5 * at)
        };
        model.coordinates().iter().map(|c| inside(c, self.next())).collect()
    }
}

#[test]
fn nothing_to_remark() {
    for text in [LEGS, ARMS] {
        let figure = Figure::read(text);
        assert_eq!(lint::check(&figure.model, &[]), []);
        for coordinate in figure.model.coordinates() {
            let named = coordinate.source.as_ref().is_some_and(|s| !s.is_empty());
            assert!(named, "{}", coordinate.name);
        }
    }
}

#[test]
fn at_zero_every_joint_is_at_rest() {
    for text in [LEGS, ARMS] {
        let figure = Figure::read(text);
        let pose = figure.at(&[]);
        for id in figure.model.segment_ids() {
            let s = figure.model.segment(id);
            let rest =
                pose.frame(s.parent) * s.joint_in_parent * s.joint_in_segment.rigid_inverse();
            assert!(apart(pose.segment(id), rest) < 1e-15, "{}", s.name);
        }
    }
    // Standing, all bones of the leg but the patella have the axes of the pelvis.
    let legs = Figure::read(LEGS);
    let pose = legs.at(&[]);
    for s in legs.model.segments().iter().filter(|s| !s.name.starts_with("patella")) {
        let upright = Affine::from_rotation(pose.segment(legs.id(&s.name)).linear);
        assert!(apart(upright, Affine::IDENTITY) < 1e-15, "{}", s.name);
    }
}

#[test]
fn the_left_is_the_right_in_a_mirror() {
    let flip = Mat3::from_columns(Vec3::X, Vec3::Y, -Vec3::Z);
    for text in [LEGS, ARMS] {
        let figure = Figure::read(text);
        let twin = |name: &str| match (name.strip_suffix("_r"), name.strip_suffix("_l")) {
            (Some(stem), _) => format!("{stem}_l"),
            (_, Some(stem)) => format!("{stem}_r"),
            _ => name.to_owned(),
        };
        let place = |key: &str| {
            let id = figure.model.find_coordinate(key).expect(key);
            figure.model.stored_range(id).start
        };
        let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
        let mut worst = 0.0_f64;
        for _ in 0..100 {
            let stored = draws.inside(&figure.model);
            let mut other = stored.clone();
            for coordinate in figure.model.coordinates() {
                other[place(&twin(&coordinate.name))] = stored[place(&coordinate.name)];
            }
            let (pose, mirrored) = (figure.pose(&stored), figure.pose(&other));
            for s in figure.model.segments() {
                let here = pose.segment(figure.id(&s.name));
                let seen = Affine::new(flip * here.linear * flip, flip * here.translation);
                worst = worst.max(apart(seen, mirrored.segment(figure.id(&twin(&s.name)))));
            }
            for marker in figure.model.markers() {
                let seen = flip * figure.marker(&pose, &marker.name);
                let there = figure.marker(&mirrored, &twin(&marker.name));
                worst = worst.max((seen - there).norm());
            }
        }
        assert!(worst < 1e-12, "{worst}");
    }
}

/// The ends of the ranges that were published, and that the joint turns so far there.
#[test]
fn ranges_end_where_their_sources_say() {
    // Merck Manual: all but what is named.
    let legs: &[(&str, &str, f64, f64)] = &[
        ("hip_flexion_r", "femur_r", -15.0, 125.0),
        // Adduction: Rajagopal et al. 2016.
        ("hip_adduction_r", "femur_r", -45.0, 30.0),
        ("hip_rotation_r", "femur_r", -45.0, 45.0),
        // Rajagopal et al. 2016.
        ("knee_angle_r", "tibia_r", 0.0, 120.0),
        ("ankle_angle_r", "talus_r", -50.0, 20.0),
        ("subtalar_angle_r", "calcaneus_r", -25.0, 35.0),
        ("mtp_angle_r", "toes_r", -80.0, 30.0),
    ];
    let arms: &[(&str, &str, f64, f64)] = &[
        // Boone & Azen 1979.
        ("elbow_flex_r", "ulna_r", 0.0, 143.0),
        ("wrist_flex_r", "hand_r", -75.0, 76.0),
        ("wrist_dev_r", "hand_r", -22.0, 36.0),
        ("pro_sup_r", "radius_r", 0.0, 180.0),
        ("finger_spread_r", "index_proximal_r", 0.0, 25.0),
        ("index_mcp_flex_r", "index_proximal_r", -30.0, 90.0),
        ("index_pip_flex_r", "index_middle_r", 0.0, 120.0),
        ("middle_mcp_flex_r", "middle_proximal_r", -30.0, 90.0),
        ("middle_pip_flex_r", "middle_middle_r", 0.0, 120.0),
        ("ring_mcp_flex_r", "ring_proximal_r", -30.0, 90.0),
        ("ring_pip_flex_r", "ring_middle_r", 0.0, 120.0),
        ("little_mcp_flex_r", "little_proximal_r", -30.0, 90.0),
        ("little_pip_flex_r", "little_middle_r", 0.0, 120.0),
        // Dutch arm model.
        ("thumb_cmc_flex_r", "thumb_metacarpal_r", -45.0, 15.0),
        ("thumb_cmc_abd_r", "thumb_metacarpal_r", -25.0, 25.0),
        // e-hand.com.
        ("thumb_mcp_flex_r", "thumb_proximal_r", -10.0, 55.0),
        ("thumb_ip_flex_r", "thumb_distal_r", -15.0, 80.0),
    ];
    for (text, table) in [(LEGS, legs), (ARMS, arms)] {
        let figure = Figure::read(text);
        assert_eq!(figure.model.coordinates().len(), 2 * table.len());
        for &(key, segment, low, high) in table {
            let left = format!("{}_l", key.strip_suffix("_r").expect(key));
            for key in [key, &left] {
                let id = figure.model.find_coordinate(key).expect(key);
                let range = figure.model.coordinate(id).range;
                let ends = [range.lower, range.upper].map(|side| side.expect(key).to_degrees());
                let off = (ends[0] - low).abs() + (ends[1] - high).abs();
                assert!(off < 1e-12, "{key} {ends:?}");
            }
            for end in [low, high] {
                let turned = figure.motion(&figure.at(&[(key, end)]), figure.id(segment)).linear;
                let angle = match key {
                    // Of the knee's three turns the first.
                    "knee_angle_r" => {
                        let order: EulerOrder = "zxy".parse().expect("an order");
                        -order.from_mat3(turned)[0]
                    }
                    _ => turned.log().norm(),
                };
                assert!((angle.to_degrees() - end.abs()).abs() < 1e-9, "{key} {end} {angle}");
            }
        }
    }
}

/// What a coordinate does to a landmark when it grows from 0, as its name says.
#[test]
fn coordinates_have_the_signs_of_their_names() {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let legs = [
        ("hip_flexion_r", "knee_center_r", x),
        ("hip_adduction_r", "knee_center_r", -z),
        ("hip_rotation_r", "toe_tip_r", -z),
        ("knee_angle_r", "ankle_center_r", -x),
        ("ankle_angle_r", "toe_tip_r", y),
        // Inversion lowers the lateral border and turns the toes in.
        ("subtalar_angle_r", "metatarsal_head_5_r", -y),
        ("subtalar_angle_r", "toe_tip_r", -z),
        ("mtp_angle_r", "toe_tip_r", -y),
    ];
    let arms = [
        ("elbow_flex_r", "wrist_center_r", x),
        // The thumb's side comes forward and goes in.
        ("pro_sup_r", "radial_styloid_r", x),
        ("pro_sup_r", "thumb_tip_r", x),
        ("wrist_flex_r", "middle_tip_r", x),
        ("wrist_dev_r", "middle_tip_r", -z),
        ("finger_spread_r", "index_tip_r", z),
        ("finger_spread_r", "ring_tip_r", -z),
        ("finger_spread_r", "little_tip_r", -z),
        ("index_mcp_flex_r", "index_tip_r", x),
        ("little_pip_flex_r", "little_tip_r", x),
        // Bending, the thumb crosses the palm; abducted, it leaves it.
        ("thumb_cmc_flex_r", "thumb_tip_r", -z),
        ("thumb_cmc_abd_r", "thumb_tip_r", x),
        ("thumb_mcp_flex_r", "thumb_tip_r", -z),
        ("thumb_ip_flex_r", "thumb_tip_r", -z),
    ];
    for (text, table) in [(LEGS, &legs[..]), (ARMS, &arms[..])] {
        let figure = Figure::read(text);
        let rest = figure.at(&[]);
        for &(key, marker, way) in table {
            let moved =
                figure.marker(&figure.at(&[(key, 1.0)]), marker) - figure.marker(&rest, marker);
            // Most of the way, or at least a third of it where an axis is oblique.
            assert!(way.dot(moved) > 0.33 * moved.norm(), "{key} {marker} {moved:?}");
            assert!(moved.norm() > 1e-4, "{key} {marker} {moved:?}");
        }
    }
}

/// Parts of the stature. Legs: Drillis & Contini 1966. Arms: de Leva 1996, a hand of Drillis &
/// Contini.
#[test]
fn segments_have_their_parts_of_the_stature() {
    let legs = Figure::read(LEGS);
    let pose = legs.at(&[]);
    let at = |name: &str| legs.marker(&pose, name);
    let drop = |upper: &str, lower: &str| (at(upper) - at(lower)).y;
    assert!((drop("hip_center_r", "knee_center_r") - 0.245 * STATURE).abs() < 1e-12);
    assert!((drop("knee_center_r", "ankle_center_r") - 0.246 * STATURE).abs() < 1e-12);
    // Heel to toe 0.152, to 0.1 mm.
    let foot = at("toe_tip_r").x - at("heel_r").x;
    assert!((foot - 0.152 * STATURE).abs() < 1e-4, "{foot}");
    // Hips 167 mm apart, 66 below and 71 behind the iliac spines (Delp et al. 1990).
    let hip = Vec3::new(-0.0707, -0.0661, 0.0835);
    assert!((at("hip_center_r") - hip).norm() < 1e-12);

    let arms = Figure::read(ARMS);
    let pose = arms.at(&[]);
    let at = |name: &str| arms.marker(&pose, name);
    let drop = (at("shoulder_center_r") - at("elbow_center_r")).y;
    assert!((drop - 0.1618 * STATURE).abs() < 1e-12, "{drop}");
    let forearm = (at("elbow_center_r") - at("wrist_center_r")).norm();
    assert!((forearm - 0.1545 * STATURE).abs() < 1e-12, "{forearm}");
    // Proximal against middle bone (Dutch arm model): 42.6 / 25.1 and so on. Lengths have 0.1 mm.
    let published = [42.6 / 25.1, 44.7 / 29.1, 40.4 / 24.9, 36.1 / 21.0];
    for (finger, ratio) in FINGERS.iter().zip(published) {
        let joint = |bone: &str| pose.segment(arms.id(&format!("{finger}_{bone}_r"))).translation;
        let proximal = (joint("middle") - joint("proximal")).norm();
        let middle = (joint("distal") - joint("middle")).norm();
        assert!((proximal / middle - ratio).abs() < 0.005, "{finger} {}", proximal / middle);
    }
    // Half the span of 1.016 of the stature and 29 mm (ANSUR II, men) less the reach from the
    // shoulder: the shoulder would lie 165 mm beside the midline. Models have 155 to 175 (Seth et
    // al. 2019, Saul et al. 2014, Rajagopal et al. 2016).
    let reach = drop + forearm + (at("wrist_center_r") - at("middle_tip_r")).norm();
    let aside = 0.5 * (1.016 * STATURE + 0.029) - reach;
    assert!((0.155..0.2).contains(&aside), "{aside}");
}

/// Delp et al. 1990 and Rajagopal et al. 2016 after Inman 1976; Manter 1941.
#[test]
fn axes_of_the_foot_are_oblique_as_published() {
    let legs = Figure::read(LEGS);
    let lean = |a: Vec3| (a.y.atan2(a.x.hypot(a.z)).to_degrees(), (-a.z).atan2(a.x).to_degrees());
    // 80.0 degrees to the tibia, the lateral end 6.1 behind; components to 0.001, 0.06 degrees.
    let (_, ankle) = legs.axis("ankle_angle_r", "talus_r");
    assert!((degrees_between(ankle, -Vec3::Y) - 80.0).abs() < 0.06);
    assert!(((-ankle.x).atan2(ankle.z).to_degrees() - 6.1).abs() < 0.06);
    // It passes below the tips of both malleoli; theirs are on the skin.
    let pose = legs.at(&[]);
    for tip in ["lateral_malleolus_r", "medial_malleolus_r"] {
        let away = beside(legs.marker(&pose, tip), legs.axis("ankle_angle_r", "talus_r"));
        assert!(away < 0.025, "{tip} {away}");
    }
    // 42 degrees up to the front and 16 to the medial side.
    let (up, inward) = lean(legs.axis("subtalar_angle_r", "calcaneus_r").1);
    assert!((up - 42.0).abs() < 1e-4 && (inward - 16.0).abs() < 1e-4, "{up} {inward}");
    // 35.5 degrees across the foot, the lateral end behind.
    let (_, toes) = legs.axis("mtp_angle_r", "toes_r");
    assert!((toes.x.atan2(-toes.z).to_degrees() - 35.5).abs() < 0.06 && toes.y.abs() < 1e-12);
}

/// Van Roy et al. 2005, men: 11.6 degrees in extension, -1.8 in full flexion. The angle is that
/// of the forearm against the plane in which the humerus bends.
#[test]
fn the_carrying_angle_falls_as_the_elbow_bends() {
    let arms = Figure::read(ARMS);
    let angle = |flexion: f64| {
        let pose = arms.at(&[("elbow_flex_r", flexion)]);
        let along = arms.marker(&pose, "wrist_center_r") - arms.marker(&pose, "elbow_center_r");
        along.normalized().z.asin().to_degrees()
    };
    assert!((angle(0.0) - 11.6).abs() < 1e-9, "{}", angle(0.0));
    assert!((angle(143.0) + 1.8).abs() < 1e-5, "{}", angle(143.0));
    assert!((0..143).all(|f| angle(f64::from(f)) > angle(f64::from(f) + 1.0)));
}

/// Pronation turns the radius about the line from its own head to the end of the ulna, 14.5 mm
/// beside the centre of the wrist (Saul et al. 2014).
#[test]
fn the_radius_turns_and_the_ulna_stays() {
    let arms = Figure::read(ARMS);
    let rest = arms.at(&[]);
    let axis = arms.axis("pro_sup_r", "radius_r");
    let head = rest.segment(arms.id("radius_r")).translation;
    let wrist = arms.marker(&rest, "wrist_center_r");
    assert!(beside(head, axis) < 1e-12);
    assert!((beside(wrist, axis) - 0.0145).abs() < 0.15e-3, "{}", beside(wrist, axis));
    let styloid = arms.marker(&rest, "radial_styloid_r");
    for turned in [45.0, 90.0, 180.0] {
        let pose = arms.at(&[("pro_sup_r", turned)]);
        assert_eq!(apart(pose.segment(arms.id("ulna_r")), rest.segment(arms.id("ulna_r"))), 0.0);
        for name in ["ulnar_styloid_r", "elbow_center_r"] {
            let moved = arms.marker(&pose, name) - arms.marker(&rest, name);
            assert_eq!(moved.norm(), 0.0, "{name}");
        }
        // A chord of the circle about the axis, and the head stays.
        let chord = (arms.marker(&pose, "radial_styloid_r") - styloid).norm();
        let expected = 2.0 * beside(styloid, axis) * (0.5 * f64::to_radians(turned)).sin();
        assert!((chord - expected).abs() < 1e-12, "{turned} {chord}");
        assert!((pose.segment(arms.id("radius_r")).translation - head).norm() < 1e-15);
    }
    // Half a turn brings the thumb's side from outside to inside, and the radius across the ulna.
    let pronated = arms.at(&[("pro_sup_r", 180.0)]);
    let ulnar = arms.marker(&rest, "ulnar_styloid_r").z;
    assert!(styloid.z > ulnar && arms.marker(&pronated, "radial_styloid_r").z < wrist.z);
}

/// Neu, Crisco & Wolfe 2001: 3.9 mm between the axes of the wrist.
#[test]
fn the_axes_of_the_wrist_do_not_meet() {
    let arms = Figure::read(ARMS);
    let flexion = arms.axis("wrist_flex_r", "hand_r");
    let deviation = arms.axis("wrist_dev_r", "hand_r");
    assert!((between(flexion, deviation) - 0.0039).abs() < 1e-12);
    assert!((degrees_between(flexion.1, deviation.1) - 90.0).abs() < 1e-9);
    // Flexion goes first: deviation is about an axis that it carries along.
    let pose = |dev: f64| arms.at(&[("wrist_flex_r", 60.0), ("wrist_dev_r", dev)]);
    let [bent, both] = [0.0, 20.0].map(|dev| pose(dev).segment(arms.id("hand_r")).linear);
    let turn = (both * bent.transpose()).log().normalized();
    assert!((turn - bent * Vec3::X).norm() < 1e-12, "{turn:?}");
}

/// Dutch arm model after Hollister et al. 1992: 80.9 degrees between the axes, 9.13 mm apart in a
/// hand of 179 mm; here it is 0.108 of the stature.
#[test]
fn the_axes_of_the_thumb_do_not_meet() {
    let arms = Figure::read(ARMS);
    let flexion = arms.axis("thumb_cmc_flex_r", "thumb_metacarpal_r");
    let abduction = arms.axis("thumb_cmc_abd_r", "thumb_metacarpal_r");
    // Components to 0.001, turned into a frame with angles to 0.1 degree; places to 0.1 mm.
    let angle = degrees_between(flexion.1, abduction.1);
    assert!((angle - 80.9).abs() < 0.15, "{angle}");
    let gap = between(flexion, abduction);
    assert!((gap - 9.13e-3 * (0.108 * STATURE / 0.179)).abs() < 0.15e-3, "{gap}");
    // Both as the source has them, in the axes of the hand, and the second 9.86 mm further on.
    let rest = arms.at(&[]);
    let hand = rest.segment(arms.id("hand_r")).linear.transpose();
    let published = [(flexion.1, [0.745, 0.665, 0.042]), (abduction.1, [-0.468, 0.732, 0.496])];
    for (found, [x, y, z]) in published {
        let off = degrees_between(hand * found, Vec3::new(x, y, z));
        assert!(off < 0.15, "{off}");
    }
    let further = hand.transpose() * Vec3::new(2.64e-3, -5.70e-3, 7.60e-3);
    let base = rest.segment(arms.id("thumb_metacarpal_r")).translation;
    assert!(beside(base, flexion) < 1e-12);
    assert!(beside(base + further, abduction) < 0.15e-3);
    // Abduction is about an axis of the metacarpal, flexion about one of the hand.
    let flexed = |abd: f64| arms.at(&[("thumb_cmc_flex_r", -30.0), ("thumb_cmc_abd_r", abd)]);
    let id = arms.id("thumb_metacarpal_r");
    let [a, b] = [0.0, 10.0].map(|abd| flexed(abd).segment(id).linear);
    let carried = a * rest.segment(id).linear.transpose() * abduction.1;
    assert!(((b * a.transpose()).log().normalized() - carried).norm() < 1e-12);
}

/// The third joint of a finger bends by 2/3 of the second (Rijpkema & Girard 1991): 80 degrees at
/// 120, the Merck Manual's ends of both.
#[test]
fn the_last_joint_follows_the_one_before_it() {
    let arms = Figure::read(ARMS);
    for finger in FINGERS {
        let key = format!("{finger}_pip_flex_r");
        let bend = |pose: &Pose, bone: &str| {
            let turn = arms.motion(pose, arms.id(&format!("{finger}_{bone}_r"))).linear.log();
            assert!(turn.x.abs() + turn.y.abs() < 1e-15);
            turn.z.to_degrees()
        };
        for (second, third) in [(0.0, 0.0), (30.0, 20.0), (75.0, 50.0), (120.0, 80.0)] {
            let pose = arms.at(&[(&key, second)]);
            assert!((bend(&pose, "middle") - second).abs() < 1e-12, "{finger}");
            assert!((bend(&pose, "distal") - third).abs() < 1e-12, "{finger}");
            assert_eq!(bend(&pose, "proximal"), 0.0);
        }
        // A fist brings the tip back to the palm: nearer to the wrist than its own first joint.
        let fist = arms.at(&[(&key, 120.0), (&format!("{finger}_mcp_flex_r"), 90.0)]);
        let wrist = arms.marker(&fist, "wrist_center_r");
        let knuckle = fist.segment(arms.id(&format!("{finger}_proximal_r"))).translation - wrist;
        let tip = arms.marker(&fist, &format!("{finger}_tip_r")) - wrist;
        assert!(tip.norm() < knuckle.norm(), "{finger}");
    }
    let spread = arms.at(&[("finger_spread_r", 25.0)]);
    for (finger, turned) in FINGERS.iter().zip([-25.0, 0.0, 12.5, 25.0]) {
        let id = arms.id(&format!("{finger}_proximal_r"));
        let turn = arms.motion(&spread, id).linear.log().x.to_degrees();
        assert!((turn - turned).abs() < 1e-12, "{finger} {turn}");
    }
}

/// Along straight paths through the ranges no joint moves faster than its coordinates let it.
///
/// Every coordinate that moves a joint turns it at a rate of at most 1 (shares are at most 1), but
/// for the knee's couplings: 0.073 of adduction and 0.341 of rotation over the first 10 degrees,
/// the patella's 1 and its tilt of 7 in 90, and a fifth more for cubics. Origins move by a lever:
/// none for hinges, the offsets between the axes of wrist and thumb, and what the tests of the knee
/// say of it.
#[test]
fn paths_are_smooth() {
    let step = 0.05_f64.to_radians();
    let mut draws = Draws(0x1234_5678_9abc_def1);
    for text in [LEGS, ARMS] {
        let figure = Figure::read(text);
        let ids: Vec<SegmentId> = figure.model.segment_ids().collect();
        let rest = figure.at(&[]);
        // Which coordinates move which joint.
        let moves: Vec<Vec<usize>> = ids
            .iter()
            .map(|&id| {
                let moved = |c: &condyle::Coordinate| {
                    let pose = figure.at(&[(&c.name, 10.0)]);
                    apart(figure.motion(&pose, id), figure.motion(&rest, id)) > 1e-9
                };
                let all = figure.model.coordinates().iter().enumerate();
                all.filter(|(_, c)| moved(c)).map(|(place, _)| place).collect()
            })
            .collect();
        let rates = |name: &str| match name.split('_').next() {
            Some("tibia") => (1.0 + 1.2 * 0.414, 8e-3),
            Some("patella") => (1.2 * 1.078, 70e-3),
            Some("hand") => (1.0, 3.9e-3),
            // 9.9 mm along the metacarpal.
            Some("thumb") if name.starts_with("thumb_metacarpal") => (1.0, 10e-3),
            _ => (1.0, 0.0),
        };
        let mut used = 0.0_f64;
        for _ in 0..6 {
            let (from, to) = (draws.inside(&figure.model), draws.inside(&figure.model));
            let gaps: Vec<f64> = from.iter().zip(&to).map(|(a, b)| (a - b).abs()).collect();
            let count = (gaps.iter().copied().fold(0.0, f64::max) / step).ceil();
            let mut before: Option<Pose> = None;
            for i in 0..=count as usize {
                let s = i as f64 / count;
                let stored: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + s * (b - a)).collect();
                let pose = figure.pose(&stored);
                if let Some(before) = &before {
                    for (&id, moves) in ids.iter().zip(&moves) {
                        let name = &figure.model.segment(id).name;
                        let way: f64 = moves.iter().map(|&place| gaps[place] / count).sum();
                        let (turning, moving) = rates(name);
                        let (a, b) = (figure.motion(before, id), figure.motion(&pose, id));
                        let turned = (a.linear.transpose() * b.linear).log().norm();
                        let moved = (b.translation - a.translation).norm();
                        assert!(turned <= turning * way + 1e-9, "{name} {turned} {way}");
                        assert!(moved <= moving * way + 1e-12, "{name} {moved} {way}");
                        if way > 0.0 {
                            used = used.max(turned / (turning * way));
                        }
                    }
                }
                before = Some(pose);
            }
        }
        // The bound is reached by every hinge.
        assert!(used > 0.999, "{used}");
    }
}

/// A text that goes on with these gives a root its parent; the mirror and the constants of what is
/// included hold for it too.
#[test]
fn they_can_be_hung_on_a_trunk() {
    let text = |file: &str, root: &str, at: &str| {
        format!(
            "condyle = 1\nkind = \"model\"\nname = \"figure\"\ninclude = [\"{file}\"]\n\
             [segment]\ntrunk = {{}}\n{root} = {{ parent = \"trunk\", at = {at} }}\n\
             [joint.ground]\ntype = \"free\"\nsegment = \"trunk\"\n"
        )
    };
    let shoulder = Vec3::new(-0.02, 0.4, 0.17);
    let pelvis = Vec3::new(0.098, -0.071, 0.0);
    for (alone, file, root, at) in
        [(ARMS, "arms.toml", "humerus_r", shoulder), (LEGS, "legs.toml", "pelvis", pelvis)]
    {
        let alone = Figure::read(alone);
        let whole = Figure::read(&text(file, root, &format!("[{}, {}, {}]", at.x, at.y, at.z)));
        assert_eq!(lint::check(&whole.model, &[]), []);
        assert_eq!(whole.model.segments().len(), alone.model.segments().len() + 1);
        let (here, there) = (alone.at(&[]), whole.at(&[]));
        for s in alone.model.segments() {
            // The left humerus hangs on the other side of the trunk.
            let flip = if s.name.ends_with("_l") { -1.0 } else { 1.0 };
            let moved = Affine::from_translation(Vec3::new(at.x, at.y, at.z * flip));
            let expected = moved * here.segment(alone.id(&s.name));
            let found = there.segment(whole.id(&s.name));
            assert!(apart(expected, found) < 1e-15, "{}", s.name);
        }
    }
}
