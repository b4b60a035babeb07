//! The tables of the study.

use super::printed;
use super::unseen::{OTHER_MOTION, SCALED};
use super::{Cell, Learned, Run, Sheet, Studied};
use condyle_learn::arms::Arm;
use condyle_learn::coupling::Law;
use condyle_learn::study::{Knee, Skin};

/// Motions in the order of [`Run::learned`].
const MOTIONS: [&str; 2] = ["gait", "crouch"];
const AXES: [&str; 3] = ["T_x", "T_y", "T_z"];
const ANGLES: [&str; 3] = ["flexion", "adduction", "rotation"];
/// Of a true slope of less, in metres per radian, shares say nothing.
const NAMED: f64 = 1e-4;

fn text(words: &str) -> Cell {
    Cell::Text(words.to_owned())
}

/// A number of millimetres.
fn mm(metres: f64) -> Cell {
    Cell::Number(1e3 * metres, 2)
}

/// The mean and the standard deviation of some numbers; the latter is no number of one.
fn spread(values: &[f64], digits: usize) -> Cell {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    match values.len() {
        0 => Cell::Empty,
        1 => Cell::Number(mean, digits),
        _ => Cell::Spread(mean, variance.sqrt(), digits),
    }
}

impl Studied {
    fn head(&self, run: &Run) -> [Cell; 2] {
        let name = self.people.get(run.person).map_or("", |person| person.name.as_str());
        [text(name), text(run.skin.name())]
    }

    fn with(&self, skin: Skin) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(move |run| run.skin == skin)
    }
}

/// All tables, in the order in which they are told.
#[must_use]
pub fn tables(studied: &Studied) -> Vec<Sheet> {
    vec![
        people(studied),
        coefficients(
            studied,
            1,
            "table1",
            "Table 1: coefficients of crouches, 95 % interval, truth",
        ),
        table_1_printed(),
        coefficients(studied, 0, "table1-gait", "The same of gaits"),
        intervals(studied),
        bias(studied),
        table_2(studied),
        judged(studied),
        validity(studied),
        table_3(studied),
        by_person(studied),
        less(studied),
        table_4(studied),
        table_5(studied),
        angles(studied),
    ]
}

fn people(studied: &Studied) -> Sheet {
    let head = [
        "person",
        "stature, m",
        "trochanter to knee, m",
        "epicondyles apart, m",
        "true knee",
        "axes turned from landmarks, °",
        "frames of gait",
        "frames of crouch",
    ];
    let mut sheet = Sheet::new("people", "People", &head);
    for run in studied.with(Skin::Rigid) {
        let Some(person) = studied.people.get(run.person) else { continue };
        let tilt = person.tilt[0].hypot(person.tilt[1]).to_degrees();
        let frames = |k: usize| Cell::Number(run.learned[k].frames.iter().sum::<usize>() as f64, 0);
        sheet.rows.push(vec![
            text(&person.name),
            Cell::Number(person.stature, 2),
            Cell::Number(person.thigh, 4),
            Cell::Number(person.width, 4),
            text(person.knee.name()),
            Cell::Number(tilt, 1),
            frames(0),
            frames(1),
        ]);
    }
    sheet
}

fn coefficients(studied: &Studied, motion: usize, name: &'static str, title: &str) -> Sheet {
    let head = [
        "person",
        "markers",
        "place",
        "flexion, m/rad",
        "adduction, m/rad",
        "rotation, m/rad",
        "constant, m",
        "R²",
        "left-out RMS, mm",
        "truth beside a line, RMS mm",
    ];
    let mut sheet = Sheet::new(name, title, &head);
    for run in &studied.runs {
        let learned = &run.learned[motion];
        for (axis, (law, truth)) in learned.laws.laws.iter().zip(&learned.truth).enumerate() {
            let [person, skin] = studied.head(run);
            let mut row = vec![person, skin, text(AXES[axis])];
            for angle in 0..3 {
                row.push(Cell::Estimate {
                    value: law.coefficients[angle],
                    interval: law.ci95[angle + 1],
                    truth: truth.slopes[angle],
                });
            }
            row.push(Cell::Estimate {
                value: law.intercept,
                interval: law.ci95[0],
                truth: Some(truth.intercept),
            });
            row.push(Cell::Number(law.r2, 3));
            row.push(law.left_out.as_ref().map_or(Cell::Empty, |left| mm(left.rmse)));
            row.push(mm(truth.left));
            sheet.rows.push(row);
        }
    }
    sheet.notes.push(
        "In round brackets the truth: the law itself of linear knees, otherwise the linear law nearest to the centres of the bones on the same frames. - is what these data \
         cannot tell, since the bones do not turn there but as flexion says: what is learned of it is noise and skin. Angles are those about \
         the axes z, x and y of the thigh, negative in flexion."
            .to_owned(),
    );
    sheet
}

