//! Charts: curves, dots and bars over two axes with numbers, as a picture.
//!
//! Series are told apart by marks and dashes as well as by colours. Everything is drawn with smooth edges on a [`Canvas`].

use crate::canvas::{Canvas, TextSize};
use crate::palette::{self, Colour};
use std::collections::HashMap;

/// What is at the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Nothing.
    None,
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A triangle that points up.
    Triangle,
    /// Two strokes that cross.
    Cross,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawn {
    /// A line through the points, with marks at them; every second so many pixels left out, 0 for none.
    Line(Mark, f64),
    /// Bars from 0 to each value, from one point's x to the next; the last point only ends the bar before.
    Bars,
    /// The outline of such bars.
    Steps,
}

/// Numbers that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What they are, beside the chart.
    pub name: String,
    /// Their colour.
    pub colour: Colour,
    /// How they are drawn.
    pub drawn: Drawn,
    /// x and y; what is not finite interrupts a line.
    pub points: Vec<[f64; 2]>,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it shows, above it.
    pub title: String,
    /// What x and y are, with their units.
    pub axes: [String; 2],
    /// Their ranges; what is outside is cut off.
    pub ranges: [[f64; 2]; 2],
    /// Drawn in this order.
    pub series: Vec<Series>,
    /// Upright lines at values of x, with what they are.
    pub lines: Vec<(f64, String)>,
}

/// Pixels around the plot: left, top, right without the names of series, bottom.
const MARGIN: [f64; 4] = [64.0, 58.0, 16.0, 52.0];
/// Pixels of the names of series for each character, and beside them.
const NAMES: f64 = 7.0;
const BESIDE: f64 = 44.0;
const SIZE: TextSize = TextSize::Medium;

impl Chart {
    /// The chart as a picture of so many pixels.
    ///
    /// ```
    /// use condyle_render::{Chart, Drawn, Mark, Series, palette};
    /// let chart = Chart {
    ///     title: "a parabola".into(),
    ///     axes: ["x".into(), "x squared".into()],
    ///     ranges: [[0.0, 2.0], [0.0, 4.0]],
    ///     series: vec![Series {
    ///         name: "y".into(),
    ///         colour: palette::AXIS_X,
    ///         drawn: Drawn::Line(Mark::Disc, 0.0),
    ///         points: (0..=4).map(|i| 0.5 * f64::from(i)).map(|x| [x, x * x]).collect(),
    ///     }],
    ///     lines: vec![],
    /// };
    /// let picture = chart.picture(400, 300);
    /// // A disc is at (1, 1): half of the way along x, a quarter of that along y.
    /// let [x, y] = chart.place([1.0, 1.0], 400, 300);
    /// assert_eq!(picture.at(x as usize, y as usize), Some(palette::AXIS_X));
    /// ```
    #[must_use]
    pub fn picture(&self, width: usize, height: usize) -> Canvas {
        let mut canvas = Canvas::new(width, height, palette::PAGE);
        let plot = self.plot(width, height);
        self.scales(&mut canvas, &plot);
        for (value, name) in &self.lines {
            let [x, top] = plot.place([*value, self.ranges[1][1]]);
            let bottom = plot.place([*value, self.ranges[1][0]])[1];
            stroke(&mut canvas, &[[x, top], [x, bottom]], 1.5, palette::TEXT, 5.0, &plot);
            write(&mut canvas, name, [x + 5.0, top + 3.0], 0.0);
        }
        for series in &self.series {
            series.draw(&mut canvas, &plot);
        }
        self.names(&mut canvas, &plot);
        canvas
    }

    /// Where a point is in such a picture, in pixels from the upper left corner.
    #[must_use]
    pub fn place(&self, point: [f64; 2], width: usize, height: usize) -> [f64; 2] {
        self.plot(width, height).place(point)
    }

