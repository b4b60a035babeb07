//! Arms of a comparison on trials whose truth is known: what an arm can be, it leaves nothing of; what it cannot be, it leaves.

use condyle::learn::arms::{Arm, Centre, Leg, Sizes};
use condyle::learn::calibration::FreeJoint;
use condyle::learn::coupling::{Groups, LawFunction, ScaleRule};
use condyle::learning::arms::{
    Compared, Gain, How, Person, Question, Residuals, Trial, compare, gains, groups, markdown,
};
use condyle::math::function::FunctionOfSeveral;
use condyle::model::component::Region;
use condyle::tracking::Request;
use condyle::{Mode, Model, Motion, Observed, Recording};

/// The markers of a person who stands, in metres: y up, x forward, z right; a thigh of `length`, a knee of `width`.
fn standing(length: f64, width: f64) -> Recording {
    let knee = 0.48;
    let markers = [
        ("RGT", [0.02, knee + length, 0.17]),
        ("RLFE", [0.01, knee, 0.05 + width]),
        ("RMFE", [0.00, knee - 0.01, 0.05]),
        ("RTT", [0.06, 0.41, 0.10]),
        ("RFH", [-0.03, 0.42, 0.15]),
        ("RMEDMAL", [-0.01, 0.08, 0.06]),
        ("RLATMAL", [-0.03, 0.07, 0.13]),
    ];
    Recording {
        labels: markers.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rate: 100.0,
        times: vec![0.0, 0.01],
        positions: (0..2)
            .flat_map(|_| markers.iter().map(|(_, place)| Observed::from(*place)))
            .collect(),
        ..Recording::default()
    }
}

fn leg(length: f64, width: f64) -> (Leg, Sizes) {
    let joint = FreeJoint::knee_pronost2010();
    let standing = standing(length, width);
    let model = joint.model(&standing).unwrap();
    (Leg::of(&model, "knee_r").unwrap(), Sizes::of(&joint, &standing).unwrap())
}

/// A law as large as those of Table 1 of Pronost et al. 2010, through where the knee is while the person stands.
fn law(leg: &Leg) -> Centre {
    let slopes = [[0.035, -0.01, 0.006], [0.008, 0.012, -0.004], [0.004, 0.006, 0.015]];
    let at = leg.standing();
    let of = |axis: usize| {
        let (slopes, intercept) = (slopes[axis].to_vec(), at[axis]);
        LawFunction::Several(FunctionOfSeveral::Linear { slopes, intercept })
    };
    let region = Region {
        low: vec![-3.0; 3],
        high: vec![3.0; 3],
        centre: vec![0.0; 3],
        inverse: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        distance: 10.0,
    };
    Centre { laws: [of(0), of(1), of(2)], mean: at, best: None, region, frames: 0 }
}

/// A motion of an arm that moves whatever is free in it, as markers see it.
fn recorded(leg: &Leg, arm: &Model, phase: f64, flexion: f64) -> Recording {
    let mut motion = Motion::default();
    for frame in 0..60 {
        let t = 0.1 * f64::from(frame) + phase;
        let mut stored = arm.defaults();
        let moves = [
            -flexion * (0.5 + 0.45 * (t + 0.6).sin()),
            0.06 * (1.9 * t).sin(),
            0.1 * (2.3 * t).cos(),
            0.01 * (1.3 * t).sin(),
            0.01 * (1.7 * t).cos(),
            0.01 * (2.9 * t).sin(),
        ];
        for (id, moved) in leg.coordinates().into_iter().zip(moves) {
            let coordinate = arm.coordinate(id);
            if !coordinate.locked && coordinate.follows.is_none() {
                *arm.value_mut(&mut stored, id) += moved;
            }
        }
        for (name, value) in
            [("thigh_r_tx", 0.01 * f64::from(frame)), ("thigh_r_rz", 0.3 * t.sin())]
        {
            let id = arm.find_coordinate(name).unwrap();
            *arm.value_mut(&mut stored, id) += value;
        }
        motion.times.push(0.01 * f64::from(frame));
        motion.frames.push(stored);
    }
    motion.virtual_markers(arm, Mode::Open).unwrap()
}

fn left(leg: &Leg, arm: Arm, centre: &Centre, recording: &Recording) -> f64 {
    let model = leg.arm(arm, Some(centre)).unwrap();
    let residuals = Residuals::of(leg, &model, recording, &Request::default()).unwrap();
    assert_eq!((residuals.frames(), residuals.unseen(), residuals.unsolved()), (60, 0, 0));
    assert!((residuals.sum() / 60.0 - residuals.mean()).abs() < 1e-15);
    assert!(residuals.most() >= residuals.mean());
    residuals.mean()
}