fn table_1_printed() -> Sheet {
    let head = ["coefficient", "1", "2", "3", "4", "5", "6"];
    let mut sheet = Sheet::new("table1-printed", "Table 1 as Pronost et al. 2010 print it", &head);
    for (axis, coefficients) in printed::TABLE_1.iter().enumerate() {
        for (index, values) in coefficients.iter().enumerate() {
            let mut row = vec![text(&format!("{} c{}", AXES[axis], index + 1))];
            row.extend(values.iter().map(|x| Cell::Number(*x, 4)));
            sheet.rows.push(row);
        }
    }
    sheet
}

/// Every coefficient that data can tell: learned, its interval, the truth, whether it is a slope.
fn told(learned: &Learned) -> impl Iterator<Item = (f64, [f64; 2], f64, Option<usize>)> + '_ {
    learned.laws.laws.iter().zip(&learned.truth).flat_map(|(law, truth)| {
        let slopes = (0..3).filter_map(|angle| {
            let truth = truth.slopes[angle]?;
            Some((law.coefficients[angle], law.ci95[angle + 1], truth, Some(angle)))
        });
        slopes.chain([(law.intercept, law.ci95[0], truth.intercept, None)])
    })
}

fn intervals(studied: &Studied) -> Sheet {
    let head = [
        "motion",
        "knee",
        "markers",
        "coefficients with a truth",
        "95 % intervals that hold it",
        "slopes within 10 %",
        "slopes over flexion, others with it, within 10 %",
    ];
    let title = "What intervals hold: chance, not skin";
    let mut sheet = Sheet::new("intervals", title, &head);
    let is_linear = |run: &&Run| {
        let person = studied.people.get(run.person);
        person.is_some_and(|p| matches!(p.knee, Knee::Linear(_)))
    };
    for motion in [1, 0] {
        for linear in [true, false] {
            for skin in [Skin::Rigid, Skin::Moving] {
                let runs: Vec<&Run> =
                    studied.with(skin).filter(|run| is_linear(run) == linear).collect();
                if runs.is_empty() {
                    continue;
                }
                let all: Vec<_> = runs.iter().flat_map(|run| told(&run.learned[motion])).collect();
                let held = all.iter().filter(|(_, ci, truth, _)| (ci[0]..=ci[1]).contains(truth));
                let slopes = all.iter().filter(|told| told.3.is_some());
                let slopes: Vec<(f64, f64)> = slopes.map(|(x, _, truth, _)| (*x, *truth)).collect();
                let along = |run: &&Run| {
                    let [tracked, truth] = run.learned[motion].along;
                    tracked.into_iter().zip(truth).collect::<Vec<_>>()
                };
                let along: Vec<(f64, f64)> = runs.iter().flat_map(along).collect();
                sheet.rows.push(vec![
                    text(MOTIONS[motion]),
                    text(if linear { "linear" } else { "not linear" }),
                    text(skin.name()),
                    Cell::Number(all.len() as f64, 0),
                    Cell::Number(held.count() as f64, 0),
                    text(&near(&slopes)),
                    text(&near(&along)),
                ]);
            }
        }
    }
    sheet.notes.push(
        "Intervals are about what differs by chance from trial to trial. What is the same in all trials of a person moves the law itself, and no statistics of the same markers shows it: intervals \
         get no wider, and the truth is outside. Skin is the largest such thing; the others are angles shrunk by noise, and the standing trial, in which 0.07 mm of noise on the mean of \
         each epicondyle turn the axes by a milliradian, and the constants move by half a millimetre. Of slopes those count whose truth is more than 0.1 mm/rad."
            .to_owned(),
    );
    sheet
}

