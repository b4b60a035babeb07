//! VTK's polygons in XML: numbers in text, in base64, or in bytes behind the XML, deflated or not.
//!
//! A block of numbers that is not text begins with a heading of whole numbers of 4 or 8 bytes: its length in bytes, or
//! where it is deflated how many parts there are, the length of a part, of the last part (0 if it is whole), and the
//! deflated length of each. In base64 the heading of a deflated block is encoded by itself, any other together with its
//! numbers.

use super::Soup;
use crate::text::{base64, number};
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::Error;
use condyle_math::Vec3;
use flate2::read::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read;

/// How large all numbers of a file may become, beside eight times its own size.
const ROOM: usize = 64 << 20;

/// What stands behind the `_` of the appended data, and whether it is base64.
type Appended<'b> = Option<(&'b [u8], bool)>;

/// How numbers are written that are not text.
struct Encoding<'b> {
    big: bool,
    /// Bytes of a number in a heading.
    wide: usize,
    deflated: bool,
    appended: Appended<'b>,
}

pub(super) fn read(bytes: &[u8]) -> Result<Soup, Error> {
    let (xml, appended) = split(bytes);
    let document = XmlDocument::from_bytes(&xml)?.value;
    let root = document.root();
    let data = root.child("PolyData").filter(|_| root.is("VTKFile")).ok_or_else(|| {
        root.error("vtp/kind", format!("the file holds `{}`", root.attribute("type").unwrap_or("")))
            .with_help("polygons are read: PolyData")
    })?;
    let compressor = root.attribute("compressor").unwrap_or("");
    if !matches!(compressor, "" | "vtkZLibDataCompressor") {
        return Err(root
            .error("vtp/compressor", format!("numbers are packed by `{compressor}`"))
            .with_help("save it with zlib or without compression"));
    }
    let encoding = Encoding {
        big: root.attribute("byte_order") == Some("BigEndian"),
        wide: if root.attribute("header_type") == Some("UInt64") { 8 } else { 4 },
        deflated: !compressor.is_empty(),
        appended,
    };
    let mut room = bytes.len().saturating_mul(8).saturating_add(ROOM) / 8;
    let mut soup = Soup::default();
    for piece in data.children_named("Piece") {
        let array = |parent: &str, name: Option<&str>| {
            let parent = piece.child(parent)?;
            parent.children_named("DataArray").find(|array| {
                name.is_none_or(|name| {
                    array.attribute("Name").is_some_and(|own| own.eq_ignore_ascii_case(name))
                })
            })
        };
        let Some(points) = array("Points", None) else { continue };
        let places = encoding.numbers(points, &mut room)?;
        let first = soup.corners.len();
        let (places, rest) = places.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(points.error("vtp/points", "points do not have three numbers each"));
        }
        soup.corners.extend(places.iter().map(|p| Vec3::from(*p)));
        for kind in ["Polys", "Strips"] {
            let corners = array(kind, Some("connectivity")).zip(array(kind, Some("offsets")));
            let Some((corners, ends)) = corners else { continue };
            let index = |x: f64| {
                let inside = x >= 0.0 && x < places.len() as f64 && x.fract() == 0.0;
                inside.then(|| first as u32 + x as u32).ok_or_else(|| {
                    corners
                        .error("surface/corner", format!("there is no corner {x}"))
                        .with_help(format!("the piece has {} points", places.len()))
                })
            };
            let numbers = encoding.numbers(corners, &mut room)?;
            let all = numbers.into_iter().map(index).collect::<Result<Vec<u32>, Error>>()?;
            let mut start = 0;
            for end in encoding.numbers(ends, &mut room)? {
                let Some(part) = all.get(start..end.max(0.0) as usize) else {
                    return Err(ends.error("vtp/offsets", format!("a polygon ends at {end}")));
                };
                start = end as usize;
                match kind {
                    "Polys" => soup.polygon(part),
                    // Every second triangle of a strip is turned round.
                    _ => soup.triangles.extend(part.windows(3).enumerate().map(|(at, t)| {
                        if at % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
                    })),
                }
            }
        }
    }
    Ok(soup)
}

/// The XML without what is appended to it, which may be any bytes.
fn split(bytes: &[u8]) -> (Cow<'_, [u8]>, Appended<'_>) {
    const TAG: &[u8] = b"<AppendedData";
    let whole = (Cow::Borrowed(bytes), None);
    let Some(tag) = bytes.windows(TAG.len()).position(|part| part == TAG) else { return whole };
    let (before, after) = bytes.split_at(tag);
    let Some(shut) = after.iter().position(|b| *b == b'>') else { return whole };
    let (open, rest) = after.split_at(shut + 1);
    let Some(mark) = rest.iter().position(|b| *b == b'_') else { return whole };
    let is_base64 = open.windows(6).any(|part| part == b"base64");
    let xml = [before, b"</VTKFile>"].concat();
    (Cow::Owned(xml), Some((rest.get(mark + 1..).unwrap_or_default(), is_base64)))
}

