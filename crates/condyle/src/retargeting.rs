//! A motion of one humanoid figure for another, by the names of their bones.
//!
//! Which bone is which part of the body is told by a table of names: a document of kind `names` whose keys are
//! parts ([`Part::name`]: `pelvis`, `spine`, `neck`, `head`, `clavicle_r`, `upper_arm_r`, `forearm_r`, `hand_r`,
//! `index_1_r`, `thigh_r`, `shank_r`, `foot_r`, `toes_r` and so on; tips `hand_tip_r`, `ball_r`, `toe_tip_r`;
//! `ankle_r` where the ankle is not the joint of `foot_r`) and whose values are the names that the part may
//! have, the likeliest first. Those of `spine` are all used, from the pelvis upwards; the last that is there is the
//! chest. Case, spaces and separators in names do not count, and a prefix that all bones share is left out.
//!
//! [`recognise`] tries the shipped tables ([`shipped::skeletons`]) and takes the one that names most parts; where none
//! does, the tree of the bones tells.
//!
//! What is computed, and how, is said at [`condyle_track::retarget`].

mod tree;

use crate::shipped;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_formats::document::names::{self, NameTable};
use condyle_model::Model;
pub use condyle_track::retarget::{
    Anchor, Body, Finger, Fit, Humanoid, Options, Part, Report, Retargeted, Side, Sliding,
    retarget, standing,
};
use std::collections::HashMap;

/// Which bones of a model are which parts, and how that is known.
#[derive(Clone, Debug)]
pub struct Recognised {
    /// The parts.
    pub body: Body,
    /// The table that named most: its name; of the user's own `--names`; `None` where the tree told.
    pub table: Option<String>,
    /// How many parts are named.
    pub named: usize,
    /// What was guessed.
    pub warnings: Vec<Diagnostic>,
}

/// The parts without which nothing is told by a table: those that one must have, and pairs.
const FEWEST: usize = 6;

/// Which bones of a model are which parts. Names of the table `own` count before those of shipped ones.
///
/// # Errors
/// `retarget/names` where neither names nor the tree of the bones tell the parts of a human.
///
/// ```
/// use condyle::retargeting::{Part, Side, recognise};
/// let human = condyle::open::model("human".as_ref())?.value;
/// let parts = recognise(&human, None)?;
/// assert_eq!(parts.table.as_deref(), Some("human"));
/// let forearm = parts.body.get(Part::Forearm(Side::Right)).unwrap();
/// assert_eq!(human.segment(forearm.segment).name, "ulna_r");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn recognise(model: &Model, own: Option<&NameTable>) -> Result<Recognised, Error> {
    let places = Places::of(model);
    let mut best: Option<(usize, String, Body)> = None;
    let shipped = shipped::skeletons().filter_map(|(name, text)| {
        let table = names::read(text, &mut |_| Err("it stands alone".to_owned())).ok()?.value;
        Some((name.to_owned(), table))
    });
    let tables = own.map(|own| ("--names".to_owned(), own.clone())).into_iter().chain(shipped);
    for (name, table) in tables {
        for prefix in &places.prefixes {
            let body = places.body(model, &table, prefix);
            let count = told(&body);
            // A user's own table wins where it says anything that can be used.
            let before = best.as_ref().map_or(0, |(count, own, _)| {
                if own == "--names" && *count >= FEWEST { usize::MAX } else { *count }
            });
            if count > before {
                best = Some((count, name.clone(), body));
            }
        }
    }
    match best.filter(|(count, _, body)| *count >= FEWEST && stands(body)) {
        Some((named, table, mut body)) => {
            places.tips(model, &mut body);
            Ok(Recognised { body, table: Some(table), named, warnings: vec![] })
        }
        None => {
            let mut body = tree::guess(model)?;
            places.tips(model, &mut body);
            let named = told(&body);
            let message = format!(
                "no table names the bones of model `{}`: their tree tells them",
                model.name()
            );
            let warning = Diagnostic::warning("retarget/guessed-parts", message)
                .with_help("say which is which with --names TABLE");
            Ok(Recognised { body, table: None, named, warnings: vec![warning] })
        }
    }
}

/// How many parts a figure has, tips and fingers not counted.
fn told(body: &Body) -> usize {
    let counted = |part: &Part| !part.is_tip() && !matches!(part, Part::Finger(..));
    body.parts().filter(|(part, _)| counted(part)).count()
}

/// Whether there is what [`retarget`] must have.
fn stands(body: &Body) -> bool {
    let both = |part: fn(Side) -> Part| Side::BOTH.iter().all(|s| body.get(part(*s)).is_some());
    let trunk = body.get(Part::Pelvis).or(body.get(Part::Chest)).is_some();
    trunk && (both(Part::Thigh) || both(Part::UpperArm))
}