/// How many slopes are within a tenth of their truth, of those whose truth is worth naming.
fn near(slopes: &[(f64, f64)]) -> String {
    let told: Vec<_> = slopes.iter().filter(|(_, truth)| truth.abs() > NAMED).collect();
    let near = told.iter().filter(|(x, truth)| (x / truth - 1.0).abs() < 0.1);
    format!("{} of {}", near.count(), told.len())
}

fn bias(studied: &Studied) -> Sheet {
    let head = [
        "person",
        "motion",
        "place",
        "angle",
        "truth, m/rad",
        "without artefact",
        "with artefact",
        "bias, m/rad",
        "bias over truth",
    ];
    let title = "What skin adds to slopes";
    let mut sheet = Sheet::new("bias", title, &head);
    let (mut flexion, mut shares): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
    for (index, person) in studied.people.iter().enumerate() {
        let [Some(rigid), Some(moving)] =
            [Skin::Rigid, Skin::Moving].map(|skin| studied.of(index, skin))
        else {
            continue;
        };
        for motion in [1, 0] {
            for axis in 0..3 {
                let mut row = |angle: &str, truth: f64, [without, with]: [f64; 2]| {
                    let added = with - without;
                    let share = if truth.abs() > NAMED { added / truth } else { f64::NAN };
                    sheet.rows.push(vec![
                        text(&person.name),
                        text(MOTIONS[motion]),
                        text(AXES[axis]),
                        text(angle),
                        Cell::Number(truth, 4),
                        Cell::Number(without, 4),
                        Cell::Number(with, 4),
                        Cell::Number(added, 4),
                        Cell::Number(share, 2),
                    ]);
                    (added, share)
                };
                let both = [rigid, moving].map(|run| &run.learned[motion]);
                let along = both.map(|learned| learned.along[0][axis]);
                let (added, share) = row("flexion, others with it", both[0].along[1][axis], along);
                if motion == 1 {
                    flexion.push(1e3 * added.abs());
                    shares.extend(Some(share.abs()).filter(|s| s.is_finite()));
                }
                for angle in 0..3 {
                    let Some(truth) = both[0].truth[axis].slopes[angle] else { continue };
                    let slopes = both.map(|learned| learned.laws.laws[axis].coefficients[angle]);
                    row(ANGLES[angle], truth, slopes);
                }
            }
        }
    }
    shares.sort_by(f64::total_cmp);
    let middle = shares.get(shares.len() / 2).copied().unwrap_or(f64::NAN);
    let mean = flexion.iter().sum::<f64>() / flexion.len().max(1) as f64;
    let most = flexion.iter().copied().fold(0.0, f64::max);
    sheet.notes.push(format!(
        "Slopes over flexion, the other angles with it, in crouches: skin adds {mean:.1} mm/rad on average over people and axes, at most {most:.1}; the median of \\|bias/truth\\| is {middle:.2}. The slopes of flexion that Pronost et al. 2010 print \
         are 14 to 58 mm/rad in T_x and T_y, those of the bones of Yamaguchi & Zajac about 5 in T_x."
    ));
    sheet
}

fn table_2(studied: &Studied) -> Sheet {
    let head = [
        "person",
        "markers",
        "crouch, mm",
        "crouch by variety, mm",
        "gait, mm",
        "markers left, crouch, mm",
        "markers left, gait, mm",
        "printed: crouch / by variety / gait, mm",
    ];
    let title = "Table 2: mean distance between the centre tracked and that of the law";
    let mut sheet = Sheet::new("table2", title, &head);
    for run in &studied.runs {
        let [gait, crouch] = &run.learned;
        let printed = printed::TABLE_2.get(run.person).filter(|_| run.skin == Skin::Moving);
        let [person, skin] = studied.head(run);
        sheet.rows.push(vec![
            person,
            skin,
            mm(crouch.deviation),
            crouch.deviation_by_variety.map_or(Cell::Empty, mm),
            mm(gait.deviation),
            mm(crouch.left),
            mm(gait.left),
            printed.map_or(Cell::Empty, |[c, v, g]| text(&format!("{c:.1} / {v:.1} / {g:.1}"))),
        ]);
    }
    for skin in [Skin::Rigid, Skin::Moving] {
        let means = |f: &dyn Fn(&Run) -> Option<f64>| -> Cell {
            let values: Vec<f64> = studied.with(skin).filter_map(f).map(|x| 1e3 * x).collect();
            spread(&values, 2)
        };
        sheet.rows.push(vec![
            text("all"),
            text(skin.name()),
            means(&|run| Some(run.learned[1].deviation)),
            means(&|run| run.learned[1].deviation_by_variety),
            means(&|run| Some(run.learned[0].deviation)),
            means(&|run| Some(run.learned[1].left)),
            means(&|run| Some(run.learned[0].left)),
            text(if skin == Skin::Moving { "1.32 / 0.98 / 1.55" } else { "" }),
        ]);
    }
    sheet
}

