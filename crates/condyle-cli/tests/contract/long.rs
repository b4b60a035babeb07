//! Long motions: memory does not grow with their length.

use super::{Folder, leg};
use std::fmt::Write;
use std::process::Stdio;
use std::time::Duration;

/// The most memory that `fk` of a motion of so many frames held, in MiB; `None` where it ended unseen.
fn most_memory(folder: &Folder, frames: usize) -> Option<f64> {
    let mut text =
        format!("long\nnRows={frames}\ninDegrees=yes\nendheader\ntime\thip_flexion\tknee_angle\n");
    for frame in 0..frames {
        let t = frame as f64 / 100.0;
        writeln!(text, "{t}\t{}\t{}", leg::hip(t).to_degrees(), leg::knee(t).to_degrees()).unwrap();
    }
    folder.write("long.mot", text);
    let mut command = folder.command(env!("CARGO_BIN_EXE_condyle"));
    command.args(["fk", "leg.osim", "--motion", "long.mot", "-o", "/dev/null"]);
    let mut child = command.stderr(Stdio::null()).spawn().expect("the command starts");
    let mut most = None;
    while child.try_wait().expect("a state").is_none() {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id()));
        let status = status.unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<f64>().ok());
        most = kib.map(|kib| kib / 1024.0).or(most);
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(child.wait().expect("an end").success());
    most
}

#[test]
fn memory_does_not_grow_with_a_motion() {
    let folder = Folder::with_leg("long-memory");
    // Of 18 and 54 MB; memory once grew with the length, to gigabytes.
    let Some((short, long)) = most_memory(&folder, 400_000).zip(most_memory(&folder, 1_200_000))
    else {
        eprintln!("not tested: no run lasted long enough to be looked at");
        return;
    };
    assert!(long < short + 8.0, "{short:.1} and {long:.1} MiB");
    assert!(long < 64.0, "{long:.1} MiB");
}
