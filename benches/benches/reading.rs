//! Reading C3D, TRC and MOT: `cargo bench -p condyle-benches --bench reading`.
//!
//! Each file is read from memory again and again; beside it the bound of the same run, which is copying its
//! bytes. `--c3d`, `--trc` and `--mot` name other files than those of the shared data folder.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use condyle::formats::{c3d, sto, trc};
use condyle_benches::{arguments, table};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The shared data folder beside the repository.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data");

fn main() {
    let path = |name: &str, usual: &str| {
        arguments::path(&format!("--{name}")).unwrap_or_else(|| PathBuf::from(DATA).join(usual))
    };
    let mut rows = vec![];
    let c3d_path = path("c3d", "hip/right_hip_functional.c3d");
    if let Some(bytes) = bytes(&c3d_path) {
        rows.push(row("c3d", &bytes, || {
            let read = c3d::from_bytes(black_box(&bytes));
            assert!(black_box(read).is_ok());
        }));
        rows.push(row("c3d, all channels in their units", &bytes, || {
            let trial =
                c3d::from_bytes(black_box(&bytes)).map(|read| read.value.analog.to_table(0.0));
            assert!(black_box(trial).is_ok());
        }));
        let mut values = vec![];
        rows.push(row("c3d, all channels in their units, into memory used again", &bytes, || {
            let trial = c3d::from_bytes(black_box(&bytes)).map(|read| read.value);
            values.clear();
            if let Ok(trial) = &trial {
                trial.analog.scaled_to(&mut values);
            }
            assert!(black_box(trial).is_ok() && !black_box(&values).is_empty());
        }));
        if let Ok(read) = c3d::from_bytes(&bytes) {
            let (analog, points) = (&read.value.analog, read.value.recording.positions.len());
            println!("{points} points, {} samples of channels", analog.stored.len());
            rows.push(row("c3d, channels to their units alone", &bytes, || {
                values.clear();
                analog.scaled_to(&mut values);
                black_box(&values);
            }));
            // The bound: what is filled is as large as positions, words, samples and scaled samples.
            let sizes = [24 * points, 4 * points, 4 * analog.stored.len(), 8 * analog.stored.len()];
            rows.push(row("c3d, as many bytes of new memory, filled", &bytes, || {
                let filled: Vec<Vec<u8>> = sizes.iter().map(|&n| vec![black_box(1); n]).collect();
                black_box(filled);
            }));
        }
    }
    for usual in ["knee/opencap4/squats1.trc", "knee/SprintMotion.trc"] {
        if let Some(bytes) = bytes(&path("trc", usual)) {
            rows.push(row("trc", &bytes, || {
                assert!(black_box(trc::from_bytes(black_box(&bytes))).is_ok());
            }));
        }
    }
    for usual in ["knee/opencap4/squats1_ik.mot", "shoulder/thoracoscapular/ABD02.mot"] {
        if let Some(bytes) = bytes(&path("mot", usual)) {
            rows.push(row("mot", &bytes, || {
                assert!(black_box(sto::from_bytes(black_box(&bytes))).is_ok());
            }));
        }
    }
    let head = ["format", "MB", "ms", "MB/s", "copying ms", "ratio"];
    table::print("reading files in memory, one thread", &head, &rows);
}

/// Nanoseconds of the fastest of many calls: each takes as long as many other programs' time slices are.
fn fastest(mut call: impl FnMut()) -> f64 {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    while start.elapsed() < Duration::from_secs(2) {
        let begin = Instant::now();
        call();
        best = best.min(begin.elapsed().as_secs_f64() * 1e9);
    }
    best
}

fn bytes(path: &Path) -> Option<Vec<u8>> {
    let read = std::fs::read(path);
    if read.is_err() {
        println!("skipped: {} is absent", path.display());
    }
    read.ok()
}

fn row(name: &str, bytes: &[u8], mut read: impl FnMut()) -> Vec<String> {
    let time = fastest(&mut read);
    let mut copy = vec![0u8; bytes.len()];
    let bound = fastest(|| {
        copy.copy_from_slice(black_box(bytes));
        black_box(&copy);
    });
    let size = bytes.len() as f64 / 1e6;
    let mut row = vec![name.to_owned()];
    let numbers = [size, time / 1e6, size / (time * 1e-9), bound / 1e6, time / bound];
    row.extend(numbers.map(|x| format!("{x:.3}")));
    row
}
