//! All tables as one text.

use super::{Studied, printed, tables};
use std::fmt::Write;

/// The study as Markdown: what was done, all tables, what is wrong with the printed numbers. `picture` names the picture of Figure 3
/// beside it, where there is one.
#[must_use]
pub fn report(studied: &Studied, picture: Option<&str>) -> String {
    let trials = &studied.plan.trials;
    let mut text =
        String::from("# The study of Pronost, Sandholm & Thalmann 2010 with virtual people\n\n");
    let _ = writeln!(
        text,
        "{} people, each with {} gaits and {} crouches ({} angles between the feet, {} times) to learn from, {} gaits and {} crouches that no law has seen; \
         seven skin markers at 100 Hz with noise of {} mm on each coordinate, {}; seed {}. Each trial twice: with markers that are fixed to bones, and with skin that moves.\n",
        studied.people.len(),
        trials.gaits,
        6 * trials.crouches,
        6,
        trials.crouches,
        trials.unseen[0],
        trials.unseen[1],
        1e3 * trials.noise,
        match studied.plan.low_pass {
            Some(hertz) => format!("filtered at {hertz} Hz before they are tracked"),
            None => "not filtered".to_owned(),
        },
        trials.seed
    );
    if studied.plan.every > 1 {
        let every = studied.plan.every;
        let _ = writeln!(text, "Of crouches one frame in {every} is tracked.\n");
    }
    for sheet in tables(studied) {
        text.push_str(&sheet.markdown());
        text.push('\n');
        if let (true, Some(picture)) = (sheet.name == "table2", picture) {
            let words = "Deviation of the centre from the law over the three angles, with artefact";
            let _ = writeln!(text, "## Figure 3: deviation over the angles of crouches\n");
            let _ = writeln!(text, "![{words}]({picture})\n");
        }
    }
    text.push_str("## What is wrong with the printed numbers\n\n");
    for error in printed::ERRORS {
        let _ = writeln!(text, "- {error}");
    }
    text
}
