//! The tree of joints.

use crate::text::{Line, number, with_comma};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};

/// More joints are refused: a figure with clothes and hair has a few hundred.
const MOST_JOINTS: usize = 5000;
/// More channels of one joint are refused.
const MOST_CHANNELS: usize = 16;

/// What a column of the rows holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    /// A place along an axis, counted from 0.
    Position(usize),
    /// An angle about an axis.
    Rotation(usize),
    /// Something that moves no joint.
    Other,
}

impl Channel {
    fn named(word: &str) -> Option<Self> {
        let lower = word.to_ascii_lowercase();
        let axis = match lower.as_bytes().first() {
            Some(b'x') => 0,
            Some(b'y') => 1,
            Some(b'z') => 2,
            _ => return None,
        };
        match lower.get(1..)? {
            "position" | "translation" | "pos" => Some(Self::Position(axis)),
            "rotation" | "rot" => Some(Self::Rotation(axis)),
            "scale" => Some(Self::Other),
            _ => None,
        }
    }
}

/// One joint, as it is written.
#[derive(Clone, Debug, Default)]
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) offset: [f64; 3],
    pub(super) channels: Vec<Channel>,
    pub(super) ends: Vec<[f64; 3]>,
}

/// A word of the hierarchy.
#[derive(Clone, Copy, Debug)]
struct Word<'a> {
    text: &'a str,
    place: Place,
}

impl Word<'_> {
    fn is(&self, word: &str) -> bool {
        self.text.trim_end_matches(':').eq_ignore_ascii_case(word)
    }
}

/// The words of a text, line by line.
pub(super) struct Words<'a, L: Iterator<Item = Line<'a>>> {
    lines: L,
    line: Option<Line<'a>>,
    /// Where in the line the rest begins.
    at: usize,
}

fn separates(c: char) -> bool {
    c.is_whitespace() || matches!(c, ',' | ';' | '\0')
}

impl<'a, L: Iterator<Item = Line<'a>>> Words<'a, L> {
    pub(super) fn new(lines: L) -> Self {
        Self { lines, line: None, at: 0 }
    }

    /// The rest of the line, and the line.
    fn rest(&self) -> Option<(&'a str, Line<'a>)> {
        let line = self.line?;
        Some((line.text.get(self.at..)?, line))
    }

    /// The next word of this line, without going on.
    fn peek_in_line(&self) -> Option<(Word<'a>, usize)> {
        let (rest, line) = self.rest()?;
        let text = rest.trim_start_matches(separates);
        let first = text.chars().next()?;
        let length = match first {
            '{' | '}' => 1,
            _ => text.find(|c| separates(c) || matches!(c, '{' | '}')).unwrap_or(text.len()),
        };
        let text = text.get(..length)?;
        let start = line.text.len() - rest.trim_start_matches(separates).len();
        Some((Word { text, place: line.place_of(text) }, start + length))
    }

    /// The next word, without going on; blank lines are left behind.
    fn peek(&mut self) -> Option<(Word<'a>, usize)> {
        loop {
            if let Some(found) = self.peek_in_line() {
                return Some(found);
            }
            self.line = Some(self.lines.next()?);
            self.at = 0;
        }
    }

    fn next(&mut self) -> Option<Word<'a>> {
        let (word, after) = self.peek()?;
        self.at = after;
        Some(word)
    }

    /// The rest of the line up to a brace: a name, which may hold spaces.
    fn name(&mut self) -> &'a str {
        let Some((rest, _)) = self.rest() else { return "" };
        let length = rest.find(['{', '}']).unwrap_or(rest.len());
        self.at += length;
        rest.get(..length).unwrap_or("").trim()
    }

    /// The rest of this line, and the lines that follow it.
    pub(super) fn into_lines(self) -> (Option<Line<'a>>, L) {
        let rest =
            self.rest().map(|(text, line)| Line { text, start: line.start + self.at, ..line });
        (rest, self.lines)
    }

    /// Up to three numbers, and how many there were.
    fn numbers(&mut self) -> ([f64; 3], usize) {
        let mut numbers = [0.0; 3];
        for (index, place) in numbers.iter_mut().enumerate() {
            let found = self.peek().and_then(|(word, after)| {
                let value = number(word.text).or_else(|| with_comma(word.text))?;
                Some((value, after))
            });
            let Some((value, after)) = found else { return (numbers, index) };
            self.at = after;
            *place = if value.is_finite() { value } else { 0.0 };
        }
        (numbers, 3)
    }
}

/// What is open while reading: a joint, or the End Site of one.
#[derive(Clone, Copy, Debug)]
enum Open {
    Joint(usize),
    End,
}

