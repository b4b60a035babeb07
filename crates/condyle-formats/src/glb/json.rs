//! Values of JSON with the way to each, for messages.

use condyle_diagnostics::Error;
use serde_json::Value;

/// Bytes that an object costs in memory at most, beside its members' own; a map of one member has room for eleven.
const OBJECT: usize = 700;
/// Bytes that a value costs in memory.
const VALUE: usize = 40;

/// Parses JSON, unless it would need more memory than twice its size and 20 MB.
///
/// # Errors
/// `glb/json` where it is none, with its line and column; `glb/size`.
pub(super) fn parse(text: &[u8]) -> Result<Value, Error> {
    let (mut objects, mut values) = (0usize, 0usize);
    for byte in text {
        match byte {
            b'{' => objects += 1,
            b',' | b'[' => values += 1,
            _ => {}
        }
    }
    // What is inside of texts is counted too: base64 has none of these letters.
    if objects * OBJECT + values * VALUE > 2 * text.len() + (20 << 20) {
        let message = format!("the JSON has {objects} objects and {values} values");
        return Err(Error::new("glb/size", message)
            .with_help("a file of this size cannot be one of a figure"));
    }
    serde_json::from_slice(text).map_err(|error| {
        let place = condyle_diagnostics::Place::at(error.line(), error.column());
        Error::new("glb/json", format!("the JSON is wrong: {error}")).at(place)
    })
}

/// No place, turn or size of a figure is larger; products of two of them are still numbers.
pub(super) const LARGEST: f64 = 1e15;

/// A value and the way to it: `/nodes/3/scale`.
#[derive(Clone, Debug)]
pub(super) struct Item<'j> {
    pub(super) value: &'j Value,
    pub(super) path: String,
}

impl<'j> Item<'j> {
    /// The whole document.
    pub(super) fn root(value: &'j Value) -> Self {
        Self { value, path: String::new() }
    }

    /// A member of an object.
    pub(super) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key)?;
        Some(Self { value, path: format!("{}/{key}", self.path) })
    }

    /// A member that has to be there.
    pub(super) fn need(&self, key: &str) -> Result<Self, Error> {
        self.get(key)
            .ok_or_else(|| Error::new("glb/json", format!("{} has no `{key}`", self.shown())))
    }

    /// The elements of a list that is a member; none where there is no such member.
    pub(super) fn list(&self, key: &str) -> Result<Vec<Self>, Error> {
        let Some(list) = self.get(key) else { return Ok(vec![]) };
        let elements = list.value.as_array().ok_or_else(|| list.wrong("a list"))?;
        let element = |(index, value)| Self { value, path: format!("{}/{index}", list.path) };
        Ok(elements.iter().enumerate().map(element).collect())
    }

    /// One element of a list that is a member.
    pub(super) fn element(&self, key: &str, index: usize) -> Result<Self, Error> {
        let list = self.value.get(key).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let path = format!("{}/{key}/{index}", self.path);
        match list.get(index) {
            Some(value) => Ok(Self { value, path }),
            None => Err(Error::new("glb/reference", format!("there is no `{path}`"))
                .with_help(format!("the list has {}, counted from 0", list.len()))),
        }
    }

    /// A whole number that is not negative.
    pub(super) fn index(&self) -> Result<usize, Error> {
        let whole = self.value.as_u64().or_else(|| {
            // Some write 3.0.
            self.value
                .as_f64()
                .filter(|x| x.fract() == 0.0 && (0.0..1e15).contains(x))
                .map(|x| x as u64)
        });
        let index = whole.and_then(|whole| usize::try_from(whole).ok());
        index.ok_or_else(|| self.wrong("a whole number"))
    }

    /// A member that is an index below `count`.
    pub(super) fn index_below(
        &self,
        key: &str,
        count: usize,
        what: &str,
    ) -> Result<Option<usize>, Error> {
        let Some(item) = self.get(key) else { return Ok(None) };
        item.below(count, what).map(Some)
    }

    /// An index below `count`.
    pub(super) fn below(&self, count: usize, what: &str) -> Result<usize, Error> {
        let index = self.index()?;
        if index < count {
            return Ok(index);
        }
        Err(Error::new("glb/reference", format!("{} names {what} {index}", self.shown()))
            .with_help(format!("there are {count}, counted from 0")))
    }

    /// A member that is a whole number, or what it is by default.
    pub(super) fn size_or(&self, key: &str, default: usize) -> Result<usize, Error> {
        self.get(key).map_or(Ok(default), |item| item.index())
    }

    /// A member that is a text.
    pub(super) fn text(&self, key: &str) -> Option<&'j str> {
        self.value.get(key)?.as_str()
    }

    /// A member that is so many numbers, none beyond [`LARGEST`].
    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Error> {
        let Some(item) = self.get(key) else { return Ok(None) };
        let list = item.value.as_array().filter(|list| list.len() == N);
        let list = list.ok_or_else(|| item.wrong(&format!("a list of {N} numbers")))?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(list) {
            let read = value.as_f64().filter(|x| x.abs() <= LARGEST);
            *number = read.ok_or_else(|| item.wrong(&format!("a list of {N} numbers")))?;
        }
        Ok(Some(numbers))
    }

    /// The way to it for a message.
    pub(super) fn shown(&self) -> String {
        if self.path.is_empty() { "the file".to_owned() } else { format!("`{}`", self.path) }
    }

    fn wrong(&self, right: &str) -> Error {
        Error::new("glb/json", format!("{} is not {right}", self.shown()))
    }
}
