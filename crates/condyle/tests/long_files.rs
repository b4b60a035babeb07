//! Long files, read part by part, hold what they hold when read at once.

use condyle::formats::{sto, trc};
use condyle::{ModelBuilder, Motion, math::Vec3, open};
use std::fmt::Write;
use std::path::PathBuf;

/// A file that is gone at the end.
struct Long(PathBuf);

impl Long {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("condyle-long-{}-{name}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        // Files are read in parts from 16 MiB on.
        assert!(text.len() > 16 << 20, "{name}: {} bytes", text.len());
        Self(path)
    }
}

impl Drop for Long {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

const FRAMES: usize = 70_000;

/// Ten markers on a path, some of them unseen now and then.
fn recording(stated: usize) -> String {
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\tlong.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n\
         100\t100\t{stated}\t10\tmm\nFrame#\tTime"
    );
    (0..10).for_each(|m| write!(text, "\tM{m}\t\t").unwrap());
    text.push_str("\n\t");
    (1..=10).for_each(|m| write!(text, "\tX{m}\tY{m}\tZ{m}").unwrap());
    text.push_str("\n\n");
    for frame in 0..FRAMES {
        write!(text, "{}\t{}", frame + 1, frame as f64 / 100.0).unwrap();
        for marker in 0..10 {
            match (frame * 7 + marker) % 97 {
                0 => text.push_str("\t\t\t"),
                n => write!(text, "\t{}.125\t{frame}.5\t-{marker}00.0625", 900 + n).unwrap(),
            }
        }
        text.push('\n');
    }
    text
}

fn motion(row: impl Fn(usize) -> String) -> String {
    let mut text = format!("long\nnRows={FRAMES}\ninDegrees=yes\nendheader\ntime");
    (0..12).for_each(|c| write!(text, "\tother_{c}").unwrap());
    text.push_str("\tangle\n");
    for frame in 0..FRAMES {
        text.push_str(&row(frame));
    }
    text
}

fn row(frame: usize) -> String {
    let others = "\t-12.345678901234567".repeat(12);
    format!("{}{others}\t{}.0625\n", frame as f64 / 100.0, frame % 90)
}

#[test]
fn a_recording_is_the_same_in_parts() {
    let text = recording(FRAMES);
    let file = Long::new("same.trc", &text);
    // The reader of the format takes all of it at once.
    let whole = trc::read(&text).unwrap();
    assert!(whole.warnings.is_empty());
    let read = open::recording(&file.0).unwrap();
    assert!(read.warnings.is_empty());
    assert!(read.value == whole.value);
    assert!(whole.value.missing() > 0);
}

#[test]
fn what_is_odd_in_a_long_recording_is_said() {
    let text = recording(FRAMES - 1);
    let file = Long::new("odd.trc", &text);
    let (whole, read) = (trc::read(&text).unwrap(), open::recording(&file.0).unwrap());
    assert!(!whole.warnings.is_empty() && read.warnings == whole.warnings);
    assert!(read.value == whole.value);
}

#[test]
fn a_motion_is_the_same_in_parts_and_its_errors_are_placed() {
    let mut b = ModelBuilder::new("hinge");
    let shank = b.segment("shank", None);
    b.hinge("knee", shank, "angle", Vec3::Z);
    let model = b.build().unwrap();
    let text = motion(row);
    let file = Long::new("same.mot", &text);
    let (whole, _) = Motion::from_table(&model, &sto::read(&text).unwrap().value);
    let parts = open::motion_parts(&file.0, &model).unwrap().expect("a motion in parts");
    assert!(parts.warned("motion/extra"));
    assert_eq!(parts.value.frames(), FRAMES);
    let mut joined = Motion::default();
    let mut count = 0;
    for part in parts.value {
        let part = part.unwrap();
        joined.times.extend(part.times);
        joined.frames.extend(part.frames);
        count += 1;
    }
    assert!(count > 3 && joined == whole, "{count} parts");

    // Seven lines of head, and lines are counted from 1.
    let back = |frame| if frame == 50_000 { row(3) } else { row(frame) };
    let file = Long::new("back.mot", &motion(back));
    assert!(open::motion_parts(&file.0, &model).unwrap().is_none());
    let error = open::motion(&file.0, &model).unwrap_err().to_string();
    assert!(error.contains(":50006:1: time goes back from 499.99 s to 0.03 s"), "{error}");
    // A blank cell is a warning with a count of its own.
    let blank =
        |frame| if frame == 60_000 { row(frame).replace("\t60.0625", "\t") } else { row(frame) };
    let file = Long::new("blank.mot", &motion(blank));
    assert!(open::motion_parts(&file.0, &model).unwrap().is_none());
}
