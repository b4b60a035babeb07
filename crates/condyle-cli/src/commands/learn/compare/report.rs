//! All numbers of a comparison, in JSON.

use condyle::learn::arms::Arm;
use condyle::learn::coupling::ScaleRule;
use condyle::learning::arms::{Compared, Person, gains, groups};
use serde_json::{Map, Value, json};

/// The report; `models` are the files of every comparison, part and arm, where they were written.
pub(super) fn json(
    persons: &[Person],
    compared: &[Compared],
    models: &[Vec<Vec<String>>],
) -> Value {
    let all = groups(persons, compared);
    let gained = gains(&all);
    let arms =
        Arm::COMPARED.map(|arm| json!({ "arm": arm.name(), "coordinates": arm.coordinates() }));
    let person = |person: &Person| {
        json!({
            "name": person.name,
            "trials": person.trials.iter().map(|t| json!({
                "name": t.name, "motion": t.groups.motion, "sub_motion": t.groups.sub_motion,
                "frames": t.recording.frames(),
            })).collect::<Vec<_>>(),
            "standing_m": person.leg.standing(),
            "planar_factor": person.leg.planar_factor(),
            "sizes_m": person.sizes.map(|s| json!({ "length": s.length, "width": s.width })),
        })
    };
    let trial = |(at, one): (usize, &Compared)| {
        let person = persons.get(one.person);
        let trial = person.and_then(|person| person.trials.get(one.trial));
        let mut left = Map::new();
        for (arm, residuals) in &one.arms {
            let numbers = json!({
                "rms_mm": 1e3 * residuals.mean(),
                "max_mm": 1e3 * residuals.most(),
                "sum_m": residuals.sum(),
                "frames": residuals.frames(),
                "unsolved": residuals.unsolved(),
                "unseen": residuals.unseen(),
            });
            left.insert(arm.name().to_owned(), numbers);
        }
        let parts = one.parts.iter().enumerate().map(|(part, own)| {
            let times = trial.map(|t| &t.recording.times);
            let time = |frame: usize| times.and_then(|times| times.get(frame)).copied();
            let files = models.get(at).and_then(|parts| parts.get(part)).map(|names| {
                let named = Arm::COMPARED.iter().zip(names);
                named.map(|(arm, file)| (arm.name().to_owned(), json!(file))).collect::<Map<_, _>>()
            });
            json!({
                "frames": [own.frames.start, own.frames.end],
                "times": [time(own.frames.start), time(own.frames.end.saturating_sub(1))],
                "learned_from_frames": own.centre.frames,
                "mean_m": own.centre.mean,
                "c4_m": own.centre.at_zero(),
                "best_m": own.centre.best,
                "models": files,
            })
        });
        json!({
            "question": one.question.name(),
            "person": person.map(|p| p.name.clone()),
            "trial": trial.map(|t| t.name.clone()),
            "motion": trial.map(|t| t.groups.motion.clone()),
            "learned_from": one.learned_from,
            "parts": parts.collect::<Vec<_>>(),
            "arms": left,
        })
    };
    let gain = |own: &condyle::learning::arms::Gains| {
        json!({
            "question": own.question.name(),
            "motion": own.motion,
            "from": own.gain.arms()[0].name(),
            "to": own.gain.arms()[1].name(),
            "shares": own.shares,
            "mean": own.mean(),
            "sd": own.deviation(),
        })
    };
    let scaled = persons.iter().enumerate().flat_map(|(from, one)| {
        persons.iter().enumerate().filter(move |(to, _)| *to != from).filter_map(
            move |(_, other)| {
                let (from, to) = (one.sizes?, other.sizes?);
                Some(json!({
                    "from": one.name,
                    "to": other.name,
                    "equation_3": from.ratios_to(to).factors(ScaleRule::Mean),
                    "per_axis": from.ratios_to(to).factors(ScaleRule::PerAxis),
                }))
            },
        )
    });
    json!({
        "arms": arms,
        "persons": persons.iter().map(person).collect::<Vec<_>>(),
        "scaling": scaled.collect::<Vec<_>>(),
        "trials": compared.iter().enumerate().map(trial).collect::<Vec<_>>(),
        "gains": gained.iter().map(gain).collect::<Vec<_>>(),
    })
}
