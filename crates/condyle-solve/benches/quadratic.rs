//! Times one call of the quadratic program at the sizes of inverse kinematics.
//!
//! `cargo bench -p condyle-solve` prints the minimum over repeated batches.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use std::hint::black_box;
use std::time::Instant;

use condyle_solve::cholesky;
use condyle_solve::quadratic::{QuadraticProgram, Status, Workspace};

/// Uniform in [-1, 1) from a linear congruential generator (Knuth's MMIX constants).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vec(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }

    /// JᵀJ + 1e-3 for a random J of 2 n rows.
    fn hessian(&mut self, n: usize) -> Vec<f64> {
        let j = self.vec(2 * n * n);
        let mut h = vec![0.0; n * n];
        for a in 0..n {
            for b in 0..n {
                h[a * n + b] = (0..2 * n).map(|k| j[k * n + a] * j[k * n + b]).sum();
            }
            h[a * n + a] += 1e-3;
        }
        h
    }
}

fn microseconds(mut call: impl FnMut()) -> f64 {
    let (batches, calls) = (400, 100);
    let batch = |_| {
        let start = Instant::now();
        for _ in 0..calls {
            call();
        }
        start.elapsed().as_secs_f64() * 1e6 / f64::from(calls)
    };
    (0..batches).map(batch).fold(f64::INFINITY, f64::min)
}

fn main() {
    let mut random = Random(1);
    let n = 29;
    let hessian = random.hessian(n);
    let gradient = random.vec(n);

    let mut factor = hessian.clone();
    let time = microseconds(|| {
        factor.copy_from_slice(black_box(&hessian));
        cholesky::factor(&mut factor, n).unwrap();
    });
    println!("cholesky n {n}: copy and factor {time:.2} us");
    let mut x = gradient.clone();
    let time = microseconds(|| {
        x.copy_from_slice(black_box(&gradient));
        cholesky::solve(&factor, n, &mut x);
    });
    println!("cholesky n {n}: copy and solve {time:.2} us");

    // Bounds wide enough for the unconstrained minimiser, and bounds of which five are active.
    let mut free = gradient.clone();
    cholesky::solve(&factor, n, &mut free);
    let wide = 2.0 * free.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut narrow = wide;
    let mut workspace = Workspace::new(n, 0, 0);
    let held = |z: &[f64]| z.iter().filter(|z| **z != 0.0).count();
    loop {
        let (lower, upper) = (vec![-narrow; n], vec![narrow; n]);
        let program = QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper);
        let solution = workspace.solve(&program);
        if held(solution.bound_multipliers()) == 5 {
            break;
        }
        narrow *= 0.99;
    }
    for (label, width) in [("wide", wide), ("narrow", narrow)] {
        let (lower, upper) = (vec![-width; n], vec![width; n]);
        let program = QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper);
        report(&format!("n {n}, {label}"), &program, Workspace::new(n, 0, 0));

        // The same through rows: an inactive one, and one that is always active.
        let row = vec![1.0; n];
        let (off, on) = ([-1e3], [1.0]);
        report(
            &format!("n {n}, {label}, an inactive row"),
            &program.with_inequalities(&row, &off),
            Workspace::new(n, 0, 1),
        );
        report(
            &format!("n {n}, {label}, an active row"),
            &program.with_inequalities(&row, &on),
            Workspace::new(n, 0, 1),
        );
    }

    let n = 17;
    let (hessian, gradient) = (random.hessian(n), random.vec(n));
    let rows = random.vec(3 * n);
    let values: Vec<f64> = random.vec(3).iter().map(|x| 0.05 * x).collect();
    for (label, width) in [("wide", 10.0), ("narrow", 0.04)] {
        let (lower, upper) = (vec![-width; n], vec![width; n]);
        let program = QuadraticProgram::bounded(&hessian, &gradient, &lower, &upper)
            .with_equalities(&rows, &values);
        report(&format!("n {n}, 3 equalities, {label}"), &program, Workspace::new(n, 3, 0));
    }
}

fn report(label: &str, program: &QuadraticProgram<'_>, mut workspace: Workspace) {
    let cold = workspace.solve(program);
    assert_eq!(cold.status(), Status::Solved, "{label}");
    let (active, rounds) =
        (cold.bound_multipliers().iter().filter(|z| **z != 0.0).count(), cold.iterations());
    let warm = microseconds(|| {
        workspace.solve(black_box(program));
    });
    let cold = microseconds(|| {
        workspace.forget();
        workspace.solve(black_box(program));
    });
    println!("{label} ({active} bounds): warm {warm:.2} us, cold {cold:.2} us in {rounds}");
}
