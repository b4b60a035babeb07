//! Documents of kind `recipe`: which markers give the orientation of a segment.
//!
//! ```text
//! document    = the head of every document, and
//! child       = the segment whose rotation is learned: a frame
//! reference   = the one in which it is seen: a frame; without one it is the laboratory
//! least_angle = frames are left out where two directions are nearer to parallel; 15 degrees if not given
//! point.P     = markers whose mean is meant by P
//! also.M      = other names of marker M, tried in this order where a recording has none of that name
//! frame.F     = two of x, y, z, each a direction, and
//! keeps       = which of the two keeps its direction; the other is made perpendicular
//! direction   = { from, to } | { normal = [a, b, c] }: (b - a) × (c - a); each a point or a marker
//! ```

use super::fields::{Fields, Reader};
use super::tree::Node;
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Read, did_you_mean};
use condyle_learn::frames::{Axis, Direction, FrameRecipe, Place, Recipe};

const FORM: Form = Form {
    kind: Kind::Recipe,
    keys: &["child", "reference", "least_angle", "point", "also", "frame", "source"],
    own: &[],
    repeated: &[],
};

const AXES: [(&str, Axis); 3] = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];

/// Reads a recipe. `include` gives the text of another one by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::recipe;
/// let text = r#"
/// condyle = 1
/// kind = "recipe"
/// angles = "deg"
/// child = "humerus"
/// least_angle = 20
/// point.elbow = ["RELB", "RELBM"]
/// [frame.humerus]
/// keeps = "y"
/// y = { from = "elbow", to = "RSHO" }
/// z = { normal = ["RSHO", "elbow", "RWRA"] }
/// "#;
/// let recipe = recipe::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(recipe.places(), ["elbow", "RSHO", "RWRA"]);
/// assert!((recipe.least_angle - 20f64.to_radians()).abs() < 1e-15);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<Recipe>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| reader.recipe(top))
}

