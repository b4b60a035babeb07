//! The solver against a slow reference solver, against the KKT conditions, and against programs
//! with a known solution.

mod common;

use common::{Instance, Random, assert_optimal};
use condyle_solve::quadratic::{BoundState, Constraint, QuadraticProgram, Status, Workspace};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const FREE: f64 = f64::INFINITY;

#[test]
fn projection_onto_the_simplex() {
    // Sort descending, largest k with x_k > τ = (x_1 + .. + x_k - 1) / k; the projection is
    // max(x - τ, 0). For (0.5, 0.9, -0.3): τ = (0.9 + 0.5 - 1) / 2 = 0.2.
    let hessian = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let program = QuadraticProgram::bounded(&hessian, &[-0.5, -0.9, 0.3], &[0.0; 3], &[FREE; 3])
        .with_equalities(&[1.0; 3], &[1.0]);
    let mut workspace = Workspace::new(3, 1, 0);
    let solution = workspace.solve(&program);
    for (x, expected) in solution.d().iter().zip([0.3, 0.7, 0.0]) {
        assert!((x - expected).abs() < 1e-15);
    }
    // H d + g = d - x = -τ where free, and z = 0.3 + τ at the bound.
    assert!((solution.equality_multipliers()[0] + 0.2).abs() < 1e-15);
    assert!((solution.bound_multipliers()[2] - 0.5).abs() < 1e-15);
    assert_eq!(solution.bounds(), [BoundState::Free, BoundState::Free, BoundState::Lower]);
}

#[test]
fn conflicts_are_named() {
    let hessian = [1.0, 0.0, 0.0, 1.0];
    let solve = |lower: &[f64], upper: &[f64], c: (&[f64], &[f64]), g: (&[f64], &[f64])| {
        let program = QuadraticProgram::bounded(&hessian, &[0.3, -0.2], lower, upper)
            .with_equalities(c.0, c.1)
            .with_inequalities(g.0, g.1);
        let mut workspace = Workspace::new(2, c.1.len(), g.1.len());
        let solution = workspace.solve(&program);
        assert_eq!(solution.status(), Status::Infeasible);
        let mut conflict = solution.conflict().to_vec();
        conflict.sort_by_key(|c| match *c {
            Constraint::Lower(i) => (0, i),
            Constraint::Upper(i) => (1, i),
            Constraint::Equality(k) => (2, k),
            Constraint::Inequality(k) => (3, k),
        });
        conflict
    };
    use Constraint::{Equality, Inequality, Lower, Upper};
    let (none, low, high) = ((&[][..], &[][..]), [-FREE; 2], [FREE; 2]);
    assert_eq!(solve(&[0.0, 2.0], &[1.0; 2], none, none), [Lower(1), Upper(1)]);
    assert_eq!(solve(&[0.0, f64::NAN], &[1.0; 2], none, none), [Lower(1), Upper(1)]);
    // d₀ + d₁ ≥ 3 with d ≤ 1; the second row, d₀ ≥ -5, is not part of the conflict.
    assert_eq!(
        solve(&low, &[1.0; 2], none, (&[1.0, 1.0, 1.0, 0.0], &[3.0, -5.0])),
        [Upper(0), Upper(1), Inequality(0)]
    );
    // d₀ = 1, d₁ = 1, d₀ - d₁ = 0, d₀ + d₁ = 3: the third is redundant, the fourth is not.
    assert_eq!(
        solve(
            &low,
            &high,
            (&[1.0, 0.0, 0.0, 1.0, 1.0, -1.0, 1.0, 1.0], &[1.0, 1.0, 0.0, 3.0]),
            none
        ),
        [Equality(0), Equality(1), Equality(3)]
    );
    // A variable fixed at 1 against 2 d₀ = 3, and against 2 d₀ ≥ 3.
    let fixed = ([1.0, -FREE], [1.0, FREE]);
    assert_eq!(solve(&fixed.0, &fixed.1, (&[2.0, 0.0], &[3.0]), none), [Lower(0), Equality(0)]);
    assert_eq!(solve(&fixed.0, &fixed.1, none, (&[2.0, 0.0], &[3.0])), [Lower(0), Inequality(0)]);
    // Rows of zeros: 0 = 1, 0 ≥ 1, and d₀ ≥ ∞.
    assert_eq!(solve(&low, &high, (&[0.0, 0.0], &[1.0]), none), [Equality(0)]);
    assert_eq!(solve(&low, &high, none, (&[0.0, 0.0], &[1.0])), [Inequality(0)]);
    assert_eq!(solve(&low, &high, none, (&[1.0, 0.0], &[FREE])), [Inequality(0)]);
}

