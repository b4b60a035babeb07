//! A body of SMPL as its authors give it: where its joints are, and how the shape moves them.

use super::array::{Array, Rows};
use super::layout::{Arrays, BODY, ROOT, WHOLE};
use super::rest::{Joint, Rest};
use super::tree::Tree;
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::Vec3;

/// More numbers of a shape are left out: motions have at most 16, bodies up to 400.
const MOST_SHAPES: usize = 400;
/// More corners of a surface are refused.
const MOST_CORNERS: usize = 1 << 20;
/// How the parts of a sparse matrix are joined to its name.
const JOINED: [&str; 3] = ["_", ".", "/"];

/// Whether bytes hold a body: where its joints are.
#[must_use]
pub fn is_body(bytes: &[u8]) -> bool {
    Arrays::open(bytes).is_ok_and(|arrays| holds_body(&arrays))
}

fn holds_body(arrays: &Arrays<'_>) -> bool {
    // Poses may come with the corners of their body.
    let poses = [WHOLE.as_slice(), &ROOT, &BODY];
    arrays.has(&["v_template", "kintree_table", "j_regressor", "j"])
        && !poses.iter().any(|names| arrays.has(names))
}

/// Where the joints of a body are: `J = J_regressor · v_template`, and for each number of the shape
/// `J_regressor · shapedirs`.
///
/// `J_regressor` may be dense or in the parts of a sparse matrix of SciPy: `J_regressor_data`, `_indices`, `_indptr`
/// (by rows, or by columns where `_format` says `csc`), or `_data`, `_row`, `_col`. Without it places are those of `J`.
///
/// # Errors
/// `smpl/body` where arrays are missing or do not fit, `smpl/objects` where they are pickled.
pub fn rest(bytes: &[u8]) -> Result<Read<Rest>, Error> {
    let mut warnings = Warnings::default();
    let mut arrays = Arrays::open(bytes)?;
    let count = parents(&mut arrays, &mut warnings)?;
    let regressor = regressor(&mut arrays)?;
    let joints = match (regressor, arrays.find(&["v_template"])?) {
        (Some(regressor), Some(corners)) => {
            let corners = corners.rows(0)?;
            if corners.width() != 3 {
                return Err(wrong("`v_template` does not hold three numbers a corner"));
            }
            regressed(&mut arrays, &regressor, &corners, &mut warnings)?
        }
        _ => match arrays.find(&["j"])? {
            Some(places) => {
                let rows = places.rows(0)?;
                if rows.width() != 3 || rows.count > MOST_CORNERS {
                    return Err(wrong("`J` does not hold three numbers a joint"));
                }
                (0..rows.count).map(|joint| (corner(&rows, joint), vec![])).collect()
            }
            None => {
                let help = "a body has `J_regressor` and `v_template`, or `J`";
                let message = format!("the arrays are {}", arrays.listed());
                return Err(Error::new("smpl/body", message).with_help(help));
            }
        },
    };
    let tree = Tree::of_len(joints.len()).filter(|_| count.is_none_or(|n| n == joints.len()));
    let Some(tree) = tree else {
        let message = format!("the body has {} joints", joints.len());
        let help = "bodies of SMPL have 24, of SMPL-H 52, of SMPL-X 55";
        return Err(Error::new("smpl/body", message).with_help(help));
    };
    let finite = |place: &Vec3| place.to_array().iter().all(|x| x.is_finite());
    if !joints.iter().all(|(place, shape)| finite(place) && shape.iter().all(finite)) {
        return Err(wrong("places of joints are no finite numbers"));
    }
    let named = tree.joints().into_iter().zip(joints);
    let joints = named.map(|((name, _), (place, shape))| Joint { name, place, shape }).collect();
    Ok(Read { value: Rest::of_body(joints), warnings: warnings.finish() })
}

fn wrong(what: &str) -> Error {
    Error::new("smpl/body", what)
}

/// How many joints the table of parents has, whose parents are compared with those of the tree.
fn parents(arrays: &mut Arrays<'_>, warnings: &mut Warnings) -> Result<Option<usize>, Error> {
    let Some(table) = arrays.find(&["kintree_table"])? else { return Ok(None) };
    let rows = table.rows(0)?;
    let Some(tree) = Tree::of_len(rows.width()).filter(|_| rows.count == 2) else {
        let message = format!("`kintree_table` has the shape {:?}", table.shape);
        return Err(wrong(&message).with_help("it is 2 rows of 24, 52 or 55 joints"));
    };
    for (joint, (name, parent)) in tree.joints().iter().enumerate().skip(1) {
        if parent.is_some_and(|parent| rows.get(0, joint) != parent as f64) {
            warnings.add("smpl/parents", || {
                let message = format!(
                    "`kintree_table` hangs joint {joint} on {}, and {} has `{name}` there",
                    rows.get(0, joint),
                    tree.title()
                );
                Diagnostic::warning("smpl/parents", message).with_help("the tree of SMPL is kept")
            });
        }
    }
    Ok(Some(tree.len()))
}

/// A corner of the surface and its weight, for each joint.
struct Regressor {
    weights: Vec<Vec<(usize, f64)>>,
}

