//! Upkeep of a trial: its markers are filled and filtered, and a part is cut from everything.

use super::Trial;
use super::trial::missing_word;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_motion::upkeep::{Done, Plan};
use std::ops::Range;

impl Trial {
    /// Does what a plan says to the markers; analog channels and points that are no markers are cut with them, and
    /// left out, with a warning, where axes are turned or the rate changes. What was done is the parameter
    /// `PROCESSING:UPKEEP`, after what it held before.
    ///
    /// # Errors
    /// As [`Plan::recording`].
    pub fn keep_up(&mut self, plan: &Plan) -> Result<Done, Error> {
        let before = self.recording.frames();
        let times = self.recording.times.clone();
        let mut done = plan.recording(&mut self.recording)?;
        if plan.axes.is_some() || plan.resample.is_some() {
            let (others, channels) = (self.others.len(), self.analog.channels.len());
            let history = self.parameters.texts("PROCESSING", "UPKEEP");
            *self = Self::of(std::mem::take(&mut self.recording));
            self.parameters.set_texts("PROCESSING", "UPKEEP", &history);
            if others + channels > 0 {
                let message = format!(
                    "{others} points that are no markers and {channels} analog channels are left out: they are neither \
                     turned nor resampled"
                );
                done.warnings.push(Diagnostic::warning("upkeep/markers-only", message));
            }
        } else if let Some(first) =
            self.recording.times.first().filter(|_| self.recording.frames() < before)
        {
            let start = times.partition_point(|time| time < first);
            self.cut(start..start + self.recording.frames());
        }
        // A marker that was filled has been seen by no camera.
        for (word, position) in self.words.iter_mut().zip(&self.recording.positions) {
            match position.position() {
                Some(_) if *word < 0.0 => *word = missing_word(false),
                None => *word = missing_word(true),
                Some(_) => {}
            }
        }
        let mut history = self.parameters.texts("PROCESSING", "UPKEEP");
        history.extend(done.steps.iter().cloned());
        self.parameters.set_texts("PROCESSING", "UPKEEP", &history);
        Ok(done)
    }

    /// Keeps some frames of everything but the recording, which has been cut already.
    fn cut(&mut self, frames: Range<usize>) {
        fn part<T: Clone>(all: &mut Vec<T>, per_frame: usize, frames: &Range<usize>) {
            let end = frames.end.saturating_mul(per_frame).min(all.len());
            let start = frames.start.saturating_mul(per_frame).min(end);
            *all = all[start..end].to_vec();
        }
        part(&mut self.words, self.recording.labels.len(), &frames);
        for other in &mut self.others {
            part(&mut other.values, 1, &frames);
            part(&mut other.words, 1, &frames);
        }
        let samples = self.analog.per_frame * self.analog.channels.len();
        part(&mut self.analog.stored, samples, &frames);
        self.first_frame += frames.start;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::c3d::{self, Analog, Channel};
    use condyle_motion::{Observed, Recording};

    fn trial() -> Trial {
        let recording = Recording {
            labels: vec!["A".into(), "B".into()],
            rate: 100.0,
            times: (0..20).map(|i| f64::from(i) / 100.0).collect(),
            positions: (0..20)
                .flat_map(|i| {
                    let a = [f64::from(i) * 0.01, 1.0, 0.0].into();
                    [
                        a,
                        if i == 8 {
                            Observed::MISSING
                        } else {
                            [0.0, f64::from(i) * 0.02, 0.5].into()
                        },
                    ]
                })
                .collect(),
            ..Recording::default()
        };
        let mut trial = Trial::of(recording);
        trial.analog = Analog {
            channels: vec![Channel { label: "Fz".into(), scale: 1.0, ..Channel::default() }],
            rate: 200.0,
            per_frame: 2,
            scale: 1.0,
            stored: (0..40u8).map(f32::from).collect(),
        };
        trial
    }

    #[test]
    fn channels_are_cut_with_the_markers() {
        let mut trial = trial();
        let plan = Plan { fill: Some(0.02), crop: Some((0.05, 0.1)), ..Plan::default() };
        trial.keep_up(&plan).unwrap();
        let read = c3d::from_bytes(&c3d::write(&trial).unwrap()).unwrap().value;
        assert_eq!((read.recording.frames(), read.first_frame), (6, 6));
        assert!((read.recording.times[0] - 0.05).abs() < 1e-12);
        assert_eq!(read.analog.values(0), (10..22).map(f64::from).collect::<Vec<_>>());
        // The gap in frame 8 lies on a line.
        let [_, y, _] = read.recording.position(3, 1).unwrap();
        assert!((y - 0.16).abs() < 1e-7 && read.words.iter().all(|word| *word >= 0.0));
        let said = read.parameters.texts("PROCESSING", "UPKEEP");
        assert_eq!(said[0], "filled 1 gap of up to 0.02 s, 1 value");
        assert_eq!(said.len(), 2);
    }

    #[test]
    fn at_another_rate_only_markers_are_left_and_it_is_said() {
        let mut trial = trial();
        let plan = Plan { resample: Some(50.0), ..Plan::default() };
        let done = trial.keep_up(&plan).unwrap();
        assert!(done.warnings.iter().any(|warning| warning.code == "upkeep/markers-only"));
        assert_eq!((trial.recording.frames(), trial.analog.channels.len()), (10, 0));
        c3d::write(&trial).unwrap();
    }
}
