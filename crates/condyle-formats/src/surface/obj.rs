//! OBJ: corners in lines that begin with `v`, polygons in lines that begin with `f`.

use super::Soup;
use crate::text::{decode, lines, number};
use condyle_diagnostics::Error;
use condyle_math::Vec3;

pub(super) fn read(bytes: &[u8]) -> Result<Soup, Error> {
    let text = decode(bytes)?.value;
    let mut soup = Soup::default();
    let mut polygon: Vec<u32> = vec![];
    for line in lines(&text) {
        let body = line.text.split('#').next().unwrap_or_default();
        let mut words = body.split_whitespace();
        match words.next() {
            Some("v") => {
                let three = [words.next(), words.next(), words.next()];
                let [Some(x), Some(y), Some(z)] = three.map(|word| number(word?)) else {
                    return Err(
                        Error::new("surface/number", "`v` has three numbers").at(line.place())
                    );
                };
                soup.corners.push(Vec3::new(x, y, z));
            }
            Some("f") => {
                polygon.clear();
                for word in words {
                    let corner = corner(word, soup.corners.len());
                    polygon.push(corner.ok_or_else(|| {
                        Error::new("surface/corner", format!("`{word}` names no corner"))
                            .with_help("corners are counted from 1, or backwards from -1")
                            .at(line.place_of(word))
                    })?);
                }
                soup.polygon(&polygon);
            }
            _ => {}
        }
    }
    Ok(soup)
}

/// The corner of `7`, `7/1`, `7//3` or `-1`, the last one so far.
fn corner(word: &str, so_far: usize) -> Option<u32> {
    let place: i64 = word.split('/').next()?.parse().ok()?;
    let index = if place < 0 { i64::try_from(so_far).ok()?.checked_add(place)? } else { place - 1 };
    // A corner may stand below the polygons that have it: whether it is there is seen at the end.
    u32::try_from(index).ok()
}
