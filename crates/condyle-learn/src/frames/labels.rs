//! Which label of a recording is a marker of a recipe: by its name; else without `Subject:`, else ignoring case, and at
//! each of these steps by other names that the recipe gives.

use super::Recipe;
use condyle_diagnostics::{Diagnostic, Error, did_you_mean, listed};
use condyle_motion::Recording;

/// A marker that was taken under another name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// The marker of the recipe.
    pub marker: String,
    /// The label of the recording.
    pub label: String,
    /// In what they differ.
    pub how: Guessed,
}

/// In what a label differs from the marker that it was taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guessed {
    /// The label has a subject's name before a colon.
    Subject,
    /// The letters differ in case.
    Case,
    /// It is another name that the recipe gives.
    Other,
}

/// What is before the last colon of a label, and what is after it.
fn parted(label: &str) -> (Option<&str>, &str) {
    match label.rsplit_once(':') {
        Some((subject, name)) => (Some(subject.trim()), name.trim()),
        None => (None, label.trim()),
    }
}

pub(super) fn label(
    recipe: &Recipe,
    recording: &Recording,
    marker: &str,
    subject: Option<&str>,
) -> Result<(usize, Option<Guess>), Error> {
    let also = recipe.also.iter().find(|place| place.name == marker);
    let also = also.map_or(&[][..], |place| &place.markers[..]);
    let names: Vec<&str> = std::iter::once(marker).chain(also.iter().map(String::as_str)).collect();
    let meant = |label: &str| match (subject, parted(label).0) {
        (None, _) => true,
        (Some(wanted), Some(found)) => wanted.eq_ignore_ascii_case(found),
        (Some(_), None) => false,
    };
    type Fits = fn(&str, &str) -> bool;
    let steps: [(Option<Guessed>, Fits); 3] = [
        (None, |label, name| label == name),
        (Some(Guessed::Subject), |label, name| parted(label).1 == name),
        (Some(Guessed::Case), |label, name| parted(label).1.eq_ignore_ascii_case(name)),
    ];
    for (how, fits) in steps {
        for (rank, name) in names.iter().enumerate() {
            let labels = recording.labels.iter().enumerate();
            let mut hits = labels.filter(|(_, label)| fits(label, name) && meant(label));
            match (hits.next(), hits.next()) {
                (None, _) => {}
                (Some((index, label)), None) => {
                    let how = if rank > 0 { Some(Guessed::Other) } else { how };
                    let guess =
                        |how| Guess { marker: marker.to_owned(), label: label.clone(), how };
                    return Ok((index, how.map(guess)));
                }
                (Some((_, one)), Some((_, two))) => {
                    let message =
                        format!("marker `{marker}` of the recipe may be `{one}` or `{two}`");
                    let help = "say whose markers are meant: the name of the subject";
                    return Err(Error::new("recipe/marker", message).with_help(help));
                }
            }
        }
    }
    let labels = recording.labels.iter().map(|label| parted(label).1);
    let otherwise = || match names.get(1..) {
        Some(others @ [_, ..]) => format!("nor one of {}", listed(others)),
        _ => "the recipe names markers as this recording does not".to_owned(),
    };
    let message = match subject {
        Some(subject) => format!("the recording has no marker `{marker}` of {subject}"),
        None => format!("the recording has no marker `{marker}`"),
    };
    let help = did_you_mean(marker, labels, otherwise);
    Err(Diagnostic::error("recipe/marker", message).with_help(help).into())
}

/// What was guessed, a sentence for each kind.
pub(super) fn warnings(guesses: &[Guess]) -> Vec<Diagnostic> {
    let kinds = [
        (Guessed::Subject, "markers are taken without the name of a subject"),
        (Guessed::Case, "markers are taken ignoring case"),
        (Guessed::Other, "markers are taken under other names"),
    ];
    let mut warnings = vec![];
    for (how, text) in kinds {
        let of_kind = guesses.iter().filter(|guess| guess.how == how);
        let pairs: Vec<String> =
            of_kind.map(|guess| format!("{} for {}", guess.label, guess.marker)).collect();
        if !pairs.is_empty() {
            let message = format!("{text}: {}", listed(pairs));
            warnings.push(Diagnostic::warning("recipe/guessed-marker", message));
        }
    }
    warnings
}
