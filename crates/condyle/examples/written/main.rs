//! A model as another program's file, and beside it what that program should answer:
//! `cargo run -p condyle --example written -- MODEL FORMAT OUT [POSES]` writes OUT and OUT.json.
//!
//! MODEL is a shipped model or a file; FORMAT is `osim`, `urdf`, `mjcf`, `usda`, or `none` for the model's own
//! coordinates alone. OUT.json has values of all joints and the transforms of all bodies at random legal poses. The
//! scripts in `oracles/written/` compare.

mod answer;

use condyle::open;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, format, out, rest @ ..] = &arguments[..] else {
        return Err("usage: written MODEL FORMAT OUT [POSES]".into());
    };
    let poses = rest.first().map_or(Ok(100), |count| count.parse())?;
    let model = open::model(Path::new(model))?.value;
    let Some((text, answer)) = answer::written(&model, format, poses) else {
        return Err(format!("`{format}` is no format that is written").into());
    };
    std::fs::write(out, text)?;
    std::fs::write(format!("{out}.json"), answer.to_string())?;
    Ok(())
}
