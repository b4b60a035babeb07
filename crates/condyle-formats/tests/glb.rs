//! Scenes, written and read again with another library.

use condyle_formats::glb::{
    Finish, LocalPose, MarkerTrack, Scene, SceneNode, Surface, Track, UpAxis, write,
};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_mesh::{Ball, Block, Form, Spindle};
use gltf::animation::util::ReadOutputs;

/// A turn about z by so many radians, at so much along x.
fn pose(angle: f64, x: f64) -> LocalPose {
    let (sin, cos) = (angle / 2.0).sin_cos();
    let rotation = [0.0, 0.0, sin, cos];
    LocalPose { translation: [x, 0.0, 0.0], rotation, ..LocalPose::IDENTITY }
}

/// An arm of two bones that bends and slides over four frames, with two recorded markers.
fn arm() -> Scene {
    let node = |name: &str, parent| SceneNode { name: name.into(), parent, ..SceneNode::default() };
    let (turn, down) = (Mat3::IDENTITY, Vec3::new(0.0, -0.3, 0.0));
    let bone = Form::Spindle(Spindle { from: Vec3::ZERO, to: down });
    let joint = Form::Ball(Ball { at: Vec3::ZERO, radii: Vec3::new(0.02, 0.02, 0.02), turn });
    let palm = Form::Block(Block {
        at: Vec3::new(0.0, -0.35, 0.0),
        size: Vec3::new(0.05, 0.1, 0.02),
        turn,
    });
    let surface = |form: &Form, finish, nodes| Surface {
        mesh: form.mesh(),
        finish,
        nodes,
        ..Surface::default()
    };
    let mut hand = node("hand", Some(1));
    hand.rest.translation = [0.0, -0.3, 0.0];
    hand.bound = Affine::from_translation(down);
    Scene {
        name: "arm".into(),
        up: UpAxis::Z,
        nodes: vec![node("upper", None), node("fore", Some(0)), hand],
        surfaces: vec![
            surface(&bone, Finish::Bone, [0, 0]),
            surface(&joint, Finish::Joint, [1, 1]),
            surface(&palm, Finish::Accent, [2, 2]),
        ],
        times: vec![2.0, 2.5, 3.0, 3.5],
        tracks: vec![
            // The sign of the third rotation is turned: the same turn, another quaternion.
            Track {
                node: 1,
                poses: vec![
                    pose(0.0, 0.0),
                    pose(0.5, 0.1),
                    pose(1.0 + std::f64::consts::TAU, 0.2),
                    pose(1.5, 0.3),
                ],
            },
            // This one only turns.
            Track { node: 0, poses: [0.0, 0.1, 0.2, 0.3].map(|a| pose(a, 0.7)).to_vec() },
        ],
        markers: vec![
            MarkerTrack {
                name: "elbow".into(),
                positions: vec![None, Some([1.0, 2.0, 3.0]), None, Some([4.0, 5.0, 6.0])],
            },
            MarkerTrack { name: "never".into(), positions: vec![None; 4] },
        ],
        ..Scene::default()
    }
}

fn reread(scene: &Scene) -> (gltf::Document, Vec<u8>) {
    let gltf = gltf::Gltf::from_slice(&write(scene).unwrap()).unwrap();
    (gltf.document, gltf.blob.unwrap_or_default())
}

#[test]
fn the_tree_is_that_of_the_scene() {
    let (document, _) = reread(&arm());
    let root = document.default_scene().unwrap().nodes().next().unwrap();
    assert_eq!(root.name(), Some("arm"));
    let names = |node: &gltf::Node<'_>| {
        node.children().map(|c| c.name().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(&root), ["upper", "elbow"]);
    let upper = root.children().next().unwrap();
    assert_eq!(names(&upper), ["fore"]);
    assert_eq!(document.nodes().count(), 6);
    let materials: Vec<_> = document.materials().filter_map(|m| m.name()).collect();
    assert_eq!(materials, ["bone", "joint", "accent", "marker"]);
}

