//! STL: triangles one by one, as bytes or as text.

use super::{Soup, truncated};
use crate::text::{decode, lines, number};
use condyle_diagnostics::{Diagnostic, Error};
use condyle_math::Vec3;

/// A heading of 80 bytes and the number of triangles.
const HEAD: usize = 84;
/// A normal, three corners, two bytes of whatever.
const TRIANGLE: usize = 50;

/// The number of triangles that a binary file states.
fn stated(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEAD)?.first_chunk::<4>()?;
    usize::try_from(u32::from_le_bytes(*count)).ok()
}

/// Whether these bytes are binary STL: as long as it states, or no text. Many such files begin with `solid` as those in
/// text do.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    let Some(count) = stated(bytes) else { return false };
    let whole = bytes.len() == count.saturating_mul(TRIANGLE).saturating_add(HEAD);
    let control = |b: &u8| matches!(b, 0..=8 | 14..=31);
    count > 0 && (whole || bytes.iter().take(512).any(control))
}

pub(super) fn binary(bytes: &[u8], warnings: &mut Vec<Diagnostic>) -> Soup {
    let body = bytes.get(HEAD..).unwrap_or_default();
    let count = stated(bytes).unwrap_or(0);
    let mut soup = Soup::default();
    for record in body.chunks_exact(TRIANGLE).take(count) {
        let (numbers, _) = record.get(12..48).unwrap_or_default().as_chunks::<4>();
        let first = soup.corners.len() as u32;
        let (corners, _) = numbers.as_chunks::<3>();
        soup.corners.extend(
            corners.iter().map(|c| Vec3::from(c.map(|x| f64::from(f32::from_le_bytes(x))))),
        );
        soup.triangles.push([first, first + 1, first + 2]);
    }
    if soup.triangles.len() < count {
        warnings.push(truncated(soup.triangles.len(), count));
    }
    soup
}

pub(super) fn text(bytes: &[u8]) -> Result<Soup, Error> {
    let text = decode(bytes)?.value;
    let mut soup = Soup::default();
    let mut open: Vec<u32> = vec![];
    for line in lines(&text) {
        let mut words = line.text.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let three = [words.next(), words.next(), words.next()];
                let [Some(x), Some(y), Some(z)] = three.map(|word| number(word?)) else {
                    return Err(
                        Error::new("surface/number", "a vertex has three numbers").at(line.place())
                    );
                };
                open.push(soup.corners.len() as u32);
                soup.corners.push(Vec3::new(x, y, z));
            }
            Some("endloop" | "endfacet") => {
                soup.polygon(&open);
                open.clear();
            }
            _ => {}
        }
    }
    Ok(soup)
}
