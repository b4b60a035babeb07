//! Answers of many frames in little memory.

use crate::answer::{FrameAnswer, FrameStatus};

/// Answers of a run of frames, all numbers in one buffer: a third less than one by one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    coordinates: usize,
    markers: usize,
    /// For each frame F, P and Σ w |e|², then its coordinates, then its marker errors.
    numbers: Vec<f64>,
    /// The loop error of each frame; empty where all are 0, as in every model without loops.
    closures: Vec<f64>,
    ends: Vec<(FrameStatus, u32)>,
}

/// How many numbers of a frame stand before its coordinates.
const HEAD: usize = 3;

impl Run {
    /// The answers of frames of one tracker.
    pub fn of(answers: &[FrameAnswer]) -> Self {
        let widest = |length: fn(&FrameAnswer) -> usize| answers.iter().map(length).max();
        let coordinates = widest(|a| a.coordinates.len()).unwrap_or(0);
        let markers = widest(|a| a.marker_errors.len()).unwrap_or(0);
        let numbers = vec![f64::NAN; answers.len() * (HEAD + coordinates + markers)];
        let ends = vec![(FrameStatus::NoMarkers, 0); answers.len()];
        let mut run = Self { coordinates, markers, numbers, closures: vec![], ends };
        answers.iter().enumerate().for_each(|(frame, answer)| run.set(frame, answer));
        run
    }

    /// How many frames it has.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The answer of one of its frames; `None` beyond them.
    pub fn get(&self, frame: usize) -> Option<FrameAnswer> {
        let &(status, iterations) = self.ends.get(frame)?;
        let row = self.row(frame);
        Some(FrameAnswer {
            coordinates: row[HEAD..HEAD + self.coordinates].to_vec(),
            objective: row[0],
            posture: row[1],
            weighted_squares: row[2],
            marker_errors: row[HEAD + self.coordinates..].to_vec(),
            closure_error: self.closures.get(frame).copied().unwrap_or(0.0),
            status,
            iterations,
        })
    }

    fn row(&self, frame: usize) -> &[f64] {
        let width = HEAD + self.coordinates + self.markers;
        &self.numbers[frame * width..(frame + 1) * width]
    }

    fn row_mut(&mut self, frame: usize) -> &mut [f64] {
        let width = HEAD + self.coordinates + self.markers;
        &mut self.numbers[frame * width..(frame + 1) * width]
    }

    fn set(&mut self, frame: usize, answer: &FrameAnswer) {
        let coordinates = self.coordinates;
        self.ends[frame] = (answer.status, answer.iterations);
        if answer.closure_error != 0.0 {
            self.closures.resize(self.len(), 0.0);
        }
        if let Some(closure) = self.closures.get_mut(frame) {
            *closure = answer.closure_error;
        }
        let (head, rest) = self.row_mut(frame).split_at_mut(HEAD);
        head.copy_from_slice(&[answer.objective, answer.posture, answer.weighted_squares]);
        let (own, errors) = rest.split_at_mut(coordinates);
        own.iter_mut().zip(&answer.coordinates).for_each(|(to, from)| *to = *from);
        errors.iter_mut().zip(&answer.marker_errors).for_each(|(to, from)| *to = *from);
    }

    /// Leaves out the frames from this one on.
    pub(crate) fn truncate(&mut self, frames: usize) {
        self.numbers.truncate(frames * (HEAD + self.coordinates + self.markers));
        self.closures.truncate(frames);
        self.ends.truncate(frames);
    }

    /// All its answers.
    pub(crate) fn unpacked(&self) -> Vec<FrameAnswer> {
        (0..self.len()).filter_map(|frame| self.get(frame)).collect()
    }
}

/// Answers of all frames of a recording, in runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers {
    runs: Vec<Run>,
    /// For each run its first frame, and at the end the number of frames.
    starts: Vec<usize>,
}

impl Answers {
    /// The answers of runs one after another.
    pub fn of_runs(runs: Vec<Run>) -> Self {
        let mut starts = Vec::with_capacity(runs.len() + 1);
        let mut start = 0;
        starts.push(start);
        for run in &runs {
            start += run.len();
            starts.push(start);
        }
        Self { runs, starts }
    }

