//! What is learned of recordings, whose frames lie along curves, when whole takes are left out.

use condyle_learn::limits::{Cloud, SPACING, Settings, independent, learn, left_out};
use condyle_math::{Quat, Vec3};

/// Turns by less than 60 degrees, as a person goes around in them for a take: along a curve whose three numbers move at
/// rates without a common measure, bent at the ball.
fn take(number: usize) -> Vec<Quat> {
    let most = 60f64.to_radians();
    let start = 7.3 * number as f64;
    (0..1500)
        .map(|frame| {
            let t = start + 0.02 * f64::from(frame);
            let wave = |rate: f64, phase: f64| (rate * t + phase * number as f64).sin();
            let turn =
                Vec3::new(wave(1.0, 0.4), wave(1.618, 1.1), wave(2.236, 2.3)) * (1.15 * most);
            let length = turn.norm();
            Quat::exp(if length > most { turn * (most / length) } else { turn })
        })
        .collect()
}

#[test]
fn a_limit_holds_nineteen_of_twenty_rotations_of_takes_that_it_has_not_seen() {
    let takes: Vec<Vec<Quat>> = (0..6).map(take).collect();
    let slices: Vec<&[Quat]> = takes.iter().map(Vec::as_slice).collect();
    assert!(slices.iter().all(|take| !independent(take)));
    let settings = Settings { nodes: 48, ..Settings::default() };
    let left = left_out(&slices, SPACING, &settings).unwrap();
    assert!(left.whole_takes && left.parts == 6);
    // 95 % of those that were left out, or more where the least offset, of two degrees, holds more.
    assert!(left.held(left.gap) > 0.948, "{}", left.held(left.gap));
    assert!(left.reaching(0.5) <= left.gap && left.gap <= 15f64.to_radians());
    let cloud = Cloud::gather(&slices, SPACING).unwrap();
    let bare = learn(&cloud, &Settings { gap: Some(0.0), ..settings }).unwrap();
    let field = learn(&cloud, &left.settings(&settings)).unwrap();
    let new: Vec<Quat> = (40..46).flat_map(take).collect();
    let inside = |field: &condyle_learn::limits::Field| {
        new.iter().filter(|q| field.outer_distance(**q) >= 0.0).count() as f64 / new.len() as f64
    };
    // Frames that are not thinned, of other takes.
    assert!(
        inside(&field) > 0.93 && inside(&bare) < inside(&field),
        "{} {}",
        inside(&bare),
        inside(&field)
    );
    // All turn by less than 60 degrees: what turns by 60 and the offset, and a step of the lattice, is outside.
    let far = 60f64.to_radians() + left.gap + 0.1;
    for axis in Vec3::UNITS {
        assert!(field.distance(Quat::from_axis_angle(axis, far)) < 0.0);
    }
    // More is held with a thicker layer, all with a thick one, and outside + inside are everything.
    assert!((left.held(0.0) + left.outside - 1.0).abs() < 1e-12);
    assert!(left.held(left.gap) >= left.held(0.0) && left.held(1.0) == 1.0);
}

#[test]
fn few_takes_are_cut_into_blocks() {
    let takes = [take(0), take(1)];
    let slices: Vec<&[Quat]> = takes.iter().map(Vec::as_slice).collect();
    let settings = Settings { nodes: 32, ..Settings::default() };
    let left = left_out(&slices, SPACING, &settings).unwrap();
    assert_eq!((left.parts, left.whole_takes), (8, false));
}