fn judged(studied: &Studied) -> Sheet {
    let head = [
        "person",
        "markers",
        "motion",
        "condition",
        "accepted: T_x, T_y, T_z",
        "left-out RMS over that of the mean: T_x, T_y, T_z",
    ];
    let title = "Where laws hold and where they do not";
    let mut sheet = Sheet::new("judged", title, &head);
    for run in &studied.runs {
        for motion in [1, 0] {
            let laws = &run.learned[motion].laws;
            let each = |f: &dyn Fn(&Law) -> String| {
                text(&laws.laws.iter().map(f).collect::<Vec<_>>().join(", "))
            };
            let [person, skin] = studied.head(run);
            sheet.rows.push(vec![
                person,
                skin,
                text(MOTIONS[motion]),
                Cell::Number(laws.condition, 1),
                each(&|law| if law.accepted() { "yes" } else { "no" }.to_owned()),
                each(&|law| match &law.left_out {
                    Some(left) => format!("{:.2}", left.rmse / left.rmse_of_mean),
                    None => "-".to_owned(),
                }),
            ]);
        }
    }
    sheet.notes.push(
        "The ratio is that of the error on trials left out by the law of the others to that by the best fixed place: 1 where a law is worth nothing. Beyond a condition of 30 the angles move nearly together, and \
         single coefficients mean little."
            .to_owned(),
    );
    sheet
}

fn validity(studied: &Studied) -> Sheet {
    let head = [
        "markers",
        "motion",
        "place",
        "laws",
        "max|M·C - E| < min(E)",
        "max|M·C - E| < min|E|",
        "largest deviation, mm",
        "least |E|, mm",
    ];
    let title = "The validity test of Pronost et al. 2010, in both readings";
    let mut sheet = Sheet::new("validity", title, &head);
    for skin in [Skin::Rigid, Skin::Moving] {
        for motion in [1, 0] {
            for axis in 0..3 {
                let laws = studied.with(skin).map(|run| &run.learned[motion].laws.laws[axis]);
                let all: Vec<_> = laws.filter_map(|law| law.validity.as_ref()).collect();
                let count = |f: &dyn Fn(&condyle_learn::coupling::Validity) -> bool| {
                    Cell::Number(all.iter().filter(|v| f(v)).count() as f64, 0)
                };
                sheet.rows.push(vec![
                    text(skin.name()),
                    text(MOTIONS[motion]),
                    text(AXES[axis]),
                    Cell::Number(all.len() as f64, 0),
                    count(&|v| v.signed()),
                    count(&|v| v.absolute()),
                    mm(all.iter().map(|v| v.largest).fold(0.0, f64::max)),
                    mm(all.iter().map(|v| v.least_absolute).fold(f64::INFINITY, f64::min)),
                ]);
            }
        }
    }
    sheet.notes.push(
        "With its sign it never holds of T_y, which is negative; with |E| it always does, whatever the law. Of T_x and T_z it says how far the centre happens to be from the plane of the trochanter."
            .to_owned(),
    );
    sheet
}

fn table_3(studied: &Studied) -> Sheet {
    let head = [
        "markers",
        "knee",
        "free coordinates",
        "gait, m a trial",
        "gait, mm a frame",
        "gait, largest mm",
        "crouch, m a trial",
        "crouch, mm a frame",
        "crouch, largest mm",
    ];
    let title = "Table 3: markers left on trials that no law has seen";
    let mut sheet = Sheet::new("table3", title, &head);
    for skin in [Skin::Rigid, Skin::Moving] {
        for arm in Arm::COMPARED {
            let (knee, free) = (arm.name(), arm.coordinates());
            let mut row = vec![text(skin.name()), text(knee), Cell::Number(free as f64, 0)];
            for gait in [true, false] {
                let followed = || {
                    let all = studied.with(skin).flat_map(|run| &run.unseen);
                    all.filter(|f| f.gait == gait && f.knee == knee)
                };
                row.push(spread(&followed().map(super::Followed::sum).collect::<Vec<_>>(), 3));
                row.push(spread(&followed().map(|f| 1e3 * f.rms()).collect::<Vec<_>>(), 2));
                row.push(Cell::Number(1e3 * followed().map(|f| f.largest).fold(0.0, f64::max), 1));
            }
            sheet.rows.push(row);
        }
    }
    for (gait, values) in printed::TABLE_3.iter().enumerate() {
        let words = ["gait", "crouch"][gait];
        sheet.notes.push(format!(
            "Printed for subject 1, {words}, in m: hinge {}, planar {}, three rotations with the learned centre {}.",
            values[0], values[1], values[2]
        ));
    }
    sheet
}

