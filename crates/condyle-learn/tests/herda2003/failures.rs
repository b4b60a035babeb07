//! What the method is known not to do, and what is lost in its polygon.

use crate::shapes::{Random, around, mean, samples, shoulder};
use condyle_learn::limits::herda2003::{
    Chart, Failure, Histogram, Options, Placement, Primitive, Removed, SphereField, SphereLimit,
    Split, SwingPolygon, project,
};
use condyle_math::{Quat, Vec3};

/// Eleven spheres at most: of the numbers in `docs/learned-limits.md` the one that finds the shoulder best.
fn learned(cloud: &[Quat], placement: Placement, split: Split) -> SphereLimit {
    let options = Options { placement, split, most: 11, ..Options::default() };
    SphereLimit::learn(cloud, mean(cloud), options).expect("the cloud has a volume")
}

#[test]
fn a_hole_in_the_data_is_covered() {
    // Figure 16 of the paper: "because our implicit surface covers data gaps, we allow orientations that
    // should have been invalidated". No sample lies within 20 degrees of the middle of the shape.
    let mut random = Random::new(16);
    let middle = mean(&samples(&shoulder, 2000, &mut random));
    let hole = 20f64.to_radians();
    assert!(around(hole, 200).iter().all(|step| shoulder(middle * *step)), "the hole is inside");
    let holed = |q: Quat| shoulder(q) && q.angle_to(middle) > hole;
    let cloud = samples(&holed, 5000, &mut random);
    for placement in [Placement::AsRecorded, Placement::Centred] {
        let limit = learned(&cloud, placement, Split::Six);
        let steps: Vec<Quat> =
            [3.0, 6.0, 9.0, 12.0].iter().flat_map(|a| around(f64::to_radians(*a), 100)).collect();
        let allowed = steps.iter().filter(|step| limit.allows(middle * **step)).count();
        println!("{placement:?}: {allowed} of {} rotations in the hole are allowed", steps.len());
        assert!(allowed * 10 > steps.len() * 9, "{placement:?}: {allowed}");
    }
}

#[test]
fn far_outside_nothing_can_be_projected() {
    let mut random = Random::new(15);
    let cloud = samples(&shoulder, 1500, &mut random);
    let limit = learned(&cloud, Placement::Centred, Split::Six);
    let (mut dead, mut found) = (0, 0);
    for _ in 0..2000 {
        let q = random.rotation();
        match project(&limit, q) {
            Err(Failure::NoField) => {
                assert_eq!(limit.value(q), 0.0);
                dead += 1;
            }
            Err(_) => {}
            Ok(answer) => {
                // Inside, up to the rounding of a rotation that is turned to a point again.
                assert!(limit.value(answer) > 1.0 - 1e-9);
                found += 1;
            }
        }
    }
    println!("{dead} of 2000 rotations have no field, {found} have an answer");
    assert!(dead > 100 && found > 100, "{dead} {found}");
}

#[test]
fn the_polygon_of_a_ball_is_a_circle() {
    // One sphere of radius ½ about the identity: all rotations by at most 60 degrees. Those that swing by β
    // twist by at most τ with cos(τ/2)·cos(β/2) = cos 30°: 60 degrees at rest, none at β = 60.
    let limit = SphereLimit {
        chart: Chart::new(Quat::IDENTITY, Placement::Centred),
        field: SphereField {
            primitives: vec![Primitive { centre: Vec3::ZERO, radius: 0.5 }],
            stickiness: 5.0,
        },
        energy: 0.0,
        history: Vec::new(),
        removed: Removed::default(),
    };
    let polygon = SwingPolygon::new(&limit, Vec3::Y, Quat::IDENTITY, 36).expect("a circle");
    let sixty = 60f64.to_radians();
    let [low, high] = polygon.cone.twist_at_rest().expect("the twist is limited");
    assert!((low + sixty).abs() < 1e-6 && (high - sixty).abs() < 1e-6, "{low} {high}");
    // The reach is found by halving 2.5 degrees twelve times; the twist 0 is one of its samples.
    for point in polygon.cone.points() {
        let reach = point.direction.y.acos().to_degrees();
        assert!((reach - 60.0).abs() < 0.001, "{reach}");
    }
    let mut random = Random::new(17);
    let (mut same, mut either, mut both) = (0, 0, 0);
    for _ in 0..100_000 {
        let q = random.rotation();
        let (field, cone) = (limit.allows(q), polygon.allows(q));
        same += usize::from(field == cone);
        either += usize::from(field || cone);
        both += usize::from(field && cone);
    }
    println!("{same} of 100000 the same, {both} of {either} inside of either inside of both");
    // (60° - sin 60°)/π = 5.8 % of all rotations are inside: a polygon that allows none would agree on 94.2 %.
    assert!(same > 98_000, "{same}");
    assert!(both * 10 > either * 8, "{both} of {either}");
    // Where nothing is possible around the reference there is no polygon.
    let far = Quat::from_axis_angle(Vec3::X, 3.0);
    assert!(SwingPolygon::new(&limit, Vec3::Y, far, 36).is_err());
}

#[test]
fn most_of_another_subject_is_inside() {
    // Figure 12 (b): the field of one subject on another. The other is the same shoulder, turned by 20 degrees.
    let mut random = Random::new(12);
    let cloud = samples(&shoulder, 3000, &mut random);
    let limit = learned(&cloud, Placement::Centred, Split::Six);
    let turn = Quat::from_axis_angle(Vec3::Z, 20f64.to_radians());
    let share = |cloud: &[Quat]| {
        let inside = cloud.iter().filter(|q| limit.allows(**q)).count();
        inside as f64 / cloud.len() as f64
    };
    let other: Vec<Quat> =
        samples(&shoulder, 3000, &mut random).into_iter().map(|q| turn * q).collect();
    let (own, others) = (share(&cloud), share(&other));
    let counts =
        |cloud: &[Quat]| Histogram::of(cloud.iter().map(|q| limit.value(*q)), 0.0, 4.0, 8).counts;
    println!("own {own:.3} {:?}, another {others:.3} {:?}", counts(&cloud), counts(&other));
    // "Predictably, there are more points outside the surface".
    assert!(own > 0.7 && others < own && others > 0.5, "{own} {others}");
}
