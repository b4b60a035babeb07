//! The entries of a zip archive: the directory at its end, entries that are stored or deflated, sizes of 64 bits.
//!
//! What is inflated is bounded by the size of the archive, whatever its directory states. Stored entries are not copied.

use condyle_diagnostics::{Error, Place};
use flate2::{Crc, Decompress, FlushDecompress, Status};
use std::borrow::Cow;

/// More entries are refused: bodies with all their tables have fifty.
const MOST_ENTRIES: usize = 4096;
/// All entries together are inflated to at most so many times the archive's size ...
const INFLATED_PER_BYTE: usize = 3;
/// ... and this many bytes.
const INFLATED_BASE: usize = 24 << 20;
/// The longest comment at the end.
const LONGEST_COMMENT: usize = 65_535;

/// One entry.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    encrypted: bool,
    method: u16,
    crc: u32,
    packed: u64,
    size: u64,
    /// Where its own header begins.
    at: u64,
}

/// An archive.
#[derive(Debug)]
pub(super) struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
    /// How much may still be inflated.
    left: usize,
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<u64> {
    let digits = bytes.get(at..at.checked_add(N)?)?;
    Some(digits.iter().rev().fold(0, |number, digit| number << 8 | u64::from(*digit)))
}

fn cut(message: &str) -> Error {
    let help = "it may be cut off: fetch it again";
    Error::new("smpl/archive", message).with_help(help)
}

impl<'a> Archive<'a> {
    /// Reads the directory.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        if !bytes.starts_with(b"PK") {
            let help = "an .npz file is a zip archive of arrays, as numpy.savez writes it";
            return Err(Error::new("smpl/archive", "the file is no zip archive").with_help(help));
        }
        let end = end_of_directory(bytes)
            .ok_or_else(|| cut("the archive has no directory at its end"))?;
        let (count, size, offset) = directory(bytes, end)
            .ok_or_else(|| cut("the end of the archive does not say where its directory is"))?;
        if count > MOST_ENTRIES as u64 {
            let message = format!("the archive has {count} entries, more than {MOST_ENTRIES}");
            return Err(Error::new("smpl/archive", message));
        }
        let is_there = |at: u64| {
            let at = usize::try_from(at).unwrap_or(usize::MAX);
            bytes.get(at..).is_some_and(|rest| rest.starts_with(b"PK\x01\x02"))
        };
        // What stands before the archive shifts all places.
        let start = (end as u64).saturating_sub(size);
        let shift = match is_there(offset) || !is_there(start) {
            true => 0,
            false => start.wrapping_sub(offset),
        };
        let mut at = usize::try_from(offset.wrapping_add(shift)).unwrap_or(usize::MAX);
        let mut entries = Vec::with_capacity(count as usize);
        for _ in 0..count {
            let (mut entry, next) =
                entry(bytes, at).ok_or_else(|| cut("the directory of the archive is damaged"))?;
            entry.at = entry.at.wrapping_add(shift);
            entries.push(entry);
            at = next;
        }
        let left = bytes.len().saturating_mul(INFLATED_PER_BYTE).saturating_add(INFLATED_BASE);
        Ok(Self { bytes, entries, left })
    }

    /// The names of all entries, without folders and without `.npy`.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| {
            let name = entry.name.rsplit(['/', '\\']).next().unwrap_or(&entry.name);
            name.strip_suffix(".npy").unwrap_or(name)
        })
    }

    /// The content of an entry by its position.
    pub(super) fn content(&mut self, index: usize) -> Result<Cow<'a, [u8]>, Error> {
        let Some(entry) = self.entries.get(index).cloned() else {
            return Err(Error::new("smpl/archive", "there is no such entry"));
        };
        let place = Place::at_byte(entry.at);
        let wrong = |what: &str| {
            let message = format!("`{:.60}` {what}", entry.name);
            Error::new("smpl/archive", message).at(place)
        };
        let packed = usize::try_from(entry.at)
            .ok()
            .and_then(|at| data(self.bytes, at, entry.packed))
            .ok_or_else(|| wrong("is not all there: the archive may be cut off"))?;
        if entry.encrypted {
            return Err(wrong("is encrypted"));
        }
        let content = match entry.method {
            0 => Cow::Borrowed(packed),
            8 => Cow::Owned(self.inflated(packed, entry.size).map_err(|what| wrong(&what))?),
            other => {
                let help = "stored and deflated entries are read, as numpy writes them";
                return Err(wrong(&format!("is packed by method {other}")).with_help(help));
            }
        };
        if content.len() as u64 != entry.size {
            return Err(wrong("has another size than the directory states"));
        }
        let mut crc = Crc::new();
        crc.update(&content);
        match crc.sum() == entry.crc {
            true => Ok(content),
            false => Err(wrong("is damaged: its checksum is another")),
        }
    }

    /// Inflates, to exactly the size that is stated.
    fn inflated(&mut self, packed: &[u8], size: u64) -> Result<Vec<u8>, String> {
        let size = usize::try_from(size).ok().filter(|size| *size <= self.left).ok_or_else(|| {
            format!(
                "inflates to {size} bytes: at most {INFLATED_PER_BYTE} times the archive and {} MB are taken",
                INFLATED_BASE >> 20
            )
        })?;
        self.left -= size;
        let mut content = Vec::with_capacity(size);
        let mut inflate = Decompress::new(false);
        let status = inflate.decompress_vec(packed, &mut content, FlushDecompress::Finish);
        match status {
            Ok(Status::StreamEnd) => Ok(content),
            // The last bits of the stream may come when all bytes are out.
            Ok(_) if content.len() == size && inflate.total_in() == packed.len() as u64 => {
                Ok(content)
            }
            Ok(_) if content.len() == size => Err("inflates to more than is stated".to_owned()),
            Ok(_) => Err("ends too early".to_owned()),
            Err(_) => Err("is damaged: it cannot be inflated".to_owned()),
        }
    }
}

