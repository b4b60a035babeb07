//! UsdSkel as far as it is written; the answers of usd-core are compared with it.

use condyle::math::{Affine, Mat3, Quat, Vec3};
use std::collections::HashMap;

/// The transforms of all joints in the world, in every frame.
pub(crate) fn joints(text: &str) -> Vec<HashMap<String, Affine>> {
    let paths: Vec<&str> = text
        .lines()
        .find_map(|line| line.trim().strip_prefix("uniform token[] joints = ["))
        .map(|rest| rest.split('"').skip(1).step_by(2).collect())
        .unwrap();
    let turns = samples(text, "quatf[] rotations", 4);
    let places = samples(text, "float3[] translations", 3);
    let sizes = samples(text, "half3[] scales", 3);
    (0..places.len())
        .map(|frame| {
            let mut by_path: HashMap<&str, Affine> = HashMap::new();
            for (i, path) in paths.iter().enumerate() {
                let [w, x, y, z] = turns[frame][i][..] else { panic!("{path}: a turn") };
                let turn = Quat::from([x, y, z, w]).normalized().to_mat3();
                let size = sizes.get(frame).map_or(&[1.0, 1.0, 1.0][..], |all| &all[i]);
                let linear =
                    Mat3::from_columns(turn.x * size[0], turn.y * size[1], turn.z * size[2]);
                let [x, y, z] = places[frame][i][..] else { panic!("{path}: a place") };
                let local = Affine::new(linear, Vec3::new(x, y, z));
                let above = path.rsplit_once('/').map_or(Affine::IDENTITY, |(up, _)| by_path[up]);
                by_path.insert(path, above * local);
            }
            let named = |(path, at): (&str, Affine)| {
                (path.rsplit('/').next().unwrap_or_default().to_owned(), at)
            };
            by_path.into_iter().map(named).collect()
        })
        .collect()
}

/// The tuples of every sample of an attribute; none where it is not sampled.
fn samples(text: &str, name: &str, width: usize) -> Vec<Vec<Vec<f64>>> {
    let Some((_, rest)) = text.split_once(&format!("{name}.timeSamples = {{\n")) else {
        return vec![];
    };
    let (lines, _) = rest.split_once('}').unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        let (_, list) = line.split_once(": [").unwrap();
        let digits = list.split(['(', ')', ',', ' ', ']']);
        digits.filter(|x| !x.is_empty()).map(|x| x.parse().unwrap()).collect()
    };
    let lines = lines.lines().filter(|line| line.contains(": ["));
    lines.map(|line| numbers(line).chunks(width).map(<[f64]>::to_vec).collect()).collect()
}
