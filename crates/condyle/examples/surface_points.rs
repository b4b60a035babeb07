//! The corners of a model's surfaces in each frame of a motion, for programs that show the same scene.
//!
//! `cargo run --release -p condyle --example surface_points -- MODEL MOTION > points.json` prints a list of frames,
//! each a list of `[x, y, z]` in metres.

use condyle::{Figure, Mode, Pose, Program};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(model), Some(motion)) = (arguments.next(), arguments.next()) else {
        return Err("give a model and a motion".into());
    };
    let model = condyle::open::model(model.as_ref())?.value;
    let motion = condyle::open::motion(motion.as_ref(), &model)?.value;
    let figure = Figure::new(&model);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut frames = vec![];
    for stored in &motion.frames {
        program.evaluate(stored, Mode::Open, &mut pose)?;
        let points = figure.parts.iter().flat_map(|part| figure.posed(part, &pose).positions);
        let points: Vec<String> =
            points.map(|p| format!("[{:.7},{:.7},{:.7}]", p.x, p.y, p.z)).collect();
        frames.push(format!("[{}]", points.join(",")));
    }
    println!("[{}]", frames.join(",\n"));
    Ok(())
}
