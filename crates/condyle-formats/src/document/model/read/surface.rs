//! Shapes: what bones look like.

use super::ModelReader;
use crate::document::fields::Fields;
use crate::document::model::draft::{Draft, PlaceDraft, ShapeDraft};
use crate::document::model::keys;
use crate::document::tree::{Entry, Node, Value};
use condyle_diagnostics::{did_you_mean, listed};
use condyle_math::Vec3;
use condyle_mesh::{Ball, Block, Finish, Form, Plate, Rib, Station, Tube};

impl ModelReader<'_> {
    pub(super) fn shape(&mut self, draft: &mut Draft, entry: &Entry) {
        let name = entry.key.clone();
        let fields =
            self.table(&entry.node, name.spot, format!("shape.{}", name.text), keys::SHAPE);
        let segment = self
            .required(&fields, "segment", "the segment that it belongs to")
            .and_then(|node| self.text(node, "segment"));
        let finish = self.finish(&fields);
        let mut until = None;
        let form = self.form(&fields, &mut until);
        let (Some(segment), Some(form)) = (segment, form) else { return };
        if let Err(wrong) = form.check() {
            let help = "lengths are in metres: see the manual's page on shapes";
            self.texts.error(name.spot, "model/shape", format!("`{}`: {wrong}", name.text), help);
            return;
        }
        draft.shapes.push(ShapeDraft { name, segment, form, finish, until });
    }

    fn finish(&mut self, fields: &Fields<'_>) -> Finish {
        let Some(said) = fields.get("finish").and_then(|n| self.text(n, "finish")) else {
            return Finish::Bone;
        };
        let names = Finish::ALL.map(Finish::name);
        Finish::ALL.into_iter().find(|f| f.name() == said.text).unwrap_or_else(|| {
            let all = || format!("finishes are: {}", names.join(", "));
            let help = did_you_mean(&said.text, names, all);
            let message = format!("unknown finish `{}`", said.text);
            self.texts.error(said.spot, "model/finish", message, help);
            Finish::Bone
        })
    }

    fn form(&mut self, fields: &Fields<'_>, until: &mut Option<PlaceDraft>) -> Option<Form> {
        let given: Vec<&str> =
            keys::FORMS.iter().copied().filter(|kind| fields.get(kind).is_some()).collect();
        let [kind] = given[..] else {
            let message = match given.len() {
                0 => "this shape has no form".to_owned(),
                _ => format!("this shape has {}", listed(&given)),
            };
            let help = format!("give one of: {}", keys::FORMS.join(", "));
            self.texts.error(fields.spot, "model/shape", message, help);
            return None;
        };
        let node = fields.get(kind)?;
        match kind {
            "ball" => {
                let table = self.table(node, node.spot, "ball".to_owned(), keys::BALL);
                let at = self.vector_or(&table, "at")?;
                let radii = self.required(&table, "radii", "a radius, or [x, y, z]")?;
                let radii = match &radii.value {
                    Value::List(_) => self.vector(radii, "radii")?,
                    _ => {
                        let radius = self.number(radii, "radii")?;
                        Vec3::new(radius, radius, radius)
                    }
                };
                let turn = self.frame(&table, ["at", "turn", "order", "matrix"]).linear;
                Some(Form::Ball(Ball { at, radii, turn }))
            }
            "box" => {
                let table = self.table(node, node.spot, "box".to_owned(), keys::BOX);
                let at = self.vector_or(&table, "at")?;
                let size = self.required(&table, "size", "lengths along x, y and z")?;
                let size = self.vector(size, "size")?;
                let turn = self.frame(&table, ["at", "turn", "order", "matrix"]).linear;
                Some(Form::Block(Block { at, size, turn }))
            }
            "tube" => {
                let across = match fields.get("across") {
                    Some(node) => self.has_direction(node, "across")?,
                    None => Vec3::Z,
                };
                let stations = self.stations(node, until)?;
                Some(Form::Tube(Tube { stations, across }))
            }
            "plate" => {
                let table = self.table(node, node.spot, "plate".to_owned(), keys::PLATE);
                let outline = self.required(&table, "outline", "a list of points around it")?;
                let outline: Option<Vec<Vec3>> =
                    self.vectors(outline, "outline")?.into_iter().collect();
                let outline = outline?;
                let thickness = self.required(&table, "thickness", "its thickness in metres")?;
                let thickness = self.number(thickness, "thickness")?;
                let middle = match table.get("middle") {
                    Some(node) => self.vector(node, "middle")?,
                    None => Plate::centre(&outline),
                };
                Some(Form::Plate(Plate { outline, middle, thickness }))
            }
            _ => self.rib(node),
        }
    }

    fn vector_or(&mut self, fields: &Fields<'_>, key: &str) -> Option<Vec3> {
        fields.get(key).map_or(Some(Vec3::ZERO), |node| self.vector(node, key))
    }

    /// Rows of x, y, z and one or two radii; the last may be a place of another segment instead.
    fn stations(&mut self, node: &Node, until: &mut Option<PlaceDraft>) -> Option<Vec<Station>> {
        let rows = self.list(node, "tube")?;
        let mut stations: Vec<Station> = vec![];
        for (number, row) in rows.iter().enumerate() {
            if number + 1 == rows.len() && !matches!(row.value, Value::List(_)) {
                *until = Some(self.far_end(row)?);
                // Where it is in this segment is known when the figure stands.
                stations.push(Station { at: Vec3::ZERO, radii: stations.last()?.radii });
                break;
            }
            match self.numbers(row, "tube")?[..] {
                [x, y, z, r] => stations.push(Station { at: Vec3::new(x, y, z), radii: [r, r] }),
                [x, y, z, r, s] => stations.push(Station { at: Vec3::new(x, y, z), radii: [r, s] }),
                _ => {
                    let message = "a point of a tube has four or five numbers";
                    let help = "give [x, y, z, radius], or [x, y, z, radius across, other radius]";
                    self.length(row.spot, message.to_owned(), help);
                    return None;
                }
            }
        }
        Some(stations)
    }

    fn far_end(&mut self, node: &Node) -> Option<PlaceDraft> {
        if matches!(node.value, Value::Text(_)) {
            let marker = self.text(node, "the end of a tube")?;
            return Some(PlaceDraft::Marker(marker, Vec3::ZERO));
        }
        let fields = self.table(node, node.spot, "the end of a tube".to_owned(), keys::POINT);
        let (segment, point) = self.point(&fields);
        if segment.is_none() {
            self.missing(&fields, "segment", "the segment that the tube reaches to");
        }
        Some(PlaceDraft::Point(segment, point))
    }

    fn rib(&mut self, node: &Node) -> Option<Form> {
        let fields = self.table(node, node.spot, "rib".to_owned(), keys::RIB);
        let at = self.vector_or(&fields, "at")?;
        let angle_of = |reader: &Self, key: &str| {
            reader.angle_unit(fields.get(key).map_or(fields.spot, |node| node.spot))
        };
        let unit = angle_of(self, "angle");
        let mut number = |key: &str, wanted: &str| {
            let node = self.required(&fields, key, wanted)?;
            self.number(node, key)
        };
        let chord = number("chord", "the distance of its ends, in metres")?;
        let angle = unit * number("angle", "the angle between chord and neck")?;
        let proximal = number("proximal", "the exponent of the spiral behind its peak")?;
        let distal = number("distal", "the exponent of the spiral before its peak")?;
        let node = self.required(&fields, "peak", "its peak, as parts of the chord")?;
        let peak = self.some::<2>(node, "peak")?;
        let node = self.required(&fields, "radii", "the two radii of its section")?;
        let radii = self.some::<2>(node, "radii")?;
        let [along, outward] = match (fields.get("along"), fields.get("outward")) {
            (Some(a), Some(b)) => {
                [self.has_direction(a, "along")?, self.has_direction(b, "outward")?]
            }
            (None, None) => {
                let [pump, swing, plane] = ["pump", "swing", "plane"]
                    .map(|key| Some(angle_of(self, key) * self.number_or(&fields, key, 0.0)?));
                Rib::directions(pump?, swing?, plane?)
            }
            (Some(_), None) => return self.lone(&fields, "outward"),
            (None, Some(_)) => return self.lone(&fields, "along"),
        };
        let rib = Rib { at, chord, peak, angle, proximal, distal, along, outward, radii };
        Some(Form::Rib(rib))
    }

    fn lone(&mut self, fields: &Fields<'_>, key: &str) -> Option<Form> {
        self.missing(fields, key, "`along` and `outward` come together");
        None
    }
}
