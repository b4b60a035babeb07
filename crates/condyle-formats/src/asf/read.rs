//! An ASF file as it is written.

use super::words::{Row, rows, value};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};

/// More bones are refused.
const MOST_BONES: usize = 5000;
/// More tokens of one bone are refused.
const MOST_TOKENS: usize = 8;

/// What one number of a take does to its bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token {
    Turn(usize),
    Move(usize),
    Length,
}

impl Token {
    fn named(word: &str) -> Option<Self> {
        let axis = |letter: u8| b"xyz".iter().position(|axis| *axis == letter);
        match word.to_ascii_lowercase().as_bytes() {
            [b'l'] => Some(Self::Length),
            [b'r', letter] => axis(*letter).map(Self::Turn),
            [b't', letter] => axis(*letter).map(Self::Move),
            _ => None,
        }
    }
}

/// Axes in the order in which turns about them come.
pub(super) type Order = [usize; 3];

/// One bone, or the root.
#[derive(Clone, Debug)]
pub(super) struct Written {
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) direction: [f64; 3],
    pub(super) length: f64,
    pub(super) axis: [f64; 3],
    pub(super) order: Order,
    pub(super) tokens: Vec<Token>,
    /// Pairs of lowest and highest values.
    pub(super) limits: Vec<f64>,
}

impl Written {
    fn new(name: &str, place: Place) -> Self {
        Self {
            name: name.to_owned(),
            place,
            direction: [0.0; 3],
            length: 0.0,
            axis: [0.0; 3],
            order: [0, 1, 2],
            tokens: vec![],
            limits: vec![],
        }
    }
}

/// A skeleton as it is written.
#[derive(Debug)]
pub(super) struct Skeleton {
    pub(super) name: String,
    /// What `length` says.
    pub(super) length: Option<f64>,
    pub(super) degrees: bool,
    /// The root, whose `direction` is its position.
    pub(super) root: Written,
    pub(super) bones: Vec<Written>,
    /// Parent and child by name, with the line.
    pub(super) hierarchy: Vec<(String, String, Place)>,
}

/// Where in the file a line is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Units,
    Root,
    Bones,
    Hierarchy,
    Other,
}

/// Reads a skeleton.
pub(super) fn read(text: &str, warnings: &mut Warnings) -> Result<Skeleton, Error> {
    let mut found = Skeleton {
        name: String::new(),
        length: None,
        degrees: true,
        root: Written::new("root", Place::at_line(1)),
        bones: vec![],
        hierarchy: vec![],
    };
    found.root.tokens = vec![
        Token::Move(0),
        Token::Move(1),
        Token::Move(2),
        Token::Turn(0),
        Token::Turn(1),
        Token::Turn(2),
    ];
    let mut section = Section::Other;
    // Whether numbers that begin a line are limits.
    let mut limits = false;
    let mut seen = false;
    for row in rows(text) {
        let mut words = row.words();
        let Some(first) = words.next() else { continue };
        if let Some(keyword) = first.strip_prefix(':') {
            limits = false;
            section = match keyword.to_ascii_lowercase().as_str() {
                "name" => {
                    found.name = words.collect::<Vec<_>>().join(" ");
                    Section::Other
                }
                "units" => Section::Units,
                "root" => Section::Root,
                "bonedata" => Section::Bones,
                "hierarchy" => Section::Hierarchy,
                _ => Section::Other,
            };
            seen |= section != Section::Other;
            continue;
        }
        match section {
            Section::Units => units(&mut found, &row),
            Section::Root => item(&mut found.root, &row, &mut limits, warnings)?,
            Section::Bones if first.eq_ignore_ascii_case("begin") => {
                if found.bones.len() >= MOST_BONES {
                    let message = format!("there are more than {MOST_BONES} bones");
                    return Err(Error::new("asf/size", message).at(row.place()));
                }
                limits = false;
                found.bones.push(Written::new("", row.place()));
            }
            Section::Bones if first.eq_ignore_ascii_case("end") => limits = false,
            Section::Bones => match found.bones.last_mut() {
                Some(bone) => item(bone, &row, &mut limits, warnings)?,
                None => {
                    let message = format!("`{first:.40}` stands before the first `begin`");
                    return Err(Error::new("asf/grammar", message).at(row.place()));
                }
            },
            Section::Hierarchy => {
                if !first.eq_ignore_ascii_case("begin") && !first.eq_ignore_ascii_case("end") {
                    let pairs =
                        words.map(|child| (first.to_owned(), child.to_owned(), row.place()));
                    found.hierarchy.extend(pairs);
                }
            }
            Section::Other => {}
        }
    }
    if !seen {
        let message = "there is no :root, no :bonedata and no :hierarchy";
        let help = "an ASF file begins with `:version 1.10`";
        return Err(Error::new("asf/empty", message).at(Place::at_line(1)).with_help(help));
    }
    Ok(found)
}

