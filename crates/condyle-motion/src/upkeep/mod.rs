//! Upkeep of values over time: turned axes, filled gaps, low-pass, another rate, a part, rates of change.
//!
//! A [`Series`] is what a recording and a table have in common: columns of numbers at the same times, NaN where
//! nothing was measured. A [`Step`] changes it and answers with a sentence of what it did, for the header of the
//! file that is written. Steps are done in the order given; [`Plan`] holds that in which they belong together:
//!
//! turn → unwind → fill → low-pass → resample → crop → differentiate
//!
//! Gaps are filled before the filter, which needs runs without holes; a part is cut out after it, so that the
//! ends of the part are filtered with what lies beyond them; and a rate of change is taken of what is smooth.
//!
//! Interpolation is everywhere the cubic spline with continuous curvature through all measured values of a
//! run ([`spline`]). Nothing is ever extrapolated.

mod axes;
mod difference;
mod fill;
mod low_pass;
mod rate;
pub mod spline;

pub use axes::Axes;

use crate::{AngleUnit, Observed, Recording, Table};
use condyle_diagnostics::{Diagnostic, Error, listed};

/// Columns of numbers at the same times.
///
/// ```
/// use condyle_motion::upkeep::{Series, Step};
/// let times: Vec<f64> = (0..5).map(f64::from).collect();
/// let hole = vec![0.0, 1.0, f64::NAN, 27.0, 64.0];
/// let mut series = Series { times, columns: vec![hole], together: 1 };
/// let said = Step::Fill { seconds: 2.0 }.apply(&mut series)?;
/// // Four values lie on one cubic, here t³, which the spline is.
/// assert!((series.columns[0][2] - 8.0).abs() < 1e-12);
/// assert_eq!(said, "filled 1 gap of up to 2 s, 1 value");
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Seconds, one per row, never decreasing.
    pub times: Vec<f64>,
    /// One list for each column, as long as `times`; NaN where nothing was measured.
    pub columns: Vec<Vec<f64>>,
    /// How many neighbouring columns are measured together: 3 for the x, y, z of a marker, else 1.
    pub together: usize,
}

/// One thing that is done to a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The columns are triples of x, y, z: turned to other axes.
    Turn(Axes),
    /// Jumps of about a whole turn between measured neighbours are taken out.
    Unwind {
        /// A whole turn: 360 or 2π.
        turn: f64,
    },
    /// Gaps between two measured values are filled on the spline.
    Fill {
        /// The longest time between the two values beside a gap, in seconds.
        seconds: f64,
    },
    /// A Butterworth low-pass of order 2, forth and back.
    LowPass {
        /// The frequency at which both passes together leave half of the power, in hertz.
        hertz: f64,
    },
    /// Rows at even steps of time from the first on.
    Resample {
        /// Rows per second.
        hertz: f64,
    },
    /// Only the rows of an interval of time, both ends included.
    Crop {
        /// Seconds.
        from: f64,
        /// Seconds.
        to: f64,
    },
    /// Every value becomes its rate of change per second, by differences of second order.
    Differentiate,
}

impl Step {
    /// Does it, and says what was done.
    ///
    /// # Errors
    /// `upkeep/argument` for a number that makes no sense for this series, `upkeep/uneven` if a filter is asked
    /// for and times are not evenly spaced, `upkeep/empty` if no row is left.
    pub fn apply(self, series: &mut Series) -> Result<String, Error> {
        match self {
            Self::Turn(axes) => axes.turn(series),
            Self::Unwind { turn } => Ok(unwind(series, turn)),
            Self::Fill { seconds } => fill::fill(series, seconds),
            Self::LowPass { hertz } => low_pass::low_pass(series, hertz),
            Self::Resample { hertz } => rate::resample(series, hertz),
            Self::Crop { from, to } => rate::crop(series, from, to),
            Self::Differentiate => difference::differentiate(series),
        }
    }
}

/// What is asked for, in the order in which it is done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plan {
    /// Other axes; for recordings.
    pub axes: Option<Axes>,
    /// The longest gap that is filled, in seconds.
    pub fill: Option<f64>,
    /// The cut-off of a low-pass, in hertz.
    pub low_pass: Option<f64>,
    /// Rows per second.
    pub resample: Option<f64>,
    /// The first and the last time that are kept.
    pub crop: Option<(f64, f64)>,
    /// Rates of change instead of values; for tables.
    pub differentiate: bool,
}