/// Reads joints up to the word `MOTION`, which is taken away, or to the end of the text; whether it was
/// there.
pub(super) fn read<'a, L: Iterator<Item = Line<'a>>>(
    words: &mut Words<'a, L>,
    warnings: &mut Warnings,
) -> Result<(Vec<Joint>, bool), Error> {
    let mut joints: Vec<Joint> = vec![];
    let mut open: Vec<Open> = vec![];
    let mut motion = false;
    while let Some(word) = words.next() {
        let own = open.iter().rev().find_map(|open| match open {
            Open::Joint(index) => Some(*index),
            Open::End => None,
        });
        let in_end = matches!(open.last(), Some(Open::End));
        if word.is("motion") {
            motion = true;
            break;
        } else if word.is("root") || word.is("joint") {
            if joints.len() >= MOST_JOINTS {
                let message = format!("there are more than {MOST_JOINTS} joints");
                return Err(Error::new("bvh/size", message).at(word.place));
            }
            let mut name = words.name().to_owned();
            if name.is_empty() {
                name = format!("joint{}", joints.len() + 1);
                warnings.add("bvh/nameless", || {
                    let message = format!("a joint has no name, and is called `{name}`");
                    Diagnostic::warning("bvh/nameless", message).at(word.place)
                });
            }
            // A root is one even where the joint before it is not closed.
            if word.is("root") && !open.is_empty() {
                unclosed(warnings, word.place, open.len());
                open.clear();
            }
            let parent = if word.is("root") { None } else { own };
            joints.push(Joint { name, parent, ..Joint::default() });
            brace(words, warnings, word.place);
            open.push(Open::Joint(joints.len() - 1));
        } else if word.is("end") {
            words.name();
            brace(words, warnings, word.place);
            open.push(Open::End);
        } else if word.is("offset") {
            let (offset, found) = words.numbers();
            if found < 3 {
                warnings.add("bvh/offset", || {
                    let message = format!("an OFFSET has {found} numbers: the rest are 0");
                    Diagnostic::warning("bvh/offset", message).at(word.place)
                });
            }
            match own.and_then(|index| joints.get_mut(index)) {
                Some(joint) if in_end => joint.ends.push(offset),
                Some(joint) => joint.offset = offset,
                None => {
                    let message = "an OFFSET stands outside of a joint";
                    return Err(Error::new("bvh/grammar", message).at(word.place));
                }
            }
        } else if word.is("channels") {
            let listed = channels(words, warnings, word.place)?;
            match own.and_then(|index| joints.get_mut(index)) {
                Some(joint) if !in_end => joint.channels.extend(listed),
                _ => {
                    let message = "CHANNELS stand outside of a joint";
                    return Err(Error::new("bvh/grammar", message).at(word.place));
                }
            }
            if own.and_then(|i| joints.get(i)).is_some_and(|j| j.channels.len() > MOST_CHANNELS) {
                let message = format!("a joint has more than {MOST_CHANNELS} channels");
                return Err(Error::new("bvh/size", message).at(word.place));
            }
        } else if word.text == "}" {
            if open.pop().is_none() {
                warnings.add("bvh/brace", || {
                    Diagnostic::warning("bvh/brace", "a `}` closes nothing").at(word.place)
                });
            }
        } else if word.text == "{" {
            warnings.add("bvh/brace", || {
                Diagnostic::warning("bvh/brace", "a `{` opens nothing").at(word.place)
            });
        } else if !word.is("hierarchy") {
            let message = format!("`{:.40}` is not known in a hierarchy", word.text);
            let help = "known are ROOT, JOINT, End Site, OFFSET, CHANNELS, braces, and MOTION";
            return Err(Error::new("bvh/grammar", message).at(word.place).with_help(help));
        }
    }
    if !open.is_empty() {
        let place = words.line.map_or(Place::at_line(1), |line| line.place());
        unclosed(warnings, place, open.len());
    }
    if joints.is_empty() {
        let message = "there is no ROOT and no JOINT";
        let help = "a BVH file begins with HIERARCHY and ROOT";
        return Err(Error::new("bvh/no-joint", message).at(Place::at_line(1)).with_help(help));
    }
    Ok((joints, motion))
}

fn unclosed(warnings: &mut Warnings, place: Place, count: usize) {
    warnings.add("bvh/brace", || {
        let message = format!("{count} braces are not closed before this place");
        Diagnostic::warning("bvh/brace", message).at(place)
    });
}

/// The brace that opens an item.
fn brace<'a, L: Iterator<Item = Line<'a>>>(
    words: &mut Words<'a, L>,
    warnings: &mut Warnings,
    place: Place,
) {
    match words.peek() {
        Some((word, after)) if word.text == "{" => words.at = after,
        _ => warnings.add("bvh/brace", || {
            Diagnostic::warning("bvh/brace", "a `{` is missing behind this word").at(place)
        }),
    }
}

/// The channels after the word CHANNELS.
fn channels<'a, L: Iterator<Item = Line<'a>>>(
    words: &mut Words<'a, L>,
    warnings: &mut Warnings,
    place: Place,
) -> Result<Vec<Channel>, Error> {
    let stated = words.peek().and_then(|(word, after)| Some((number(word.text)?, after)));
    if let Some((_, after)) = stated {
        words.at = after;
    }
    let mut listed = vec![];
    loop {
        // Words of other lines belong to it only where they are channels.
        let in_line = words.peek_in_line().is_some();
        let Some((word, after)) = words.peek() else { break };
        let known = Channel::named(word.text);
        let other = in_line && !matches!(word.text, "{" | "}") && !is_item(&word);
        if known.is_none() && !other {
            break;
        }
        if known.is_none_or(|channel| channel == Channel::Other) {
            warnings.add("bvh/channel", || {
                let message = format!("the channel `{:.40}` moves nothing", word.text);
                let help = "its numbers are left out";
                Diagnostic::warning("bvh/channel", message).at(word.place).with_help(help)
            });
        }
        listed.push(known.unwrap_or(Channel::Other));
        words.at = after;
        if listed.len() > MOST_CHANNELS {
            let message = format!("a joint has more than {MOST_CHANNELS} channels");
            return Err(Error::new("bvh/size", message).at(place));
        }
    }
    if stated.is_none_or(|(count, _)| count != listed.len() as f64) {
        let count =
            stated.map_or("no number of channels".to_owned(), |(n, _)| format!("{n} channels"));
        warnings.add("bvh/channel-count", || {
            let message = format!("{count} stated, {} named: the names rule", listed.len());
            Diagnostic::warning("bvh/channel-count", message).at(place)
        });
    }
    Ok(listed)
}

/// Whether a word begins another item.
fn is_item(word: &Word<'_>) -> bool {
    ["root", "joint", "end", "offset", "channels", "motion"].iter().any(|item| word.is(item))
}
