//! Who is compared: a table of persons and their standing trials.

use super::super::joint::segment;
use crate::failure::Failure;
use crate::screen::say;
use condyle::Recording;
use condyle::learn::arms::{Leg, Sizes};
use condyle::learn::calibration::FreeJoint;
use condyle::learning::arms::Person;
use std::path::{Path, PathBuf};

/// One person, before anything is read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Subject {
    pub name: String,
    pub standing: PathBuf,
    pub parent: (String, Vec<String>),
    pub child: (String, Vec<String>),
    pub origin: String,
    pub ends: [String; 2],
    pub left: bool,
}

/// Markers of a person who stands move by less, in metres.
const STILL: f64 = 0.03;

impl Subject {
    /// The person with a leg calibrated from the standing trial, without trials.
    pub(super) fn person(&self, joint: &str, standing: &Recording) -> Result<Person, Failure> {
        let joint = FreeJoint {
            name: joint.to_owned(),
            segments: [self.parent.0.clone(), self.child.0.clone()],
            markers: [self.parent.1.clone(), self.child.1.clone()],
            origin: self.origin.clone(),
            ends: self.ends.clone(),
            left: self.left,
            ..FreeJoint::knee_pronost2010()
        };
        let path = self.standing.display();
        let failed = |error: condyle::Error| Failure::new(format!("{path}: {error}"));
        let model = joint.model(standing).map_err(failed)?;
        let unrest = joint.unrest(standing);
        if unrest > STILL {
            let message = format!(
                "warning: {path}: markers are up to {:.0} mm from their means: the person does not stand still, and the model is \
                 that of no moment",
                1e3 * unrest
            );
            say(&message);
        }
        Ok(Person {
            name: self.name.clone(),
            leg: Leg::of(&model, &joint.name).map_err(failed)?,
            sizes: Sizes::of(&joint, standing),
            trials: vec![],
        })
    }
}

/// Reads a table of persons: a line of names of columns, then one for each. Empty cells are as in `base`.
pub(super) fn read(text: &str, folder: &Path, base: &Subject) -> Result<Vec<Subject>, String> {
    let cells = |line: &str| -> Vec<String> {
        // Lists of markers have commas; cells that hold them are in quotes, or separated by semicolons or tabs.
        let apart = if line.contains(';') {
            ';'
        } else if line.contains('\t') {
            '\t'
        } else {
            ','
        };
        let (mut all, mut cell, mut quoted) = (vec![], String::new(), false);
        for c in line.trim_start_matches('\u{feff}').chars() {
            match c {
                '"' => quoted = !quoted,
                c if c == apart && !quoted => all.push(std::mem::take(&mut cell)),
                c => cell.push(c),
            }
        }
        all.push(cell);
        all.iter().map(|cell| cell.trim().to_owned()).collect()
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let Some((_, head)) = lines.next() else { return Err("the table of subjects is empty".into()) };
    let head: Vec<String> = cells(head).iter().map(|cell| cell.to_ascii_lowercase()).collect();
    let known = ["subject", "static", "parent", "child", "origin", "medial", "lateral", "side"];
    if let Some(other) = head.iter().find(|cell| !known.contains(&cell.as_str())) {
        return Err(format!("there is no column `{other}`: columns are {}", known.join(", ")));
    }
    let mut subjects: Vec<Subject> = vec![];
    for (at, line) in lines {
        let line_number = at + 1;
        let cells = cells(line);
        let of = |name: &str| {
            let column = head.iter().position(|cell| cell == name)?;
            cells.get(column).filter(|cell| !cell.is_empty()).cloned()
        };
        let needed = |name: &str| {
            of(name).ok_or_else(|| format!("line {line_number}: the cell `{name}` is empty"))
        };
        let mut subject = Subject { name: needed("subject")?, ..base.clone() };
        subject.standing = folder.join(needed("static")?);
        let markers = |name: &str, base: &(String, Vec<String>)| match of(name) {
            None => Ok(base.clone()),
            // The segments of all persons have the same names.
            Some(list) => {
                let list = list.split_once('=').map_or(list.as_str(), |(_, list)| list);
                let list = list.replace(' ', ",");
                segment(&format!("{}={list}", base.0))
                    .map_err(|said| format!("line {line_number}: `{name}`: {said}"))
            }
        };
        subject.parent = markers("parent", &base.parent)?;
        subject.child = markers("child", &base.child)?;
        subject.origin = of("origin").unwrap_or(subject.origin);
        let [medial, lateral] = subject.ends;
        subject.ends = [of("medial").unwrap_or(medial), of("lateral").unwrap_or(lateral)];
        subject.left = match of("side").as_deref() {
            None => base.left,
            Some("left") => true,
            Some("right") => false,
            Some(other) => {
                return Err(format!(
                    "line {line_number}: the side is left or right, not `{other}`"
                ));
            }
        };
        if subjects.iter().any(|other| other.name == subject.name) {
            return Err(format!("line {line_number}: `{}` is there twice", subject.name));
        }
        subjects.push(subject);
    }
    if subjects.is_empty() {
        return Err("the table names no subject".into());
    }
    Ok(subjects)
}

#[cfg(test)]
mod tests {
    use super::{Subject, read};
    use std::path::Path;

    fn base() -> Subject {
        Subject {
            name: String::new(),
            standing: "".into(),
            parent: ("thigh".into(), vec!["A".into(), "B".into(), "C".into()]),
            child: ("shank".into(), vec!["D".into(), "E".into(), "F".into()]),
            origin: "A".into(),
            ends: ["B".into(), "C".into()],
            left: false,
        }
    }

    #[test]
    fn cells_that_are_empty_are_as_the_options_say() {
        let text = "subject,static,parent,origin,side\nAnna,a.trc,,,\nBo,b.trc,G H I,G,left\n";
        let all = read(text, Path::new("data"), &base()).unwrap();
        assert_eq!(
            all[0],
            Subject { name: "Anna".into(), standing: "data/a.trc".into(), ..base() }
        );
        assert_eq!(all[1].parent, ("thigh".into(), vec!["G".into(), "H".into(), "I".into()]));
        assert_eq!((all[1].origin.as_str(), all[1].left), ("G", true));
        // Commas in a cell stand in quotes.
        let text = "subject,static,child\nAnna,a.trc,\"X,Y,Z\"\n";
        let all = read(text, Path::new(""), &base()).unwrap();
        assert_eq!(all[0].child.1, ["X", "Y", "Z"]);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let said = |text: &str| read(text, Path::new(""), &base()).unwrap_err();
        assert_eq!(said("subject,static\nAnna,\n"), "line 2: the cell `static` is empty");
        assert!(said("subject,file\nAnna,a\n").starts_with("there is no column `file`"));
        let two = said("subject,static,parent\nAnna,a.trc,G H\n");
        assert_eq!(two, "line 2: `parent`: a segment needs three markers");
        assert_eq!(said("subject,static\nA,a\n\nA,b\n"), "line 4: `A` is there twice");
    }
}
