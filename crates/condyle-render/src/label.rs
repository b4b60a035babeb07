//! Labels: each beside its place, none over another.

use crate::canvas::{Canvas, TextSize};
use crate::palette;
use crate::scene::Label;

/// A rectangle of pixels.
#[derive(Clone, Copy)]
struct Box {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Box {
    fn overlaps(&self, other: &Self) -> bool {
        self.x < other.x + other.width
            && other.x < self.x + self.width
            && self.y < other.y + other.height
            && other.y < self.y + self.height
    }
}

/// How far labels may be from their places, in heights of a character.
const REACHES: [f64; 6] = [0.6, 1.5, 2.6, 4.0, 6.0, 9.0];

/// Directions in which labels are looked for: right first, then up and down, left last.
const DIRECTIONS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [0.8, -0.6],
    [0.8, 0.6],
    [-1.0, 0.0],
    [-0.8, -0.6],
    [-0.8, 0.6],
    [0.0, -1.0],
    [0.0, 1.0],
];

/// Draws labels at places in pixels, the nearest to the viewer first. One that fits nowhere is left out.
pub(crate) fn draw<'a>(canvas: &mut Canvas, labels: impl Iterator<Item = (&'a Label, [f64; 3])>) {
    let size = TextSize::for_picture(canvas.width(), canvas.height());
    let (character, high) = size.character();
    let (wide, tall) = (canvas.width() as f64, canvas.height() as f64);
    let inside = |[x, y, near]: &[f64; 3]| {
        (0.0..wide).contains(x) && (0.0..tall).contains(y) && near.is_finite()
    };
    let mut labels: Vec<_> = labels.filter(|(_, at)| inside(at)).collect();
    labels.sort_by(|a, b| b.1[2].total_cmp(&a.1[2]));
    // Places of other labels stay free.
    let dots: Vec<Box> = labels
        .iter()
        .map(|(_, [x, y, _])| Box { x: x - 2.0, y: y - 2.0, width: 4.0, height: 4.0 })
        .collect();
    let mut taken: Vec<Box> = vec![];
    for (index, (label, [x, y, _])) in labels.iter().enumerate() {
        let width = (label.text.chars().count() * character) as f64;
        let height = high as f64;
        let places = REACHES.iter().flat_map(|reach| {
            DIRECTIONS.iter().map(move |[dx, dy]| {
                let (x, y) = (x + dx * reach * height, y + dy * reach * height);
                let x = x - width * (0.5 - 0.5 * dx.signum() * f64::from(*dx != 0.0));
                Box { x, y: y - 0.5 * height, width, height }
            })
        });
        let free = |place: &Box| {
            let within = place.x >= 1.0
                && place.y >= 1.0
                && place.x + place.width < wide - 1.0
                && place.y + place.height < tall - 1.0;
            within
                && !taken.iter().any(|other| place.overlaps(other))
                && !dots.iter().enumerate().any(|(i, dot)| i != index && place.overlaps(dot))
        };
        let Some(place) = places.into_iter().find(free) else { continue };
        taken.push(place);
        let end = [x.clamp(place.x, place.x + width), y.clamp(place.y, place.y + height)];
        leader(canvas, [*x, *y], end);
        let at = (place.x.round() as i32, place.y.round() as i32);
        canvas.write(&label.text, at, size, label.colour, palette::BACKGROUND);
    }
}

/// A thin line from a place to its label, with a dot at the place.
fn leader(canvas: &mut Canvas, from: [f64; 2], to: [f64; 2]) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let steps = dx.abs().max(dy.abs()).ceil().max(1.0);
    for step in 0..=steps as usize {
        let share = step as f64 / steps;
        let at = [from[0] + dx * share, from[1] + dy * share];
        canvas.mix(at[0].floor() as i64, at[1].floor() as i64, palette::LEADER, 0.8);
    }
    for y in -1..=1 {
        for x in -1..=1 {
            let at = (from[0].floor() as i64 + x, from[1].floor() as i64 + y);
            canvas.mix(at.0, at.1, palette::LEADER, if x == 0 || y == 0 { 1.0 } else { 0.4 });
        }
    }
}