    fn plot(&self, width: usize, height: usize) -> Plot {
        let [left, top, right, bottom] = MARGIN;
        let longest = self.series.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
        let names = if longest == 0 { 0.0 } else { NAMES * longest as f64 + BESIDE };
        let [width, height] = [width as f64, height as f64];
        Plot {
            corner: [left, top],
            size: [(width - left - right - names).max(10.0), (height - top - bottom).max(10.0)],
            ranges: self.ranges,
        }
    }

    fn scales(&self, canvas: &mut Canvas, plot: &Plot) {
        let ([left, top], [wide, high]) = (plot.corner, plot.size);
        for (axis, range) in self.ranges.iter().enumerate() {
            let step = step(range[1] - range[0], if axis == 0 { wide / 75.0 } else { high / 45.0 });
            let first = (range[0] / step - 1e-9).ceil() as i64;
            for n in first..first + 100 {
                let value = step * n as f64;
                if value > range[1] + 1e-9 * step {
                    break;
                }
                let text = number(value, step);
                if axis == 0 {
                    let x = plot.place([value, 0.0])[0];
                    line(canvas, [[x, top], [x, top + high]], 1.0, palette::GROUND);
                    write(canvas, &text, [x, top + high + 6.0], 0.5);
                } else {
                    let y = plot.place([0.0, value])[1];
                    line(canvas, [[left, y], [left + wide, y]], 1.0, palette::GROUND);
                    write(canvas, &text, [left - 7.0, y - 6.0], 1.0);
                }
            }
        }
        line(canvas, [[left, top], [left, top + high]], 1.5, palette::TEXT);
        line(canvas, [[left, top + high], [left + wide, top + high]], 1.5, palette::TEXT);
        write(canvas, &self.title, [left, 8.0], 0.0);
        write(canvas, &self.axes[1], [8.0, 32.0], 0.0);
        write(canvas, &self.axes[0], [left + 0.5 * wide, top + high + 28.0], 0.5);
    }

    fn names(&self, canvas: &mut Canvas, plot: &Plot) {
        let x = plot.corner[0] + plot.size[0] + 12.0;
        for (index, series) in self.series.iter().filter(|s| !s.name.is_empty()).enumerate() {
            let y = plot.corner[1] + 10.0 + 20.0 * index as f64;
            match series.drawn {
                Drawn::Bars => fill(canvas, [x, y - 5.0], [x + 24.0, y + 5.0], series.colour, 0.55),
                Drawn::Steps => line(canvas, [[x, y], [x + 24.0, y]], 2.0, series.colour),
                Drawn::Line(mark, dash) => {
                    let whole = Plot { corner: [0.0; 2], size: [1e9; 2], ..*plot };
                    stroke(canvas, &[[x, y], [x + 24.0, y]], 2.0, series.colour, dash, &whole);
                    mark.draw(canvas, [x + 12.0, y], series.colour);
                }
            }
            write(canvas, &series.name, [x + 30.0, y - 6.0], 0.0);
        }
    }
}

/// Where the plot is in the picture, and what it shows.
#[derive(Clone, Copy)]
struct Plot {
    corner: [f64; 2],
    size: [f64; 2],
    ranges: [[f64; 2]; 2],
}

impl Plot {
    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let share = |axis: usize| {
            let [low, high] = self.ranges[axis];
            (point[axis] - low) / (high - low)
        };
        [self.corner[0] + share(0) * self.size[0], self.corner[1] + (1.0 - share(1)) * self.size[1]]
    }

    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let inside = |at: f64, axis: usize| {
            at >= self.corner[axis] - 1.5 && at <= self.corner[axis] + self.size[axis] + 1.5
        };
        inside(x, 0) && inside(y, 1)
    }
}

