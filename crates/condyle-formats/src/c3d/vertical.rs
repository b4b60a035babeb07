//! Which way is up in a file, and the turn that makes it y.

use super::parameters::Parameters;
use condyle_diagnostics::{Diagnostic, Warnings};

/// The axis of a file that points up.
///
/// ```
/// use condyle_formats::c3d::Up;
/// assert_eq!(Up::Z.turned([1.0, 2.0, 3.0]), [1.0, 3.0, -2.0]);
/// assert_eq!(Up::Z.back([1.0, 3.0, -2.0]), [1.0, 2.0, 3.0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Up {
    /// 0, 1 or 2 for x, y or z.
    pub axis: u8,
    /// Whether its positive end points up.
    pub positive: bool,
}

impl Up {
    /// As in memory.
    pub const Y: Self = Self { axis: 1, positive: true };
    /// As in most laboratories.
    pub const Z: Self = Self { axis: 2, positive: true };

    /// Its name with its sign: `+Z`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match (self.axis, self.positive) {
            (0, true) => "+X",
            (0, false) => "-X",
            (1, true) => "+Y",
            (1, false) => "-Y",
            (_, true) => "+Z",
            (_, false) => "-Z",
        }
    }

    /// A point of the file with y up, turned about one axis by as little as that takes.
    #[must_use]
    pub fn turned(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        // 0 - x has no negative zero.
        match (self.axis, self.positive) {
            (0, true) => [0.0 - y, x, z],
            (0, false) => [y, 0.0 - x, z],
            (1, true) => [x, y, z],
            (1, false) => [x, 0.0 - y, 0.0 - z],
            (_, true) => [x, z, 0.0 - y],
            (_, false) => [x, 0.0 - z, y],
        }
    }

    /// The way back.
    #[must_use]
    pub fn back(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match (self.axis, self.positive) {
            (0, true) => [y, 0.0 - x, z],
            (0, false) => [0.0 - y, x, z],
            (1, true) => [x, y, z],
            (1, false) => [x, 0.0 - y, 0.0 - z],
            (_, true) => [x, 0.0 - z, y],
            (_, false) => [x, z, 0.0 - y],
        }
    }

    fn named(text: &str) -> Option<Self> {
        let text = text.trim().to_ascii_uppercase();
        let (sign, name) = match text.strip_prefix('-') {
            Some(name) => (false, name),
            None => (true, text.strip_prefix('+').unwrap_or(&text)),
        };
        let axis = match name.trim() {
            "X" => 0,
            "Y" => 1,
            "Z" => 2,
            _ => return None,
        };
        Some(Self { axis, positive: sign })
    }
}

/// Which way is up: the direction in which force platforms are flat, else that of `POINT:Y_SCREEN`, else
/// that in which alone the markers are never far below zero. Its sign is that of the places of markers where nearly
/// all have the same: they are above the floor.
///
/// `points` are places in the file's own axes and `scale` makes metres of them.
pub(super) fn find(
    parameters: &Parameters,
    points: &[[f64; 3]],
    scale: f64,
    warnings: &mut Warnings,
) -> Up {
    let said = Up::named(&parameters.text("POINT", "Y_SCREEN"));
    let flat = flat_axis(parameters);
    let guess = || only_floor(points, scale);
    let (axis, reason) = match (flat, said, points.is_empty()) {
        (Some(axis), _, _) => (axis, "as the force platforms lie"),
        (None, Some(up), _) => (up.axis, "as POINT:Y_SCREEN says"),
        (None, None, false) => match guess() {
            Some(found) => found,
            None => return Up::Y,
        },
        (None, None, true) => return Up::Y,
    };
    let stated = said.filter(|up| up.axis == axis).is_none_or(|up| up.positive);
    let above = points.iter().filter(|p| p[usize::from(axis)] > 0.0).count();
    let positive = match points.len() {
        0 => stated,
        all if 20 * above >= 19 * all => true,
        all if 20 * above <= all => false,
        _ => stated,
    };
    let up = Up { axis, positive };
    if up == Up::Y {
        return up;
    }
    let message = format!("{} points up, {reason}", up.name());
    let help = "markers are turned so that y does; written C3D files have the file's own axes";
    let said = match (flat, said) {
        (None, None) => Diagnostic::warning("c3d/up", message),
        _ => Diagnostic::note("c3d/up", message),
    };
    warnings.push(said.with_help(help));
    up
}

