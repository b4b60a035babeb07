//! Surfaces that bones glide on, the points that touch them, and gaps.

use super::figure::Figure;
use super::marks::{label, line};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::component::Contact;
use condyle_model::{Law, SegmentId, Signal};
use condyle_render::{Scene, Surface, palette, shape};

/// A gap of more than this is coloured as broken where no other is allowed, in metres.
const TOUCHING: f64 = 1e-4;

const OPACITY: f64 = 0.14;

/// All contacts of the segments that are looked at.
pub(super) fn contacts(figure: &Figure, named: bool, scene: &mut Scene) {
    let model = figure.model;
    for (number, id) in figure.program.contacts().enumerate() {
        let component = &model.components()[id.index()];
        let Law::Contact(law) = &component.law else { continue };
        let Some(segment) = component.segments_at("segment").next() else { continue };
        let surface = component.segments_at("surface").next();
        if figure.is_signed(segment) {
            glide(figure, (law, number), (segment, surface), named, scene);
        }
    }
    for id in model.component_ids() {
        let component = &model.components()[id.index()];
        let Law::Ellipsoid(law) = &component.law else { continue };
        let moved = model.outputs_of(component.joint_set).find(
            |(_, signal)| matches!(signal, Signal::Output(of, _) if reads(figure, *of, id.index())),
        );
        let Some((segment, _)) = moved.filter(|(segment, _)| figure.is_signed(*segment)) else {
            continue;
        };
        let own = model.segment(segment);
        let frame = figure.pose.frame(own.parent) * own.joint_in_parent;
        let ball = shape::ellipsoid(&frame, law.radii.to_array(), palette::CONTACT);
        scene.surfaces.push(ball.with_opacity(OPACITY));
        point(figure.joint(segment).translation, palette::GAP, figure, scene);
    }
}

/// Whether a component is another, or has it among its inputs, however far before.
fn reads(figure: &Figure, of: condyle_model::model::ComponentId, wanted: usize) -> bool {
    let mut next = vec![of];
    let mut seen = vec![false; figure.model.components().len()];
    while let Some(id) = next.pop() {
        if id.index() == wanted {
            return true;
        }
        if std::mem::replace(&mut seen[id.index()], true) {
            continue;
        }
        let inputs = &figure.model.components()[id.index()].inputs;
        next.extend(inputs.iter().filter_map(|signal| match signal {
            Signal::Output(id, _) => Some(*id),
            _ => None,
        }));
    }
    false
}

/// An ellipsoid with the two points on it that touch it now, joined, and a line to the surface from each that
/// does not.
fn glide(
    figure: &Figure,
    (law, number): (&Contact, usize),
    (segment, surface): (SegmentId, Option<SegmentId>),
    named: bool,
    scene: &mut Scene,
) {
    let frame = figure.pose.frame(surface) * law.law.ellipsoid_in_surface();
    let radii = law.law.radii();
    let ball = shape::ellipsoid(&frame, radii.to_array(), palette::CONTACT);
    scene.surfaces.push(ball.with_opacity(OPACITY));
    let Some(report) = figure.pose.contact(number) else { return };
    let drivers: Vec<f64> = figure.program.contact_drivers(figure.pose, number).collect();
    let places = law.law.points(&drivers).map(|p| figure.pose.segment(segment) * p);
    for pair in law.law.pairs() {
        let ends = [pair.first, pair.second].map(|p| figure.pose.segment(segment) * p);
        scene.lines.push(line(ends.to_vec(), 1.0, palette::LEADER));
    }
    scene.lines.push(line(places.to_vec(), 2.5, palette::CONTACT));
    for (place, gap) in places.into_iter().zip(report.gaps) {
        let most = law.most_gap.unwrap_or(0.0).max(TOUCHING);
        let colour = if gap.abs() <= most { palette::GAP } else { palette::GAP_BROKEN };
        point(place, colour, figure, scene);
        if gap.abs() > TOUCHING {
            let normal = normal(&frame, radii, place);
            scene.lines.push(line(vec![place, place - normal * gap], 3.0, colour));
            if named {
                label(place, &format!("{:.1} mm", gap * 1e3), colour, scene);
            }
        }
    }
}