fn regressor(arrays: &mut Arrays<'_>) -> Result<Option<Regressor>, Error> {
    let objects = match arrays.find(&["j_regressor"]) {
        Ok(Some(dense)) => return dense_rows(&dense).map(Some),
        Ok(None) => None,
        Err(error) if error.code() == "smpl/objects" => Some(error),
        Err(error) => return Err(error),
    };
    for sign in JOINED {
        let mut part = |what: &str| arrays.find(&[format!("j_regressor{sign}{what}").as_str()]);
        let Some(data) = part("data")? else { continue };
        let format = part("format")?.and_then(|array| array.text());
        let numbers = |array: Option<Array<'_>>| -> Result<Option<Vec<f64>>, Error> {
            let Some(array) = array else { return Ok(None) };
            let rows = array.rows(0)?;
            if rows.width() != 1 || rows.count > MOST_CORNERS {
                return Err(wrong("`J_regressor` has parts that are no lists"));
            }
            Ok(Some((0..rows.count).map(|index| rows.get(index, 0)).collect()))
        };
        let data = numbers(Some(data))?.unwrap_or_default();
        let (rows, columns) = match (numbers(part("row")?)?, numbers(part("col")?)?) {
            (Some(rows), Some(columns)) => (rows, columns),
            _ => {
                let inner = numbers(part("indices")?)?;
                let ends = numbers(part("indptr")?)?;
                let (Some(inner), Some(ends)) = (inner, ends) else {
                    return Err(wrong("`J_regressor` is sparse, and its indices are missing"));
                };
                let mut outer = vec![f64::NAN; inner.len()];
                for (number, pair) in ends.windows(2).enumerate() {
                    let range = pair[0].max(0.0) as usize..pair[1].max(0.0) as usize;
                    let part = outer.get_mut(range);
                    let part = part.ok_or_else(|| wrong("`J_regressor` has wrong indices"))?;
                    part.fill(number as f64);
                }
                match format.as_deref() == Some("csc") {
                    true => (inner, outer),
                    false => (outer, inner),
                }
            }
        };
        let mut weights: Vec<Vec<(usize, f64)>> = vec![];
        for ((row, column), weight) in rows.iter().zip(&columns).zip(&data) {
            let limits = 0.0..MOST_CORNERS as f64;
            if !limits.contains(column) || !(0.0..256.0).contains(row) {
                return Err(wrong("`J_regressor` has wrong indices"));
            }
            let row = *row as usize;
            if weights.len() <= row {
                weights.resize_with(row + 1, Vec::new);
            }
            if let Some(list) = weights.get_mut(row) {
                list.push((*column as usize, *weight));
            }
        }
        return Ok(Some(Regressor { weights }));
    }
    match objects {
        Some(error) => {
            let help = "a sparse matrix is pickled: write it in Python as J_regressor.toarray()";
            Err(error.with_help(help))
        }
        None => Ok(None),
    }
}

fn dense_rows(dense: &Array<'_>) -> Result<Regressor, Error> {
    let rows = dense.rows(0)?;
    let joints = Tree::of_len(rows.count).ok_or_else(|| {
        let message = format!("`J_regressor` has the shape {:?}", dense.shape);
        wrong(&message).with_help("it has a row for each joint: 24, 52 or 55")
    })?;
    let row = |joint: usize| {
        let all = (0..rows.width()).map(|corner| (corner, rows.get(joint, corner)));
        all.filter(|(_, weight)| *weight != 0.0).collect()
    };
    Ok(Regressor { weights: (0..joints.len()).map(row).collect() })
}

fn corner(rows: &Rows<'_, '_>, index: usize) -> Vec3 {
    Vec3::new(rows.get(index, 0), rows.get(index, 1), rows.get(index, 2))
}

/// Places of joints, and their steps for each number of the shape.
fn regressed(
    arrays: &mut Arrays<'_>,
    regressor: &Regressor,
    corners: &Rows<'_, '_>,
    warnings: &mut Warnings,
) -> Result<Vec<(Vec3, Vec<Vec3>)>, Error> {
    let fits = |(corner, _): &(usize, f64)| *corner < corners.count;
    if !regressor.weights.iter().flatten().all(fits) {
        return Err(wrong("`J_regressor` and `v_template` have different numbers of corners"));
    }
    let shapes = match arrays.find(&["shapedirs"]) {
        Ok(found) => found,
        Err(error) => {
            let said = error.into_diagnostics().into_iter().next();
            let message = said.map_or(String::new(), |said| said.message);
            let said = Diagnostic::warning("smpl/left-out", message);
            warnings.push(said.with_help("the mean shape is taken, whatever the `betas` are"));
            None
        }
    };
    let shapes = match &shapes {
        Some(array) => match array.shape[..] {
            [count, 3, shapes] if count == corners.count => Some((array.rows(0)?, shapes)),
            _ => {
                let message = format!("`shapedirs` has the shape {:?}", array.shape);
                return Err(wrong(&message).with_help("it is (corners, 3, shapes)"));
            }
        },
        None => None,
    };
    let joint = |weights: &Vec<(usize, f64)>| {
        let mean = weights.iter().map(|(at, weight)| corner(corners, *at) * *weight);
        let place = mean.fold(Vec3::ZERO, |sum, step| sum + step);
        let steps = shapes.as_ref().map_or(vec![], |(rows, count)| {
            let step = |beta: usize| {
                let along = |axis: usize| {
                    let all = weights
                        .iter()
                        .map(|(at, weight)| weight * rows.get(*at, axis * count + beta));
                    all.sum::<f64>()
                };
                Vec3::new(along(0), along(1), along(2))
            };
            (0..(*count).min(MOST_SHAPES)).map(step).collect()
        });
        (place, steps)
    };
    Ok(regressor.weights.iter().map(joint).collect())
}