#[test]
fn a_row_of_rounding_noise_is_no_constraint() {
    // A planar loop in space: the third row is zero except for rounding, and taken literally it
    // would require d₁ = 3. The first row alone gives d = (1, 0).
    let hessian = [1.0, 0.0, 0.0, 1.0];
    let program = QuadraticProgram::bounded(&hessian, &[0.0; 2], &[-FREE; 2], &[FREE; 2])
        .with_equalities(&[1.0, 0.0, 2.0, 0.0, 0.0, 1e-17], &[1.0, 2.0, 3e-17]);
    let mut workspace = Workspace::new(2, 3, 0);
    let solution = workspace.solve(&program);
    assert_eq!(solution.status(), Status::Solved);
    assert!((solution.d()[0] - 1.0).abs() < 1e-15 && solution.d()[1].abs() < 1e-15);
    assert_eq!(solution.equality_multipliers()[1..], [0.0, 0.0]);
}

#[test]
fn what_cannot_be_solved_is_said() {
    let singular = [1.0, 0.0, 1.0, 1.0]; // pivot of variable 1: 1 - 1·1 = 0
    let (low, high) = ([-FREE; 2], [FREE; 2]);
    let mut workspace = Workspace::new(2, 0, 0);
    let mut status = |hessian: &[f64], gradient: &[f64], low: &[f64]| {
        workspace.solve(&QuadraticProgram::bounded(hessian, gradient, low, &high)).status()
    };
    assert_eq!(status(&singular, &[1.0; 2], &low), Status::NotPositiveDefinite { variable: 1 });
    assert_eq!(
        status(&[f64::NAN; 4], &[1.0; 2], &low),
        Status::NotPositiveDefinite { variable: 0 }
    );
    assert_eq!(status(&[1.0, 0.0, 0.0, 1.0], &[f64::NAN, 1.0], &low), Status::NotFinite);

    let identity = [1.0, 0.0, 0.0, 1.0];
    let program = QuadraticProgram::bounded(&identity, &[0.0; 2], &low, &high);
    let mut workspace = Workspace::new(2, 1, 0);
    let mut status = |rows: &[f64], values: &[f64]| {
        workspace.solve(&program.with_equalities(rows, values)).status()
    };
    assert_eq!(status(&[f64::NAN, 1.0], &[1.0]), Status::NotFinite);
    assert_eq!(status(&[1.0, 1.0], &[FREE]), Status::NotFinite);
    let mut workspace = Workspace::new(2, 0, 1);
    let mut status = |rows: &[f64], values: &[f64]| {
        workspace.solve(&program.with_inequalities(rows, values)).status()
    };
    assert_eq!(status(&[f64::NAN, 1.0], &[1.0]), Status::NotFinite);
    assert_eq!(status(&[1.0, 1.0], &[f64::NAN]), Status::NotFinite);
    assert_eq!(status(&[1.0, 1.0], &[-FREE]), Status::Solved);
}

#[test]
fn a_variable_held_by_its_bounds_needs_no_curvature() {
    // H = [1 1; 1 1] is singular, but with d₁ fixed at 2 the objective is ½ d₀² + 2 d₀ - d₀.
    let program =
        QuadraticProgram::bounded(&[1.0, 0.0, 1.0, 1.0], &[-1.0, 0.0], &[-FREE, 2.0], &[FREE, 2.0]);
    let mut workspace = Workspace::new(2, 0, 0);
    let solution = workspace.solve(&program);
    assert_eq!(solution.d(), [-1.0, 2.0]);
    assert_eq!(solution.bounds()[1], BoundState::Fixed);
    assert_eq!(solution.bound_multipliers(), [0.0, 1.0]); // H d + g = (-1 + 2 - 1, -1 + 2)
}

#[test]
#[should_panic(expected = "gradient has 1 numbers, the workspace 2")]
fn a_program_of_another_shape_is_refused() {
    Workspace::new(2, 0, 0).solve(&QuadraticProgram::bounded(&[1.0; 4], &[1.0], &[0.0], &[1.0]));
}

