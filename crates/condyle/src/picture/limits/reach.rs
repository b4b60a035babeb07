//! Directions in which a bone may point, as a part of a sphere about its joint. Its shade tells how far the bone may twist
//! there: yellow the least, green-blue the most; and so do lines with the twist in degrees: colour alone tells not everyone.

use super::super::marks::{label, line};
use super::OPACITY;
use condyle_math::Vec3;
use condyle_mesh::Patch;
use condyle_render::{Line, Scene, Surface, palette};

const SHADES: usize = 16;
/// Lines of equal twist are these degrees apart: the smallest with which there are at most [`MOST_LINES`].
const STEPS: [f64; 4] = [15.0, 30.0, 60.0, 90.0];
const MOST_LINES: usize = 7;

/// A direction, and its twist in shades.
type Corner = (Vec3, f64);

/// The part of a polygon on one side of a level.
fn above(polygon: &[Corner], level: f64, side: f64) -> Vec<Corner> {
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (i, &(place, here)) in polygon.iter().enumerate() {
        let (next, there) = polygon[(i + 1) % polygon.len()];
        let (from, to) = (side * (here - level), side * (there - level));
        if from >= 0.0 {
            part.push((place, here));
        }
        if (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0) {
            let share = from / (from - to);
            part.push((place * (1.0 - share) + next * share, level));
        }
    }
    part
}

/// The directions that are reached, and how far the bone may twist there.
#[derive(Debug)]
pub(super) struct Reach {
    pub(super) patch: Patch,
    /// How much of the turn about the bone is allowed at each corner, in radians.
    pub(super) widths: Vec<f64>,
}

impl Reach {
    /// Draws it about a joint: the part of the sphere, its boundary, and if asked for lines of equal twist with the degrees.
    pub(super) fn draw(&self, place: &dyn Fn(Vec3) -> Vec3, lined: bool, scene: &mut Scene) {
        scene.surfaces.extend(self.shades(place));
        for edge in self.edges() {
            scene.lines.push(line(edge.iter().map(|v| place(*v)).collect(), 2.0, palette::LIMIT));
        }
        let lines = if lined { self.lines() } else { vec![] };
        let mut named = None;
        for (degrees, path) in lines {
            let points: Vec<Vec3> = path.iter().map(|v| place(*v * 1.002)).collect();
            // The longest line of each twist is named, which comes first.
            if named.replace(degrees) != Some(degrees) {
                label(points[points.len() / 2], &format!("{degrees:.0}°"), palette::TEXT, scene);
            }
            let thin = line(points, 1.0, palette::TEXT);
            scene.lines.push(Line { opacity: 0.55, through: 0.15, ..thin });
        }
    }

    /// The least and the most twist.
    pub(super) fn ends(&self) -> [f64; 2] {
        let known = || self.widths.iter().copied();
        [known().fold(f64::INFINITY, f64::min), known().fold(0.0, f64::max)]
    }

    /// The part of the sphere, a surface for each shade: triangles are cut where the shade changes, so that the shade of a
    /// place is that of its twist, linear between corners.
    pub(super) fn shades(&self, place: &dyn Fn(Vec3) -> Vec3) -> Vec<Surface> {
        let [low, high] = self.ends();
        let mut shades: Vec<Surface> = (0..SHADES)
            .map(|shade| Surface::empty(Self::colour((shade as f64 + 0.5) / SHADES as f64)))
            .map(|surface| surface.with_opacity(1.5 * OPACITY))
            .collect();
        let centre = place(Vec3::ZERO);
        for triangle in &self.patch.triangles {
            let corners = triangle.map(|i| i as usize);
            let level = |i: usize| match high > low + 1e-9 {
                true => (self.widths[i] - low) / (high - low) * SHADES as f64,
                false => SHADES as f64,
            };
            let polygon: Vec<Corner> =
                corners.iter().map(|&i| (self.patch.corners[i], level(i))).collect();
            let shade = |level: f64| (level.max(0.0) as usize).min(SHADES - 1);
            let levels = || polygon.iter().map(|corner| corner.1);
            let first = shade(levels().fold(f64::INFINITY, f64::min) + 1e-9);
            let last = shade(levels().fold(0.0, f64::max) - 1e-9);
            for shade in first..=last.max(first) {
                let mut part = polygon.clone();
                if shade > first {
                    part = above(&part, shade as f64, 1.0);
                }
                if shade < last {
                    part = above(&part, shade as f64 + 1.0, -1.0);
                }
                let surface = &mut shades[shade];
                let corners: Vec<u32> = part
                    .iter()
                    .map(|(direction, _)| {
                        let place = place(direction.normalized());
                        surface.corner(place, place - centre)
                    })
                    .collect();
                if let Some((first, rest)) = corners.split_first() {
                    let fan = rest.windows(2).map(|ends| [*first, ends[0], ends[1]]);
                    surface.triangles.extend(fan);
                }
            }
        }
        shades.retain(|surface| !surface.triangles.is_empty());
        shades
    }

    /// The colour of a share of the way from the least to the most twist.
    pub(super) fn colour(share: f64) -> palette::Colour {
        [0, 1, 2].map(|i| {
            let [from, to] = [palette::LIMIT_LOW[i], palette::LIMIT[i]].map(f64::from);
            (from + (to - from) * share).round() as u8
        })
    }

    /// The boundary as closed lines.
    pub(super) fn edges(&self) -> Vec<Vec<Vec3>> {
        let loops = self.patch.loops().into_iter();
        loops
            .map(|line| {
                let around = line.iter().chain(line.first());
                around.map(|i| self.patch.corners[*i as usize]).collect()
            })
            .collect()
    }

    /// Lines of equal twist, with it in degrees.
    pub(super) fn lines(&self) -> Vec<(f64, Vec<Vec3>)> {
        let [low, high] = self.ends().map(f64::to_degrees);
        let levels = |step: f64| {
            (1..).map(move |n| step * f64::from(n)).skip_while(move |d| *d <= low).take_while(
                // A line on the greatest twist itself is noise.
                move |d| *d < high - 1.0,
            )
        };
        let step = STEPS.into_iter().find(|step| levels(*step).count() <= MOST_LINES);
        let mut lines = vec![];
        for degrees in levels(step.unwrap_or(120.0)) {
            let length = |line: &Vec<Vec3>| -> f64 {
                line.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
            };
            let mut level = self.patch.contour(&self.widths, degrees.to_radians());
            // Specks are left out.
            level.retain(|line| length(line) > 0.2);
            level.sort_by(|a, b| length(b).total_cmp(&length(a)));
            lines.extend(level.into_iter().map(|line| (degrees, line)));
        }
        lines
    }
}
