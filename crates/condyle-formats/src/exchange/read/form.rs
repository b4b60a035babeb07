//! What bones look like.

use super::find;
use super::value::At;
use crate::Error;
use condyle_mesh::{Ball, Block, Finish, Form, Plate, Rib, Spindle, Station, Tube};
use condyle_model::{SegmentId, Shape};
use std::collections::HashMap;

/// A shape, with the segments by name.
pub(super) fn shape(at: &At<'_>, segments: &HashMap<String, SegmentId>) -> Result<Shape, Error> {
    let until = match at.perhaps("until") {
        Some(end) => Some((find(segments, &end.key("segment")?)?, end.key("point")?.vector()?)),
        None => None,
    };
    let finish = at.perhaps("finish");
    let finishes = Finish::ALL.map(|finish| (finish.name(), finish));
    Ok(Shape {
        name: at.key("name")?.text()?.to_owned(),
        segment: find(segments, &at.key("segment")?)?,
        form: form(&at.key("form")?)?,
        finish: finish.map_or(Ok(Finish::Bone), |finish| finish.word(&finishes))?,
        until,
    })
}

fn form(at: &At<'_>) -> Result<Form, Error> {
    let kind = at.key("kind")?;
    let vector = |key: &str| at.key(key)?.vector();
    let number = |key: &str| at.key(key)?.number();
    Ok(match kind.text()? {
        "ball" => Form::Ball(Ball {
            at: vector("at")?,
            radii: vector("radii")?,
            turn: at.key("turn")?.matrix()?,
        }),
        "box" => Form::Block(Block {
            at: vector("at")?,
            size: vector("size")?,
            turn: at.key("turn")?.matrix()?,
        }),
        "tube" => {
            let mut stations = vec![];
            for station in at.key("stations")?.list()? {
                let radii = station.key("radii")?.some()?;
                stations.push(Station { at: station.key("at")?.vector()?, radii });
            }
            Form::Tube(Tube { stations, across: vector("across")? })
        }
        "plate" => Form::Plate(Plate {
            outline: at.key("outline")?.vectors()?,
            middle: vector("middle")?,
            thickness: number("thickness")?,
        }),
        "rib" => Form::Rib(Rib {
            at: vector("at")?,
            chord: number("chord")?,
            peak: at.key("peak")?.some()?,
            angle: number("angle")?,
            proximal: number("proximal")?,
            distal: number("distal")?,
            along: vector("along")?,
            outward: vector("outward")?,
            radii: at.key("radii")?.some()?,
        }),
        "spindle" => Form::Spindle(Spindle { from: vector("from")?, to: vector("to")? }),
        other => {
            let known = ["ball", "box", "tube", "plate", "rib", "spindle"];
            return Err(kind.unknown(other, known.into_iter()));
        }
    })
}
