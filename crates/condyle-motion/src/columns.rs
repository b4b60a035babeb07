//! Which columns of a table hold which coordinates.
//!
//! A column holds a coordinate if its name is the coordinate's key, or a path whose last parts are
//! the joint set and the coordinate (`/jointset/knee_r/knee_angle_r/value`). Parts of a path are
//! compared whole: `left_knee/angle` does not belong to a joint set `knee`.

pub use crate::angles::is_length;
use crate::{AngleUnit, Table};
use condyle_diagnostics::Error;
use condyle_model::{CoordinateId, CoordinateKind, Model};

/// The coordinate whose value a column holds: the column's name, or the part of its path before
/// `/value`. None for a path of something else, such as a speed.
///
/// ```
/// use condyle_motion::columns::coordinate_name;
/// assert_eq!(coordinate_name("/jointset/knee_r/knee_angle_r/value"), Some("knee_angle_r"));
/// assert_eq!(coordinate_name("knee_r/knee_angle_r/value"), Some("knee_angle_r"));
/// assert_eq!(coordinate_name("/jointset/knee_r/knee_angle_r|value"), Some("knee_angle_r"));
/// assert_eq!(coordinate_name("knee_angle_r"), Some("knee_angle_r"));
/// assert_eq!(coordinate_name("/jointset/knee_r/knee_angle_r/speed"), None);
/// ```
#[must_use]
pub fn coordinate_name(column: &str) -> Option<&str> {
    if !column.contains(['/', '|']) {
        return Some(column);
    }
    let path = column.strip_suffix("/value").or_else(|| column.strip_suffix("|value"))?;
    path.rsplit('/').next().filter(|name| !name.is_empty())
}

/// The names of the columns that hold a coordinate: one, or four of an orientation.
pub fn columns(model: &Model, id: CoordinateId) -> Vec<String> {
    parts(model, id).iter().map(|part| format!("{}{part}", model.coordinate_key(id))).collect()
}

/// The suffix after the key in the name of each column of a coordinate.
fn parts(model: &Model, id: CoordinateId) -> &'static [&'static str] {
    match model.coordinate(id).kind {
        CoordinateKind::Orientation => &[".qx", ".qy", ".qz", ".qw"],
        _ => &[""],
    }
}

/// For each stored number of a coordinate, the column of a table that holds it.
pub fn found_columns(model: &Model, id: CoordinateId, table: &Table) -> Vec<Option<usize>> {
    let coordinate = model.coordinate(id);
    let set = &model.joint_sets()[coordinate.joint_set.index()].name;
    let by_path = |part: &str| {
        let path = format!("/{set}/{}{part}", coordinate.name);
        let holds = |column: &String| {
            let bare = column.strip_suffix("/value").unwrap_or(column);
            format!("/{}", bare.trim_start_matches('/')).ends_with(&path)
        };
        table.columns.iter().position(holds)
    };
    let names = columns(model, id);
    let parts = parts(model, id).iter();
    let found: Vec<Option<usize>> = parts
        .zip(names)
        .map(|(part, name)| table.column(&name).or_else(|| by_path(part)))
        .collect();
    if coordinate.kind == CoordinateKind::Orientation && found.contains(&None) {
        let stems = [model.coordinate_key(id), set.clone(), coordinate.name.clone()].into_iter();
        let moved = model.outputs_of(coordinate.joint_set);
        let moved = moved.map(|(segment, _)| model.segment(segment).name.clone());
        // Only where one segment turns is its name that of the turn.
        let moved: Vec<String> = moved.collect();
        let alone = (moved.len() == 1).then(|| moved[0].clone());
        if let Some(other) = stems.chain(alone).find_map(|stem| quaternion(table, &stem)) {
            return other.map(Some).to_vec();
        }
    }
    found
}

/// How other programs call the four numbers x, y, z, w of a quaternion, behind the name of what turns.
const QUATERNIONS: [[&str; 4]; 6] = [
    ["_x", "_y", "_z", "_w"],
    [".x", ".y", ".z", ".w"],
    ["_qx", "_qy", "_qz", "_qw"],
    [".qx", ".qy", ".qz", ".qw"],
    ["/qx", "/qy", "/qz", "/qw"],
    ["/x", "/y", "/z", "/w"],
];

/// The columns of a quaternion that is called so, as x, y, z, w; in any case. In a table of the type
/// `Quaternion` of OpenSim `NAME_1` to `NAME_4` are w, x, y, z.
fn quaternion(table: &Table, stem: &str) -> Option<[usize; 4]> {
    let typed =
        table.header_value("DataType").is_some_and(|t| t.eq_ignore_ascii_case("quaternion"));
    let numbered = typed.then_some(["_2", "_3", "_4", "_1"]);
    QUATERNIONS.into_iter().chain(numbered).find_map(|parts| {
        let column = |part: &str| {
            let holds = |name: &String| {
                name.len() == stem.len() + part.len()
                    && name.get(..stem.len()).is_some_and(|n| n.eq_ignore_ascii_case(stem))
                    && name.get(stem.len()..).is_some_and(|n| n.eq_ignore_ascii_case(part))
            };
            table.columns.iter().position(holds)
        };
        Some([column(parts[0])?, column(parts[1])?, column(parts[2])?, column(parts[3])?])
    })
}