/// The segments and markers of a model by their names without case and separators.
struct Places {
    named: Vec<(String, Anchor, bool)>,
    /// What may stand before the names that a table has.
    prefixes: Vec<String>,
}

/// Without case and separators.
fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

impl Places {
    fn of(model: &Model) -> Self {
        let mut named = vec![];
        for id in model.segment_ids() {
            let segment = model.segment(id);
            let point = segment.joint_in_segment.translation;
            named.push((plain(&segment.name), Anchor { segment: id, point }, true));
        }
        for marker in model.markers() {
            if let Some(segment) = marker.segment {
                named.push((plain(&marker.name), Anchor { segment, point: marker.point }, false));
            }
        }
        let mut prefixes = vec![String::new()];
        for segment in model.segments() {
            // All up to a colon or a bar, and words before which others stand: `Bip01 `, `DEF-`.
            for (place, sign) in segment.name.char_indices() {
                if matches!(sign, ':' | '|' | ' ' | '-' | '_' | '.') {
                    prefixes.push(plain(&segment.name[..place]));
                }
            }
        }
        let segments = || named.iter().filter(|(_, _, bone)| *bone);
        if let Some((first, ..)) = segments().next() {
            let shared = segments().fold(first.as_str(), |shared, (name, ..)| {
                let same = shared.chars().zip(name.chars()).take_while(|(a, b)| a == b);
                let length: usize = same.map(|(c, _)| c.len_utf8()).sum();
                &shared[..length]
            });
            prefixes.push(shared.to_owned());
        }
        prefixes.sort();
        // A prefix stands before several names.
        let several = |prefix: &String| {
            segments().filter(|(name, ..)| name.starts_with(&**prefix)).count() > 5
        };
        prefixes.dedup();
        prefixes.retain(several);
        Self { named, prefixes }
    }

    /// The parts that a table names.
    fn body(&self, model: &Model, table: &NameTable, prefix: &str) -> Body {
        let mut places: HashMap<&str, (Anchor, bool)> = HashMap::new();
        for (name, anchor, bone) in &self.named {
            if let Some(own) = name.strip_prefix(prefix) {
                places.entry(own).or_insert((*anchor, *bone));
            }
        }
        let find = |name: &String| places.get(plain(name).as_str()).copied();
        let mut body = Body::default();
        for (part, names) in table {
            if part == "spine" {
                let mut spine: Vec<Anchor> =
                    names.iter().filter_map(find).filter(|p| p.1).map(|p| p.0).collect();
                let chest = spine.pop();
                for (number, anchor) in spine.iter().take(24).enumerate() {
                    body.set(model, Part::Spine(number as u8), anchor.segment);
                }
                if let Some(chest) = chest {
                    body.set(model, Part::Chest, chest.segment);
                }
            } else if let Some(part) = Part::named(part) {
                let found = names.iter().filter_map(find).find(|(_, bone)| *bone || part.is_tip());
                if let Some((anchor, _)) = found {
                    body.set_point(part, anchor);
                }
            }
        }
        body
    }

    /// Tips that no table names: the end that a reader marked on the last bone.
    fn tips(&self, model: &Model, body: &mut Body) {
        for side in Side::BOTH {
            let mut of =
                vec![(Part::ToeTip(side), Part::Toes(side)), (Part::Ball(side), Part::Foot(side))];
            of.push((Part::HandTip(side), Part::Hand(side)));
            for finger in Finger::ALL {
                of.push((Part::Finger(side, finger, 3), Part::Finger(side, finger, 2)));
            }
            for (tip, part) in of {
                let Some(anchor) = body.get(part).filter(|_| body.get(tip).is_none()) else {
                    continue;
                };
                // A foot with toes ends at these.
                if matches!(tip, Part::Ball(side) if body.get(Part::Toes(side)).is_some()) {
                    continue;
                }
                let segment = plain(&model.segment(anchor.segment).name);
                let ends = self.named.iter().filter(|(name, end, bone)| {
                    let own =
                        name.starts_with(&segment) || name.contains("end") || name.contains("site");
                    !bone && end.segment == anchor.segment && own
                });
                let far = |end: &Anchor| (end.point - anchor.point).norm();
                let end = ends.map(|(_, end, _)| *end).max_by(|a, b| far(a).total_cmp(&far(b)));
                if let Some(end) = end.filter(|end| far(end) > 1e-4) {
                    body.set_point(tip, end);
                }
            }
        }
    }
}
