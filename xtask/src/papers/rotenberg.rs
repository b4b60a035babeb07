//! The joint types of Rotenberg's chapter.

use super::Item;
use super::Step::{File, Picture, Run};

/// One of each, along a bar.
const JOINTS: &str = r#"condyle = 1
kind = "model"
name = "joints"
angles = "deg"

[segment.bar]
[segment.hinge]
parent = "bar"
at = [0, 0, 0]
[segment.universal]
parent = "bar"
at = [0.3, 0, 0]
[segment.ball]
parent = "bar"
at = [0.6, 0, 0]
[segment.prismatic]
parent = "bar"
at = [0.9, 0, 0]
[segment.screw]
parent = "bar"
at = [1.2, 0, 0]
[segment.scale]
parent = "bar"
at = [1.5, 0, 0]
[segment.shear]
parent = "bar"
at = [1.8, 0, 0]

[joint.hinge]
segment = "hinge"
type = "hinge"
axis = [0, 0, 1]
[joint.universal]
segment = "universal"
type = "universal"
axes = [[1, 0, 0], [0, 0, 1]]
[joint.ball]
segment = "ball"
type = "euler"
order = "zxy"
[joint.prismatic]
segment = "prismatic"
type = "prismatic"
axis = [0, 1, 0]
[joint.screw]
segment = "screw"
type = "screw"
axis = [0, 1, 0]
pitch = 0.2
[joint.scale]
segment = "scale"
type = "scale"
axis = [0, 1, 0]
volume = true
[joint.shear]
segment = "shear"
type = "shear"
along = [1, 0, 0]
across = [0, 1, 0]

[shape.hinge]
segment = "hinge"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.universal]
segment = "universal"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.ball]
segment = "ball"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.prismatic]
segment = "prismatic"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.screw]
segment = "screw"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.scale]
segment = "scale"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
[shape.shear]
segment = "shear"
box = { at = [0, 0.1, 0], size = [0.06, 0.2, 0.06] }
"#;

/// All of them moved.
const MOVED: &str = r#"[{}, { "hinge/angle": "40 deg", "universal/first": "30 deg", "universal/second": "40 deg", "ball/first": "30 deg", "ball/second": "20 deg",
 "ball/third": "60 deg", "prismatic/distance": 0.1, "screw/angle": "180 deg", "scale/factor": 1.5, "shear/amount": 0.5 }]
"#;

pub(super) const ITEMS: &[Item] = &[Item {
    name: "2.2 joint types",
    shows: "Hinge, universal, three-axis, translation, screw, scaling with constant volume, shear: at rest, and moved.",
    steps: &[
        File("joints.toml", JOINTS),
        File("moved.json", MOVED),
        Run(&["fk", "OUT/joints.toml", "--pose", "OUT/moved.json"], 60),
        Run(
            &[
                "render",
                "OUT/joints.toml",
                "--pose",
                "OUT/moved.json",
                "--view",
                "20,15",
                "--size",
                "1200x420",
                "-o",
                "OUT/joints.png",
            ],
            0,
        ),
        Picture("joints.png"),
    ],
    beside: "The chapter writes row vectors; matrices here are for columns, transposed. Its formulas, one by one, are held by the tests of condyle-model.",
}];
