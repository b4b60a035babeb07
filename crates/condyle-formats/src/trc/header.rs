//! The lines before the first row: rate, counts, unit and labels.

use crate::text::{self, Line, cell, unquoted, with_comma};
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};
use condyle_motion::LengthUnit;

/// How cells are separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Delimiter {
    Tab,
    Comma,
    Semicolon,
    Space,
}

impl Delimiter {
    /// Tabs where the line has any.
    pub(super) fn of(line: &str) -> Self {
        if line.contains('\t') { Self::Tab } else { Self::Space }
    }

    /// What separates the cells of a line of words: commas and semicolons too.
    fn of_words(line: &str) -> Self {
        match Self::of(line) {
            Self::Space if line.contains(';') => Self::Semicolon,
            Self::Space if line.contains(',') => Self::Comma,
            other => other,
        }
    }

    /// The cells of a line, without quotes around them: blank ones too, but where spaces separate.
    pub(super) fn cells(self, line: &str) -> Vec<&str> {
        match self {
            Self::Tab => line.split('\t').map(unquoted).collect(),
            Self::Comma => line.split(',').map(unquoted).collect(),
            Self::Semicolon => line.split(';').map(unquoted).collect(),
            Self::Space => line.split_whitespace().map(unquoted).collect(),
        }
    }
}

/// The contents of the lines before the rows.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) labels: Vec<String>,
    pub(super) rate: Option<f64>,
    /// Other rates that the header states, such as that of the cameras.
    pub(super) other_rates: Vec<f64>,
    pub(super) frames: Option<f64>,
    /// None where it must be guessed.
    pub(super) unit: Option<LengthUnit>,
    /// The line of the header's values.
    pub(super) values: Place,
    /// What separates cells where it is neither a tab nor a space.
    pub(super) delimiter: Option<Delimiter>,
    /// The column of the time, by the line of names.
    pub(super) time: usize,
    /// The column of the first coordinate, by the names and the axes: the likeliest first.
    pub(super) first: Vec<usize>,
}

/// Reads up to and including the axis line; `lines` is left at the first row.
pub(super) fn read<'a>(
    lines: &mut std::iter::Peekable<impl Iterator<Item = Line<'a>>>,
    warnings: &mut Warnings,
) -> Result<Header, Error> {
    let keys_line = find_keys(lines, warnings)?;
    let delimiter = Delimiter::of_words(keys_line.text);
    let keys = delimiter.cells(keys_line.text);
    let Some(values_line) = lines.find(|line| !line.is_blank()) else {
        return Err(Error::new("trc/truncated", "the header ends after its keys")
            .at(keys_line.place())
            .with_help("a line of values must follow: rate, frames, markers, unit"));
    };
    let other = matches!(delimiter, Delimiter::Comma | Delimiter::Semicolon).then_some(delimiter);
    let of_values = other.unwrap_or_else(|| Delimiter::of(values_line.text));
    let values = Values::new(&keys, of_values.cells(values_line.text));
    let number_of = |key: &str| {
        let value = values.of(key)?;
        cell(value).or_else(|| with_comma(value)).filter(|v| v.is_finite())
    };
    let rate_of = |key: &str| number_of(key).filter(|rate| *rate > 0.0);

    let rate = rate_of("DataRate");
    if rate.is_none() {
        warnings.push(
            Diagnostic::warning("trc/rate", "the header has no DataRate")
                .at(values_line.place())
                .with_help("the rate is taken from the times"),
        );
    }
    let unit = unit_of(&values, values_line, warnings);
    let declared = number_of("NumMarkers");
    let Names { labels, time, first } = names(lines, values_line, other, declared, warnings)?;
    Ok(Header {
        labels,
        rate,
        other_rates: ["CameraRate", "OrigDataRate"].into_iter().filter_map(rate_of).collect(),
        frames: number_of("NumFrames"),
        unit,
        values: values_line.place(),
        delimiter: other,
        time,
        first,
    })
}

