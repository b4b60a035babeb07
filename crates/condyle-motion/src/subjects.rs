//! Several people in one recording, told apart by what their labels begin with.

use crate::Recording;
use condyle_diagnostics::{Error, did_you_mean};

impl Recording {
    /// The people whose names stand before a colon in labels (`Anna:RFHD`), each with the number of labels,
    /// in the order of the labels.
    ///
    /// ```
    /// use condyle_motion::Recording;
    /// let labels = ["Anna:RFHD", "Anna:LFHD", "Ben:RFHD", "*12"].map(str::to_owned).to_vec();
    /// let recording = Recording { labels, ..Recording::default() };
    /// assert_eq!(recording.subjects(), [("Anna", 2), ("Ben", 1)]);
    /// ```
    #[must_use]
    pub fn subjects(&self) -> Vec<(&str, usize)> {
        let mut subjects: Vec<(&str, usize)> = vec![];
        for (name, _) in self.labels.iter().filter_map(|label| label.rsplit_once(':')) {
            match subjects.iter_mut().find(|(known, _)| *known == name) {
                Some((_, count)) => *count += 1,
                None => subjects.push((name, 1)),
            }
        }
        subjects
    }

    /// The part of a recording that is one person's: the labels that begin with the name and a colon or
    /// another sign that is no letter or digit.
    ///
    /// # Errors
    /// `recording/subject` if there is no such label.
    pub fn of_subject(&self, subject: &str) -> Result<Self, Error> {
        let is_theirs = |label: &String| {
            label.strip_prefix(subject).is_some_and(|rest| {
                rest.starts_with(|c: char| !c.is_alphanumeric()) && rest.chars().count() > 1
            })
        };
        let kept: Vec<usize> =
            (0..self.labels.len()).filter(|&label| is_theirs(&self.labels[label])).collect();
        if kept.is_empty() {
            let subjects: Vec<&str> = self.subjects().iter().map(|(name, _)| *name).collect();
            let message = format!("no label begins with the name of a subject `{subject}`");
            let all = || match subjects[..] {
                [] => "no label has a name before a colon".to_owned(),
                _ => format!("subjects are: {}", subjects.join(", ")),
            };
            let help = did_you_mean(subject, subjects.iter().copied(), all);
            return Err(Error::new("recording/subject", message).with_help(help));
        }
        let rows = (0..self.frames()).map(|frame| self.frame(frame));
        let confidence = |frame: usize| kept.iter().map(move |&l| self.confidence(frame, l));
        Ok(Self {
            labels: kept.iter().map(|&label| self.labels[label].clone()).collect(),
            positions: rows
                .flat_map(|row| kept.iter().filter_map(|&l| row.get(l).copied()))
                .collect(),
            times: self.times.clone(),
            confidences: self
                .confidences
                .is_some()
                .then(|| (0..self.frames()).flat_map(confidence).collect()),
            ..*self
        })
    }
}
