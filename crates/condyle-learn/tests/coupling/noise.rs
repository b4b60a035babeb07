//! 200 repetitions each: coverage of intervals, acceptance of laws and of noise.

use super::trials::{CONSTANT, Dice, SLOPES, Trials};
use condyle_learn::coupling::{Settings, learn};

const REPETITIONS: u64 = 200;

const REAL: Trials = Trials {
    count: 12,
    frames: 100,
    effect: 0.003,
    noise: 0.004,
    memory: 0.9,
    unrelated: false,
    wandering: false,
};

/// How often the interval of the constant and of each slope holds the truth, and how often the law is accepted.
fn covered(trials: &Trials, from: u64) -> ([f64; 4], f64) {
    let (mut held, mut accepted) = ([0u32; 4], 0u32);
    for repetition in 0..REPETITIONS {
        let samples = trials.make(&mut Dice::new(from + repetition));
        let laws = learn(&samples, &[], &[0, 1, 2], &[3], &Settings::default()).unwrap();
        let law = &laws.laws[0];
        let truth = [CONSTANT, SLOPES[0], SLOPES[1], SLOPES[2]];
        for (count, (truth, [low, high])) in held.iter_mut().zip(truth.iter().zip(&law.ci95)) {
            *count += u32::from((low..=high).contains(&truth));
        }
        accepted += u32::from(law.accepted());
    }
    let share = |count: u32| f64::from(count) / REPETITIONS as f64;
    (held.map(share), share(accepted))
}

/// Issue: between 90 and 99 %, of frames that follow each other and trials that differ.
#[test]
fn intervals_hold_the_truth() {
    let few = Trials { count: 5, ..REAL };
    let strong = Trials { effect: 0.01, ..REAL };
    let long = Trials { count: 30, frames: 40, memory: 0.97, ..REAL };
    for (name, trials) in [("12", &REAL), ("few", &few), ("strong", &strong), ("long", &long)] {
        let (shares, accepted) = covered(trials, 1000);
        println!("{name}: {shares:?}, accepted {accepted}");
        assert!(shares.iter().all(|share| (0.90..=0.99).contains(share)), "{name}: {shares:?}");
        // The law moves the centre by 25 mm in a cycle, the noise by 4.
        assert!(accepted > 0.8, "{name}: {accepted}");
    }
}

/// Issue: noise is accepted in under 5 %, and by the criterion of 2010 nearly always.
#[test]
fn noise_is_not_accepted_but_by_the_criterion_of_2010() {
    for (wandering, count, effect) in [
        (false, 12, 0.003),
        (true, 12, 0.003),
        (true, 6, 0.003),
        (true, 20, 0.02),
        (false, 6, 0.01),
    ] {
        let trials = Trials { unrelated: true, wandering, count, effect, ..REAL };
        let (mut accepted, mut valid, mut signed) = (0, 0, 0);
        for repetition in 0..REPETITIONS {
            let samples = trials.make(&mut Dice::new(5000 + repetition));
            let laws = learn(&samples, &[], &[0, 1, 2], &[3], &Settings::default()).unwrap();
            let law = &laws.laws[0];
            accepted += u64::from(law.accepted());
            let validity = law.validity.unwrap();
            valid += u64::from(validity.absolute());
            signed += u64::from(validity.signed());
        }
        println!("wandering {wandering} {count}: accepted {accepted}, |E| {valid}, E {signed}");
        assert!(accepted * 20 < REPETITIONS, "{accepted} of {REPETITIONS}");
        assert!(valid * 100 >= REPETITIONS * 95, "{valid}");
        // The constant is negative: its sign makes the other reading false for any law.
        assert_eq!(signed, 0);
    }
}
