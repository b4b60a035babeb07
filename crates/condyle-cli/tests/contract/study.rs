//! `condyle learn study`.

use super::Folder;

/// A quick study of two people: all files are there, the first person's slope of flexion in crouches is 35 mm/rad as it was made, and the
/// recordings that are written are those that the commands of a user take.
#[test]
fn a_study_is_written_and_its_trials_can_be_learned_from() {
    let folder = Folder::new("study");
    let quick = ["learn", "study", "--quick", "--subjects", "1", "--trials", "-o", "out"];
    let said = folder.condyle(&quick).expect(0);
    assert!(said.contains("study.md"), "{said}");
    let csv = folder.read("out/table1.csv");
    let mut rows = csv.lines();
    let head: Vec<&str> = rows.next().expect("a head").split(',').collect();
    // Names hold commas in quotes; those before flexion do not.
    assert_eq!(&head[..3], ["person", "markers", "place"]);
    let first: Vec<&str> = rows.next().expect("a row").split(',').collect();
    let [slope, truth] = [3, 6].map(|cell| first[cell].parse::<f64>().expect("a number"));
    assert!((slope / 0.035 - 1.0).abs() < 0.1 && (truth / 0.035 - 1.0).abs() < 1e-9, "{first:?}");
    assert!(folder.read("out/study.md").contains("![Deviation"));
    for picture in ["out/figure3.png", "out/figure3-rigid.png"] {
        let bytes = std::fs::read(folder.path().join(picture)).expect("a picture");
        assert_eq!(&bytes[1..4], b"PNG");
    }
    // The same by hand.
    folder.condyle(&["learn", "joint", "out/trials/s1_standing.trc", "-o", "leg.toml"]).expect(0);
    let trial = |feet: &str| format!("out/trials/rigid/s1_crouch_{feet}_1.trc");
    let (a, b) = (trial("0"), trial("90"));
    let learn = ["learn", "coupling", &a, &b, "--model", "leg.toml", "--joint", "knee_r"];
    let to = ["-o", "knee.toml", "--report", "R.json"];
    folder.condyle(&[&learn[..], &to[..]].concat()).expect(0);
    let report: serde_json::Value = serde_json::from_str(&folder.read("R.json")).expect("JSON");
    let slope = report["laws"][0]["slopes"]["knee_r_flexion"].as_f64().expect("a slope");
    assert!((slope / 0.035 - 1.0).abs() < 0.1, "{slope}");
}

#[test]
fn results_need_a_folder() {
    let folder = Folder::new("study-file");
    folder.write("taken", "a file");
    let said = folder.condyle(&["learn", "study", "--quick", "-o", "taken"]).refused();
    assert!(said.contains("give a folder"), "{said}");
    let said = folder.condyle(&["learn", "study", "--subjects", "7", "-o", "out"]).refused();
    assert!(said.contains('7'), "{said}");
}