#[test]
fn z_up_becomes_y_up() {
    let (document, _) = reread(&arm());
    let root = document.default_scene().unwrap().nodes().next().unwrap();
    let matrix = root.transform().matrix();
    // The image of z, the third column, is y.
    for (found, expected) in matrix[2].iter().zip([0.0, 1.0, 0.0, 0.0]) {
        assert!((found - expected).abs() < 1e-6, "{matrix:?}");
    }
    let (document, _) = reread(&Scene { up: UpAxis::Y, ..arm() });
    let root = document.default_scene().unwrap().nodes().next().unwrap();
    assert_eq!(root.transform().decomposed().1, [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn channels_hold_the_motion() {
    let (document, bin) = reread(&arm());
    let animation = document.animations().next().unwrap();
    // Turn and slide of the forearm, turn of the upper arm, the way of the elbow's marker.
    assert_eq!(animation.channels().count(), 4);
    let mut seen = Vec::new();
    for channel in animation.channels() {
        let name = channel.target().node().name().unwrap().to_owned();
        let reader = channel.reader(|buffer| (buffer.index() == 0).then_some(bin.as_slice()));
        let times: Vec<f32> = reader.read_inputs().unwrap().collect();
        assert_eq!(times, [0.0, 0.5, 1.0, 1.5]);
        match reader.read_outputs().unwrap() {
            ReadOutputs::Translations(places) => {
                let places: Vec<_> = places.collect();
                if name == "elbow" {
                    let (first, last) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
                    assert_eq!(places, [first, first, first, last]);
                } else {
                    assert_eq!(places[3], [0.3, 0.0, 0.0]);
                }
                seen.push(format!("{name} moves"));
            }
            ReadOutputs::Rotations(rotations) => {
                let rotations: Vec<[f32; 4]> = rotations.into_f32().collect();
                for pair in rotations.windows(2) {
                    let dot: f32 = (0..4).map(|i| pair[0][i] * pair[1][i]).sum();
                    assert!(dot > 0.9, "a rotation jumps to its opposite: {rotations:?}");
                }
                if name == "fore" {
                    let expected = (0.5_f32).sin_cos();
                    assert!((rotations[2][2] - expected.0).abs() < 1e-6);
                    assert!((rotations[2][3] - expected.1).abs() < 1e-6);
                }
                seen.push(format!("{name} turns"));
            }
            _ => panic!("a channel of another kind"),
        }
    }
    assert_eq!(seen, ["fore moves", "fore turns", "upper turns", "elbow moves"]);
    // At rest the nodes stand as in the first frame.
    let upper = document.nodes().find(|n| n.name() == Some("upper")).unwrap();
    assert_eq!(upper.transform().decomposed().0, [0.7, 0.0, 0.0]);
}

#[test]
fn only_what_changes_its_size_has_a_channel_for_it() {
    let mut scene = arm();
    // The hand is small throughout; the forearm grows along its bone while it thins.
    scene.nodes[2].rest.scale = [0.5, 0.25, 2.0];
    for (pose, length) in scene.tracks[0].poses.iter_mut().zip([1.0, 1.5, 2.0, 4.0]) {
        pose.scale = [1.0 / f64::sqrt(length), length, 1.0 / f64::sqrt(length)];
    }
    let (document, bin) = reread(&scene);
    let scale = |name: &str| {
        let node = document.nodes().find(|n| n.name() == Some(name)).unwrap();
        node.transform().decomposed().2
    };
    assert_eq!(scale("hand"), [0.5, 0.25, 2.0]);
    assert_eq!((scale("upper"), scale("fore")), ([1.0; 3], [1.0; 3]));
    let animation = document.animations().next().unwrap();
    let mut sized = vec![];
    for channel in animation.channels() {
        let reader = channel.reader(|_| Some(bin.as_slice()));
        if let ReadOutputs::Scales(scales) = reader.read_outputs().unwrap() {
            sized.push(channel.target().node().name().unwrap().to_owned());
            let scales: Vec<[f32; 3]> = scales.collect();
            assert_eq!(scales[3], [0.5, 4.0, 0.5]);
            assert_eq!(scales[1][0], 1.5f64.sqrt().recip() as f32);
        }
    }
    assert_eq!(sized, ["fore"]);
}

#[test]
fn bounds_and_alignment_are_as_the_format_asks() {
    let (document, bin) = reread(&arm());
    for view in document.views() {
        assert_eq!(view.offset() % 4, 0);
        assert!(view.offset() + view.length() <= bin.len());
    }
    for mesh in document.meshes() {
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| Some(bin.as_slice()));
            let bounds = primitive.bounding_box();
            let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            for axis in 0..3 {
                let all = positions.iter().map(|p| p[axis]);
                assert_eq!(bounds.min[axis], all.clone().fold(f32::INFINITY, f32::min));
                assert_eq!(bounds.max[axis], all.fold(f32::NEG_INFINITY, f32::max));
            }
            let corners = positions.len() as u32;
            assert!(reader.read_indices().unwrap().into_u32().all(|i| i < corners));
        }
    }
}

#[test]
fn a_still_figure_has_no_animation() {
    let still = Scene { times: vec![], tracks: vec![], markers: vec![], ..arm() };
    let (document, _) = reread(&still);
    assert_eq!(document.animations().count(), 0);
    let hand = document.nodes().find(|n| n.name() == Some("hand")).unwrap();
    assert_eq!(hand.transform().decomposed().0, [0.0, -0.3, 0.0]);
    let (empty, bin) = reread(&Scene { name: "nothing".into(), ..Scene::default() });
    assert_eq!((empty.nodes().count(), bin.len()), (1, 0));
}

#[test]
fn repeated_times_are_dropped() {
    let mut scene = arm();
    scene.times = vec![1e9, 1e9, 1e9 + 1.0, 1e9 + 1.0];
    let (document, bin) = reread(&scene);
    let animation = document.animations().next().unwrap();
    let channel = animation.channels().next().unwrap();
    let reader = channel.reader(|_| Some(bin.as_slice()));
    assert_eq!(reader.read_inputs().unwrap().collect::<Vec<_>>(), [0.0, 1.0]);
}

#[test]
fn faults_name_the_node() {
    type Spoil = fn(&mut Scene);
    let cases: [(&str, &str, Spoil); 14] = [
        ("glb/parent", "node 0 `upper` has parent 2", |s| s.nodes[0].parent = Some(2)),
        ("glb/track", "a track moves node 7", |s| s.tracks[0].node = 7),
        ("glb/track", "two tracks move `upper`", |s| s.tracks[0].node = 0),
        ("glb/track", "the track of `fore` has 3 frames", |s| {
            s.tracks[0].poses.pop();
        }),
        ("glb/time", "time 1 is before time 0", |s| s.times[0] = 9.0),
        ("glb/time", "time 3 is not finite", |s| s.times[3] = f64::NAN),
        ("glb/pose", "`fore` has", |s| s.tracks[0].poses[2].rotation = [0.0; 4]),
        ("glb/pose", "`hand` has", |s| s.nodes[2].rest.translation[0] = f64::INFINITY),
        ("glb/pose", "`fore` has", |s| s.tracks[0].poses[1].scale[2] = f64::NAN),
        ("glb/pose", "marker `elbow` is not finite", |s| {
            s.markers[0].positions[0] = Some([f64::NAN; 3]);
        }),
        ("glb/surface", "surface 2 hangs on node 3", |s| s.surfaces[2].nodes = [2, 3]),
        ("glb/surface", "surface 1 has", |s| s.surfaces[1].weights = vec![0.5]),
        ("glb/surface", "surface 0 is not finite", |s| {
            s.surfaces[0].mesh.positions[3].x = f64::NAN;
        }),
        ("glb/surface", "surface 2 hangs on `hand`, which has no size", |s| {
            s.nodes[2].bound.linear = Mat3::from_columns(Vec3::X, Vec3::Y, Vec3::X);
        }),
    ];
    for (code, said, spoil) in cases {
        let mut scene = arm();
        spoil(&mut scene);
        let error = write(&scene).unwrap_err();
        assert_eq!(error.code(), code, "{said}");
        assert!(error.to_string().starts_with(said), "{error}");
    }
}

/// Where a skinned corner is shown, by glTF's own formula.
#[test]
fn a_surface_goes_with_the_nodes_that_carry_it() {
    let mut scene = arm();
    // A band from the forearm to the hand: its corners go with both, the lower the more with the hand.
    let ends =
        Form::Spindle(Spindle { from: Vec3::new(0.0, -0.2, 0.0), to: Vec3::new(0.0, -0.4, 0.0) });
    let mesh = ends.mesh();
    let weights: Vec<f64> = mesh.positions.iter().map(|p| (-0.2 - p.y) / 0.2).collect();
    let surface =
        Surface { mesh, finish: Finish::Cartilage, nodes: [1, 2], weights, colours: vec![] };
    scene.surfaces = vec![surface.clone()];
    // The hand is turned at rest, and the surface is given where it is not.
    scene.nodes[2].rest = LocalPose { translation: [0.0, -0.3, 0.0], ..pose(0.8, 0.0) };
    scene.up = UpAxis::Y;
    scene.tracks.clear();
    let (document, bin) = reread(&scene);
    let skin = document.skins().next().unwrap();
    let matrix = |m: [[f32; 4]; 4]| {
        let [x, y, z, t] = m.map(|[a, b, c, _]| Vec3::new(a.into(), b.into(), c.into()));
        Affine::new(Mat3::from_columns(x, y, z), t)
    };
    let reader = skin.reader(|_| Some(bin.as_slice()));
    let back: Vec<Affine> = reader.read_inverse_bind_matrices().unwrap().map(matrix).collect();
    let joints: Vec<&str> = skin.joints().map(|j| j.name().unwrap()).collect();
    assert_eq!(joints, ["upper", "fore", "hand"]);
    let turned = Affine::new(Mat3::rotation_z(0.8), Vec3::new(0.0, -0.3, 0.0));
    let shown = [Affine::IDENTITY, Affine::IDENTITY, turned];
    let primitive = document.meshes().find(|m| m.name() == Some("arm")).unwrap();
    let primitive = primitive.primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(bin.as_slice()));
    let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    let joints: Vec<[u16; 4]> = reader.read_joints(0).unwrap().into_u16().collect();
    let weights: Vec<[f32; 4]> = reader.read_weights(0).unwrap().into_f32().collect();
    for (corner, p) in positions.iter().enumerate() {
        let p = Vec3::from(p.map(f64::from));
        let mut found = Vec3::ZERO;
        for k in 0..4 {
            let joint = usize::from(joints[corner][k]);
            found += (shown[joint] * (back[joint] * p)) * f64::from(weights[corner][k]);
        }
        let w = surface.weights[corner];
        // The forearm has not moved; the hand turned about its own joint.
        let moved =
            Mat3::rotation_z(0.8) * (p - Vec3::new(0.0, -0.3, 0.0)) + Vec3::new(0.0, -0.3, 0.0);
        let expected = p * (1.0 - w) + moved * w;
        assert!((found - expected).norm() < 1e-6, "{corner}: {found:?} {expected:?}");
    }
}

