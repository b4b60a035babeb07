//! Which recorded marker is which marker of the model.

use condyle_diagnostics::{Diagnostic, Error, did_you_mean, listed};
use condyle_model::Model;
use condyle_motion::keypoint::{LIMBS, canonical};
use std::collections::{HashMap, HashSet};

/// A recorded marker and the model's marker of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Match {
    /// Position among the model's markers.
    pub marker: usize,
    /// Position among the recording's labels.
    pub label: usize,
}

/// What may stand between a subject and a marker. A colon always does; the others are also parts of names,
/// and count where [`FEWEST`] markers have the same letters before them.
const SEPARATORS: [char; 7] = [':', '_', '.', '-', '|', '/', ' '];

/// The fewest markers that tell a subject where no colon does; all, of a model that has fewer.
const FEWEST: usize = 3;

/// Sides, which are no subjects.
const SIDES: [&str; 6] = ["l", "r", "left", "right", "lt", "rt"];

/// Letters before the names of markers, with their separator, and what they make of the labels.
struct Prefix<'l> {
    prefix: &'l str,
    /// For each marker of the model its label, and whether only ignoring case.
    labels: Vec<Option<(usize, bool)>>,
    count: usize,
}

impl Prefix<'_> {
    /// The subject: without the separator.
    fn subject(&self) -> &str {
        self.prefix.strip_suffix(SEPARATORS).unwrap_or(self.prefix)
    }
}

/// Matches labels to the model's markers: exactly, then without a `Subject:` prefix, then ignoring case. Every guess is in
/// a warning; a marker is matched once. Labels that together are a set of keypoints find the model's
/// [places for them](KEYPOINT).
///
/// All markers are of one subject, so one prefix holds for all of them; beside it only labels without any
/// are used. It may end in a colon or in another separator, as of `Anna_RFHD`. Where several people are in
/// the recording, `subject` says whose markers they are; without it the one that has more than twice as many
/// of the model's markers as any other.
///
/// # Errors
/// `track/subjects` where several subjects fit, `track/subject` where the one that is asked for is not there.
///
/// ```
/// use condyle::{ModelBuilder, matching::match_markers, math::Vec3};
/// let mut b = ModelBuilder::new("head");
/// let head = b.segment("head", None);
/// b.marker("RFHD", Some(head), Vec3::X);
/// b.marker("LFHD", Some(head), Vec3::Z);
/// let model = b.build().unwrap();
/// let (matches, warnings) = match_markers(&model, &["Anna:RFHD".into(), "lfhd".into()], None).unwrap();
/// assert_eq!(matches.len(), 2);
/// assert_eq!(warnings.len(), 2);
/// let two = ["Anna:RFHD", "Anna:LFHD", "Ben:RFHD", "Ben:LFHD"].map(String::from);
/// assert!(match_markers(&model, &two, None).is_err());
/// let (matches, _) = match_markers(&model, &two, Some("Ben")).unwrap();
/// assert_eq!((matches[0].label, matches[1].label), (2, 3));
/// ```
pub fn match_markers(
    model: &Model,
    labels: &[String],
    subject: Option<&str>,
) -> Result<(Vec<Match>, Vec<Diagnostic>), Error> {
    let mut warnings = vec![];
    let keypoints = keypoints(model, labels, &mut warnings);
    let labels = keypoints.as_deref().unwrap_or(labels);
    let prefixes = prefixes(model, labels);
    let chosen = match subject {
        Some(subject) => Some(asked_for(&prefixes, subject)?),
        None => choose(&prefixes, &mut warnings)?,
    };
    let mut matched: Vec<Option<(usize, bool)>> = vec![None; model.markers().len()];
    let mut of_prefix = vec![];
    if let Some(chosen) = chosen {
        matched.clone_from(&chosen.labels);
        if !chosen.prefix.is_empty() {
            let names = model.markers().iter().zip(&matched).filter(|(_, label)| label.is_some());
            of_prefix = names.map(|(marker, _)| marker.name.as_str()).collect();
        }
    }
    if subject.is_none()
        && let Some(plain) = prefixes.iter().find(|p| p.prefix.is_empty())
    {
        for (place, label) in matched.iter_mut().zip(&plain.labels) {
            *place = place.or(*label);
        }
    }
    if let (Some(chosen), false) = (chosen, of_prefix.is_empty()) {
        let message = format!(
            "markers are taken without their prefix `{}`: {}",
            chosen.prefix,
            listed(of_prefix)
        );
        warnings.push(Diagnostic::warning("track/guessed-marker", message));
    }
    let by_case: Vec<String> = model
        .markers()
        .iter()
        .zip(&matched)
        .filter_map(|(marker, label)| {
            let (label, _) = label.filter(|(_, by_case)| *by_case)?;
            Some(format!("{} for {}", labels[label], marker.name))
        })
        .collect();
    if !by_case.is_empty() {
        let message = format!("markers are taken ignoring case: {}", listed(by_case));
        warnings.push(Diagnostic::warning("track/guessed-marker", message));
    }
    let pairs = matched.into_iter().enumerate();
    let matches = pairs.filter_map(|(marker, label)| Some(Match { marker, label: label?.0 }));
    Ok((matches.collect(), warnings))
}

