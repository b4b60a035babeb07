//! Recordings of virtual people, and the truth of each frame.

use super::dice::Dice;
use super::motion::{CROUCHES, Kind, RATE, hung, moments};
use super::person::landmark_frame;
use super::skin::Tissue;
use super::{Person, Skin};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_motion::{LengthUnit, Observed, Recording};

/// What the columns of a truth are: angles in radians, the centre of the knee in metres, as [`Take::truth`] has them.
pub const TRUTH_COLUMNS: [&str; 6] = ["flexion", "adduction", "rotation", "tx", "ty", "tz"];

/// One trial.
#[derive(Clone, Debug)]
pub struct Take {
    /// Its name, such as `s1_crouch_30_4`.
    pub name: String,
    /// What is done in it.
    pub kind: Kind,
    /// What cameras see.
    pub recording: Recording,
    /// Row by row what [`TRUTH_COLUMNS`] name: the angles of the bones in the order z, x, y and the place of the centre along the thigh's axes
    /// from the trochanter's marker, in the frames that landmarks give while the person stands. Angles are those about the axes: negative
    /// in flexion.
    pub truth: Vec<[f64; 6]>,
}

/// How many trials there are, and how markers are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trials {
    /// Gaits that are learned from.
    pub gaits: usize,
    /// Crouches of each variety that are learned from.
    pub crouches: usize,
    /// Gaits, and crouches of all varieties in turn, that nothing is learned from.
    pub unseen: [usize; 2],
    /// The standard deviation of white noise on each coordinate of each marker, in metres.
    pub noise: f64,
    /// What all that is random comes from.
    pub seed: u64,
}

impl Default for Trials {
    /// Those of Pronost et al. 2010: ten gaits and five crouches of six varieties, 30 000 frames; ten gaits and ten crouches beside them.
    /// Noise of 0.5 mm, as cameras of a laboratory have it (recalled).
    fn default() -> Self {
        Self { gaits: 10, crouches: 5, unseen: [10, 10], noise: 0.5e-3, seed: 1 }
    }
}

impl Trials {
    /// What a person does in the trials that are learned from, or in those that are not: kinds with the number of the repetition.
    #[must_use]
    pub fn wanted(&self, unseen: bool) -> Vec<(Kind, usize)> {
        let [gaits, crouches] = if unseen { self.unseen } else { [self.gaits, 0] };
        let gaits = (1..=gaits).map(|n| (Kind::Gait, n));
        let varied = (0..crouches).map(|n| (Kind::Crouch(CROUCHES[n % 6]), n / 6 + 1));
        let repeated = CROUCHES.iter().filter(|_| !unseen);
        let repeated =
            repeated.flat_map(|feet| (1..=self.crouches).map(|n| (Kind::Crouch(*feet), n)));
        gaits.chain(repeated).chain(varied).collect()
    }

    /// A standing trial, by which a user calibrates.
    #[must_use]
    pub fn standing(&self, person: &Person) -> Take {
        self.take(person, Kind::Standing, 0, false, Skin::Rigid)
    }