/// Where the record is that ends the archive: the last one whose comment fits.
fn end_of_directory(bytes: &[u8]) -> Option<usize> {
    let first = bytes.len().saturating_sub(22 + LONGEST_COMMENT);
    let tail = bytes.get(first..)?;
    let found = tail.windows(22).rposition(|record| record.starts_with(b"PK\x05\x06"))?;
    Some(first + found)
}

/// How many entries, how many bytes of directory, and where it begins.
fn directory(bytes: &[u8], end: usize) -> Option<(u64, u64, u64)> {
    let count = number::<2>(bytes, end + 10)?;
    let size = number::<4>(bytes, end + 12)?;
    let offset = number::<4>(bytes, end + 16)?;
    if count != 0xffff && size != 0xffff_ffff && offset != 0xffff_ffff {
        return Some((count, size, offset));
    }
    // The record of 64 bits, whose place stands before this one.
    let locator = end.checked_sub(20)?;
    if !bytes.get(locator..)?.starts_with(b"PK\x06\x07") {
        return Some((count, size, offset));
    }
    let at = usize::try_from(number::<8>(bytes, locator + 8)?).ok()?;
    if !bytes.get(at..)?.starts_with(b"PK\x06\x06") {
        return None;
    }
    Some((
        number::<8>(bytes, at.checked_add(32)?)?,
        number::<8>(bytes, at.checked_add(40)?)?,
        number::<8>(bytes, at.checked_add(48)?)?,
    ))
}

/// An entry of the directory, and where the next one is.
fn entry(bytes: &[u8], at: usize) -> Option<(Entry, usize)> {
    let head = bytes.get(at..at.checked_add(46)?)?;
    if !head.starts_with(b"PK\x01\x02") {
        return None;
    }
    let flags = number::<2>(head, 8)?;
    let lengths = [28, 30, 32].map(|place| number::<2>(head, place).unwrap_or(0) as usize);
    let name = bytes.get(at + 46..at + 46 + lengths[0])?;
    let extra_at = at + 46 + lengths[0];
    let mut extra = bytes.get(extra_at..extra_at + lengths[1])?;
    // Fields that do not fit stand in the extra field of number 1, in this order.
    let mut fields = [number::<4>(head, 24)?, number::<4>(head, 20)?, number::<4>(head, 42)?];
    while let (Some(kind), Some(length)) = (number::<2>(extra, 0), number::<2>(extra, 2)) {
        let own = extra.get(4..4 + length as usize)?;
        if kind == 1 {
            let mut place = 0;
            for field in fields.iter_mut().filter(|field| **field == 0xffff_ffff) {
                *field = number::<8>(own, place)?;
                place += 8;
            }
        }
        extra = extra.get(4 + length as usize..)?;
    }
    let [size, packed, own_at] = fields;
    let entry = Entry {
        name: String::from_utf8_lossy(name).into_owned(),
        encrypted: flags & 1 == 1,
        method: number::<2>(head, 10)? as u16,
        crc: number::<4>(head, 16)? as u32,
        packed,
        size,
        at: own_at,
    };
    Some((entry, extra_at + lengths[1] + lengths[2]))
}

/// The packed bytes behind the header at a place.
fn data(bytes: &[u8], at: usize, packed: u64) -> Option<&[u8]> {
    let head = bytes.get(at..at.checked_add(30)?)?;
    if !head.starts_with(b"PK\x03\x04") {
        return None;
    }
    let name = number::<2>(head, 26)? as usize;
    let extra = number::<2>(head, 28)? as usize;
    let start = at + 30 + name + extra;
    bytes.get(start..start.checked_add(usize::try_from(packed).ok()?)?)
}