#[test]
fn whoever_looks_elsewhere_is_turned_to_look_along_z() {
    use condyle_model::model::Facing;
    for up in [UpAxis::Y, UpAxis::Z] {
        for facing in [Facing::PlusX, Facing::MinusX, Facing::PlusZ, Facing::MinusZ] {
            // Nobody looks along the vertical: with z up it is y.
            let ahead = match (up, facing) {
                (UpAxis::Z, Facing::PlusZ) => -Vec3::Y,
                (UpAxis::Z, Facing::MinusZ) => Vec3::Y,
                _ => facing.direction(),
            };
            let scene = Scene { up, facing, nodes: vec![SceneNode::default()], ..Scene::default() };
            let read = gltf::Gltf::from_slice(&write(&scene).unwrap()).unwrap();
            let top = read.scenes().next().unwrap().nodes().next().unwrap();
            let m = top.transform().matrix();
            let turned = |v: Vec3| -> Vec<f32> {
                let v = v.to_array().map(|x| x as f32);
                (0..3).map(|row| (0..3).map(|c| m[c][row] * v[c]).sum()).collect()
            };
            let near =
                |a: Vec<f32>, b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
            let vertical = if up == UpAxis::Y { Vec3::Y } else { Vec3::Z };
            assert!(near(turned(vertical), [0.0, 1.0, 0.0]), "{up:?} {facing:?}");
            assert!(near(turned(ahead), [0.0, 0.0, 1.0]), "{up:?} {facing:?}");
        }
    }
}

