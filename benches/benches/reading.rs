//! Reading C3D, TRC and MOT: `cargo bench -p condyle-benches --bench reading [-- --json] [FILE...]`.
//!
//! Each file is read from memory again and again, and from its path; beside it the bounds of the same run, which are
//! reading its bytes alone and filling as much new memory. `faults` are the pages that the operating system had to
//! provide for one call, where it tells that (Linux). Without files those of the shared data folder are read.
//! `--json` prints the same as one document, for `oracles/reading/table.py`.
#![allow(missing_docs, reason = "a benchmark has no interface")]

use condyle::formats::{c3d, sto, trc};
use condyle_benches::table;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The shared data folder beside the repository.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data");
/// Files of it.
const USUAL: [&str; 5] = [
    "hip/right_hip_functional.c3d",
    "knee/opencap4/squats1.trc",
    "knee/SprintMotion.trc",
    "knee/opencap4/squats1_ik.mot",
    "shoulder/thoracoscapular/ABD02.mot",
];

fn main() {
    let named: Vec<PathBuf> =
        std::env::args().skip(1).filter(|a| !a.starts_with("--")).map(PathBuf::from).collect();
    let json = std::env::args().any(|argument| argument == "--json");
    let usual = || USUAL.iter().map(|name| Path::new(DATA).join(name)).collect();
    let files: Vec<PathBuf> = if named.is_empty() { usual() } else { named };
    let mut all = vec![];
    for path in &files {
        match std::fs::read(path) {
            Ok(bytes) => all.extend(rows(path, &bytes)),
            Err(_) => eprintln!("skipped: {} is absent", path.display()),
        }
    }
    if json {
        let rows: Vec<String> = all.iter().map(Row::json).collect();
        println!("[\n{}\n]", rows.join(",\n"));
        return;
    }
    let head = ["file", "what", "MB", "best ms", "median ms", "MB/s", "faults"];
    let cells: Vec<Vec<String>> = all.iter().map(Row::cells).collect();
    table::print("reading files, one thread", &head, &cells);
}

/// All that is timed for a file.
fn rows(path: &Path, bytes: &[u8]) -> Vec<Row> {
    let timed = |what: &'static str, call: &mut dyn FnMut()| Row::timed(path, what, bytes, call);
    let mut rows = vec![timed("bytes alone", &mut || {
        assert!(black_box(std::fs::read(black_box(path))).is_ok());
    })];
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("c3d") => {
            rows.push(timed("as stored", &mut || {
                assert!(black_box(c3d::from_bytes(black_box(bytes))).is_ok());
            }));
            let mut values = vec![];
            rows.push(timed("scaled into memory used again", &mut || {
                let trial = c3d::from_bytes(black_box(bytes)).map(|read| read.value);
                values.clear();
                if let Ok(trial) = &trial {
                    trial.analog.scaled_to(&mut values);
                }
                assert!(black_box(trial).is_ok() && !black_box(&values).is_empty());
            }));
            let scaled = |bytes: &[u8]| {
                c3d::from_bytes(bytes).map(|read| {
                    let table = read.value.analog.to_table(0.0);
                    (read.value, table)
                })
            };
            rows.push(timed("scaled into a new table", &mut || {
                assert!(black_box(scaled(black_box(bytes))).is_ok());
            }));
            rows.push(timed("scaled into a new table, from its path", &mut || {
                let bytes = std::fs::read(black_box(path)).unwrap_or_default();
                assert!(black_box(scaled(&bytes)).is_ok());
            }));
            if let Ok(read) = c3d::from_bytes(bytes) {
                let (analog, points) = (&read.value.analog, read.value.recording.positions.len());
                rows.push(timed("scaling alone", &mut || {
                    values.clear();
                    analog.scaled_to(&mut values);
                    black_box(&values);
                }));
                // As large as positions, words, samples and scaled samples.
                let samples = analog.stored.len();
                let sizes = [24 * points, 4 * points, 4 * samples, 8 * samples];
                rows.push(timed("as much new memory, filled", &mut || {
                    let filled: Vec<Vec<u8>> =
                        sizes.iter().map(|&n| vec![black_box(1); n]).collect();
                    black_box(filled);
                }));
            }
        }
        Some("trc") => {
            rows.push(timed("from memory", &mut || {
                assert!(black_box(trc::from_bytes(black_box(bytes))).is_ok());
            }));
            rows.push(timed("from its path", &mut || {
                let bytes = std::fs::read(black_box(path)).unwrap_or_default();
                assert!(black_box(trc::from_bytes(&bytes)).is_ok());
            }));
        }
        Some("mot" | "sto") => {
            rows.push(timed("from memory", &mut || {
                assert!(black_box(sto::from_bytes(black_box(bytes))).is_ok());
            }));
            rows.push(timed("from its path", &mut || {
                let bytes = std::fs::read(black_box(path)).unwrap_or_default();
                assert!(black_box(sto::from_bytes(&bytes)).is_ok());
            }));
        }
        _ => eprintln!("skipped: {} is none of .c3d, .trc, .mot, .sto", path.display()),
    }
    rows
}

/// A call that was timed many times.
struct Row {
    file: String,
    what: &'static str,
    bytes: usize,
    calls: usize,
    /// Seconds of the fastest call and of the middle one.
    best: f64,
    median: f64,
    /// Pages provided for a call, the mean of all; `None` where the system does not tell.
    faults: Option<f64>,
}

impl Row {
    /// Calls for two seconds, and five times at least.
    fn timed(path: &Path, what: &'static str, bytes: &[u8], call: &mut dyn FnMut()) -> Self {
        call();
        let start = Instant::now();
        let before = faults();
        let mut times = vec![];
        while times.len() < 5 || start.elapsed() < Duration::from_secs(2) {
            let begin = Instant::now();
            call();
            times.push(begin.elapsed().as_secs_f64());
        }
        let faults = before.zip(faults()).map(|(a, b)| (b - a) / times.len() as f64);
        times.sort_by(f64::total_cmp);
        Self {
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            what,
            bytes: bytes.len(),
            calls: times.len(),
            best: times[0],
            median: times[times.len() / 2],
            faults,
        }
    }

    fn cells(&self) -> Vec<String> {
        let size = self.bytes as f64 / 1e6;
        let faults = self.faults.map_or("-".to_owned(), |faults| format!("{faults:.0}"));
        let numbers = [size, self.best * 1e3, self.median * 1e3, size / self.best];
        let mut cells = vec![self.file.clone(), self.what.to_owned()];
        cells.extend(numbers.map(|x| format!("{x:.3}")));
        cells.push(faults);
        cells
    }

    fn json(&self) -> String {
        let Self { file, what, bytes, calls, .. } = self;
        let (best, median) = (self.best * 1e3, self.median * 1e3);
        let faults = self.faults.map_or("null".to_owned(), |faults| format!("{faults:.1}"));
        format!(
            "{{\"file\": {file:?}, \"what\": {what:?}, \"bytes\": {bytes}, \"calls\": {calls}, \
             \"best_ms\": {best:.4}, \"median_ms\": {median:.4}, \"faults\": {faults}}}"
        )
    }
}

/// How many pages the operating system has provided for this process without reading a disk.
fn faults() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in brackets, may hold spaces; minflt is the eighth word behind it.
    stat.rsplit(')').next()?.split_whitespace().nth(7)?.parse().ok()
}
