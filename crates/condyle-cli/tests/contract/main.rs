//! The contract of the command line: what each command reads and writes, and how it ends.

#[path = "../command/mod.rs"]
mod command;

mod batch;
mod bench;
mod compare;
mod constrain;
mod convert;
mod coupling;
mod diff;
mod document;
mod export;
mod fk;
mod given;
mod info;
#[cfg(unix)]
mod keypoints;
mod kill;
mod leg;
mod limits;
#[cfg(target_os = "linux")]
mod long;
#[cfg(unix)]
mod output;
mod pose;
mod render;
mod scale;
mod shipped;
mod skeleton;
#[cfg(unix)]
mod standard_input;
mod study;
mod track;
mod transfer;
mod upkeep;

use command::{Answer, Folder};
use serde_json::Value;

impl Answer {
    /// Standard output of a run that must have ended with this code.
    #[track_caller]
    fn expect(self, code: i32) -> String {
        assert_eq!(self.code, code, "{}", self.err);
        String::from_utf8(self.out).expect("text on standard output")
    }

    /// The one JSON document that standard output must be.
    #[track_caller]
    fn json(self) -> Value {
        let text = self.expect(0);
        let mut documents = serde_json::Deserializer::from_str(&text).into_iter::<Value>();
        let value = documents.next().expect("a document").expect("valid JSON");
        assert!(documents.next().is_none(), "more than one document: {text}");
        value
    }

    /// Standard error of a run that refused its arguments or input, and wrote nothing.
    #[track_caller]
    fn refused(self) -> String {
        assert_eq!((self.code, self.out.len()), (2, 0), "{}", self.err);
        assert!(self.err.contains("error: "), "{}", self.err);
        self.err
    }
}

/// Asserts that two numbers are nearly the same.
#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "found {found}, expected {expected}");
}

/// A number of a JSON document.
#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

impl Folder {
    /// A folder with the leg as `leg.osim`.
    fn with_leg(name: &str) -> Self {
        let folder = Self::new(name);
        folder.write("leg.osim", leg::osim());
        folder
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}
