//! The surfaces of bones.

use super::figure::Figure;
use condyle_mesh::Finish;
use condyle_model::SegmentId;
use condyle_render::{Surface, palette};

/// All surfaces, each with the segment that carries it.
pub(super) fn surfaces(figure: &Figure) -> Vec<(SegmentId, Surface)> {
    let part = |part: &crate::Part| {
        let [carrier, _] = part.segments;
        let plain = match part.finish {
            Finish::Bone => palette::BONE,
            Finish::Cartilage => palette::CARTILAGE,
            Finish::Joint => palette::JOINT,
            Finish::Accent => palette::ACCENT,
            Finish::Marker => palette::MARKER,
        };
        let mesh = figure.surfaces.posed(part, figure.pose);
        let surface = Surface {
            positions: mesh.positions.into_iter().map(|p| p.to_array()).collect(),
            normals: mesh.normals.into_iter().map(|n| n.to_array()).collect(),
            triangles: mesh.triangles,
            colour: figure.colour(Some(carrier), plain),
            opacity: 1.0,
        };
        (carrier, surface)
    };
    figure.surfaces.parts.iter().map(part).collect()
}