impl Encoding<'_> {
    /// The numbers of an array.
    fn numbers(&self, array: Element<'_>, room: &mut usize) -> Result<Vec<f64>, Error> {
        let wrong = |why: &str| {
            let name = array.attribute("Name").unwrap_or("points");
            array.error("vtp/numbers", format!("the numbers of `{name}`: {why}"))
        };
        let format = array.attribute("format").unwrap_or("ascii");
        if format == "ascii" {
            let mut numbers = vec![];
            for word in array.text().split_whitespace() {
                *room = room.checked_sub(1).ok_or_else(|| wrong("they are too many"))?;
                let value = number(word).ok_or_else(|| wrong("they are not all numbers"))?;
                numbers.push(value);
            }
            return Ok(numbers);
        }
        let kind = array.attribute("type").unwrap_or("");
        let size = size(kind).ok_or_else(|| wrong("their type is unknown"))?;
        let most = room.saturating_mul(size);
        let bytes = match format {
            "binary" => self.block(array.text().trim().as_bytes(), true, most),
            "appended" => {
                let (data, is_base64) =
                    self.appended.ok_or_else(|| wrong("nothing is appended to the file"))?;
                let offset = array.attribute("offset").and_then(|text| text.trim().parse().ok());
                let data = offset.and_then(|offset: usize| data.get(offset..));
                let data = data.ok_or_else(|| wrong("they begin behind the end of the file"))?;
                self.block(data, is_base64, most)
            }
            _ => return Err(wrong("they are neither ascii nor binary nor appended")),
        };
        let bytes = bytes.map_err(wrong)?;
        *room = room.checked_sub(bytes.len() / size).ok_or_else(|| wrong("they are too many"))?;
        Ok(decoded(kind, self.big, &bytes))
    }

    /// The bytes of a block without its heading, at most so many.
    fn block(&self, data: &[u8], is_base64: bool, most: usize) -> Result<Vec<u8>, &'static str> {
        if !self.deflated {
            let length = self.heading(&taken(data, 0, self.wide, is_base64)?, 0)?;
            return taken(data, self.wide, length, is_base64);
        }
        let three = taken(data, 0, 3 * self.wide, is_base64)?;
        let (parts, size, last) =
            (self.heading(&three, 0)?, self.heading(&three, 1)?, self.heading(&three, 2)?);
        if parts > data.len() {
            return Err("they have more parts than bytes");
        }
        if parts == 0 {
            return Ok(vec![]);
        }
        let heading = (3 + parts) * self.wide;
        let lengths = taken(data, 0, heading, is_base64)?;
        // The heading is encoded by itself.
        let behind = if is_base64 { heading.div_ceil(3) * 4 } else { heading };
        let behind = data.get(behind..).ok_or(SHORT)?;
        let total =
            (parts - 1).saturating_mul(size).saturating_add(if last == 0 { size } else { last });
        if total > most {
            return Err("they are too many");
        }
        let mut out = vec![];
        let mut start = 0usize;
        for part in 0..parts {
            let length = self.heading(&lengths, 3 + part)?;
            let packed = taken(behind, start, length, is_base64)?;
            let whole = if part + 1 == parts && last != 0 { last } else { size };
            let mut decoder = ZlibDecoder::new(&packed[..]).take(whole as u64);
            decoder.read_to_end(&mut out).map_err(|_| "they cannot be inflated")?;
            start = start.saturating_add(length);
        }
        if out.len() == total { Ok(out) } else { Err("they are not as long as stated") }
    }

    fn heading(&self, bytes: &[u8], place: usize) -> Result<usize, &'static str> {
        let part = bytes.get(place * self.wide..(place + 1) * self.wide).ok_or(SHORT)?;
        let add = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
        let value =
            if self.big { part.iter().fold(0, add) } else { part.iter().rev().fold(0, add) };
        usize::try_from(value).map_err(|_| SHORT)
    }
}

const SHORT: &str = "they break off";

/// So many bytes from a place on, of bytes or of what base64 stands for.
fn taken(
    data: &[u8],
    start: usize,
    length: usize,
    is_base64: bool,
) -> Result<Vec<u8>, &'static str> {
    let end = start.checked_add(length).ok_or(SHORT)?;
    if !is_base64 {
        return data.get(start..end).map(<[u8]>::to_vec).ok_or(SHORT);
    }
    // From the group of four letters in which the first byte is to that of the last.
    let letters = data.get(start / 3 * 4..data.len().min(end.div_ceil(3).saturating_mul(4)));
    let text = letters.and_then(|letters| std::str::from_utf8(letters).ok()).ok_or(SHORT)?;
    let bytes = base64::decode(text).ok_or("they are no base64")?;
    bytes.get(start % 3..start % 3 + length).map(<[u8]>::to_vec).ok_or(SHORT)
}

/// How many bytes a number of a type has that VTK names.
fn size(kind: &str) -> Option<usize> {
    Some(match kind {
        "Int8" | "UInt8" => 1,
        "Int16" | "UInt16" => 2,
        "Float32" | "Int32" | "UInt32" => 4,
        "Float64" | "Int64" | "UInt64" => 8,
        _ => return None,
    })
}

/// Numbers of such a type.
fn decoded(kind: &str, big: bool, bytes: &[u8]) -> Vec<f64> {
    fn each<const N: usize>(bytes: &[u8], big: bool, of: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        let little = |mut number: [u8; N]| {
            if big {
                number.reverse();
            }
            of(number)
        };
        bytes.as_chunks::<N>().0.iter().map(|number| little(*number)).collect()
    }
    match kind {
        "Float32" => each(bytes, big, |b| f64::from(f32::from_le_bytes(b))),
        "Float64" => each(bytes, big, f64::from_le_bytes),
        "Int8" => each(bytes, big, |b| f64::from(i8::from_le_bytes(b))),
        "UInt8" => each(bytes, big, |b| f64::from(u8::from_le_bytes(b))),
        "Int16" => each(bytes, big, |b| f64::from(i16::from_le_bytes(b))),
        "UInt16" => each(bytes, big, |b| f64::from(u16::from_le_bytes(b))),
        "Int32" => each(bytes, big, |b| f64::from(i32::from_le_bytes(b))),
        "UInt32" => each(bytes, big, |b| f64::from(u32::from_le_bytes(b))),
        // Positions below 2⁵³ are exact.
        "Int64" => each(bytes, big, |b| i64::from_le_bytes(b) as f64),
        _ => each(bytes, big, |b| u64::from_le_bytes(b) as f64),
    }
}