#[test]
fn what_is_driven_is_a_node_whose_place_is_the_value() {
    use condyle_formats::glb::Driven;
    let smile = Driven { name: "smile".into(), rest: 0.0, values: vec![0.0, 0.5, 1.0] };
    let scene = Scene {
        nodes: vec![SceneNode { name: "head".into(), ..SceneNode::default() }],
        times: vec![0.0, 0.1, 0.2],
        driven: vec![smile],
        ..Scene::default()
    };
    let file = write(&scene).unwrap();
    let read = gltf::Gltf::from_slice(&file).unwrap();
    let node = read.nodes().find(|node| node.name() == Some("smile")).unwrap();
    assert_eq!(node.extras().as_ref().unwrap().get(), r#"{"drives":"smile"}"#);
    let channel = read.animations().next().unwrap().channels().next().unwrap();
    assert_eq!(channel.target().node().index(), node.index());
    let reader = channel.reader(|_| read.blob.as_deref());
    let Some(ReadOutputs::Translations(places)) = reader.read_outputs() else {
        panic!("it moves along x");
    };
    assert_eq!(places.collect::<Vec<_>>(), [[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let wrong = Scene { driven: vec![Driven::default()], ..scene };
    assert_eq!(write(&wrong).unwrap_err().code(), "glb/track");
}

/// A surface with a colour for each corner: the numbers come back as linear light, its material is white so that nothing is mixed
/// into them, and the same finish without colours keeps its own material.
#[test]
fn corners_have_colours_of_their_own() {
    let mut scene = arm();
    let mut coloured = scene.surfaces[0].clone();
    let count = coloured.mesh.positions.len();
    coloured.colours = (0..count)
        .map(|i| [i as f32 / count as f32, 0.25, 1.0 - i as f32 / count as f32])
        .collect();
    scene.surfaces.push(coloured.clone());
    let (document, bin) = reread(&scene);
    let mesh = document.meshes().find(|mesh| mesh.name() == Some("arm")).expect("the figure");
    let mut found = 0;
    for primitive in mesh.primitives() {
        let reader = primitive.reader(|_| Some(&bin));
        let material = primitive.material().pbr_metallic_roughness().base_color_factor();
        match reader.read_colors(0) {
            Some(colours) => {
                found += 1;
                let colours: Vec<[f32; 3]> = colours.into_rgb_f32().collect();
                assert_eq!(colours, coloured.colours);
                assert_eq!(material, [1.0; 4]);
            }
            None => assert_ne!(material, [1.0; 4]),
        }
    }
    assert_eq!(found, 1);
    // A colour too few, and one that is none.
    for wrong in [vec![[0.0; 3]], vec![[2.0; 3]; count]] {
        scene.surfaces[3].colours = wrong;
        assert_eq!(write(&scene).unwrap_err().code(), "glb/surface");
    }
}