/// What a plan did to a recording or a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Done {
    /// One sentence for each step.
    pub steps: Vec<String>,
    /// What to know about the result.
    pub warnings: Vec<Diagnostic>,
}

impl Plan {
    /// Its steps, in their order, with the unwinding of angles that wrap at `turn`.
    fn steps(&self, turn: Option<f64>) -> Vec<Step> {
        let unwind = turn.map(|turn| Step::Unwind { turn });
        let steps = [
            self.axes.map(Step::Turn),
            unwind,
            self.fill.map(|seconds| Step::Fill { seconds }),
            self.low_pass.map(|hertz| Step::LowPass { hertz }),
            self.resample.map(|hertz| Step::Resample { hertz }),
            self.crop.map(|(from, to)| Step::Crop { from, to }),
            self.differentiate.then_some(Step::Differentiate),
        ];
        steps.into_iter().flatten().collect()
    }

    fn apply(&self, series: &mut Series, turn: Option<f64>) -> Result<Done, Error> {
        let mut done = Done::default();
        if let (Some(hertz), Some(old)) = (self.resample, rate::rate(&series.times)) {
            // Above half of the new rate nothing may be left.
            let kept = self.low_pass.unwrap_or(old / 2.0);
            if kept > hertz / 2.0 * (1.0 + 1e-9) {
                let message = format!(
                    "{hertz} rows a second hold frequencies up to {} Hz, and there are some up to {kept} Hz: they \
                     appear as slower ones",
                    hertz / 2.0
                );
                let help = format!("filter first: a low-pass at {} Hz or less", hertz / 2.0);
                done.warnings.push(Diagnostic::warning("upkeep/aliasing", message).with_help(help));
            }
        }
        for step in self.steps(turn) {
            let said = step.apply(series)?;
            if !said.is_empty() {
                done.steps.push(said);
            }
        }
        Ok(done)
    }

    /// Does it to a marker recording.
    ///
    /// # Errors
    /// As [`Step::apply`]; `upkeep/argument` for rates of change, which are no positions.
    pub fn recording(&self, recording: &mut Recording) -> Result<Done, Error> {
        if self.differentiate {
            return Err(Error::new("upkeep/argument", "speeds of markers are no marker recording")
                .with_help("write a table (.csv, .sto)"));
        }
        let mut series = Series::of_recording(recording);
        let done = self.apply(&mut series, None)?;
        series.into_recording(recording);
        if let Some(rate) = self.resample {
            recording.rate = rate;
        }
        Ok(done)
    }

    /// Does it to a table; with `differentiate` columns keep their names and their values are per second.
    ///
    /// Columns of angles that jump by a whole turn are unwound first; columns of quaternions are refused, since
    /// their four numbers mean nothing one by one.
    ///
    /// # Errors
    /// As [`Step::apply`]; `upkeep/argument` for turned axes, `upkeep/quaternions`.
    pub fn table(&self, table: &mut Table) -> Result<Done, Error> {
        if self.axes.is_some() {
            return Err(Error::new("upkeep/argument", "only marker recordings have axes to turn"));
        }
        let smooth = self.fill.is_some()
            || self.low_pass.is_some()
            || self.resample.is_some()
            || self.differentiate;
        let quaternions = quaternions(&table.columns);
        if smooth && !quaternions.is_empty() {
            let names = listed(&quaternions);
            return Err(Error::new(
                "upkeep/quaternions",
                format!("{names} are quaternions, whose numbers mean nothing one by one"),
            )
            .with_help("convert the motion of its model instead, or crop only"));
        }
        let turn = match table.angle_unit {
            AngleUnit::Degrees | AngleUnit::Unstated => 360.0,
            AngleUnit::Radians | AngleUnit::RadiansAsRule => std::f64::consts::TAU,
        };
        let mut series = Series::of_table(table);
        let done = self.apply(&mut series, smooth.then_some(turn))?;
        series.into_table(table);
        Ok(done)
    }
}

impl Series {
    /// Three columns for each marker.
    #[must_use]
    pub fn of_recording(recording: &Recording) -> Self {
        let (rows, markers) = (recording.frames(), recording.labels.len());
        let mut columns = vec![vec![f64::NAN; rows]; 3 * markers];
        for row in 0..rows {
            for (marker, seen) in recording.frame(row).iter().enumerate() {
                for (axis, x) in seen.position().into_iter().flatten().enumerate() {
                    columns[3 * marker + axis][row] = x;
                }
            }
        }
        Self { times: recording.times.clone(), columns, together: 3 }
    }

