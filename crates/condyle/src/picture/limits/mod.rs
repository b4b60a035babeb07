//! What limits allow, and where the pose is in it: reach cones, what learned fields reach, and ellipses as fans about their joint, the
//! range of a rotation as an arc, that of a translation as a bar.

mod arc;
mod cone;
mod ellipse;
#[cfg(test)]
mod enforced;
mod field;
mod judged;
mod reach;
mod twist;

pub use field::Reaches;
pub(super) use judged::Judged;

use super::figure::Figure;
use super::marks::line;
use super::sweep::Sweep;
use condyle_math::Vec3;
use condyle_model::{CoordinateId, Law, Signal};
use condyle_render::{Line, Scene, Surface, palette};

/// All limits of the segments that are looked at.
pub(super) fn limits(figure: &Figure, named: bool, scene: &mut Scene) {
    let mut sweep = Sweep::new(figure);
    for bound in figure.program.bounds() {
        match &figure.model.components()[bound.component.index()].law {
            Law::Cone(law) => cone::draw(figure, bound, law, scene),
            Law::Ellipse(law) => ellipse::draw(figure, &mut sweep, bound, law, scene),
            Law::Field(law) => field::draw(figure, bound, law, scene),
            _ => {}
        }
    }
    let shown = figure.shown_by_others();
    for id in figure.model.coordinate_ids().filter(|id| !shown.contains(id)) {
        arc::draw(figure, &mut sweep, id, named, scene);
    }
}

impl Figure<'_> {
    /// The coordinates that a cone or an ellipse bounds.
    fn shown_by_others(&self) -> Vec<CoordinateId> {
        let components = self.model.components().iter();
        let wide = components.filter(|c| matches!(c.law, Law::Cone(_) | Law::Ellipse(_)));
        let signals = wide.flat_map(|c| c.inputs.iter());
        let direct = signals.filter_map(|signal| match *signal {
            Signal::Coordinate(id) => Some(id),
            Signal::Output(id, _) => {
                let before = &self.model.components()[id.index()];
                let bounded = before.law.bounds().then_some(before.inputs.first()).flatten();
                match bounded {
                    Some(Signal::Coordinate(id)) => Some(*id),
                    _ => None,
                }
            }
            Signal::Segment(_) => None,
        });
        direct.collect()
    }
}

/// How opaque what is allowed is.
const OPACITY: f64 = 0.3;

/// A fan from a centre over a path.
fn fan(centre: Vec3, path: &[Vec3], colour: palette::Colour) -> Surface {
    let mut surface = Surface::empty(colour).with_opacity(OPACITY);
    path.windows(2).for_each(|ends| surface.flat([centre, ends[0], ends[1]]));
    surface
}

/// The line from a joint to where its bone points now.
fn value(centre: Vec3, to: Vec3) -> Line {
    Line { through: 0.6, ..line(vec![centre, to], 3.0, palette::VALUE) }
}
