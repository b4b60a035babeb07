#[path = "../tests/field/shapes.rs"]
#[allow(dead_code)]
mod shapes;
use condyle_learn::limits::{Cloud, Settings, State, learn};
use shapes::{Random, SHAPES};
fn main() {
    let shape = SHAPES[3];
    let mut random = Random(5);
    let boundary = shape.boundary(30_000, &mut random);
    let two = boundary.at(&shape, 2f64.to_radians(), 4000, &mut random);
    let cloud = shape.samples(5000, &mut random);
    for set in std::env::args().skip(1) {
    println!("== {set}");
    let mut t = [[[0.0f64; 3]; 4]; 2];
    {
 let mut p = condyle_learn::limits::lab::P.write().unwrap();
 *p = [f64::NAN; 24];
 for kv in set.split(',') { if let Some((i, v)) = kv.split_once('=') { p[i.parse::<usize>().unwrap()] = v.parse().unwrap(); } }
 }
    {
        let field = learn(&Cloud::gather(&[&cloud], 0.0).unwrap(), &Settings::default()).unwrap();
        for (q, inside) in &two {
            let swing = (2.0 * (q.x * q.x + q.y * q.y).sqrt().atan2((q.z * q.z + q.w * q.w).sqrt())).to_degrees();
            let twist = (2.0 * (q.z / q.w).atan()).to_degrees().abs();
            // in angle of rotation: distance to the faces
            let a = 110.0 - swing;
            let b = (45.0 - twist) * (swing / 2.0).to_radians().cos(); 
            let k = if a.abs() < 8.0 && b.abs() < 8.0 { 0 } else if a.abs() < 8.0 { 1 } else if swing < 60.0 { 2 } else { 3 };
            let e = &mut t[usize::from(*inside)][k];
            e[0] += 1.0;
            e[1] += f64::from(u8::from((field.state(*q).0 == State::Valid) != *inside));
            let truth = if *inside { 2.0 } else { -2.0 };
            e[2] += field.distance(*q).to_degrees() - truth;
        }
    }
    for (i, name) in ["outside", "inside"].iter().enumerate() {
        for (k, what) in ["edge", "swing face", "twist face, swing<60", "twist face beyond"].iter().enumerate() {
            let e = t[i][k];
            println!("{name} {what}: n {} wrong {:.3} bias {:.2}", e[0], e[1] / e[0], e[2] / e[0]);
        }
    }
}
}
