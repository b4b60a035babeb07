//! The lines before the first row: rate, counts, unit and labels.

use crate::text::{Line, number};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};
use condyle_motion::LengthUnit;

/// How cells are separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Delimiter {
    Tab,
    Space,
}

impl Delimiter {
    /// Tabs where the line has any.
    pub(super) fn of(line: &str) -> Self {
        if line.contains('\t') { Self::Tab } else { Self::Space }
    }

    /// The cells of a line: with tabs, blank ones too.
    pub(super) fn cells(self, line: &str) -> Vec<&str> {
        match self {
            Self::Tab => line.split('\t').map(str::trim).collect(),
            Self::Space => line.split_whitespace().collect(),
        }
    }
}

/// The contents of the lines before the rows.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) labels: Vec<String>,
    pub(super) rate: Option<f64>,
    pub(super) frames: Option<f64>,
    /// None where it must be guessed.
    pub(super) unit: Option<LengthUnit>,
    /// The line of the header's values.
    pub(super) values: Place,
}

/// Reads up to and including the axis line; `lines` is left at the first row.
pub(super) fn read<'a>(
    lines: &mut std::iter::Peekable<impl Iterator<Item = Line<'a>>>,
    warnings: &mut Warnings,
) -> Result<Header, Error> {
    let keys_line = find_keys(lines, warnings)?;
    let keys = Delimiter::of(keys_line.text).cells(keys_line.text);
    let Some(values_line) = lines.find(|line| !line.is_blank()) else {
        return Err(Error::new("trc/truncated", "the header ends after its keys")
            .at(keys_line.place())
            .with_help("a line of values must follow: rate, frames, markers, unit"));
    };
    let values = Delimiter::of(values_line.text).cells(values_line.text);
    let value_of = |key: &str| {
        keys.iter()
            .position(|k| k.eq_ignore_ascii_case(key))
            .and_then(|index| values.get(index).copied())
            .filter(|value| !value.is_empty())
    };
    let number_of = |key: &str| value_of(key).and_then(number).filter(|v| v.is_finite());

    let rate = number_of("DataRate").filter(|rate| *rate > 0.0);
    if rate.is_none() {
        warnings.push(
            Diagnostic::warning("trc/rate", "the header has no DataRate")
                .at(values_line.place())
                .with_help("the rate is taken from the times"),
        );
    }
    let unit = unit_of(value_of("Units"), values_line, warnings);
    let labels = labels(lines, values_line, number_of("NumMarkers"), warnings)?;
    Ok(Header { labels, rate, frames: number_of("NumFrames"), unit, values: values_line.place() })
}

/// Finds the line of keys, which is the second of a valid file.
fn find_keys<'a>(
    lines: &mut impl Iterator<Item = Line<'a>>,
    warnings: &mut Warnings,
) -> Result<Line<'a>, Error> {
    let mut lines = lines.filter(|line| !line.is_blank());
    let Some(first) = lines.next() else {
        return Err(Error::new("trc/empty", "the file is empty")
            .at(Place::at_line(1))
            .with_help("a TRC file starts with `PathFileType`"));
    };
    if has_keys(first) {
        warnings.push(
            Diagnostic::warning("trc/path-file-type", "the line `PathFileType` is missing")
                .at(first.place()),
        );
        return Ok(first);
    }
    if !first.text.trim_start().to_ascii_lowercase().starts_with("pathfiletype") {
        return Err(Error::new("trc/not-trc", "the file does not start with `PathFileType`")
            .at(first.place())
            .with_help("this is not a TRC file"));
    }
    if let Some((_, rest)) = first.text.split_once('(')
        && let Some((axes, _)) = rest.split_once(')')
        && !axes.replace(' ', "").eq_ignore_ascii_case("X/Y/Z")
    {
        warnings.push(
            Diagnostic::warning("trc/axes", format!("the axes are named `({axes})`"))
                .at(first.place())
                .with_help("coordinates are taken in the order of the columns"),
        );
    }
    let keys = lines.next().ok_or_else(|| {
        Error::new("trc/truncated", "the file ends after its first line")
            .at(first.place())
            .with_help("a line of keys must follow: DataRate, NumFrames, Units, ...")
    })?;
    if has_keys(keys) {
        Ok(keys)
    } else {
        Err(Error::new("trc/keys", "the second line names none of the header's keys")
            .at(keys.place())
            .with_help("it should read `DataRate CameraRate NumFrames NumMarkers Units ...`"))
    }
}

fn has_keys(line: Line<'_>) -> bool {
    let known = ["datarate", "camerarate", "numframes", "nummarkers", "units"];
    line.text.split_whitespace().any(|word| known.iter().any(|key| word.eq_ignore_ascii_case(key)))
}

fn unit_of(name: Option<&str>, line: Line<'_>, warnings: &mut Warnings) -> Option<LengthUnit> {
    let unit = name.and_then(LengthUnit::from_name);
    if unit.is_none() {
        let message = match name {
            Some(name) if number(name).is_none() => format!("`{name}` is not a unit of length"),
            _ => "the header has no unit of length".to_owned(),
        };
        warnings.add("trc/unit", || {
            Diagnostic::warning("trc/unit", message)
                .at(line.place())
                .with_help("write mm, cm, m, in or ft; guessed from the size of the data")
        });
    }
    unit
}

