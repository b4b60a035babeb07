//! A small workspace in a temporary folder, to which a test adds what a check forbids.

use crate::outcome::{Context, Outcome};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A folder that is removed with its value.
pub(crate) struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// An empty folder.
    pub(crate) fn new() -> Self {
        static MADE: AtomicUsize = AtomicUsize::new(0);
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        let name = format!("condyle-check-{}-{number}", std::process::id());
        let root = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&root).expect("a temporary folder can be made");
        // Cargo gives real paths, also where the temporary folder is a link.
        Self { root: root.canonicalize().expect("it is there") }
    }

    /// A crate without any fault, `sound`, as the only one of its workspace.
    pub(crate) fn of_one_crate() -> Self {
        Self::new()
            .file(
                "Cargo.toml",
                "[package]\nname = \"sound\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
                 license = \"MIT\"\n\n[workspace]\n",
            )
            .file(
                "src/lib.rs",
                "//! Sound.\n\n/// Twice `x`.\npub fn twice(x: u32) -> u32 {\n    2 * x\n}\n",
            )
    }

    /// The same with a file written or replaced.
    pub(crate) fn file(self, path: &str, text: &str) -> Self {
        let file = self.root.join(path);
        let folder = file.parent().expect("a file is in a folder");
        std::fs::create_dir_all(folder).expect("folders can be made");
        std::fs::write(file, text).expect("files can be written");
        self
    }

    /// The same with a text appended to a file.
    pub(crate) fn with(self, path: &str, text: &str) -> Self {
        let before = std::fs::read_to_string(self.root.join(path)).expect("the file is there");
        self.file(path, &(before + text))
    }

    /// The same with some text of a file replaced.
    pub(crate) fn with_instead(self, path: &str, old: &str, new: &str) -> Self {
        let before = std::fs::read_to_string(self.root.join(path)).expect("the file is there");
        assert!(before.contains(old), "{path} has no `{old}`");
        self.file(path, &before.replace(old, new))
    }

    /// The input of a check of this workspace; it builds inside.
    pub(crate) fn context(&self) -> Context {
        Context { root: self.root.clone(), bless: false, trial: Some(self.root.join("target")) }
    }

    /// Expects that a check passes here.
    pub(crate) fn passes(self, check: fn(&Context) -> Outcome) -> Self {
        let outcome = check(&self.context());
        assert!(matches!(outcome, Outcome::Passed), "{outcome:?}");
        self
    }

    /// Expects that a check fails here with a message that contains these words.
    pub(crate) fn fails(self, check: fn(&Context) -> Outcome, words: &str) -> Self {
        match check(&self.context()) {
            Outcome::Failed(why) => assert!(why.contains(words), "`{words}` is not in: {why}"),
            outcome => panic!("{outcome:?} where it should fail with `{words}`"),
        }
        self
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        // A temporary folder that cannot be removed does no harm.
        let _ = std::fs::remove_dir_all(&self.root);
    }
}