/// The axis across which all corners of platforms are the same, to a hundredth of their span.
fn flat_axis(parameters: &Parameters) -> Option<u8> {
    let corners = parameters.numbers("FORCE_PLATFORM", "CORNERS");
    let corners = corners.as_chunks::<3>().0.get(..4)?;
    let span = [0, 1, 2].map(|axis| {
        let (low, high) = corners
            .iter()
            .map(|c| c[axis])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high): (f64, f64), x| {
                (low.min(x), high.max(x))
            });
        high - low
    });
    let mut order = [0usize, 1, 2];
    order.sort_by(|&a, &b| span[a].total_cmp(&span[b]));
    let [least, middle, _] = order;
    (span[least] < 0.02 * span[middle]).then_some(least as u8)
}

/// The only axis along which all markers are between a floor at zero and the height of a person; of several such axes, as
/// where people stand in one corner of the laboratory, the only one along which some of them are on that floor.
fn only_floor(points: &[[f64; 3]], scale: f64) -> Option<(u8, &'static str)> {
    if points.len() < 4 {
        return None;
    }
    let along = |axis: u8| points.iter().map(move |p| scale * p[usize::from(axis)]);
    let share = |axis: u8, height: f64| {
        along(axis).filter(|x| *x < height).count() as f64 / points.len() as f64
    };
    let is_floor = |axis: &u8| {
        let high = along(*axis).fold(f64::NEG_INFINITY, f64::max);
        share(*axis, -0.05) <= 0.005 && (0.3..3.0).contains(&high)
    };
    let only = |axes: &[u8]| match axes {
        [axis] => Some(*axis),
        _ => None,
    };
    let floors: Vec<u8> = (0..3).filter(is_floor).collect();
    // Feet are a twentieth of all markers or more, and nothing else is lower than 20 cm for long.
    let stood: Vec<u8> = floors.iter().copied().filter(|&axis| share(axis, 0.2) >= 0.05).collect();
    let far = floors.iter().all(|&axis| stood.contains(&axis) || share(axis, 0.3) == 0.0);
    let one = only(&floors).map(|axis| (axis, "as only there no marker is below a floor at zero"));
    let other = || only(&stood).map(|axis| (axis, "as only there markers are on a floor at zero"));
    one.or_else(|| other().filter(|_| far))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_stands_in_a_corner_stands_on_the_floor() {
        // Two feet, two knees, a head, one and two metres from the origin.
        let one = |x: f64| {
            [0.05, 0.08, 0.5, 0.52, 1.7]
                .map(|height| [x + 0.1 * height, 2.0 - 0.2 * height, height])
        };
        let points: Vec<[f64; 3]> = [1.0, 1.1, 1.2].into_iter().flat_map(one).collect();
        assert_eq!(only_floor(&points, 1.0).map(|found| found.0), Some(2));
        // Without feet it is not known.
        let above: Vec<[f64; 3]> = points.iter().map(|[x, y, z]| [*x, *y, z + 0.4]).collect();
        assert_eq!(only_floor(&above, 1.0), None);
        // Beside the origin only one axis has a floor.
        let beside: Vec<[f64; 3]> = above.iter().map(|[x, y, z]| [x - 1.1, y - 1.8, *z]).collect();
        assert_eq!(only_floor(&beside, 1.0).map(|found| found.0), Some(2));
    }

    #[test]
    fn turns_are_rotations_that_bring_up_to_y_and_go_back() {
        for axis in 0..3u8 {
            for positive in [true, false] {
                let up = Up { axis, positive };
                let mut point = [0.0; 3];
                point[usize::from(axis)] = if positive { 1.0 } else { -1.0 };
                assert_eq!(up.turned(point), [0.0, 1.0, 0.0], "{up:?}");
                assert_eq!(up.back(up.turned([1.0, 2.0, 3.0])), [1.0, 2.0, 3.0], "{up:?}");
                let [x, y, z] =
                    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| up.turned(e));
                let cross = [
                    x[1] * y[2] - x[2] * y[1],
                    x[2] * y[0] - x[0] * y[2],
                    x[0] * y[1] - x[1] * y[0],
                ];
                assert_eq!(cross, z, "{up:?} is no mirror");
                assert_eq!(Up::named(up.name()), Some(up));
            }
        }
        assert_eq!(Up::named(" z "), Some(Up::Z));
        assert_eq!(Up::named("up"), None);
    }
}
