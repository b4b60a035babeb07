//! From a scene to a picture, band by band.

use crate::band::{BEYOND, Band, Corner, Paint, SAMPLES};
use crate::camera::Camera;
use crate::canvas::Canvas;
use crate::ground;
use crate::label;
use crate::light::{Screen, linear};
use crate::palette::Colour;
use crate::scene::{Line, Scene, Surface};
use condyle_math::Vec3;

/// Rows of pixels that are drawn together.
const BAND: usize = 32;

/// How much nearer lines are than surfaces in the same place, as a share of the height that is shown.
const BEFORE: f64 = 0.002;

/// Draws a scene.
pub fn render(scene: &Scene, camera: &Camera, width: usize, height: usize) -> Canvas {
    let picture = Picture::new(scene, camera, width, height);
    let bands: Vec<Vec<Colour>> = (0..picture.bands()).map(|band| picture.band(band)).collect();
    picture.finish(&bands)
}

/// A scene made ready to be drawn in bands of rows, in any order and on any number of threads: the picture
/// is the same.
pub struct Picture<'a> {
    scene: &'a Scene,
    camera: Camera,
    width: usize,
    height: usize,
    opaque: Layer,
    lines: Layer,
    glass: Layer,
    ground: Option<ground::Seen>,
    screen: Screen,
}

/// Triangles in the order in which they are drawn.
#[derive(Default)]
struct Layer {
    triangles: Vec<Triangle>,
    /// Of each band, those that reach into it or into what darkens it.
    bands: Vec<Vec<u32>>,
}

impl Layer {
    /// Notes which bands the triangles reach into.
    fn sort(&mut self, bands: usize) {
        self.bands = vec![vec![]; bands];
        let (high, beyond) = ((BAND * SAMPLES) as f64, (BEYOND * SAMPLES) as f64);
        for (number, triangle) in (0u32..).zip(&self.triangles) {
            let [top, bottom] = triangle.rows;
            let (top, bottom) = ((top - beyond) / high, (bottom + beyond) / high);
            if bottom < 0.0 || top >= bands as f64 {
                continue;
            }
            // A row on the border of two bands belongs to either: both look.
            let first = (top.ceil() - 1.0).max(0.0) as usize;
            let last = (bottom as usize).min(bands - 1);
            self.bands[first..=last].iter_mut().for_each(|band| band.push(number));
        }
    }

    /// Draws what reaches into a band.
    fn draw(&self, band: usize, samples: &mut Band) {
        for &number in self.bands.get(band).into_iter().flatten() {
            let triangle = &self.triangles[number as usize];
            samples.triangle(triangle.corners, &triangle.paint);
        }
    }
}

struct Triangle {
    corners: [Corner; 3],
    paint: Paint,
    /// The least and greatest row.
    rows: [f64; 2],
}

impl Triangle {
    fn new(corners: [Corner; 3], paint: Paint) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner.y);
        let rows = [a.min(b).min(c), a.max(b).max(c)];
        let good = corners.iter().all(|c| c.x.abs() < FAR && c.y.abs() < FAR && c.near.is_finite());
        good.then_some(Self { corners, paint, rows })
    }

    fn nearest(&self) -> f64 {
        self.corners.iter().map(|corner| corner.near).sum()
    }
}

/// Samples from the picture beyond which nothing is drawn.
const FAR: f64 = 1e9;

impl<'a> Picture<'a> {
    /// Prepares a picture of so many pixels.
    pub fn new(scene: &'a Scene, camera: &Camera, width: usize, height: usize) -> Self {
        let mut picture = Self {
            scene,
            camera: *camera,
            width,
            height,
            opaque: Layer::default(),
            lines: Layer::default(),
            glass: Layer::default(),
            ground: None,
            screen: Screen::new(),
        };
        if !(camera.height > 0.0 && camera.height.is_finite()) || width == 0 || height == 0 {
            return picture;
        }
        let pixel = camera.height / height as f64;
        picture.ground = scene.ground.as_ref().and_then(|g| ground::Seen::new(g, camera, pixel));
        scene.surfaces.iter().for_each(|surface| picture.surface(surface));
        scene.lines.iter().for_each(|line| picture.line(line));
        picture.glass.triangles.sort_by(|a, b| a.nearest().total_cmp(&b.nearest()));
        let bands = picture.bands();
        for layer in [&mut picture.opaque, &mut picture.lines, &mut picture.glass] {
            layer.sort(bands);
        }
        picture
    }

    /// Metres of a sample.
    fn step(&self) -> f64 {
        self.camera.height / (self.height * SAMPLES) as f64
    }

    /// Metres to the right and up of the upper left corner.
    fn corner(&self) -> [f64; 2] {
        let half = 0.5 * self.camera.height;
        [-half * self.width as f64 / self.height as f64, half]
    }

    fn project(&self, point: [f64; 3]) -> Corner {
        let [u, v, near] = self.camera.seen(point);
        let [left, top] = self.corner();
        // On a lattice, so that sides which two triangles share are the same to the last bit.
        let snap = |x: f64| (x * 256.0).round() / 256.0;
        Corner { x: snap((u - left) / self.step()), y: snap((top - v) / self.step()), near }
    }

