//! Suggestions for mistyped names.

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
    // The measure is quadratic in length: nobody mistypes a name of two hundred letters.
    let clip = |s: &str| s.chars().take(200).collect::<String>().to_lowercase();
    let name = clip(name);
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, &clip(candidate)), candidate))
        .filter(|(similarity, _)| *similarity >= 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
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
}
