//! Which recorded marker is which marker of the model.

use condyle_diagnostics::Diagnostic;
use condyle_model::Model;

/// A recorded marker and the model's marker of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Match {
    /// Position among the model's markers.
    pub marker: usize,
    /// Position among the recording's labels.
    pub label: usize,
}

/// Matches labels to the model's markers: exactly, then without a `Subject:` prefix, then ignoring
/// case. Every guess is a warning; a marker is matched once.
///
/// ```
/// use condyle::{ModelBuilder, matching::match_markers, math::Vec3};
/// let mut b = ModelBuilder::new("head");
/// let head = b.segment("head", None);
/// b.marker("RFHD", Some(head), Vec3::X);
/// b.marker("LFHD", Some(head), Vec3::Z);
/// let model = b.build().unwrap();
/// let (matches, warnings) = match_markers(&model, &["Anna:RFHD".into(), "lfhd".into()]);
/// assert_eq!(matches.len(), 2);
/// assert_eq!(warnings.len(), 2);
/// ```
pub fn match_markers(model: &Model, labels: &[String]) -> (Vec<Match>, Vec<Diagnostic>) {
    let mut warnings = vec![];
    let mut taken = vec![false; labels.len()];
    let mut matched: Vec<Option<usize>> = vec![None; model.markers().len()];
    let bare = |label: &str| label.rsplit(':').next().unwrap_or(label).to_owned();
    type Rule<'a> = (&'a str, &'a dyn Fn(&str, &str) -> bool);
    let rules: [Rule<'_>; 3] = [
        ("", &|label, name| label == name),
        ("without its prefix", &|label, name| bare(label) == name),
        ("ignoring case", &|label, name| bare(label).eq_ignore_ascii_case(name)),
    ];
    for (how, rule) in rules {
        for (index, marker) in model.markers().iter().enumerate() {
            if matched[index].is_some() {
                continue;
            }
            let hit = (0..labels.len()).find(|&l| !taken[l] && rule(&labels[l], &marker.name));
            let Some(label) = hit else { continue };
            taken[label] = true;
            matched[index] = Some(label);
            if !how.is_empty() {
                warnings.push(Diagnostic::warning(
                    "track/guessed-marker",
                    format!(
                        "marker `{}` is taken for the model's `{}` {how}",
                        labels[label], marker.name
                    ),
                ));
            }
        }
    }
    let pairs = matched.into_iter().enumerate();
    (pairs.filter_map(|(marker, label)| Some(Match { marker, label: label? })).collect(), warnings)
}
