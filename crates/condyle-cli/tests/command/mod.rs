//! The built command, run in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A folder that is empty at first and gone at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// `name` must differ between tests that run at the same time.
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("condyle-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder for a test");
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file of the folder.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder of a test");
        std::fs::write(path, content).expect("a file of a test");
        self
    }

    /// Runs the command in the folder.
    pub(crate) fn condyle(&self, arguments: &[&str]) -> Answer {
        self.run(self.command(env!("CARGO_BIN_EXE_condyle")).args(arguments))
    }

    /// A program that will run in the folder, with nothing on its standard input.
    pub(crate) fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.current_dir(&self.0).stdin(Stdio::null());
        command
    }

    /// Runs a program to its end.
    pub(crate) fn run(&self, command: &mut Command) -> Answer {
        let output = command.output().expect("the command starts");
        Answer {
            // None of a command that a signal ended.
            code: output.status.code().unwrap_or(-1),
            out: output.stdout,
            err: String::from_utf8(output.stderr).expect("messages are text"),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// What a run ended with.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) code: i32,
    pub(crate) out: Vec<u8>,
    pub(crate) err: String,
}
