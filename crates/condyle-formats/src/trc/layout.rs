//! Which columns of the rows hold what: in some files rows stand a cell beside their names.

use super::header::{Delimiter, Header};
use crate::text::{Line, cell, unquoted, with_comma};
use condyle_diagnostics::{Diagnostic, Warnings};

/// How many rows are looked at.
const ROWS: usize = 400;

/// The columns of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    /// The column of the time; the number of the frame is before it.
    pub(super) time: usize,
    /// The column of the first coordinate.
    pub(super) first: usize,
}

/// What is known of some rows.
struct Rows {
    /// The first cells of each row: blank, or with a number, or with something else.
    starts: Vec<Vec<Start>>,
    /// How many cells each has up to its last that is not blank.
    widths: Vec<usize>,
}

#[derive(Clone, Copy, PartialEq)]
enum Start {
    Blank,
    Number(f64),
    Other,
}

impl Rows {
    fn of<'a>(header: &Header, lines: impl Iterator<Item = Line<'a>>) -> Self {
        let mut rows = Self { starts: vec![], widths: vec![] };
        let most = header.first.iter().max().map_or(4, |first| first + 3);
        for line in lines.filter(|line| !line.is_blank()).take(ROWS) {
            let delimiter = header.delimiter.unwrap_or_else(|| Delimiter::of(line.text));
            let start = |text: &&str| match cell(text).or_else(|| with_comma(text)) {
                Some(value) if value.is_finite() => Start::Number(value),
                _ if text.is_empty() => Start::Blank,
                _ => Start::Other,
            };
            let first = most.min(12);
            if delimiter == Delimiter::Tab && !line.text.contains(['"', '\'']) {
                // The last cell with something in it is behind the last tab before it.
                let filled = line.text.trim_end();
                let width = filled.bytes().filter(|b| *b == b'\t').count() + 1;
                let cells = line.text.split('\t').map(unquoted).take(first);
                rows.starts.push(cells.map(|cell| start(&cell)).collect());
                rows.widths.push(if filled.trim().is_empty() { 0 } else { width });
                continue;
            }
            let cells = delimiter.cells(line.text);
            let width = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
            rows.starts.push(cells.iter().take(first).map(start).collect());
            rows.widths.push(width);
        }
        rows
    }

    /// The numbers of a column, if every row has one.
    fn numbers(&self, column: usize) -> Option<Vec<f64>> {
        let number = |row: &Vec<Start>| match row.get(column) {
            Some(Start::Number(value)) => Some(*value),
            _ => None,
        };
        self.starts.iter().map(number).collect()
    }

    fn all_blank(&self, columns: std::ops::Range<usize>) -> bool {
        self.starts.iter().all(|row| {
            row.get(columns.clone()).is_some_and(|cells| cells.iter().all(|c| *c == Start::Blank))
        })
    }

    /// Whether a column holds neither numbers nor blanks, as times of day.
    fn all_words(&self, column: usize) -> bool {
        self.starts.iter().all(|row| row.get(column) == Some(&Start::Other))
    }

    /// Whether four of five rows end with a whole marker, if coordinates begin in this column.
    fn whole_markers(&self, first: usize) -> bool {
        let longer = || self.widths.iter().filter(|width| **width > first);
        let whole = longer().filter(|width| (**width - first).is_multiple_of(3)).count();
        whole > 0 && 5 * whole >= 4 * longer().count()
    }

    /// Whether a column rises evenly with the times, as time stamps do.
    fn rises_with(&self, times: &[f64], column: usize) -> bool {
        let Some(values) = self.numbers(column) else { return false };
        let (Some(t0), Some(t1)) = (times.first(), times.last()) else { return false };
        let (Some(v0), Some(v1)) = (values.first(), values.last()) else { return false };
        let (span, rise) = (t1 - t0, v1 - v0);
        let on_line = |(t, v): (&f64, &f64)| ((v - v0) / rise - (t - t0) / span).abs() < 0.02;
        times.len() > 2 && span > 0.0 && rise > 0.0 && times.iter().zip(&values).all(on_line)
    }
}

impl Layout {
    /// Where the names say, unless the rows are a whole number of markers long only where they are taken
    /// to begin elsewhere; of several such places, that at which the times are those of the rate.
    pub(super) fn find<'a>(
        header: &Header,
        lines: impl Iterator<Item = Line<'a>>,
        warnings: &mut Warnings,
    ) -> Self {
        let rows = Rows::of(header, lines);
        let standard = Self { time: header.time, first: header.time + 1 };
        let named =
            Self { first: header.first.first().copied().unwrap_or(standard.first), ..standard };
        let mut found: Vec<(Self, bool)> = vec![];
        let mut add = |layout: Self, fits: &dyn Fn(&[f64]) -> bool| {
            let Some(times) = rows.numbers(layout.time) else { return };
            if times.is_sorted() && rows.whole_markers(layout.first) && fits(&times) {
                found.push((layout, has_rate(&times, header.rate) == Some(true)));
            }
        };
        for &first in &header.first {
            add(Self { first, ..standard }, &|_| true);
        }
        for shift in 1..=2 {
            let moved = Self { time: named.time + shift, first: named.first + shift };
            add(moved, &|_| rows.all_blank(0..shift));
        }
        let beside = Self { first: named.first + 1, ..named };
        add(beside, &|times| {
            rows.all_blank(named.first..beside.first)
                || rows.all_words(named.first)
                || rows.rises_with(times, named.first)
        });
        if let Some(time) = named.time.checked_sub(1) {
            let moved = Self { time, first: named.first - 1 };
            add(moved, &|times| has_rate(times, header.rate) == Some(true));
        }
        let best = found.iter().find(|(_, rated)| *rated).or(found.first());
        let layout = best.map_or(named, |(layout, _)| *layout);
        if layout != named && layout != standard {
            let message = format!(
                "the rows stand beside their names: times are in column {}, the first marker in column {}",
                layout.time + 1,
                layout.first + 1
            );
            let said = Diagnostic::warning("trc/shifted-rows", message).at(header.values);
            warnings.push(said.with_help("they are read like that"));
        }
        layout
    }
}

/// Whether times step by one over the rate; None where that is unknown.
fn has_rate(times: &[f64], rate: Option<f64>) -> Option<bool> {
    let step = median_step(times)?;
    let mean = (times.last()? - times.first()?) / (times.len() - 1) as f64;
    rate.map(|rate| [step, mean].iter().any(|step| (0.95..1.05).contains(&(step * rate))))
}

/// The median of the steps between times that differ.
pub(super) fn median_step(times: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.retain(|step| *step > 0.0);
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}
