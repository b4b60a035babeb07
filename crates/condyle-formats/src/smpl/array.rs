//! One array of NumPy: the text that says what it is, and its numbers in any kind, size, order and byte order.

use condyle_diagnostics::Error;
use std::borrow::Cow;

/// More dimensions are refused.
const MOST_DIMENSIONS: usize = 8;
/// More columns are refused: joints times corners of a body's surface are fewer in a row.
const MOST_COLUMNS: usize = 200_000;
/// Longer texts are cut.
const LONGEST_TEXT: usize = 200;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Float,
    Signed,
    /// Truth values are these, too.
    Unsigned,
    Bytes,
    Text,
}

/// An array.
#[derive(Clone, Debug)]
pub(super) struct Array<'a> {
    pub(super) name: String,
    pub(super) shape: Vec<usize>,
    kind: Kind,
    /// Bytes of an element.
    size: usize,
    big_endian: bool,
    fortran: bool,
    content: Cow<'a, [u8]>,
    /// Where the numbers begin.
    start: usize,
}

/// What a header states.
#[derive(Debug, Default)]
struct Head {
    kind: Option<String>,
    fortran: bool,
    shape: Option<Vec<usize>>,
}

/// The words of a header: a dictionary of Python with texts, truth values and a tuple of integers.
fn head(text: &str) -> Result<Head, String> {
    let mut head = Head::default();
    let mut rest = text.trim_start().strip_prefix('{').ok_or("is no dictionary")?;
    loop {
        rest = rest.trim_start_matches([',', ' ', '\n', '\t']);
        if rest.is_empty() || rest.starts_with('}') {
            return Ok(head);
        }
        let (key, after) = quoted(rest).ok_or("has a key that is no text")?;
        let after = after.trim_start().strip_prefix(':').ok_or("has a key without a value")?;
        let after = after.trim_start();
        rest = match key {
            "descr" => {
                let (kind, after) = quoted(after).ok_or("is of records, not of numbers")?;
                head.kind = Some(kind.to_owned());
                after
            }
            "fortran_order" => {
                head.fortran = after.starts_with("True");
                let word = after.find(|c: char| !c.is_alphanumeric()).unwrap_or(after.len());
                after.get(word..).unwrap_or("")
            }
            "shape" => {
                let inner = after.strip_prefix('(').ok_or("has a shape that is no tuple")?;
                let (inner, after) = inner.split_once(')').ok_or("has a shape without an end")?;
                let mut shape = vec![];
                for word in inner.split(',').map(str::trim).filter(|word| !word.is_empty()) {
                    // Python 2 wrote `10L`.
                    let word = word.strip_suffix('L').unwrap_or(word);
                    shape.push(word.parse().map_err(|_| "has a shape that is not of integers")?);
                    if shape.len() > MOST_DIMENSIONS {
                        return Err(format!("has more than {MOST_DIMENSIONS} dimensions"));
                    }
                }
                head.shape = Some(shape);
                after
            }
            other => return Err(format!("has an unknown key `{other:.30}`")),
        };
    }
}

/// A text in quotes at the beginning, and what follows.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text.get(1..)?.split_once(quote)
}

/// Why an array of objects is not read.
pub(super) const OBJECTS: &str =
    "holds objects of Python (pickled), which are not read: that would run what is in the file";

