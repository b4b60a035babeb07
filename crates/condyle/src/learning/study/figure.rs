//! S3's Figure 3: how far the tracked centre is from that of the law, over the angles of crouches, a panel for each person.

use super::Studied;
use condyle_learn::study::Skin;
use condyle_render::{Canvas, Cloud, palette};

/// Pixels of a panel.
const PANEL: [usize; 2] = [470, 400];

/// Six panels of one kind of skin: axes are flexion, adduction and rotation in degrees, the colour is the deviation in mm, from the
/// least of that person (blue) to the greatest (red).
#[must_use]
pub fn figure(studied: &Studied, skin: Skin) -> Canvas {
    let runs: Vec<_> = studied.runs.iter().filter(|run| run.skin == skin).collect();
    let [wide, high] = PANEL;
    let columns = runs.len().clamp(1, 3);
    let rows = runs.len().div_ceil(columns).max(1);
    let mut canvas = Canvas::new(columns * wide, rows * high, palette::PAGE);
    for (index, run) in runs.iter().enumerate() {
        let Some(person) = studied.people.get(run.person) else { continue };
        let points = run
            .cloud
            .iter()
            // Flexion is positive in pictures, as people have it.
            .map(|([f, a, r], far)| ([-f.to_degrees(), a.to_degrees(), r.to_degrees()], 1e3 * far))
            .collect();
        let cloud = Cloud {
            title: format!("{}: {}, {}", person.name, person.knee.name(), skin.name()),
            axes: ["flexion".to_owned(), "adduction".to_owned(), "rotation, deg".to_owned()],
            unit: "mm".to_owned(),
            points,
        };
        canvas.place(&cloud.picture(wide, high), index % columns * wide, index / columns * high);
    }
    canvas
}
