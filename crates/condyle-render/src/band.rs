//! Rows of samples with their depths: what is drawn into them, and the pixels that they make.

use crate::ground;
use crate::light::{Linear, Screen, linear, lit};
use crate::palette;
use crate::palette::Colour;
use condyle_math::Vec3;
use std::ops::Range;

/// Samples along each side of a pixel.
pub(crate) const SAMPLES: usize = 3;

/// Distances in samples at which something nearer darkens, each with how much of the light it takes in one of
/// eight directions.
const CREASES: [(isize, f32); 3] = [(3, 0.035), (7, 0.02), (13, 0.012)];

/// Pixels beyond a band that darken it.
pub(crate) const BEYOND: usize = 5;

/// How much nearer than its distance across the view something has to be.
const STEEP: f32 = 2.0;

const AROUND: [(isize, isize); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// A corner as it is seen: samples to the right and down from the upper left corner of the picture, metres
/// towards the viewer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) near: f64,
}

/// How a triangle is coloured.
#[derive(Clone, Copy)]
pub(crate) enum Paint {
    /// Lit by normals at its corners, as seen.
    Lit([Vec3; 3], Linear, f32),
    /// One colour, with its opacity where nothing is in front, and where something is.
    Flat(Linear, f32, f32),
}

/// Some rows of a picture.
pub(crate) struct Band {
    width: usize,
    /// The first row of samples, and how many there are.
    first: usize,
    rows: usize,
    light: Vec<Linear>,
    near: Vec<f32>,
}

impl Band {
    /// Rows of pixels from `first` on.
    pub(crate) fn new(width: usize, first: usize, rows: usize) -> Self {
        let (width, first, rows) = (width * SAMPLES, first * SAMPLES, rows * SAMPLES);
        let background = linear(palette::BACKGROUND);
        Self {
            width,
            first,
            rows,
            light: vec![background; width * rows],
            near: vec![f32::NEG_INFINITY; width * rows],
        }
    }

    /// Draws a triangle. What is opaque and lit sets the depth; everything else is mixed in where nothing
    /// is in front of it.
    pub(crate) fn triangle(&mut self, corners: [Corner; 3], paint: &Paint) {
        let [a, mut b, mut c] = corners;
        let mut paint = *paint;
        let mut area = edge(a, b, c.x, c.y);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        if area < 0.0 {
            (b, c, area) = (c, b, -area);
            if let Paint::Lit([_, second, third], _, _) = &mut paint {
                std::mem::swap(second, third);
            }
        }
        // Samples are at the middles of their squares.
        let low = |p: f64, q: f64, r: f64| (p.min(q).min(r) - 0.5).ceil().max(0.0);
        let high = |p: f64, q: f64, r: f64, end: usize| {
            (p.max(q).max(r) - 0.5).floor().min(end as f64 - 1.0)
        };
        let (left, right) = (low(a.x, b.x, c.x), high(a.x, b.x, c.x, self.width));
        let top = low(a.y, b.y, c.y).max(self.first as f64);
        let bottom = high(a.y, b.y, c.y, self.first + self.rows);
        if left > right || top > bottom {
            return;
        }
        let sides = [(b, c), (c, a), (a, b)];
        // A sample on a side that two triangles share belongs to one of them.
        let least = sides.map(|(from, to)| {
            let owned = from.y > to.y || (from.y == to.y && from.x < to.x);
            if owned { 0.0 } else { f64::MIN_POSITIVE }
        });
        let share = area.recip();
        for y in top as usize..=bottom as usize {
            let row = (y - self.first) * self.width;
            for x in left as usize..=right as usize {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let [u, v, w] = sides.map(|(from, to)| edge(from, to, px, py));
                if u < least[0] || v < least[1] || w < least[2] {
                    continue;
                }
                let [u, v, w] = [u * share, v * share, w * share];
                let near = (a.near * u + b.near * v + c.near * w) as f32;
                self.sample(row + x, near, &paint, [u, v, w]);
            }
        }
    }