impl Series {
    fn draw(&self, canvas: &mut Canvas, plot: &Plot) {
        let finite = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
        match self.drawn {
            Drawn::Line(mark, dash) => {
                for run in self.points.split(|p| !finite(p)) {
                    let places: Vec<[f64; 2]> = run.iter().map(|p| plot.place(*p)).collect();
                    stroke(canvas, &places, 2.0, self.colour, dash, plot);
                    for place in places.iter().filter(|place| plot.holds(**place)) {
                        mark.draw(canvas, *place, self.colour);
                    }
                }
            }
            Drawn::Bars | Drawn::Steps => {
                let floor = plot.place([0.0, plot.ranges[1][0].max(0.0)])[1];
                let mut outline = vec![];
                for ends in self.points.windows(2) {
                    let [[x, y], [next, _]] = [plot.place(ends[0]), plot.place(ends[1])];
                    let y = y.max(plot.corner[1]);
                    outline.extend([[x, y], [next, y]]);
                    if self.drawn == Drawn::Bars && y < floor {
                        fill(canvas, [x + 0.5, y], [next - 0.5, floor], self.colour, 0.55);
                    }
                }
                if self.drawn == Drawn::Steps {
                    stroke(canvas, &outline, 2.0, self.colour, 0.0, plot);
                }
            }
        }
    }
}

impl Mark {
    fn draw(self, canvas: &mut Canvas, [x, y]: [f64; 2], colour: Colour) {
        const R: f64 = 4.0;
        let covered = |dx: f64, dy: f64| match self {
            Self::None => 0.0,
            Self::Disc => R + 0.5 - dx.hypot(dy),
            Self::Square => R - 0.5 + 0.5 - dx.abs().max(dy.abs()),
            // Its sides rise by √3.
            Self::Triangle => {
                (R - 1.0 - dy).min(R - (dx.abs() * 3f64.sqrt() - dy) * 0.5 - 0.5) + 0.5
            }
            Self::Cross => {
                let stroke = (dx.abs() - dy.abs()).abs() / 2f64.sqrt();
                (1.0 - stroke).min(R - dx.abs().max(dy.abs())) + 0.5
            }
        };
        for py in (y - 6.0).floor() as i64..=(y + 6.0).ceil() as i64 {
            for px in (x - 6.0).floor() as i64..=(x + 6.0).ceil() as i64 {
                let part = covered(px as f64 + 0.5 - x, py as f64 + 0.5 - y).clamp(0.0, 1.0);
                if part > 0.0 {
                    canvas.mix(px, py, colour, part);
                }
            }
        }
    }
}

/// A distance between numbers of a scale of which at most so many are wanted: 1, 2 or 5 times a power of ten.
fn step(range: f64, most: f64) -> f64 {
    let least = range.abs().max(1e-12) / most.max(1.0);
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|n| n * power).into_iter().find(|s| *s >= least).unwrap_or(least)
}

/// A number with the digits that its scale needs.
fn number(value: f64, step: f64) -> String {
    let digits = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    let value = if value.abs() < 1e-9 * step { 0.0 } else { value };
    format!("{value:.digits$}")
}

/// Text whose left end (0), middle (0.5) or right end (1) is at a place.
fn write(canvas: &mut Canvas, text: &str, [x, y]: [f64; 2], part: f64) {
    let wide = (text.chars().count() * SIZE.character().0) as f64;
    let at = ((x - part * wide).round() as i32, y.round() as i32);
    canvas.write(text, at, SIZE, palette::TEXT, palette::PAGE);
}

fn fill(canvas: &mut Canvas, [x, y]: [f64; 2], [right, bottom]: [f64; 2], colour: Colour, by: f64) {
    for py in y.floor() as i64..bottom.ceil() as i64 {
        for px in x.floor() as i64..right.ceil() as i64 {
            let along =
                |at: i64, low: f64, high: f64| ((at + 1) as f64).min(high) - (at as f64).max(low);
            let part = along(px, x, right).clamp(0.0, 1.0) * along(py, y, bottom).clamp(0.0, 1.0);
            canvas.mix(px, py, colour, by * part);
        }
    }
}

fn line(canvas: &mut Canvas, ends: [[f64; 2]; 2], width: f64, colour: Colour) {
    let all = Plot { corner: [0.0; 2], size: [1e9; 2], ranges: [[0.0, 1.0]; 2] };
    stroke(canvas, &ends, width, colour, 0.0, &all);
}

