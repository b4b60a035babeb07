//! Chains of one kind of joint, for every kind there is.

use crate::random::Random;
use condyle_math::function::{Function, SimmSpline};
use condyle_math::{Affine, Quat, Scalar, Vec3};
use condyle_model::component::{
    Along, Centre, ConstantCurvature, Contact, ContactPair, Curve, Depend, Ellipsoid, Gliding,
    Heading, JointCone, Law, MotionLaw, Pivot, Registry, Scale, Shear, Signal, SurfaceAxis,
    Swinging,
};
use condyle_model::{
    Cone, ConePoint, CoordinateKind, JointSetId, Model, ModelBuilder, Projection, Range, SegmentId,
};

/// One kind of joint: its name, whether it is one of the simple ones, and how it is made.
pub struct Kind {
    /// What it is called in tables.
    pub name: &'static str,
    /// Whether it has few fixed axes, like the joints of most skeletons.
    pub simple: bool,
    make: fn(&mut ModelBuilder, JointSetId, SegmentId) -> Signal,
}

const OBLIQUE: Vec3 = Vec3::new(0.6, -0.48, 0.64);

fn angle(b: &mut ModelBuilder, set: JointSetId, name: &str) -> Signal {
    b.coordinate(set, name, CoordinateKind::Rotation).into()
}

fn turns(b: &mut ModelBuilder, set: JointSetId, axes: &[Vec3]) -> Vec<Signal> {
    axes.iter()
        .enumerate()
        .map(|(i, &axis)| {
            let angle = angle(b, set, &format!("angle_{i}"));
            b.rotate(set, &format!("turn_{i}"), angle, axis)
        })
        .collect()
}

fn slides(b: &mut ModelBuilder, set: JointSetId, axes: &[Vec3]) -> Vec<Signal> {
    axes.iter()
        .enumerate()
        .map(|(i, &axis)| {
            let along = b.coordinate(set, &format!("slide_{i}"), CoordinateKind::Translation);
            b.translate(set, &format!("along_{i}"), along, axis)
        })
        .collect()
}

fn scale(b: &mut ModelBuilder, set: JointSetId, along: Along) -> Signal {
    let factor = b.coordinate(set, "factor", CoordinateKind::Scale).into();
    b.component(set, "scale", Law::Scale(Scale { along }), vec![factor])
}

fn path() -> Box<[SimmSpline; 3]> {
    let u = vec![-1.5, -0.5, 0.4, 1.6];
    Box::new([[0.0, 0.1, 0.2, 0.25], [0.0, 0.02, 0.0, -0.03], [0.01, 0.0, 0.01, 0.0]].map(|y| {
        SimmSpline::new(u.clone(), y.to_vec()).unwrap_or_else(|e| panic!("increasing: {e}"))
    }))
}

fn curve(b: &mut ModelBuilder, set: JointSetId, heading: Option<Heading>) -> Signal {
    let parameter = angle(b, set, "parameter");
    let curve = Law::Curve(Curve { path: path(), heading });
    b.component(set, "curve", curve, vec![parameter])
}

fn pivot(b: &mut ModelBuilder, set: JointSetId, centre: Centre) -> Signal {
    let angle = angle(b, set, "angle");
    let pivot = Pivot::new(Vec3::Z, centre).unwrap_or_else(|e| panic!("an axis: {e}"));
    b.pivot(set, "pivot", angle, pivot)
}

/// A cone of 14 control points, as in the source's figure 5, with bounds of twist.
pub fn cone(rest: Vec3, half: f64) -> Cone {
    let across = rest.cross(Vec3::new(0.31, -0.72, 0.62)).normalized();
    let beside = rest.cross(across);
    let points = (0..14).map(|i| {
        let (s, c) = (std::f64::consts::TAU * f64::from(i) / 14.0).sin_cos();
        let (far, near) = (half * (1.0 + 0.2 * (2.0 * s * c))).sin_cos();
        let direction = rest * near + (across * c + beside * s) * far;
        ConePoint { direction, twist: Some([-0.6, 0.5]) }
    });
    Cone::new(rest, Some([-0.8, 0.9]), points.collect(), 2, Projection::Nearest)
        .unwrap_or_else(|e| panic!("star-shaped: {e}"))
}

fn ball_in_cone(b: &mut ModelBuilder, set: JointSetId, half: f64) -> Signal {
    let angles = ["first", "second", "third"].map(|name| angle(b, set, name));
    let axes = [Vec3::Z, Vec3::X, Vec3::Y];
    let cone = Law::Cone(JointCone { of: Swinging::Angles(axes), cone: cone(-Vec3::Y, half) });
    let Signal::Output(id, _) = b.component(set, "cone", cone, angles.to_vec()) else {
        unreachable!("a component has outputs")
    };
    let turns = (0..3)
        .map(|k| b.rotate(set, &format!("turn_{k}"), Signal::Output(id, k), axes[k as usize]));
    let turns = turns.collect();
    b.product(set, "product", turns)
}