#[test]
fn an_arm_leaves_nothing_of_a_knee_that_it_can_be() {
    let (leg, _) = leg(0.42, 0.09);
    let centre = law(&leg);
    for truth in Arm::ALL {
        let model = leg.arm(truth, Some(&centre)).unwrap();
        let recording = recorded(&leg, &model, 0.3, 1.6);
        for arm in Arm::ALL {
            let left = left(&leg, arm, &centre, &recording);
            // A hinge is a fixed centre with two angles at rest; here the constant of the law is where the hinge is, and the free
            // joint can be all of them.
            let can = match (truth, arm) {
                (_, Arm::Free) => true,
                (truth, arm) if truth == arm => true,
                (Arm::Hinge | Arm::Fixed, Arm::FixedC4 | Arm::Fixed)
                | (Arm::FixedC4, Arm::Fixed) => true,
                _ => false,
            };
            match can {
                true => assert!(left < 1e-6, "{truth:?} by {arm:?}: {left}"),
                false => assert!(left > 2e-4, "{truth:?} by {arm:?}: {left}"),
            }
        }
    }
}

#[test]
fn a_frame_in_which_a_segment_shows_two_markers_is_counted_for_no_arm() {
    let (leg, _) = leg(0.42, 0.09);
    let mut recording = recorded(&leg, leg.model(), 0.0, 1.0);
    let width = recording.labels.len();
    let thigh = recording.marker("RGT").unwrap();
    for frame in 10..15 {
        recording.positions[frame * width + thigh] = Observed::MISSING;
    }
    // The shank has four markers; without one of them it is still seen.
    let shank = recording.marker("RFH").unwrap();
    recording.positions[20 * width + shank] = Observed::MISSING;
    for arm in [Arm::Hinge, Arm::Free] {
        let model = leg.arm(arm, None).unwrap();
        let residuals = Residuals::of(&leg, &model, &recording, &Request::default()).unwrap();
        assert_eq!((residuals.frames(), residuals.unseen()), (55, 5), "{arm:?}");
    }
}

fn person(name: &str, length: f64, width: f64, true_knee: &dyn Fn(&Leg) -> Model) -> Person {
    let (leg, sizes) = leg(length, width);
    let knee = true_knee(&leg);
    let trials = [("gait_1", 0.9), ("gait_2", 1.0), ("crouch_1", 1.9), ("crouch_2", 2.0)];
    let trials = trials.iter().enumerate().map(|(at, (trial, flexion))| Trial {
        name: (*trial).to_owned(),
        groups: Groups::of_name(trial),
        recording: recorded(&leg, &knee, at as f64, *flexion),
    });
    let trials = trials.collect();
    Person { name: name.to_owned(), leg, sizes: Some(sizes), trials }
}

fn of(all: &[Compared], question: Question) -> Vec<&Compared> {
    all.iter().filter(|one| one.question == question).collect()
}

#[test]
fn a_learned_centre_is_nothing_off_on_trials_that_no_law_saw() {
    let knee = |leg: &Leg| leg.arm(Arm::Learned, Some(&law(leg))).unwrap();
    let persons = [person("Anna", 0.42, 0.09, &knee), person("Bo", 0.44, 0.10, &knee)];
    let compared = compare(&persons, &How::default(), &mut |_| {}).unwrap();
    assert!(compared.warnings.is_empty(), "{:?}", compared.warnings);
    let all = compared.value;
    // Two persons of four trials, and every question can be asked.
    for question in Question::ALL {
        assert_eq!(of(&all, question).len(), 8, "{question:?}");
    }
    for question in [Question::OtherTrials, Question::SameMotion, Question::OtherMotions] {
        for one in of(&all, question) {
            let own = &persons[one.person].trials[one.trial].name;
            assert!(!one.learned_from.contains(own), "{question:?} {own}");
            let expected = match question {
                Question::OtherTrials => 3,
                Question::SameMotion => 1,
                _ => 2,
            };
            assert_eq!(one.learned_from.len(), expected);
            // A linear knee holds everywhere; the law of three angles comes back from any trial.
            assert!(one.of(Arm::Learned).unwrap().mean() < 1e-5, "{question:?} {own}");
            assert!(one.of(Arm::Fixed).unwrap().mean() > 1e-3);
            assert!(one.of(Arm::Free).unwrap().mean() < 1e-6);
        }
    }
    let groups = groups(&persons, &all);
    let gains = gains(&groups);
    let centre = gains
        .iter()
        .find(|g| {
            g.question == Question::OtherTrials && g.motion == "crouch" && g.gain == Gain::Centre
        })
        .unwrap();
    assert_eq!(centre.shares.len(), 2);
    assert!(centre.mean() > 0.99, "{centre:?}");
    // From hinge to learned is both gains one after another.
    for group in &groups {
        let both = 1.0 - (1.0 - group.gain(Gain::Rotation)) * (1.0 - group.gain(Gain::Centre));
        assert!((group.gain(Gain::OverHinge) - both).abs() < 1e-12);
    }
    let table = markdown(&persons, &all);
    assert!(table.contains("| Anna | crouch | 2 | learned | 3 |"), "{table}");
}