fn by_person(studied: &Studied) -> Sheet {
    let names = Arm::COMPARED.map(Arm::name);
    let head = [&["person", "markers", "motion"], &names[..]].concat();
    let title = "The same by person, mm a frame";
    let mut sheet = Sheet::new("table3-people", title, &head);
    for run in &studied.runs {
        for (motion, gait) in [true, false].into_iter().enumerate() {
            let [person, skin] = studied.head(run);
            let mut row = vec![person, skin, text(MOTIONS[motion])];
            row.extend(names.map(|name| {
                let found = run.unseen.iter().find(|f| f.gait == gait && f.knee == name);
                found.map_or(Cell::Empty, |f| mm(f.rms()))
            }));
            sheet.rows.push(row);
        }
    }
    sheet.notes.push(
        "The knee of s5 is the planar one, and there no law is nearer; that of s6 is it about axes that are not those of the landmarks."
            .to_owned(),
    );
    sheet
}

/// By how much per cent the sum of one knee is less than that of another, person by person.
fn reductions(studied: &Studied, skin: Skin, gait: bool, knee: &str, than: &str) -> Vec<f64> {
    studied
        .with(skin)
        .filter_map(|run| {
            let of = |name: &str| {
                run.unseen
                    .iter()
                    .find(|f| f.gait == gait && f.knee == name)
                    .map(super::Followed::sum)
            };
            Some(100.0 * (1.0 - of(knee)? / of(than)?))
        })
        .collect()
}

fn less(studied: &Studied) -> Sheet {
    let head = [
        "knee",
        "than",
        "gait without artefact, %",
        "gait with artefact, %",
        "crouch without artefact, %",
        "crouch with artefact, %",
        "printed: gait, crouch, %",
    ];
    let title = "By how much markers left are less, over people";
    let mut sheet = Sheet::new("reductions", title, &head);
    let pairs = [
        ("learned", "hinge"),
        ("learned", "planar"),
        ("fixed-best", "hinge"),
        ("fixed-best", "planar"),
        ("learned", "fixed-best"),
        ("learned", "fixed"),
        ("learned", "fixed-c4"),
        ("free", "learned"),
        (SCALED[0], "planar"),
        (SCALED[1], "planar"),
        (SCALED[2], "planar"),
        (SCALED[2], "fixed-best"),
    ];
    for (knee, than) in pairs {
        let mut row = vec![text(knee), text(than)];
        let mut some = false;
        for gait in [true, false] {
            for skin in [Skin::Rigid, Skin::Moving] {
                let all = reductions(studied, skin, gait, knee, than);
                some |= !all.is_empty();
                row.push(spread(&all, 0));
            }
        }
        let printed = match (knee, than) {
            ("learned", "hinge") => Some(0),
            ("learned", "planar") => Some(1),
            _ => None,
        };
        row.push(printed.map_or(Cell::Empty, |column| {
            let [gait, crouch] = printed::LESS.map(|motion| motion[column]);
            text(&format!("{} ± {}, {} ± {}", gait.0, gait.1, crouch.0, crouch.1))
        }));
        if some {
            sheet.rows.push(row);
        }
    }
    sheet.notes.push(
        "From hinge to fixed-best, three rotations about the constant that leaves least at the markers, it is the two angles more that gain, from there to learned the moving centre alone: the printed numbers hold both. Negative where the first leaves more: shares of what the planar knee leaves of s5, whose own it is, are large \
         and of little meaning; the table by person tells more."
            .to_owned(),
    );
    sheet
}

