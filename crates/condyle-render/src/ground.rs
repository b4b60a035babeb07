//! The ground: a level plane with a grid, seen from above or along it.

use crate::camera::Camera;
use crate::light::{Linear, linear};
use crate::palette;
use crate::scene::Ground;
use condyle_math::Vec3;

/// The ground as a camera sees it.
pub(crate) struct Seen {
    /// How much nearer to the viewer the plane is: at the middle of the picture, and for each metre to the
    /// right and up. Nothing where it is seen along its plane.
    near: Option<[f64; 3]>,
    /// Grid coordinates: at the middle of the picture, and for each metre to the right and up.
    grid: [[f64; 3]; 2],
    /// Metres between lines.
    spacing: f64,
    radius: f64,
    /// Metres of a pixel.
    pixel: f64,
    /// Where the plane is in a picture along it: to the right, up.
    edge: [f64; 2],
    opacity: f64,
    plain: Linear,
    line: Linear,
}

/// Less than this sine of the elevation is along the plane.
const ALONG: f64 = 0.012;

impl Seen {
    /// `None` from below.
    pub(crate) fn new(ground: &Ground, camera: &Camera, pixel: f64) -> Option<Self> {
        let [right, up, toward] = [camera.right, camera.up, camera.toward].map(Vec3::from);
        let normal = Vec3::from(ground.up);
        let slope = toward.dot(normal);
        let good = slope >= -ALONG
            && ground.radius > 0.0
            && [ground.up, ground.forward, ground.middle]
                .as_flattened()
                .iter()
                .all(|x| x.is_finite());
        if !good {
            return None;
        }
        let off = Vec3::from(ground.middle) - Vec3::from(camera.centre);
        let along = slope < ALONG;
        // c + u·right + v·up + t·toward is on the plane.
        let near = (!along).then(|| {
            [off.dot(normal) / slope, -right.dot(normal) / slope, -up.dot(normal) / slope]
        });
        let axes = [Vec3::from(ground.forward), Vec3::from(ground.forward).cross(normal)];
        let grid = axes.map(|axis| match near {
            None => [0.0; 3],
            Some([t, by_u, by_v]) => [
                toward.dot(axis) * t - off.dot(axis),
                right.dot(axis) + toward.dot(axis) * by_u,
                up.dot(axis) + toward.dot(axis) * by_v,
            ],
        });
        Some(Self {
            near,
            grid,
            spacing: spacing(ground.radius / 5.0),
            radius: ground.radius,
            pixel,
            edge: [off.dot(right), off.dot(up)],
            opacity: if along { 1.0 } else { ((slope - ALONG) / 0.08).clamp(0.35, 0.9) },
            plain: linear(palette::GROUND),
            line: linear(palette::GRID),
        })
    }

    /// Its colour and opacity in a pixel, and how near it is there with its slope for each metre to the
    /// right and up.
    pub(crate) fn at(&self, u: f64, v: f64) -> Option<(Linear, f32, [f64; 3])> {
        let Some([t, by_u, by_v]) = self.near else { return self.along(u, v) };
        let place = self.grid.map(|[at, by_u, by_v]| at + u * by_u + v * by_v);
        let distance = place[0].hypot(place[1]) / self.radius;
        if distance >= 1.0 {
            return None;
        }
        let fade = smooth(1.0 - distance);
        let mut line = 0.0f64;
        for (axis, at) in self.grid.iter().zip(place) {
            let footprint = self.pixel * (axis[1].abs() + axis[2].abs());
            let off = (at / self.spacing - (at / self.spacing).round()).abs() * self.spacing;
            // A line of 1.2 pixels, thinner than one where pixels are long.
            let cover = (1.1 - off / footprint.max(1e-12)).clamp(0.0, 1.0);
            let crowd = (self.spacing / footprint.max(1e-12) / 6.0).clamp(0.0, 1.0);
            line = line.max(cover * crowd);
        }
        let colour = mixed(self.plain, self.line, line as f32);
        Some((colour, (self.opacity * fade) as f32, [t + u * by_u + v * by_v, by_u, by_v]))
    }

    /// Seen along the plane: a line, and a shade under it.
    fn along(&self, u: f64, v: f64) -> Option<(Linear, f32, [f64; 3])> {
        let below = self.edge[1] - v;
        let aside = ((u - self.edge[0]) / self.radius).abs();
        if below < -0.5 * self.pixel || aside >= 1.0 {
            return None;
        }
        let fade = smooth(1.0 - aside);
        let line = (1.5 - (below / self.pixel).abs()).clamp(0.0, 1.0);
        let depth = smooth((1.0 - below / (0.12 * self.radius)).clamp(0.0, 1.0));
        let colour = mixed(self.plain, self.line, line as f32);
        let share = fade * line.max(0.8 * depth);
        Some((colour, share as f32, [f64::NEG_INFINITY, 0.0, 0.0]))
    }
}

fn mixed(a: Linear, b: Linear, share: f32) -> Linear {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * share)
}

fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// 1, 2 or 5 times a power of ten, at most so long.
fn spacing(most: f64) -> f64 {
    let power = 10f64.powf(most.max(1e-9).log10().floor());
    [5.0, 2.0].into_iter().map(|m| m * power).find(|s| *s <= most).unwrap_or(power)
}
