use condyle_learn::limits::field::{made, shaped, Field};
use condyle_learn::limits::uniform;
use condyle_math::{Quat, Vec3};
use condyle_model::limit::field::{Ends, Shape};
use std::time::Instant;
fn lu(beyond: f64) -> Shape {
    let d = |v: &[f64]| v.iter().map(|x| x.to_radians()).collect::<Vec<_>>();
    let axes = [-Vec3::X, Vec3::Z, -Vec3::Y];
    let second = Ends::new(d(&[0.0, 180.0]), vec![], d(&[-43.0, 17.0]), d(&[153.0, 123.0])).unwrap();
    let third = Ends::new(d(&[0.0, 90.0]), d(&[0.0, 90.0]), d(&[-90.0, -100.0, -20.0, -10.0]), d(&[60.0, 10.0, 100.0, 100.0])).unwrap();
    Shape::new(axes, [-9f64.to_radians(), 160f64.to_radians()], second, third, beyond.to_radians()).unwrap()
}
fn main() {
    let shape = lu(0.0);
    for (a, b) in [(0.0, 0.0), (0.0, 90.0), (90.0, 0.0), (90.0, 90.0), (160.0, 0.0f64)] {
        let [l, u] = shape.third().at(f64::to_radians(a), b.to_radians());
        println!("{a} {b}: {:.1} {:.1} span {:.1}", l.to_degrees(), u.to_degrees(), (u - l).to_degrees());
    }
    // dense boundary
    let n = 240;
    let mut dense: Vec<[f32; 4]> = vec![];
    for turn in 0..3 { for end in 0..2 { for i in 0..=n { for j in 0..=n {
        let (u, v, e) = (i as f64 / n as f64, j as f64 / n as f64, end as f64);
        let p = match turn { 0 => [e, u, v], 1 => [u, e, v], _ => [u, v, e] };
        dense.push(shape.rotation(shape.angles_at(p)).to_array().map(|c| c as f32));
    }}}}
    println!("{} dense", dense.len());
    let asked: Vec<Quat> = uniform(10000).collect();
    let truth: Vec<f64> = asked.iter().map(|q| {
        let s = q.to_array().map(|c| c as f32);
        let best = dense.iter().map(|p| (p[0]*s[0]+p[1]*s[1]+p[2]*s[2]+p[3]*s[3]).abs()).fold(0.0f32, f32::max);
        let d = 2.0 * f64::from(best.min(1.0)).acos();
        if shape.contains(*q) { d } else { -d }
    }).collect();
    let volume = truth.iter().filter(|d| **d > 0.0).count() as f64 / 1e4;
    println!("volume {volume}");
    for nodes in [48, 48, 64, 64, 80] {
        let g = std::sync::Arc::new(shaped(lu(0.0), Some(nodes)));
        let t = Instant::now();
        let field: Field = made(&g);
        let took = t.elapsed().as_secs_f64();
        let mut e: Vec<f64> = asked.iter().zip(&truth).map(|(q, t)| (field.distance(*q) - t).to_degrees().abs()).collect();
        let mut near: Vec<f64> = asked.iter().zip(&truth).filter(|(_, t)| t.abs() < 0.35).map(|(q, t)| (field.distance(*q) - t).to_degrees().abs()).collect();
        e.sort_by(f64::total_cmp); near.sort_by(f64::total_cmp);
        let pc = |v: &Vec<f64>, p: f64| v[((v.len() - 1) as f64 * p) as usize];
        let wrong = asked.iter().zip(&truth).filter(|(q, t)| (field.distance(**q) > 0.0) != (**t > 0.0)).count();
        let wrong3 = asked.iter().zip(&truth).filter(|(q, t)| t.abs() > 0.035 && (field.distance(**q) > 0.0) != (**t > 0.0)).count();
        println!("{nodes}: {:.3} s, all median {:.3} p95 {:.3} p99 {:.2} max {:.2}; within 20°: median {:.3} p95 {:.3} p99 {:.2} max {:.2}; sign wrong {wrong}, beyond 2° {wrong3}; share {:.4}", took, pc(&e, 0.5), pc(&e, 0.95), pc(&e, 0.99), pc(&e, 1.0), pc(&near, 0.5), pc(&near, 0.95), pc(&near, 0.99), pc(&near, 1.0), field.learned().valid);
    }
    // projection with beyond
    for beyond in [0.0, 15.0] {
        let g = std::sync::Arc::new(shaped(lu(beyond), Some(64)));
        let field = made(&g);
        let mut off: Vec<f64> = vec![]; let mut outside = 0; let mut n = 0;
        for q in asked.iter().filter(|q| field.distance(**q) < 0.0) {
            let p = field.nearest(*q);
            if field.distance(p) < 0.0 { outside += 1; }
            n += 1;
            off.push((q.angle_to(p) + field.distance(*q)).to_degrees());
        }
        off.sort_by(f64::total_cmp);
        let pc = |p: f64| off[((off.len() - 1) as f64 * p) as usize];
        println!("beyond {beyond}: {n} projected, {outside} stay outside; way less distance p1 {:.2} median {:.3} p95 {:.2} p99 {:.2} max {:.2}", pc(0.01), pc(0.5), pc(0.95), pc(0.99), pc(1.0));
    }
}
