//! Where a number comes from, and how it can be changed.

use super::change::number;
use super::expression::{Affine, Followed};
use super::leaf::{Expression, Found, Keyed, Leaf, Piece};
use super::{Editable, Source, Step, shown};
use crate::document::Document;
use crate::document::texts::{Context, Spot};
use crate::document::tree::ends;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Where a number of a document comes from.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Origin {
    /// It is a number of the document itself.
    Plain,
    /// It is an expression that names this constant, or several, of which this is the first.
    Constant {
        /// Its name, without the `$`.
        name: String,
    },
    /// It stands in an included text that may be changed.
    Include,
    /// A template gives it.
    Template {
        /// The template's name.
        template: String,
        /// The instance, where it stands in the template itself and not in the row of the instance.
        instance: Option<String>,
    },
    /// It stands in a text that is shipped with the program.
    Shipped,
}

impl Origin {
    /// Its name: `plain`, `constant`, `include`, `template` or `shipped`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Constant { .. } => "constant",
            Self::Include => "include",
            Self::Template { .. } => "template",
            Self::Shipped => "shipped",
        }
    }
}

/// What is changed for a number to have another value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WayKind {
    /// The number itself, in the document.
    Here,
    /// The number itself, in the text that is included.
    File,
    /// The value in the row of a template's instance, or its default.
    Row,
    /// The template, for all instances.
    Template,
    /// The number in the expression.
    Factor,
    /// The constant that the expression names, for all that follows it.
    Constant,
    /// The expression, which becomes a number.
    Number,
    /// A line is added to the document, which stands in place of what an included text or a template gives.
    Override,
}

impl WayKind {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Here,
        Self::File,
        Self::Row,
        Self::Template,
        Self::Factor,
        Self::Constant,
        Self::Number,
        Self::Override,
    ];

    /// Its name in programs, such as `override`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Here => "here",
            Self::File => "file",
            Self::Row => "row",
            Self::Template => "template",
            Self::Factor => "factor",
            Self::Constant => "constant",
            Self::Number => "number",
            Self::Override => "override",
        }
    }

    /// The way of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// A way to change a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// What is changed.
    pub kind: WayKind,
    /// What will be written where, as a sentence.
    pub sentence: String,
    pub(super) target: Target,
}

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Target {
    /// A number in place of another, or of an expression.
    Replace {
        source: usize,
        range: Range<usize>,
        /// Of the value with the number that is written.
        affine: Affine,
        signed: bool,
    },
    /// A key of the document itself.
    Override {
        path: Vec<String>,
        /// The text of its value, of which one piece is the number.
        pieces: Arc<Vec<String>>,
        piece: usize,
        affine: Affine,
        enforced: Option<bool>,
    },
}

const PLAIN: Affine = Affine { slope: 1.0, offset: 0.0 };

/// The numbers of a document with the ways to change them.
pub(super) fn editables(
    title: &str,
    sources: &[Source],
    found: Found,
    document: &Document,
) -> Vec<Editable> {
    let sources_of = found
        .files
        .iter()
        .map(|name| sources.iter().position(|source| source.name == *name).unwrap_or_default());
    let mut at_spot: HashMap<Spot, usize> = HashMap::new();
    for leaf in &found.leaves {
        *at_spot.entry(plain_spot(leaf.spot)).or_default() += 1;
    }
    let mut maker = Maker {
        title,
        sources,
        sources_of: sources_of.collect(),
        ends: sources.iter().map(|source| ends(&source.text)).collect(),
        lines: sources.iter().map(|source| line_starts(&source.text)).collect(),
        at_spot,
        pieces: HashMap::new(),
        document,
        found: &found,
    };
    found.leaves.iter().filter_map(|leaf| maker.editable(leaf)).collect()
}

fn line_starts(text: &str) -> Vec<usize> {
    let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1);
    std::iter::once(0).chain(breaks).collect()
}

fn plain_spot(spot: Spot) -> Spot {
    Spot::new(spot.file, spot.start)
}

struct Maker<'a> {
    title: &'a str,
    sources: &'a [Source],
    /// The source of each text by the number that its spots have.
    sources_of: Vec<usize>,
    /// Where each value ends, by where it begins, in each source.
    ends: Vec<HashMap<usize, usize>>,
    /// Where each line of each source begins.
    lines: Vec<Vec<usize>>,
    /// How many numbers come from each place.
    at_spot: HashMap<Spot, usize>,
    /// The pieces of keys that were rendered.
    pieces: HashMap<usize, Arc<Vec<String>>>,
    document: &'a Document,
    found: &'a Found,
}