    /// One trial of a person. With and without artefact the same bones move, and noise is the same.
    ///
    /// ```
    /// use condyle_learn::study::{Kind, Person, Skin, Trials};
    /// let (trials, person) = (Trials::default(), Person::of_six(0, 1));
    /// let take = trials.take(&person, Kind::Crouch(30), 4, false, Skin::Moving);
    /// assert_eq!(take.name, "s1_crouch_30_4");
    /// assert!((800..1100).contains(&take.recording.frames()) && take.recording.labels.len() == 7);
    /// // While a person stands all angles are 0, and the centre is below the trochanter.
    /// let truth = trials.standing(&person).truth[0];
    /// assert!(truth[..3].iter().all(|angle| angle.abs() < 1e-12));
    /// assert!((truth[4] + person.thigh).abs() < 0.02);
    /// ```
    #[must_use]
    pub fn take(
        &self,
        person: &Person,
        kind: Kind,
        number: usize,
        unseen: bool,
        skin: Skin,
    ) -> Take {
        let (code, motion) = match kind {
            Kind::Standing => (0, "standing".to_owned()),
            Kind::Gait => (1000, "gait".to_owned()),
            Kind::Crouch(feet) => (2000 + u64::from(feet), format!("crouch_{feet}")),
        };
        let words = [person.index, code, number as u64, u64::from(unseen)];
        let mut dice = Dice::of(self.seed, &words);
        let mut shaken = Dice::of(self.seed ^ 0xa5a5, &words);
        let wander = Tissue::wander(&mut dice);
        let knee = person.knee.made();
        let all = moments(kind, person.depth, person.thigh, &mut dice);
        let parts = all.len().max(1) as f64;
        let rest = person.joint.rigid_inverse();
        let standing = landmark_frame([person.places[0], person.places[1], person.places[2]]);
        let parent = Affine::new(standing.linear, person.places[0]);
        let mut take = Take {
            name: format!(
                "{}_{}{motion}_{number}",
                person.name,
                if unseen { "unseen_" } else { "" }
            ),
            kind,
            recording: Recording {
                labels: Person::LABELS.map(str::to_owned).to_vec(),
                rate: RATE,
                units: LengthUnit::Millimetre,
                ..Recording::default()
            },
            truth: vec![],
        };
        for (frame, moment) in all.iter().enumerate() {
            let thigh = hung(moment, person.places[0]);
            // The shank's own frame coincides with the thigh's in extension.
            let shank_in_thigh = person.joint * knee.moved(moment.angles) * rest;
            let shank = thigh * shank_in_thigh;
            take.recording.times.push(frame as f64 / RATE);
            for (marker, place) in person.places.iter().enumerate() {
                let moved = match skin {
                    Skin::Rigid => Vec3::ZERO,
                    Skin::Moving => {
                        let [flexion, ..] = moment.angles;
                        person.tissue.moved(marker, flexion, moment.load, moment.since)
                            + wander.at(marker, frame as f64 / parts)
                    }
                };
                let bone = if marker < Person::ON_THIGH { thigh } else { shank };
                let noise = Vec3::new(shaken.normal(), shaken.normal(), shaken.normal());
                let seen = bone * (*place + moved) + noise * self.noise;
                take.recording.positions.push(Observed::from(seen.to_array()));
            }
            // Landmarks of the thigh and of the shank were at the same places while the person stood.
            let joint = parent.rigid_inverse() * shank_in_thigh * standing;
            let [x, y, z] = joint.translation.to_array();
            let [flexion, adduction, rotation] = angles(joint.linear);
            take.truth.push([flexion, adduction, rotation, x, y, z]);
        }
        take
    }
}

/// The angles of Rz(a)·Rx(b)·Ry(c): the middle row of the middle column is sin b.
fn angles(m: Mat3) -> [f64; 3] {
    [(-m.y.x).atan2(m.y.y), m.y.z.clamp(-1.0, 1.0).asin(), (-m.x.z).atan2(m.z.z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The truth of a linear knee is its law, whatever the markers' places are.
    #[test]
    fn the_truth_of_a_linear_knee_is_its_law() {
        let trials = Trials::default();
        for index in 0..2 {
            let person = Person::of_six(index, 3);
            let super::super::Knee::Linear(slopes) = person.knee else { panic!("a linear knee") };
            let start = trials.standing(&person).truth[0];
            for kind in [Kind::Gait, Kind::Crouch(120)] {
                for row in &trials.take(&person, kind, 1, false, Skin::Rigid).truth {
                    for axis in 0..3 {
                        let law: f64 = (0..3).map(|i| slopes[axis][i] * row[i]).sum();
                        assert!((row[3 + axis] - start[3 + axis] - law).abs() < 1e-12);
                    }
                }
            }
        }
    }

    /// Skin moves as the fluoroscopy of PMC8631460 has it: the cluster of the thigh by 18 mm or so, single markers by up to
    /// 40 (Cappozzo et al. 1996), and not while a person stands.
    #[test]
    fn skin_moves_by_published_sizes() {
        let trials = Trials { noise: 0.0, ..Trials::default() };
        let mut largest = [0.0f64; 6];
        for index in 0..6 {
            let person = Person::of_six(index, 1);
            let [rigid, moving] = [Skin::Rigid, Skin::Moving]
                .map(|skin| trials.take(&person, Kind::Crouch(60), 1, false, skin));
            assert_eq!(rigid.truth, moving.truth, "the bones are the same");
            let pairs = rigid.recording.positions.iter().zip(&moving.recording.positions);
            let apart: Vec<f64> = pairs
                .map(|(a, b)| {
                    let [a, b] = [a, b].map(|p| Vec3::from(p.position().unwrap()));
                    (a - b).norm()
                })
                .collect();
            largest[index] = apart.iter().copied().fold(0.0, f64::max);
            assert!(apart[..7].iter().all(|d| *d < 0.006), "nearly none at the start");
        }
        assert!(largest.iter().all(|d| (0.012..0.045).contains(d)), "{largest:?}");
    }

    /// 30 000 frames of each person, as Pronost et al. 2010 say.
    #[test]
    fn there_are_thirty_thousand_frames() {
        let trials = Trials::default();
        assert_eq!(trials.wanted(false).len(), 40);
        assert_eq!(trials.wanted(true).len(), 20);
        let person = Person::of_six(4, 1);
        let frames: usize = trials
            .wanted(false)
            .into_iter()
            .map(|(kind, number)| {
                trials.take(&person, kind, number, false, Skin::Rigid).truth.len()
            })
            .sum();
        assert!((29_000..31_500).contains(&frames), "{frames}");
    }
}
