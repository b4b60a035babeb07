//! The lines up to `endheader`.

use crate::text::{Line, number};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};
use condyle_motion::AngleUnit;

/// Keys that SIMM wrote with a space instead of `=`.
const SIMM_KEYS: [&str; 4] = ["datacolumns", "datarows", "otherdata", "range"];

/// The contents of the header.
#[derive(Debug, Default)]
pub(super) struct Header {
    pub(super) name: String,
    /// Keys and values, without those that the table has fields for.
    pub(super) pairs: Vec<(String, String)>,
    pub(super) angle_unit: AngleUnit,
    pub(super) rows: Option<f64>,
    pub(super) columns: Option<f64>,
    /// First and last time of a SIMM file, in seconds.
    pub(super) range: Option<[f64; 2]>,
}

/// The longest line of a header in bytes; a megabyte without a line end is no header.
const LONGEST: usize = 1 << 20;

/// Reads up to and including `endheader`.
pub(super) fn read<'a>(
    lines: &mut impl Iterator<Item = Line<'a>>,
    warnings: &mut Warnings,
) -> Result<Header, Error> {
    let mut header = Header::default();
    let mut key_unit: Option<(AngleUnit, Place)> = None;
    let mut text_unit: Option<AngleUnit> = None;
    let mut simm = false;
    let mut first = true;
    let mut seen = None;
    for line in lines {
        let text = line.text.trim();
        if text.eq_ignore_ascii_case("endheader") {
            header.angle_unit = settle(key_unit, text_unit, simm, warnings);
            return Ok(header);
        }
        if text.len() > LONGEST {
            return Err(Error::new("sto/no-endheader", "a line of the header is too long")
                .at(line.place())
                .with_help("is this a motion? write `endheader` before the line of names"));
        }
        seen.get_or_insert(line);
        if text.is_empty() {
            continue;
        }
        let was_first = std::mem::take(&mut first);
        let lower = text.to_ascii_lowercase();
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let word = word.to_ascii_lowercase();
        if let Some((key, value)) = text.split_once('=') {
            let (key, value) = (key.trim(), value.trim());
            match key.to_ascii_lowercase().as_str() {
                "indegrees" => match truth(value) {
                    Some(unit) => key_unit = Some((unit, line.place())),
                    None => warnings.push(
                        Diagnostic::warning("sto/in-degrees", format!("`inDegrees={value}`"))
                            .at(line.place())
                            .with_help("write `inDegrees=yes` or `inDegrees=no`; it was skipped"),
                    ),
                },
                "nrows" | "datarows" => header.rows = number(value),
                "ncolumns" | "datacolumns" => header.columns = number(value),
                "version" => {}
                "name" => header.name = value.to_owned(),
                _ => header.pairs.push((key.to_owned(), value.to_owned())),
            }
        } else if SIMM_KEYS.contains(&word.as_str()) {
            simm = true;
            match word.as_str() {
                "datarows" => header.rows = number(rest),
                "datacolumns" => header.columns = number(rest),
                "range" => {
                    let mut ends = rest.split_whitespace().map(number);
                    if let (Some(Some(start)), Some(Some(end))) = (ends.next(), ends.next()) {
                        header.range = Some([start, end]);
                    }
                }
                _ => {}
            }
        } else if lower.contains("angles are in degrees") {
            text_unit = Some(AngleUnit::Degrees);
        } else if lower.contains("angles are in radians") {
            text_unit = Some(AngleUnit::Radians);
        } else if word == "name" && !rest.is_empty() {
            header.name = rest.trim().to_owned();
        } else if was_first {
            header.name = text.to_owned();
        }
    }
    Err(match seen {
        None => Error::new("sto/empty", "the file is empty")
            .at(Place::at_line(1))
            .with_help("a motion starts with a header that ends with `endheader`"),
        Some(line) => Error::new("sto/no-endheader", "no line reads `endheader`")
            .at(line.place())
            .with_help("is this a motion? write `endheader` before the line of names"),
    })
}

fn truth(value: &str) -> Option<AngleUnit> {
    match value.to_ascii_lowercase().as_str() {
        "yes" | "y" | "true" | "1" => Some(AngleUnit::Degrees),
        "no" | "n" | "false" | "0" => Some(AngleUnit::Radians),
        _ => None,
    }
}

/// The unit that the key, the text and the kind of header imply; the key takes precedence.
fn settle(
    key: Option<(AngleUnit, Place)>,
    text: Option<AngleUnit>,
    simm: bool,
    warnings: &mut Warnings,
) -> AngleUnit {
    match (key, text) {
        (Some((key, place)), Some(text)) if key != text => {
            let name = |unit| if unit == AngleUnit::Degrees { "degrees" } else { "radians" };
            warnings.push(
                Diagnostic::warning(
                    "sto/unit-contradiction",
                    format!("`inDegrees` means {}, the text states {}", name(key), name(text)),
                )
                .at(place)
                .with_help(format!("taken as {}", name(key))),
            );
            key
        }
        (Some((key, _)), _) => key,
        (None, Some(text)) => text,
        (None, None) if simm => AngleUnit::Degrees,
        (None, None) => AngleUnit::Unstated,
    }
}
