//! A recording with everything that stands beside its markers.

use super::analog::Analog;
use super::bytes::Processor;
use super::event::{self, Event};
use super::parameters::Parameters;
use super::platform::{self, Platform};
use super::vertical::Up;
use condyle_motion::{LengthUnit, Observed, Recording, Table};

/// What a point is that is no marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Angles of a joint, in degrees.
    Angle,
    /// A force.
    Force,
    /// A moment.
    Moment,
    /// A power.
    Power,
    /// Single numbers.
    Scalar,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Angle, Self::Force, Self::Moment, Self::Power, Self::Scalar];

    /// The parameter of `POINT` that lists their labels.
    #[must_use]
    pub fn list(self) -> &'static str {
        match self {
            Self::Angle => "ANGLES",
            Self::Force => "FORCES",
            Self::Moment => "MOMENTS",
            Self::Power => "POWERS",
            Self::Scalar => "SCALARS",
        }
    }

    /// The parameter of `POINT` that states their unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Angle => "ANGLE_UNITS",
            Self::Force => "FORCE_UNITS",
            Self::Moment => "MOMENT_UNITS",
            Self::Power => "POWER_UNITS",
            Self::Scalar => "SCALAR_UNITS",
        }
    }

    /// Its name, for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Force => "force",
            Self::Moment => "moment",
            Self::Power => "power",
            Self::Scalar => "scalar",
        }
    }
}

/// A point that is no marker, over time: three numbers in each frame, in a unit of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct Other {
    /// Its name; no other point has it.
    pub label: String,
    /// What it is.
    pub kind: Kind,
    /// The unit of its numbers, as it is written; may be blank.
    pub unit: String,
    /// Its numbers as they are in the file, frame by frame, in the axes of the file; zeros where it is missing.
    pub values: Vec<[f32; 3]>,
    /// As [`Trial::words`].
    pub words: Vec<f32>,
}

impl Other {
    /// Its numbers in a frame; `None` where it is missing.
    #[must_use]
    pub fn value(&self, frame: usize) -> Option<[f64; 3]> {
        let value = self.values.get(frame)?.map(f64::from);
        self.words.get(frame).is_none_or(|word| *word >= 0.0).then_some(value)
    }
}

/// A place among the points of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// The marker of this position in the recording.
    Marker(usize),
    /// The other point of this position.
    Other(usize),
}

/// How the numbers of a file are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Storage {
    /// The processor.
    pub processor: Processor,
    /// Whether numbers are whole numbers of 16 bits with a common scale, not floats.
    pub whole: bool,
}

/// All that a C3D file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The markers: metres, y up.
    pub recording: Recording,
    /// What the file says of the residual and the cameras of each marker in each frame, row by row; -1 where
    /// it was not seen. [`Trial::residual`] and [`Trial::cameras`] take it apart.
    pub words: Vec<f32>,
    /// Points that are no markers.
    pub others: Vec<Other>,
    /// The points in the order of the file.
    pub columns: Vec<Column>,
    /// Analog channels.
    pub analog: Analog,
    /// Events of the header; those of the group `EVENT` are in the parameters.
    pub header_events: Vec<Event>,
    /// All parameters as they are in the file.
    pub parameters: Parameters,
    /// The number of the first frame, counted from 1 at time 0.
    pub first_frame: usize,
    /// The longest gap that was filled, in frames, as the header says.
    pub filled_gap: u16,
    /// What a step of residuals is worth, in the file's unit of length.
    pub scale: f32,
    /// Which way is up in the file.
    pub up: Up,
    /// How the numbers were stored.
    pub storage: Storage,
}

impl Trial {
    /// A recording as it is written alone: in millimetres, y up.
    ///
    /// ```
    /// use condyle_formats::{LengthUnit, Recording, c3d};
    /// let recording = Recording {
    ///     labels: vec!["LASI".into()],
    ///     rate: 100.0,
    ///     times: vec![0.0],
    ///     positions: vec![[0.125, 0.9, -0.12].into()],
    ///     units: LengthUnit::Millimetre,
    ///     ..Recording::default()
    /// };
    /// let bytes = c3d::write(&c3d::Trial::of(recording.clone()))?;
    /// let read = c3d::from_bytes(&bytes)?.value.recording;
    /// assert_eq!(read.labels, recording.labels);
    /// let [x, y, z] = read.position(0, 0).unwrap_or_default();
    /// assert!((x - 0.125).abs() < 1e-7 && (y - 0.9).abs() < 1e-7 && (z + 0.12).abs() < 1e-7);
    /// # Ok::<(), condyle_formats::Error>(())
    /// ```
    #[must_use]
    pub fn of(mut recording: Recording) -> Self {
        recording.units = LengthUnit::Millimetre;
        let rate = if recording.rate > 0.0 { recording.rate } else { 100.0 };
        let start = recording.times.first().copied().unwrap_or(0.0);
        let first = (start * rate).round().clamp(0.0, 1e9) as usize + 1;
        let mut parameters = Parameters::default();
        parameters.set_texts("POINT", "X_SCREEN", &["+X"]);
        parameters.set_texts("POINT", "Y_SCREEN", &["+Y"]);
        Self {
            words: recording
                .positions
                .iter()
                .map(|p| missing_word(p.position().is_none()))
                .collect(),
            others: vec![],
            columns: (0..recording.labels.len()).map(Column::Marker).collect(),
            analog: Analog { per_frame: 1, rate, scale: 1.0, ..Analog::default() },
            header_events: vec![],
            parameters,
            first_frame: first,
            filled_gap: 0,
            scale: 1.0,
            up: Up::Y,
            storage: Storage::default(),
            recording,
        }
    }