impl Maker<'_> {
    fn source(&self, spot: Spot) -> Option<(usize, &Source)> {
        let number = *self.sources_of.get(spot.file as usize)?;
        Some((number, self.sources.get(number)?))
    }

    fn range(&self, spot: Spot) -> Option<Range<usize>> {
        let (number, _) = self.source(spot)?;
        Some(spot.start..*self.ends.get(number)?.get(&spot.start)?)
    }

    /// What stands at a spot.
    fn written(&self, spot: Spot) -> Option<&str> {
        self.source(spot)?.1.text.get(self.range(spot)?)
    }

    /// Line and column of a spot, counted from 1.
    fn line_and_column(&self, spot: Spot) -> (usize, usize) {
        let Some((number, source)) = self.source(spot) else { return (0, 0) };
        let starts = self.lines.get(number).map_or(&[][..], Vec::as_slice);
        let line = starts.partition_point(|&start| start <= spot.start);
        let from = starts.get(line.saturating_sub(1)).copied().unwrap_or(0);
        let before = source.text.get(from..spot.start).unwrap_or_default();
        (line, before.chars().count() + 1)
    }

    /// `file:line` of a spot.
    fn place(&self, spot: Spot) -> String {
        let Some((_, source)) = self.source(spot) else { return self.title.to_owned() };
        let name = if source.name.is_empty() { self.title } else { &source.name };
        format!("{name}:{}", self.line_and_column(spot).0)
    }

    fn owned(&self, spot: Spot) -> bool {
        self.source(spot).is_some_and(|(_, source)| source.owned)
    }

    fn editable(&mut self, leaf: &Leaf) -> Option<Editable> {
        let (_, source) = self.source(leaf.spot)?;
        let (line, column) = self.line_and_column(leaf.spot);
        let file = source.name.clone();
        let written = self.written(leaf.spot)?.to_owned();
        let origin = match (&leaf.context, &leaf.expression) {
            _ if !self.owned(leaf.spot) => Origin::Shipped,
            (Some(Context::Instance { template, name, .. }), _) => {
                Origin::Template { template: template.clone(), instance: Some(name.clone()) }
            }
            (Some(Context::Parameter { template, .. }), _) => {
                Origin::Template { template: template.clone(), instance: None }
            }
            (None, Some(expression)) => Origin::Constant { name: first_name(&expression.text) },
            (None, None) if leaf.spot.file > 0 => Origin::Include,
            (None, None) => Origin::Plain,
        };
        let (unit, _) = leaf.unit.name(leaf.degrees, &self.document.model);
        Some(Editable {
            path: leaf.path.clone(),
            value: leaf.value,
            unit,
            file,
            line,
            column,
            written,
            origin,
            mirrored: self.mirrored(&leaf.path),
            ways: self.ways(leaf),
        })
    }

    /// The path of the mirrored side, if that is not written.
    fn mirrored(&self, path: &[Step]) -> Option<Vec<Step>> {
        let (from, to) = self.found.mirror.as_ref()?;
        let other = |name: &str| name.strip_suffix(from).map(|stem| format!("{stem}{to}"));
        let [Step::Key(family), Step::Key(name), ..] = path else { return None };
        if family == "constants" {
            return None;
        }
        let twin = other(name)?;
        // A joint and a joint set have one namespace.
        let families: &[&str] = match family.as_str() {
            "joint" | "joint_set" => &["joint", "joint_set"],
            family => &[family],
        };
        let written =
            |family: &&str| self.found.names.contains(&((*family).to_owned(), twin.clone()));
        if families.iter().any(written) {
            return None;
        }
        let renamed = path.iter().enumerate().map(|(at, step)| match step {
            Step::Key(key) if at > 0 => Step::Key(other(key).unwrap_or_else(|| key.clone())),
            step => step.clone(),
        });
        Some(renamed.collect())
    }

    fn ways(&mut self, leaf: &Leaf) -> Vec<Way> {
        let mut ways = vec![];
        match &leaf.expression {
            None => ways.extend(self.replaced(leaf)),
            Some(expression) => self.of_expression(leaf, expression, &mut ways),
        }
        if leaf.spot.file > 0 || leaf.context.is_some() {
            ways.extend(self.overridden(leaf));
        }
        // A number that is a share of a constant is rarely meant to change all else that follows the constant.
        let alone = |followed: &Followed| {
            followed.affine.slope.abs() == 1.0 && followed.affine.offset == 0.0
        };
        let shares = |expression: &Expression| !expression.followed.as_ref().is_some_and(alone);
        if leaf.expression.as_ref().is_some_and(shares) {
            ways.sort_by_key(|way| way.kind == WayKind::Constant);
        }
        ways
    }

    /// The number itself is changed where it stands.
    fn replaced(&self, leaf: &Leaf) -> Option<Way> {
        if !self.owned(leaf.spot) {
            return None;
        }
        let place = self.place(leaf.spot);
        let (kind, sentence) = match &leaf.context {
            Some(Context::Parameter { template, .. }) => {
                let others = self.others(leaf.spot);
                let what =
                    format!("writes the value in the row of template `{template}` ({place})");
                (WayKind::Row, format!("{what}{others}"))
            }
            Some(Context::Instance { template, of, .. }) => {
                let all = if *of > 1 { format!(", in all {of} instances") } else { String::new() };
                (WayKind::Template, format!("changes template `{template}` itself ({place}){all}"))
            }
            None if leaf.spot.file > 0 => {
                (WayKind::File, format!("writes into {place}, which this document includes"))
            }
            None => (WayKind::Here, format!("writes the number at {place}")),
        };
        let target = self.replace(leaf.spot, self.range(leaf.spot)?, PLAIN, true)?;
        Some(Way { kind, sentence, target })
    }

    fn replace(
        &self,
        spot: Spot,
        range: Range<usize>,
        affine: Affine,
        signed: bool,
    ) -> Option<Target> {
        let (source, _) = self.source(spot)?;
        Some(Target::Replace { source, range, affine, signed })
    }

    fn others(&self, spot: Spot) -> String {
        match self.at_spot.get(&plain_spot(spot)).map_or(0, |count| count.saturating_sub(1)) {
            0 => String::new(),
            1 => ", which one other number is, too".to_owned(),
            count => format!(", which {count} other numbers are, too"),
        }
    }

    fn of_expression(&mut self, leaf: &Leaf, expression: &Expression, ways: &mut Vec<Way>) {
        let (Some(range), Some(written)) = (self.range(leaf.spot), self.written(leaf.spot)) else {
            return;
        };
        let written = written.to_owned();
        let place = self.place(leaf.spot);
        let in_instance = matches!(leaf.context, Some(Context::Instance { .. }));
        let all = match &leaf.context {
            Some(Context::Instance { template, of, .. }) if *of > 1 => {
                format!(" of template `{template}`, in all {of} instances")
            }
            _ => String::new(),
        };
        if self.owned(leaf.spot)
            && let Some((literal, affine)) = &expression.literal
            // Without escapes the text of the string is that of the file.
            && written.get(1..written.len().saturating_sub(1)) == Some(&expression.text)
        {
            let from = range.start + 1;
            let inside = from + literal.range.start..from + literal.range.end;
            let old = &expression.text[literal.range.clone()];
            let sentence = format!("writes the number {old} of {written} at {place}{all}");
            let target = self.replace(leaf.spot, inside, affine.clone(), literal.signed);
            ways.extend(target.map(|target| Way { kind: WayKind::Factor, sentence, target }));
        }
        if let Some(followed) = &expression.followed {
            let defined = self.place(followed.spot);
            let name = &followed.name;
            let affine = followed.affine.clone();
            let others = match self.found.followers.get(name).map_or(0, |n| n.saturating_sub(1)) {
                0 => String::new(),
                1 => ", which one other number follows, too".to_owned(),
                count => format!(", which {count} other numbers follow, too"),
            };
            if followed.parameter && self.owned(followed.spot) {
                let others = self.others(followed.spot);
                let sentence = format!("writes `{name}` in its row ({defined}){others}");
                let target = self
                    .range(followed.spot)
                    .and_then(|range| self.replace(followed.spot, range, affine, true));
                ways.extend(target.map(|target| Way { kind: WayKind::Row, sentence, target }));
            } else if !followed.parameter && self.owned(followed.spot) {
                let sentence = format!("writes constant `{name}` ({defined}){others}");
                let target = self
                    .range(followed.spot)
                    .and_then(|range| self.replace(followed.spot, range, affine, true));
                ways.extend(target.map(|target| Way { kind: WayKind::Constant, sentence, target }));
            } else if !followed.parameter {
                let sentence = format!(
                    "writes constant `{name}` into {}, in place of that of {defined}{others}",
                    self.title
                );
                let target = Target::Override {
                    path: vec!["constants".to_owned(), name.clone()],
                    pieces: Arc::new(vec![String::new()]),
                    piece: 0,
                    affine,
                    enforced: None,
                };
                ways.push(Way { kind: WayKind::Constant, sentence, target });
            }
        }
        if self.owned(leaf.spot) && !in_instance {
            let sentence = format!(
                "writes a number in place of {written} at {place}, which then no longer follows {}",
                first_name(&expression.text)
            );
            let target = self.replace(leaf.spot, range, PLAIN, true);
            ways.extend(target.map(|target| Way { kind: WayKind::Number, sentence, target }));
        }
    }

    /// A key of the document itself stands in place of an included one, or of a template's.
    fn overridden(&mut self, leaf: &Leaf) -> Option<Way> {
        let keyed = self.found.keyed.get(leaf.key)?;
        let pieces = self.pieces_of(leaf.key, keyed);
        let own = |piece: &Piece| {
            matches!(piece, Piece::Leaf(number)
                if self.found.leaves.get(*number).is_some_and(|other| other.path == leaf.path))
        };
        let piece = keyed.pieces.iter().position(own)?;
        let copied = keyed.pieces.iter().filter(|p| matches!(p, Piece::Leaf(_))).count() - 1;
        let name: Vec<Step> = keyed.path.iter().cloned().map(Step::Key).collect();
        let stands = match &leaf.context {
            Some(Context::Instance { template, .. } | Context::Parameter { template, .. }) => {
                format!("what template `{template}` gives")
            }
            None => format!("that of {}", self.place(leaf.spot)),
        };
        let copied = match copied {
            0 => String::new(),
            1 => "; its other number is copied".to_owned(),
            count => format!("; its other {count} numbers are copied"),
        };
        let (title, name) = (self.title, shown(&name));
        let sentence = format!("writes `{name}` into {title}, in place of {stands}{copied}");
        let slope = 1.0 / self.conversion(leaf);
        let target = Target::Override {
            path: keyed.path.clone(),
            pieces,
            piece,
            affine: Affine { slope, offset: 0.0 },
            enforced: keyed.enforced,
        };
        Some(Way { kind: WayKind::Override, sentence, target })
    }

    /// The factor from the unit of a leaf's text to that of the document itself.
    fn conversion(&self, leaf: &Leaf) -> f64 {
        let degree = std::f64::consts::PI / 180.0;
        match leaf.unit.name(leaf.degrees, &self.document.model).1 {
            true if leaf.degrees && !self.found.degrees => degree,
            true if !leaf.degrees && self.found.degrees => 1.0 / degree,
            _ => 1.0,
        }
    }

    fn pieces_of(&mut self, key: usize, keyed: &Keyed) -> Arc<Vec<String>> {
        if let Some(known) = self.pieces.get(&key) {
            return known.clone();
        }
        let text = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Leaf(number) => {
                self.found.leaves.get(*number).map_or(String::new(), |leaf| self.copy(leaf))
            }
        };
        let pieces = Arc::new(keyed.pieces.iter().map(text).collect::<Vec<_>>());
        self.pieces.insert(key, pieces.clone());
        pieces
    }

    /// A number as it is copied into the document itself.
    fn copy(&self, leaf: &Leaf) -> String {
        let factor = self.conversion(leaf);
        // What an instance gives is not known outside it.
        let inside = leaf.context.is_some() && leaf.expression.is_some();
        match self.written(leaf.spot) {
            Some(written) if factor == 1.0 && !inside => written.to_owned(),
            _ => number(leaf.value * factor),
        }
    }
}

fn first_name(text: &str) -> String {
    crate::document::template::dollars(text).next().unwrap_or_default().to_owned()
}