/// A line through places, within the plot; with dashes and gaps of so many pixels.
fn stroke(
    canvas: &mut Canvas,
    places: &[[f64; 2]],
    width: f64,
    colour: Colour,
    dash: f64,
    plot: &Plot,
) {
    // Each pixel once, by the piece that covers it most.
    let mut covered: HashMap<(i64, i64), f64> = HashMap::new();
    let mut gone = 0.0;
    let reach = 0.5 * width + 1.0;
    for ends in places.windows(2) {
        let ([x, y], [u, v]) = (ends[0], ends[1]);
        let length = (u - x).hypot(v - y);
        if !(length.is_finite() && length < 1e5) {
            continue;
        }
        let [dx, dy] = if length > 0.0 { [(u - x) / length, (v - y) / length] } else { [1.0, 0.0] };
        for py in (y.min(v) - reach).floor() as i64..=(y.max(v) + reach).ceil() as i64 {
            for px in (x.min(u) - reach).floor() as i64..=(x.max(u) + reach).ceil() as i64 {
                let [ax, ay] = [px as f64 + 0.5 - x, py as f64 + 0.5 - y];
                let along = (ax * dx + ay * dy).clamp(0.0, length);
                let off = (ax - along * dx).hypot(ay - along * dy);
                let gap = dash > 0.0 && ((gone + along) / dash) as i64 % 2 == 1;
                let part = (0.5 * width + 0.5 - off).clamp(0.0, 1.0);
                if part > 0.0 && !gap && plot.holds([px as f64 + 0.5, py as f64 + 0.5]) {
                    let kept = covered.entry((px, py)).or_insert(0.0);
                    *kept = kept.max(part);
                }
            }
        }
        gone += length;
    }
    // The order of the pixels does not matter: each is mixed once.
    for ((x, y), part) in covered {
        canvas.mix(x, y, colour, part);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_round_numbers() {
        assert_eq!(step(1.0, 10.0), 0.1);
        assert_eq!(step(1.0, 6.0), 0.2);
        assert_eq!(step(45.0, 5.0), 10.0);
        assert_eq!(number(0.30000000000000004, 0.1), "0.3");
        assert_eq!(number(20.0, 10.0), "20");
        assert_eq!(number(0.05, 0.05), "0.05");
    }

    /// A bar is as high as its number, a dashed line has gaps, and nothing is drawn outside the plot.
    #[test]
    fn bars_and_lines_are_where_their_numbers_are() {
        let bars = vec![[0.0, 3.0], [1.0, 1.0], [2.0, 0.0]];
        let dashed = vec![[0.0, 2.0], [4.0, 2.0]];
        let series = |drawn, points, colour| Series { name: String::new(), colour, drawn, points };
        let chart = Chart {
            title: String::new(),
            axes: [String::new(), String::new()],
            ranges: [[0.0, 2.0], [0.0, 4.0]],
            series: vec![
                series(Drawn::Bars, bars, [0, 0, 0]),
                series(Drawn::Line(Mark::None, 8.0), dashed, [255, 0, 0]),
            ],
            lines: vec![],
        };
        let picture = chart.picture(320, 240);
        let dark = |x: f64, y: f64| {
            let [x, y] = chart.place([x, y], 320, 240);
            picture.at(x as usize, y as usize).is_some_and(|c| c[1] < 140)
        };
        assert!(dark(0.53, 2.8) && !dark(0.53, 3.2) && dark(1.53, 0.7) && !dark(1.53, 1.3));
        let [left, y] = chart.place([0.0, 2.0], 320, 240);
        let right = chart.place([2.0, 2.0], 320, 240)[0];
        let red = |x: usize| picture.at(x, y as usize) == Some([255, 0, 0]);
        let count = (left as usize..right as usize).filter(|x| red(*x)).count();
        let all = right - left;
        assert!((count as f64 / all - 0.5).abs() < 0.1, "{count} of {all}");
        assert!((right as usize + 4..320).all(|x| !red(x)), "cut off at the plot");
    }
}
