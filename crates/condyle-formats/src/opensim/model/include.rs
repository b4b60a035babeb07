//! Sets that a model keeps in files of their own: `<MarkerSet file="markers.xml"/>`.

use super::frame::is_default;
use super::of;
use crate::Include;
use crate::text::check_size;
use crate::xml::edit::Edits;
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Read};

/// The sets that move something.
const SETS: [&str; 4] = ["BodySet", "JointSet", "ConstraintSet", "MarkerSet"];

/// The document with the sets that it names by file put in.
///
/// # Errors
/// `osim/include` where such a file is not XML or holds no such set, and where it cannot be had, unless
/// it is that of a marker set: a model without its markers still moves.
pub(in crate::opensim) fn put_in(
    document: Read<XmlDocument>,
    include: &mut Include<'_>,
) -> Result<Read<XmlDocument>, Error> {
    let Read { value: document, mut warnings } = document;
    let Some(model) = of(document.root()) else { return Ok(Read { value: document, warnings }) };
    let mut found: Vec<(Element<'_>, String, XmlDocument)> = vec![];
    for set in model.descendants().filter(|e| SETS.contains(&e.name())) {
        let file = set.attribute("file").map(str::trim).unwrap_or_default();
        if file.is_empty() || file.eq_ignore_ascii_case("unassigned") || is_default(set) {
            continue;
        }
        let text =
            match include(file) {
                Ok(text) => text,
                Err(why) => {
                    let message = format!("{} is in the file `{file}`: {why}", set.describe());
                    let help = "paths are seen from the model's folder";
                    if !set.is("MarkerSet") {
                        return Err(set.error("osim/include", message).with_help(help));
                    }
                    let said = Diagnostic::warning("osim/include", message).at(set.place());
                    warnings.push(said.with_help(
                        "its markers are missing; paths are seen from the model's folder",
                    ));
                    continue;
                }
            };
        let other = XmlDocument::parse(&text)
            .map_err(|error| set.error("osim/include", format!("in `{file}`: {error}")))?;
        for said in other.warnings {
            let message = format!("in `{file}`: {}", said.message);
            warnings.push(Diagnostic { message, place: Some(set.place()), ..said });
        }
        found.push((set, file.to_owned(), other.value));
    }
    if found.is_empty() {
        return Ok(Read { value: document, warnings });
    }
    let mut inserted = vec![];
    for (set, file, other) in &found {
        let guest = set_of(other.root(), set.name()).ok_or_else(|| {
            let message = format!("the file `{file}` holds no <{}>", set.name());
            set.error("osim/include", message).with_help("is it the right file?")
        })?;
        inserted.push((*set, guest));
    }
    let whole = document.with_inserted(&inserted);
    Ok(Read { value: whole, warnings })
}

/// The text of a model or a setup with the sets that it names by file put in, as they are written.
///
/// # Errors
/// Those of its XML; `osim/include` as [`put_in`] has it.
pub(in crate::opensim) fn put_into_text(
    text: &str,
    include: &mut Include<'_>,
) -> Result<Read<String>, Error> {
    let Read { value: document, mut warnings } = XmlDocument::parse(text)?;
    let is_model = of(document.root()).is_some();
    let mut edits = Edits::new(text);
    let mut included = text.len();
    for set in document.root().descendants().filter(|e| e.name().ends_with("Set")) {
        let file = set.attribute("file").map(str::trim).unwrap_or_default();
        if file.is_empty() || file.eq_ignore_ascii_case("unassigned") || is_default(set) {
            continue;
        }
        let other = match include(file) {
            Ok(other) => other,
            Err(why) => {
                let message = format!("{} is in the file `{file}`: {why}", set.describe());
                let help = "paths are seen from the model's folder";
                if !is_model || SETS.contains(&set.name()) && !set.is("MarkerSet") {
                    return Err(set.error("osim/include", message).with_help(help));
                }
                let said = Diagnostic::warning("osim/include", message).at(set.place());
                warnings.push(said.with_help("it stays a file of its own and is not changed"));
                continue;
            }
        };
        included += other.len();
        check_size(included)?;
        let other = other.strip_prefix('\u{feff}').unwrap_or(&other);
        let parsed = XmlDocument::parse(other)
            .map_err(|error| set.error("osim/include", format!("in `{file}`: {error}")))?;
        let guest = set_of(parsed.value.root(), set.name()).ok_or_else(|| {
            let message = format!("the file `{file}` holds no <{}>", set.name());
            set.error("osim/include", message).with_help("is it the right file?")
        })?;
        edits.replace(set, Edits::new(other).written(guest));
    }
    Ok(Read { value: edits.finish(), warnings })
}

/// The set of that class: bare, in its document, or in a model.
fn set_of<'d>(root: Element<'d>, class: &str) -> Option<Element<'d>> {
    root.descendants().find(|e| e.is(class))
}
