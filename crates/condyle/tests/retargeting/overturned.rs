//! Feet and hands that a recording turned over, as programs that fit skeletons to few markers do.

use crate::figure::{Arms, Figure};
use crate::{carried, places};
use condyle::math::{Quat, Vec3};
use condyle::model::CoordinateKind;
use condyle::retargeting::Options;
use condyle::{Model, Motion};
use std::f64::consts::PI;

/// Turns a bone about a line in its own axes, in some frames. The bones are balls, in their order.
fn turned(model: &Model, motion: &mut Motion, bone: usize, line: Vec3, frames: [usize; 2]) {
    let turns = |id: &condyle::model::CoordinateId| {
        model.coordinate(*id).kind == CoordinateKind::Orientation
    };
    let id = model.coordinate_ids().filter(turns).nth(bone).unwrap();
    let half = Quat::from_axis_angle(line.normalized(), PI);
    for frame in &mut motion.frames[frames[0]..frames[1]] {
        let stored = &mut frame[model.stored_range(id)];
        let [x, y, z, w] = stored.try_into().unwrap();
        stored.copy_from_slice(&(Quat { x, y, z, w } * half).to_array());
    }
}

#[test]
fn what_a_recording_turned_over_is_turned_back() {
    let source = Figure::default();
    let model = source.model();
    let motion = source.motion(&model, 120);
    let mut over = motion.clone();
    // The left foot's line at rest is 14 cm forward, 5 cm down and 1 cm to the left; the right hand's goes on as the arm.
    let world = source.world();
    turned(&model, &mut over, 15, world * Vec3::new(0.14, -0.05, -0.01), [40, 120]);
    turned(&model, &mut over, 12, world * Vec3::new(0.0, 0.0, 1.0), [0, 70]);
    let target = Figure { arms: Arms::A, odd_axes: true, ..source };
    let other = target.model();
    let [whole, mended] =
        [&motion, &over].map(|motion| carried(&model, motion, &other, Options::default()));
    let told = |code: &str, of: &condyle::retargeting::Retargeted| {
        of.warnings.iter().filter(|warning| warning.code == code).count()
    };
    assert_eq!(told("retarget/turned-over", &whole), 0);
    assert_eq!(told("retarget/turned-over", &mended), 2);
    // The repair is exact: half a turn and half a turn is none. What is left is the solver's tolerance, squared 1e-6.
    let pairs = places(&other, &whole.motion).into_iter().zip(places(&other, &mended.motion));
    for (frame, (a, b)) in pairs.enumerate() {
        for (joint, (a, b)) in a.iter().zip(&b).enumerate() {
            let off = (*a - *b).norm();
            assert!(off < 1e-3, "frame {frame}, joint {joint}: {off} m");
        }
    }
}