/// What the markers of a model are called that stand where estimators of poses see the body: this, and the
/// name of the [point](condyle_motion::keypoint::canonical).
pub const KEYPOINT: &str = "keypoint.";

/// The labels of keypoints by the names that a model has for them; `None` where the labels are not those of
/// keypoints, or the model has no markers for them.
///
/// A point is the middle of a joint, where a marker of the same name may lie on the skin. So labels are taken as
/// keypoints where one person has both shoulders, elbows, wrists, hips, knees and ankles, which no set of markers
/// has under such names.
fn keypoints(
    model: &Model,
    labels: &[String],
    warnings: &mut Vec<Diagnostic>,
) -> Option<Vec<String>> {
    let known: HashSet<&str> =
        model.markers().iter().filter_map(|m| m.name.strip_prefix(KEYPOINT)).collect();
    if known.is_empty() {
        return None;
    }
    let parted = |label: &'_ String| {
        let at = label.rfind(':').map_or(0, |at| at + 1);
        (label[..at].to_owned(), canonical(&label[at..]))
    };
    let parted: Vec<(String, Option<&str>)> = labels.iter().map(parted).collect();
    let mut people: HashMap<&str, HashSet<&str>> = HashMap::new();
    for (prefix, part) in &parted {
        people.entry(prefix).or_default().extend(part);
    }
    let whole = people.values().any(|parts| LIMBS.iter().all(|limb| parts.contains(limb)));
    if !whole {
        return None;
    }
    let mut taken: HashSet<(&str, &str)> = HashSet::new();
    let mut unknown = vec![];
    let renamed = parted.iter().zip(labels).map(|((prefix, part), label)| match part {
        Some(part) if known.contains(part) && taken.insert((prefix, part)) => {
            format!("{prefix}{KEYPOINT}{part}")
        }
        _ => {
            unknown.push(label.as_str());
            label.clone()
        }
    });
    let renamed = renamed.collect();
    let message = "the labels are those of keypoints: they are taken where estimators of poses see them, \
                   most in the middle of a joint";
    let mut said = Diagnostic::note("track/keypoints", message);
    if !unknown.is_empty() {
        said = said.with_help(format!("the model has no place for {}", listed(unknown)));
    }
    warnings.push(said);
    Some(renamed)
}