/// The position of the scapula in the thorax in the default pose.
pub const SCAPULA: Vec3 = Vec3::new(-0.02, 0.02, 0.16);

/// Ribs and three pairs of points on a scapula; the sizes are realistic but invented.
pub fn gliding() -> Gliding {
    let (centre, radii) = (Vec3::new(-0.03, -0.1, 0.05), Vec3::new(0.1, 0.18, 0.1));
    // Directions from the centre of the ribs to where they touch, as seen from the scapula's joint.
    let point = |x, y, z| centre + Vec3::new(x, y, z).normalized().times(radii) - SCAPULA;
    let pair = |first, second, at| ContactPair { first, second, at };
    let pairs = vec![
        pair(point(-0.83, 0.5, 0.28), point(-0.93, -0.1, 0.3), [0.3, 0.0]),
        pair(point(-0.85, 0.4, 0.25), point(-0.93, -0.2, 0.3), [-0.1, 0.1]),
        pair(point(-0.87, 0.3, 0.3), point(-0.9, -0.2, 0.5), [0.1, 0.8]),
    ];
    let ribs = Affine::from_translation(centre);
    Gliding::new(ribs, radii, Vec3::new(0.1, 0.97, 0.2), pairs)
        .unwrap_or_else(|e| panic!("ribs: {e}"))
}

/// A user-defined law that costs as little as a hinge with a lift.
#[derive(Debug)]
struct Cam;

impl MotionLaw for Cam {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let (s, c) = inputs[0].sin_cos();
        let turn = condyle_math::Mat3::identity().rotated_z((s, c));
        Affine::new(turn, Vec3::new(S::zero(), (S::one() - c).scale(0.02), S::zero()))
    }
}

