//! Which arrays of a file hold the poses, and which joints each of them moves.

use super::archive::Archive;
use super::array::{Array, Rows};
use super::tree::Tree;
use condyle_diagnostics::{Diagnostic, Error, Warnings};

/// All joints in one array.
pub(super) const WHOLE: [&str; 5] = ["poses", "fullpose", "full_pose", "pose", "thetas"];
/// The pelvis alone.
pub(super) const ROOT: [&str; 4] =
    ["root_orient", "global_orient", "root_pose", "root_orientation"];
/// The joints from the hips to the wrists, or to the hands of SMPL.
pub(super) const BODY: [&str; 2] = ["pose_body", "body_pose"];
const JAW: [&str; 2] = ["pose_jaw", "jaw_pose"];
const EYES: [&str; 2] = ["pose_eye", "eye_pose"];
const LEFT_EYE: [&str; 2] = ["leye_pose", "left_eye_pose"];
const RIGHT_EYE: [&str; 2] = ["reye_pose", "right_eye_pose"];
/// Both hands, the left one first.
const HANDS: [&str; 2] = ["pose_hand", "hand_pose"];
const LEFT_HAND: [&str; 3] = ["left_hand_pose", "lhand_pose", "pose_left_hand"];
const RIGHT_HAND: [&str; 3] = ["right_hand_pose", "rhand_pose", "pose_right_hand"];
/// Where the pelvis is.
const PLACES: [&str; 5] = ["trans", "transl", "translation", "root_trans", "root_translation"];
/// How many frames are in a second.
const RATES: [&str; 6] =
    ["mocap_framerate", "mocap_frame_rate", "mocap_fps", "framerate", "frame_rate", "fps"];
/// By how much a figure is larger than its places say.
const SCALES: [&str; 2] = ["scaling", "scale"];
/// What comes before names.
const PREFIXES: [&str; 3] = ["smplx_", "smplh_", "smpl_"];

/// An array that moves joints.
#[derive(Debug)]
pub(super) struct Block<'a> {
    array: Array<'a>,
    /// The first joint it moves, and how many.
    pub(super) first: usize,
    pub(super) joints: usize,
    /// The dimension of the frames; `None` of one frame whose joints are all dimensions.
    along: Option<usize>,
    /// Whether a rotation is nine numbers, row by row.
    pub(super) matrices: bool,
}

impl<'a> Block<'a> {
    /// Its rows, a frame each: three numbers a joint, or nine.
    pub(super) fn rows(&self) -> Result<Rows<'_, 'a>, Error> {
        self.array.rows(self.along)
    }
}

/// What a file holds.
#[derive(Debug)]
pub(super) struct Layout<'a> {
    pub(super) tree: Tree,
    pub(super) blocks: Vec<Block<'a>>,
    pub(super) frames: usize,
    pub(super) places: Option<Array<'a>>,
    /// Frames per second.
    pub(super) rate: Option<f64>,
    /// Whether the rate is that of a recording of markers, as in AMASS.
    pub(super) recorded: bool,
    pub(super) scale: f64,
    pub(super) betas: Vec<f64>,
    pub(super) gender: Option<String>,
}

/// A name without its prefix, in lower case.
fn plain(name: &str) -> String {
    let lower = name.to_ascii_lowercase();
    let rest = PREFIXES.iter().find_map(|prefix| lower.strip_prefix(prefix));
    rest.map_or(lower.clone(), str::to_owned)
}

/// The arrays of an archive by their names.
pub(super) struct Arrays<'a> {
    archive: Archive<'a>,
    names: Vec<String>,
}

impl<'a> Arrays<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        let archive = Archive::open(bytes)?;
        let names = archive.names().map(plain).collect();
        Ok(Self { archive, names })
    }

    pub(super) fn has(&self, names: &[&str]) -> bool {
        names.iter().any(|name| self.names.iter().any(|own| own == name))
    }

    /// The names of all arrays, for messages.
    pub(super) fn listed(&self) -> String {
        let names: Vec<&str> = self.names.iter().map(String::as_str).take(30).collect();
        match names.is_empty() {
            true => "none".to_owned(),
            false => names.join(", "),
        }
    }

    /// The first of these arrays that is there.
    pub(super) fn find(&mut self, names: &[&str]) -> Result<Option<Array<'a>>, Error> {
        for name in names {
            if let Some(index) = self.names.iter().position(|own| own == name) {
                let content = self.archive.content(index)?;
                return Array::read(name, content).map(Some);
            }
        }
        Ok(None)
    }

    /// As [`Arrays::find`], of arrays that can be done without: what is wrong is told.
    fn optional(&mut self, names: &[&str], warnings: &mut Warnings) -> Option<Array<'a>> {
        self.find(names).unwrap_or_else(|error| {
            let said = error.into_diagnostics().into_iter().next();
            let message = said.map_or(String::new(), |said| said.message);
            let said = Diagnostic::warning("smpl/left-out", message);
            warnings.push(said.with_help("it is left out"));
            None
        })
    }
}

