//! What a writer of models answers with.

use super::{Tree, Value};
use condyle_diagnostics::{Diagnostic, Read};
use condyle_math::Affine;

/// A model in the text of another program.
#[derive(Clone, Debug)]
pub struct Written {
    /// The text.
    pub text: String,
    /// The tree that it says.
    pub tree: Tree,
    /// Its joints of one number by their names, each with its value in the tree.
    pub joints: Vec<(String, Value)>,
    /// Its joints of an orientation by their names, each with its position among those of the tree.
    pub balls: Vec<(String, usize)>,
    /// The names of its bodies, in the order of the tree's links.
    pub bodies: Vec<String>,
    /// The model's world in that of the file, which has another axis up.
    pub base: Affine,
    /// What was fitted, dropped or turned into something else.
    pub remarks: Vec<Diagnostic>,
}

impl Written {
    /// The text with the remarks as warnings.
    pub fn into_read(self) -> Read<String> {
        Read { value: self.text, warnings: self.remarks }
    }
}

/// Names that are unique and hold no character that other programs take as their own.
#[derive(Clone, Debug, Default)]
pub struct Names {
    taken: std::collections::HashSet<String>,
}

impl Names {
    /// The name, changed where it has to be.
    pub fn take(&mut self, wanted: &str) -> String {
        let plain =
            |c: char| if c.is_alphanumeric() || matches!(c, '_' | '-' | '.') { c } else { '_' };
        let mut base: String = wanted.chars().map(plain).collect();
        if base.is_empty() {
            base.push('_');
        }
        let mut name = base.clone();
        let mut number = 2usize;
        while !self.taken.insert(name.clone()) {
            name = format!("{base}_{number}");
            number += 1;
        }
        name
    }
}

/// Text that may stand in an attribute.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
