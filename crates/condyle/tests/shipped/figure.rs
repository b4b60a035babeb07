//! A shipped model made ready, and what all tests of shipped models do with it.
//!
//! The contract:
//! - A [`Figure`] is read without warnings, or the test fails. [`Figure::shipped`] reads a text of
//!   the library, [`Figure::alone`] one that includes no other, [`Figure::of`] a text that a test
//!   has made.
//! - Numbers are radians and metres. Where they are degrees, the function says so.
//! - Coordinates that are not named are at 0. [`Figure::at`] and [`Figure::open`] take numbers as
//!   they are; limits hold only in [`Figure::pose`] with [`Mode::Posed`].
//! - Joints are read as motions from the joint in the parent to the joint in the segment, so a
//!   joint at rest is the identity ([`Figure::motion`]; its parents must not stretch).
//! - x is forward, y up, z to the right. The mirror is that of z, and the name of the other side
//!   has `_l` for `_r` ([`Mirror`]).
//! - [`Draws`] are the same in every run.

use condyle::check;
use condyle::formats::document;
use condyle::math::{Affine, EulerOrder, Mat3, Vec3};
use condyle::{Coordinate, Mode, Model, Pose, Program, SegmentId, shipped};

/// A model made ready.
pub(crate) struct Figure {
    pub(crate) model: Model,
    pub(crate) program: Program,
}

impl Figure {
    /// A shipped model, with all that it includes.
    #[track_caller]
    pub(crate) fn shipped(name: &str) -> Self {
        let read = shipped::read(name).expect(name);
        assert_eq!(read.warnings, [], "{name}");
        Self::ready(read.value.model)
    }

    /// A shipped model whose text includes no other: written to stand alone it is what it was.
    #[track_caller]
    pub(crate) fn alone(name: &str) -> Self {
        let (text, copy) = (shipped::text(name).expect(name), shipped::standalone(name));
        assert!(copy.expect(name) == text, "{name} includes another");
        Self::shipped(name)
    }

    /// A text that a test has made. It may include shipped models and their parts by file name.
    #[track_caller]
    pub(crate) fn of(text: &str) -> Self {
        let include = &mut |file: &str| {
            let models = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
            std::fs::read_to_string(models.join(file)).map_err(|error| error.to_string())
        };
        let read = document::read(text, include).expect("a model");
        assert_eq!(read.warnings, []);
        Self::ready(read.value.model)
    }

    fn ready(model: Model) -> Self {
        let program = Program::compile(&model);
        Self { model, program }
    }

    /// The pose of stored numbers.
    pub(crate) fn pose(&self, stored: &[f64], mode: Mode) -> Pose {
        let mut pose = Pose::new(&self.program);
        self.program.evaluate(stored, mode, &mut pose).expect("buffers of this program");
        pose
    }

    /// The pose of stored numbers as they are, limits not applied.
    pub(crate) fn open(&self, stored: &[f64]) -> Pose {
        self.pose(stored, Mode::Open)
    }

    /// The pose with some coordinates set in degrees, the others at 0, limits not applied.
    #[track_caller]
    pub(crate) fn at(&self, degrees: &[(&str, f64)]) -> Pose {
        self.open(&self.degrees(degrees))
    }

    /// Stored numbers with some coordinates set in degrees, the others at 0.
    #[track_caller]
    pub(crate) fn degrees(&self, values: &[(&str, f64)]) -> Vec<f64> {
        let radians: Vec<(&str, f64)> =
            values.iter().map(|(key, value)| (*key, value.to_radians())).collect();
        self.set(&radians)
    }

    /// Stored numbers with some coordinates set, the others at 0.
    #[track_caller]
    pub(crate) fn set(&self, values: &[(&str, f64)]) -> Vec<f64> {
        let mut stored = vec![0.0; self.model.stored_len()];
        for (key, value) in values {
            stored[self.place(key)] = *value;
        }
        stored
    }

    /// Where a coordinate has its (first) number.
    #[track_caller]
    pub(crate) fn place(&self, key: &str) -> usize {
        self.model.stored_range(self.model.find_coordinate(key).expect(key)).start
    }

    /// Both ends of a coordinate's range, in degrees.
    #[track_caller]
    pub(crate) fn range(&self, key: &str) -> [f64; 2] {
        let range = self.model.coordinate(self.model.find_coordinate(key).expect(key)).range;
        [range.lower, range.upper].map(|side| side.expect(key).to_degrees())
    }