    fn into_recording(self, recording: &mut Recording) {
        let markers = recording.labels.len();
        let mut positions = Vec::with_capacity(self.times.len() * markers);
        for row in 0..self.times.len() {
            for xyz in self.columns.chunks_exact(3) {
                positions.push(Observed::from([xyz[0][row], xyz[1][row], xyz[2][row]]));
            }
        }
        recording.confidences = between(recording, &self.times);
        recording.positions = positions;
        recording.times = self.times;
    }

    /// The columns of a table.
    #[must_use]
    pub fn of_table(table: &Table) -> Self {
        let columns = (0..table.columns.len()).map(|column| table.series(column).collect());
        Self { times: table.times.clone(), columns: columns.collect(), together: 1 }
    }

    fn into_table(self, table: &mut Table) {
        let rows = self.times.len();
        table.values =
            (0..rows).flat_map(|row| self.columns.iter().map(move |column| column[row])).collect();
        table.times = self.times;
    }
}

/// The confidences of a recording at other times, each between its neighbours' that were seen.
fn between(recording: &Recording, times: &[f64]) -> Option<Vec<f64>> {
    recording.confidences.as_ref()?;
    let markers = recording.labels.len();
    let mut confidences = vec![0.0; times.len() * markers];
    for marker in 0..markers {
        let at = |frame: usize| (recording.times[frame], recording.confidence(frame, marker));
        let seen: Vec<(f64, f64)> =
            (0..recording.frames()).map(at).filter(|(_, sure)| *sure > 0.0).collect();
        for (row, time) in times.iter().enumerate() {
            let after = seen.partition_point(|(t, _)| t < time);
            let before = after.checked_sub(1).and_then(|i| seen.get(i)).or(seen.first());
            let Some((&(t0, c0), &(t1, c1))) = before.zip(seen.get(after).or(seen.last())) else {
                continue;
            };
            let share = if t1 > t0 { ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 1.0 };
            confidences[row * markers + marker] = c0 + share * (c1 - c0);
        }
    }
    Some(confidences)
}

/// The runs of rows in which a column has values: first row and the row after the last.
fn runs(column: &[f64]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = None;
    for (row, value) in column.iter().enumerate() {
        match (value.is_nan(), start) {
            (false, None) => start = Some(row),
            (true, Some(first)) => {
                runs.push(first..row);
                start = None;
            }
            _ => {}
        }
    }
    runs.extend(start.map(|first| first..column.len()));
    runs
}

/// Adds whole turns where a column jumps by more than half a one between measured neighbours.
fn unwind(series: &mut Series, turn: f64) -> String {
    let mut unwound = 0;
    for column in &mut series.columns {
        let (mut last, mut added) = (f64::NAN, 0.0);
        let before = unwound;
        for value in column.iter_mut().filter(|value| !value.is_nan()) {
            // Numbers that are no angles do not jump by a turn, exactly to a twentieth, again and again.
            let turns = ((*value - last) / turn).round();
            if turns != 0.0 && ((*value - last) / turn - turns).abs() < 0.05 {
                added -= turns * turn;
                unwound = before + 1;
            }
            last = *value;
            *value += added;
        }
    }
    match unwound {
        0 => String::new(),
        count => format!("took whole turns out of {count} {}", plural(count, "column", "columns")),
    }
}

/// The first names of quaternion columns: four that differ in an ending w, x, y, z.
fn quaternions(columns: &[String]) -> Vec<String> {
    let stem = |name: &str, letter: char| {
        let short = name.strip_suffix(letter)?;
        Some(short.to_owned())
    };
    let with = |letter: char| columns.iter().filter_map(move |name| stem(name, letter));
    let has = |stem: &str, letter: char| with(letter).any(|other| other == stem);
    let found = with('w').filter(|s| has(s, 'x') && has(s, 'y') && has(s, 'z'));
    found.map(|stem| format!("`{stem}w`")).collect()
}

fn plural(count: usize, one: &'static str, many: &'static str) -> &'static str {
    if count == 1 { one } else { many }
}

fn argument(message: String) -> Error {
    Error::new("upkeep/argument", message)
}