/// Every kind of joint.
pub fn kinds() -> Vec<Kind> {
    let kind = |name, simple, make| Kind { name, simple, make };
    vec![
        kind("weld", true, |b, set, _| b.place(set, "place", Affine::IDENTITY)),
        kind("hinge about x", true, |b, set, _| turns(b, set, &[Vec3::X])[0]),
        kind("hinge about any axis", true, |b, set, _| turns(b, set, &[OBLIQUE])[0]),
        kind("universal", true, |b, set, _| {
            let turns = turns(b, set, &[Vec3::Z, Vec3::X]);
            b.product(set, "product", turns)
        }),
        kind("three axes (zxy)", false, |b, set, _| {
            let turns = turns(b, set, &[Vec3::Z, Vec3::X, Vec3::Y]);
            b.product(set, "product", turns)
        }),
        kind("quaternion ball", true, |b, set, _| {
            let q = b.coordinate(set, "q", CoordinateKind::Orientation);
            b.ball(set, "ball", q)
        }),
        kind("prismatic", true, |b, set, _| slides(b, set, &[OBLIQUE])[0]),
        kind("three translations", true, |b, set, _| {
            let slides = slides(b, set, &Vec3::UNITS);
            b.product(set, "product", slides)
        }),
        kind("planar", true, |b, set, _| {
            let mut factors = slides(b, set, &[Vec3::X, Vec3::Y]);
            factors.extend(turns(b, set, &[Vec3::Z]));
            b.product(set, "product", factors)
        }),
        kind("free (quaternion)", true, |b, set, _| {
            let mut factors = slides(b, set, &Vec3::UNITS);
            let q = b.coordinate(set, "q", CoordinateKind::Orientation);
            factors.push(b.ball(set, "ball", q));
            b.product(set, "product", factors)
        }),
        kind("screw", true, |b, set, _| {
            let angle = angle(b, set, "angle");
            let advance = b.map(set, "advance", angle, Function::linear(0.003, 0.0));
            let factors = vec![
                b.rotate(set, "turn", angle, Vec3::X),
                b.translate(set, "along", advance, Vec3::X),
            ];
            b.product(set, "product", factors)
        }),
        kind("scale", true, |b, set, _| scale(b, set, Along::Everywhere)),
        kind("scale along an axis", true, |b, set, _| scale(b, set, Along::Axis(OBLIQUE))),
        kind("scale, volume kept", true, |b, set, _| scale(b, set, Along::Volume(Vec3::X))),
        kind("shear", true, |b, set, _| {
            let amount = angle(b, set, "amount");
            let shear = Law::Shear(Shear { along: Vec3::X, across: Vec3::Y });
            b.component(set, "shear", shear, vec![amount])
        }),
        kind("curve", false, |b, set, _| curve(b, set, None)),
        kind("curve, turning", false, |b, set, _| {
            curve(b, set, Some(Heading { forward: Vec3::X, up: Vec3::Y }))
        }),
        kind("pivot, one centre", true, |b, set, _| {
            pivot(b, set, Centre::Intervals(vec![(1.0, Vec3::new(0.01, 0.02, 0.0))]))
        }),
        kind("pivot, two centres", false, |b, set, _| {
            let centres = [(0.4, Vec3::X * 0.01), (2.0, Vec3::Y * 0.02)];
            pivot(b, set, Centre::Intervals(centres.to_vec()))
        }),
        kind("pivot, smooth path", false, |b, set, _| pivot(b, set, Centre::Path(path()))),
        kind("ellipsoid", false, |b, set, _| {
            let angles = ["first", "second", "third"].map(|name| angle(b, set, name));
            let (radii, axis) = (Vec3::new(0.07, 0.15, 0.07), SurfaceAxis::Normal);
            let glide = Law::Ellipsoid(Ellipsoid { radii, axis });
            b.component(set, "ellipsoid", glide, angles.to_vec())
        }),
        kind("constant curvature", false, |b, set, _| {
            let angles = ["first", "second", "third"].map(|name| angle(b, set, name));
            let column = ConstantCurvature { neutral: [0.1, 0.2, 0.0], length: 0.2 };
            b.constant_curvature(set, "column", angles, column)
        }),
        kind("depend + hinge", false, |b, set, _| {
            let (passive, driver) = (angle(b, set, "passive"), angle(b, set, "driver"));
            let lower = Some(Function::linear(0.3, -0.4));
            let held = b.depend(set, "held", passive, driver, Depend { lower, upper: None });
            b.rotate(set, "turn", held, Vec3::Z)
        }),
        kind("cone + three axes, inside", false, |b, set, _| ball_in_cone(b, set, 2.2)),
        kind("cone + three axes, outside", false, |b, set, _| ball_in_cone(b, set, 0.15)),
        kind("compensate + hinge", false, |b, set, segment| {
            let above: Vec<SegmentId> = b.segment_at(segment.index() - 1).into_iter().collect();
            let undo = b.compensate(set, "undo", segment, &above, 1.0);
            let turn = turns(b, set, &[Vec3::Z])[0];
            b.product(set, "product", vec![undo, turn])
        }),
        kind("contact + hinge", false, |b, set, segment| {
            let before = turns(b, set, &[Vec3::Z])[0];
            let [lift, turn] = ["lift", "turn"].map(|name| angle(b, set, name));
            // The segment before this one carries the ribs.
            let surface = b.segment_at(segment.index() - 1).unwrap_or(segment);
            let contact = Law::Contact(Contact { before: true, most_gap: None, law: gliding() });
            let inputs = vec![segment.into(), surface.into(), before, lift, turn];
            let glide = b.component(set, "glide", contact, inputs);
            b.product(set, "product", vec![before, glide])
        }),
        kind("a user's law", false, |b, set, _| {
            let inputs = vec![angle(b, set, "angle")];
            let mut registry = Registry::default();
            registry.register("cam", &["angle"], |_| Ok(Cam));
            let cam = registry.make("cam", Default::default());
            let cam = cam.unwrap_or_else(|e| panic!("registered: {e}"));
            b.component(set, "cam", Law::Custom(cam), inputs)
        }),
    ]
}

/// A root and a line of joints of one kind.
pub fn line(kind: &Kind, joints: usize) -> Model {
    let mut b = ModelBuilder::new(kind.name);
    let mut last = b.segment("root", None);
    for i in 0..joints {
        let segment = b.segment(&format!("bone{i}"), Some(last));
        b.place_joint(segment, Vec3::new(0.01, 0.08, -0.005 * (i % 3) as f64));
        let set = b.joint_set(&format!("joint{i}"));
        let motion = (kind.make)(&mut b, set, segment);
        b.output(set, segment, motion);
        last = segment;
    }
    b.build().unwrap_or_else(|findings| panic!("{} is well formed: {findings:?}", kind.name))
}

/// Stored numbers within half a radian of the defaults, orientations within a radian.
pub fn poses(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let mut random = Random::new(11);
    (0..count)
        .map(|_| {
            let mut stored = model.defaults();
            for id in model.coordinate_ids() {
                let place = model.stored_range(id);
                if place.len() == 4 {
                    let v = Vec3::new(random.signed(), random.signed(), random.signed());
                    stored[place].copy_from_slice(&Quat::exp(v).to_array());
                } else {
                    let wide = if model.coordinate(id).range == Range::FREE { 0.5 } else { 0.2 };
                    stored[place.start] += wide * random.signed();
                }
            }
            stored
        })
        .collect()
}
