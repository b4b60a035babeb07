//! Accessors: numbers of any component type in buffers, interleaved or sparse.

use super::json::{Item, LARGEST};
use crate::text::base64;
use condyle_diagnostics::Error;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

/// The bytes of another file by its path as seen from the one that is read; else a sentence.
pub type Beside<'r> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'r;

/// The kinds of numbers of which accessors consist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// A number from its bytes. Normalised ones are c/255, c/65535, max(c/127, -1), max(c/32767, -1).
    fn number(self, bytes: &[u8], normalised: bool) -> f64 {
        let byte = |index: usize| bytes.get(index).copied().unwrap_or(0);
        let two = [byte(0), byte(1)];
        let four = [byte(0), byte(1), byte(2), byte(3)];
        let (number, most) = match self {
            Self::I8 => (f64::from(byte(0) as i8), 127.0),
            Self::U8 => (f64::from(byte(0)), 255.0),
            Self::I16 => (f64::from(i16::from_le_bytes(two)), 32767.0),
            Self::U16 => (f64::from(u16::from_le_bytes(two)), 65535.0),
            Self::U32 => (f64::from(u32::from_le_bytes(four)), 4_294_967_295.0),
            Self::F32 => return f64::from(f32::from_le_bytes(four)),
        };
        if normalised { (number / most).max(-1.0) } else { number }
    }
}

/// Numbers one after the other, so many for each element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbers {
    /// The numbers.
    pub(super) values: Vec<f64>,
    /// How many are an element.
    pub(super) width: usize,
}

impl Numbers {
    /// How many elements there are.
    pub(super) fn count(&self) -> usize {
        self.values.len() / self.width
    }
}

/// The accessors of a file, read when they are asked for and kept.
pub(super) struct Accessors<'b, 'j, 'r> {
    root: &'j Value,
    binary: Option<&'b [u8]>,
    beside: &'r mut Beside<'r>,
    buffers: HashMap<usize, Rc<Cow<'b, [u8]>>>,
    read: HashMap<usize, Rc<Numbers>>,
    /// How many numbers may still be made.
    room: usize,
}

impl<'b, 'j, 'r> Accessors<'b, 'j, 'r> {
    /// Those of a file of `size` bytes.
    pub(super) fn new(
        root: &'j Value,
        binary: Option<&'b [u8]>,
        beside: &'r mut Beside<'r>,
        size: usize,
    ) -> Self {
        // Three times the size of the file and 16 MB, in numbers of 8 bytes.
        let room = (3 * size + (16 << 20)) / 8;
        Self { root, binary, beside, buffers: HashMap::new(), read: HashMap::new(), room }
    }

    /// The numbers of an accessor.
    ///
    /// # Errors
    /// `glb/json`, `glb/reference`, `glb/accessor` where it reaches beyond its bytes, `glb/buffer` where those are
    /// not at hand, `glb/size`.
    pub(super) fn numbers(&mut self, index: usize) -> Result<Rc<Numbers>, Error> {
        if let Some(read) = self.read.get(&index) {
            return Ok(Rc::clone(read));
        }
        let accessor = Item::root(self.root).element("accessors", index)?;
        let numbers = Rc::new(self.made(&accessor)?);
        self.read.insert(index, Rc::clone(&numbers));
        Ok(numbers)
    }

