//! Groups of parameters: what a file says about itself.

/// All groups of a file, in its order.
///
/// ```
/// use condyle_formats::c3d::{Parameters, Values};
/// let mut parameters = Parameters::default();
/// parameters.set("POINT", "USED", Values::Integers(vec![26]), &[]);
/// parameters.set_texts("POINT", "LABELS", &["LASI", "RASI"]);
/// assert_eq!(parameters.number("point", "used"), Some(26.0));
/// assert_eq!(parameters.texts("POINT", "LABELS"), ["LASI", "RASI"]);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    /// The groups.
    pub groups: Vec<Group>,
}

/// A group of parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Group {
    /// Its name; blank if the file has parameters of a group that it does not name.
    pub name: String,
    /// What it is, in words.
    pub description: String,
    /// Whether programs should leave it alone.
    pub locked: bool,
    /// Its parameters, in the order of the file.
    pub parameters: Vec<Parameter>,
}

/// One parameter: a number, a text, or an array of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What it is, in words.
    pub description: String,
    /// Whether programs should leave it alone.
    pub locked: bool,
    /// The sizes of the array, that which changes fastest first; of texts the first is their length. None of
    /// a single value.
    pub sizes: Vec<u8>,
    /// Its values, as many as the product of the sizes.
    pub values: Values,
}

/// The values of a parameter.
#[derive(Debug, Clone)]
pub enum Values {
    /// Letters in an unstated encoding.
    Letters(Vec<u8>),
    /// Small whole numbers.
    Bytes(Vec<u8>),
    /// Whole numbers of 16 bits.
    Integers(Vec<i16>),
    /// Numbers.
    Floats(Vec<f32>),
}

impl Values {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Letters(values) | Self::Bytes(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Floats(values) => values.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them as a number; `None` of letters.
    #[must_use]
    pub fn number(&self, index: usize) -> Option<f64> {
        match self {
            Self::Letters(_) => None,
            Self::Bytes(values) => values.get(index).map(|&v| f64::from(v)),
            Self::Integers(values) => values.get(index).map(|&v| f64::from(v)),
            Self::Floats(values) => values.get(index).map(|&v| f64::from(v)),
        }
    }
}

/// Floats are compared by their bits, so that what is not a number equals itself.
impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Letters(a), Self::Letters(b)) | (Self::Bytes(a), Self::Bytes(b)) => a == b,
            (Self::Integers(a), Self::Integers(b)) => a == b,
            (Self::Floats(a), Self::Floats(b)) => {
                a.iter().map(|v| v.to_bits()).eq(b.iter().map(|v| v.to_bits()))
            }
            _ => false,
        }
    }
}

impl Parameter {
    /// Its texts without the blanks around them; none of numbers.
    #[must_use]
    pub fn texts(&self) -> Vec<String> {
        let Values::Letters(letters) = &self.values else { return vec![] };
        let width = match self.sizes.first() {
            Some(0) => return vec![],
            Some(&width) => usize::from(width),
            None => 1,
        };
        letters.chunks(width).map(text).collect()
    }

    /// All its numbers; none of texts.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        (0..self.values.len()).filter_map(|index| self.values.number(index)).collect()
    }
}

/// Letters up to the first NUL, without blanks around them: UTF-8, else Latin-1.
pub(super) fn text(letters: &[u8]) -> String {
    let letters = letters.split(|&b| b == 0).next().unwrap_or_default();
    let text = match std::str::from_utf8(letters) {
        Ok(text) => text.to_owned(),
        Err(_) => letters.iter().map(|&b| char::from(b)).collect(),
    };
    text.trim().to_owned()
}

/// Texts side by side, each as wide as the longest.
fn letters(texts: &[&str]) -> (Vec<u8>, [u8; 2]) {
    let longest = texts.iter().map(|t| t.len()).max().unwrap_or(0).clamp(1, 127);
    let mut all = Vec::with_capacity(longest * texts.len());
    for text in texts {
        let bytes = text.as_bytes();
        let kept = bytes.get(..longest).unwrap_or(bytes);
        all.extend_from_slice(kept);
        all.resize(all.len() + longest - kept.len(), b' ');
    }
    (all, [longest as u8, texts.len().min(255) as u8])
}

/// How many texts one parameter holds; further ones are in `LABELS2`, `LABELS3`, …
const TEXTS: usize = 255;

/// `LABELS`, `LABELS2`, `LABELS3`, …
fn numbered(name: &str) -> impl Iterator<Item = String> + '_ {
    (1..).map(move |n: usize| if n == 1 { name.to_owned() } else { format!("{name}{n}") })
}