/// Refuses a table of which two columns have the name of one coordinate: readers call the second `name#2`.
///
/// # Errors
/// `motion/duplicate` with the names.
///
/// ```
/// use condyle_model::ModelBuilder;
/// use condyle_motion::{Table, columns::check_single};
/// # use condyle_math::Vec3;
/// let mut b = ModelBuilder::new("arm");
/// let forearm = b.segment("forearm", None);
/// b.hinge("elbow", forearm, "flexion", Vec3::Z);
/// let model = b.build()?;
/// let table = |columns: &[&str]| Table {
///     columns: columns.iter().map(|c| c.to_string()).collect(),
///     ..Table::default()
/// };
/// assert!(check_single(&model, &table(&["flexion", "force", "force#2"])).is_ok());
/// assert!(check_single(&model, &table(&["flexion", "flexion#2"])).is_err());
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn check_single(model: &Model, table: &Table) -> Result<(), Error> {
    for cell in cells(model, table) {
        let Some(name) = cell.column.and_then(|column| table.columns.get(column)) else { continue };
        let second = format!("{name}#2");
        if table.columns.contains(&second) {
            let message = format!("two columns are called `{name}`, a coordinate of the model");
            let help = "remove or rename one of them";
            return Err(Error::new("motion/duplicate", message).with_help(help));
        }
    }
    Ok(())
}

/// One stored number of a model, and the column of a table that holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// Which of the coordinate's numbers it is.
    pub part: usize,
    /// Its position among all stored numbers.
    pub place: usize,
    /// The column; `None` where the table has none.
    pub column: Option<usize>,
    /// What the column's numbers are multiplied by.
    pub factor: f64,
}

/// Where a table holds the numbers of a model, all of them in the model's order.
pub fn cells(model: &Model, table: &Table) -> Vec<Cell> {
    let mut cells = Vec::with_capacity(model.stored_len());
    for coordinate in model.coordinate_ids() {
        let rotation = model.coordinate(coordinate).kind == CoordinateKind::Rotation;
        let degrees = table.angle_unit == AngleUnit::Degrees && rotation;
        let factor = if degrees { 1f64.to_radians() } else { 1.0 };
        let start = model.stored_range(coordinate).start;
        for (part, column) in found_columns(model, coordinate, table).into_iter().enumerate() {
            cells.push(Cell { coordinate, part, place: start + part, column, factor });
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::Vec3;
    use condyle_model::ModelBuilder;

    #[test]
    fn quaternions_are_found_as_other_programs_call_them() {
        let mut b = ModelBuilder::new("hips");
        let thigh = b.segment("Thigh_R", None);
        b.ball_joint("hip_r", thigh);
        let model = b.build().unwrap();
        let id = model.coordinate_ids().next().unwrap();
        let found = |columns: [&str; 4], header: &[(&str, &str)]| {
            let header = header.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
            let columns = columns.map(str::to_owned).to_vec();
            found_columns(&model, id, &Table { columns, header, ..Table::default() })
        };
        let all = |order: [usize; 4]| order.map(Some).to_vec();
        assert_eq!(found(["hip_r_w", "hip_r_x", "hip_r_y", "hip_r_z"], &[]), all([1, 2, 3, 0]));
        assert_eq!(
            found(["thigh_r.x", "thigh_r.y", "thigh_r.z", "thigh_r.w"], &[]),
            all([0, 1, 2, 3])
        );
        let numbered = ["Thigh_R_1", "Thigh_R_2", "Thigh_R_3", "Thigh_R_4"];
        assert_eq!(found(numbered, &[("DataType", "Quaternion")]), all([1, 2, 3, 0]));
        assert_eq!(found(numbered, &[]), vec![None; 4]);
        assert_eq!(found(["hip_r_w", "hip_r_x", "hip_r_y", "other"], &[]), vec![None; 4]);
    }

    #[test]
    fn parts_of_a_path_are_compared_whole() {
        let mut b = ModelBuilder::new("knees");
        for name in ["knee", "left_knee"] {
            let shank = b.segment(name, None);
            b.hinge(name, shank, "angle", Vec3::Z);
        }
        let model = b.build().unwrap();
        let found = |columns: &[&str]| -> Vec<Option<usize>> {
            let columns = columns.iter().map(|&c| c.to_owned()).collect();
            let table = Table { columns, ..Table::default() };
            cells(&model, &table).iter().map(|cell| cell.column).collect()
        };
        // `left_knee/angle` ends in the characters of `knee/angle`, and was once read for both.
        assert_eq!(found(&["left_knee/angle"]), [None, Some(0)]);
        assert_eq!(found(&["/jointset/left_knee/angle/value"]), [None, Some(0)]);
        assert_eq!(found(&["/jointset/left_knee/angle/value", "knee/angle"]), [Some(1), Some(0)]);
    }

    #[test]
    fn the_four_numbers_of_an_orientation_have_columns_of_their_own() {
        let mut b = ModelBuilder::new("hips");
        for name in ["hip_r", "hip_l"] {
            let thigh = b.segment(name, None);
            b.ball_joint(name, thigh);
        }
        let model = b.build().unwrap();
        let id = model.coordinate_ids().next().unwrap();
        let columns = ["qw", "qx", "qy", "qz"].map(|q| format!("/jointset/hip_r/orientation.{q}"));
        let table = Table { columns: columns.to_vec(), ..Table::default() };
        assert_eq!(found_columns(&model, id, &table), [Some(1), Some(2), Some(3), Some(0)]);
    }
}
