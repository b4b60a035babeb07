//! What the tests of legs and arms ask of both.
//!
//! Each function asserts one thing of a figure whose coordinates have `_r` and `_l` alike, by a
//! table of the right side.

use crate::figure::{Draws, Figure, apart, turns};
use condyle::math::{Affine, Vec3};
use condyle::{Coordinate, Pose, SegmentId};

/// Asserts that a table of coordinates, segments and ends in degrees is that of all ranges, the
/// left ones alike, and that the joint turns so far at each end, unless no segment is named.
#[track_caller]
pub(crate) fn assert_ranges(figure: &Figure, table: &[(&str, &str, f64, f64)]) {
    assert_eq!(figure.model.coordinates().len(), 2 * table.len());
    for &(key, segment, low, high) in table {
        let left = format!("{}_l", key.strip_suffix("_r").expect(key));
        for key in [key, &left] {
            let ends = figure.range(key);
            let off = (ends[0] - low).abs() + (ends[1] - high).abs();
            assert!(off < 1e-12, "{key} {ends:?}");
        }
        for end in [low, high].into_iter().filter(|_| !segment.is_empty()) {
            let turned = figure.motion(&figure.at(&[(key, end)]), figure.id(segment));
            let angle = match key {
                // Of the knee's three turns the first.
                "knee_angle_r" => turns(turned)[0].abs(),
                _ => turned.linear.log().norm(),
            };
            assert!((angle.to_degrees() - end.abs()).abs() < 1e-9, "{key} {end} {angle}");
        }
    }
}

/// Asserts which way a coordinate takes a landmark when it grows from 0.
#[track_caller]
pub(crate) fn assert_signs(figure: &Figure, table: &[(&str, &str, Vec3)]) {
    let rest = figure.at(&[]);
    for &(key, marker, way) in table {
        let moved = figure.marker(&figure.at(&[(key, 1.0)]), marker) - figure.marker(&rest, marker);
        // Most of the way, or at least a third of it where an axis is oblique.
        assert!(way.dot(moved) > 0.33 * moved.norm(), "{key} {marker} {moved:?}");
        assert!(moved.norm() > 1e-4, "{key} {marker} {moved:?}");
    }
}

/// Asserts that along straight paths no joint turns, and no origin moves, faster than the rates of
/// its segment times the steps of the coordinates that move it.
#[track_caller]
pub(crate) fn assert_smooth(figure: &Figure, rates: impl Fn(&str) -> (f64, f64)) {
    let step = 0.05_f64.to_radians();
    let mut draws = Draws(0x1234_5678_9abc_def1);
    let ids: Vec<SegmentId> = figure.model.segment_ids().collect();
    let rest = figure.at(&[]);
    // Which coordinates move which joint.
    let moves: Vec<Vec<usize>> = ids
        .iter()
        .map(|&id| {
            let moved = |c: &Coordinate| {
                let pose = figure.at(&[(&c.name, 10.0)]);
                apart(figure.motion(&pose, id), figure.motion(&rest, id)) > 1e-9
            };
            let all = figure.model.coordinates().iter().enumerate();
            all.filter(|(_, c)| moved(c)).map(|(place, _)| place).collect()
        })
        .collect();
    let mut used = 0.0_f64;
    for _ in 0..6 {
        let path = draws.way(&figure.model, step);
        let strides = path.strides();
        let mut before: Option<Pose> = None;
        for i in 0..=path.steps {
            let pose = figure.open(&path.after(i));
            if let Some(before) = &before {
                for (&id, moves) in ids.iter().zip(&moves) {
                    let name = &figure.model.segment(id).name;
                    let way: f64 = moves.iter().map(|&place| strides[place]).sum();
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

/// Asserts that a text can include the file and hang its root on a trunk, and that all segments
/// are then where they were, seen from there.
#[track_caller]
pub(crate) fn assert_hangs(alone: &Figure, file: &str, root: &str, at: Vec3) {
    let whole = Figure::of(&format!(
        "condyle = 1\nkind = \"model\"\nname = \"figure\"\ninclude = [\"{file}\"]\n\
         [segment]\ntrunk = {{}}\n{root} = {{ parent = \"trunk\", at = [{}, {}, {}] }}\n\
         [joint.ground]\ntype = \"free\"\nsegment = \"trunk\"\n",
        at.x, at.y, at.z
    ));
    whole.assert_unremarked();
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