fn units(found: &mut Skeleton, row: &Row<'_>) {
    let mut words = row.words();
    while let (Some(key), Some(word)) = (words.next(), words.next()) {
        match key.to_ascii_lowercase().as_str() {
            "length" => found.length = value(word),
            "angle" => found.degrees = !word.to_ascii_lowercase().starts_with("rad"),
            _ => {}
        }
    }
}

/// One line about a bone or the root.
fn item(
    bone: &mut Written,
    row: &Row<'_>,
    limits: &mut bool,
    warnings: &mut Warnings,
) -> Result<(), Error> {
    let mut words = row.words();
    let Some(first) = words.next() else { return Ok(()) };
    if *limits && value(first).is_some() {
        return add_limits(bone, row, row.words());
    }
    *limits = false;
    let key = first.to_ascii_lowercase();
    let wrong = |word: &str| {
        let message = format!("`{word:.40}` is not known behind `{first:.40}`");
        Error::new("asf/grammar", message).at(row.place())
    };
    match key.as_str() {
        "name" => bone.name = words.collect::<Vec<_>>().join(" "),
        "direction" | "position" => bone.direction = numbers(row, words)?.0,
        "length" => {
            let word = words.next().unwrap_or("");
            bone.length = value(word).filter(|l| l.is_finite()).ok_or_else(|| wrong(word))?;
        }
        "axis" | "orientation" => {
            let mut rest = words.clone();
            if words.clone().next().is_some_and(|word| value(word).is_some()) {
                let (axis, after) = numbers(row, words)?;
                bone.axis = axis;
                rest = after;
            }
            if let Some(word) = rest.next() {
                bone.order = order(word).ok_or_else(|| wrong(word))?;
            }
        }
        "dof" | "order" => {
            let tokens: Option<Vec<Token>> = words.clone().map(Token::named).collect();
            bone.tokens = tokens.ok_or_else(|| {
                let unknown = words.clone().find(|word| Token::named(word).is_none());
                wrong(unknown.unwrap_or("")).with_help("known are rx, ry, rz, tx, ty, tz and l")
            })?;
            if bone.tokens.len() > MOST_TOKENS {
                let message = format!("a bone has more than {MOST_TOKENS} degrees of freedom");
                return Err(Error::new("asf/size", message).at(row.place()));
            }
        }
        "limits" => {
            *limits = true;
            add_limits(bone, row, words)?;
        }
        "id" | "bodymass" | "cofmass" | "torque" | "angle" | "bodyrotation" => {}
        _ => warnings.add("asf/unknown", || {
            let message = format!("`{first:.40}` is not known, and left out");
            Diagnostic::warning("asf/unknown", message).at(row.place())
        }),
    }
    Ok(())
}

fn add_limits<'a>(
    bone: &mut Written,
    row: &Row<'_>,
    words: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    for word in words {
        let value = value(word).ok_or_else(|| {
            let message = format!("`{word:.40}` is no limit");
            Error::new("asf/grammar", message).at(row.place())
        })?;
        if bone.limits.len() < 2 * MOST_TOKENS {
            bone.limits.push(value);
        }
    }
    Ok(())
}

/// Three numbers, and the words after them.
fn numbers<'a, I: Iterator<Item = &'a str> + Clone>(
    row: &Row<'_>,
    mut words: I,
) -> Result<([f64; 3], I), Error> {
    let mut numbers = [0.0; 3];
    for number in &mut numbers {
        let word = words.next().unwrap_or("");
        *number = value(word).filter(|v| v.is_finite()).ok_or_else(|| {
            let message = format!("three numbers are needed, `{word:.40}` is none");
            Error::new("asf/number", message).at(row.place())
        })?;
    }
    Ok((numbers, words))
}

fn order(word: &str) -> Option<Order> {
    let axes: Vec<usize> = word
        .to_ascii_lowercase()
        .bytes()
        .filter_map(|letter| b"xyz".iter().position(|axis| *axis == letter))
        .collect();
    axes.try_into().ok().filter(|_| word.len() == 3)
}