impl<'a> Array<'a> {
    /// Reads the head of an array, and checks that all of its numbers are there.
    pub(super) fn read(name: &str, content: Cow<'a, [u8]>) -> Result<Self, Error> {
        let wrong = |what: &str| Error::new("smpl/array", format!("the array `{name:.60}` {what}"));
        let missing = || wrong("has no head of NumPy");
        if !content.starts_with(b"\x93NUMPY") {
            return Err(missing());
        }
        let number = |from: usize, to: usize| {
            let digits = content.get(from..to)?;
            Some(digits.iter().rev().fold(0usize, |n, digit| n << 8 | usize::from(*digit)))
        };
        let (from, length) = match content.get(6) {
            Some(1) => (10, number(8, 10)),
            Some(2 | 3) => (12, number(8, 12)),
            _ => return Err(wrong("is of an unknown version of NumPy's format")),
        };
        let length = length.ok_or_else(missing)?;
        let start = from + length;
        let text = content.get(from..start).ok_or_else(missing)?;
        let text = String::from_utf8_lossy(text);
        let head = head(&text).map_err(|what| wrong(&what))?;
        let (Some(word), Some(shape)) = (head.kind, head.shape) else {
            return Err(wrong("does not say its kind and its shape"));
        };
        let (order, letter) = match word.strip_prefix(['<', '>', '|', '=']) {
            Some(rest) => (word.chars().next(), rest),
            None => (None, word.as_str()),
        };
        let mut letters = letter.chars();
        let letter = letters.next().unwrap_or(' ');
        let count: Option<usize> = letters.as_str().parse().ok();
        let (kind, size) = match (letter, count) {
            ('O', _) => {
                let help = "write it again in Python with allow_pickle=True for reading, and as plain arrays: \
                            numpy.savez(OUT, **DICTIONARY)";
                return Err(Error::new(
                    "smpl/objects",
                    format!("the array `{name:.60}` {OBJECTS}"),
                )
                .with_help(help));
            }
            ('f', Some(size @ (2 | 4 | 8))) => (Kind::Float, size),
            ('i', Some(size @ (1 | 2 | 4 | 8))) => (Kind::Signed, size),
            ('u', Some(size @ (1 | 2 | 4 | 8))) => (Kind::Unsigned, size),
            ('b' | '?', Some(1) | None) => (Kind::Unsigned, 1),
            ('S' | 'a', Some(size)) => (Kind::Bytes, size),
            ('U', Some(size)) => (Kind::Text, size.saturating_mul(4)),
            _ => return Err(wrong(&format!("is of the kind `{word:.20}`, which is not read"))),
        };
        let total = shape.iter().try_fold(1usize, |n, side| n.checked_mul(*side));
        let there = content.len().saturating_sub(start);
        let needed = total.and_then(|total| total.checked_mul(size.max(1)));
        if needed.is_none_or(|needed| needed > there.max(usize::from(size == 0))) {
            let message = format!("states a shape of {shape:?}, but only {there} bytes are there");
            return Err(wrong(&message));
        }
        let (name, big_endian, fortran) = (name.to_owned(), order == Some('>'), head.fortran);
        Ok(Self { name, shape, kind, size, big_endian, fortran, content, start })
    }

    /// Whether it holds numbers.
    pub(super) fn is_numeric(&self) -> bool {
        !matches!(self.kind, Kind::Bytes | Kind::Text)
    }

    /// How many elements there are.
    pub(super) fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// The element at a place in memory; NaN where there is no number.
    fn element(&self, place: usize) -> f64 {
        let at = self.start + place * self.size;
        let Some(digits) = self.content.get(at..at + self.size) else { return f64::NAN };
        let join = |number: u64, digit: &u8| number << 8 | u64::from(*digit);
        let bits = match self.big_endian {
            true => digits.iter().fold(0, join),
            false => digits.iter().rev().fold(0, join),
        };
        match (self.kind, self.size) {
            (Kind::Float, 8) => f64::from_bits(bits),
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => half(bits as u16),
            (Kind::Signed, size) => {
                let unused = 64 - 8 * size as u32;
                ((bits << unused).cast_signed() >> unused) as f64
            }
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Bytes | Kind::Text, _) => f64::NAN,
        }
    }

    /// The only number of an array that has one.
    pub(super) fn scalar(&self) -> Option<f64> {
        (self.is_numeric() && self.len() == 1).then(|| self.element(0))
    }

    /// The only text of an array that has one.
    pub(super) fn text(&self) -> Option<String> {
        let own = self.content.get(self.start..self.start.checked_add(self.size)?)?;
        let text: String = match self.kind {
            Kind::Bytes => String::from_utf8_lossy(own).into_owned(),
            Kind::Text => {
                let letter = |four: &[u8]| {
                    let digits = <[u8; 4]>::try_from(four).ok()?;
                    char::from_u32(match self.big_endian {
                        true => u32::from_be_bytes(digits),
                        false => u32::from_le_bytes(digits),
                    })
                };
                let letters = own.chunks_exact(4).take(LONGEST_TEXT);
                letters.map(|four| letter(four).unwrap_or('\u{fffd}')).collect()
            }
            _ => return None,
        };
        let text: String = text.trim_end_matches('\0').chars().take(LONGEST_TEXT).collect();
        // Bytes of Python that were turned into a text.
        let plain = text.strip_prefix("b'").and_then(|text| text.strip_suffix('\''));
        (self.len() == 1).then(|| plain.unwrap_or(&text).to_owned())
    }

    /// The array as rows along a dimension, those before it of length 1, all after it put into columns; `None`
    /// for one row of all numbers.
    pub(super) fn rows(&self, along: impl Into<Option<usize>>) -> Result<Rows<'_, 'a>, Error> {
        let along = along.into();
        let first = along.map_or(0, |along| along + 1);
        let wrong = |what: String| {
            Error::new("smpl/array", format!("the array `{:.60}` {what}", self.name))
        };
        if !self.is_numeric() {
            return Err(wrong("holds texts, not numbers".to_owned()));
        }
        let stride = |dimension: usize| -> usize {
            let others = match self.fortran {
                true => self.shape.get(..dimension),
                false => self.shape.get(dimension + 1..),
            };
            // An array without elements may have sides of any length; its strides are not used.
            others.unwrap_or_default().iter().fold(1, |n, side| n.wrapping_mul(*side))
        };
        let inner = self.shape.get(first..).unwrap_or_default();
        let width = inner.iter().try_fold(1usize, |n, side| n.checked_mul(*side));
        if width.is_none_or(|width| width > MOST_COLUMNS) {
            let message =
                format!("has a shape of {:?}: more than {MOST_COLUMNS} columns", self.shape);
            return Err(wrong(message));
        }
        let mut columns = if width == Some(0) { vec![] } else { vec![0usize] };
        for (number, side) in inner.iter().enumerate() {
            if columns.is_empty() {
                break;
            }
            let step = stride(first + number);
            columns =
                columns.iter().flat_map(|at| (0..*side).map(move |i| at + i * step)).collect();
        }
        let count = along.map_or(1, |along| self.shape.get(along).copied().unwrap_or(1));
        Ok(Rows { array: self, count, stride: along.map_or(0, stride), columns })
    }
}