/// Reads the label line and the axis line after it.
fn labels<'a>(
    lines: &mut std::iter::Peekable<impl Iterator<Item = Line<'a>>>,
    values: Line<'a>,
    declared: Option<f64>,
    warnings: &mut Warnings,
) -> Result<Vec<String>, Error> {
    let next = |lines: &mut std::iter::Peekable<_>| {
        lines.by_ref().find(|line: &Line<'_>| !line.is_blank())
    };
    let Some(label_line) = next(lines) else {
        return Err(Error::new("trc/truncated", "the file ends before the marker names")
            .at(values.place())
            .with_help("a line `Frame# Time name name ...` must follow the header's values"));
    };
    let delimiter = Delimiter::of(label_line.text);
    let cells = delimiter.cells(label_line.text);
    let starts = |index: usize, word: &str| {
        cells.get(index).is_some_and(|cell| cell.to_ascii_lowercase().starts_with(word))
    };
    if !starts(0, "frame") || !starts(1, "time") {
        return Err(Error::new("trc/labels", "the marker names do not start with `Frame# Time`")
            .at(label_line.place())
            .with_help("write `Frame#`, `Time` and then one name for each marker"));
    }
    let mut named: Vec<(usize, &str)> =
        cells.iter().copied().enumerate().skip(2).filter(|(_, cell)| !cell.is_empty()).collect();

    while lines.peek().is_some_and(Line::is_blank) {
        lines.next();
    }
    // The axis line has no number in it; where it is missing the rows follow immediately.
    let axes = lines.next_if(|line| {
        let mut filled = line.text.split_whitespace().peekable();
        filled.peek().is_some()
            && filled.all(|cell| cell.starts_with(|c: char| "XYZxyz".contains(c)))
    });
    if let Some(line) = axes {
        let axes = Delimiter::of(line.text).cells(line.text);
        let columns: Vec<usize> =
            axes.iter().enumerate().filter(|(_, a)| !a.is_empty()).map(|(i, _)| i).collect();
        if columns.len() / 3 > named.len() {
            named = unnamed(&named, &columns, delimiter, label_line, warnings)?;
        }
    }
    if named.is_empty() {
        return Err(Error::new("trc/labels", "there are no marker names")
            .at(label_line.place())
            .with_help("write one name for each marker after `Frame#` and `Time`"));
    }
    if let Some(declared) = declared
        && declared != named.len() as f64
    {
        warnings.push(
            Diagnostic::warning(
                "trc/marker-count",
                format!("NumMarkers is {declared}, but {} names are given", named.len()),
            )
            .at(label_line.place())
            .with_help("the names are used"),
        );
    }
    Ok(distinct(&named, label_line, warnings))
}

/// Gives a name to the triples of axes that have none, where tab positions show which they are.
fn unnamed<'a>(
    named: &[(usize, &'a str)],
    columns: &[usize],
    delimiter: Delimiter,
    line: Line<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<(usize, &'a str)>, Error> {
    let heads: Vec<usize> = columns.iter().copied().step_by(3).take(columns.len() / 3).collect();
    let aligned = named.iter().all(|(column, _)| heads.contains(column));
    if delimiter == Delimiter::Space || !aligned {
        return Err(Error::new(
            "trc/labels",
            format!("there are axes for {} markers, but {} names", heads.len(), named.len()),
        )
        .at(line.place())
        .with_help("name every marker"));
    }
    let mut names = named.iter().peekable();
    Ok(heads
        .into_iter()
        .map(|head| match names.next_if(|(column, _)| *column == head) {
            Some(name) => *name,
            None => {
                warnings.add("trc/unnamed", || {
                    Diagnostic::warning("trc/unnamed", format!("column {} has no name", head + 1))
                        .at(line.place())
                        .with_help("the marker is called `unnamed`")
                });
                (head, "unnamed")
            }
        })
        .collect())
}

/// The names, the second of two equal ones with `#2` after it.
fn distinct(named: &[(usize, &str)], line: Line<'_>, warnings: &mut Warnings) -> Vec<String> {
    let mut taken: std::collections::HashSet<String> =
        named.iter().map(|(_, name)| (*name).to_owned()).collect();
    let mut uses: std::collections::HashMap<&str, usize> = std::collections::HashMap::new();
    let mut labels = Vec::with_capacity(named.len());
    for (_, name) in named {
        let count = uses.entry(name).or_insert(0);
        *count += 1;
        if *count == 1 {
            labels.push((*name).to_owned());
            continue;
        }
        let mut other = format!("{name}#{count}");
        while !taken.insert(other.clone()) {
            *count += 1;
            other = format!("{name}#{count}");
        }
        warnings.add("trc/duplicate-name", || {
            Diagnostic::warning("trc/duplicate-name", format!("two markers are called `{name}`"))
                .at(line.place())
                .with_help(format!("the later one is read as `{other}`"))
        });
        labels.push(other);
    }
    labels
}
