//! Frames of trials, and which trials belong together.

/// Who moves in a trial, and how.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Groups {
    /// The person; empty where nobody is named.
    pub subject: String,
    /// The kind of motion, such as `crouch`.
    pub motion: String,
    /// A variety of it, such as `crouch_30`; equal to the motion where there are none.
    pub sub_motion: String,
}

impl Groups {
    /// What the name of a file says: its parts between `_`, `-`, spaces and dots are a subject (`s1`, `subject2`, `p03`),
    /// the motion, and what distinguishes its varieties; a number at the end counts repetitions. Digits at the end of
    /// the only part count repetitions, too.
    ///
    /// ```
    /// use condyle_learn::coupling::Groups;
    /// let groups = Groups::of_name("s2_crouch_30_4");
    /// assert_eq!((&*groups.subject, &*groups.motion), ("s2", "crouch"));
    /// assert_eq!(groups.sub_motion, "crouch_30");
    /// assert_eq!(Groups::of_name("gait07").motion, "gait");
    /// ```
    #[must_use]
    pub fn of_name(name: &str) -> Self {
        let lower = name.to_lowercase();
        let mut parts: Vec<&str> =
            lower.split(['_', '-', ' ', '.']).filter(|part| !part.is_empty()).collect();
        let mut subject = String::new();
        if parts.len() > 1 && is_subject(parts[0]) {
            subject = parts.remove(0).to_owned();
        }
        let is_number = |part: &&str| part.chars().all(|c| c.is_ascii_digit());
        if parts.len() > 1 && parts.last().is_some_and(is_number) {
            parts.pop();
        } else if let Some(last) = parts.last_mut() {
            let bare = last.trim_end_matches(|c: char| c.is_ascii_digit());
            if !bare.is_empty() {
                *last = bare;
            }
        }
        let motion = parts.first().copied().unwrap_or_default();
        // `walk1_left` is a variety of `walk`.
        let bare = motion.trim_end_matches(|c: char| c.is_ascii_digit());
        let motion = if bare.is_empty() { motion } else { bare };
        Self { subject, motion: motion.to_owned(), sub_motion: parts.join("_") }
    }
}

fn is_subject(part: &str) -> bool {
    ["subject", "subj", "sub", "person", "s", "p"].iter().any(|word| {
        part.strip_prefix(word)
            .is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit()))
    })
}

/// The frames of one trial in which all columns are known.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Trial {
    /// Its name, such as that of its file.
    pub name: String,
    /// Who moves, and how.
    pub groups: Groups,
    /// Frame by frame, one number for each column of the samples.
    pub values: Vec<f64>,
    /// Frames that are left out because a value is missing.
    pub missing: usize,
    /// Frames that are left out because they were tracked badly.
    pub badly_tracked: usize,
}

/// Trials of the same coordinates.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Samples {
    /// The names of the coordinates.
    pub columns: Vec<String>,
    /// The trials.
    pub trials: Vec<Trial>,
}

impl Samples {
    /// A trial from rows that may have gaps: rows with a number that is not finite are left out and counted.
    ///
    /// ```
    /// use condyle_learn::coupling::{Groups, Samples};
    /// let mut samples = Samples { columns: vec!["a".into(), "b".into()], trials: vec![] };
    /// samples.add("gait_1", Groups::of_name("gait_1"), &[0.1, 0.2, f64::NAN, 0.3, 0.5, 0.6], 0);
    /// assert_eq!((samples.frames(), samples.trials[0].missing), (2, 1));
    /// ```
    pub fn add(&mut self, name: &str, groups: Groups, rows: &[f64], badly_tracked: usize) {
        let width = self.columns.len().max(1);
        let mut trial = Trial { name: name.to_owned(), groups, badly_tracked, ..Trial::default() };
        for row in rows.chunks_exact(width) {
            if row.iter().all(|x| x.is_finite()) {
                trial.values.extend_from_slice(row);
            } else {
                trial.missing += 1;
            }
        }
        self.trials.push(trial);
    }

    /// How many frames of a trial are used.
    #[must_use]
    pub fn frames_of(&self, trial: &Trial) -> usize {
        trial.values.len() / self.columns.len().max(1)
    }

    /// How many frames of all trials are used.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.trials.iter().map(|trial| self.frames_of(trial)).sum()
    }

    /// The values of a column in all trials, one after another.
    #[must_use]
    pub fn column(&self, column: usize) -> Vec<f64> {
        let width = self.columns.len().max(1);
        let rows = self.trials.iter().flat_map(|trial| trial.values.chunks_exact(width));
        rows.filter_map(|row| row.get(column).copied()).collect()
    }

    /// The position of a column.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}
