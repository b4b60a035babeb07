//! Figures 3 to 11 and Plates 1 to 6 of Shao & Ng-Thow-Hing 2003.

use super::Item;
use super::Step::{File, Graph, Manual, Picture, Run};

/// An upper arm of 0.3 m, abducted about one centre up to 50 degrees and another beyond.
const FLOATING: &str = r#"condyle = 1
kind = "model"
name = "upper arm"
angles = "deg"

[segment.scapula]
[segment.humerus]
parent = "scapula"
[segment.elbow]
parent = "humerus"
at = [0, -0.3, 0]

[joint_set.shoulder.coordinate.abduction]
range = [0, 90]
[joint_set.shoulder.component.abduct.pivot]
angle = "abduction"
axis = [0, 0, 1]
centres = [{ to = 50, at = [0, 0, 0] }, { at = [0.01, 0.02, 0] }]
[joint_set.shoulder.output]
humerus = "abduct"
"#;

/// The arm at 0, 30, 50, 70 and 90 degrees.
const ABDUCTED: &str = r#"[{ "abduction": "0 deg" }, { "abduction": "30 deg" }, { "abduction": "50 deg" },
 { "abduction": "70 deg" }, { "abduction": "90 deg" }]
"#;

/// The clavicle raised, the arm left as it is asked to be.
const RAISED: &str = r#"[{ "shoulder_elevation_r": "60 deg" }, { "shoulder_elevation_r": "60 deg", "shrug_r": "15 deg" },
 { "shoulder_elevation_r": "60 deg", "shrug_r": "30 deg" }]
"#;

/// An arm asked for beyond the cone.
const BEYOND: &str = r#"[{ "shoulder_plane_r": "-120 deg", "shoulder_elevation_r": "40 deg" }, { "shoulder_plane_r": "-120 deg", "shoulder_elevation_r": "110 deg" }]
"#;

