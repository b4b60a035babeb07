#[path = "../tests/field/shapes.rs"]
#[allow(dead_code)]
mod shapes;
#[path = "../tests/field/drawn.rs"]
#[allow(dead_code)]
mod drawn;
use condyle_learn::limits::{Cloud, Field, Settings, State, lab, learn};
use condyle_math::{Quat, Vec3};
use shapes::{ASIDE, Random, SHAPES, Shape};

fn samples(shape: &Shape, count: usize, more: f64, random: &mut Random) -> Vec<Quat> {
    let mut found = vec![];
    while found.len() < count {
        for q in shape.samples(100, random) {
            let sparse = (Quat::exp(Vec3::new(0.2, 0.3, 0.1)).conjugate() * q).log().x < 0.0;
            if sparse && random.unit() * more > 1.0 { continue; }
            found.push(q);
        }
    }
    found.truncate(count);
    found
}
fn learned(samples: &[Quat]) -> Field {
    learn(&Cloud::gather(&[samples], 0.0).unwrap(), &Settings::default()).unwrap()
}
fn accuracy(points: &[(Quat, bool)], valid: impl Fn(Quat) -> bool) -> [f64; 2] {
    let (mut good, mut all) = ([0.0; 2], [0.0; 2]);
    for (q, inside) in points {
        all[usize::from(*inside)] += 1.0;
        good[usize::from(*inside)] += f64::from(u8::from(valid(*q) == *inside));
    }
    [good[0] / all[0], good[1] / all[1]]
}
// lab SEEDS COUNTS(5000,1500,5000u,..) SET SET ...; SET = i=v,i=v
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let which: Vec<usize> = args[0].split(',').filter_map(|s| s.parse().ok()).collect();
    let seeds: u64 = args[1].parse().unwrap();
    let kinds: Vec<(usize, f64)> = args[2].split(',').map(|k| {
        let u = k.ends_with('u');
        (k.trim_end_matches('u').parse().unwrap(), if u { 12.0 } else { 1.0 })
    }).collect();
    let sets = &args[3..];
    let all: Vec<Shape> = SHAPES.into_iter().chain(ASIDE).chain(drawn::SEEN).collect();
    let mut sums = vec![vec![[0.0f64; 6]; kinds.len()]; sets.len()];
    let mut worst = vec![vec![[9f64; 3]; kinds.len()]; sets.len()];
    for w in &which {
        let shape = all[*w];
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let share = shape.share(&mut random);
        let boundary = shape.boundary(30_000, &mut random);
        let two = boundary.at(&shape, 2f64.to_radians(), 1600, &mut random);
        let three = boundary.at(&shape, 3f64.to_radians(), 1600, &mut random);
        for (k, (count, more)) in kinds.iter().enumerate() {
            let mut rows = vec![[0.0; 6]; sets.len()];
            for _ in 0..seeds {
                let cloud = samples(&shape, *count, *more, &mut random);
                for (s, set) in sets.iter().enumerate() {
                    {
                        let mut p = lab::P.write().unwrap();
                        *p = [f64::NAN; 24];
                        for kv in set.split(',') {
                            if let Some((i, v)) = kv.split_once('=') {
                                p[i.parse::<usize>().unwrap()] = v.parse().unwrap();
                            }
                        }
                    }
                    let start = std::time::Instant::now();
                    let field = learned(&cloud);
                    let took = start.elapsed().as_secs_f64();
                    let valid = |q| field.state(q).0 == State::Valid;
                    let [a, b] = accuracy(&two, valid);
                    let [c, d] = accuracy(&three, valid);
                    let v = [a, b, c, d, field.learned().valid / share, took];
                    for (x, v) in rows[s].iter_mut().zip(v) { *x += v / seeds as f64; }
                    if s == 0 && std::env::var("V").is_ok() {
                        eprintln!("   gap {:.2} spacing {:.2} radius {:.1}", field.learned().gap.to_degrees(), field.learned().spacing.to_degrees(), field.learned().radius.to_degrees());
                    }
                }
            }
            for (s, r) in rows.iter().enumerate() {
                println!("{:44.44} {count:5}{} {:14} 2° {:.3} ({:.3} {:.3})  3° {:.3} ({:.3} {:.3}) vol {:.3} {:.2}s",
                    shape.name, if *more > 1.0 {"u"} else {" "}, sets[s], 0.5*(r[0]+r[1]), r[0], r[1], 0.5*(r[2]+r[3]), r[2], r[3], r[4], r[5]);
                for (x, v) in sums[s][k].iter_mut().zip(r) { *x += v / which.len() as f64; }
                let m = [0.5*(r[0]+r[1]), 0.5*(r[2]+r[3]), 0.0];
                for i in 0..2 { worst[s][k][i] = worst[s][k][i].min(m[i]); }
            }
        }
    }
    for (k, kind) in kinds.iter().enumerate() {
        for (s, set) in sets.iter().enumerate() {
            let r = sums[s][k];
            println!("MEAN {}{} {set:20} 2° {:.4} ({:.3} {:.3}) 3° {:.4} ({:.3} {:.3}) vol {:.3}  worst {:.3} {:.3}  {:.2}s", kind.0, if kind.1 > 1.0 {"u"} else {""},
                0.5*(r[0]+r[1]), r[0], r[1], 0.5*(r[2]+r[3]), r[2], r[3], r[4], worst[s][k][0], worst[s][k][1], r[5]);
        }
    }
}