impl Parameters {
    /// A group by its name, in any case.
    #[must_use]
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name.eq_ignore_ascii_case(name))
    }

    /// A parameter by the names of its group and its own, in any case.
    #[must_use]
    pub fn get(&self, group: &str, name: &str) -> Option<&Parameter> {
        self.group(group)?.parameters.iter().find(|p| p.name.eq_ignore_ascii_case(name))
    }

    /// The first number of a parameter.
    #[must_use]
    pub fn number(&self, group: &str, name: &str) -> Option<f64> {
        self.get(group, name)?.values.number(0)
    }

    /// The first number of a parameter that counts something: whole numbers without a sign.
    pub(super) fn count(&self, group: &str, name: &str) -> Option<usize> {
        match &self.get(group, name)?.values {
            Values::Integers(values) => values.first().map(|&v| usize::from(v as u16)),
            values => values.number(0).filter(|v| (0.0..1e9).contains(v)).map(|v| v as usize),
        }
    }

    /// The first text of a parameter; blank if there is none.
    #[must_use]
    pub fn text(&self, group: &str, name: &str) -> String {
        self.get(group, name).and_then(|p| p.texts().into_iter().next()).unwrap_or_default()
    }

    /// The texts of a parameter and of those that continue it: `LABELS`, `LABELS2`, …
    #[must_use]
    pub fn texts(&self, group: &str, name: &str) -> Vec<String> {
        let found = numbered(name).map_while(|name| self.get(group, &name));
        found.flat_map(Parameter::texts).collect()
    }

    /// The numbers of a parameter and of those that continue it: `SCALE`, `SCALE2`, …
    #[must_use]
    pub fn numbers(&self, group: &str, name: &str) -> Vec<f64> {
        let found = numbered(name).map_while(|name| self.get(group, &name));
        found.flat_map(Parameter::numbers).collect()
    }

    fn group_mut(&mut self, name: &str) -> &mut Group {
        let known = self.groups.iter().position(|g| g.name.eq_ignore_ascii_case(name));
        let index = known.unwrap_or(self.groups.len());
        if known.is_none() {
            self.groups.push(Group { name: name.to_owned(), ..Group::default() });
        }
        &mut self.groups[index]
    }

    /// Sets the values of a parameter, which is made where there is none.
    pub fn set(&mut self, group: &str, name: &str, values: Values, sizes: &[u8]) {
        let group = self.group_mut(group);
        let sizes = sizes.to_vec();
        match group.parameters.iter_mut().find(|p| p.name.eq_ignore_ascii_case(name)) {
            Some(known) => (known.values, known.sizes) = (values, sizes),
            None => group.parameters.push(Parameter {
                name: name.to_owned(),
                description: String::new(),
                locked: false,
                sizes,
                values,
            }),
        }
    }

    /// Removes a parameter.
    pub fn remove(&mut self, group: &str, name: &str) {
        if self.get(group, name).is_some() {
            self.group_mut(group).parameters.retain(|p| !p.name.eq_ignore_ascii_case(name));
        }
    }

    /// Sets a list of texts, continued in `NAME2`, `NAME3`, … after 255 of them; one that is the same already
    /// stays as it is. At most 127 bytes of each text are kept.
    pub fn set_texts<S: AsRef<str>>(&mut self, group: &str, name: &str, texts: &[S]) {
        let texts: Vec<&str> = texts.iter().map(AsRef::as_ref).collect();
        if self.texts(group, name) == texts && self.get(group, name).is_some() {
            return;
        }
        self.set_parts(
            group,
            name,
            texts.chunks(TEXTS).map(|part| {
                let (letters, sizes) = letters(part);
                (Values::Letters(letters), sizes.to_vec())
            }),
        );
    }

    /// Sets a list of numbers, continued as texts are; one that is the same already stays as it is.
    pub(super) fn set_numbers(&mut self, group: &str, name: &str, numbers: &[f64], whole: bool) {
        if self.numbers(group, name) == numbers && self.get(group, name).is_some() {
            return;
        }
        self.set_parts(
            group,
            name,
            numbers.chunks(TEXTS).map(|part| {
                let values = match whole {
                    true => Values::Integers(part.iter().map(|&v| v as i16).collect()),
                    false => Values::Floats(part.iter().map(|&v| v as f32).collect()),
                };
                (values, vec![part.len() as u8])
            }),
        );
    }

    fn set_parts(
        &mut self,
        group: &str,
        name: &str,
        parts: impl Iterator<Item = (Values, Vec<u8>)>,
    ) {
        let mut count = 0;
        for ((values, sizes), name) in parts.zip(numbered(name)) {
            self.set(group, &name, values, &sizes);
            count += 1;
        }
        for name in numbered(name).skip(count) {
            if self.get(group, &name).is_none() {
                break;
            }
            self.remove(group, &name);
        }
    }
}
