//! A resolved model and a conformance file of it, for authors of evaluators:
//! `cargo run --release --example conformance -- MODEL N FOLDER`.
//!
//! FOLDER gets `MODEL.json`, as `condyle convert` writes it, and `MODEL.poses.json`: N poses, open and
//! posed, from inside to far outside the ranges, with effective coordinates and the transforms of all
//! segments. `examples/evaluator.py` compares itself with them; `docs/exchange.md` says what they are.

mod record;

use condyle::formats::exchange;
use condyle::open;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, count, folder] = &arguments[..] else {
        return Err("usage: conformance MODEL N FOLDER".into());
    };
    let count: usize = count.parse().map_err(|_| format!("`{count}` is no number of poses"))?;
    let path = Path::new(model);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let model = open::model(path)?.value;
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join(format!("{name}.json")), exchange::write(&model))?;
    let poses = record::record(&model, count);
    std::fs::write(folder.join(format!("{name}.poses.json")), poses)?;
    Ok(())
}