    fn surface(&mut self, surface: &Surface) {
        let opacity = surface.opacity.clamp(0.0, 1.0) as f32;
        if opacity.is_nan() || opacity == 0.0 {
            return;
        }
        let colour = linear(surface.colour);
        let corners: Vec<Corner> = surface.positions.iter().map(|&p| self.project(p)).collect();
        let axes = [self.camera.right, self.camera.up, self.camera.toward].map(Vec3::from);
        let normals: Vec<Vec3> = surface
            .normals
            .iter()
            .map(|&n| {
                let [x, y, z] = axes.map(|axis| axis.dot(n.into()));
                let seen = Vec3::new(x, y, z);
                let norm = seen.norm();
                if norm > 1e-300 { seen * norm.recip() } else { Vec3::Z }
            })
            .collect();
        for triangle in &surface.triangles {
            let at = triangle.map(|i| i as usize);
            let [Some(a), Some(b), Some(c)] = at.map(|i| corners.get(i)) else { continue };
            let [Some(na), Some(nb), Some(nc)] = at.map(|i| normals.get(i)) else { continue };
            // Rows go down: counter-clockwise as seen is a negative area here.
            let faces = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 0.0;
            let turn = if faces { 1.0 } else { -1.0 };
            let paint = Paint::Lit([*na * turn, *nb * turn, *nc * turn], colour, opacity);
            let layer = if opacity >= 1.0 { &mut self.opaque } else { &mut self.glass };
            layer.triangles.extend(Triangle::new([*a, *b, *c], paint));
        }
    }

    fn line(&mut self, line: &Line) {
        let (opacity, through) = (line.opacity.clamp(0.0, 1.0), line.through.clamp(0.0, 1.0));
        let paint = Paint::Flat(linear(line.colour), opacity as f32, through as f32);
        let half = 0.5 * line.width * SAMPLES as f64;
        let before = BEFORE * self.camera.height;
        let seen: Vec<Corner> = line.points.iter().map(|&p| self.project(p)).collect();
        // Across the line at each point: the mean of the pieces that meet there, so that they do not overlap.
        let direction = |i: usize| -> Option<[f64; 2]> {
            let (a, b) = (seen.get(i)?, seen.get(i + 1)?);
            let (x, y) = (b.x - a.x, b.y - a.y);
            let length = x.hypot(y);
            (length > 0.0 && length.is_finite()).then(|| [x / length, y / length])
        };
        let across = |i: usize| -> [f64; 2] {
            let one = i.checked_sub(1).and_then(direction);
            let other = direction(i);
            let (a, b) = (one.or(other).unwrap_or([1.0, 0.0]), other.or(one).unwrap_or([1.0, 0.0]));
            let (x, y) = (a[0] + b[0], a[1] + b[1]);
            let length = x.hypot(y);
            // The mean of two directions that turn by θ is short by cos θ/2; a sharp turn is cut.
            let stretch = (2.0 / length.max(0.7)).min(2.0);
            match length > 1e-9 {
                true => [-y / length * half * stretch, x / length * half * stretch],
                false => [-a[1] * half, a[0] * half],
            }
        };
        for i in 0..seen.len().saturating_sub(1) {
            let (a, b) = (seen[i], seen[i + 1]);
            let (p, q) = (across(i), across(i + 1));
            let moved = |c: Corner, [x, y]: [f64; 2], sign: f64| Corner {
                x: c.x + sign * x,
                y: c.y + sign * y,
                near: c.near + before,
            };
            let corners =
                [moved(a, p, 1.0), moved(a, p, -1.0), moved(b, q, -1.0), moved(b, q, 1.0)];
            self.lines.triangles.extend(Triangle::new([corners[0], corners[1], corners[2]], paint));
            self.lines.triangles.extend(Triangle::new([corners[0], corners[2], corners[3]], paint));
        }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.height.div_ceil(BAND)
    }

    /// The pixels of a band, rows from the top.
    pub fn band(&self, band: usize) -> Vec<Colour> {
        let first = band * BAND;
        let wanted = BAND.min(self.height.saturating_sub(first));
        // Pixels are darkened by what is beside them, also beyond the band.
        let from = first.saturating_sub(BEYOND);
        let rows = (first + wanted + BEYOND).min(self.height).saturating_sub(from);
        let mut samples = Band::new(self.width, from, rows);
        self.opaque.draw(band, &mut samples);
        samples.crease(self.step());
        if let Some(ground) = &self.ground {
            samples.ground(ground, (self.corner(), self.step()));
        }
        self.lines.draw(band, &mut samples);
        self.glass.draw(band, &mut samples);
        samples.pixels(&self.screen, first - from..first - from + wanted)
    }

    /// The picture of all bands in their order, with its labels.
    pub fn finish(&self, bands: &[Vec<Colour>]) -> Canvas {
        let mut canvas = Canvas::of_pixels(self.width, self.height, bands.concat());
        let scale = SAMPLES as f64;
        let labels = self.scene.labels.iter().map(|label| {
            let Corner { x, y, near } = self.project(label.at);
            (label, [x / scale, y / scale, near])
        });
        label::draw(&mut canvas, labels);
        canvas
    }
}
