//! A batch that is killed at any moment and resumed ends as one that was not.

use super::{Folder, leg};
use std::collections::HashMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

struct Batch {
    folder: Folder,
    trials: Vec<String>,
    /// What each result must be.
    expected: HashMap<String, Vec<u8>>,
    /// How long all of it takes.
    whole: Duration,
}

/// What tells a file from another that was written later to the same place.
type Stamp = (u64, i64, i64);

impl Batch {
    fn new(name: &str, trials: usize, frames: usize) -> Self {
        let folder = Folder::with_leg(name);
        let trials: Vec<String> = (0..trials).map(|i| format!("t{i}.trc")).collect();
        for (i, trial) in trials.iter().enumerate() {
            folder.write(trial, leg::trc(frames + i, |_, _| true));
        }
        let mut batch = Self { folder, trials, expected: HashMap::new(), whole: Duration::ZERO };
        let begun = Instant::now();
        assert!(batch.command("reference").status().expect("the command runs").success());
        batch.whole = begun.elapsed();
        for trial in &batch.trials {
            let name = trial.replace(".trc", ".mot");
            let place = batch.folder.path().join("reference").join(&name);
            batch.expected.insert(name, fs::read(place).expect("a result"));
        }
        batch
    }

    fn command(&self, output: &str) -> Command {
        let mut command = self.folder.command(env!("CARGO_BIN_EXE_condyle"));
        command.args(["track", "leg.osim"]).args(&self.trials);
        command.args([
            "-o",
            output,
            "--errors",
            &format!("{output}-errors"),
            "--resume",
            "--threads",
            "1",
        ]);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// The results that are done, by report, after checking that all results are whole.
    fn done(&self, output: &str) -> HashMap<String, [Stamp; 3]> {
        let place = |name: &str| self.folder.path().join(output).join(name);
        let stamp = |path: &std::path::Path| {
            let known = fs::metadata(path).expect("a file");
            (known.ino(), known.mtime(), known.mtime_nsec())
        };
        let mut done = HashMap::new();
        for (name, expected) in &self.expected {
            let report = place(&name.replace(".mot", ".report.json"));
            match fs::read(place(name)) {
                Ok(found) => assert!(found == *expected, "{name} is torn"),
                Err(_) => assert!(!report.exists(), "{name} has a report and is not there"),
            }
            if let Ok(text) = fs::read(&report) {
                serde_json::from_slice::<serde_json::Value>(&text).expect("a whole report");
                let errors = self.folder.path().join(format!("{output}-errors"));
                let errors = errors.join(name.replace(".mot", ".csv"));
                let stamps = [stamp(&place(name)), stamp(&errors), stamp(&report)];
                done.insert(name.clone(), stamps);
            }
        }
        done
    }

    /// Kills a batch and resumes it, until it is done or was killed so often. Answers how often.
    fn killed(&self, output: &str, most: usize, random: &mut u64) -> usize {
        let mut before = HashMap::new();
        let mut kills = 0;
        while kills < most {
            let mut child = self.command(output).spawn().expect("the command starts");
            *random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let share = (*random >> 40) as f64 / (1u64 << 24) as f64;
            // Most kills come early, so that many are needed before all is done.
            std::thread::sleep(self.whole.mul_f64(0.4 * share * share));
            child.kill().expect("a process to kill");
            let ended = child.wait().expect("an end");
            let done = self.done(output);
            for (name, stamps) in &before {
                assert_eq!(done.get(name), Some(stamps), "{name} was done twice, or lost");
            }
            if ended.success() {
                break;
            }
            kills += 1;
            before = done;
        }
        let ended = self.command(output).status().expect("the command runs");
        assert!(ended.success());
        let done = self.done(output);
        assert_eq!(done.len(), self.trials.len());
        assert!(before.iter().all(|(name, stamps)| done[name] == *stamps));
        for folder in [output.to_owned(), format!("{output}-errors")] {
            let entries = fs::read_dir(self.folder.path().join(folder)).expect("a folder");
            let left =
                entries.flatten().filter(|e| e.file_name().to_string_lossy().ends_with(".part"));
            // What the last kill left, the last run has removed.
            assert_eq!(left.count(), 0);
        }
        kills
    }
}

#[test]
fn a_batch_of_six_survives_five_kills() {
    let batch = Batch::new("kill-few", 6, 300);
    let mut random = 1;
    let kills = batch.killed("out", 5, &mut random);
    assert!(kills > 0, "it was never caught at work");
}

#[test]
#[ignore = "takes a minute"]
fn a_batch_of_twenty_survives_fifty_kills() {
    let batch = Batch::new("kill-many", 20, 2000);
    let (mut kills, mut random, mut rounds) = (0, 2026, 0);
    while kills < 50 {
        kills += batch.killed(&format!("out{rounds}"), 50 - kills, &mut random);
        rounds += 1;
        assert!(rounds < 100, "it is hardly ever caught at work");
    }
    eprintln!("{kills} kills in {rounds} batches of {:?}", batch.whole);
}