/// An array seen as rows.
#[derive(Clone, Debug)]
pub(super) struct Rows<'r, 'a> {
    array: &'r Array<'a>,
    pub(super) count: usize,
    stride: usize,
    columns: Vec<usize>,
}

impl Rows<'_, '_> {
    /// How many columns there are.
    pub(super) fn width(&self) -> usize {
        self.columns.len()
    }

    /// One number; NaN where there is none.
    pub(super) fn get(&self, row: usize, column: usize) -> f64 {
        match self.columns.get(column) {
            Some(column) if row < self.count => self.array.element(row * self.stride + column),
            _ => f64::NAN,
        }
    }
}

/// A float of 16 bits: sign, five bits of exponent, ten of mantissa.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let exponent = i32::from(bits >> 10 & 31);
    let mantissa = f64::from(bits & 1023);
    sign * match exponent {
        0 => mantissa * 2f64.powi(-24),
        31 if mantissa == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + mantissa / 1024.0) * 2f64.powi(exponent - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(head: &str, content: &[u8]) -> Result<Array<'static>, Error> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((head.len() as u16).to_le_bytes());
        bytes.extend(head.as_bytes());
        bytes.extend(content);
        Array::read("a", Cow::Owned(bytes))
    }

    #[test]
    fn fortran_order_and_byte_order() {
        // [[1, 2, 3], [4, 5, 6]] column by column, as big-endian shorts.
        let content: Vec<u8> = [1i16, 4, 2, 5, 3, 6].iter().flat_map(|n| n.to_be_bytes()).collect();
        let read =
            array("{'descr': '>i2', 'fortran_order': True, 'shape': (2, 3), }", &content).unwrap();
        let rows = read.rows(0).unwrap();
        let all: Vec<f64> =
            (0..2).flat_map(|r| (0..3).map(|c| rows.get(r, c)).collect::<Vec<_>>()).collect();
        assert_eq!(all, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let negative = array("{'descr':'<i2','fortran_order':False,'shape':()}", &[0xfe, 0xff]);
        assert_eq!(negative.unwrap().scalar(), Some(-2.0));
    }

    #[test]
    fn halves_are_those_of_ieee_754() {
        let known = [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (0x0001, 5.960_464_477_539_063e-8),
        ];
        for (bits, value) in known {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan() && half(0xfc00) == f64::NEG_INFINITY);
    }

    #[test]
    fn texts_of_both_kinds() {
        let male: Vec<u8> = "male".chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
        let text = array("{'descr': '<U4', 'fortran_order': False, 'shape': (), }", &male).unwrap();
        assert_eq!(text.text().as_deref(), Some("male"));
        let bytes = array("{'descr': '|S6', 'fortran_order': False, 'shape': (1,), }", b"male\0\0");
        assert_eq!(bytes.unwrap().text().as_deref(), Some("male"));
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_its_reason() {
        let objects = array("{'descr': '|O', 'fortran_order': False, 'shape': (), }", b"\x80\x04.");
        let error = objects.unwrap_err();
        assert_eq!(error.code(), "smpl/objects");
        assert!(error.to_string().contains("pickled"), "{error}");
        for (head, said) in [
            ("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,), }", "records"),
            ("{'descr': '<c16', 'fortran_order': False, 'shape': (1,), }", "`<c16`"),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296, 9), }",
                "shape",
            ),
            ("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", "only 8 bytes"),
            ("{'descr': '<f8'}", "does not say"),
        ] {
            let error = array(head, &[0; 8]).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
