//! The solver does not allocate on any code path. This test is alone in its binary because the
//! allocator counts for the whole process.

use std::alloc::System;

use condyle_solve::quadratic::{QuadraticProgram, Status, Workspace};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Allocations and reallocations during `call`: the minimum of five attempts, because the thread of
/// the test harness may allocate at the same time, while the solver would allocate in every
/// attempt.
fn allocations(mut call: impl FnMut()) -> usize {
    let attempt = |_| {
        let region = Region::new(GLOBAL);
        call();
        let change = region.change();
        change.allocations + change.reallocations
    };
    (0..5).map(attempt).min().unwrap()
}

#[test]
fn solving_allocates_nothing() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1_u8; 64]))) >= 1, "the counter counts");

    // Tridiagonal (-1, 2.5, -1): diagonally dominant. A gradient of alternating sign and increasing
    // size makes lower and upper bounds active.
    let n = 30;
    let mut hessian = vec![0.0; n * n];
    for i in 0..n {
        hessian[i * n + i] = 2.5;
        if i > 0 {
            hessian[i * n + i - 1] = -1.0;
        }
    }
    let gradient: Vec<f64> =
        (0..n).map(|i| if i % 3 == 0 { 0.3 * i as f64 } else { -0.1 * i as f64 }).collect();
    let flipped: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let (lower, upper) = (vec![-1.0; n], vec![1.0; n]);
    // Σ d = 0.5 twice; Σ over even d ≥ 3, Σ over odd d ≥ -4.
    let equality_rows = vec![1.0; 2 * n];
    let parity = |p: usize| (0..n).map(move |i| f64::from(u8::from(i % 2 == p)));
    let inequality_rows: Vec<f64> = parity(0).chain(parity(1)).collect();

    let mut bounded = Workspace::new(n, 0, 0);
    let mut full = Workspace::new(n, 2, 2);
    let mut expect = |gradient: &[f64], equality: &[f64], inequality: &[f64], status| {
        let program = QuadraticProgram::bounded(&hessian, gradient, &lower, &upper);
        assert_eq!(bounded.solve(&program).status(), Status::Solved);
        let program = program
            .with_equalities(&equality_rows, equality)
            .with_inequalities(&inequality_rows, inequality);
        let solution = full.solve(&program);
        assert_eq!(solution.status(), status);
        assert_eq!(solution.conflict().is_empty(), status != Status::Infeasible);
        bounded.forget();
        full.forget();
    };
    let count = allocations(|| {
        for gradient in [&gradient, &flipped, &gradient] {
            expect(gradient, &[0.5, 0.5], &[3.0, -4.0], Status::Solved);
            // The two equalities contradict; then the inequalities add up to 1 > 0.5.
            expect(gradient, &[0.5, 0.6], &[3.0, -4.0], Status::Infeasible);
            expect(gradient, &[0.5, 0.5], &[3.0, -2.0], Status::Infeasible);
        }
    });
    assert_eq!(count, 0);
}
