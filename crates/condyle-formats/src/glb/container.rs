//! What is around the JSON of a glTF file: the header and chunks of a GLB, or nothing.
//!
//! ```text
//! glb   = "glTF" version length { chunk }     all numbers are little-endian, of 4 bytes
//! chunk = length kind bytes                   JSON comes first, then at most one of BIN\0
//! ```
//!
//! Chunks of other kinds are left out, as the specification asks. A length that the header states and the file does not have
//! is a repair; so is a binary chunk that ends early, until something beyond its end is needed.

use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};
use std::ops::Range;

/// Where the parts of a file are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Container {
    /// The JSON, without what fills its chunk up.
    pub(super) json: Range<usize>,
    /// The binary chunk.
    pub(super) binary: Option<Range<usize>>,
    /// Whether it is a GLB.
    pub(super) is_binary: bool,
}

const HEADER: usize = 12;

impl Container {
    /// Finds the parts.
    ///
    /// # Errors
    /// `glb/version` of other versions than 2, `glb/chunk` where the JSON is not whole.
    pub(super) fn find(bytes: &[u8], warnings: &mut Warnings) -> Result<Self, Error> {
        if !bytes.starts_with(b"glTF") {
            let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
            return Ok(Self { json: start..bytes.len(), binary: None, is_binary: false });
        }
        let version = word(bytes, 4).ok_or_else(|| cut_off(bytes.len()))?;
        if version != 2 {
            let message = format!("the file is of version {version} of glTF");
            return Err(Error::new("glb/version", message)
                .at(Place::at_byte(4))
                .with_help("version 2 is read: export it again"));
        }
        let stated = word(bytes, 8).ok_or_else(|| cut_off(bytes.len()))?;
        if stated as usize != bytes.len() {
            let message = format!("the header states {stated} bytes, the file has {}", bytes.len());
            warnings.push(Diagnostic::warning("glb/length", message).at(Place::at_byte(8)));
        }
        let (mut json, mut binary) = (None, None);
        let mut at = HEADER;
        while let (Some(length), Some(kind)) = (word(bytes, at), bytes.get(at + 4..at + 8)) {
            let start = at + 8;
            let wanted = start.saturating_add(length as usize);
            let end = wanted.min(bytes.len());
            match kind {
                b"JSON" if json.is_none() => {
                    if wanted > bytes.len() {
                        let message = format!(
                            "the JSON should end at byte {wanted}, the file has {}",
                            bytes.len()
                        );
                        let error = Error::new("glb/chunk", message).at(Place::at_byte(at as u64));
                        return Err(error.with_help("the file is cut off: get it again"));
                    }
                    let text = bytes.get(start..end).unwrap_or_default();
                    let fill = text.iter().rev().take_while(|b| matches!(b, 0 | b' ')).count();
                    json = Some(start..end - fill);
                }
                b"BIN\0" if binary.is_none() => {
                    if wanted > bytes.len() {
                        let message = format!(
                            "the binary chunk should end at byte {wanted}, the file has {}",
                            bytes.len()
                        );
                        warnings.push(
                            Diagnostic::warning("glb/chunk", message)
                                .at(Place::at_byte(at as u64))
                                .with_help("what is there is read"),
                        );
                    }
                    binary = Some(start..end);
                }
                _ => {}
            }
            at = wanted;
        }
        match json {
            Some(json) => Ok(Self { json, binary, is_binary: true }),
            None => Err(Error::new("glb/chunk", "there is no chunk of JSON")
                .at(Place::at_byte(HEADER as u64))
                .with_help("a GLB holds its JSON in its first chunk")),
        }
    }
}

impl Container {
    /// The kind and bytes of all chunks that are neither JSON nor binary.
    pub(super) fn others<'b>(&self, bytes: &'b [u8]) -> Vec<(&'b [u8], &'b [u8])> {
        let mut found = vec![];
        let mut at = if self.is_binary { HEADER } else { bytes.len() };
        while let (Some(length), Some(kind)) = (word(bytes, at), bytes.get(at + 4..at + 8)) {
            let end = (at + 8).saturating_add(length as usize);
            let known = [&b"JSON"[..], b"BIN\0"].contains(&kind);
            if let Some(part) = bytes.get(at + 8..end).filter(|_| !known) {
                found.push((kind, part));
            }
            at = end;
        }
        found
    }
}

/// Whether bytes look like glTF in JSON: an object that has an asset near its beginning or its end.
pub(crate) fn looks_like_json(bytes: &[u8]) -> bool {
    const NEAR: usize = 1 << 16;
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let has = |part: &[u8]| part.windows(7).any(|w| w == b"\"asset\"");
    text.starts_with(b"{")
        && (has(&text[..text.len().min(NEAR)]) || has(&text[text.len().saturating_sub(NEAR)..]))
}

/// A number of 4 bytes.
pub(super) fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

fn cut_off(length: usize) -> Error {
    Error::new("glb/chunk", format!("the file ends after {length} bytes, inside its header"))
        .at(Place::at_byte(length as u64))
}
