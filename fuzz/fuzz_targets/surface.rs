//! Any bytes as a surface: no panic, and a mesh whose triangles have corners at places.
#![no_main]

use condyle_formats::surface;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = surface::from_bytes(data) else { return };
    let mesh = read.value;
    assert!(!mesh.triangles.is_empty(), "a surface has triangles");
    assert_eq!(mesh.positions.len(), mesh.normals.len());
    assert!(mesh.positions.iter().all(|p| p.is_finite()), "corners are somewhere");
    assert!(mesh.normals.iter().all(|n| n.is_finite()), "normals point somewhere");
    let corners = mesh.positions.len() as u32;
    assert!(mesh.triangles.iter().flatten().all(|corner| *corner < corners));
});
