//! Points as a file has them, before axes, unit and rate are settled.

use super::sets::KeypointSet;
use condyle_diagnostics::Error;
use std::collections::HashMap;

/// One point of one person in one frame, in the file's unit and axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub frame: usize,
    pub label: usize,
    pub at: [f64; 3],
    /// From 0; 1 where it is not said.
    pub confidence: f64,
}

/// Name, place and confidence of a point that was seen.
pub(super) type Named = (String, [f64; 3], Option<f64>);

/// One person in a frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Person {
    /// What the file calls them.
    pub name: Option<String>,
    /// The points that were seen.
    pub points: Vec<Named>,
}

impl Person {
    /// The middle of the points.
    fn middle(&self) -> Option<[f64; 3]> {
        let seen = self.points.iter().filter(|(_, _, c)| c.is_none_or(|c| c > 0.0));
        let seen: Vec<&[f64; 3]> = seen.map(|(_, at, _)| at).collect();
        let mean = |axis: usize| seen.iter().map(|at| at[axis]).sum::<f64>() / seen.len() as f64;
        (!seen.is_empty()).then(|| [mean(0), mean(1), mean(2)])
    }
}

/// All that a file has.
#[derive(Debug, Default)]
pub(super) struct Raw {
    /// The people, in the order in which they appear.
    pub people: Vec<String>,
    /// The person and the name of each label.
    pub labels: Vec<(usize, String)>,
    places: HashMap<(usize, String), usize>,
    /// Where each person was seen last.
    last: Vec<Option<[f64; 3]>>,
    /// Seconds, or numbers of frames; as many as frames.
    pub times: Vec<f64>,
    /// Whether `times` are seconds.
    pub in_seconds: bool,
    /// Frames per second, where the file says it.
    pub rate: Option<f64>,
    pub points: Vec<Point>,
    /// Whether the file says how sure any point is.
    pub weighed: bool,
    /// The set that points without names are taken from.
    pub set: Option<&'static KeypointSet>,
}

impl Raw {
    /// Adds a frame; people without names are those who were nearest in the frames before.
    ///
    /// # Errors
    /// `keypoints/time` where time goes back or is none.
    pub(super) fn add_frame(&mut self, time: f64, people: Vec<Person>) -> Result<(), Error> {
        let frame = self.times.len();
        if !time.is_finite() || self.times.last().is_some_and(|last| time < *last) {
            let last = self.times.last().copied().unwrap_or_default();
            let message = format!("frame {frame}: the time goes from {last} to {time}");
            return Err(Error::new("keypoints/time", message)
                .with_help("frames must be in the order of their times"));
        }
        self.times.push(time);
        let who = self.whose(&people);
        for (person, who) in people.into_iter().zip(who) {
            self.last[who] = person.middle().or(self.last[who]);
            for (name, at, confidence) in person.points {
                self.weighed |= confidence.is_some();
                let label = self.label(who, name);
                let confidence = confidence.unwrap_or(1.0);
                self.points.push(Point { frame, label, at, confidence });
            }
        }
        Ok(())
    }

    /// The index of a person by name.
    fn person(&mut self, name: &str) -> usize {
        if let Some(known) = self.people.iter().position(|known| known == name) {
            return known;
        }
        self.people.push(name.to_owned());
        self.last.push(None);
        self.people.len() - 1
    }

    /// Who each person of a frame is.
    fn whose(&mut self, people: &[Person]) -> Vec<usize> {
        let mut who: Vec<Option<usize>> = people
            .iter()
            .map(|person| person.name.as_ref().map(|name| self.person(name)))
            .collect();
        // The nearest two first.
        let mut pairs: Vec<(f64, usize, usize)> = vec![];
        for (index, person) in people.iter().enumerate().filter(|(i, _)| who[*i].is_none()) {
            let Some(at) = person.middle() else { continue };
            for (known, last) in self.last.iter().enumerate() {
                let Some(last) = last else { continue };
                let off: f64 = (0..3).map(|axis| (at[axis] - last[axis]).powi(2)).sum();
                pairs.push((off, index, known));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, index, known) in pairs {
            if who[index].is_none() && !who.contains(&Some(known)) {
                who[index] = Some(known);
            }
        }
        let mut next = self.people.len();
        who.into_iter()
            .map(|known| {
                known.unwrap_or_else(|| {
                    next += 1;
                    self.person(&format!("person{next}"))
                })
            })
            .collect()
    }

    fn label(&mut self, who: usize, name: String) -> usize {
        let next = self.labels.len();
        let place = *self.places.entry((who, name.clone())).or_insert(next);
        if place == next {
            self.labels.push((who, name));
        }
        place
    }

    /// The names of so many points of a list without names.
    ///
    /// # Errors
    /// `keypoints/set` where no set has so many.
    pub(super) fn names_of(&mut self, count: usize) -> Result<&'static [&'static str], Error> {
        if let Some(set) = self.set.filter(|set| set.points.len() == count) {
            return Ok(set.points);
        }
        let set = KeypointSet::of_size(count).ok_or_else(|| {
            let message = format!("{count} points without names are of no known set");
            let known =
                super::SETS.iter().map(|set| format!("{} of {}", set.points.len(), set.name));
            let known: Vec<String> = known.collect();
            Error::new("keypoints/set", message)
                .with_help(format!("known are: {}", known.join(", ")))
        })?;
        self.set = Some(set);
        Ok(set.points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn person(x: f64) -> Person {
        Person { name: None, points: vec![("nose".into(), [x, 0.0, 0.0], None)] }
    }

    #[test]
    fn people_without_names_are_those_who_were_nearest() {
        let mut raw = Raw::default();
        raw.add_frame(0.0, vec![person(0.0), person(2.0)]).unwrap();
        // The order changes, and one is gone for a while.
        raw.add_frame(1.0, vec![person(1.9), person(0.1)]).unwrap();
        raw.add_frame(2.0, vec![person(1.8)]).unwrap();
        raw.add_frame(3.0, vec![person(0.2), person(1.7)]).unwrap();
        assert_eq!(raw.people, ["person1", "person2"]);
        let of_second = raw.points.iter().filter(|p| raw.labels[p.label].0 == 1);
        assert_eq!(of_second.map(|p| p.at[0]).collect::<Vec<_>>(), [2.0, 1.9, 1.8, 1.7]);
        assert!(raw.add_frame(2.0, vec![]).is_err());
    }
}