    #[track_caller]
    pub(crate) fn id(&self, segment: &str) -> SegmentId {
        self.model.find_segment(segment).expect(segment)
    }

    /// What the joint of a segment does in a pose. No parent of it may stretch.
    pub(crate) fn motion(&self, pose: &Pose, segment: SegmentId) -> Affine {
        let s = self.model.segment(segment);
        let joint_in_world = pose.frame(s.parent) * s.joint_in_parent;
        joint_in_world.rigid_inverse() * pose.segment(segment) * s.joint_in_segment
    }

    /// The segment that carries a marker, and the marker's place on it.
    #[track_caller]
    pub(crate) fn landmark(&self, name: &str) -> (SegmentId, Vec3) {
        let marker = self.model.markers().iter().find(|m| m.name == name).expect(name);
        (marker.segment.expect("a segment"), marker.point)
    }

    /// Where a marker is in a pose.
    #[track_caller]
    pub(crate) fn marker(&self, pose: &Pose, name: &str) -> Vec3 {
        let (segment, point) = self.landmark(name);
        pose.segment(segment) * point
    }

    /// A point and a direction of the axis about which a joint turns when one coordinate leaves 0,
    /// in the world of the pose at 0.
    #[track_caller]
    pub(crate) fn axis(&self, key: &str, segment: &str) -> (Vec3, Vec3) {
        let rest = self.at(&[]).segment(self.id(segment));
        let moved = self.at(&[(key, 1.0)]).segment(self.id(segment)) * rest.rigid_inverse();
        let turn = moved.linear.log();
        let (angle, along) = (turn.norm(), turn.normalized());
        // The point nearest to the origin: p = (t + cot(angle / 2) a × t) / 2 for t across a.
        let t = moved.translation;
        assert!(t.dot(along).abs() < 1e-12, "{key} slides");
        ((t + along.cross(t) * (1.0 / (0.5 * angle).tan())) * 0.5, along)
    }

    /// Asserts that the lint finds nothing.
    #[track_caller]
    pub(crate) fn assert_unremarked(&self) {
        assert_eq!(check::check(&self.model, &[]), []);
    }

    /// Asserts that every coordinate names the source of its numbers.
    #[track_caller]
    pub(crate) fn assert_sourced(&self) {
        for coordinate in self.model.coordinates() {
            let named = coordinate.source.as_ref().is_some_and(|s| !s.is_empty());
            assert!(named, "{}", coordinate.name);
        }
    }

    /// Asserts that in a pose every segment is where its joint is, to 1e-15.
    #[track_caller]
    pub(crate) fn assert_at_rest(&self, pose: &Pose) {
        for id in self.model.segment_ids() {
            let s = self.model.segment(id);
            let rest =
                pose.frame(s.parent) * s.joint_in_parent * s.joint_in_segment.rigid_inverse();
            assert!(apart(pose.segment(id), rest) < 1e-15, "{}", s.name);
        }
    }

    /// How numbers and segments of one side belong to those of the other. A coordinate whose
    /// `joint/name` is told to be turned over changes its sign in the mirror.
    #[track_caller]
    pub(crate) fn mirror(&self, turned_over: impl Fn(&str) -> bool) -> Mirror<'_> {
        let coordinates = self.model.coordinate_ids().map(|id| {
            let coordinate = self.model.coordinate(id);
            let joint = &self.model.joint_sets()[coordinate.joint_set.index()].name;
            let key = format!("{joint}/{}", coordinate.name);
            let sign = if turned_over(&key) { -1.0 } else { 1.0 };
            (self.place(&key), self.place(&other_side(&key)), sign)
        });
        let twin = |id: SegmentId| self.id(&other_side(&self.model.segment(id).name));
        let segments = self.model.segment_ids().map(|id| (id, twin(id)));
        Mirror { figure: self, coordinates: coordinates.collect(), segments: segments.collect() }
    }
}

/// The mirror between right and left of a figure.
pub(crate) struct Mirror<'a> {
    figure: &'a Figure,
    /// The place of a number, that of the other side, and the sign between them.
    coordinates: Vec<(usize, usize, f64)>,
    segments: Vec<(SegmentId, SegmentId)>,
}