pub(super) const ITEMS: &[Item] = &[
    Item {
        name: "Figure 3",
        shows: "Compensation: the clavicle is raised by 0, 15 and 30 degrees, and the upper arm keeps its orientation while its head stays in the socket.",
        steps: &[
            File("raised.json", RAISED),
            Run(
                &[
                    "render",
                    "human",
                    "--pose",
                    "OUT/raised.json",
                    "--view",
                    "back",
                    "--at",
                    "clavicle_r,scapula_r,humerus_r",
                    "--zoom",
                    "3",
                    "--size",
                    "1100x360",
                    "-o",
                    "OUT/compensation.png",
                ],
                0,
            ),
            Picture("compensation.png"),
        ],
        beside: "The paper draws three states of one raise. Its two steps (inverse of the ancestor's transform, then the translation back to the joint) are the component \
                 `compensate`; a weight between 0 and 1 is ours. How far clavicle and arm may go is set by the paper's dependencies.",
    },
    Item {
        name: "Figure 4",
        shows: "Floating centre of shoulder abduction: c1 up to 50 degrees, c2 beyond; at 70 degrees first 50 about c1, then 20 about c2.",
        steps: &[
            File("floating.toml", FLOATING),
            File("abducted.json", ABDUCTED),
            Run(&["fk", "OUT/floating.toml", "--pose", "OUT/abducted.json"], 40),
            Run(
                &[
                    "render",
                    "OUT/floating.toml",
                    "--pose",
                    "OUT/abducted.json",
                    "--view",
                    "side",
                    "--show",
                    "bones,centres",
                    "--size",
                    "1000x300",
                    "-o",
                    "OUT/floating.png",
                ],
                0,
            ),
            Picture("floating.png"),
        ],
        beside: "By the paper's equation 1 written out (c2 + R(20)(R(50) p - c2), c1 at 0) at 70 degrees the origin of the arm is at (7.443, -2.214) mm and the elbow at (289.351, -104.820) mm: the \
                 numbers above. The paper's interval formula loses the value at the end of an interval; ours goes on from interval to interval.",
    },
    Item {
        name: "Figure 5",
        shows: "Joint limit cone of the shoulder, shaded by the range of twist.",
        steps: &[
            Run(
                &[
                    "render",
                    "human",
                    "--view",
                    "20,10",
                    "--at",
                    "shoulder_r",
                    "--zoom",
                    "3",
                    "--show",
                    "bones,limits",
                    "--size",
                    "800x520",
                    "-o",
                    "OUT/cone.png",
                ],
                0,
            ),
            Picture("cone.png"),
        ],
        beside: "The paper refines 14 points by subdivision; the cone here goes through its points by arcs on the sphere, so that what is drawn is what is enforced. The paper prints no \
                 coordinates of its points: `shoulder-shao2003` has its figure read off. This is the shoulder of `human`, learned from published ranges (docs/shipped-models.md).",
    },
    Item {
        name: "Figure 6",
        shows: "An arm asked for behind the back, beyond the limit, is put back to its boundary: above what is asked for, below what is enforced.",
        steps: &[
            File("beyond.json", BEYOND),
            Run(
                &[
                    "render",
                    "human",
                    "--pose",
                    "OUT/beyond.json",
                    "--limits",
                    "off",
                    "--view",
                    "150,15",
                    "--at",
                    "humerus_r,hand_r,thorax",
                    "--zoom",
                    "2",
                    "--size",
                    "800x380",
                    "-o",
                    "OUT/asked.png",
                ],
                0,
            ),
            Picture("asked.png"),
            Run(
                &[
                    "render",
                    "human",
                    "--pose",
                    "OUT/beyond.json",
                    "--view",
                    "150,15",
                    "--at",
                    "humerus_r,hand_r,thorax",
                    "--zoom",
                    "2",
                    "--size",
                    "800x380",
                    "-o",
                    "OUT/enforced.png",
                ],
                0,
            ),
            Picture("enforced.png"),
        ],
        beside: "The paper goes from the wrong direction straight toward that of rest until it meets the boundary, which depends on where rest is; here the nearest point of the boundary is taken, twist and swing together.",
    },
    Item {
        name: "Figure 7, Plate 6",
        shows: "The ellipsoids under the scapulae and the pairs of points that glide on them.",
        steps: &[
            Run(
                &[
                    "render",
                    "shoulder-shao2003",
                    "--view",
                    "back",
                    "--at",
                    "scapula_r,scapula_l",
                    "--show",
                    "bones,contacts",
                    "--size",
                    "900x480",
                    "-o",
                    "OUT/contact.png",
                ],
                0,
            ),
            Picture("contact.png"),
        ],
        beside: "As in the paper one ellipsoid on each side and pairs of reference points, the active one chosen by the arm; between pairs ours blends, so that nothing jumps.",
    },
    Item {
        name: "Figure 8",
        shows: "Joint function of the cervical joint set.",
        steps: &[Graph("spine-shao2003", "cervical", "cervical.svg"), Picture("cervical.svg")],
        beside: "One-to-many mapping, one rotation for each vertebra and their products, as in the figure; the paper's model has zero input at an end of the range, ours at the neutral pose.",
    },
    Item {
        name: "Figures 9 to 11",
        shows: "Joint function of the shoulder joint set, parts 1 to 3 in one graph.",
        steps: &[Graph("shoulder-shao2003", "shoulder_r", "shoulder.svg"), Picture("shoulder.svg")],
        beside: "Rotations, cone, two compensations, dependencies of clavicle and scapula on the arm, and the scapula's constraint, wired as in the paper's three parts.",
    },
    Item {
        name: "Plate 1",
        shows: "The knee driven by one coordinate, with its moving centre.",
        steps: &[
            Run(
                &[
                    "render",
                    "human",
                    "--pose",
                    "docs/pictures/knee.json",
                    "--view",
                    "side",
                    "--at",
                    "knee_r",
                    "--zoom",
                    "5",
                    "--show",
                    "bones,centres",
                    "--size",
                    "1200x360",
                    "-o",
                    "OUT/knee.png",
                ],
                0,
            ),
            Picture("knee.png"),
        ],
        beside: "The paper prints no centres. Those here are of the published knee that docs/shipped-models.md names.",
    },
    Item {
        name: "Plates 2 to 5",
        shows: "Lateral bending with the rib cage, flexion of the neck, the lumbar region, and extreme abduction of the arm.",
        steps: &[Manual("spine.png"), Manual("neck.png"), Manual("lumbar.png"), Manual("arm.png")],
        beside: "On our own human: its ranges are of the sources in docs/shipped-models.md, not of the paper, which prints none.",
    },
];