    fn word(&self, frame: usize, marker: usize) -> Option<f32> {
        let width = self.recording.labels.len();
        self.recording.position(frame, marker)?;
        self.words.get(frame.checked_mul(width)?.checked_add(marker)?).copied()
    }

    /// The average distance of the rays by which a marker was seen, in metres; `None` where it was not seen.
    ///
    /// The low byte of the word times the scale; a word with a fraction is the distance itself.
    #[must_use]
    pub fn residual(&self, frame: usize, marker: usize) -> Option<f64> {
        let word = self.word(frame, marker).filter(|word| *word >= 0.0)?;
        let length = match word.fract() == 0.0 {
            true => f64::from(word as i32 & 0xff) * f64::from(self.scale.abs()),
            false => f64::from(word),
        };
        Some(self.recording.units.to_metres(length))
    }

    /// Which of the first seven cameras saw a marker, a bit for each; 0 where that is unknown.
    #[must_use]
    pub fn cameras(&self, frame: usize, marker: usize) -> u8 {
        let word = self.word(frame, marker).filter(|word| *word >= 0.0 && word.fract() == 0.0);
        word.map_or(0, |word| (word as i32 >> 8) as u8 & 0x7f)
    }

    /// All events in the order of their times, those of the group and those of the header that it lacks.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        let mut events = event::of_group(&self.parameters);
        // Both hold the same events in many files, with labels cut to four letters.
        let close = |a: &Event, b: &Event| (a.time - b.time).abs() < 0.002;
        let only: Vec<Event> = self
            .header_events
            .iter()
            .filter(|event| !events.iter().any(|known| close(known, event)))
            .cloned()
            .collect();
        events.extend(only);
        events.sort_by(|a, b| a.time.total_cmp(&b.time));
        events
    }

    /// The force platforms.
    #[must_use]
    pub fn platforms(&self) -> Vec<Platform> {
        platform::read(&self.parameters, self.recording.units, self.up)
    }

    /// Markers and all other points as one recording in millimetres; the numbers of others stand in it as in
    /// their own unit, so that a file in millimetres has them unchanged.
    #[must_use]
    pub fn all_points(&self) -> Recording {
        let millimetres = |value: [f64; 3]| value.map(|x| LengthUnit::Millimetre.to_metres(x));
        let mut all = Recording { units: LengthUnit::Millimetre, ..self.recording.clone() };
        if self.others.is_empty() {
            return all;
        }
        all.labels = self.columns.iter().map(|column| self.label(*column).to_owned()).collect();
        all.positions = Vec::with_capacity(self.columns.len() * all.frames());
        for frame in 0..self.recording.frames() {
            let row = self.recording.frame(frame);
            all.positions.extend(self.columns.iter().map(|column| match *column {
                Column::Marker(index) => row.get(index).copied().unwrap_or(Observed::MISSING),
                Column::Other(index) => {
                    let value = self.others.get(index).and_then(|other| other.value(frame));
                    value.map(millimetres).into()
                }
            }));
        }
        all
    }

    /// Three columns for each point: markers in metres, others in their own unit; NaN where one is missing.
    #[must_use]
    pub fn to_table(&self) -> Table {
        let mut all = self.all_points().to_table();
        let width = 3 * self.columns.len();
        for row in all.values.chunks_exact_mut(width.max(1)) {
            for (three, column) in row.chunks_exact_mut(3).zip(&self.columns) {
                if matches!(column, Column::Other(_)) {
                    three.iter_mut().for_each(|x| *x *= 1000.0);
                }
            }
        }
        all
    }

    /// The name of a point.
    pub(super) fn label(&self, column: Column) -> &str {
        let label = match column {
            Column::Marker(index) => self.recording.labels.get(index),
            Column::Other(index) => self.others.get(index).map(|other| &other.label),
        };
        label.map_or("", String::as_str)
    }
}

/// The word of a point.
pub(super) fn missing_word(missing: bool) -> f32 {
    if missing { -1.0 } else { 0.0 }
}