fn point(at: Vec3, colour: palette::Colour, figure: &Figure, scene: &mut Scene) {
    let mut mark = Surface::empty(colour);
    shape::add_ball(&mut mark, at, 0.1 * figure.unit, (14, 10));
    scene.surfaces.push(mark);
}

/// The outward normal of the ellipsoid that goes through a point with the same shape.
fn normal(frame: &Affine, radii: Vec3, place: Vec3) -> Vec3 {
    let own: Mat3 = frame.linear.transpose();
    let Vec3 { x, y, z } = own * (place - frame.translation);
    let steep = Vec3::new(x / radii.x.powi(2), y / radii.y.powi(2), z / radii.z.powi(2));
    let length = steep.norm();
    if length > 1e-12 { frame.linear * (steep * length.recip()) } else { Vec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::super::figure::tests::seen;
    use super::*;

    /// Where a point is against the ellipsoid: 1 on it.
    fn level(frame: &Affine, radii: Vec3, place: Vec3) -> f64 {
        let own = frame.linear.transpose() * (place - frame.translation);
        Vec3::new(own.x / radii.x, own.y / radii.y, own.z / radii.z).norm()
    }

    #[test]
    fn points_that_touch_are_on_the_ellipsoid_and_a_gap_leads_to_it() {
        let shoulder = crate::shipped::read("shoulder").expect("it is shipped").value.model;
        let plane = shoulder.find_coordinate("shoulder_elevation_r").expect("a coordinate");
        let mut joined = 0;
        for elevation in [0.0, 0.6, 1.4] {
            let mut stored = shoulder.defaults();
            *shoulder.value_mut(&mut stored, plane) = elevation;
            seen(&shoulder, &stored, |figure| {
                let mut scene = Scene::default();
                contacts(figure, false, &mut scene);
                for (number, id) in figure.program.contacts().enumerate() {
                    let component = &shoulder.components()[id.index()];
                    let Law::Contact(law) = &component.law else { continue };
                    let surface = component.segments_at("surface").next();
                    let frame = figure.pose.frame(surface) * law.law.ellipsoid_in_surface();
                    let gaps = figure.pose.contact(number).expect("a report").gaps;
                    let lines = scene.lines.iter().filter(|l| l.colour == palette::CONTACT);
                    for line in lines {
                        let ends = [0, 1].map(|i| Vec3::from(line.points[i]));
                        let levels = ends.map(|end| level(&frame, law.law.radii(), end) - 1.0);
                        // Of one of the two contacts, on the right or left.
                        if (levels[0].abs() < 1e-9) == (gaps[0].abs() < TOUCHING)
                            && levels[1].abs() < 1e-9
                            && gaps[1].abs() < TOUCHING
                        {
                            joined += 1;
                        }
                    }
                }
            });
        }
        assert!(joined >= 3, "{joined} pairs on the ribs");
    }

    #[test]
    fn the_normal_is_that_of_the_surface() {
        let frame = Affine::new(Mat3::rotation_y(0.7), Vec3::new(0.1, 0.2, 0.3));
        let radii = Vec3::new(0.1, 0.2, 0.15);
        // A point that is 3 mm outside along the normal of its foot.
        let foot = Vec3::new(0.6 * radii.x, 0.0, 0.8 * radii.z);
        let steep = Vec3::new(foot.x / 0.01, 0.0, foot.z / 0.0225).normalized();
        let place = frame * (foot + steep * 0.003);
        let back = place - normal(&frame, radii, place) * 0.003;
        // The shape through the point is only nearly the same: off by the square of the gap.
        assert!((level(&frame, radii, back) - 1.0).abs() < 1e-3);
        assert!((back - frame * foot).norm() < 3e-4);
    }
}