    fn made(&mut self, accessor: &Item<'j>) -> Result<Numbers, Error> {
        let component = component(accessor)?;
        let kind = accessor.text("type").unwrap_or("");
        // Columns of small matrices are padded to 4 bytes; none of these are used by skeletons.
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => {
                let message = format!("{} is of type `{kind}`", accessor.shown());
                return Err(Error::new("glb/accessor", message)
                    .with_help("numbers of a skeleton are SCALAR, VEC2, VEC3, VEC4 or MAT4"));
            }
        };
        let count = accessor.need("count")?.index()?;
        let normalised = accessor.value.get("normalized").and_then(Value::as_bool) == Some(true);
        let total =
            count.checked_mul(width).filter(|total| *total <= self.room).ok_or_else(|| {
                let message = format!(
                    "{} has {count} elements, more than the file can hold",
                    accessor.shown()
                );
                Error::new("glb/size", message)
            })?;
        self.room -= total;
        let mut values = vec![];
        if accessor.get("bufferView").is_some() {
            let (bytes, stride) = self.bytes(accessor, component.size() * width, count)?;
            values.reserve_exact(total);
            let (buffer, range) = bytes;
            let part = buffer.get(range).unwrap_or_default();
            for element in 0..count {
                let start = element * stride;
                for number in 0..width {
                    let at = start + number * component.size();
                    values.push(component.number(part.get(at..).unwrap_or_default(), normalised));
                }
            }
        } else {
            // Without bytes an accessor is all zeros.
            values.resize(total, 0.0);
        }
        if let Some(sparse) = accessor.get("sparse") {
            self.replace(&sparse, &mut values, width, count, component, normalised)?;
        }
        if let Some(bad) = values.iter().position(|x| x.is_nan() || x.abs() > LARGEST) {
            let element = bad / width;
            let message =
                format!("{}: element {element} is no number of a figure", accessor.shown());
            return Err(Error::new("glb/accessor", message));
        }
        Ok(Numbers { values, width })
    }

    /// The elements of a sparse accessor that have values of their own.
    fn replace(
        &mut self,
        sparse: &Item<'j>,
        values: &mut [f64],
        width: usize,
        count: usize,
        component: Component,
        normalised: bool,
    ) -> Result<(), Error> {
        let changed = sparse.need("count")?.index()?;
        if changed > count {
            let message = format!("{} changes {changed} of {count} elements", sparse.shown());
            return Err(Error::new("glb/accessor", message));
        }
        let (places, given) = (sparse.need("indices")?, sparse.need("values")?);
        let whole = self::component(&places)?;
        let ((place_buffer, place_range), place_stride) =
            self.bytes(&places, whole.size(), changed)?;
        let size = component.size() * width;
        let ((buffer, range), stride) = self.bytes(&given, size, changed)?;
        let place_bytes = place_buffer.get(place_range).unwrap_or_default();
        let bytes = buffer.get(range).unwrap_or_default();
        for change in 0..changed {
            let at = place_bytes.get(change * place_stride..).unwrap_or_default();
            let element = whole.number(at, false) as usize;
            let start = element.saturating_mul(width);
            let Some(target) = values.get_mut(start..start.saturating_add(width)) else {
                let message = format!("{} names element {element} of {count}", places.shown());
                return Err(Error::new("glb/accessor", message));
            };
            for (number, value) in target.iter_mut().enumerate() {
                let at = change * stride + number * component.size();
                *value = component.number(bytes.get(at..).unwrap_or_default(), normalised);
            }
        }
        Ok(())
    }

    /// The bytes of `count` elements of `size` bytes each in the view of `item`, and the step between elements.
    #[expect(clippy::type_complexity, reason = "a buffer and a part of it")]
    fn bytes(
        &mut self,
        item: &Item<'j>,
        size: usize,
        count: usize,
    ) -> Result<((Rc<Cow<'b, [u8]>>, std::ops::Range<usize>), usize), Error> {
        let view =
            Item::root(self.root).element("bufferViews", item.need("bufferView")?.index()?)?;
        let buffer = self.buffer(view.need("buffer")?.index()?)?;
        let start = view.size_or("byteOffset", 0)?;
        let length = view.need("byteLength")?.index()?;
        let offset = item.size_or("byteOffset", 0)?;
        let stride = view.size_or("byteStride", size)?.max(1);
        let beyond = || {
            let message = format!(
                "{}: {count} elements of {size} bytes reach beyond the {length} bytes of {} in a buffer of {}",
                item.shown(),
                view.shown(),
                buffer.len()
            );
            Error::new("glb/accessor", message)
        };
        let needed = match count {
            0 => 0,
            _ => (count - 1)
                .checked_mul(stride)
                .and_then(|n| n.checked_add(size))
                .ok_or_else(beyond)?,
        };
        let end_in_view =
            offset.checked_add(needed).filter(|end| *end <= length).ok_or_else(beyond)?;
        let end =
            start.checked_add(end_in_view).filter(|end| *end <= buffer.len()).ok_or_else(beyond)?;
        Ok(((Rc::clone(&buffer), end - needed..end), stride))
    }

    fn buffer(&mut self, index: usize) -> Result<Rc<Cow<'b, [u8]>>, Error> {
        if let Some(buffer) = self.buffers.get(&index) {
            return Ok(Rc::clone(buffer));
        }
        let item = Item::root(self.root).element("buffers", index)?;
        let missing = |why: String| Error::new("glb/buffer", format!("{}: {why}", item.shown()));
        let bytes = match item.text("uri") {
            None => match self.binary {
                Some(binary) if index == 0 => Cow::Borrowed(binary),
                _ => {
                    return Err(missing(
                        "it has no address, and the file has no binary chunk for it".into(),
                    ));
                }
            },
            Some(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let text = data.split_once(";base64,").map(|(_, text)| text);
                    let text = text.ok_or_else(|| missing("its address holds no base64".into()))?;
                    let bytes = base64::decode(text)
                        .ok_or_else(|| missing("its base64 is wrong".into()))?;
                    Cow::Owned(bytes)
                }
                None => {
                    let path = unescaped(uri);
                    let bytes = (self.beside)(&path).map_err(|why| {
                        missing(format!("`{path}`: {why}"))
                            .with_help("it is looked for beside the file")
                    })?;
                    Cow::Owned(bytes)
                }
            },
        };
        let buffer = Rc::new(bytes);
        self.buffers.insert(index, Rc::clone(&buffer));
        Ok(buffer)
    }
}

