//! Tables as Markdown and CSV.

use std::fmt::Write;

/// What is in a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number with so many digits behind the point.
    Number(f64, usize),
    /// A mean and a standard deviation, with digits.
    Spread(f64, f64, usize),
    /// What was learned with its 95 % interval, and what is true, where data can tell it.
    Estimate {
        /// What was learned.
        value: f64,
        /// Its interval.
        interval: [f64; 2],
        /// The truth.
        truth: Option<f64>,
    },
    /// Nothing.
    Empty,
}

impl Cell {
    fn markdown(&self) -> String {
        match self {
            Self::Text(text) => text.replace('|', "\\|"),
            Self::Number(x, _) | Self::Spread(x, ..) if !x.is_finite() => "-".to_owned(),
            Self::Number(x, digits) => fixed(*x, *digits),
            Self::Spread(mean, sd, digits) => format!("{} ± {sd:.digits$}", fixed(*mean, *digits)),
            Self::Estimate { value, interval: [low, high], truth } => {
                let [value, low, high] = [value, low, high].map(|x| fixed(*x, 4));
                let truth = truth.map_or("-".to_owned(), |t| fixed(t, 4));
                format!("{value} [{low}, {high}] ({truth})")
            }
            Self::Empty => String::new(),
        }
    }

    /// One cell, or as many as the widest of its column has.
    fn csv(&self, width: usize) -> Vec<String> {
        let mut cells = match self {
            Self::Text(text) => vec![quoted(text)],
            Self::Number(x, _) => vec![number(*x)],
            Self::Spread(mean, sd, _) => vec![number(*mean), number(*sd)],
            Self::Estimate { value, interval, truth } => vec![
                number(*value),
                number(interval[0]),
                number(interval[1]),
                truth.map_or(String::new(), number),
            ],
            Self::Empty => vec![],
        };
        cells.resize(width, String::new());
        cells
    }

    fn parts(&self) -> &'static [&'static str] {
        match self {
            Self::Spread(..) => &[" mean", " sd"],
            Self::Estimate { .. } => &["", " low", " high", " truth"],
            _ => &[""],
        }
    }
}

/// A number with digits, without the sign of a zero.
fn fixed(x: f64, digits: usize) -> String {
    let text = format!("{x:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_owned(),
        _ => text,
    }
}

fn number(x: f64) -> String {
    if x.is_finite() { format!("{x}") } else { String::new() }
}

fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The name of its file, without ending.
    pub name: &'static str,
    /// What it is.
    pub title: String,
    /// The heads of its columns.
    pub head: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<Cell>>,
    /// What has to be said of it.
    pub notes: Vec<String>,
}

impl Sheet {
    /// An empty table.
    pub(super) fn new(name: &'static str, title: &str, head: &[&str]) -> Self {
        let head = head.iter().map(|h| (*h).to_owned()).collect();
        Self { name, title: title.to_owned(), head, rows: vec![], notes: vec![] }
    }

    /// As Markdown, with its title and notes.
    ///
    /// ```
    /// use condyle::learning::study::{Cell, Sheet};
    /// let rows = vec![vec![Cell::Text("gait".into()), Cell::Spread(44.0, 8.0, 0)]];
    /// let head = vec!["motion".to_owned(), "less, %".to_owned()];
    /// let sheet = Sheet { name: "t", title: "T".into(), head, rows, notes: vec![] };
    /// assert!(sheet.markdown().contains("| gait | 44 ± 8 |"));
    /// assert_eq!(sheet.csv(), "motion,\"less, % mean\",\"less, % sd\"\ngait,44,8\n");
    /// ```
    #[must_use]
    pub fn markdown(&self) -> String {
        let head: Vec<String> = self.head.iter().map(|h| h.replace('|', "\\|")).collect();
        let mut text = format!("## {}\n\n| {} |\n|", self.title, head.join(" | "));
        for _ in &self.head {
            text.push_str(" --- |");
        }
        text.push('\n');
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(Cell::markdown).collect();
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        for note in &self.notes {
            let _ = writeln!(text, "\n{note}");
        }
        text
    }

    /// As comma-separated values, all digits of each number; an interval has columns of its own.
    #[must_use]
    pub fn csv(&self) -> String {
        let parts: Vec<&[&str]> = (0..self.head.len())
            .map(|column| {
                let cells = self.rows.iter().filter_map(|row| row.get(column));
                cells.map(Cell::parts).max_by_key(|parts| parts.len()).unwrap_or(&[""])
            })
            .collect();
        let heads = self.head.iter().zip(&parts);
        let heads = heads.flat_map(|(head, parts)| parts.iter().map(move |p| format!("{head}{p}")));
        let mut lines = vec![heads.map(|head| quoted(&head)).collect::<Vec<_>>().join(",")];
        for row in &self.rows {
            let cells = row.iter().zip(&parts).flat_map(|(cell, parts)| cell.csv(parts.len()));
            lines.push(cells.collect::<Vec<_>>().join(","));
        }
        lines.push(String::new());
        lines.join("\n")
    }
}
