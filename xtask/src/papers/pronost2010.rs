//! Tables 1 to 5 and Figures 3 to 5 of Pronost et al. 2010.

use super::Item;
use super::Step::{Cargo, Manual, Picture, Run};

pub(super) const ITEMS: &[Item] = &[
    Item {
        name: "Tables 1 to 5, Figure 3",
        shows: "The study remade with six virtual subjects whose true knees are known.",
        steps: &[Run(&["learn", "study", "-o", "OUT/study"], 60), Picture("study/figure3.png")],
        beside: "The tables with the paper's numbers and the errors in them stand in study/study.md beside this page.",
    },
    Item {
        name: "Figure 4",
        shows: "A law on another figure by three landmarks: the landmarks, gait and crouch.",
        steps: &[
            Manual("transfer-human-landmarks.png"),
            Manual("transfer-human-gait.png"),
            Manual("transfer-human-crouch.png"),
        ],
        beside: "The paper's character is not published; this is `human`. docs/transfer-figures.md has three more figures, and the commands.",
    },
    Item {
        name: "Figure 5",
        shows: "Screw and bolt, gears, bow compass: laws from markers, about axes that nobody was told.",
        steps: &[Cargo(&["test", "--quiet", "-p", "condyle", "--test", "learned", "machines"], 8)],
        beside: "The paper shows pictures; the tests hold pitch, ratio and all coefficients to 1e-9.",
    },
];