/// Finds what a file holds.
pub(super) fn layout<'a>(
    arrays: &mut Arrays<'a>,
    warnings: &mut Warnings,
) -> Result<Layout<'a>, Error> {
    let model_type = arrays.optional(&["surface_model_type", "model_type"], warnings);
    let model_type = model_type.and_then(|array| array.text()).unwrap_or_default();
    let model_type = model_type.to_ascii_lowercase();
    let (tree, mut blocks) = match arrays.find(&WHOLE)? {
        Some(whole) => together(arrays, whole)?,
        None => in_parts(arrays, &model_type, warnings)?,
    };
    blocks.retain(|block| block.joints > 0);
    let mut frames: Option<usize> = None;
    let mut uneven = false;
    for block in &blocks {
        let own = block.rows()?.count;
        // One row beside many holds throughout.
        frames = Some(match frames {
            Some(known) if known != 1 && own != 1 => {
                uneven |= known != own;
                known.min(own)
            }
            Some(known) if own == 1 => known,
            _ => own,
        });
    }
    let mut frames = frames.unwrap_or(0);
    let places = arrays.find(&PLACES)?;
    if let Some(places) = &places {
        let own = match places.shape[..] {
            [3] => 1,
            [count, 3] => count,
            [1, count, 3] | [count, 1, 3] => count,
            _ => {
                let message = format!(
                    "the array `{}` has the shape {:?}: three numbers a frame are places",
                    places.name, places.shape
                );
                return Err(Error::new("smpl/array", message));
            }
        };
        if own != 1 && own != frames {
            uneven = true;
            frames = if frames == 1 { frames } else { frames.min(own) };
        }
    }
    if uneven {
        let message =
            format!("the arrays have different numbers of frames: the first {frames} are read");
        warnings.push(Diagnostic::warning("smpl/frames", message));
    }
    let mut rate = None;
    let mut recorded = false;
    if let Some(array) = arrays.optional(&RATES, warnings) {
        rate = array.scalar().filter(|rate| rate.is_finite() && *rate > 0.0);
        recorded = array.name.starts_with("mocap");
        if rate.is_none() {
            let message = format!("`{}` is no number of frames per second", array.name);
            warnings.push(Diagnostic::warning("smpl/rate", message));
        }
    }
    let scale = arrays.optional(&SCALES, warnings).and_then(|array| array.scalar());
    let betas = match arrays.optional(&["betas", "shape"], warnings) {
        Some(array) if array.is_numeric() && array.len() > 0 => {
            // Of a shape for each frame the first.
            let rows = array.rows(array.shape.len().checked_sub(2))?;
            let numbers = (0..rows.width()).map(|column| rows.get(0, column));
            numbers.map(|beta| if beta.is_finite() { beta } else { 0.0 }).collect()
        }
        _ => vec![],
    };
    let gender = arrays.optional(&["gender"], warnings).and_then(|array| array.text());
    Ok(Layout {
        tree,
        blocks,
        frames,
        places,
        rate,
        recorded,
        scale: scale.filter(|scale| scale.is_finite() && *scale > 0.0).unwrap_or(1.0),
        betas,
        gender,
    })
}

/// One array that holds all joints, or all but the pelvis beside one of the pelvis.
fn together<'a>(
    arrays: &mut Arrays<'a>,
    whole: Array<'a>,
) -> Result<(Tree, Vec<Block<'a>>), Error> {
    let shape = whole.shape.clone();
    let name = whole.name.clone();
    let all = block(whole, 0, &|joints| {
        Tree::of_len(joints).is_some() || Tree::of_len(joints + 1).is_some()
    });
    let Some(mut all) = all else {
        let message = format!("the array `{name}` has the shape {shape:?}: no poses of SMPL");
        let help = "they are 66, 72, 156 or 165 numbers a frame: rotation vectors of 22, 24, 52 or 55 joints";
        return Err(Error::new("smpl/array", message).with_help(help));
    };
    if let Some(tree) = Tree::of_len(all.joints) {
        return Ok((tree, vec![all]));
    }
    all.first = 1;
    let tree = Tree::of_len(all.joints + 1).unwrap_or(Tree::Body);
    let root = part(arrays, &ROOT, 0, &[1])?;
    Ok((tree, root.into_iter().chain([all]).collect()))
}

