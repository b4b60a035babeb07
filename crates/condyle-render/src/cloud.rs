//! Points in a box of three axes, coloured by a number, as a picture.

use crate::canvas::{Canvas, TextSize};
use crate::palette::{self, Colour};

/// Points over three numbers, with a fourth as their colour: blue for the least, by yellow, to red for the greatest.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// What it shows, above it.
    pub title: String,
    /// What the three axes are; each is as long as its points need.
    pub axes: [String; 3],
    /// The unit of what the colour tells.
    pub unit: String,
    /// Places, and what the colour tells.
    pub points: Vec<([f64; 3], f64)>,
}

const SIZE: TextSize = TextSize::Medium;
/// Pixels above the box, and to the right of it for the scale of colours.
const TOP: f64 = 40.0;
const RIGHT: f64 = 92.0;
/// Pixels of a point.
const RADIUS: f64 = 2.2;

impl Cloud {
    /// The cloud as a picture of so many pixels: the first axis goes to the right and forward, the second to the left and
    /// forward, the third up. Points in front cover those behind.
    ///
    /// ```
    /// use condyle_render::{Cloud, palette};
    /// let cloud = Cloud {
    ///     title: "two".into(),
    ///     axes: ["a".into(), "b".into(), "c".into()],
    ///     unit: "mm".into(),
    ///     points: vec![([0.0, 0.0, 0.0], 1.0), ([1.0, 1.0, 1.0], 2.0)],
    /// };
    /// let picture = cloud.picture(400, 300);
    /// let [x, y] = cloud.place([1.0, 1.0, 1.0], 400, 300);
    /// assert_eq!(picture.at(x as usize, y as usize), Some(palette::AXIS_X));
    /// ```
    #[must_use]
    pub fn picture(&self, width: usize, height: usize) -> Canvas {
        let mut canvas = Canvas::new(width, height, palette::PAGE);
        let view = self.view(width, height);
        let [low, high] = view.ranges;
        let corner = |x: usize, y: usize, z: usize| {
            let pick = |axis: usize, end: usize| if end == 0 { low[axis] } else { high[axis] };
            [pick(0, x), pick(1, y), pick(2, z)]
        };
        // The three faces behind, then the points.
        for axis in 0..3 {
            for step in 0..=4 {
                let part = f64::from(step) / 4.0;
                for other in (0..3).filter(|o| *o != axis) {
                    let mut from = corner(0, 0, 0);
                    from[axis] = low[axis] + part * (high[axis] - low[axis]);
                    let mut to = from;
                    to[other] = high[other];
                    let shade = if step == 0 { palette::LEADER } else { palette::GROUND };
                    line(&mut canvas, view.place(from), view.place(to), shade);
                }
            }
        }
        let range = self.range();
        let mut order: Vec<&([f64; 3], f64)> = self
            .points
            .iter()
            .filter(|(p, v)| p.iter().all(|x| x.is_finite()) && v.is_finite())
            .collect();
        order.sort_by(|a, b| view.depth(a.0).total_cmp(&view.depth(b.0)));
        for (place, value) in order {
            disc(&mut canvas, view.place(*place), shade(*value, range));
        }
        self.names(&mut canvas, &view);
        scale(&mut canvas, width, height, range, &self.unit);
        canvas
    }

    /// Where a place is in such a picture, in pixels from the upper left corner.
    #[must_use]
    pub fn place(&self, place: [f64; 3], width: usize, height: usize) -> [f64; 2] {
        self.view(width, height).place(place)
    }

    fn range(&self) -> [f64; 2] {
        let values = self.points.iter().map(|(_, value)| *value).filter(|v| v.is_finite());
        let [low, high] =
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
        if high > low { [low, high] } else { [low.min(0.0), low.max(0.0) + 1.0] }
    }

