//! Every type of joint against the formulas of Rotenberg, *Skeletons*, section 2.2.
//!
//! The source writes points as rows, v′ = v·M, with the offset r in the last row; its printed
//! formulas are lost, so they are derived here once more, in that convention, from what each joint
//! does to the three axes and the origin. Ours are their transposes.

use super::read;
use condyle_model::{Mode, Pose, Program};

/// Three axes and an origin, as rows.
type Rows = [[f64; 3]; 4];

const R: [f64; 3] = [0.1, -0.2, 0.3];

/// The product of two row matrices: the first is applied first.
fn then(first: Rows, second: Rows) -> Rows {
    let mut out = [[0.0; 3]; 4];
    for (i, row) in out.iter_mut().enumerate() {
        for (k, cell) in row.iter_mut().enumerate() {
            *cell = (0..3).map(|j| first[i][j] * second[j][k]).sum::<f64>()
                + if i == 3 { second[3][k] } else { 0.0 };
        }
    }
    out
}

fn linear(rows: [[f64; 3]; 3]) -> Rows {
    [rows[0], rows[1], rows[2], [0.0; 3]]
}

fn moved(by: [f64; 3]) -> Rows {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], by]
}

fn x(t: f64) -> Rows {
    linear([[1.0, 0.0, 0.0], [0.0, t.cos(), t.sin()], [0.0, -t.sin(), t.cos()]])
}

fn y(t: f64) -> Rows {
    linear([[t.cos(), 0.0, -t.sin()], [0.0, 1.0, 0.0], [t.sin(), 0.0, t.cos()]])
}

fn z(t: f64) -> Rows {
    linear([[t.cos(), t.sin(), 0.0], [-t.sin(), t.cos(), 0.0], [0.0, 0.0, 1.0]])
}

/// A turn about any unit axis: c·I + (1 - c)·aᵀa with ±s·a beside the diagonal.
fn about([a, b, c]: [f64; 3], t: f64) -> Rows {
    let (s, k) = (t.sin(), t.cos());
    let m = 1.0 - k;
    linear([
        [k + m * a * a, m * a * b + s * c, m * a * c - s * b],
        [m * b * a - s * c, k + m * b * b, m * b * c + s * a],
        [m * c * a + s * b, m * c * b - s * a, k + m * c * c],
    ])
}

/// A unit quaternion x, y, z, w.
fn quaternion([x, y, z, w]: [f64; 4]) -> Rows {
    linear([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ])
}

/// The joint of a document of one segment at R, at these stored numbers.
fn joint(lines: &str, stored: &[f64]) -> Rows {
    let text = format!(
        "condyle = 1\nkind = \"model\"\n[segment.base]\n[segment.bone]\nparent = \"base\"\n\
         at = [0.1, -0.2, 0.3]\n[joint.j]\nsegment = \"bone\"\n{lines}\n"
    );
    let model = read(&text);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(stored, Mode::Posed, &mut pose).expect(lines);
    let bone = pose.segment(model.find_segment("bone").unwrap());
    [bone.linear.x, bone.linear.y, bone.linear.z, bone.translation].map(|v| v.to_array())
}

fn same(lines: &str, stored: &[f64], expected: Rows) {
    let found = joint(lines, stored);
    let offset = then(expected, moved(R));
    for (a, b) in found.iter().flatten().zip(offset.iter().flatten()) {
        assert!((a - b).abs() < 1e-14, "{lines}: {found:?} is not {offset:?}");
    }
}

