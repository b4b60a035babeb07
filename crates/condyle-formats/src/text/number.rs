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
    fn decimals_read_back() {
        for value in [0.1, -0.0, 1e-12, 1e300, 123_456.789, f64::MIN_POSITIVE, 1.0 / 3.0] {
            let back = number(&decimal(value)).unwrap();
            assert_eq!(back.to_bits(), value.to_bits(), "{value}");
        }
        assert_eq!(decimal(0.00001), "0.00001");
        assert_eq!(decimal(1e-12), "1e-12");
    }
}
