//! Files of a hundred megabytes that hold nothing: refused in seconds, in little memory.

use super::command::{Answer, Folder};
use std::process::Command;
use std::time::{Duration, Instant};

/// How long a hundred megabytes may take, on a machine that builds something else meanwhile.
const PATIENCE: Duration = Duration::from_secs(20);

/// How much memory it may take, in KiB: six times its size.
const MEMORY: u32 = 600_000;

impl Folder {
    /// Runs the command with a bound on its memory.
    fn condyle_within(&self, kibibytes: u32, arguments: &[&str]) -> Answer {
        let limited = format!("ulimit -v {kibibytes}; exec \"$0\" \"$@\"");
        let output = Command::new("sh")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_condyle")])
            .args(arguments)
            .current_dir(self.path())
            .output()
            .expect("the command starts");
        let err = String::from_utf8(output.stderr).expect("messages are text");
        Answer { code: output.status.code().unwrap_or(-1), out: output.stdout, err }
    }
}

/// Reads a hundred megabytes of a piece, repeated, as every format.
fn a_hundred_megabytes(name: &str, piece: &str, said: [&str; 4]) {
    let folder = Folder::new(name);
    let mut file = "huge".to_owned();
    folder.write(&file, piece.repeat(100_000_000 / piece.len()));
    for (ending, said) in ["osim", "trc", "mot", "csv"].into_iter().zip(said) {
        let before = std::mem::replace(&mut file, format!("huge.{ending}"));
        std::fs::rename(folder.path().join(before), folder.path().join(&file)).expect("renamed");
        let start = Instant::now();
        let run = folder.condyle_within(MEMORY, &["info", &file]);
        assert!(start.elapsed() < PATIENCE, "{file} took {:?}", start.elapsed());
        assert_eq!((run.code, run.out.len()), (2, 0), "{}", run.err);
        assert!(run.err.ends_with(&format!("error: {file}:{said}\n")), "{}", run.err);
    }
}

const NO_ELEMENT: &str = "1: there is no element (this is not an XML file)";
const EMPTY_TRC: &str = "1: the file is empty (a TRC file starts with `PathFileType`)";
const EMPTY_CSV: &str = "1: there is no line of names (the first line must name the columns)";
const ENDLESS_MOT: &str = "1: a line of the header is too long (is this a motion? write \
                           `endheader` before the line of names)";

#[test]
fn a_hundred_megabytes_of_spaces() {
    let empty_mot = "1: no line reads `endheader` (is this a motion? write `endheader` before the line of names)";
    a_hundred_megabytes("huge-spaces", " ", [NO_ELEMENT, EMPTY_TRC, empty_mot, EMPTY_CSV]);
}

#[test]
fn a_hundred_megabytes_of_line_ends() {
    let empty_mot = "1: no line reads `endheader` (is this a motion? write `endheader` before the line of names)";
    a_hundred_megabytes("huge-lines", "\n", [NO_ELEMENT, EMPTY_TRC, empty_mot, EMPTY_CSV]);
}

#[test]
fn a_hundred_megabytes_of_open_tags() {
    let said = [
        "1:769: elements are nested more than 256 deep (no model or setup file needs that; is the \
         file damaged?)",
        "1: the file does not start with `PathFileType` (this is not a TRC file)",
        ENDLESS_MOT,
        "1: the name of column 1 has 99999999 letters or is binary (is this a table? the first \
         line must name the columns)",
    ];
    a_hundred_megabytes("huge-tags", "<a>", said);
}
