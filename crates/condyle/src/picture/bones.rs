//! The surfaces of bones, and skins over them.

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
    figure.surfaces.seen().map(part).collect()
}

/// All skins; bones are seen through them where they are shown as well.
pub(super) fn skins(figure: &Figure, through: bool) -> Vec<Surface> {
    let skin = |skin: &crate::geometry::Skin| {
        let mesh = skin.posed(figure.pose);
        Surface {
            positions: mesh.positions.into_iter().map(|p| p.to_array()).collect(),
            normals: mesh.normals.into_iter().map(|n| n.to_array()).collect(),
            triangles: mesh.triangles,
            colour: figure.colour(None, skin.colour.unwrap_or(palette::SKIN)),
            opacity: if through { 0.4 } else { 1.0 },
        }
    };
    figure.surfaces.skins.iter().map(skin).collect()
}