/// All prefixes that make labels markers of the model, the empty one too, in the order of the labels.
fn prefixes<'l>(model: &Model, labels: &'l [String]) -> Vec<Prefix<'l>> {
    let markers = model.markers();
    let exact: HashMap<&str, usize> =
        markers.iter().enumerate().rev().map(|(i, m)| (m.name.as_str(), i)).collect();
    let lower: HashMap<String, usize> =
        markers.iter().enumerate().rev().map(|(i, m)| (m.name.to_lowercase(), i)).collect();
    let mut found: Vec<Prefix<'l>> = vec![];
    let mut places: HashMap<&'l str, usize> = HashMap::new();
    // Exact names before those that differ in case.
    for by_case in [false, true] {
        for (label, text) in labels.iter().enumerate() {
            let ends = text.char_indices().filter(|(_, c)| SEPARATORS.contains(c));
            let starts = ends.map(|(at, c)| at + c.len_utf8());
            for (prefix, name) in std::iter::once(0).chain(starts).map(|at| text.split_at(at)) {
                let marker = match by_case {
                    false => exact.get(name).copied(),
                    true => lower.get(&name.to_lowercase()).copied(),
                };
                let Some(marker) = marker else { continue };
                let place = *places.entry(prefix).or_insert_with(|| {
                    found.push(Prefix { prefix, labels: vec![None; markers.len()], count: 0 });
                    found.len() - 1
                });
                let of_prefix = &mut found[place];
                let taken = of_prefix.labels.iter().flatten().any(|(taken, _)| *taken == label);
                if of_prefix.labels[marker].is_none() && !taken {
                    of_prefix.labels[marker] = Some((label, by_case));
                    of_prefix.count += 1;
                }
            }
        }
    }
    let fewest = FEWEST.min(markers.len().max(2));
    let plain = found.iter().find(|p| p.prefix.is_empty()).map(|p| p.labels.clone());
    let is_plain = |label: usize| plain.iter().flatten().flatten().any(|(l, _)| *l == label);
    found.retain(|p| {
        let subject = p.subject();
        // A label that is a marker as it stands is no other one behind a prefix.
        let own = p.labels.iter().flatten().filter(|(label, _)| !is_plain(*label)).count();
        p.prefix.is_empty()
            || own > 0
                && (p.prefix.ends_with(':')
                    || own >= fewest && !SIDES.contains(&subject.to_lowercase().as_str()))
    });
    found
}

/// The prefix of a subject that is asked for.
fn asked_for<'a, 'l>(prefixes: &'a [Prefix<'l>], subject: &str) -> Result<&'a Prefix<'l>, Error> {
    let named = || prefixes.iter().filter(|p| !p.prefix.is_empty());
    let bare = subject.strip_suffix(SEPARATORS).unwrap_or(subject);
    let exact = named().find(|p| p.subject() == bare);
    let found = exact.or_else(|| named().find(|p| p.subject().eq_ignore_ascii_case(bare)));
    found.ok_or_else(|| {
        let subjects: Vec<&str> = named().map(Prefix::subject).collect();
        let message = format!("no markers of the model are those of a subject `{subject}`");
        let all = || match subjects[..] {
            [] => "no label has a prefix: omit --subject".to_owned(),
            _ => format!("subjects are: {}", subjects.join(", ")),
        };
        let help = did_you_mean(subject, subjects.iter().copied(), all);
        Error::new("track/subject", message).with_help(help)
    })
}

