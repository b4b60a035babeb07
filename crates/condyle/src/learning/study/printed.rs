//! The numbers that Pronost, Sandholm & Thalmann 2010 print, and what is wrong with them.

/// Table 1: of T_x, T_y and T_z the coefficients c1 to c4 of six subjects, crouches; metres per radian, and metres. Which angle has which
/// index is not said for the numbers: by the text the third is about the axis of flexion, by their constancy over subjects the second.
pub(super) const TABLE_1: [[[f64; 6]; 4]; 3] = [
    [
        [0.0573, 0.1142, 0.0496, 0.0322, -0.0007, 0.0404],
        [0.0361, 0.0340, 0.0470, 0.0328, 0.0348, 0.0351],
        [0.0582, 0.3426, 0.0788, 0.1105, -0.0297, 0.0203],
        [0.0748, 0.0691, 0.0783, 0.0637, 0.0713, 0.0878],
    ],
    [
        [0.0306, 0.0501, 0.0657, 0.0613, 0.1460, 0.1001],
        [-0.0442, -0.0366, -0.0364, -0.0143, -0.0260, -0.0585],
        [-0.1055, -0.1093, 0.0330, 0.0044, 0.1869, 0.2011],
        [-0.5035, -0.4274, -0.4920, -0.4662, -0.5105, -0.5310],
    ],
    [
        [-0.0199, -0.0100, 0.0362, -0.0536, 0.0000, -0.0586],
        [0.0210, 0.0515, 0.0116, 0.0376, 0.0148, 0.0277],
        [-0.2218, -0.1856, 0.0142, -0.2319, -0.0292, -0.3299],
        [0.0346, 0.0414, 0.0318, 0.0260, 0.0292, 0.0347],
    ],
];

/// Table 2: mean deviations in mm, crouch by one law and by a law for each variety, gait by one law.
pub(super) const TABLE_2: [[f64; 3]; 6] = [
    [1.3, 1.1, 1.1],
    [2.0, 1.4, 0.9],
    [0.9, 0.7, 1.5],
    [1.1, 0.9, 1.7],
    [1.6, 1.0, 3.1],
    [1.0, 0.8, 1.0],
];

/// The text beside Table 3: per cent by which the sum of errors is less with three rotations and a learned centre than with a hinge and than
/// with the planar knee, mean and deviation over subjects; gait, then crouch.
pub(super) const LESS: [[(f64, f64); 2]; 2] =
    [[(44.0, 8.0), (31.0, 5.0)], [(71.0, 9.0), (66.0, 6.0)]];

/// Table 3: hinge, planar, learned; gait, then crouch. Sums over frames of RMS distances in metres, subject 1.
pub(super) const TABLE_3: [[f64; 3]; 2] = [[3.02, 2.48, 1.19], [272.94, 261.46, 76.34]];

/// Table 4, its rows put right: gait, then crouch; the subject's own law, and one scaled from another.
pub(super) const TABLE_4: [[f64; 2]; 2] = [[1.19, 2.10], [76.34, 87.35]];

/// Table 5: gaits by laws of gait and of crouch; crouches by both.
pub(super) const TABLE_5: [[f64; 2]; 2] = [[1.19, 1.68], [130.34, 76.34]];

/// What is wrong with them.
pub(super) const ERRORS: [&str; 8] = [
    "Table 3 and the text do not match: subject 1 has 1.19 m for 3.02 and 2.48, which is 61 % and 52 % less, while the text has 44 ± 8 and 31 ± 5 % over \
     subjects. Crouch (72 and 71 %) is within a deviation of the text.",
    "The two rows of Table 4 are swapped: 76.34 m is the crouch of Table 3, 1.19 m the gait.",
    "The conclusion has 53 to 80 % for what the text has 31 to 71 %, and 25 to 41 % for scaled laws, where Tables 3 and 4 give 15 % (gait: 2.10 m for 2.48) and 67 % \
     (crouch: 87.35 for 261.46) against the planar knee.",
    "That laws for varieties deviate 26 % less is 25.3 % by the means of Table 2 (1.32 to 0.98 mm) and 23.9 % as the mean over subjects.",
    "Sums over frames are not divided by their number. 76 m of one crouch are 8 cm for each of 1000 frames, which no knee that deviates by 1.3 mm leaves; per frame, with its number of \
     frames, is what is told here.",
    "Three rotations with a moving centre are compared with one rotation; what three rotations gain with a centre that does not move is not told. That arm is added here.",
    "The validity test max|M·C - E| < min(E) says nothing: T_y is about -0.5 m, so that it never holds with its sign, and always with |E|, of any law.",
    "By the text the third angle is about the axis of flexion. Of the coefficients only c2 is nearly the same in all subjects, as that of the one angle which \
     moves by radians has to be: the tables have another order than the text.",
];
