//! Force platforms: where they are, and which analog channels are theirs.

use super::parameters::Parameters;
use super::vertical::Up;
use condyle_motion::LengthUnit;

/// A force platform.
#[derive(Debug, Clone, PartialEq)]
pub struct Platform {
    /// Its type: 1 gives a centre of pressure, 2 forces and moments, 3 eight forces, 4 is type 2 with a matrix
    /// of calibration.
    pub kind: u8,
    /// Its corners in the order of its quadrants, in metres, turned as the markers are.
    pub corners: [[f64; 3]; 4],
    /// Of types 2 and 4 the way from its origin to the middle of its top, in metres and in its own axes; of type
    /// 3 half the distances of its sensors and the height of its top.
    pub origin: [f64; 3],
    /// Positions of its analog channels, counted from 0.
    pub channels: Vec<usize>,
    /// Of type 4 the matrix that makes forces and moments of voltages, column by column; else empty.
    pub calibration: Vec<f64>,
}

/// The platforms that a file describes, as far as it describes them.
pub(super) fn read(parameters: &Parameters, unit: LengthUnit, up: Up) -> Vec<Platform> {
    let group = ["FORCE_PLATFORM", "FORCE_PLATEFORM", "FORCE_PLATFORMS"];
    let Some(group) = group.into_iter().find(|name| parameters.group(name).is_some()) else {
        return vec![];
    };
    let numbers = |name: &str| parameters.numbers(group, name);
    let (types, corners, origins) = (numbers("TYPE"), numbers("CORNERS"), numbers("ORIGIN"));
    let (channels, calibration) = (numbers("CHANNEL"), numbers("CAL_MATRIX"));
    let used = parameters.count(group, "USED").unwrap_or(types.len());
    let size = |name: &str| {
        let sizes = parameters.get(group, name).and_then(|p| p.sizes.first());
        sizes.map_or(0, |&size| usize::from(size))
    };
    let per_platform = match size("CHANNEL") {
        0 => 6,
        size => size,
    };
    let metres = |place: [f64; 3]| place.map(|x| unit.to_metres(x));
    (0..used.min(types.len()))
        .map(|index| {
            let kind = types[index].clamp(0.0, 255.0) as u8;
            let place = |list: &[f64], at: usize| {
                let part = list.get(3 * at..3 * at + 3);
                part.and_then(|part| part.try_into().ok()).unwrap_or([0.0; 3])
            };
            let most = if kind == 3 { 8 } else { 6 };
            let own = channels.iter().skip(index * per_platform).take(per_platform.min(most));
            let own = own.filter(|c| **c >= 1.0).map(|c| *c as usize - 1);
            let entries = 36;
            let matrix = calibration.get(entries * index..entries * (index + 1));
            Platform {
                kind,
                corners: [0, 1, 2, 3].map(|c| up.turned(metres(place(&corners, 4 * index + c)))),
                origin: metres(place(&origins, index)),
                channels: own.collect(),
                calibration: matrix.filter(|_| kind == 4).unwrap_or_default().to_vec(),
            }
        })
        .collect()
}