impl Reader<'_> {
    fn recipe(&mut self, top: &Fields<'_>) -> Option<Recipe> {
        if let Some(source) = top.get("source") {
            self.text(source, "source");
        }
        let mut points = vec![];
        for entry in top.get("point").map_or(&[][..], |node| self.entries(node, "point")) {
            let (markers, _) = self.names(&entry.node, &entry.key.text);
            if markers.is_empty() {
                let message = format!("point `{}` is of no marker", entry.key.text);
                self.texts.error(entry.node.spot, "recipe/point", message, "name one or more");
            }
            let markers = markers.into_iter().map(|marker| marker.text).collect();
            points.push(Place { name: entry.key.text.clone(), markers });
        }
        let mut also = vec![];
        for entry in top.get("also").map_or(&[][..], |node| self.entries(node, "also")) {
            let (markers, _) = self.names(&entry.node, &entry.key.text);
            let markers = markers.into_iter().map(|marker| marker.text).collect();
            also.push(Place { name: entry.key.text.clone(), markers });
        }
        let mut frames = vec![];
        let tables = top.get("frame").map_or(&[][..], |node| self.entries(node, "frame"));
        for entry in tables {
            let label = format!("frame.{}", entry.key.text);
            let known = ["x", "y", "z", "keeps"];
            let fields = self.table(&entry.node, entry.key.spot, label, &known);
            frames.extend(self.axes_of(entry.key.text.clone(), &fields));
        }
        let least_angle = match top.get("least_angle") {
            None => Recipe::default().least_angle,
            Some(node) => {
                let angle = self.not_negative(node, "least_angle")? * self.angle_unit(node.spot);
                if angle >= std::f64::consts::FRAC_PI_2 {
                    let message = "`least_angle` is a right angle or more".to_owned();
                    let help =
                        "give an angle below that at which directions are good, such as 15 degrees";
                    self.texts.error(node.spot, "recipe/angle", message, help);
                }
                angle
            }
        };
        // Frames with a fault are not there, and are not reported again as missing.
        let named: Vec<&str> = tables.iter().map(|entry| entry.key.text.as_str()).collect();
        let child = self.required(top, "child", "the name of a frame, such as \"humerus\"");
        let child = child.and_then(|node| self.frame_named(node, "child", &named, &frames));
        let reference = match top.get("reference") {
            None => None,
            Some(node) => Some(self.frame_named(node, "reference", &named, &frames)?),
        };
        Some(Recipe { points, also, child: child?, reference, least_angle })
    }

    fn frame_named(
        &mut self,
        node: &Node,
        key: &str,
        named: &[&str],
        frames: &[FrameRecipe],
    ) -> Option<FrameRecipe> {
        let name = self.text(node, key)?;
        if !named.contains(&name.text.as_str()) {
            let all = || format!("give a table [frame.{}]", name.text);
            let help = did_you_mean(&name.text, named.iter().copied(), all);
            let message = format!("`{key}` names no frame: `{}`", name.text);
            self.texts.error(name.spot, "recipe/frame", message, help);
        }
        frames.iter().find(|frame| frame.name == name.text).cloned()
    }

    /// Two directions, of which one is kept.
    fn axes_of(&mut self, name: String, fields: &Fields<'_>) -> Option<FrameRecipe> {
        let mut given = vec![];
        for (letter, axis) in AXES {
            if let Some(node) = fields.get(letter) {
                given.push((axis, self.direction_between(node, letter)?));
            }
        }
        let Ok([first, second]): Result<[_; 2], _> = given.try_into() else {
            let message = format!("[{}] must have two of `x`, `y`, `z`", fields.label);
            let help = "the third follows from them";
            self.texts.error(fields.spot, "recipe/axes", message, help);
            return None;
        };
        self.required(fields, "keeps", "the axis that keeps its direction: \"x\", \"y\" or \"z\"")?;
        let keeps = self.word(fields, "keeps", &AXES)?;
        let (kept, second) = match (keeps == first.0, keeps == second.0) {
            (true, _) => (first, second),
            (_, true) => (second, first),
            _ => {
                let message =
                    format!("`keeps` of [{}] names an axis that is not given", fields.label);
                self.texts.error(
                    fields.spot,
                    "recipe/keeps",
                    message,
                    "name one of the two that are",
                );
                return None;
            }
        };
        Some(FrameRecipe { name, kept, second })
    }

    fn direction_between(&mut self, node: &Node, label: &str) -> Option<Direction> {
        let fields = self.table(node, node.spot, label.to_owned(), &["from", "to", "normal"]);
        if let Some(normal) = fields.get("normal") {
            if let Some(from) = fields.get("from").or_else(|| fields.get("to")) {
                self.exclusive(from, "normal", "from");
            }
            let (names, _) = self.names(normal, "normal");
            let names: Vec<String> = names.into_iter().map(|name| name.text).collect();
            let Ok(points) = <[String; 3]>::try_from(names) else {
                let message = "`normal` is not of three places".to_owned();
                self.length(
                    normal.spot,
                    message,
                    "give [a, b, c]: the normal is (b - a) × (c - a)",
                );
                return None;
            };
            return Some(Direction::Normal { points });
        }
        let wanted = "the name of a point or marker";
        let from = self.required(&fields, "from", wanted).and_then(|n| self.text(n, "from"));
        let to = self.required(&fields, "to", wanted).and_then(|n| self.text(n, "to"));
        Some(Direction::Between { from: from?.text, to: to?.text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recipe(inside: &str) -> Result<Recipe, Error> {
        let text = format!("condyle = 1\nkind = \"recipe\"\n{inside}");
        read(&text, &mut |_| Err("it stands alone".into())).map(|read| read.value)
    }

    #[test]
    fn two_axes_and_one_that_is_kept() {
        let read = recipe(
            "child = \"c\"\nreference = \"r\"\n[frame.r]\nkeeps = \"z\"\nx = { from = \"A\", to = \"B\" }\n\
             z = { normal = [\"A\", \"B\", \"C\"] }\n[frame.c]\nkeeps = \"x\"\nx = { from = \"A\", to = \"D\" }\n\
             y = { from = \"A\", to = \"E\" }\n",
        );
        let read = read.unwrap();
        let reference = read.reference.as_ref().unwrap();
        assert_eq!((reference.kept.0, reference.second.0), (Axis::Z, Axis::X));
        assert_eq!((read.child.kept.0, read.child.second.0), (Axis::X, Axis::Y));
        assert_eq!(read.places(), ["A", "D", "E", "B", "C"]);
    }

    #[test]
    fn faults_are_placed() {
        let frame = "[frame.c]\nkeeps = \"x\"\nx = { from = \"A\", to = \"B\" }\n";
        for (text, said) in [
            ("".to_owned(), "[] has no `child`"),
            (
                format!("child = \"d\"\n{frame}y = {{ from = \"A\", to = \"C\" }}"),
                "line 3, column 9: `child` names no frame: `d`",
            ),
            (format!("child = \"c\"\n{frame}"), "line 4, column 8: [frame.c] must have two of"),
            (
                format!("child = \"c\"\n{frame}z = {{ normal = [\"A\"] }}"),
                "line 7, column 16: `normal` is not of three places",
            ),
            (
                "child = \"c\"\nleast_angle = 2\n".to_owned(),
                "line 4, column 15: `least_angle` is a right angle or more",
            ),
        ] {
            let error = recipe(&text).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