#[test]
fn no_unknowns() {
    let program = QuadraticProgram::bounded(&[], &[], &[], &[]);
    assert_eq!(Workspace::new(0, 0, 0).solve(&program).status(), Status::Solved);
    // 0 ≥ 1
    let program = program.with_inequalities(&[], &[1.0]);
    assert_eq!(Workspace::new(0, 0, 1).solve(&program).status(), Status::Infeasible);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        failure_persistence: None,
        // The same cases in every run.
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    /// Small integers make vertices, duplicates, ties and exact infeasibility common.
    #[test]
    fn agrees_with_the_enumeration_of_active_sets(
        seed in any::<u64>(), n in 1_usize..=5, equalities in 0_usize..=2, inequalities in 0_usize..=3,
        damping in prop::sample::select(vec![1.0, 0.125, 1e-8]),
    ) {
        let instance =
            Instance::integers(&mut Random(seed), n, equalities, inequalities, damping);
        let mut workspace = instance.workspace();
        let expected = instance.enumerate();
        for start in ["cold", "warm"] {
            let solution = workspace.solve(&instance.program());
            let Some((d, objective)) = &expected else {
                prop_assert_eq!(solution.status(), Status::Infeasible, "{}", start);
                prop_assert!(!instance.conflict_is_feasible(solution.conflict()), "{}", start);
                continue;
            };
            assert_optimal(&instance, solution);
            let value = solution.objective(&instance.program());
            // The reference solves by elimination: error about 1e-16 / damping, here within 1e-7.
            prop_assert!((value - objective).abs() <= 1e-7 * (1.0 + objective.abs()), "{}", start);
            if damping > 0.1 {
                for (x, expected) in solution.d().iter().zip(d) {
                    prop_assert!((x - expected).abs() <= 1e-10 * (1.0 + expected.abs()));
                }
            }
        }
    }

    /// The KKT conditions determine the minimiser, for any size.
    #[test]
    fn satisfies_the_optimality_conditions(
        seed in any::<u64>(), n in 1_usize..=40, equalities in 0_usize..=4,
        inequalities in 0_usize..=10,
        damping in prop::sample::select(vec![1.0, 1e-3, 1e-8]),
    ) {
        let random = &mut Random(seed);
        let instance = Instance::feasible(random, n, equalities, inequalities, damping);
        let mut workspace = instance.workspace();
        assert_optimal(&instance, workspace.solve(&instance.program()));
        // Warm, from its own active set and from that of an unrelated program.
        assert_optimal(&instance, workspace.solve(&instance.program()));
        let other = Instance::feasible(random, n, equalities, inequalities, 1.0);
        workspace.resize(n, other.equality_values.len(), other.inequality_values.len());
        assert_optimal(&other, workspace.solve(&other.program()));
    }

    /// As in Gauss-Newton: the same constraints, another gradient. At a degenerate vertex more than
    /// one active set is optimal to 1e-12, and nearly parallel constraints amplify the difference;
    /// here the inequalities are kept apart by construction, and the other properties cover
    /// degeneracy.
    #[test]
    fn warm_and_cold_agree(
        seed in any::<u64>(), n in 1_usize..=30, equalities in 0_usize..=3,
        inequalities in 0_usize..=6,
    ) {
        let random = &mut Random(seed);
        let mut instance = Instance::feasible(random, n, equalities, inequalities, 1.0);
        for (lower, upper) in instance.lower.iter_mut().zip(&mut instance.upper) {
            if lower < upper {
                (*lower, *upper) = (*lower - 0.1, *upper + 0.1);
            }
        }
        instance.inequality_values.iter_mut().for_each(|h| *h -= 0.1);
        let mut warm = instance.workspace();
        let mut cold = instance.workspace();
        for round in 0..6 {
            warm.solve(&instance.program());
            cold.forget();
            cold.solve(&instance.program());
            let (warm, cold) = (warm.solution(), cold.solution());
            prop_assert_eq!(warm.status(), Status::Solved);
            prop_assert_eq!(cold.status(), Status::Solved);
            let size = cold.d().iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            for (a, b) in warm.d().iter().zip(cold.d()) {
                prop_assert!((a - b).abs() <= 1e-10 * size, "round {}: {} {}", round, a, b);
            }
            for g in &mut instance.gradient {
                *g += 0.3 * random.real();
            }
        }
    }

    /// Farkas: a row that is minus a positive combination of others, with a limit above the one
    /// that they imply, contradicts exactly those.
    #[test]
    fn a_contradiction_of_three_rows_is_found(
        seed in any::<u64>(), n in 3_usize..=30, gap in 1e-6..1.0,
    ) {
        let random = &mut Random(seed);
        let mut instance = Instance::feasible(random, n, 0, 0, 0.01);
        instance.lower.fill(-FREE);
        instance.upper.fill(FREE);
        let (a, b) = (random.reals(n), random.reals(n));
        let (s, t) = (0.5 + random.real().abs(), 0.5 + random.real().abs());
        let last: Vec<f64> = a.iter().zip(&b).map(|(a, b)| -(s * a + t * b)).collect();
        let (h, k) = (random.real(), random.real());
        instance.inequality_rows = [a, b, last].concat();
        instance.inequality_values = vec![h, k, -(s * h + t * k) + gap];
        let mut workspace = instance.workspace();
        let solution = workspace.solve(&instance.program());
        prop_assert_eq!(solution.status(), Status::Infeasible);
        let mut rows = [false; 3];
        for constraint in solution.conflict() {
            match *constraint {
                Constraint::Inequality(k) => rows[k] = true,
                other => prop_assert!(false, "{:?} has no part in it", other),
            }
        }
        prop_assert_eq!(rows, [true; 3]);
    }
}