    /// How many frames there are.
    pub fn len(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The run that a frame is in, and its place there.
    fn place(&self, frame: usize) -> (usize, usize) {
        let run = self.starts.partition_point(|&start| start <= frame).saturating_sub(1);
        (run, frame - self.starts[run])
    }

    /// The answer of a frame; `None` beyond them.
    pub fn get(&self, frame: usize) -> Option<FrameAnswer> {
        (frame < self.len()).then(|| self.at(frame))
    }

    /// The answer of a frame.
    ///
    /// # Panics
    /// If there is no such frame, as indexing does.
    pub fn at(&self, frame: usize) -> FrameAnswer {
        let (run, place) = self.place(frame);
        self.runs[run].get(place).unwrap_or_else(|| panic!("there are {} frames", self.len()))
    }

    /// The stored numbers of all coordinates in a frame.
    ///
    /// # Panics
    /// If there is no such frame, as indexing does.
    pub fn coordinates(&self, frame: usize) -> &[f64] {
        let (run, place) = self.place(frame);
        let run = &self.runs[run];
        &run.row(place)[HEAD..HEAD + run.coordinates]
    }

    pub(crate) fn coordinates_mut(&mut self, frame: usize) -> &mut [f64] {
        let (run, place) = self.place(frame);
        let run = &mut self.runs[run];
        let coordinates = run.coordinates;
        &mut run.row_mut(place)[HEAD..HEAD + coordinates]
    }

    /// The distance of each marker target in a frame, NaN where it was not seen.
    ///
    /// # Panics
    /// If there is no such frame, as indexing does.
    pub fn marker_errors(&self, frame: usize) -> &[f64] {
        let (run, place) = self.place(frame);
        let run = &self.runs[run];
        &run.row(place)[HEAD + run.coordinates..]
    }

    /// F + P of a frame.
    pub(crate) fn minimised(&self, frame: usize) -> f64 {
        let (run, place) = self.place(frame);
        let row = self.runs[run].row(place);
        row[0] + row[1]
    }

    pub(crate) fn set(&mut self, frame: usize, answer: &FrameAnswer) {
        let (run, place) = self.place(frame);
        self.runs[run].set(place, answer);
    }

    /// The answers from the first frame to the last.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = FrameAnswer> + '_ {
        (0..self.len()).map(|frame| self.at(frame))
    }
}

/// How many frames are packed together where nothing else says so.
const RUN: usize = 64;

impl From<&[FrameAnswer]> for Answers {
    fn from(answers: &[FrameAnswer]) -> Self {
        Self::of_runs(answers.chunks(RUN).map(Run::of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_comes_out_the_same() {
        let answer = |i: usize| FrameAnswer {
            objective: i as f64,
            posture: 0.5,
            weighted_squares: 0.25,
            marker_errors: vec![0.1 * i as f64, 2.0, 3.0],
            closure_error: 7.0,
            status: FrameStatus::Solved,
            iterations: i as u32,
            ..FrameAnswer::start(&[i as f64, -1.0])
        };
        let list: Vec<FrameAnswer> = (0..150).map(answer).collect();
        let mut packed = Answers::from(&list[..]);
        assert_eq!(packed.iter().collect::<Vec<_>>(), list);
        assert_eq!((packed.len(), packed.get(150)), (150, None));
        assert_eq!(packed.coordinates(64), [64.0, -1.0]);
        assert_eq!(packed.marker_errors(149), list[149].marker_errors);
        packed.set(63, &answer(7));
        assert_eq!((packed.at(63), packed.minimised(63)), (answer(7), 7.5));
        assert_eq!((packed.at(62), packed.at(64)), (answer(62), answer(64)));
        let closed = |i: usize| FrameAnswer { closure_error: 0.0, ..answer(i) };
        let list: Vec<FrameAnswer> = (0..5).map(closed).collect();
        let mut packed = Answers::from(&list[..]);
        assert_eq!((packed.at(3), packed.runs[0].closures.len()), (closed(3), 0));
        packed.set(3, &answer(3));
        assert_eq!((packed.at(2), packed.at(3), packed.at(4)), (closed(2), answer(3), closed(4)));
        assert!(Answers::default().is_empty());
    }
}
