//! Suggestions for mistyped names.

use std::borrow::Cow;

/// From which similarity on a name is suggested.
const SIMILAR: f64 = 0.8;
/// How many letters of a name are compared: the measure is quadratic in length, and longer
/// names are not typed by hand.
const LONGEST: usize = 200;

/// The candidate that a mistyped name most likely meant.
///
/// Similar means a Jaro-Winkler similarity of at least 0.8 between the lower-case names. The cost
/// grows with the number of candidates: ask only for a message that is shown.
///
/// ```
/// use condyle_diagnostics::nearest;
/// assert_eq!(nearest("knee_angel_r", ["hip_flexion_r", "knee_angle_r"]), Some("knee_angle_r"));
/// assert_eq!(nearest("knee_angel_r", ["lumbar"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = comparable(name);
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates {
        let plain = comparable(candidate);
        let least = best.map_or(SIMILAR, |(similarity, _)| similarity);
        if most_similar(&name, &plain) < least {
            continue;
        }
        let similarity = strsim::jaro_winkler(&name, &plain);
        // Of equals the last wins.
        if similarity >= least {
            best = Some((similarity, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// A bound of the Jaro-Winkler similarity, at a fraction of its cost: at most the letters that two
/// names share in any order match, and with m of them in names of a and b letters Jaro's measure is
/// at most (m/a + m/b + 1)/3, to which Winkler adds a tenth of the rest for each of the first four
/// letters that are equal.
fn most_similar(a: &str, b: &str) -> f64 {
    if !(a.is_ascii() && b.is_ascii()) || a.is_empty() || b.is_empty() {
        return 1.0;
    }
    let mut count = [0u8; 128];
    a.bytes().for_each(|letter| count[usize::from(letter)] += 1);
    let mut shared = 0.0;
    for letter in b.bytes() {
        let left = &mut count[usize::from(letter)];
        if *left > 0 {
            *left -= 1;
            shared += 1.0;
        }
    }
    let jaro = (shared / a.len() as f64 + shared / b.len() as f64 + 1.0) / 3.0;
    let prefix = a.bytes().zip(b.bytes()).take(4).take_while(|(x, y)| x == y).count();
    // A little slack for rounding.
    jaro + 0.1 * prefix as f64 * (1.0 - jaro) + 1e-9
}

/// A name in lower case; copied only if it is not.
fn comparable(name: &str) -> Cow<'_, str> {
    let plain = |b: u8| b.is_ascii() && !b.is_ascii_uppercase();
    if name.len() <= LONGEST && name.bytes().all(plain) {
        return Cow::Borrowed(name);
    }
    Cow::Owned(name.chars().take(LONGEST).collect::<String>().to_lowercase())
}

/// The question after the nearest candidate, or `otherwise` where none is near.
///
/// ```
/// use condyle_diagnostics::did_you_mean;
/// assert_eq!(did_you_mean("tibai", ["tibia"], || unreachable!()), "did you mean `tibia`?");
/// assert_eq!(did_you_mean("x", ["tibia"], || "name a segment".into()), "name a segment");
/// ```
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
    otherwise: impl FnOnce() -> String,
) -> String {
    nearest(name, candidates).map_or_else(otherwise, |near| format!("did you mean `{near}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_like_nothing_has_no_neighbour() {
        assert_eq!(nearest("", ["a", "b"]), None);
        assert_eq!(nearest("R.ASIS", ["r.asis"]), Some("r.asis"));
    }

    #[test]
    fn the_bound_lies_above_the_measure() {
        let names =
            ["knee_angle_r", "knee_angel_r", "bone_12", "bnoe_1", "aab", "baa", "x", "xyzzy"];
        for a in names {
            for b in names {
                let (most, is) = (most_similar(a, b), strsim::jaro_winkler(a, b));
                assert!(most >= is, "{a} {b}: {most} {is}");
            }
        }
    }
}
