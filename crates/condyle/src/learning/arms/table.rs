//! Markdown and CSV.

use super::compared::{Compared, Question};
use super::person::Person;
use super::sums::{Gain, gains, groups};
use std::fmt::Write as _;

fn told(question: Question) -> &'static str {
    match question {
        Question::OtherTrials => {
            "Each trial is left out and tracked with what all other trials of the same person say."
        }
        Question::SameMotion => {
            "Learned from other trials of the same person and the same kind of motion. Where a trial is the only one of its kind, \
             blocks of time in it are left out in turn: they are near to what the law was learned from."
        }
        Question::OtherMotions => {
            "Learned from the same person's motions of other kinds (experiment 2 of Pronost et al. 2010)."
        }
        Question::OtherPersons => {
            "Learned from all other persons and scaled by (s1 + s2)/2 (experiment 1 and equation 3 of Pronost et al. 2010)."
        }
        Question::OtherPersonsPerAxis => {
            "Learned from all other persons and scaled by s1 along the thigh, s2 across it and their mean forward."
        }
    }
}

/// The tables for people: for each question, person and motion what every arm leaves, then the gains.
///
/// RMS is the mean over frames of the root mean square over markers, in mm; the sum is over the frames of a trial, in m, and the mean
/// over trials, as in Table 3 of Pronost et al. 2010.
#[must_use]
pub fn markdown(persons: &[Person], compared: &[Compared]) -> String {
    let all = groups(persons, compared);
    let gained = gains(&all);
    let mut out = String::from("# Joints compared\n");
    for question in Question::ALL {
        let own: Vec<_> = all.iter().filter(|group| group.question == question).collect();
        if own.is_empty() {
            continue;
        }
        let _ = writeln!(out, "\n## {}\n\n{}\n", question.name(), told(question));
        out.push_str("| person | motion | trials | arm | free | RMS mm | max mm | sum m | frames | unsolved |\n");
        out.push_str("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
        for group in &own {
            let person = persons.get(group.person).map_or("", |person| person.name.as_str());
            let trials = match group.in_blocks {
                0 => group.trials.to_string(),
                n if n == group.trials => format!("{n} in blocks"),
                n => format!("{}, {n} of them in blocks", group.trials),
            };
            for (arm, sum) in &group.arms {
                let _ = writeln!(
                    out,
                    "| {person} | {} | {trials} | {} | {} | {:.2} | {:.1} | {:.3} | {} | {} |",
                    group.motion,
                    arm.name(),
                    arm.coordinates(),
                    1e3 * sum.mean,
                    1e3 * sum.most,
                    sum.sum,
                    sum.frames,
                    sum.unsolved
                );
            }
        }
        out.push_str("\n| motion | persons |");
        for gain in Gain::ALL {
            let _ = write!(out, " {} |", gain.name());
        }
        out.push_str("\n| --- | --- |");
        Gain::ALL.iter().for_each(|_| out.push_str(" --- |"));
        out.push('\n');
        let own: Vec<_> = gained.iter().filter(|gains| gains.question == question).collect();
        for four in own.chunks(Gain::ALL.len()) {
            let Some(first) = four.first() else { continue };
            let _ = write!(out, "| {} | {} |", first.motion, first.shares.len());
            for gains in four {
                let _ = match gains.deviation() {
                    Some(deviation) => {
                        write!(out, " {:.1} ± {:.1} % |", 1e2 * gains.mean(), 1e2 * deviation)
                    }
                    None => write!(out, " {:.1} % |", 1e2 * gains.mean()),
                };
            }
            out.push('\n');
        }
    }
    out
}

/// One line for each question, trial and arm, with a line of names above: lengths in mm, the sum in m.
#[must_use]
pub fn csv(persons: &[Person], compared: &[Compared]) -> String {
    let mut out = String::from(
        "question,person,motion,sub_motion,trial,learned_from,blocks,arm,free,rms_mm,max_mm,sum_m,frames,unsolved,unseen\n",
    );
    for one in compared {
        let Some(person) = persons.get(one.person) else { continue };
        let Some(trial) = person.trials.get(one.trial) else { continue };
        for (arm, residuals) in &one.arms {
            let texts = [
                one.question.name(),
                &person.name,
                &trial.groups.motion,
                &trial.groups.sub_motion,
                &trial.name,
                &one.learned_from.join(" "),
            ]
            .map(|text| format!("\"{}\"", text.replace('"', "\"\"")));
            let _ = writeln!(
                out,
                "{},{},{},{},{:.6},{:.6},{:.9},{},{},{}",
                texts.join(","),
                one.parts.len(),
                arm.name(),
                arm.coordinates(),
                1e3 * residuals.mean(),
                1e3 * residuals.most(),
                residuals.sum(),
                residuals.frames(),
                residuals.unsolved(),
                residuals.unseen()
            );
        }
    }
    out
}
