#[path = "../tests/field/shapes.rs"]
#[allow(dead_code)]
mod shapes;
#[path = "../tests/field/drawn.rs"]
#[allow(dead_code)]
mod drawn;
use condyle_learn::limits::{Cloud, Settings, lab, learn};
use condyle_math::{Quat, Vec3};
use shapes::Random;
use std::io::Write;

enum Set { Drawn(drawn::Drawn), Ball(Quat, f64), Ellipsoid(Quat, Vec3), Hollow(drawn::Drawn, Quat, f64), Wide(f64, f64, Quat, f64), Cap(Vec3, f64, Quat) }
impl Set {
    fn holds(&self, q: Quat) -> bool {
        match self {
            Set::Drawn(d) => d.holds(q),
            Set::Ball(c, r) => q.angle_to(*c) < *r,
            Set::Ellipsoid(c, r) => { let v = (c.conjugate() * q).log(); let [a,b,c] = [v.x/r.x, v.y/r.y, v.z/r.z]; a*a+b*b+c*c < 1.0 }
            Set::Hollow(d, c, r) => d.holds(q) && q.angle_to(*c) > *r,
            Set::Wide(swing, twist, c, skew) => {
                let q = *c * q;
                let s = 2.0 * q.x.hypot(q.y).atan2(q.z.hypot(q.w));
                let t = 2.0 * (q.z / q.w).atan();
                s <= *swing && (t - skew * s * q.x.signum() * 0.3).abs() <= *twist
            }
            Set::Cap(v, r, c) => { let w = (*c * q).log(); w.x.abs() <= v.x && w.y.abs() <= v.y && w.z.abs() <= v.z && w.norm() < *r }
        }
    }
}
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (from, to): (usize, usize) = (args[0].parse().unwrap(), args[1].parse().unwrap());
    let mut file = std::io::BufWriter::new(std::fs::File::create(&args[2]).unwrap());
    for number in from..to {
        let mut random = Random(0xA076_1D64_78BD_642F ^ ((number as u64 + 1) << 32) ^ ((number as u64 + 1) << 7));
        for _ in 0..20 { random.unit(); }
        let turn = random.rotation();
        let set = match number % 10 {
            0..=3 => Set::Drawn(drawn::drawn(number * 4 + number % 4 + 400)),
            4 => Set::Ball(turn, 0.5 + 1.2 * random.unit()),
            5 => Set::Ellipsoid(turn, Vec3::new(0.4 + random.unit(), 0.4 + 0.7 * random.unit(), 0.3 + 0.6 * random.unit())),
            6 => Set::Hollow(drawn::drawn(4 * number + 401 + number % 2), turn, 0.35 + 0.4 * random.unit()),
            7 => Set::Wide(0.8 + 1.4 * random.unit(), 0.2 + 1.0 * random.unit(), turn, random.unit()),
            8 => Set::Cap(Vec3::new(0.3 + random.unit(), 0.3 + random.unit(), 0.3 + random.unit()), 0.6 + 0.9 * random.unit(), turn),
            _ => Set::Drawn(drawn::drawn(number * 4 + 1 + 402)),
        };
        let share = (0..4000).filter(|_| set.holds(random.rotation())).count() as f64 / 4000.0;
        if share < 0.01 || share > 0.6 { continue }
        let count = (500.0 * 24f64.powf(random.unit())) as usize;
        let more: f64 = if random.unit() < 0.35 { 1.0 + 15.0 * random.unit() } else { 1.0 };
        let axis = random.direction();
        let middle = random.rotation();
        let soft = 0.05 + 0.8 * random.unit();
        let mut samples = vec![];
        while samples.len() < count {
            let q = random.rotation();
            if !set.holds(q) { continue }
            if more > 1.0 {
                let side = (middle.conjugate() * q).log().dot(axis) / soft;
                let keep = 1.0 / more + (1.0 - 1.0 / more) / (1.0 + (-side).exp());
                if random.unit() > keep { continue }
            }
            samples.push(q);
        }
        {
            let mut p = lab::P.write().unwrap();
            *p = [f64::NAN; 24];
            p[20] = 1.0; p[8] = 0.0; p[0] = 0.1;
        }
        let _ = learn(&Cloud::gather(&[&samples], 0.0).unwrap(), &Settings::default()).unwrap();
        let (features, at) = lab::OUT.lock().unwrap().take().unwrap();
        // boundary
        let mut points: Vec<[f32; 4]> = vec![];
        let mut tries = 0usize;
        let all = 16000;
        while points.len() < all && tries < 20_000_000 {
            tries += 1;
            let a = random.rotation();
            let way = random.direction() * 0.2;
            let inside = set.holds(a);
            if set.holds(a * Quat::exp(way)) == inside { continue }
            let (mut near, mut far) = (0.0, 1.0);
            for _ in 0..16 {
                let m = 0.5 * (near + far);
                if set.holds(a * Quat::exp(way * m)) == inside { near = m } else { far = m }
            }
            points.push((a * Quat::exp(way * near)).normalized().to_array().map(|c| c as f32));
        }
        // crossings of a segment of length L: rate = S E|cos| L... S = 2 * (crossed/tries) * 8pi^2 / L
        let surface = 2.0 * points.len() as f64 / tries as f64 * 8.0 * std::f64::consts::PI.powi(2) / 0.2;
        let slack = surface / (points.len() as f64 * std::f64::consts::PI);
        let mut rows = 0;
        let mut guard = 0;
        while rows < 2500 && guard < 60_000 {
            guard += 1;
            let i = (random.unit() * at.len() as f64) as usize % at.len();
            let f = &features[i];
            let q = at[i].to_array().map(|c| c as f32);
            let best = points.iter().map(|p| (p[0]*q[0]+p[1]*q[1]+p[2]*q[2]+p[3]*q[3]).abs()).fold(0.0f32, f32::max);
            let d = 2.0 * f64::from(best.min(1.0)).acos();
            let d = (d * d - slack).max(0.0).sqrt();
            if d > 1.5 * f64::from(f[19]) { continue }
            let held = set.holds(at[i]);
            let mut row = f.to_vec();
            row.push(if held { d as f32 } else { -d as f32 } / f[19]);
            row.push(number as f32);
            for v in row { file.write_all(&v.to_le_bytes()).unwrap(); }
            rows += 1;
        }
        eprintln!("{number} kind {} share {share:.3} n {count} more {more:.1} rows {rows} surface {surface:.1} slack {:.2}", number % 10, slack.sqrt().to_degrees());
    }
}
