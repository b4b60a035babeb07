//! Expressions such as `"-0.5 * $height + $gap"`: which of their parts can be changed so that they have another value.

use crate::document::fields::Reader;
use crate::document::number::Constant;
use crate::document::template::dollars;
use crate::document::texts::Spot;
use crate::document::tree::{Node, Value};
use std::collections::HashMap;
use std::ops::Range;

/// How many constants may be defined by each other in a row.
const LONGEST: usize = 32;

/// A part of an expression whose value is `offset + slope * part`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Affine {
    pub(super) slope: f64,
    pub(super) offset: f64,
}

impl Affine {
    /// From the values at 0, 1 and 2; `None` of what is not straight, or does not change.
    fn through(values: [Option<f64>; 3]) -> Option<Self> {
        let [Some(offset), Some(one), Some(two)] = values else { return None };
        let slope = one - offset;
        let bend = two - one - slope;
        let straight = bend.abs() <= 1e-9 * (offset.abs() + one.abs() + two.abs());
        (straight && slope != 0.0 && slope.is_finite()).then_some(Self { slope, offset })
    }
}

/// A number in an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Literal {
    /// Its bytes in the expression, with a minus before it.
    pub(super) range: Range<usize>,
    /// Whether a minus may stand before it.
    pub(super) signed: bool,
    /// Whether it is a term by itself.
    alone: bool,
}

/// The numbers in an expression, and whether it names anything.
pub(super) fn literals(text: &str) -> Vec<Literal> {
    let mut found = vec![];
    let mut from = 0;
    loop {
        let rest = &text[from..];
        let next = [" + ", " - "].iter().filter_map(|op| rest.find(op)).min();
        let term = &rest[..next.unwrap_or(rest.len())];
        let count = term.split('*').count();
        let mut at = from;
        for (number, factor) in term.split('*').enumerate() {
            let lead = factor.len() - factor.trim_start().len();
            let bare = factor.trim();
            let digits = bare.strip_prefix('-').filter(|_| number == 0).unwrap_or(bare);
            if digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                let range = at + lead..at + lead + bare.len();
                found.push(Literal { range, signed: number == 0, alone: count == 1 });
            }
            at += factor.len() + 1;
        }
        match next {
            Some(next) => from += next + 3,
            None => return found,
        }
    }
}

/// The number of an expression that is changed to change its value: the term that is a number alone, or else the
/// only factor that is one.
pub(super) fn literal(
    reader: &mut Reader<'_>,
    text: &str,
    spot: Spot,
) -> Option<(Literal, Affine)> {
    let all = literals(text);
    let mut alone = all.iter().filter(|literal| literal.alone);
    let chosen = match (alone.next(), alone.next(), &all[..]) {
        (Some(one), None, _) => one,
        (None, None, [one]) => one,
        _ => return None,
    };
    let mut value = |literal: &str| {
        let changed =
            format!("{}{literal}{}", &text[..chosen.range.start], &text[chosen.range.end..]);
        reader.sum(&changed, spot)
    };
    let affine = Affine::through([value("0"), value("1"), value("2")])?;
    Some((chosen.clone(), affine))
}

/// What an expression follows: the constant or the parameter at the end of a chain of definitions that each name one.
pub(super) struct Followed {
    pub(super) name: String,
    /// Whether it is a parameter of a template, not a constant.
    pub(super) parameter: bool,
    /// The place of the number that defines it.
    pub(super) spot: Spot,
    pub(super) affine: Affine,
}

/// Where a link of the chain is stored in the reader.
enum Place {
    Constant(String),
    Parameter(u32, String),
}

/// What an expression follows, if that is one number.
pub(super) fn followed(
    reader: &mut Reader<'_>,
    defined: &HashMap<&str, &Node>,
    text: &str,
    spot: Spot,
) -> Option<Followed> {
    let mut chain: Vec<(String, Spot, Place)> = vec![];
    let (mut text, mut spot) = (text.to_owned(), spot);
    let end = loop {
        let mut names: Vec<&str> = dollars(&text).collect();
        names.dedup();
        let [name] = names[..] else { return None };
        if chain.len() > LONGEST {
            return None;
        }
        let given = reader.given.get(&spot.context).and_then(|given| given.get(name));
        let (node, place): (&Node, Place) = match given {
            Some(node) => (node, Place::Parameter(spot.context, name.to_owned())),
            None => (*defined.get(name)?, Place::Constant(name.to_owned())),
        };
        let (value, at) = (
            match &node.value {
                Value::Number(_) => None,
                Value::Text(text) => Some(text.clone()),
                _ => return None,
            },
            node.spot,
        );
        let name = name.to_owned();
        let parameter = matches!(place, Place::Parameter(..));
        chain.push((text, spot, place));
        match value {
            None => break (name, parameter, at),
            Some(next) => (text, spot) = (next, at),
        }
    };
    let mut value = |x: f64| {
        let mut value = Some(x);
        for (text, spot, place) in chain.iter().rev() {
            let before = set(reader, place, value?);
            value = reader.sum(text, *spot);
            restore(reader, place, before);
        }
        value
    };
    let affine = Affine::through([value(0.0), value(1.0), value(2.0)])?;
    let (name, parameter, spot) = end;
    Some(Followed { name, parameter, spot, affine })
}

/// What stood in a place before.
enum Before {
    Constant(Option<Constant>),
    Parameter(Option<Value>),
}

fn set(reader: &mut Reader<'_>, place: &Place, value: f64) -> Before {
    match place {
        Place::Constant(name) => {
            Before::Constant(reader.constants.insert(name.clone(), Constant::Is(value)))
        }
        Place::Parameter(context, name) => {
            let node = reader.given.get_mut(context).and_then(|given| given.get_mut(name));
            Before::Parameter(
                node.map(|node| std::mem::replace(&mut node.value, Value::Number(value))),
            )
        }
    }
}

fn restore(reader: &mut Reader<'_>, place: &Place, before: Before) {
    match (place, before) {
        (Place::Constant(name), Before::Constant(Some(constant))) => {
            reader.constants.insert(name.clone(), constant);
        }
        (Place::Parameter(context, name), Before::Parameter(Some(value))) => {
            let node = reader.given.get_mut(context).and_then(|given| given.get_mut(name));
            if let Some(node) = node {
                node.value = value;
            }
        }
        _ => {}
    }
}

/// All constants that an expression follows, over the definitions of others.
pub(super) fn constants(defined: &HashMap<&str, &Node>, text: &str) -> Vec<String> {
    let mut names: Vec<String> = dollars(text).map(str::to_owned).collect();
    let mut next = 0;
    while let Some(name) = names.get(next).cloned() {
        next += 1;
        if let Some(Node { value: Value::Text(text), .. }) = defined.get(name.as_str()) {
            for more in dollars(text) {
                if !names.iter().any(|known| known == more) {
                    names.push(more.to_owned());
                }
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::literals;

    #[test]
    fn numbers_are_found_with_their_sign_where_one_may_stand() {
        let of = |text: &'static str| {
            literals(text)
                .into_iter()
                .map(|l| (&text[l.range], l.signed, l.alone))
                .collect::<Vec<_>>()
        };
        assert_eq!(of("-0.5 * $height"), [("-0.5", true, false)]);
        assert_eq!(of("$a * 2 - $b"), [("2", false, false)]);
        assert_eq!(of("$thigh + 0.0108"), [("0.0108", true, true)]);
        assert_eq!(of("0.5 * $a - 1e-3"), [("0.5", true, false), ("1e-3", true, true)]);
        assert_eq!(of("-$thigh"), []);
    }
}
