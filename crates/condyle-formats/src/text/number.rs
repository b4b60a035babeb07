//! Numbers in the spellings of old and new programs.

/// A number with any of the spellings of infinity and not-a-number met in files.
///
/// Besides what Rust reads: `1.#INF`, `-1.#IND`, `1.#QNAN`, `1.#SNAN`, `-nan(ind)`, in any case.
/// Space around it is ignored. None if it is not a number.
///
/// ```
/// use condyle_formats::text::number;
/// assert_eq!(number(" -1.5E+01 "), Some(-15.0));
/// assert_eq!(number("-1.#INF"), Some(f64::NEG_INFINITY));
/// assert!(number("-nan(ind)").is_some_and(f64::is_nan));
/// assert_eq!(number("1,5"), None);
/// ```
#[must_use]
pub fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    if text.len() > 16 || !text.is_ascii() {
        return None;
    }
    let lower = text.to_ascii_lowercase();
    let (sign, body) = match lower.strip_prefix('-') {
        Some(body) => (-1.0, body),
        None => (1.0, lower.strip_prefix('+').unwrap_or(&lower)),
    };
    // Some C libraries pad the spelling with zeros: 1.#INF00.
    match body.trim_end_matches('0') {
        "1.#inf" => Some(sign * f64::INFINITY),
        "1.#ind" | "1.#qnan" | "1.#snan" | "1.#nan" => Some(f64::NAN),
        _ if body.starts_with("nan(") && body.ends_with(')') => Some(f64::NAN),
        _ => None,
    }
}

/// Words that tables hold where a value is missing, in lower case.
const MISSING: [&str; 15] = [
    "na",
    "n/a",
    "#n/a",
    "#na",
    "n.a.",
    "<na>",
    "none",
    "null",
    "(null)",
    "nil",
    "missing",
    "undefined",
    "nan(snan)",
    "qnan",
    "snan",
];

/// The number in a cell of a table; NaN where a word or a sign says that it is missing.
///
/// Beside what [`number`] reads: cells in quotes, the exponents of Fortran (`1.5D+03`), and `NA`, `N/A`,
/// `null`, `none`, `-`, `--`, `*` and their like. None if it is none of these.
///
/// ```
/// use condyle_formats::text::cell;
/// assert_eq!(cell("1.5D+03"), Some(1500.0));
/// assert_eq!(cell("\"-2\""), Some(-2.0));
/// assert!(cell("N/A").is_some_and(f64::is_nan));
/// assert_eq!(cell("abc"), None);
/// ```
#[must_use]
pub fn cell(text: &str) -> Option<f64> {
    if let Some(value) = number(text) {
        return Some(value);
    }
    let text = unquoted(text);
    if text.len() > 64 || !text.is_ascii() {
        return None;
    }
    let lower = text.to_ascii_lowercase();
    let word = lower.trim_start_matches(['+', '-']);
    let signs = ['-', '*', '.', '?', '_'];
    let only_signs =
        signs.iter().any(|sign| !lower.is_empty() && lower.chars().all(|c| c == *sign));
    if only_signs || MISSING.contains(&lower.as_str()) || MISSING[13..].contains(&word) {
        return Some(f64::NAN);
    }
    number(text).or_else(|| {
        let fortran = lower.bytes().filter(|b| *b == b'd').count() == 1
            && lower.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        fortran.then(|| number(&lower.replace('d', "e"))).flatten()
    })
}

/// The number in a cell whose decimal separator is a comma; None of any other cell.
pub(crate) fn with_comma(text: &str) -> Option<f64> {
    let single = text.bytes().filter(|b| *b == b',').count() == 1 && !text.contains('.');
    single.then(|| cell(&text.replace(',', "."))).flatten().filter(|value| !value.is_nan())
}

/// A cell without the quotes around it.
pub(crate) fn unquoted(text: &str) -> &str {
    // Nearly all cells begin and end with a digit, a sign or a letter.
    let plain = |b: Option<&u8>| b.is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'-');
    let bytes = text.as_bytes();
    if plain(bytes.first()) && plain(bytes.last()) {
        return text;
    }
    let mut text = text.trim();
    while let Some(inner) = ['"', '\''].iter().find_map(|&q| text.strip_prefix(q)?.strip_suffix(q))
    {
        text = inner.trim();
    }
    text
}

/// The shortest decimal that reads back as the same number; an exponent only for the very small
/// and the very large.
pub(crate) fn decimal(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        "nan".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "inf".to_owned() } else { "-inf".to_owned() }
    } else if size == 0.0 || (1e-9..1e16).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// A name as one cell of a table: line ends and tabs would end it, so they become spaces.
pub(crate) fn plain(name: &str) -> String {
    name.replace(['\t', '\r', '\n'], " ").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings() {
        assert_eq!(number("1.#INF00"), Some(f64::INFINITY));
        for nan in ["NaN", "NAN", "nan", "-nan", "1.#QNAN", "-1.#IND", "-1.#IND00", "nan(ind)"] {
            assert!(number(nan).is_some_and(f64::is_nan), "{nan}");
        }
        for inf in ["inf", "Infinity", "INF", "+inf"] {
            assert_eq!(number(inf), Some(f64::INFINITY), "{inf}");
        }
        for no in ["", "abc", "1.0f", "0x10", "1 2", "--1", "1.#"] {
            assert_eq!(number(no), None, "{no}");
        }
        assert_eq!(number("1."), Some(1.0));
        assert_eq!(number(".5"), Some(0.5));
    }

    #[test]
    fn cells_of_tables() {
        for missing in
            ["NA", "N/A", "null", "None", "-", "--", "*", "-QNAN", "1.#QNAN", "nan", "\"NA\""]
        {
            assert!(cell(missing).is_some_and(f64::is_nan), "{missing}");
            assert_eq!(with_comma(missing), None, "{missing}");
        }
        for (text, value) in [("0.5D-01", 0.05), ("-1d2", -100.0), ("'7'", 7.0)] {
            assert_eq!(cell(text), Some(value), "{text}");
        }
        for no in ["", "abc", "d", "1d2d3", "0x1d", "--1", "1,5", "deadd"] {
            assert_eq!(cell(no), None, "{no}");
        }
        assert_eq!(with_comma("-0,25"), Some(-0.25));
        for no in ["1,000,000", "1.000,5", "1.5", ",", "a,b"] {
            assert_eq!(with_comma(no), None, "{no}");
        }
    }

    #[test]
    fn decimals_read_back() {
        for value in [0.1, -0.0, 1e-12, 1e300, 123_456.789, f64::MIN_POSITIVE, 1.0 / 3.0] {
            let back = number(&decimal(value)).unwrap();
            assert_eq!(back.to_bits(), value.to_bits(), "{value}");
        }
        assert_eq!(decimal(0.00001), "0.00001");
        assert_eq!(decimal(1e-12), "1e-12");
    }
}
