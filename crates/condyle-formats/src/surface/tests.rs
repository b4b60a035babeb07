//! A square in every spelling that is read, and files that are damaged.

use super::from_bytes;
use crate::text::base64::encode;
use condyle_math::Vec3;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// The corners of a unit square in the xy plane: its area is 1.
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// Reads what must be the square, facing along z.
fn is_square(bytes: &[u8], what: &str) {
    let mesh = from_bytes(bytes).unwrap_or_else(|error| panic!("{what}: {error}")).value;
    let mut positions: Vec<[f64; 3]> = mesh.positions.iter().map(|p| p.to_array()).collect();
    positions.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let mut corners = SQUARE.map(|c| c.map(f64::from)).to_vec();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(positions, corners, "{what}");
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a) * 0.5
    };
    let areas = mesh.triangles.iter().map(area).fold(Vec3::ZERO, |a, b| a + b);
    assert_eq!(areas, Vec3::Z, "{what}");
    assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "{what}");
}

/// A block of VTK's in bytes: its heading, and what follows that.
fn block(bytes: &[u8], wide: bool, deflated: bool) -> [Vec<u8>; 2] {
    let number = |x: usize| match wide {
        true => (x as u64).to_le_bytes().to_vec(),
        false => (x as u32).to_le_bytes().to_vec(),
    };
    if !deflated {
        return [number(bytes.len()), bytes.to_vec()];
    }
    // Parts of 16 bytes.
    let (mut heading, mut packed) = (vec![], vec![]);
    let parts: Vec<&[u8]> = bytes.chunks(16).collect();
    for x in [parts.len(), 16, bytes.len() % 16] {
        heading.extend(number(x));
    }
    for part in parts {
        let mut encoder = ZlibEncoder::new(vec![], Compression::default());
        encoder.write_all(part).unwrap();
        let part = encoder.finish().unwrap();
        heading.extend(number(part.len()));
        packed.extend(part);
    }
    [heading, packed]
}

/// The square as VTK writes it.
fn vtp(format: &str, raw: bool, wide: bool, deflated: bool) -> Vec<u8> {
    let points: Vec<u8> = SQUARE.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let corners: Vec<u8> = (0..4i64).flat_map(i64::to_le_bytes).collect();
    let ends = 4i32.to_le_bytes().to_vec();
    let words = ["0 0 0 1 0 0 1 1 0 0 1 0", "0 1 2 3", "4"];
    let mut appended: Vec<u8> = vec![];
    let mut array = |name: &str, kind: &str, bytes: &[u8], words: &str| {
        let [heading, body] = block(bytes, wide, deflated);
        let encoded = match deflated {
            true => encode(&heading) + &encode(&body),
            false => encode(&[heading.clone(), body.clone()].concat()),
        };
        let start = format!("<DataArray Name=\"{name}\" type=\"{kind}\" NumberOfComponents=\"3\"");
        match format {
            "ascii" => format!("{start} format=\"ascii\">\n {words}\n</DataArray>"),
            "binary" => format!("{start} format=\"binary\">\n {encoded}\n</DataArray>"),
            _ => {
                let text = format!("{start} format=\"appended\" offset=\"{}\"/>", appended.len());
                if raw {
                    appended.extend([heading, body].concat());
                } else {
                    appended.extend(encoded.bytes());
                }
                text
            }
        }
    };
    let arrays = [
        array("Points", "Float32", &points, words[0]),
        array("connectivity", "Int64", &corners, words[1]),
        array("offsets", "Int32", &ends, words[2]),
    ];
    let wide = if wide { "UInt64" } else { "UInt32" };
    let compressor = if deflated { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let xml = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"{wide}\"{compressor}><PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"1\">\
         <Points>{}</Points><Polys>{}{}</Polys></Piece></PolyData>",
        arrays[0], arrays[1], arrays[2]
    );
    if format != "appended" {
        return (xml + "</VTKFile>").into_bytes();
    }
    let encoding = if raw { "raw" } else { "base64" };
    let open = format!("<AppendedData encoding=\"{encoding}\">\n   _");
    [xml.as_bytes(), open.as_bytes(), &appended, b"\n</AppendedData></VTKFile>"].concat()
}

fn stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..5].copy_from_slice(b"solid");
    bytes.extend(2u32.to_le_bytes());
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        bytes.extend([0; 12]);
        for corner in triangle {
            let corner: [f32; 3] = SQUARE[corner];
            bytes.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

const STL: &str = "solid square
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1 0 0
      vertex 1 1 0
    endloop
  endfacet
  facet normal 0 0 1
    outer loop
      vertex 0 0 -0
      vertex 1 1 0
      vertex 0 1e0 0
    endloop
  endfacet
endsolid square
";

const OBJ: &str = "# a square\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 # third\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n";

#[test]
fn every_spelling_gives_the_same_square() {
    for format in ["ascii", "binary", "appended"] {
        for bits in 0..8 {
            let (raw, wide, deflated) = (bits & 1 == 0, bits & 2 == 0, bits & 4 == 0);
            let what = format!("{format}, raw {raw}, wide {wide}, deflated {deflated}");
            is_square(&vtp(format, raw, wide, deflated), &what);
        }
    }
    is_square(&stl(), "binary STL");
    is_square(STL.as_bytes(), "STL");
    is_square(OBJ.as_bytes(), "OBJ");
    let strip = "<VTKFile type='PolyData'><PolyData><Piece><Points><DataArray type='Float32'>0 0 0 1 0 0 \
        0 1 0 1 1 0</DataArray></Points><Strips><DataArray Name='connectivity'>0 1 2 3</DataArray>\
        <DataArray Name='offsets'>4</DataArray></Strips></Piece></PolyData></VTKFile>";
    is_square(strip.as_bytes(), "a strip");
}

#[test]
fn damage_is_told_and_never_a_panic() {
    let code = |bytes: &[u8]| from_bytes(bytes).unwrap_err().iter().next().unwrap().code;
    assert_eq!(code(b"ply\nformat ascii 1.0\n"), "surface/format");
    assert_eq!(code(b"v 0 0 0\nv 1 0 0\nv 1 1 0\n"), "surface/empty");
    assert_eq!(code(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n"), "surface/corner");
    assert_eq!(code(b"v 0 0 0\nv 1 x 0\n"), "surface/number");
    assert_eq!(code(b"v 0 0 0\nv 1 inf 0\nv 1 1 0\nf 1 2 3\n"), "surface/number");
    let error = from_bytes(b"v 0 0 0\nf 1 0 1\n").unwrap_err().to_string();
    assert!(error.starts_with("line 2, column 5: `0` names no corner"), "{error}");
    // Of binary STL that is cut off the whole triangles are there.
    let cut = from_bytes(&stl()[..140]).unwrap();
    assert_eq!((cut.value.triangles.len(), cut.warnings[0].code), (1, "surface/truncated"));
    // A count of four thousand million triangles takes no memory.
    let mut many = stl();
    many[80..84].copy_from_slice(&[255; 4]);
    assert_eq!(from_bytes(&many).unwrap().value.triangles.len(), 2);
    for format in ["ascii", "binary", "appended"] {
        for bits in 0..4 {
            let whole = vtp(format, bits & 1 == 0, true, bits & 2 == 0);
            for end in (0..whole.len()).step_by(7) {
                let _ = from_bytes(&whole[..end]);
                let mut changed = whole.clone();
                changed[end] ^= 0x55;
                let _ = from_bytes(&changed);
            }
        }
    }
}
