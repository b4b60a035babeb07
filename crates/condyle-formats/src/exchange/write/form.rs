//! What bones look like.

use super::{Writer, vector};
use condyle_math::Mat3;
use condyle_mesh::{Ball, Block, Form, Plate, Rib, Spindle, Station, Tube};
use condyle_model::Shape;
use serde_json::{Value, json};

impl Writer<'_> {
    pub(super) fn shape(&self, shape: &Shape) -> Value {
        let Shape { name, segment, form: of, finish, until } = shape;
        let until = until.map(|(segment, point)| {
            json!({ "segment": self.segment_name(Some(segment)), "point": vector(point) })
        });
        json!({
            "name": name,
            "segment": self.segment_name(Some(*segment)),
            "finish": finish.name(),
            "form": form(of),
            "until": until,
        })
    }
}

fn form(form: &Form) -> Value {
    match form {
        Form::Ball(Ball { at, radii, turn }) => json!({
            "kind": "ball",
            "at": vector(*at),
            "radii": vector(*radii),
            "turn": matrix(*turn),
        }),
        Form::Block(Block { at, size, turn }) => json!({
            "kind": "box",
            "at": vector(*at),
            "size": vector(*size),
            "turn": matrix(*turn),
        }),
        Form::Tube(Tube { stations, across }) => {
            let station =
                |Station { at, radii }: &Station| json!({ "at": vector(*at), "radii": radii });
            json!({
                "kind": "tube",
                "stations": stations.iter().map(station).collect::<Value>(),
                "across": vector(*across),
            })
        }
        Form::Plate(Plate { outline, middle, thickness }) => json!({
            "kind": "plate",
            "outline": outline.iter().map(|p| vector(*p)).collect::<Value>(),
            "middle": vector(*middle),
            "thickness": thickness,
        }),
        Form::Rib(rib) => {
            let Rib { at, chord, peak, angle, proximal, distal, along, outward, radii } = rib;
            json!({
                "kind": "rib",
                "at": vector(*at),
                "chord": chord,
                "peak": peak,
                "angle": angle,
                "proximal": proximal,
                "distal": distal,
                "along": vector(*along),
                "outward": vector(*outward),
                "radii": radii,
            })
        }
        Form::Spindle(Spindle { from, to }) => {
            json!({ "kind": "spindle", "from": vector(*from), "to": vector(*to) })
        }
    }
}

/// Three rows of three numbers.
fn matrix(m: Mat3) -> Value {
    let rows = m.transpose();
    json!([rows.x.to_array(), rows.y.to_array(), rows.z.to_array()])
}