fn component(item: &Item<'_>) -> Result<Component, Error> {
    let code = item.need("componentType")?.index()?;
    Component::of(code).ok_or_else(|| {
        Error::new("glb/accessor", format!("{} has componentType {code}", item.shown()))
            .with_help("known are 5120, 5121, 5122, 5123, 5125 and 5126")
    })
}

/// An address with its %20 and the like as they are meant.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let code = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let code = code.and_then(|two| u8::from_str_radix(two, 16).ok());
        match code {
            Some(code) if *first == b'%' => {
                bytes.push(code);
                rest = &after[2..];
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn numbers(root: &Value, binary: &[u8], index: usize) -> Result<Rc<Numbers>, Error> {
        let mut none = |path: &str| Err(format!("no {path}"));
        Accessors::new(root, Some(binary), &mut none, 1000).numbers(index)
    }

    #[test]
    fn every_component_type_is_read_and_normalised_as_the_specification_says() {
        // Two bytes of each; the formulas of "Animations" in the specification of glTF 2.0.
        let bytes = [0x81, 0x7f, 0x01, 0x80, 0xff, 0x7f, 0, 0, 0x80, 0x3f];
        let cases = [
            (5120, true, 0, vec![-1.0, 1.0]),
            (5120, false, 0, vec![-127.0, 127.0]),
            (5121, true, 0, vec![129.0 / 255.0, 127.0 / 255.0]),
            (5122, true, 2, vec![-1.0, 1.0]),
            (5123, true, 2, vec![32769.0 / 65535.0, 32767.0 / 65535.0]),
            (5126, false, 6, vec![1.0]),
        ];
        for (code, normalized, offset, expected) in cases {
            let root = json!({
                "buffers": [{"byteLength": 10}],
                "bufferViews": [{"buffer": 0, "byteLength": 10}],
                "accessors": [{"bufferView": 0, "byteOffset": offset, "componentType": code,
                    "normalized": normalized, "count": expected.len(), "type": "SCALAR"}],
            });
            assert_eq!(numbers(&root, &bytes, 0).unwrap().values, expected, "{code}");
        }
    }

    #[test]
    fn interleaved_and_sparse_elements_are_found() {
        // Records of 6 bytes of which the last two are the number; the second element is replaced.
        let bytes = [9, 9, 9, 9, 1, 0, 9, 9, 9, 9, 2, 0, 9, 9, 9, 9, 3, 0, 1, 7, 0];
        let root = json!({
            "buffers": [{"byteLength": 21}],
            "bufferViews": [{"buffer": 0, "byteLength": 18, "byteStride": 6},
                {"buffer": 0, "byteOffset": 18, "byteLength": 1}, {"buffer": 0, "byteOffset": 19, "byteLength": 2}],
            "accessors": [{"bufferView": 0, "byteOffset": 4, "componentType": 5123, "count": 3, "type": "SCALAR",
                "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121},
                    "values": {"bufferView": 2}}}],
        });
        assert_eq!(numbers(&root, &bytes, 0).unwrap().values, [1.0, 7.0, 3.0]);
    }

    #[test]
    fn counts_beyond_the_bytes_are_refused() {
        for (count, offset) in
            [(3, 0), (2, 4), (1_000_000_000_000u64, 0), (u64::MAX, 0), (2, u64::MAX)]
        {
            let root = json!({
                "buffers": [{"byteLength": 8}],
                "bufferViews": [{"buffer": 0, "byteLength": 8}],
                "accessors": [{"bufferView": 0, "byteOffset": offset, "componentType": 5126, "count": count,
                    "type": "SCALAR"}],
            });
            let error = numbers(&root, &[0; 8], 0).unwrap_err();
            assert!(["glb/accessor", "glb/size"].contains(&error.code()), "{error}");
        }
    }

    #[test]
    fn addresses_are_unescaped() {
        assert_eq!(unescaped("my%20walk.bin"), "my walk.bin");
        assert_eq!(unescaped("100%"), "100%");
    }
}
