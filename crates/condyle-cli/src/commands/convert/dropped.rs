//! What another format does not hold of a C3D trial, or holds without its unit.

use crate::screen::say;
use condyle::formats::c3d::{Kind, Trial};
use condyle::formats::{Format, Id};

/// Says in which units points that are no markers are written, and what is left out.
pub(super) fn tell(trial: &Trial, target: &Format) {
    let lengths = if target.id == Id::Csv { "m" } else { "mm" };
    let kinds: Vec<String> = Kind::ALL
        .iter()
        .filter_map(|kind| {
            let of_kind: Vec<_> = trial.others.iter().filter(|o| o.kind == *kind).collect();
            let unit = of_kind.first().map(|other| other.unit.as_str())?;
            let unit = if unit.is_empty() { "no unit" } else { unit };
            Some(format!("{} {}s ({unit})", of_kind.len(), kind.name()))
        })
        .collect();
    if !kinds.is_empty() {
        say(&format!(
            "note: not in {lengths}, but in their own unit and the axes of the file: {} \
             (--markers-only leaves them out)",
            kinds.join(", ")
        ));
    }
    let counts = [
        (trial.analog.channels.len(), "analog channel"),
        (trial.events().len(), "event"),
        (trial.platforms().len(), "force platform"),
    ];
    let left: Vec<String> = counts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}{}", if *count == 1 { "" } else { "s" }))
        .collect();
    if !left.is_empty() {
        let help = "a C3D holds them; --analog writes the channels as a table";
        say(&format!("note: .{} does not hold {} ({help})", target.name, left.join(", ")));
    }
}
