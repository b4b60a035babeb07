//! Which marker of the left side is which of the right.

use condyle_math::Vec3;

/// Of a body whose markers have such names and such places at rest, the pairs of left and right by
/// their positions in these lists: by the names, or else by places that mirror each other in an
/// upright plane.
pub(super) fn pairs(names: &[String], places: &[Vec3], up: Vec3) -> Vec<[usize; 2]> {
    let named = by_name(names);
    if named.len() >= 2 { named } else { by_place(places, up) }
}

/// Names of which one is the other with `L` for `R` or `left` for `right`, ignoring case.
fn by_name(names: &[String]) -> Vec<[usize; 2]> {
    let lower: Vec<String> = names.iter().map(|name| name.to_ascii_lowercase()).collect();
    let mut taken = vec![false; names.len()];
    let mut pairs = vec![];
    for (left, name) in lower.iter().enumerate() {
        for partner in partners(name) {
            let free = |&right: &usize| right != left && !taken[right] && lower[right] == partner;
            if !taken[left]
                && let Some(right) = (0..names.len()).find(free)
            {
                (taken[left], taken[right]) = (true, true);
                pairs.push([left, right]);
            }
        }
    }
    pairs
}

/// What a name of the left side may be called on the right, in lower case, the likeliest first:
/// whole words, then a letter at an end, then one between.
fn partners(name: &str) -> Vec<String> {
    let word = name.match_indices("left").map(|(at, _)| (0, at, 4, "right"));
    let end = |at: usize| if at == 0 { 1 } else { 2 };
    let letter = name.match_indices('l').map(|(at, _)| {
        let last = at + 1 == name.len();
        (if at == 0 || last { end(at) } else { 3 }, at, 1, "r")
    });
    let mut places: Vec<_> = word.chain(letter).collect();
    places.sort_by_key(|&(rank, at, ..)| (rank, at));
    let replaced = |(_, at, length, with): (usize, usize, usize, &str)| {
        format!("{}{with}{}", &name[..at], &name[at + length..])
    };
    places.into_iter().map(replaced).collect()
}

/// How far apart, in shares of the whole body's size, two places may be to count as one.
const ALIKE: f64 = 0.03;

/// Places that are each other's nearest image in the horizontal direction that gives the most pairs.
fn by_place(places: &[Vec3], up: Vec3) -> Vec<[usize; 2]> {
    let n = places.len();
    let middle = places.iter().fold(Vec3::ZERO, |sum, &p| sum + p) * (1.0 / n.max(1) as f64);
    let size = places.iter().map(|&p| (p - middle).norm()).fold(0.0, f64::max);
    let within = ALIKE * size;
    let found =
        [Vec3::X, Vec3::Y, Vec3::Z].into_iter().filter(|axis| axis.dot(up) == 0.0).map(|axis| {
            let image = |p: Vec3| p - axis * (2.0 * (p - middle).dot(axis));
            let nearest = |i: usize| {
                let off = |j: &usize| (places[*j] - image(places[i])).norm();
                (0..n).min_by(|a, b| off(a).total_cmp(&off(b))).filter(|j| off(j) <= within)
            };
            let mutual = |i: usize| nearest(i).filter(|&j| i < j && nearest(j) == Some(i));
            (0..n).filter_map(|i| Some([i, mutual(i)?])).collect::<Vec<_>>()
        });
    let best = found.max_by_key(Vec::len).unwrap_or_default();
    if best.len() >= 2 { best } else { vec![] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &[&str]) -> Vec<[usize; 2]> {
        by_name(&names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn sides_are_told_by_names_in_every_dialect() {
        for [left, right] in [
            ["LASI", "RASI"],
            ["L_knee", "r_knee"],
            ["L.Acromium", "R.Acromium"],
            ["ankle_l", "ankle_r"],
            ["LeftHeel", "RightHeel"],
            ["heel_left", "heel_Right"],
            ["Ankle.L", "Ankle.R"],
            ["toe_l_lat", "toe_r_lat"],
            ["LLLE", "RLLE"],
        ] {
            assert_eq!(named(&[right, "SACR", left]), [[2, 0]], "{left}");
        }
        assert!(named(&["LASI", "C7", "clavicle", "STRN", "L1"]).is_empty());
    }

    #[test]
    fn sides_without_names_are_told_by_places() {
        let names: Vec<String> = (0..5).map(|i| format!("M{i}")).collect();
        let place = |x, y, z| Vec3::new(x, y, z);
        let places = [
            place(0.1, 1.0, 0.2),
            place(0.1, 1.005, -0.2),
            place(-0.2, 0.1, 0.3),
            place(-0.2, 0.1, -0.3),
            place(0.0, 1.4, 0.0),
        ];
        assert_eq!(pairs(&names, &places, Vec3::Y), [[0, 1], [2, 3]]);
        assert!(pairs(&names[..1], &places[..1], Vec3::Y).is_empty());
    }
}
