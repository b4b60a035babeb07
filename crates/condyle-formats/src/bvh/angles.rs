//! Three angles of a rotation that follow those of the frame before.

use condyle_math::{EulerOrder, Mat3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The order of most such files, Rz·Rx·Ry: taken unless it comes near its singular pose.
const USUAL: [usize; 3] = [2, 0, 1];
/// Farther than this from the singular pose, in radians, the usual order is as good as any: 15°.
const FAR: f64 = PI / 12.0;

/// The order whose middle angle stays farthest from ±90° in all of these rotations; the usual one where it
/// stays far enough.
pub(super) fn order(rotations: impl Iterator<Item = Mat3> + Clone) -> EulerOrder {
    let room = |order: EulerOrder| {
        let left = rotations.clone().map(|turn| {
            let [_, middle, _] = order.from_mat3(turn);
            FRAC_PI_2 - middle.abs()
        });
        left.fold(f64::INFINITY, f64::min)
    };
    let usual = EulerOrder::ALL.into_iter().find(|order| order.axes() == USUAL);
    let usual = usual.unwrap_or(EulerOrder::XYZ);
    if room(usual) >= FAR {
        return usual;
    }
    let mut best = (usual, room(usual));
    for order in EulerOrder::ALL.into_iter().filter(|o| o.axes()[0] != o.axes()[2]) {
        let room = room(order);
        // A better order must be clearly better, so that rounding does not choose.
        if room > best.1 + 1e-9 {
            best = (order, room);
        }
    }
    best.0
}

/// The angles of a rotation nearest to those before: of the two triples that give it, with any whole turns.
pub(super) fn following(order: EulerOrder, turn: Mat3, before: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = order.from_mat3(turn);
    let near = |triple: [f64; 3]| {
        let mut own = triple;
        for (angle, before) in own.iter_mut().zip(before) {
            *angle -= TAU * ((*angle - before) / TAU).round();
        }
        own
    };
    let far = |triple: &[f64; 3]| {
        triple.iter().zip(before).map(|(angle, before)| (angle - before).powi(2)).sum::<f64>()
    };
    let (first, second) = (near([a, b, c]), near([a + PI, PI - b, c + PI]));
    if far(&second) < far(&first) { second } else { first }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_goes_round_twice_has_no_jump() {
        let order: EulerOrder = "zxy".parse().unwrap();
        let mut angles = [0.0; 3];
        for step in 0..=720 {
            let angle = f64::from(step).to_radians();
            angles = following(order, Mat3::rotation_y(angle), angles);
            assert!((angles[2] - angle).abs() < 1e-9, "{step}: {angles:?}");
        }
    }

    #[test]
    fn the_order_is_away_from_its_singular_pose() {
        // A turn about x by 90° is singular in the order z, x, y.
        let turns = (0..=18).map(|step| Mat3::rotation_x(f64::from(10 * step).to_radians()));
        let chosen = order(turns.clone());
        assert_ne!(chosen.axes()[1], 0, "{chosen}");
        let small = (0..=6).map(|step| Mat3::rotation_x(f64::from(10 * step).to_radians()));
        assert_eq!(order(small).axes(), USUAL);
    }
}
