//! Rows of plain decimals between tabs: nearly all bytes of most recordings and motions.
//!
//! A row that has anything else in it is left to the reader of its format, which knows all spellings.

/// A cell with nothing in it: a NaN that no text gives.
const BLANK: u64 = 0x7ff8_0000_0000_b1a4;

/// Powers of ten that a double holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The cells of a row, reused for the next.
#[derive(Debug, Default)]
pub(crate) struct Row {
    cells: Vec<f64>,
}

impl Row {
    /// Reads one row with its line end and answers where the next begins; `None` if it is none of plain
    /// numbers, blank cells and `NaN` between tabs, or has more than `most` cells.
    pub(crate) fn read(&mut self, text: &str, start: usize, most: usize) -> Option<usize> {
        self.cells.clear();
        let bytes = text.as_bytes();
        let mut at = start;
        while self.cells.len() < most {
            at = skip_spaces(bytes, at);
            let cell = match bytes.get(at) {
                None | Some(b'\t' | b'\n' | b'\r') => f64::from_bits(BLANK),
                Some(b'n' | b'N') => {
                    let word = bytes.get(at..at + 3)?;
                    at += 3;
                    word.eq_ignore_ascii_case(b"nan").then_some(f64::NAN)?
                }
                Some(_) => {
                    let (value, end) = decimal(text, at)?;
                    at = end;
                    value
                }
            };
            self.cells.push(cell);
            at = skip_spaces(bytes, at);
            match bytes.get(at) {
                Some(b'\t') => at += 1,
                Some(b'\r') if bytes.get(at + 1) == Some(&b'\n') => return Some(at + 2),
                Some(b'\n' | b'\r') => return Some(at + 1),
                None => return (at > start).then_some(at),
                Some(_) => return None,
            }
        }
        None
    }

    /// The cells; blank ones are NaN.
    pub(crate) fn cells(&self) -> &[f64] {
        &self.cells
    }
}

/// Whether a cell has nothing in it.
pub(crate) fn is_blank(cell: f64) -> bool {
    cell.to_bits() == BLANK
}

fn skip_spaces(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at) == Some(&b' ') {
        at += 1;
    }
    at
}

/// The digits from a place on, appended to a number; where they end. More than 19 of them overflow.
fn digits(bytes: &[u8], start: usize, mut number: u64) -> (u64, usize) {
    let mut at = start;
    // Eight at once, as most numbers have at least as many.
    while let Some(eight) = bytes.get(at..at + 8).and_then(|b| <[u8; 8]>::try_from(b).ok()) {
        let word = u64::from_le_bytes(eight);
        let Some(value) = eight_digits(word) else { break };
        number = number.wrapping_mul(100_000_000).wrapping_add(value);
        at += 8;
    }
    while let Some(digit) = bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
        number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    (number, at)
}

/// The number that eight letters are, the first in the lowest byte; `None` unless all are digits.
fn eight_digits(word: u64) -> Option<u64> {
    let high = word & 0xf0f0_f0f0_f0f0_f0f0;
    let carried = word.wrapping_add(0x0606_0606_0606_0606) & 0xf0f0_f0f0_f0f0_f0f0;
    if high != 0x3030_3030_3030_3030 || carried != 0x3030_3030_3030_3030 {
        return None;
    }
    // Neighbours are joined to numbers of two, four and eight digits.
    let ones = word & 0x0f0f_0f0f_0f0f_0f0f;
    let pairs = (ones.wrapping_mul(10).wrapping_add(ones >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100).wrapping_add(pairs >> 16)) & 0x0000_ffff_0000_ffff;
    Some((fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xffff_ffff)
}

/// A decimal number and where it ends.
///
/// A whole number below 2^53 times or over a power of ten up to 10^22: both are doubles, so one rounding
/// gives the nearest double. All others are left to the standard library.
fn decimal(text: &str, start: usize) -> Option<(f64, usize)> {
    let bytes = text.as_bytes();
    let mut at = start;
    let negative = match bytes.get(at) {
        Some(b'-') => {
            at += 1;
            true
        }
        Some(b'+') => {
            at += 1;
            false
        }
        _ => false,
    };
    let whole = at;
    let (mut number, end) = digits(bytes, at, 0);
    at = end;
    let mut count = at - whole;
    let mut power = 0i64;
    if bytes.get(at) == Some(&b'.') {
        let (all, end) = digits(bytes, at + 1, number);
        number = all;
        power = -((end - at - 1) as i64);
        count += end - at - 1;
        at = end;
    }
    if count == 0 {
        return None;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = bytes.get(at + 1).copied();
        let first = if matches!(sign, Some(b'+' | b'-')) { at + 2 } else { at + 1 };
        let (exponent, end) = digits(bytes, first, 0);
        if end == first || end - first > 4 {
            return None;
        }
        power += if sign == Some(b'-') { -(exponent as i64) } else { exponent as i64 };
        at = end;
    }
    let size = usize::try_from(power.unsigned_abs()).ok();
    let value = match size.and_then(|size| POWERS.get(size)) {
        Some(scale) if count <= 19 && number < 1 << 53 => {
            let value = if power < 0 { number as f64 / scale } else { number as f64 * scale };
            if negative { -value } else { value }
        }
        _ => text.get(start..at)?.parse().ok()?,
    };
    Some((value, at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cells(text: &str) -> Option<(Vec<Option<f64>>, usize)> {
        let mut row = Row::default();
        let end = row.read(text, 0, 100)?;
        Some((row.cells().iter().map(|c| (!is_blank(*c)).then_some(*c)).collect(), end))
    }

    #[test]
    fn rows_end_at_their_line_ends() {
        let one_two = vec![Some(1.0), Some(2.5)];
        for (text, end) in [("1\t2.5", 5), ("1\t2.5\n3", 6), ("1\t 2.5 \r\n3", 9), ("1\t2.5\r3", 6)]
        {
            assert_eq!(cells(text), Some((one_two.clone(), end)), "{text:?}");
        }
        assert_eq!(cells("\t\t-1e-3\t"), Some((vec![None, None, Some(-0.001), None], 8)));
        assert_eq!(cells("\n"), Some((vec![None], 1)));
        let (nan, _) = cells("nan\tNaN\n").unwrap();
        assert!(nan.iter().all(|cell| cell.is_some_and(f64::is_nan)));
        for other in [
            "", "1,5", "1 2", "a", "1.#INF", "1d5", "-", ".", "1e", "1e+", "nan(ind)", "\"1\"", "é",
        ] {
            assert_eq!(cells(other), None, "{other:?}");
        }
        let mut row = Row::default();
        assert_eq!(row.read("1\t2\t3\n", 0, 2), None);
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(
            sign in "[+-]?", whole in "[0-9]{0,21}", fraction in "(\\.[0-9]{0,21})?", exponent in "(e[+-]?[0-9]{1,3})?",
        ) {
            let text = format!("{sign}{whole}{fraction}{exponent}");
            let expected: Option<f64> = text.parse().ok();
            let found = decimal(&text, 0).filter(|(_, end)| *end == text.len()).map(|(value, _)| value);
            prop_assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{}", text);
        }

        #[test]
        fn doubles_written_are_read_back(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            let text = format!("{value:e}");
            prop_assert_eq!(decimal(&text, 0).map(|(v, _)| v.to_bits()), Some(bits));
        }
    }
}
