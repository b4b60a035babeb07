//! `condyle upkeep`.

use super::{Folder, leg};

/// Two markers at 100 Hz; the second is missing in two frames.
fn trial() -> String {
    let mut text = String::from(
        "PathFileType\t4\t(X/Y/Z)\ta.trc\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
         100\t100\t40\t2\tmm\t100\t1\t40\n\
         Frame#\tTime\tA\t\t\tB\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n",
    );
    for frame in 0..40 {
        let second =
            if [12, 13].contains(&frame) { "\t\t".into() } else { format!("{frame}\t20\t1500") };
        let time = f64::from(frame) / 100.0;
        text += &format!("{}\t{time}\t100\t200\t{}\t{second}\n", frame + 1, 1000 + frame);
    }
    text
}

#[test]
fn what_was_done_is_said_and_in_the_header() {
    let folder = Folder::new("upkeep-recording");
    folder.write("a.trc", trial());
    let asked =
        ["upkeep", "a.trc", "b.trc", "--axes", "x,z,-y", "--fill", "0.05", "--crop", "0.1:0.19"];
    let run = folder.condyle(&asked);
    let steps = [
        "turned axes: x, y, z are the former x, z, -y",
        "filled 1 gap of up to 0.05 s, 2 values",
        "cut to 10 rows of 40, from 0.1 to 0.19 s",
    ];
    for step in steps {
        assert!(run.err.contains(step), "{}", run.err);
    }
    assert_eq!(run.expect(0), "");
    let text = folder.read("b.trc");
    let first = text.lines().next().expect("a line");
    assert_eq!(first, format!("PathFileType\t4\t(X/Y/Z)\tb.trc\t{}", steps.join("\t")));
    // Frame 12 of the line that B moves on: (12, 20, 1500) in old axes.
    let row = text.lines().find(|line| line.starts_with("3\t0.12\t")).expect("a row");
    let cells: Vec<f64> = row.split('\t').map(|cell| cell.parse().expect("a number")).collect();
    let expected = [3.0, 0.12, 100.0, 1012.0, -200.0, 12.0, 1500.0, -20.0];
    assert!(cells.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{row}");
    // It is read again as any other.
    assert!(folder.condyle(&["info", "b.trc"]).expect(0).contains("10 frames"));
}

#[test]
fn speeds_of_markers_are_a_table() {
    let folder = Folder::new("upkeep-speed");
    folder.write("a.trc", trial());
    let refused = folder.condyle(&["upkeep", "a.trc", "b.trc", "--differentiate"]).refused();
    assert!(refused.contains("a motion is not written as .trc"), "{refused}");
    folder.condyle(&["upkeep", "a.trc", "v.csv", "--differentiate"]).expect(0);
    let text = folder.read("v.csv");
    assert!(text.contains("# upkeep=differentiated: values are per second"), "{text}");
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("0.05,")).collect();
    assert!(text.starts_with("# Units=m/s\n"), "{text}");
    // A rises 1 mm a frame along z, which is 0.1 m/s; B goes along x.
    let cells: Vec<f64> = rows[0].split(',').map(|cell| cell.parse().expect("a number")).collect();
    let expected = [0.05, 0.0, 0.0, 0.1, 0.1, 0.0, 0.0];
    assert!(cells.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{}", rows[0]);
}

#[test]
fn motions_keep_their_unit_and_tell() {
    let folder = Folder::with_leg("upkeep-motion");
    folder.write("m.mot", leg::mot(60));
    folder.condyle(&["upkeep", "m.mot", "f.sto", "--lowpass", "6", "--resample", "50"]).expect(0);
    let text = folder.read("f.sto");
    let head = text.split("endheader").next().expect("a header");
    assert!(head.contains("upkeep=low-passed at 6 Hz (Butterworth"), "{head}");
    assert!(head.contains("upkeep=resampled from 100 to 50 rows a second, 30 rows"), "{head}");
    assert!(head.contains("inDegrees=yes"), "{head}");
    // It still is a motion of the model.
    folder.condyle(&["fk", "leg.osim", "--motion", "f.sto", "-o", "x.csv"]).expect(0);
    let again = folder.condyle(&["upkeep", "f.sto", "g.csv", "--crop", ":0.1"]);
    assert_eq!(again.code, 0, "{}", again.err);
    // What was done before is kept.
    let text = folder.read("g.csv");
    assert_eq!(text.lines().filter(|line| line.starts_with("# upkeep=")).count(), 3, "{text}");
}

#[test]
fn what_cannot_be_done_is_refused() {
    let folder = Folder::with_leg("upkeep-refused");
    folder.write("m.mot", leg::mot(60));
    for (asked, said) in [
        (vec![], "nothing is asked for"),
        (vec!["--lowpass", "60"], "below 50 Hz"),
        (vec!["--axes", "x,z,y"], "mirror image"),
        (vec!["--axes", "x,z,-y"], "only marker recordings have axes"),
        (vec!["--crop", "7:8"], "no row is between 7 and 8 s"),
        (vec!["--crop", "8"], "a colon between"),
    ] {
        let mut arguments = vec!["upkeep", "m.mot", "f.mot"];
        arguments.extend(asked);
        let refused = folder.condyle(&arguments).refused();
        assert!(refused.contains(said), "{refused}");
    }
}
