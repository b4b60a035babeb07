//! `condyle pose`.

use super::{Folder, leg, near, number};

/// The goal that the ankle marker is where it is with these angles.
fn ankle(h: f64, k: f64) -> String {
    let [x, y] = leg::marker(5, h, k);
    format!("condyle = 1\nkind = \"goals\"\n[point.ankle]\npoint = \"ANKLE\"\nat = [{x}, {y}, 0]\n")
}

#[test]
fn a_pose_is_found_and_written() {
    let folder = Folder::with_leg("pose");
    folder.write("goals.toml", ankle(0.2, -0.8));
    let answer = folder.condyle(&["pose", "leg.osim", "goals.toml", "--json"]).json();
    assert_eq!(answer["met"], true);
    assert_eq!(answer["goals"][0]["name"], "ankle");
    assert!(number(&answer["goals"][0]["off_m"]) < 1e-9);
    // Two angles and two numbers of the place; the knee's range is not enforced, and the other knee is
    // farther from rest.
    near(number(&answer["coordinates"]["hip_flexion"]), 0.2, 1e-9);
    near(number(&answer["coordinates"]["knee_angle"]), -0.8, 1e-9);
    near(number(&answer["coordinates"]["knee_slide"]), -0.016, 1e-9);
    assert_eq!(answer["by"]["hip_flexion"], "goals");
    assert_eq!(answer["by"]["knee_slide"], "follows");
    assert_eq!(answer["by"]["ankle/flexion"], "held");
    assert_eq!(answer["by"]["toe/flexion"], "rest");
    // The file is a pose for other commands, of the same bits.
    let run = folder.condyle(&["pose", "leg.osim", "goals.toml", "-o", "p.json"]);
    let text = run.expect(0);
    assert!(text.contains("point  ankle  met"), "{text}");
    let frames = folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]);
    assert_eq!(frames.err, "");
    let pose: serde_json::Value = serde_json::from_str(&folder.read("p.json")).expect("JSON");
    assert_eq!(pose["knee_angle"], answer["coordinates"]["knee_angle"]);
    assert!(pose.get("knee_slide").is_none(), "what follows is left out");
    // Near another pose the other knee is nearer.
    folder.write("rest.json", r#"{"hip_flexion": -0.6, "knee_angle": 0.8}"#);
    let other = ["pose", "leg.osim", "goals.toml", "--rest", "rest.json", "--json"];
    let other = folder.condyle(&other).json();
    assert!(number(&other["coordinates"]["knee_angle"]) > 0.5, "{other}");
    // On standard output there is the pose alone.
    let run = folder.condyle(&["pose", "leg.osim", "goals.toml", "-o", "-"]);
    assert_eq!(run.expect(0), folder.read("p.json"));
}

#[test]
fn goals_out_of_reach_say_by_how_much() {
    let folder = Folder::with_leg("pose-far");
    // Straight down from the hip, with a knee that stays straight: the marker is √(0.8² + 0.02²) m from it.
    let text = "condyle = 1\nkind = \"goals\"\nhold = \"knee_angle\"\n[point.far]\npoint = \"ANKLE\"\n\
                at = [0, -1, 0]\n";
    folder.write("goals.toml", text);
    let run = folder.condyle(&["pose", "leg.osim", "goals.toml"]);
    let text = run.expect(1);
    let missed = text.split("missed by ").nth(1).and_then(|t| t.split(" mm").next());
    let missed: f64 = missed.and_then(|t| t.parse().ok()).unwrap_or_else(|| panic!("{text}"));
    near(missed, 2000.0 - 1e3 * (0.64f64 + 0.0004).sqrt(), 1e-3);
    let answer = folder.condyle(&["pose", "leg.osim", "goals.toml", "--json"]);
    assert!(answer.expect(1).contains("\"met\":false"));
}

#[test]
fn unusable_goals_are_refused_with_their_places() {
    let folder = Folder::with_leg("pose-bad");
    folder.write("goals.toml", ankle(0.0, 0.0).replace("ANKLE", "ANKEL"));
    let said = folder.condyle(&["pose", "leg.osim", "goals.toml"]).refused();
    assert!(said.contains("goals.toml:4:9"), "{said}");
    assert!(
        said.contains("unknown marker `ANKEL`") && said.contains("did you mean `ANKLE`?"),
        "{said}"
    );
    folder.write("goals.toml", ankle(0.0, 0.0).replace("[point.", "[piont."));
    let said = folder.condyle(&["pose", "leg.osim", "goals.toml"]).refused();
    assert!(
        said.contains("unknown key `piont`") && said.contains("did you mean `point`?"),
        "{said}"
    );
    folder.write("two.json", "[{}, {}]");
    folder.write("goals.toml", ankle(0.0, 0.0));
    let run = ["pose", "leg.osim", "goals.toml", "--rest", "two.json"];
    assert!(folder.condyle(&run).refused().contains("two.json: the file holds 2 poses: give one"));
    let run = ["pose", "leg.osim", "goals.toml", "--json", "-o", "-"];
    assert!(folder.condyle(&run).refused().contains("give one of them"));
    folder.condyle(&["pose", "leg.osim", "leg.osim"]).refused();
}
