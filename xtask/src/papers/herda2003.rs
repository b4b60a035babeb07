//! Figures 5 to 17 of Herda et al. 2003.

use super::Item;
use super::Step::{Cargo, File, Manual, Picture, Run};

/// An upper arm that the learned limit holds.
const HELD: &str = r#"condyle = 1
kind = "model"
name = "upper arm"

[segment.thorax]
[segment.humerus]
parent = "thorax"
[segment.elbow]
parent = "humerus"
at = [0, -0.3, 0]

[joint_set.shoulder.coordinate.rotation]
kind = "orientation"
[joint_set.shoulder.component.held.field]
orientation = "rotation"
file = "shoulder.toml"
[joint_set.shoulder.component.turn.ball]
orientation = "held"
[joint_set.shoulder.output]
humerus = "turn"
"#;

pub(super) const ITEMS: &[Item] = &[
    Item {
        name: "Figures 5 and 6",
        shows: "Rotations of an upper arm from recordings, and the boundary of what is possible: the directions that the arm reaches, coloured by how far it can twist there.",
        steps: &[
            Run(
                &[
                    "learn",
                    "limits",
                    "DATA/shoulder/cmu01/01_03.amc",
                    "DATA/shoulder/cmu01/01_12.amc",
                    "--joint",
                    "rhumerus",
                    "-o",
                    "OUT/shoulder.toml",
                ],
                20,
            ),
            Run(
                &[
                    "limits",
                    "mesh",
                    "OUT/shoulder.toml",
                    "--space",
                    "quaternion",
                    "-o",
                    "OUT/quaternions.glb",
                ],
                4,
            ),
            File("held.toml", HELD),
            Run(
                &[
                    "render",
                    "OUT/held.toml",
                    "--show",
                    "bones,limits",
                    "--view",
                    "front",
                    "--view",
                    "35,20",
                    "--view",
                    "back",
                    "--size",
                    "1100x420",
                    "-o",
                    "OUT/held.png",
                ],
                0,
            ),
            Picture("held.png"),
        ],
        beside: "The paper's actor moves one shoulder through its range for minutes; these are takes of climbing and swinging from the CMU database, so that the volume is smaller. The surface is that of the \
                 signed field, not of the paper's primitives; quaternions.glb beside this page is it in the paper's space of quaternions.",
    },
    Item {
        name: "Figures 7 and 12",
        shows: "Histograms: radii in one solid angle, and field values of the method on the subject it was fitted to and on another.",
        steps: &[Manual("limits-radii.png"), Manual("limits-values.png")],
        beside: "Two subjects coincide in the paper's Figure 12 by eye; here 81 % of the training subject's frames and 53 % of the other's have F at least 1: they do not (docs/learned-limits.md).",
    },
    Item {
        name: "Figures 8 to 11",
        shows: "Surface points, splitting, and objects rebuilt from five primitives: all readings of the method on one cloud, error and accuracy against the number of primitives.",
        steps: &[Cargo(
            &["run", "--release", "--quiet", "-p", "condyle-learn", "--example", "herda2003"],
            60,
        )],
        beside: "Two objects of five primitives come back with F = 1 at their surface points within 0.05 on average, as in the paper's histogram. The energy sees surface points only: it falls while the inside empties.",
    },
    Item {
        name: "Figure 13",
        shows: "An arm through the thorax, before and after.",
        steps: &[Manual("through-thorax.png"), Manual("through-thorax-legal.png")],
        beside: "The paper's motion is not published; this one is made in its manner.",
    },
    Item {
        name: "Figure 14",
        shows: "An arm too far back, before and after.",
        steps: &[Manual("too-far-back.png"), Manual("too-far-back-legal.png")],
        beside: "As Figure 13.",
    },
    Item {
        name: "Figure 15",
        shows: "The closest valid orientation: of rotations outside, how far they are from the boundary and where they are put.",
        steps: &[
            Run(&["limits", "report", "OUT/shoulder.toml"], 40),
            Cargo(&["test", "--release", "--quiet", "-p", "condyle-learn", "--test", "field"], 6),
        ],
        beside: "The paper steps along the gradient of a field that is exactly 0 beyond 0.4 quaternion units, where it stays; ours is alive everywhere, and the tests hold its projection against 1e5 points of the boundary. Needs Figure 6.",
    },
    Item {
        name: "Figure 16",
        shows: "A hole in the cloud: allowed by the paper's method, unknown by ours.",
        steps: &[
            Cargo(
                &[
                    "test",
                    "--release",
                    "--quiet",
                    "-p",
                    "condyle-learn",
                    "--test",
                    "herda2003",
                    "a_hole_in_the_data_is_covered",
                ],
                3,
            ),
            Cargo(
                &[
                    "test",
                    "--release",
                    "--quiet",
                    "-p",
                    "condyle-learn",
                    "--test",
                    "field",
                    "the_middle_of_a_removed_ball",
                ],
                3,
            ),
        ],
        beside: "The paper reports the failure; the test reproduces it with the paper's method and finds the hole with ours.",
    },
    Item {
        name: "Figure 17",
        shows: "Tracking an arm from three markers with and without the limit.",
        steps: &[],
        beside: "The paper's images are out of scope. The experiment on named recordings is in docs/learned-limits.md, \"An arm from three markers\", made by oracles/limits/arm.py: impossible twists in 19 of 5190 frames without, 3 with.",
    },
];