    fn view(&self, width: usize, height: usize) -> View {
        let mut ranges = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (place, _) in &self.points {
            for axis in (0..3).filter(|axis| place[*axis].is_finite()) {
                ranges[0][axis] = ranges[0][axis].min(place[axis]);
                ranges[1][axis] = ranges[1][axis].max(place[axis]);
            }
        }
        for axis in 0..3 {
            // A range of its own where nothing moves.
            if !(ranges[1][axis] - ranges[0][axis]).is_finite() {
                ranges[0][axis] = 0.0;
                ranges[1][axis] = 1.0;
            } else if ranges[1][axis] - ranges[0][axis] < 1e-9 {
                ranges[0][axis] -= 0.5;
                ranges[1][axis] += 0.5;
            }
        }
        let [width, height] = [width as f64 - RIGHT, height as f64 - TOP];
        // Seen from above in front: 1.73 edges wide, 2 high.
        let edge = (width / 2.1).min(height / 2.3).max(1.0);
        View { ranges, edge, middle: [0.5 * width, TOP + 0.5 * height - 6.0] }
    }

    fn names(&self, canvas: &mut Canvas, view: &View) {
        let [low, high] = view.ranges;
        let at = |axis: usize, part: f64| {
            // Along the front edges of the floor, and along the left edge behind for the third.
            let mut place = match axis {
                0 => [low[0], high[1], low[2]],
                1 => [high[0], low[1], low[2]],
                _ => [low[0], high[1], low[2]],
            };
            place[axis] = low[axis] + part * (high[axis] - low[axis]);
            view.place(place)
        };
        for axis in 0..3 {
            let [dx, dy, part] = match axis {
                0 => [-4.0, 6.0, 1.0],
                1 => [4.0, 6.0, 0.0],
                _ => [-8.0, -6.0, 1.0],
            };
            for (end, value) in [(0.0, low[axis]), (1.0, high[axis])] {
                let [x, y] = at(axis, end);
                // Both ends of the floor's axes keep off the corner that they share.
                let lift = if axis < 2 && end == 0.0 { -2.0 } else { 0.0 };
                write(canvas, &format!("{value:.0}"), [x + dx, y + dy + lift], part);
            }
            if axis == 2 {
                // Above its upper end.
                let [x, y] = at(axis, 1.0);
                write(canvas, &self.axes[axis], [x - 24.0, y - 24.0], 0.0);
            } else {
                let [x, y] = at(axis, 0.5);
                write(canvas, &self.axes[axis], [x + 2.0 * dx, y + dy + 10.0], part);
            }
        }
        write(canvas, &self.title, [10.0, 8.0], 0.0);
    }
}

/// How places become pixels: an isometric view of a cube.
struct View {
    /// The least and the greatest of each axis.
    ranges: [[f64; 3]; 2],
    /// Pixels of an edge.
    edge: f64,
    middle: [f64; 2],
}

impl View {
    fn unit(&self, place: [f64; 3]) -> [f64; 3] {
        let [low, high] = self.ranges;
        [0, 1, 2].map(|axis| (place[axis] - low[axis]) / (high[axis] - low[axis]) - 0.5)
    }

    fn place(&self, place: [f64; 3]) -> [f64; 2] {
        let [a, b, c] = self.unit(place);
        let (cos, sin) = (30f64.to_radians().cos(), 0.5);
        [
            self.middle[0] + self.edge * cos * (a - b),
            self.middle[1] + self.edge * (sin * (a + b) - c),
        ]
    }

    /// Nearer to the viewer is greater.
    fn depth(&self, place: [f64; 3]) -> f64 {
        self.unit(place).iter().sum()
    }
}

fn shade(value: f64, [low, high]: [f64; 2]) -> Colour {
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    let between = |from: Colour, to: Colour, t: f64| -> Colour {
        [0, 1, 2].map(|i| (f64::from(from[i]) * (1.0 - t) + f64::from(to[i]) * t).round() as u8)
    };
    match part < 0.5 {
        true => between(palette::AXIS_Z, palette::LIMIT_LOW, 2.0 * part),
        false => between(palette::LIMIT_LOW, palette::AXIS_X, 2.0 * part - 1.0),
    }
}

