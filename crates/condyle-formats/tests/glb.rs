//! Scenes, written and read again with another library.

use condyle_formats::glb::{
    Finish, LocalPose, MarkerTrack, Scene, SceneNode, Shape, Track, UpAxis, write,
};
use gltf::animation::util::ReadOutputs;

/// A turn about z by so many radians, at so much along x.
fn pose(angle: f64, x: f64) -> LocalPose {
    let (sin, cos) = (angle / 2.0).sin_cos();
    let rotation = [0.0, 0.0, sin, cos];
    LocalPose { translation: [x, 0.0, 0.0], rotation, ..LocalPose::IDENTITY }
}

/// An arm of two bones that bends and slides over four frames, with two recorded markers.
fn arm() -> Scene {
    let node = |name: &str, parent| SceneNode {
        name: name.into(),
        parent,
        shapes: vec![
            Shape::Bone { to: [0.0, -0.3, 0.0] },
            Shape::Ball { at: [0.0; 3], radius: 0.02, finish: Finish::Joint },
        ],
        ..SceneNode::default()
    };
    let mut hand = node("hand", Some(1));
    hand.rest.translation = [0.0, -0.3, 0.0];
    let size = [0.05, 0.1, 0.02];
    hand.shapes = vec![Shape::Box { at: [0.0, -0.05, 0.0], size, finish: Finish::Accent }];
    Scene {
        name: "arm".into(),
        up: UpAxis::Z,
        nodes: vec![node("upper", None), node("fore", Some(0)), hand],
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
    assert_eq!(document.nodes().count(), 5);
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
    let cases: [(&str, &str, Spoil); 11] = [
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
        ("glb/shape", "`hand` has Ball", |s| {
            s.nodes[2].shapes =
                vec![Shape::Ball { at: [0.0; 3], radius: 0.0, finish: Finish::Bone }];
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