impl Mirror<'_> {
    /// z turned over.
    pub(crate) fn plane() -> Mat3 {
        Mat3::from_columns(Vec3::X, Vec3::Y, -Vec3::Z)
    }

    /// The numbers of the posture that the mirror shows.
    pub(crate) fn numbers(&self, stored: &[f64]) -> Vec<f64> {
        let mut other = stored.to_vec();
        for &(here, there, sign) in &self.coordinates {
            other[there] = sign * stored[here];
        }
        other
    }

    /// Asserts that all segments of a second pose are where the mirror shows those of the first, to
    /// a bound on every number.
    #[track_caller]
    pub(crate) fn assert_segments(&self, pose: &Pose, mirrored: &Pose, bound: f64) {
        let flip = Self::plane();
        for &(here, there) in &self.segments {
            let one = pose.segment(here);
            let seen = Affine::new(flip * one.linear * flip, flip * one.translation);
            let off = apart(seen, mirrored.segment(there));
            assert!(off < bound, "{}: {off:e}", self.figure.model.segment(here).name);
        }
    }

    /// Asserts the same of all markers, to a distance.
    #[track_caller]
    pub(crate) fn assert_markers(&self, pose: &Pose, mirrored: &Pose, bound: f64) {
        for marker in self.figure.model.markers() {
            let seen = Self::plane() * self.figure.marker(pose, &marker.name);
            let there = self.figure.marker(mirrored, &other_side(&marker.name));
            let off = (seen - there).norm();
            assert!(off < bound, "{}: {off:e}", marker.name);
        }
    }
}

/// The name, or `joint/name`, on the other side; what is in the middle keeps its own.
fn other_side(key: &str) -> String {
    let side = |name: &str| match (name.strip_suffix("_r"), name.strip_suffix("_l")) {
        (Some(stem), _) => format!("{stem}_l"),
        (_, Some(stem)) => format!("{stem}_r"),
        _ => name.to_owned(),
    };
    key.split('/').map(side).collect::<Vec<String>>().join("/")
}

/// The largest difference between the numbers of two placements.
pub(crate) fn apart(a: Affine, b: Affine) -> f64 {
    a.to_rows().iter().zip(b.to_rows()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Flexion, bending and rotation of a motion M = Rz(-flexion) Rx(bending) Ry(rotation), which is
/// the order of spine and knee: bending to the right or adduction, rotation to the left or inward.
pub(crate) fn turns(motion: Affine) -> [f64; 3] {
    let order: EulerOrder = "zxy".parse().expect("an order");
    let [z, x, y] = order.from_mat3(motion.linear);
    [-z, x, y]
}

/// How far two lines, each a point and a direction, are from each other.
pub(crate) fn between((p, a): (Vec3, Vec3), (q, b): (Vec3, Vec3)) -> f64 {
    a.cross(b).normalized().dot(q - p).abs()
}

/// How far a point is from a line.
pub(crate) fn beside(point: Vec3, (p, a): (Vec3, Vec3)) -> f64 {
    a.cross(point - p).norm()
}

pub(crate) fn degrees_between(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

/// Numbers that are the same in every run (xorshift).
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    /// A number in [0, 1).
    pub(crate) fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// All coordinates somewhere in their ranges; a side without end is at -1 or 1.
    pub(crate) fn inside(&mut self, model: &Model) -> Vec<f64> {
        let inside = |c: &Coordinate, share: f64| {
            let (low, high) = (c.range.lower.unwrap_or(-1.0), c.range.upper.unwrap_or(1.0));
            low + (high - low) * share
        };
        model.coordinates().iter().map(|c| inside(c, self.share())).collect()
    }

    /// A straight way between two postures inside the ranges, on which no coordinate makes a step
    /// that is larger than the one given.
    pub(crate) fn way(&mut self, model: &Model, step: f64) -> Way {
        let (from, to) = (self.inside(model), self.inside(model));
        let longest = from.iter().zip(&to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        Way { from, to, steps: (longest / step).ceil() as usize }
    }
}

/// A straight way between two postures, in equal steps.
pub(crate) struct Way {
    from: Vec<f64>,
    to: Vec<f64>,
    pub(crate) steps: usize,
}

impl Way {
    /// The stored numbers after some steps.
    pub(crate) fn after(&self, steps: usize) -> Vec<f64> {
        let share = steps as f64 / self.steps as f64;
        self.from.iter().zip(&self.to).map(|(a, b)| a + share * (b - a)).collect()
    }

    /// How far one step moves each stored number.
    pub(crate) fn strides(&self) -> Vec<f64> {
        let steps = self.steps as f64;
        self.from.iter().zip(&self.to).map(|(a, b)| (a - b).abs() / steps).collect()
    }
}