/// A person whose knee is another's, larger: coefficients by s₁ along y, by s₂ along z, by their mean along x. Scaled per axis the
/// law is the truth; by one scalar it is off where s₁ and s₂ differ.
#[test]
fn a_law_scaled_per_axis_is_that_of_a_person_who_is_larger_per_axis() {
    let (one, from) = leg(0.42, 0.09);
    let base = law(&one);
    let knee = |own: &Leg| {
        let is_other = (own.standing()[1] - one.standing()[1]).abs() > 1e-9;
        let (_, to) = leg(0.46, 0.08);
        let factors = from.ratios_to(to).factors(ScaleRule::PerAxis);
        let centre = if is_other { base.scaled(factors) } else { base.clone() };
        own.arm(Arm::Learned, Some(&centre)).unwrap()
    };
    let persons = [person("Anna", 0.42, 0.09, &knee), person("Bo", 0.46, 0.08, &knee)];
    let all = compare(&persons, &How::default(), &mut |_| {}).unwrap().value;
    // Only from the first to the second: the mean of s₁ and s₂ is not undone by the mean of 1/s₁ and 1/s₂.
    let second = |question| of(&all, question).into_iter().filter(|one| one.person == 1);
    for one in second(Question::OtherPersonsPerAxis) {
        assert!(one.of(Arm::Learned).unwrap().mean() < 1e-5);
        assert_eq!(one.learned_from.len(), 4);
    }
    for one in second(Question::OtherPersons) {
        assert!(one.of(Arm::Learned).unwrap().mean() > 1e-3);
    }
    assert_eq!(second(Question::OtherPersonsPerAxis).count(), 4);
}

#[test]
fn of_one_trial_blocks_of_time_are_left_out() {
    let (leg, _) = leg(0.42, 0.09);
    let knee = leg.arm(Arm::Learned, Some(&law(&leg))).unwrap();
    let recording = recorded(&leg, &knee, 0.0, 1.5);
    let trial = Trial { name: "squat".into(), groups: Groups::of_name("squat"), recording };
    let person = Person { name: "Anna".into(), leg, sizes: None, trials: vec![trial] };
    let all = compare(&[person], &How::default(), &mut |_| {}).unwrap().value;
    let [one] = &all[..] else { panic!("{} comparisons", all.len()) };
    assert_eq!((one.question, one.parts.len()), (Question::SameMotion, 8));
    // Eight blocks of 60 frames, each frame once; no block is among the frames of its law.
    for (k, part) in one.parts.iter().enumerate() {
        assert_eq!(part.frames, 60 * k / 8..60 * (k + 1) / 8);
        assert_eq!(part.centre.frames, 60 - part.frames.len());
    }
    for (arm, residuals) in &one.arms {
        assert_eq!(residuals.frames(), 60, "{arm:?}");
    }
    assert!(one.of(Arm::Learned).unwrap().mean() < 1e-5);
}

/// A person whose knee is a fixed centre, off from where it is while the person stands: the best constant finds it from markers.
#[test]
fn the_best_constant_centre_is_the_fixed_centre_that_there_is() {
    let off = [0.012, -0.02, 0.008];
    let knee = |leg: &Leg| {
        let place = [0, 1, 2].map(|axis| leg.standing()[axis] + off[axis]);
        let centre = Centre { mean: place, ..law(leg) };
        leg.arm(Arm::Fixed, Some(&centre)).unwrap()
    };
    let persons = [person("Anna", 0.42, 0.09, &knee)];
    let all = compare(&persons, &How::default(), &mut |_| {}).unwrap().value;
    for one in &all {
        let best = one.parts[0].centre.best.unwrap();
        for axis in 0..3 {
            let truth = persons[0].leg.standing()[axis] + off[axis];
            // The search stops at a tenth of a millimetre.
            assert!((best[axis] - truth).abs() < 1e-4, "{:?}: {best:?}", one.question);
        }
        assert!(one.of(Arm::FixedBest).unwrap().mean() < 1e-4);
        assert!(one.of(Arm::Hinge).unwrap().mean() > 1e-3);
    }
}