/// S3's sums over the trials that a knee followed: mean and standard deviation, in metres.
fn sums(studied: &Studied, skin: Skin, gait: bool, knee: &str) -> Cell {
    let all = studied.with(skin).flat_map(|run| &run.unseen);
    let all = all.filter(|f| f.gait == gait && f.knee == knee);
    spread(&all.map(super::Followed::sum).collect::<Vec<_>>(), 3)
}

fn table_4(studied: &Studied) -> Sheet {
    let head = [
        "markers",
        "motion",
        "own law, m a trial",
        "equation 3, m a trial",
        "per axis, m a trial",
        "slopes per axis, own place, m a trial",
        "equation 3 leaves more, %",
        "per axis leaves more, %",
        "slopes, own place leave more, %",
        "best fixed centre of one's own leaves more, %",
        "printed, subject 1: own, scaled",
    ];
    let title = "Table 4: the law of another person, scaled";
    let mut sheet = Sheet::new("table4", title, &head);
    for skin in [Skin::Rigid, Skin::Moving] {
        for (motion, gait) in [true, false].into_iter().enumerate() {
            let sums = |knee: &str| sums(studied, skin, gait, knee);
            let more = |knee: &str| {
                let less = reductions(studied, skin, gait, knee, Arm::Learned.name());
                spread(&less.iter().map(|less| -less).collect::<Vec<_>>(), 0)
            };
            let printed = printed::TABLE_4[motion];
            sheet.rows.push(vec![
                text(skin.name()),
                text(MOTIONS[motion]),
                sums(Arm::Learned.name()),
                sums(SCALED[0]),
                sums(SCALED[1]),
                sums(SCALED[2]),
                more(SCALED[0]),
                more(SCALED[1]),
                more(SCALED[2]),
                more(Arm::FixedBest.name()),
                text(&format!("{}, {}", printed[0], printed[1])),
            ]);
        }
    }
    sheet.notes.push(
        "The law of the next person, that of the first for the last; s2 to s3, s4 to s5 and s6 to s1 are knees of another kind. Equation 3 multiplies all coefficients, the place of \
         the centre among them, by the mean of two ratios of lengths: markers that lie millimetres beside their landmarks then put the centre a centimetre off. \
         With the place from one's own standing trial only the slopes are another's."
            .to_owned(),
    );
    sheet
}

fn table_5(studied: &Studied) -> Sheet {
    let head = [
        "markers",
        "motion",
        "by the law of gait, m a trial",
        "by the law of crouch, m a trial",
        "the other law leaves more, %",
        "printed, subject 1: gait law, crouch law",
    ];
    let title = "Table 5: a law of one motion used on the other";
    let mut sheet = Sheet::new("table5", title, &head);
    for skin in [Skin::Rigid, Skin::Moving] {
        for (motion, gait) in [true, false].into_iter().enumerate() {
            let sums = |knee: &str| sums(studied, skin, gait, knee);
            let (own, other) = (sums(Arm::Learned.name()), sums(OTHER_MOTION));
            let more = reductions(studied, skin, gait, OTHER_MOTION, Arm::Learned.name());
            let [by_gait, by_crouch] = if gait { [own, other] } else { [other, own] };
            let printed = printed::TABLE_5[motion];
            sheet.rows.push(vec![
                text(skin.name()),
                text(MOTIONS[motion]),
                by_gait,
                by_crouch,
                spread(&more.iter().map(|less| -less).collect::<Vec<_>>(), 0),
                text(&format!("{}, {}", printed[0], printed[1])),
            ]);
        }
    }
    sheet
}

fn angles(studied: &Studied) -> Sheet {
    let head = [
        "person",
        "markers",
        "motion",
        "flexion, °",
        "adduction, °",
        "rotation, °",
        "frames tracked badly",
    ];
    let title = "Angles of the free knee beside those of the bones, RMS";
    let mut sheet = Sheet::new("angles", title, &head);
    for run in &studied.runs {
        for motion in [1, 0] {
            let learned = &run.learned[motion];
            let [person, skin] = studied.head(run);
            let mut row = vec![person, skin, text(MOTIONS[motion])];
            row.extend(learned.angle_errors.map(|e| Cell::Number(e.to_degrees(), 2)));
            row.push(Cell::Number(learned.frames[1] as f64, 0));
            sheet.rows.push(row);
        }
    }
    sheet
}