#[test]
fn turns() {
    let (t, u, v) = (0.7, -0.4, 1.1);
    same("type = \"hinge\"\naxis = [1, 0, 0]", &[t], x(t));
    same("type = \"hinge\"\naxis = [0, 1, 0]", &[t], y(t));
    same("type = \"hinge\"\naxis = [0, 0, 1]", &[t], z(t));
    same("type = \"hinge\"\naxis = [0.6, -0.48, 0.64]", &[t], about([0.6, -0.48, 0.64], t));
    // What the source calls xy turns about x first: for columns that is y·x.
    same("type = \"universal\"\naxes = [[0, 1, 0], [1, 0, 0]]", &[u, t], then(x(t), y(u)));
    same("type = \"universal\"\naxes = [[0, 0, 1], [1, 0, 0]]", &[u, t], then(x(t), z(u)));
    same("type = \"universal\"\naxes = [[0, 0, 1], [0, 1, 0]]", &[u, t], then(y(t), z(u)));
    let oblique = "type = \"universal\"\naxes = [[0.6, 0, 0.8], [0, 0.6, 0.8]]";
    same(oblique, &[u, t], then(about([0.0, 0.6, 0.8], t), about([0.6, 0.0, 0.8], u)));
    let axis = |name: char| match name {
        'x' => x,
        'y' => y,
        _ => z,
    };
    for order in
        ["xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"]
    {
        let [a, b, c] = [0, 1, 2].map(|i| axis(order.chars().nth(i).unwrap()));
        let lines = format!("type = \"euler\"\norder = \"{order}\"");
        same(&lines, &[t, u, v], then(then(c(v), b(u)), a(t)));
    }
    // A turn by t about a is the quaternion (a·sin t/2, cos t/2).
    let (s, c) = (0.5f64 * t).sin_cos();
    let q = [0.6 * s, -0.48 * s, 0.64 * s, c];
    same("type = \"ball\"", &q, quaternion(q));
    same("type = \"ball\"", &q, about([0.6, -0.48, 0.64], t));
}

#[test]
fn slides_and_compounds() {
    let (t, u) = (0.7, -0.4);
    let along = [0.6 * 0.05, -0.48 * 0.05, 0.64 * 0.05];
    same("type = \"weld\"", &[], moved([0.0; 3]));
    same("type = \"prismatic\"\naxis = [0.6, -0.48, 0.64]", &[0.05], moved(along));
    let two = "type = \"prismatic\"\naxes = [[1, 0, 0], [0, 0, 1]]";
    same(two, &[0.05, -0.02], moved([0.05, 0.0, -0.02]));
    let three = "type = \"prismatic\"\naxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    same(three, &[0.05, -0.02, 0.03], moved([0.05, -0.02, 0.03]));
    same("type = \"planar\"", &[0.05, -0.02, t], then(z(t), moved([0.05, -0.02, 0.0])));
    // The source's xyz of the six-degree joint: x is applied first.
    let free = then(then(then(x(t), y(u)), z(0.3)), moved([0.05, -0.02, 0.03]));
    same("type = \"free\"\norder = \"zyx\"", &[0.05, -0.02, 0.03, 0.3, u, t], free);
    // t_x = k·θ with k = pitch / 2π.
    let screw = moved([0.012 * t / std::f64::consts::TAU, 0.0, 0.0]);
    same("type = \"screw\"\naxis = [1, 0, 0]\npitch = 0.012", &[t], then(x(t), screw));
    // A straight curve c(u) = (u, 2u, 0) needs no spline to be known.
    let curve = "type = \"curve\"\npath = [[[0, 0], [1, 1]], [[0, 0], [1, 2]], [[0, 0], [1, 0]]]";
    same(curve, &[0.3], moved([0.3, 0.6, 0.0]));
    // Turning with its tangent (1, 2, 0)/√5, the car pitches up by atan 2.
    let car = format!("{curve}\nforward = [1, 0, 0]\nup = [0, 1, 0]");
    same(&car, &[0.3], then(z(2f64.atan()), moved([0.3, 0.6, 0.0])));
}

#[test]
fn joints_that_are_not_rigid() {
    let s = 1.7f64;
    let stretch = |[a, b, c]: [f64; 3]| linear([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]);
    same("type = \"scale\"", &[s], stretch([s, s, s]));
    same("type = \"scale\"\naxis = [1, 0, 0]", &[s], stretch([s, 1.0, 1.0]));
    let axes = "type = \"scale\"\naxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    same(axes, &[s, 0.5, 2.0], stretch([s, 0.5, 2.0]));
    let thin = 1.0 / s.sqrt();
    same("type = \"scale\"\naxis = [0, 1, 0]\nvolume = true", &[s], stretch([thin, s, thin]));
    // x grows by 0.3 of y: as rows, y's image has an x.
    let shear = linear([[1.0, 0.0, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    same("type = \"shear\"\nalong = [1, 0, 0]\nacross = [0, 1, 0]", &[0.3], shear);
}