    fn sample(&mut self, at: usize, near: f32, paint: &Paint, [u, v, w]: [f64; 3]) {
        let seen = near > self.near[at];
        match *paint {
            Paint::Lit(_, _, _) if !seen => {}
            Paint::Lit([a, b, c], colour, opacity) => {
                let normal = a * u + b * v + c * w;
                let light = lit(colour, normal);
                if opacity >= 1.0 {
                    self.light[at] = light;
                    self.near[at] = near;
                } else {
                    // Glass is denser where it is seen along its surface.
                    let facing = (normal.z / normal.norm().max(1e-300)).clamp(0.0, 1.0) as f32;
                    let grazing = (1.0 - facing).powi(2);
                    self.mix(at, light, opacity + (1.0 - opacity) * 0.5 * grazing);
                }
            }
            Paint::Flat(colour, opacity, through) => {
                self.mix(at, colour, if seen { opacity } else { through });
            }
        }
    }

    fn mix(&mut self, at: usize, light: Linear, share: f32) {
        for (old, new) in self.light[at].iter_mut().zip(light) {
            *old += (new - *old) * share;
        }
    }

    /// Darkens what is just behind the outline of something nearer, which tells bones that cross apart.
    /// `step` is the size of a sample in metres.
    pub(crate) fn crease(&mut self, step: f64) {
        for y in 0..self.rows {
            for x in 0..self.width {
                let at = y * self.width + x;
                let near = self.near[at];
                if near == f32::NEG_INFINITY {
                    continue;
                }
                let mut dark = 0.0;
                for (distance, share) in CREASES {
                    let least = STEEP * distance as f32 * step as f32;
                    for (dx, dy) in AROUND {
                        let (i, j) = (x as isize + dx * distance, y as isize + dy * distance);
                        let inside = (0..self.width as isize).contains(&i)
                            && (0..self.rows as isize).contains(&j);
                        if inside {
                            let other = self.near[j as usize * self.width + i as usize];
                            dark +=
                                share * ((other - near - least) / (3.0 * least)).clamp(0.0, 1.0);
                        }
                    }
                }
                let left = 1.0 - dark;
                self.light[at] = self.light[at].map(|c| c * left);
            }
        }
    }

    /// Draws the ground behind and over what is there. `metres` gives the place of a sample: at the upper
    /// left corner, and for each sample.
    pub(crate) fn ground(&mut self, ground: &ground::Seen, ([u0, v0], step): ([f64; 2], f64)) {
        for y in (0..self.rows).step_by(SAMPLES) {
            for x in (0..self.width).step_by(SAMPLES) {
                let middle = 0.5 * SAMPLES as f64;
                let u = u0 + (x as f64 + middle) * step;
                let v = v0 - ((y + self.first) as f64 + middle) * step;
                let Some((colour, share, [near, by_u, by_v])) = ground.at(u, v) else { continue };
                for j in 0..SAMPLES {
                    for i in 0..SAMPLES {
                        let at = (y + j) * self.width + x + i;
                        let (du, dv) = (i as f64 + 0.5 - middle, j as f64 + 0.5 - middle);
                        let near = (near + (du * by_u - dv * by_v) * step) as f32;
                        // What is behind everything has no depth.
                        if near > self.near[at] || self.near[at] == f32::NEG_INFINITY {
                            self.mix(at, colour, share);
                        }
                    }
                }
            }
        }
    }

    /// The pixels of some rows, each the mean of its samples.
    pub(crate) fn pixels(&self, screen: &Screen, rows: Range<usize>) -> Vec<Colour> {
        let width = self.width / SAMPLES;
        let mut pixels = Vec::with_capacity(width * rows.len());
        for y in rows {
            for x in 0..width {
                let mut sum = [0.0f32; 3];
                for j in 0..SAMPLES {
                    let from = (y * SAMPLES + j) * self.width + x * SAMPLES;
                    for light in &self.light[from..from + SAMPLES] {
                        for (sum, part) in sum.iter_mut().zip(light) {
                            *sum += part.clamp(0.0, 1.0);
                        }
                    }
                }
                pixels.push(screen.colour(sum.map(|s| s / (SAMPLES * SAMPLES) as f32)));
            }
        }
        pixels
    }
}

/// Twice the area of a side and a point, positive to the right of it as rows go down.
fn edge(from: Corner, to: Corner, x: f64, y: f64) -> f64 {
    (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
}
