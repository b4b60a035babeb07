//! Surfaces of bones in files: VTK's polygons, STL and OBJ.
//!
//! What a file is, its content tells: an element `VTKFile`, the length that binary STL states, or lines of text.
//! Polygons become triangles that share their first corner, corners at the same place become one, and normals are
//! made anew from the triangles, so that all files look alike. Numbers are taken as they are: OpenSim has metres.
//!
//! | format | what is read |
//! | --- | --- |
//! | `.vtp` | points, polygons and strips of `PolyData`: in text, in base64 within or appended, or appended as bytes; either byte order; deflated by zlib or not |
//! | `.stl` | triangles, binary or text |
//! | `.obj` | `v` and `f`; all else is skipped |

mod obj;
mod stl;
mod vtp;

use condyle_diagnostics::{Diagnostic, Error, Read};
use condyle_math::Vec3;
use condyle_mesh::Mesh;
use std::collections::HashMap;

/// The largest coordinate of a corner, in whatever unit: a surface of bones is smaller.
const LARGEST: f64 = 1e9;

/// Reads a surface of any of these formats; its normals point to where triangles are counter-clockwise.
///
/// # Warnings
/// `surface/truncated` for binary STL that ends early, whose whole triangles are read.
///
/// # Errors
/// `surface/format` where the content is of none; `surface/number`, `surface/corner` for a triangle of a corner that is not
/// there, `surface/empty` without triangles; `vtp/…` with the line; what is wrong with the XML.
///
/// ```
/// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let mesh = condyle_formats::surface::from_bytes(text.as_bytes())?.value;
/// assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 2));
/// assert_eq!(mesh.normals[0].z, 1.0);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Mesh>, Error> {
    let head = bytes.get(..bytes.len().min(4096)).unwrap_or_default();
    let has = |word: &[u8]| head.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word));
    let mut warnings = vec![];
    let soup = if has(b"<VTKFile") {
        vtp::read(bytes)?
    } else if stl::is_binary(bytes) {
        stl::binary(bytes, &mut warnings)
    } else if has(b"solid") && has(b"facet") {
        stl::text(bytes)?
    } else if has(b"v ") || has(b"v\t") {
        obj::read(bytes)?
    } else {
        return Err(Error::new("surface/format", "this is neither .vtp nor .stl nor .obj")
            .with_help("legacy files of VTK are saved anew as .vtp"));
    };
    Ok(Read { value: soup.mesh()?, warnings })
}

/// Corners and triangles as they stand in a file.
#[derive(Debug, Default)]
struct Soup {
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Adds a polygon as triangles that share its first corner.
    fn polygon(&mut self, corners: &[u32]) {
        let [first, rest @ ..] = corners else { return };
        self.triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }

    /// One corner for each place, and no triangle that is a line.
    fn mesh(self) -> Result<Mesh, Error> {
        let Self { corners, triangles } = self;
        if let Some(bad) = corners
            .iter()
            .position(|p| !p.is_finite() || p.to_array().iter().any(|x| x.abs() > LARGEST))
        {
            let message = format!("corner {} is at no place", bad + 1);
            return Err(Error::new("surface/number", message));
        }
        let mut at: HashMap<[u64; 3], u32> = HashMap::with_capacity(corners.len());
        let mut positions: Vec<Vec3> = vec![];
        let mut own = Vec::with_capacity(corners.len());
        for corner in &corners {
            // Minus zero is zero.
            let key = corner.to_array().map(|x| (x + 0.0).to_bits());
            own.push(*at.entry(key).or_insert_with(|| {
                positions.push(*corner);
                (positions.len() - 1) as u32
            }));
        }
        let mut kept = Vec::with_capacity(triangles.len());
        for (number, triangle) in triangles.into_iter().enumerate() {
            let [Some(&a), Some(&b), Some(&c)] = triangle.map(|i| own.get(i as usize)) else {
                let message = format!("triangle {} has a corner that is not there", number + 1);
                return Err(Error::new("surface/corner", message)
                    .with_help(format!("there are {} corners", corners.len())));
            };
            if a != b && b != c && c != a {
                kept.push([a, b, c]);
            }
        }
        if kept.is_empty() {
            return Err(Error::new("surface/empty", "there are no triangles in it"));
        }
        Ok(Mesh::of(positions, kept))
    }
}

/// What is said of a file that ends before it should.
fn truncated(found: usize, stated: usize) -> Diagnostic {
    let message = format!("the file ends after {found} of {stated} triangles");
    Diagnostic::warning("surface/truncated", message).with_help("the whole ones are read")
}

#[cfg(test)]
mod tests;
