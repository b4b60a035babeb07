//! Damaged, wrong and hostile files: each gets a clear sentence with a place and a remedy, quickly.

#[path = "../command/mod.rs"]
mod command;
#[cfg(target_os = "linux")]
mod huge;
#[path = "../contract/leg.rs"]
mod leg;

use command::Folder;

/// A file that cannot be used: its name, its content, and what is said after `error: `.
type Refused<'a> = (&'a str, String, &'a str);

#[track_caller]
fn all_refused(folder: &Folder, files: &[Refused<'_>]) {
    for (name, content, said) in files {
        let run = folder.write(name, content).condyle(&["info", name]);
        assert_eq!((run.code, run.out.len()), (2, 0), "{name}: {}", run.err);
        let expected = format!("error: {name}:{said}\n");
        assert!(run.err.ends_with(&expected), "expected {expected}found {}", run.err);
    }
}

/// Files that can be used, each with what is said after `warning: `.
#[track_caller]
fn all_warned(folder: &Folder, files: &[Refused<'_>]) {
    for (name, content, said) in files {
        let run = folder.write(name, content).condyle(&["info", name]);
        assert_eq!(run.code, 0, "{name}: {}", run.err);
        assert!(!run.out.is_empty(), "{name}");
        let expected = format!("warning: {name}:{said}\n");
        assert!(run.err.contains(&expected), "expected {expected}found {}", run.err);
    }
}

/// The first lines of a text.
fn head(text: &str, lines: usize) -> String {
    text.lines().take(lines).map(|line| format!("{line}\n")).collect()
}

#[test]
fn models() {
    let folder = Folder::new("bad-models");
    let with = |from: &str, to: &str| {
        let (text, leg) = (leg::osim().replace(from, to), leg::osim());
        assert_ne!(text, leg, "{from}");
        text
    };
    all_refused(
        &folder,
        &[
            ("empty.osim", String::new(), "1: there is no element (this is not an XML file)"),
            (
                "truncated.osim",
                head(&leg::osim(), 7),
                "7: the outermost element is never closed (the file ends here; was it cut off?)",
            ),
            (
                "cut.osim",
                leg::osim()[..60].to_owned(),
                "2: the text ends inside a tag (the file ends here; was it cut off?)",
            ),
            (
                "count.osim",
                with("<axis>0 0 1</axis>", "<axis>0 0</axis>"),
                "7:357: <axis> holds 2 numbers (expected 3)",
            ),
            (
                "range.osim",
                with("<range>-1.5 2</range>", "<range>-1.5</range>"),
                "6:173: <range> holds 1 numbers (expected 2)",
            ),
            (
                "twice.osim",
                with("<Body name=\"foot\"/>", "<Body name=\"foot\"/>\n<Body name=\"foot\"/>"),
                "5:1: two bodies are named `foot` (give each body a name of its own)",
            ),
            (
                "axis.osim",
                with("<axis>0 0 1</axis>", "<axis>0 NaN 1</axis>"),
                "7:357: <axis> of <TransformAxis name=\"rotation1\"> is not finite (give three \
                 numbers that are neither NaN nor infinite)",
            ),
            (
                "default.osim",
                with("<default_value>0.1<", "<default_value>nan<"),
                "8:145: the default of <Coordinate name=\"flexion\"> is not finite (give a number)",
            ),
            (
                "location.osim",
                with("<location>0.05 0 0<", "<location>0.05 0 inf<"),
                "13:77: <location> of <Marker name=\"HIP\"> is not finite (give three numbers that \
                 are neither NaN nor infinite)",
            ),
            (
                "word.osim",
                with("<range>-1.5 2</range>", "<range>-1.5 two</range>"),
                "6:173: `two` in <range> is not a number (expected numbers separated by spaces)",
            ),
            (
                "frames.osim",
                with("<socket_parent>/ground<", "<socket_parent>hip_place<"),
                "6:22: frame `hip_place` is not attached to a body (is it its own ancestor? \
                 attach one of its ancestors to a body)",
            ),
            (
                "unknown.osim",
                with("<socket_parent>/bodyset/thigh<", "<socket_parent>/bodyset/tigh<"),
                "7:725: <PhysicalOffsetFrame name=\"knee_place\"> names no frame: `/bodyset/tigh` \
                 (did you mean `/bodyset/thigh`?)",
            ),
            (
                "deep.osim",
                "<a>".repeat(10_000),
                "1:769: elements are nested more than 256 deep (no model or setup file needs that; \
                 is the file damaged?)",
            ),
            (
                "entity.osim",
                "<!DOCTYPE a>\n<a/>".to_owned(),
                "1:1: the file has a document type declaration (remove `<!DOCTYPE ...>`; entities \
                 are not expanded)",
            ),
            (
                "many.osim",
                format!("<Model><BodySet>\n{}</BodySet></Model>", "<Body/>".repeat(2)),
                "2:8: two bodies are named `` (give each body a name of its own)",
            ),
        ],
    );
    all_warned(
        &folder,
        &[
            (
                "unit.osim",
                with("<range>-1.5 2</range>", "<range>-90 120</range>"),
                "6:142: the range of `hip_flexion` reaches 120 radians (is it in degrees? the \
                 file's angles must be in radians)",
            ),
            (
                "marker.osim",
                with("\"SHIN\"", "\"TIBIA\""),
                "17:1: a second marker is named `TIBIA` (the first one is used)",
            ),
            (
                "joint.osim",
                with("<PinJoint name=\"toe\"", "<PinJoint name=\"ankle\""),
                "9:1: a second joint is named `ankle` (it is read as `ankle_0`)",
            ),
        ],
    );
}

#[test]
fn bodies_and_couplers_in_a_circle() {
    let folder = Folder::new("bad-circles");
    // Thigh on toes, toes on thigh: no body stands on the ground.
    let bodies = leg::osim().replace("<socket_parent>/ground<", "<socket_parent>/bodyset/toes<");
    let run = folder.write("bodies.osim", bodies).condyle(&["info", "bodies.osim", "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    for said in ["bodies.osim:4:19: <Body name=\"thigh\"> is not connected", "closes"] {
        assert!(run.err.contains(said), "{}", run.err);
    }
    let json: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
    assert_eq!(json["closures"][0]["kind"], "frames");
    // The knee follows its slide, which follows the knee.
    let coupler = "<CoordinateCouplerConstraint name=\"back\"><coupled_coordinates_function>\
                   <LinearFunction><coefficients>50 0</coefficients></LinearFunction>\
                   </coupled_coordinates_function><independent_coordinate_names>knee_slide\
                   </independent_coordinate_names><dependent_coordinate_name>knee_angle\
                   </dependent_coordinate_name></CoordinateCouplerConstraint>\n</objects></ConstraintSet>";
    let text = leg::osim().replace("</objects></ConstraintSet>", coupler);
    let run = folder.write("couplers.osim", text).condyle(&["info", "couplers.osim", "--json"]);
    assert!(run.err.starts_with("warning: couplers.osim:11:"), "{}", run.err);
    assert!(run.err.contains("closes a circle of couplers"), "{}", run.err);
    let json: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
    assert_eq!(json["closures"][0]["kind"], "coupling");
    assert_eq!(json["closures"][0]["follower"], "knee_angle");
}

#[test]
fn recordings() {
    let folder = Folder::new("bad-recordings");
    let whole = leg::trc(3, |_, _| true);
    let with = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        whole.replace(from, to)
    };
    all_refused(
        &folder,
        &[
            (
                "empty.trc",
                String::new(),
                "1: the file is empty (a TRC file starts with `PathFileType`)",
            ),
            (
                "other.trc",
                "hello\n".to_owned(),
                "1: the file does not start with `PathFileType` (this is not a TRC file)",
            ),
            (
                "header.trc",
                head(&whole, 3),
                "3: the file ends before the marker names (a line `Frame# Time name name ...` must \
                 follow the header's values)",
            ),
            (
                "names.trc",
                head(&whole, 6),
                "4: there are marker names, but no frames (rows of frame, time and positions must \
                 follow the names)",
            ),
            (
                "count.trc",
                with("\n1\t0\t", "\n1\t0\t7\t"),
                "7:151: the row has too many cells (expected at most 20 for 6 markers, found 21)",
            ),
            (
                "word.trc",
                with("\n1\t0\t50\t", "\n1\t0\tfifty\t"),
                "7:5: `fifty` is not a number (expected a coordinate of `HIP`; a missing value is a \
                 blank cell)",
            ),
            (
                "time.trc",
                with("\n2\t0.01\t", "\n2\tnan\t"),
                "8: the row has no time (write the seconds in the second cell)",
            ),
            (
                "back.trc",
                with("\n2\t0.01\t", "\n2\t9\t"),
                "9:3: time goes back from 9 s to 0.02 s (does the file hold two recordings? split \
                 it)",
            ),
        ],
    );
    all_warned(
        &folder,
        &[
            (
                "truncated.trc",
                whole[..whole.len() - 40].to_owned(),
                "9: the row ends early (expected 20 cells, found 17; markers missing at its end: 1)",
            ),
            (
                "unit.trc",
                with("\tmm\n", "\tm\n"),
                "3: the markers of a frame span 7.9759e2 m (is the unit `m` right?)",
            ),
            (
                "furlong.trc",
                with("\tmm\n", "\tfurlong\n"),
                "3: `furlong` is not a unit of length (write mm, cm, m, in or ft; guessed from the \
                 size of the data)",
            ),
            (
                "frames.trc",
                with("\t3\t6\t", "\t99\t6\t"),
                "3: NumFrames is 99, but 3 rows follow (the rows are used)",
            ),
            (
                "markers.trc",
                with("\t3\t6\t", "\t3\t7\t"),
                "4: NumMarkers is 7, but 6 names are given (the names are used)",
            ),
            (
                "twice.trc",
                with("SHIN", "TIBIA"),
                "4: two markers are called `TIBIA` (the later one is read as `TIBIA#2`)",
            ),
        ],
    );
    // NaN is how many programs say that a marker was not seen.
    folder.write("nan.trc", with("\n1\t0\t50\t", "\n1\t0\tNaN\t"));
    let run = folder.condyle(&["info", "nan.trc", "--json"]);
    assert_eq!(run.err, "");
    let json: serde_json::Value = serde_json::from_slice(&run.out).expect("JSON");
    assert_eq!(json["markers"][0]["missing_frames"], 1);
}

#[test]
fn motions() {
    let folder = Folder::new("bad-motions");
    let whole = leg::mot(3);
    let with = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        whole.replace(from, to)
    };
    all_refused(
        &folder,
        &[
            (
                "empty.mot",
                String::new(),
                "1: the file is empty (a motion starts with a header that ends with `endheader`)",
            ),
            (
                "header.mot",
                head(&whole, 3),
                "1: no line reads `endheader` (is this a motion? write `endheader` before the line \
                 of names)",
            ),
            (
                "names.mot",
                head(&whole, 4),
                "4: the file ends after `endheader` (a line of names must follow: `time` and one \
                 name for each column)",
            ),
            (
                "count.mot",
                with("\n0\t", "\n0\t1\t"),
                "6:7: the row has too many cells (expected 3, found 4)",
            ),
            (
                "time.mot",
                with("\n0\t0\t", "\nNaN\t0\t"),
                "6: the row has no time (write the seconds in the first cell)",
            ),
            (
                "word.mot",
                with("\n0\t0\t", "\n0\tzero\t"),
                "6:3: `zero` in column `hip_flexion` is not a number (expected a number; a missing \
                 value is a blank cell or `nan`)",
            ),
            (
                "back.mot",
                with("\n0\t0\t", "\n5\t0\t"),
                "7:1: time goes back from 5 s to 0.01 s (does the file hold two motions? split it)",
            ),
            (
                "binary.csv",
                "\0\x01\0\x02".repeat(100),
                "1: the name of column 1 has 400 letters or is binary (is this a table? the first \
                 line must name the columns)",
            ),
            (
                "empty.csv",
                String::new(),
                "1: there is no line of names (the first line must name the columns)",
            ),
        ],
    );
    all_warned(
        &folder,
        &[
            (
                "truncated.mot",
                whole[..whole.len() - 25].to_owned(),
                "8: the row ends early (expected 3 cells, found 2; the rest is NaN)",
            ),
            (
                "unit.mot",
                with("inDegrees=yes", "inDegrees=maybe"),
                "3: `inDegrees=maybe` (write `inDegrees=yes` or `inDegrees=no`; it was skipped)",
            ),
            (
                "both.mot",
                with("inDegrees=yes", "inDegrees=no\nAngles are in degrees"),
                "3: `inDegrees` means radians, the text states degrees (taken as radians)",
            ),
            (
                "columns.mot",
                with("version=1", "version=1\nnColumns=2"),
                "6: the header states 2 columns, but 3 are named (the names are used)",
            ),
            (
                "rows.mot",
                with("version=1", "version=1\nnRows=9"),
                "6: the header states 9 rows, but 3 follow (the rows are used)",
            ),
        ],
    );
    // A number that is none leaves the coordinate at its default, which is said.
    folder.write("nan.mot", with("\n0\t0\t", "\n0\tNaN\t")).write("leg.osim", leg::osim());
    let run = folder.condyle(&["fk", "leg.osim", "--motion", "nan.mot"]);
    assert_eq!(run.code, 0);
    let said =
        "warning: nan.mot: 1 cells hold no number (the coordinates keep their defaults there)";
    assert!(run.err.contains(said), "{}", run.err);
}

#[test]
fn setups() {
    let folder = Folder::new("bad-setups");
    let tool = |inside: &str| {
        format!(
            "<OpenSimDocument>\n<InverseKinematicsTool>\n{inside}\n</InverseKinematicsTool>\
             </OpenSimDocument>"
        )
    };
    let task = |name: &str, weight: &str| {
        format!("<IKMarkerTask name=\"{name}\">\n<weight>{weight}</weight></IKMarkerTask>")
    };
    let tasks = |inside: &str| tool(&format!("<IKTaskSet><objects>{inside}</objects></IKTaskSet>"));
    all_refused(
        &folder,
        &[
            ("empty.xml", String::new(), "1: there is no element (this is not an XML file)"),
            (
                "truncated.xml",
                head(&tool("<time_range>0 1</time_range>"), 3),
                "3: the outermost element is never closed (the file ends here; was it cut off?)",
            ),
            (
                "count.xml",
                tool("<time_range>0 1 2</time_range>"),
                "3:1: <time_range> holds 3 numbers (expected 2)",
            ),
            (
                "order.xml",
                tool("<time_range>2 1</time_range>"),
                "3:1: the time range `2 1` is reversed (write the earlier time first: `1 2`)",
            ),
            (
                "nan.xml",
                tasks(&task("A", "NaN")),
                "4:1: the weight NaN of <IKMarkerTask name=\"A\"> is not valid (a weight is 0 or \
                 more)",
            ),
            (
                "word.xml",
                tasks(&task("A", "heavy")),
                "4:1: `heavy` in <weight> is not a number (expected a number)",
            ),
            (
                "deep.xml",
                "<IKTaskSet>".repeat(10_000),
                "1:2817: elements are nested more than 256 deep (no model or setup file needs \
                 that; is the file damaged?)",
            ),
        ],
    );
    all_warned(
        &folder,
        &[
            (
                "twice.xml",
                tasks(&(task("A", "1") + &task("A", "2"))),
                "4:34: <IKMarkerTask name=\"A\"> repeats (the first of them is used)",
            ),
            (
                "typo.xml",
                tool("<time_rnage>0 1</time_rnage>"),
                "3:1: <time_rnage> is not known (it was skipped; did you mean <time_range>?)",
            ),
        ],
    );
}

#[test]
fn more_bodies_than_anybody_has() {
    let folder = Folder::new("bad-bodies");
    let bodies: String = (0..20_000).map(|i| format!("<Body name=\"b{i}\"/>\n")).collect();
    // Each of 4000 segments moves with the six coordinates of the free first one and with the
    // hinges before it: 6·4000 + 4000·3999/2.
    let joints: String = (1..4_000)
        .map(|i| {
            format!(
                "<PinJoint name=\"j{i}\"><socket_parent_frame>/bodyset/b{}</socket_parent_frame>\
                 <socket_child_frame>/bodyset/b{i}</socket_child_frame></PinJoint>\n",
                i - 1
            )
        })
        .collect();
    let model = |bodies: &str| {
        format!("<Model>\n<BodySet>\n{bodies}</BodySet><JointSet>\n{joints}</JointSet></Model>\n")
    };
    let chain: String = bodies.lines().take(4_000).collect();
    all_refused(
        &folder,
        &[
            (
                "many.osim",
                model(&bodies),
                "10003:1: <Body name=\"b10000\"> exceeds the number allowed (a model may have \
                 10000 of its kind; is the file damaged?)",
            ),
            (
                "chain.osim",
                model(&chain),
                "1:1: the model has 8022000 pairs of a segment and a direction of motion (at \
                 most 4000000 are allowed; use fewer bodies)",
            ),
        ],
    );
}
