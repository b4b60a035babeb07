//! Whether a marker at 0 0 0 stands there or was not seen.

use crate::{Observed, Recording};
use condyle_diagnostics::{Diagnostic, listed};

/// What a marker at exactly `0 0 0` means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Zeros {
    /// Not seen, where the marker is elsewhere in other frames; a place, where it is nowhere else.
    #[default]
    Told,
    /// A place like any other.
    Keep,
    /// Not seen.
    Missing,
}

impl Recording {
    /// Decides what positions at exactly `0 0 0` are, over the whole recording: some programs write them
    /// where a marker was not seen.
    ///
    /// Warnings name the markers and how many positions they are.
    ///
    /// ```
    /// use condyle_motion::{Recording, Zeros};
    /// let mut recording = Recording {
    ///     labels: vec!["LASI".into(), "origin".into()],
    ///     times: vec![0.0, 0.01],
    ///     positions: [[0.0; 3], [0.0; 3], [0.1, 0.9, 0.0], [0.0; 3]].map(Into::into).to_vec(),
    ///     ..Recording::default()
    /// };
    /// let said = recording.settle_zeros(Zeros::Told);
    /// assert_eq!((recording.position(0, 0), recording.position(0, 1)), (None, Some([0.0; 3])));
    /// assert_eq!(said.len(), 2);
    /// ```
    pub fn settle_zeros(&mut self, zeros: Zeros) -> Vec<Diagnostic> {
        let width = self.labels.len();
        if zeros == Zeros::Keep || width == 0 {
            return vec![];
        }
        let at_zero = |position: &Observed| position.position() == Some([0.0; 3]);
        // At zero, and elsewhere.
        let mut counts = vec![[0usize; 2]; width];
        for row in self.positions.chunks_exact(width) {
            for (count, position) in counts.iter_mut().zip(row) {
                match position.position() {
                    Some([0.0, 0.0, 0.0]) => count[0] += 1,
                    Some(_) => count[1] += 1,
                    None => {}
                }
            }
        }
        let [mut dropped, mut kept] = [vec![], vec![]];
        for (marker, count) in counts.iter().enumerate() {
            match count {
                [0, _] => {}
                [_, 0] if zeros == Zeros::Told => kept.push(marker),
                _ => dropped.push(marker),
            }
        }
        let mut drops = vec![false; width];
        dropped.iter().for_each(|&marker| drops[marker] = true);
        if !dropped.is_empty() {
            for row in self.positions.chunks_exact_mut(width) {
                for (position, drop) in row.iter_mut().zip(&drops) {
                    if *drop && at_zero(position) {
                        *position = Observed::MISSING;
                    }
                }
            }
        }
        let frames = self.frames();
        let named = |markers: &[usize]| {
            let one =
                |&m: &usize| format!("{} ({} of {frames} frames)", self.labels[m], counts[m][0]);
            listed(markers.iter().map(one))
        };
        let mut said = vec![];
        if !dropped.is_empty() {
            let count: usize = dropped.iter().map(|&marker| counts[marker][0]).sum();
            let place = match zeros {
                Zeros::Told => " and elsewhere in other frames",
                _ => "",
            };
            let message = format!("at exactly 0 0 0{place}: {}", named(&dropped));
            let help = format!("these {count} positions are missing; `--zeros keep` keeps them");
            said.push(Diagnostic::warning("recording/zeros", message).with_help(help));
        }
        if !kept.is_empty() {
            let message = format!("at exactly 0 0 0 wherever it is seen: {}", named(&kept));
            let help = "kept, as it may be a real origin; `--zeros missing` drops it";
            said.push(Diagnostic::warning("recording/origin", message).with_help(help));
        }
        said
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_decided_for_each_kind_of_marker() {
        // Always at zero; at zero and elsewhere; at zero and not seen; never at zero.
        let [zero, away] = [Observed::from([0.0; 3]), Observed::from([0.0, 0.0, 1.0])];
        let rows = [[zero, zero, zero, away], [zero, away, Observed::MISSING, away]];
        let settled = |zeros| {
            let mut recording = Recording {
                labels: ["a", "b", "c", "d"].map(str::to_owned).to_vec(),
                times: vec![0.0, 0.01],
                positions: rows.concat(),
                ..Recording::default()
            };
            let said = recording.settle_zeros(zeros);
            let codes: Vec<_> = said.iter().map(|d| d.code).collect();
            let frame: Vec<bool> =
                recording.frame(0).iter().map(|p| p.position().is_some()).collect();
            (frame, codes.join(" "))
        };
        let told = settled(Zeros::Told);
        assert_eq!(
            told,
            (vec![true, false, true, true], "recording/zeros recording/origin".into())
        );
        assert_eq!(settled(Zeros::Keep), (vec![true; 4], String::new()));
        assert_eq!(
            settled(Zeros::Missing),
            (vec![false, false, false, true], "recording/zeros".into())
        );
    }
}
