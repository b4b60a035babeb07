//! SHA-256 of what was read and written, to tell whether either has changed.

use sha2::{Digest as _, Sha256};
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

/// A digest of several parts, each with its name and length, so that no two lists of parts give the same
/// bytes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Digest(Sha256);

impl Digest {
    pub(crate) fn add(&mut self, name: &str, content: &[u8]) {
        for part in [name.as_bytes(), content] {
            self.0.update((part.len() as u64).to_le_bytes());
            self.0.update(part);
        }
    }

    pub(crate) fn finish(self) -> String {
        hexadecimal(self.0)
    }
}

/// The digest of a file's bytes.
pub(crate) fn of_file(path: &Path) -> io::Result<String> {
    let mut written = Hashed::new(io::sink());
    io::copy(&mut File::open(path)?, &mut written)?;
    Ok(written.finish().1)
}

fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A writer that takes the digest of what goes through it.
#[derive(Debug)]
pub(crate) struct Hashed<W> {
    writer: W,
    digest: Sha256,
}

impl<W: Write> Hashed<W> {
    pub(crate) fn new(writer: W) -> Self {
        Self { writer, digest: Sha256::new() }
    }

    /// The writer, and the digest of all bytes that it took.
    pub(crate) fn finish(self) -> (W, String) {
        (self.writer, hexadecimal(self.digest))
    }
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.writer.write(bytes)?;
        self.digest.update(bytes.get(..count).unwrap_or(bytes));
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_go_through_give_the_known_digest() {
        let mut written = Hashed::new(vec![]);
        written.write_all(b"abc").unwrap();
        // FIPS 180-2, appendix B.1.
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(written.finish(), (b"abc".to_vec(), known.to_owned()));
    }

    #[test]
    fn parts_are_told_apart() {
        let of = |parts: &[(&str, &str)]| {
            let mut digest = Digest::default();
            parts.iter().for_each(|(name, content)| digest.add(name, content.as_bytes()));
            digest.finish()
        };
        assert_ne!(of(&[("a", "bc")]), of(&[("ab", "c")]));
        assert_ne!(of(&[("a", ""), ("b", "")]), of(&[("a", "b")]));
    }
}
