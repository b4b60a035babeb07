//! Bytes to text: UTF-8, UTF-16, or Latin-1 as the last resort.

use std::borrow::Cow;

use condyle_diagnostics::{Diagnostic, Error, Place, Read};

/// The text in some bytes that must be UTF-8, without its byte order mark.
///
/// # Errors
/// `text/utf-8` with the line of the first byte that is wrong.
pub fn utf8(bytes: &[u8]) -> Result<&str, Error> {
    std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = before.iter().filter(|b| **b == b'\n').count() + 1;
        let error = Error::new("text/utf-8", "the text is not UTF-8");
        error.at(Place::at_line(line)).with_help("save it as UTF-8")
    })
}

/// The largest text a reader takes, in bytes (512 MiB).
pub const MAX_TEXT_BYTES: usize = 512 << 20;

/// The text in some bytes, without its byte order mark.
///
/// UTF-8 is used unchanged; UTF-16 is recognised by its byte order mark, or by the zeros between its first
/// letters. Anything else is read as
/// Latin-1, in which every byte is a character, with the warning `text/encoding`.
///
/// # Errors
///
/// `text/size` if there are more than [`MAX_TEXT_BYTES`].
///
/// ```
/// let read = condyle_formats::text::decode(b"caf\xe9")?;
/// assert_eq!(read.value, "café");
/// assert!(read.warned("text/encoding"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn decode(bytes: &[u8]) -> Result<Read<Cow<'_, str>>, Error> {
    check_size(bytes.len())?;
    if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        return Ok(utf16(rest, u16::from_le_bytes));
    }
    if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        return Ok(utf16(rest, u16::from_be_bytes));
    }
    if let Some(unit) = unmarked_utf16(bytes) {
        let mut read = utf16(bytes, unit);
        let said = Diagnostic::note("text/encoding", "UTF-16 without a byte order mark");
        read.warnings.insert(0, said.with_help("recognised by the zeros between letters"));
        return Ok(read);
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Read::clean(Cow::Borrowed(text))),
        Err(error) => {
            let wrong = error.valid_up_to();
            let line = 1 + bytes[..wrong].iter().filter(|b| **b == b'\n').count();
            let text: String = bytes.iter().map(|b| char::from(*b)).collect();
            let warning = Diagnostic::note("text/encoding", "the text is not UTF-8")
                .at(Place { line, column: 0, byte: Some(wrong as u64) })
                .with_help("read as Latin-1; letters outside ASCII may be wrong");
            Ok(Read { value: Cow::Owned(text), warnings: vec![warning] })
        }
    }
}

/// Rejects a text that is too large to be held in memory several times.
pub(crate) fn check_size(bytes: usize) -> Result<(), Error> {
    if bytes <= MAX_TEXT_BYTES {
        return Ok(());
    }
    Err(Error::new("text/size", format!("the text has {bytes} bytes"))
        .with_help(format!("at most {MAX_TEXT_BYTES} bytes are read; split the file")))
}

/// How the units of UTF-16 without a byte order mark are made of bytes: one of the two is zero in each of
/// the first letters, which are ASCII in every format.
fn unmarked_utf16(bytes: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let pairs = bytes.get(..bytes.len().min(64) / 2 * 2)?.as_chunks::<2>().0;
    let letter = |b: u8| (b' '..=b'~').contains(&b) || b"\t\r\n".contains(&b);
    if pairs.len() < 4 {
        None
    } else if pairs.iter().all(|&[a, b]| a == 0 && letter(b)) {
        Some(u16::from_be_bytes)
    } else if pairs.iter().all(|&[a, b]| letter(a) && b == 0) {
        Some(u16::from_le_bytes)
    } else {
        None
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Read<Cow<'_, str>> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut broken = !rest.is_empty();
    let text = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)))
        .map(|c| {
            c.unwrap_or_else(|_| {
                broken = true;
                char::REPLACEMENT_CHARACTER
            })
        })
        .collect();
    let mut read = Read::clean(Cow::Owned(text));
    if broken {
        read.warnings.push(
            Diagnostic::note("text/encoding", "the UTF-16 text has invalid characters")
                .with_help("they were replaced by `\u{fffd}`"),
        );
    }
    read
}

/// Decodes bytes and reads the text, the decoder's warnings first.
pub(crate) fn read_decoded<T>(
    bytes: &[u8],
    read: impl FnOnce(&str) -> Result<Read<T>, Error>,
) -> Result<Read<T>, Error> {
    let text = decode(bytes)?;
    let mut read = read(&text.value)?;
    read.warnings.splice(0..0, text.warnings);
    Ok(read)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn byte_order_marks_are_dropped() {
        assert_eq!(decode(b"\xef\xbb\xbfab").unwrap().value, "ab");
        assert_eq!(decode(b"\xff\xfea\0b\0").unwrap().value, "ab");
        assert_eq!(decode(b"\xfe\xff\0a\0b").unwrap().value, "ab");
    }

    #[test]
    fn zeros_between_letters_tell_utf_16() {
        for order in [u16::to_be_bytes as fn(u16) -> [u8; 2], u16::to_le_bytes] {
            let ascii: Vec<u8> = "time\ta\n".repeat(6).encode_utf16().flat_map(order).collect();
            let read = decode(&ascii).unwrap();
            assert_eq!(read.value, "time\ta\n".repeat(6));
            assert!(read.warned("text/encoding"));
        }
        assert_eq!(decode(b"a\0b\0").unwrap().value, "a\0b\0");
    }

    #[test]
    fn half_a_character_is_a_warning() {
        let read = decode(b"\xff\xfea\0b").unwrap();
        assert_eq!(read.value, "a");
        assert!(read.warned("text/encoding"));
    }

    #[test]
    fn latin_1_names_the_line() {
        let read = decode(b"one\ntwo \xb5m\n").unwrap();
        assert_eq!(read.value, "one\ntwo µm\n");
        assert_eq!(read.warnings[0].place.unwrap().line, 2);
        assert_eq!(read.warnings[0].place.unwrap().byte, Some(8));
    }
}