/// The only prefix that fits: the others make less than half as many markers; labels without one win where
/// they make as many.
fn choose<'a, 'l>(
    prefixes: &'a [Prefix<'l>],
    warnings: &mut Vec<Diagnostic>,
) -> Result<Option<&'a Prefix<'l>>, Error> {
    let Some(most) = prefixes.iter().map(|p| p.count).max() else { return Ok(None) };
    let bare = prefixes.iter().find(|p| p.prefix.is_empty());
    let mut subjects = prefixes.iter().filter(|p| !p.prefix.is_empty());
    // Few labels with a prefix beside many without one are of the same person, if nobody else is there.
    if let (Some(bare), Some(one), None) = (bare, subjects.next(), subjects.next())
        && bare.labels.iter().zip(&one.labels).all(|(a, b)| a.is_none() || b.is_none())
    {
        return Ok(Some(one));
    }
    let fitting: Vec<&Prefix<'l>> = prefixes.iter().filter(|p| 2 * p.count >= most).collect();
    let named = || fitting.iter().copied().filter(|p| !p.prefix.is_empty());
    let said = |p: &Prefix<'_>| format!("{} ({} markers)", p.subject(), p.count);
    let plain = fitting.iter().copied().find(|p| p.prefix.is_empty() && p.count == most);
    let others = |chosen: &Prefix<'_>| -> Vec<String> {
        prefixes
            .iter()
            .filter(|p| !p.prefix.is_empty() && p.prefix != chosen.prefix)
            .map(said)
            .collect()
    };
    let only = || {
        let mut named = named();
        named.next().filter(|_| named.next().is_none())
    };
    let apart = |chosen: &Prefix<'_>| {
        // Labels with and without a prefix are of one person if they are different markers.
        plain.is_some_and(|plain| {
            plain.labels.iter().zip(&chosen.labels).all(|(a, b)| a.is_none() || b.is_none())
        })
    };
    let chosen = match plain {
        Some(plain) => only().filter(|chosen| apart(chosen)).unwrap_or(plain),
        None => only().ok_or_else(|| {
            let subjects: Vec<String> = named().map(said).collect();
            let message = format!("several subjects fit the model: {}", listed(subjects));
            let help = "say whose markers are meant: `--subject NAME`";
            Error::new("track/subjects", message).with_help(help)
        })?,
    };
    let others = others(chosen);
    if !others.is_empty() {
        let message = format!("other subjects are in the recording: {}", listed(others));
        let help = "their markers are not used; `--subject NAME` takes another";
        warnings.push(Diagnostic::warning("track/other-subjects", message).with_help(help));
    }
    Ok(Some(chosen))
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::ModelBuilder;

    fn matched(
        names: &[&str],
        labels: &[&str],
        subject: Option<&str>,
    ) -> Result<Vec<usize>, String> {
        let mut b = ModelBuilder::new("body");
        let body = b.segment("body", None);
        names.iter().for_each(|name| {
            b.marker(name, Some(body), Vec3::X);
        });
        let labels: Vec<String> = labels.iter().map(|l| (*l).to_owned()).collect();
        let found = match_markers(&b.build().unwrap(), &labels, subject);
        found
            .map(|(found, _)| found.iter().map(|m| m.label).collect())
            .map_err(|error| error.code().to_owned())
    }

    #[test]
    fn one_prefix_holds_for_all_markers() {
        let names = ["A", "B", "C"];
        for separator in SEPARATORS {
            let join = |list: [&str; 6]| list.map(|l| l.replace(':', &separator.to_string()));
            let two = join(["S1:A", "S2:A", "S1:B", "S2:B", "S1:C", "S2:C"]);
            let two: Vec<&str> = two.iter().map(String::as_str).collect();
            assert_eq!(matched(&names, &two, None), Err("track/subjects".into()), "{separator}");
            assert_eq!(matched(&names, &two, Some("S2")), Ok(vec![1, 3, 5]), "{separator}");
            assert_eq!(matched(&names, &two, Some("S4")), Err("track/subject".into()));
            // Alone, it needs no telling.
            let one: Vec<&str> = two.iter().copied().step_by(2).collect();
            assert_eq!(matched(&names, &one, None), Ok(vec![0, 1, 2]), "{separator}");
        }
        // Of a second person, a marker or two that are less than half are no doubt.
        assert_eq!(matched(&names, &["S1:A", "S2:A", "S2:B", "S2:C"], None), Ok(vec![1, 2, 3]));
        // Labels without a prefix win, and complete those with one.
        assert_eq!(
            matched(&names, &["S1:A", "A", "B", "C", "S1:B", "S1:C"], None),
            Ok(vec![1, 2, 3])
        );
        assert_eq!(matched(&names, &["S1:A", "S1:B", "c"], None), Ok(vec![0, 1, 2]));
        assert_eq!(matched(&names, &["x", "*12"], None), Ok(vec![]));
    }

    #[test]
    fn sides_are_no_subjects() {
        let names = ["ASIS", "PSIS", "KNEE"];
        let labels = ["L_ASIS", "L_PSIS", "L_KNEE", "R_ASIS", "R_PSIS", "R_KNEE"];
        assert_eq!(matched(&names, &labels, None), Ok(vec![]));
    }
}