/// The values of the header, each with its key.
struct Values<'a> {
    pairs: Vec<(&'a str, &'a str)>,
    /// All that are not blank.
    filled: Vec<&'a str>,
}

impl<'a> Values<'a> {
    /// By column; where that leaves some of them without a key, as between two tabs instead of one, by
    /// their order.
    fn new(keys: &[&'a str], values: Vec<&'a str>) -> Self {
        let filled = |cells: &[&'a str]| -> Vec<&'a str> {
            cells.iter().copied().filter(|cell| !cell.is_empty()).collect()
        };
        let (named, given) = (filled(keys), filled(&values));
        let all_keyed = values
            .iter()
            .enumerate()
            .all(|(at, value)| value.is_empty() || keys.get(at).is_some_and(|key| !key.is_empty()));
        let by_order = !all_keyed && named.len() >= given.len();
        let pairs = match by_order {
            true => named.into_iter().zip(given.iter().copied()).collect(),
            false => keys.iter().copied().zip(values.iter().copied()).collect(),
        };
        Self { pairs, filled: given }
    }

    fn of(&self, key: &str) -> Option<&'a str> {
        let found = self.pairs.iter().find(|(k, _)| k.eq_ignore_ascii_case(key));
        found.map(|(_, value)| *value).filter(|value| !value.is_empty())
    }
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
    let start = first.text.trim_start_matches(|c: char| c.is_whitespace() || c == '"');
    if !start.to_ascii_lowercase().starts_with("pathfiletype") {
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
    let mut words = line.text.split(|c: char| c.is_whitespace() || ",;\"'".contains(c));
    words.any(|word| known.iter().any(|key| word.eq_ignore_ascii_case(key)))
}

/// The unit under its key; where there is none that is known, the only one that the values hold.
fn unit_of(values: &Values<'_>, line: Line<'_>, warnings: &mut Warnings) -> Option<LengthUnit> {
    let name = values.of("Units");
    if let Some(unit) = name.and_then(LengthUnit::from_name) {
        return Some(unit);
    }
    let mut others = values.filled.iter().filter_map(|value| LengthUnit::from_name(value));
    if let (Some(unit), None) = (others.next(), others.next()) {
        let message = format!("the unit `{}` is not under its key", unit.name());
        warnings.push(Diagnostic::warning("trc/header", message).at(line.place()));
        return Some(unit);
    }
    let message = match name {
        Some(name) if cell(name).is_none() => format!("`{name}` is not a unit of length"),
        _ => "the header has no unit of length".to_owned(),
    };
    warnings.push(
        Diagnostic::warning("trc/unit", message)
            .at(line.place())
            .with_help("write mm, cm, m, in or ft; guessed from the size of the data"),
    );
    None
}

/// What the lines of names and axes say.
struct Names {
    labels: Vec<String>,
    time: usize,
    first: Vec<usize>,
}

/// Reads the label line and the axis line after it.
fn names<'a>(
    lines: &mut std::iter::Peekable<impl Iterator<Item = Line<'a>>>,
    values: Line<'a>,
    delimiter: Option<Delimiter>,
    declared: Option<f64>,
    warnings: &mut Warnings,
) -> Result<Names, Error> {
    let next = |lines: &mut std::iter::Peekable<_>| {
        lines.by_ref().find(|line: &Line<'_>| !line.is_blank())
    };
    let Some(label_line) = next(lines) else {
        return Err(Error::new("trc/truncated", "the file ends before the marker names")
            .at(values.place())
            .with_help("a line `Frame# Time name name ...` must follow the header's values"));
    };
    let of = |line: Line<'_>| delimiter.unwrap_or_else(|| Delimiter::of(line.text));
    let cells = of(label_line).cells(label_line.text);
    let Some(time) = time_column(&cells) else {
        return Err(Error::new("trc/labels", "the marker names do not start with `Frame# Time`")
            .at(label_line.place())
            .with_help("write `Frame#`, `Time` and then one name for each marker"));
    };
    let named = cells.iter().copied().enumerate().skip(time + 1);
    let mut named: Vec<(usize, &str)> = named.filter(|(_, cell)| !cell.is_empty()).collect();

    while lines.peek().is_some_and(Line::is_blank) {
        lines.next();
    }
    // The axis line has no number in it; where it is missing the rows follow immediately.
    let axes = lines.next_if(|line| {
        let cells = of(*line).cells(line.text);
        let mut filled = cells.iter().filter(|cell| !cell.is_empty()).peekable();
        filled.peek().is_some()
            && filled.all(|cell| cell.starts_with(|c: char| "XYZxyz".contains(c)))
    });
    let columns: Option<Vec<usize>> = axes.map(|line| {
        let axes = of(line).cells(line.text);
        axes.iter().enumerate().filter(|(_, a)| !a.is_empty()).map(|(i, _)| i).collect()
    });
    // Where spaces separate, columns say nothing.
    let lead = columns.as_ref().and_then(|columns| columns.first().copied());
    let lead = lead.filter(|lead| of(label_line) != Delimiter::Space && *lead > time);
    let markers = columns.as_ref().map(|columns| columns.len() / 3);
    let others = other_columns(&named, markers, lead);
    for (column, name) in named.drain(..others) {
        warnings.add("trc/extra-column", || {
            let message = format!("`{name}` in column {} is no marker", column + 1);
            Diagnostic::warning("trc/extra-column", message)
                .at(label_line.place())
                .with_help("it is not read: the axes begin behind it")
        });
    }
    let mut first = vec![time + 1 + others];
    first.extend(lead.filter(|lead| !first.contains(lead)));
    if let Some(columns) = &columns
        && columns.len() / 3 > named.len()
    {
        named = unnamed(&named, columns, of(label_line), label_line, warnings)?;
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
    Ok(Names { labels: distinct(&named, label_line, warnings), time, first })
}

/// The column called `Time`, with nothing before it but a number of frames and blank cells.
fn time_column(cells: &[&str]) -> Option<usize> {
    let is_time = |cell: &str| {
        let lower = cell.to_ascii_lowercase();
        lower.starts_with("time") && !lower.starts_with("timestamp")
    };
    let at = cells.iter().take(4).position(|cell| is_time(cell))?;
    let frames = [
        "",
        "frame",
        "sub",
        "field",
        "sample",
        "index",
        "item",
        "#",
        "no",
        "timestamp",
        "time stamp",
        "system",
    ];
    let before = cells[..at].iter().map(|cell| cell.to_ascii_lowercase());
    let known =
        |cell: String| frames.iter().any(|f| cell == *f || !f.is_empty() && cell.starts_with(f));
    before.into_iter().all(known).then_some(at)
}

/// How many of the first names are those of columns without axes, such as a time stamp.
fn other_columns(named: &[(usize, &str)], markers: Option<usize>, lead: Option<usize>) -> usize {
    let stamps = ["timestamp", "systemtime", "unixtime", "timecode", "subframe", "epoch"];
    let is_stamp = |name: &str| {
        let letters = name.chars().filter(char::is_ascii_alphabetic).collect::<String>();
        stamps.iter().any(|stamp| letters.eq_ignore_ascii_case(stamp))
    };
    let surplus = markers.map(|markers| named.len().saturating_sub(markers));
    if let (Some(surplus), Some(lead)) = (surplus, lead)
        && named.iter().take(surplus).all(|(column, _)| *column < lead)
    {
        return surplus;
    }
    named.iter().take(surplus.unwrap_or(1)).take_while(|(_, name)| is_stamp(name)).count()
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
    text::distinct(named.iter().map(|(_, name)| *name), |index, other| {
        let name = named.get(index).map_or("", |(_, name)| name);
        warnings.add("trc/duplicate-name", || {
            Diagnostic::warning("trc/duplicate-name", format!("two markers are called `{name}`"))
                .at(line.place())
                .with_help(format!("the later one is read as `{other}`"))
        });
    })
}
