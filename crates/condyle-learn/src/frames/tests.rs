use super::*;
use condyle_motion::Observed;

fn between(from: &str, to: &str) -> Direction {
    Direction::Between { from: from.into(), to: to.into() }
}

fn normal(points: [&str; 3]) -> Direction {
    Direction::Normal { points: points.map(str::to_owned) }
}

/// Markers that move as a thorax and a humerus with these orientations.
fn recording(poses: &[(Quat, Quat)]) -> Recording {
    let thorax = [
        ("C7", [-0.06, 0.10, 0.0]),
        ("T8", [-0.08, -0.15, 0.0]),
        ("IJ", [0.05, 0.06, 0.0]),
        ("PX", [0.08, -0.11, 0.0]),
    ];
    let humerus = [("GH", [0.0, 0.0, 0.0]), ("EL", [0.0, -0.3, 0.04]), ("EM", [0.0, -0.3, -0.04])];
    let mut positions = vec![];
    for (of_thorax, of_humerus) in poses {
        let chest = Vec3::new(0.3, 1.3, -0.2);
        for (_, at) in thorax {
            positions.push(chest + of_thorax.to_mat3() * Vec3::from(at));
        }
        let shoulder = chest + of_thorax.to_mat3() * Vec3::new(0.0, 0.1, 0.18);
        for (_, at) in humerus {
            positions.push(shoulder + of_humerus.to_mat3() * Vec3::from(at));
        }
    }
    Recording {
        labels: thorax.iter().chain(&humerus).map(|(name, _)| format!("Ann:{name}")).collect(),
        times: (0..poses.len()).map(|i| i as f64).collect(),
        positions: positions.into_iter().map(|p| Observed::from(p.to_array())).collect(),
        rate: 1.0,
        ..Recording::default()
    }
}

/// The frames of Wu et al. 2005: thorax, and humerus by its first option.
fn wu2005() -> Recipe {
    let point = |name: &str, markers: &[&str]| Place {
        name: name.into(),
        markers: markers.iter().map(|m| (*m).to_owned()).collect(),
    };
    Recipe {
        points: vec![
            point("low", &["PX", "T8"]),
            point("high", &["IJ", "C7"]),
            point("E", &["EL", "EM"]),
        ],
        child: FrameRecipe {
            name: "humerus".into(),
            kept: (Axis::Y, between("E", "GH")),
            second: (Axis::X, normal(["GH", "EL", "EM"])),
        },
        reference: Some(FrameRecipe {
            name: "thorax".into(),
            kept: (Axis::Y, between("low", "high")),
            second: (Axis::Z, normal(["IJ", "C7", "low"])),
        }),
        ..Recipe::default()
    }
}

#[test]
fn rotations_are_those_of_the_humerus_in_the_thorax() {
    let turn = |x, y, z| Quat::exp(Vec3::new(x, y, z));
    let poses = [
        (turn(0.0, 0.0, 0.0), turn(0.0, 0.0, 0.0)),
        (turn(0.4, -0.9, 0.2), turn(1.1, 0.3, -0.7)),
        (turn(-2.0, 1.0, 0.5), turn(0.2, 2.5, 0.9)),
    ];
    let found = wu2005().rotations(&recording(&poses)).unwrap();
    // The thorax of these markers leans by a fixed angle in the marker frame; taken out by the first pose.
    let lean = found.rotations[0];
    for ((thorax, humerus), rotation) in poses.into_iter().zip(&found.rotations) {
        let expected = lean * (thorax.conjugate() * humerus);
        assert!(rotation.angle_to(expected) < 1e-12, "{rotation:?}");
    }
    // Only about z, since all markers of the trunk are in one plane: from the mean of PX and T8 to that of IJ and C7.
    let expected = ((-0.005f64 - 0.0) / (0.08 + 0.13)).atan();
    let axis = lean.log();
    assert!(
        axis.x.abs() < 1e-12
            && axis.y.abs() < 1e-12
            && (axis.z.abs() - expected.abs()).abs() < 1e-12
    );
}

#[test]
fn straight_arms_and_missing_markers_are_left_out_and_counted() {
    let mut trial = recording(&[(Quat::IDENTITY, Quat::IDENTITY); 4]);
    // In frame 1 the inner epicondyle lies on the line from shoulder to the outer one; in frame 2 it is missing.
    let width = trial.labels.len();
    let [gh, el] = [4, 5].map(|marker| Vec3::from(trial.position(1, marker).unwrap()));
    trial.positions[width + 6] = Observed::from((gh + (el - gh) * 0.5).to_array());
    trial.positions[2 * width + 6] = Observed::MISSING;
    let found = wu2005().rotations(&trial).unwrap();
    assert_eq!(
        (found.frames.as_slice(), found.missing, found.ill_conditioned),
        (&[0, 3][..], 1, 1)
    );
    // Frames without a marker, ill-conditioned ones, and labels that have a subject.
    assert_eq!(found.warnings().len(), 3);
}

#[test]
fn axes_may_be_named_in_any_order() {
    // However the two axes are chosen, a frame built from a segment's own axes is that segment's.
    let turn = Quat::exp(Vec3::new(0.5, -1.2, 0.8));
    let ends =
        [("O", [0.0; 3]), ("X", [1.0, 0.0, 0.0]), ("Y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0])];
    let trial = Recording {
        labels: ends.iter().map(|(name, _)| (*name).to_owned()).collect(),
        times: vec![0.0],
        positions: ends
            .iter()
            .map(|(_, at)| Observed::from((turn.to_mat3() * Vec3::from(*at)).to_array()))
            .collect(),
        ..Recording::default()
    };
    let axes = [(Axis::X, "X"), (Axis::Y, "Y"), (Axis::Z, "Z")];
    for kept in axes {
        for second in axes.into_iter().filter(|axis| *axis != kept) {
            let child = FrameRecipe {
                name: "it".into(),
                kept: (kept.0, between("O", kept.1)),
                second: (second.0, between("O", second.1)),
            };
            let found = Recipe { child, ..Recipe::default() }.rotations(&trial).unwrap();
            assert!(found.rotations[0].angle_to(turn) < 1e-12);
        }
    }
}

#[test]
fn markers_that_are_not_there_are_named() {
    let mut recipe = wu2005();
    recipe.child.kept.1 = between("E", "GHH");
    let error = recipe.rotations(&recording(&[(Quat::IDENTITY, Quat::IDENTITY)])).unwrap_err();
    assert!(error.to_string().contains("no marker `GHH`"), "{error}");
}