fn scale(canvas: &mut Canvas, width: usize, height: usize, range: [f64; 2], unit: &str) {
    let left = width as f64 - RIGHT + 16.0;
    let [top, bottom] = [TOP + 24.0, height as f64 - 40.0];
    for y in top as i64..bottom as i64 {
        let part = 1.0 - (y as f64 - top) / (bottom - top);
        let colour = shade(range[0] + part * (range[1] - range[0]), range);
        for x in 0..12 {
            canvas.mix(left as i64 + x, y, colour, 1.0);
        }
    }
    for part in [0.0, 0.5, 1.0] {
        let value = range[0] + part * (range[1] - range[0]);
        let y = bottom + part * (top - bottom);
        write(canvas, &format!("{value:.1} {unit}"), [left + 16.0, y - 6.0], 0.0);
    }
}

/// Text whose left end (0), middle (0.5) or right end (1) is at a place.
fn write(canvas: &mut Canvas, text: &str, [x, y]: [f64; 2], part: f64) {
    let wide = (text.chars().count() * SIZE.character().0) as f64;
    let at = ((x - part * wide).round() as i32, y.round() as i32);
    canvas.write(text, at, SIZE, palette::TEXT, palette::PAGE);
}

fn disc(canvas: &mut Canvas, [x, y]: [f64; 2], colour: Colour) {
    for py in (y - RADIUS - 1.0).floor() as i64..=(y + RADIUS + 1.0).ceil() as i64 {
        for px in (x - RADIUS - 1.0).floor() as i64..=(x + RADIUS + 1.0).ceil() as i64 {
            let off = (px as f64 + 0.5 - x).hypot(py as f64 + 0.5 - y);
            let part = (RADIUS + 0.5 - off).clamp(0.0, 1.0);
            if part > 0.0 {
                canvas.mix(px, py, colour, part);
            }
        }
    }
}

fn line(canvas: &mut Canvas, [x, y]: [f64; 2], [u, v]: [f64; 2], colour: Colour) {
    let length = (u - x).hypot(v - y);
    let steps = (length * 2.0).clamp(1.0, 1e5) as usize;
    for step in 0..=steps {
        let part = step as f64 / steps as f64;
        let [px, py] = [x + part * (u - x), y + part * (v - y)];
        canvas.mix(px.floor() as i64, py.floor() as i64, colour, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: Vec<([f64; 3], f64)>) -> Cloud {
        Cloud {
            title: String::new(),
            axes: std::array::from_fn(|_| String::new()),
            unit: "mm".into(),
            points,
        }
    }

    /// The least is blue, the greatest red, and a point in front hides one behind.
    #[test]
    fn colours_tell_values_and_depth_tells_order() {
        let front = [1.0, 1.0, 1.0];
        let behind = [0.0, 0.0, 0.0];
        let drawn = cloud(vec![(front, 1.0), (behind, 3.0), ([0.0, 1.0, 0.0], 2.0)]);
        let picture = drawn.picture(400, 300);
        let at = |place| {
            let [x, y] = drawn.place(place, 400, 300);
            picture.at(x as usize, y as usize)
        };
        // Seen along the diagonal both are in the middle.
        assert_eq!(at(front), Some(palette::AXIS_Z));
        assert_eq!(at([0.0, 1.0, 0.0]), Some(palette::LIMIT_LOW));
    }

    /// Nothing to see, or one point: still a picture.
    #[test]
    fn empty_clouds_are_drawn() {
        for points in [vec![], vec![([1.0, 2.0, 3.0], 4.0)], vec![([f64::NAN; 3], f64::NAN)]] {
            assert!(!cloud(points).picture(300, 200).png().is_empty());
        }
    }
}