/// Arrays of parts of the body.
fn in_parts<'a>(
    arrays: &mut Arrays<'a>,
    model_type: &str,
    warnings: &mut Warnings,
) -> Result<(Tree, Vec<Block<'a>>), Error> {
    let body = part(arrays, &BODY, 1, &[21, 23, 51, 54])?;
    let root = part(arrays, &ROOT, 0, &[1])?;
    if body.is_none() && root.is_none() {
        let message = format!(
            "the file holds neither poses of SMPL nor a body: its arrays are {}",
            arrays.listed()
        );
        let help = "poses are called `poses`, or `global_orient` and `body_pose`; bodies have `J_regressor`, \
                    `v_template` and `kintree_table`";
        return Err(Error::new("smpl/no-poses", message).with_help(help));
    }
    let has = |names: &[&str]| arrays.has(names);
    let face = has(&JAW) || has(&EYES) || has(&LEFT_EYE) || has(&RIGHT_EYE);
    let hands = has(&HANDS) || has(&LEFT_HAND) || has(&RIGHT_HAND);
    let joints = body.as_ref().map_or(21, |block| block.joints);
    let tree = match joints {
        54 => Tree::SmplX,
        51 => Tree::SmplH,
        _ if face || model_type.contains("smplx") => Tree::SmplX,
        _ if hands || model_type.contains("smplh") => Tree::SmplH,
        23 => Tree::Smpl,
        _ => Tree::Body,
    };
    let mut blocks: Vec<Block<'a>> = root.into_iter().chain(body).collect();
    if blocks.first().is_some_and(|block| block.first > 0) {
        let message = "there is no orientation of the pelvis: it is not turned";
        warnings.push(Diagnostic::warning("smpl/root", message));
    }
    if let (Some(hands), 21 | 23) = (tree.fingers(), joints) {
        if let Some(block) = blocks.last_mut().filter(|block| block.first == 1) {
            // What SMPL has as hands is not what these trees have there.
            block.joints = block.joints.min(21);
        }
        if tree == Tree::SmplX {
            for (names, first, count) in
                [(&JAW, 22, 1), (&EYES, 23, 2), (&LEFT_EYE, 23, 1), (&RIGHT_EYE, 24, 1)]
            {
                blocks.extend(part(arrays, names, first, &[count])?);
            }
        }
        blocks.extend(part(arrays, &HANDS, hands, &[30])?);
        for (names, first) in [(&LEFT_HAND, hands), (&RIGHT_HAND, hands + 15)] {
            match part(arrays, names, first, &[15]) {
                Ok(found) => blocks.extend(found),
                Err(error) if error.code() == "smpl/array" => {
                    let said = error.into_diagnostics().into_iter().next();
                    let message = said.map_or(String::new(), |said| said.message);
                    let help = "hands in principal components need the components of their body, which are not read: \
                                write them as 45 numbers a frame; the hand stays at rest";
                    warnings.push(Diagnostic::warning("smpl/hands", message).with_help(help));
                }
                Err(error) => return Err(error),
            }
        }
    }
    Ok((tree, blocks))
}

/// The array of a part of the body, which may have so many joints.
fn part<'a>(
    arrays: &mut Arrays<'a>,
    names: &[&str],
    first: usize,
    counts: &[usize],
) -> Result<Option<Block<'a>>, Error> {
    let Some(array) = arrays.find(names)? else { return Ok(None) };
    let (name, shape) = (array.name.clone(), array.shape.clone());
    match block(array, first, &|joints| counts.contains(&joints)) {
        Some(block) => Ok(Some(block)),
        None => {
            let widths: Vec<String> = counts.iter().map(|n| (3 * n).to_string()).collect();
            let message = format!(
                "the array `{name}` has the shape {shape:?}: {} numbers a frame are expected",
                widths.join(" or ")
            );
            Err(Error::new("smpl/array", message))
        }
    }
}

/// What an array's shape says of frames and joints; `None` where it has no number of joints that fits.
fn block<'a>(array: Array<'a>, first: usize, fits: &dyn Fn(usize) -> bool) -> Option<Block<'a>> {
    let shape = array.shape.clone();
    let whole = |numbers: usize| {
        Some(numbers / 3).filter(|joints| numbers.is_multiple_of(3) && fits(*joints))
    };
    // Frames along a dimension, the joints in what follows; or one frame.
    let (along, joints, matrices) = match shape[..] {
        [numbers] => (None, whole(numbers)?, false),
        [joints, 3] if joints > 1 && fits(joints) && !fits(1) => (None, joints, false),
        [_, numbers] => (Some(0), whole(numbers)?, false),
        [_, joints, 3, 3] if fits(joints) => (Some(0), joints, true),
        [_, 3, 3] if fits(1) => (Some(0), 1, true),
        [_, joints, 3] if fits(joints) => (Some(0), joints, false),
        [1, _, numbers] => (Some(1), whole(numbers)?, false),
        [1, _, joints, 3] if fits(joints) => (Some(1), joints, false),
        _ => return None,
    };
    Some(Block { array, first, joints, along, matrices })
}
