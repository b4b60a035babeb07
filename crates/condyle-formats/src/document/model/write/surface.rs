//! Shapes.

use super::{Writer, key, line, number, numbers, text, vector};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_mesh::{Finish, Form};
use condyle_model::Shape;
use std::fmt::Write;

impl Writer<'_> {
    pub(super) fn shape(&mut self, shape: &Shape) {
        let form = match &shape.form {
            Form::Ball(ball) => {
                let mut parts = turned(ball.at, ball.turn);
                parts.push(format!("radii = {}", vector(ball.radii)));
                format!("ball = {{ {} }}", parts.join(", "))
            }
            Form::Block(block) => {
                let mut parts = turned(block.at, block.turn);
                parts.push(format!("size = {}", vector(block.size)));
                format!("box = {{ {} }}", parts.join(", "))
            }
            Form::Tube(tube) => {
                let mut rows: Vec<String> = tube
                    .stations
                    .iter()
                    .map(|s| {
                        let ([x, y, z], [r, other]) = (s.at.to_array(), s.radii);
                        if r == other {
                            numbers(&[x, y, z, r])
                        } else {
                            numbers(&[x, y, z, r, other])
                        }
                    })
                    .collect();
                if let Some((segment, point)) = shape.until {
                    rows.pop();
                    let segment = text(&self.model.segment(segment).name);
                    rows.push(format!("{{ segment = {segment}, at = {} }}", vector(point)));
                }
                let across = match tube.across {
                    Vec3::Z => String::new(),
                    across => format!("\nacross = {}", vector(across)),
                };
                format!("tube = [{}]{across}", rows.join(", "))
            }
            Form::Plate(plate) => {
                let outline: Vec<String> = plate.outline.iter().map(|p| vector(*p)).collect();
                format!(
                    "plate = {{ outline = [{}], middle = {}, thickness = {} }}",
                    outline.join(", "),
                    vector(plate.middle),
                    number(plate.thickness),
                )
            }
            Form::Rib(rib) => format!(
                "rib = {{ at = {}, chord = {}, peak = {}, angle = {}, proximal = {}, distal = {}, \
                 along = {}, outward = {}, radii = {} }}",
                vector(rib.at),
                number(rib.chord),
                numbers(&rib.peak),
                number(rib.angle),
                number(rib.proximal),
                number(rib.distal),
                vector(rib.along),
                vector(rib.outward),
                numbers(&rib.radii),
            ),
            // Documents have none: it stands where a model does not say what its bones look like.
            Form::Spindle(_) => return,
        };
        line!(self, "\n[shape.{}]", key(&shape.name));
        line!(self, "segment = {}", text(&self.model.segment(shape.segment).name));
        if shape.finish != Finish::Bone {
            line!(self, "finish = \"{}\"", shape.finish.name());
        }
        line!(self, "{form}");
    }
}

fn turned(at: Vec3, turn: Mat3) -> Vec<String> {
    super::frame(Affine { translation: at, ..Affine::from_rotation(turn) })
}
