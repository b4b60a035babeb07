//! What is asked of everything that evaluates models.

use super::backend::Backend;
use super::{TREES, difference, grow, naive};
use condyle_math::Affine;
use condyle_model::{Mode, Model};
use std::sync::OnceLock;

/// Asserts that a backend gives the poses of the naive evaluator, the same in both modes where
/// coordinates are legal, and finite ones whatever is asked.
///
/// Each model is posed in eight postures by one call, so that a backend with lanes has another one
/// in each.
pub(crate) fn conforms(backend: &impl Backend) {
    equals_the_naive_evaluator(backend);
    leaves_legal_coordinates(backend);
    stays_finite(backend, 16);
}

/// Postures of each tree.
const POSTURES: usize = 8;

/// A random model, postures of it, and what the naive evaluator makes of one of them.
struct Tree {
    model: Model,
    postures: Vec<Vec<f64>>,
    /// Which posture. It varies from tree to tree.
    tried: usize,
    /// Open and posed; `None` near a tangency of a contact.
    expected: [Option<Expected>; 2],
}

/// What the naive evaluator makes of a posture.
struct Expected {
    segments: Vec<Affine>,
    /// The effective numbers of each coordinate.
    coordinates: Vec<Vec<f64>>,
}

const MODES: [Mode; 2] = [Mode::Open, Mode::Posed];

/// The trees, grown once for all backends.
fn trees() -> &'static [Tree] {
    static TREES_GROWN: OnceLock<Vec<Tree>> = OnceLock::new();
    TREES_GROWN.get_or_init(|| (0..TREES).map(tree).collect())
}

fn tree(seed: u64) -> Tree {
    let (model, stored) = grow::random_model(seed);
    let mut dice = grow::Dice::new(seed ^ 0x1a9e5);
    let mut postures = vec![stored];
    postures.resize_with(POSTURES, || grow::posture(&model, &mut dice));
    let tried = seed as usize % POSTURES;
    let expected = MODES.map(|mode| {
        let twin = naive::Evaluator::new(&model, &postures[tried], mode);
        let segments = model.segment_ids().map(|id| twin.segment(id)).collect();
        let coordinates = model.coordinate_ids().map(|id| twin.coordinate(id)).collect();
        (!twin.doubtful.get()).then_some(Expected { segments, coordinates })
    });
    Tree { model, postures, tried, expected }
}

fn equals_the_naive_evaluator(backend: &impl Backend) {
    let mut doubtful = 0;
    for (seed, tree) in trees().iter().enumerate() {
        for (mode, expected) in MODES.into_iter().zip(&tree.expected) {
            let found = &backend.poses(&tree.model, mode, &tree.postures)[tree.tried];
            let Some(Expected { segments, coordinates }) = expected else {
                doubtful += 1;
                continue;
            };
            for ((id, found), &expected) in
                tree.model.segment_ids().zip(&found.segments).zip(segments)
            {
                let scale = 1.0 + expected.translation.norm();
                let off = difference(*found, expected);
                assert!(off < 1e-12 * scale, "seed {seed} {mode:?} {id:?}: {off}");
            }
            for (id, expected) in tree.model.coordinate_ids().zip(coordinates) {
                for (a, b) in found.effective[tree.model.stored_range(id)].iter().zip(expected) {
                    assert!(
                        (a - b).abs() < 1e-12 * (1.0 + b.abs()),
                        "seed {seed} {mode:?} {id:?}: {a} {b}"
                    );
                }
            }
        }
    }
    println!("{doubtful} poses with a contact near a tangency left out");
    assert!(doubtful < TREES / 10, "{doubtful} poses with a contact near a tangency");
}

fn leaves_legal_coordinates(backend: &impl Backend) {
    let mut legal = 0;
    for (seed, tree) in trees().iter().enumerate() {
        let model = &tree.model;
        let within = backend.poses(model, Mode::Posed, &tree.postures);
        let within: Vec<Vec<f64>> = within.into_iter().map(|pose| pose.effective).collect();
        let [open, posed] = MODES.map(|mode| backend.poses(model, mode, &within));
        for ((within, open), posed) in within.iter().zip(open).zip(posed) {
            // A limit may push a coordinate out of its range, or break another limit.
            let in_range = model.coordinate_ids().all(|id| {
                let coordinate = model.coordinate(id);
                let value = model.value(within, id);
                coordinate.follows.is_some() || coordinate.range.distance(value) >= 0.0
            });
            if in_range && open.rows.iter().all(|&row| row >= 0.0) {
                legal += 1;
                assert_eq!(open.segments, posed.segments, "seed {seed}");
                assert_eq!(open.effective, posed.effective, "seed {seed}");
            }
        }
    }
    let all = trees().len() * POSTURES;
    // Limits on what is measured between segments move nothing: many of these are broken.
    assert!(legal > all * 2 / 5, "only {legal} of {all} were legal");
}

/// Asserts that so many poses of each tree are finite, half of them of plausible numbers, half of
/// numbers of any size.
pub(crate) fn stays_finite(backend: &impl Backend, postures: usize) {
    let sizes = [0.0, -0.0, 1.0, 1e3, 1e12, 1e300, f64::INFINITY, f64::NAN, 1e-320];
    for (seed, tree) in trees().iter().enumerate() {
        let mut dice = grow::Dice::new(seed as u64 ^ 0x5eed);
        let asked = (0..postures).map(|number| {
            let any = |dice: &mut grow::Dice| {
                let size = if number % 2 == 0 { 3.0 } else { sizes[dice.below(sizes.len())] };
                if size.is_finite() { dice.within(size) } else { size }
            };
            tree.postures[0].iter().map(|_| any(&mut dice)).collect()
        });
        let asked: Vec<Vec<f64>> = asked.collect();
        for mode in MODES {
            for (pose, asked) in backend.poses(&tree.model, mode, &asked).iter().zip(&asked) {
                for (id, segment) in tree.model.segment_ids().zip(&pose.segments) {
                    let finite = segment.to_rows().iter().all(|x| x.is_finite());
                    assert!(finite, "seed {seed} {mode:?} {id:?}: {segment:?} at {asked:?}");
                }
                assert!(pose.effective.iter().all(|x| x.is_finite()), "seed {seed} {asked:?}");
            }
        }
    }
}

/// Asserts that two backends give the same numbers, to the last bit.
pub(crate) fn equals(backend: &impl Backend, other: &impl Backend) {
    for (seed, tree) in trees().iter().enumerate() {
        for mode in MODES {
            let [found, expected] = [
                backend.poses(&tree.model, mode, &tree.postures),
                other.poses(&tree.model, mode, &tree.postures),
            ];
            assert_eq!(found, expected, "seed {seed} {mode:?}");
        }
    }
}
