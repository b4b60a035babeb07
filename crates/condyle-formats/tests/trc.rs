//! Every rule of the TRC reader, one small file each, and the round trip.

use condyle_formats::trc;
use condyle_formats::{Error, LengthUnit, Read, Recording};
use proptest::prelude::*;

/// A file of two markers `A` and `B` at 100 Hz in millimetres, with these rows.
fn with_rows(rows: &str) -> Result<Read<Recording>, Error> {
    trc::read(&format!(
        "PathFileType\t4\t(X/Y/Z)\tx.trc\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\n\
         100\t100\t1\t2\tmm\t100\n\
         Frame#\tTime\tA\t\t\tB\t\t\n\
         \t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\
         \n{rows}"
    ))
}

/// A file with these units, labels and row.
fn with(units: &str, labels: &str, axes: &str, rows: &str) -> Result<Read<Recording>, Error> {
    trc::read(&format!(
        "PathFileType\t4\t(X/Y/Z)\tx.trc\n\
         DataRate\tNumFrames\tNumMarkers\tUnits\n\
         100\t1\t2\t{units}\n\
         Frame#\tTime\t{labels}\n{axes}{rows}"
    ))
}

const AXES: &str = "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";
const ROW: &str = "1\t0\t100\t200\t300\t400\t500\t600\n";

fn codes(read: &Read<Recording>) -> Vec<&'static str> {
    read.warnings.iter().map(|w| w.code).collect()
}

#[test]
fn a_clean_file_has_no_warnings() {
    let read = with_rows(ROW).unwrap();
    assert_eq!(codes(&read), [""; 0]);
    let recording = read.value;
    assert_eq!(recording.labels, ["A", "B"]);
    assert_eq!(recording.rate, 100.0);
    assert_eq!(recording.times, [0.0]);
    assert_eq!(recording.units, LengthUnit::Millimetre);
    assert_eq!(recording.position(0, 1), Some([0.4, 0.5, 0.6]));
}

#[test]
fn missing_markers_are_blank_nan_or_infinite() {
    let read = with_rows(
        "1\t0.00\t\t\t\t400\t500\t600\n\
         2\t0.01\tNaN\tNAN\tnan\t400\t500\t600\n\
         3\t0.02\t1\t2\tInf\t400\t500\t600\n\
         4\t0.03\t1.#QNAN\t-1.#IND\t1\t400\t500\t600\n\
         5\t0.04\t100\t\t300\t400\t500\t600\n\
         6\t0.05\t0\t0\t0\t400\t500\t600\n",
    )
    .unwrap();
    let a: Vec<_> = (0..6).map(|frame| read.value.position(frame, 0)).collect();
    assert_eq!(a, [None, None, None, None, None, Some([0.0; 3])]);
    assert_eq!(read.value.gaps().len(), 1);
    assert_eq!(codes(&read), ["trc/part-blank", "trc/frame-count"]);
}

#[test]
fn labels_are_taken_by_order() {
    let axes = "\t\t\tX5\tY5\tZ5\tX9\tY9\tZ9\n";
    let read = with("m", "\tLASI\t\tR*60 knee\t\t\t\t", axes, ROW).unwrap();
    assert_eq!(read.value.labels, ["LASI", "R*60 knee"]);
    assert_eq!(read.value.position(0, 0), Some([100.0, 200.0, 300.0]));
}

#[test]
fn the_axis_line_may_be_missing() {
    let read = with("mm", "A\t\t\tB", "", ROW).unwrap();
    assert_eq!(read.value.position(0, 0), Some([0.1, 0.2, 0.3]));
    assert_eq!(codes(&read), [""; 0]);
}

#[test]
fn a_marker_without_a_name_keeps_its_place() {
    let axes = "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";
    let read = with("mm", "\t\t\tB", axes, ROW).unwrap();
    assert_eq!(read.value.labels, ["unnamed", "B"]);
    assert_eq!(codes(&read), ["trc/unnamed"]);
    // Where tab positions do not tell which it is, nothing is guessed.
    let error = with("mm", "\tB", axes, ROW).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 4: there are axes for 2 markers, but 1 names (name every marker)"
    );
}

#[test]
fn equal_names_are_told_apart() {
    let read = with("mm", "A\t\t\tA", AXES, ROW).unwrap();
    assert_eq!(read.value.labels, ["A", "A#2"]);
    assert_eq!(
        read.warnings[0].to_string(),
        "line 4: two markers are called `A` (the later one is read as `A#2`)"
    );
    let taken = with("mm", "A\t\t\tA\t\t\tA#2", "", "1\t0\t1\t2\t3\n").unwrap();
    assert_eq!(taken.value.labels, ["A", "A#3", "A#2"]);
}

#[test]
fn counts_in_the_header_do_not_rule() {
    let read = with_rows(&format!("{ROW}2\t0.01\t1\t2\t3\t4\t5\t6\n")).unwrap();
    assert_eq!(read.value.frames(), 2);
    assert_eq!(
        read.warnings[0].to_string(),
        "line 3: NumFrames is 1, but 2 rows follow (the rows are used)"
    );
    let read = with("mm", "A\t\t\tB\t\t\tC", "", "1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\n").unwrap();
    assert_eq!(
        read.warnings[0].to_string(),
        "line 4: NumMarkers is 2, but 3 names are given (the names are used)"
    );
}

#[test]
fn line_ends_and_trailing_tabs_do_not_matter() {
    let expected = with_rows(ROW).unwrap();
    for end in ["\r\n", "\r"] {
        let text = format!(
            "\u{feff}PathFileType\t4\t(X/Y/Z)\tx.trc\t\nDataRate\tCameraRate\tNumFrames\t\
             NumMarkers\tUnits\tOrigDataRate\t\t\n100\t100\t1\t2\t mm \t100\t\t\n\
             Frame#\tTime\tA\t\t\tB\t\t\t\t\t\n{AXES}\n{}\t\t\t\n",
            ROW.trim_end()
        );
        assert_eq!(trc::read(&text.replace('\n', end)).unwrap(), expected, "{end:?}");
    }
}

#[test]
fn spaces_separate_where_there_are_no_tabs() {
    let read = trc::read(
        "PathFileType 4 (X/Y/Z) x.trc\n\
         DataRate CameraRate NumFrames NumMarkers Units\n\
         50.0 50.0 2 2 cm\n\
         Frame# Time A B\n\
         X1 Y1 Z1 X2 Y2 Z2\n\
         1 0.00   10  20 30  40 50 60   \n\
         2 0.02   10  20 30\n",
    )
    .unwrap();
    assert_eq!(read.value.labels, ["A", "B"]);
    assert_eq!(read.value.position(0, 1), Some([0.4, 0.5, 0.6]));
    assert_eq!(read.value.position(1, 1), None);
    assert_eq!(codes(&read), ["trc/space-gaps", "trc/short-row"]);
}

#[test]
fn units_are_read_or_guessed() {
    for (unit, metres) in [("mm", 0.1), ("cm", 1.0), ("M", 100.0), ("inches", 2.54), ("ft", 30.48)]
    {
        let read = with(unit, "A", "", "1\t0\t100\t0\t0\n").unwrap();
        let x = read.value.position(0, 0).unwrap()[0];
        assert!((x - metres).abs() < 1e-12, "{unit}: {x}");
        assert!(!read.warned("trc/unit"), "{unit}");
    }
    // Two markers 1.7 m apart.
    for (distance, unit) in [("1700", LengthUnit::Millimetre), ("1.7", LengthUnit::Metre)] {
        for name in ["", "furlong", "100"] {
            let row = format!("1\t0\t0\t0\t0\t0\t{distance}\t0\n");
            let read = with(name, "A\t\t\tB", AXES, &row).unwrap();
            assert_eq!(read.value.units, unit, "{distance} {name}");
            assert!((read.value.extent().unwrap() - 1.7).abs() < 1e-12);
            assert_eq!(codes(&read), ["trc/unit", "trc/unit"]);
        }
    }
    // A person in centimetres, or a hand in millimetres.
    let error = with("", "A\t\t\tB", AXES, "1\t0\t0\t0\t0\t0\t170\t0\n").unwrap_err();
    assert_eq!(error.code(), "trc/unit");
}

#[test]
fn blank_cells_between_the_values_of_the_header_shift_nothing() {
    let small = "1\t0\t0\t0\t0\t0\t17\t0\n";
    let text = |keys: &str, values: &str| {
        trc::read(&format!("PathFileType\n{keys}\n{values}\nFrame#\tTime\tA\t\t\tB\n{AXES}{small}"))
            .unwrap()
    };
    let keys = "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate";
    for values in [
        "60\t\t60\t\t1\t\t2\t\tmm\t\t60",
        "60\t\t60\t\t1\t\t2\t\tmm",
        " 60.0\t\t  60.0\t\t    1\t\t     2\t\t mm\t  60.0",
    ] {
        let read = text(keys, values);
        assert_eq!((read.value.units, read.value.rate), (LengthUnit::Millimetre, 60.0), "{values}");
        assert_eq!(codes(&read), [""; 0], "{values}: {:?}", read.warnings);
    }
    // The value of one key is left out, so that neither column nor order is right.
    let read = text(keys, "60\t60\t1\tmm\t60\t7");
    assert_eq!(read.value.units, LengthUnit::Millimetre);
    assert!(read.warned("trc/header"));
}

#[test]
fn a_wrong_unit_is_suspected() {
    let large = with("m", "A\t\t\tB", AXES, "1\t0\t0\t0\t0\t0\t1700\t0\n").unwrap();
    assert_eq!(
        large.warnings[0].to_string(),
        "line 3: the markers of a frame span 1.7000e3 m (is the unit `m` right?)"
    );
    let small = with("mm", "A\t\t\tB", AXES, "1\t0\t0\t0\t0\t0\t1.7\t0\n").unwrap();
    assert_eq!(codes(&small), ["trc/size"]);
    let fine = with("mm", "A\t\t\tB", AXES, "1\t0\t0\t0\t0\t0\t1700\t0\n").unwrap();
    assert_eq!(codes(&fine), [""; 0]);
}

#[test]
fn numbers_may_have_exponents() {
    let read = with("m", "A", "", "1\t0\t-2.73E-01\t7.46e-02\t-1.57E+00\n").unwrap();
    assert_eq!(read.value.position(0, 0), Some([-0.273, 0.0746, -1.57]));
}

#[test]
fn the_rate_may_come_from_the_times() {
    let text = "PathFileType\nNumFrames\tUnits\n3\tm\nFrame#\tTime\tA\n\
                1\t0\t1\t1\t1\n2\t0.02\t1\t1\t1\n3\t0.04\t1\t1\t1\n";
    let read = trc::read(text).unwrap();
    assert!((read.value.rate - 50.0).abs() < 1e-9);
    assert_eq!(codes(&read), ["trc/rate"]);
    let wrong = text.replace("NumFrames\tUnits\n3", "DataRate\tUnits\n100");
    let read = trc::read(&wrong).unwrap();
    assert!((read.value.rate - 50.0).abs() < 1e-9);
    assert_eq!(
        read.warnings[0].to_string(),
        "DataRate is 100 Hz, but the times give 50.000 Hz (the times are used)"
    );
}

#[test]
fn a_missing_first_line_is_a_warning() {
    let read = trc::read("DataRate\tUnits\n100\tm\nFrame#\tTime\tA\n1\t0\t1\t1\t1\n").unwrap();
    assert_eq!(codes(&read), ["trc/path-file-type"]);
}

#[test]
fn rows_that_end_early() {
    let read = with_rows("1\t0\t100\t200\t300\n").unwrap();
    assert_eq!(read.value.position(0, 0), Some([0.1, 0.2, 0.3]));
    assert_eq!(read.value.position(0, 1), None);
    assert_eq!(
        read.warnings[0].to_string(),
        "line 7: the row ends early (expected 8 cells, found 5; markers missing at its end: 1)"
    );
}

#[test]
fn markers_beyond_the_last_name_are_skipped() {
    let long = "1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\n";
    let read = with_rows(long).unwrap();
    assert_eq!(read.value.positions.len(), 2);
    assert_eq!(
        read.warnings[0].to_string(),
        "line 7, column 17: markers without a name in the rows: 1 \
         (those after the last name were skipped)"
    );
    // They may begin in a later row, and be more in a still later one.
    let longer = long.replace("1\t0\t1", "3\t0.02\t1").replace('\n', "\t1\t2\t3\n");
    let later = long.replace("1\t0\t1", "2\t0.01\t1");
    let read = with_rows(&format!("{ROW}{later}{longer}")).unwrap();
    assert_eq!(read.value.position(2, 0), Some([0.001, 0.002, 0.003]));
    assert_eq!(codes(&read), ["trc/nameless", "trc/nameless", "trc/frame-count", "trc/size"]);
}

/// Rows of three frames at 100 Hz, with something before and behind each frame's number and time.
fn beside(before: &str, behind: [&str; 3]) -> String {
    let row = |i: usize| {
        format!("{before}{}\t{}\t{}{}\t2\t3\t4\t5\t6\n", i + 1, i as f64 / 100.0, behind[i], 10 * i)
    };
    (0..3).map(row).collect()
}

#[test]
fn rows_that_stand_beside_their_names() {
    let stamps = ["1700000000000\t", "1700000000010\t", "1700000000020\t"];
    for (what, labels, axes, rows, code) in [
        ("as named", "A\t\t\tB", AXES, beside("", [""; 3]), ""),
        ("a blank cell first", "A\t\t\tB", AXES, beside("\t", [""; 3]), "trc/shifted-rows"),
        ("two blank cells", "A\t\t\tB", AXES, beside("\t\t", [""; 3]), "trc/shifted-rows"),
        (
            "a blank cell behind the time",
            "A\t\t\tB",
            AXES,
            beside("", ["\t"; 3]),
            "trc/shifted-rows",
        ),
        ("a time stamp without a name", "A\t\t\tB", AXES, beside("", stamps), "trc/shifted-rows"),
        (
            "a time stamp before the axes",
            "Timestamp\tA\t\t\tB",
            "\t\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n",
            beside("", stamps),
            "trc/extra-column",
        ),
        (
            "a time stamp, no axes",
            "Time Stamp\tA\t\t\tB",
            "",
            beside("", stamps),
            "trc/extra-column",
        ),
    ] {
        let read = with("mm", labels, axes, &rows).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!(read.value.labels, ["A", "B"], "{what}");
        assert_eq!(read.value.times, [0.0, 0.01, 0.02], "{what}");
        for frame in 0..3 {
            let x = frame as f64 / 100.0;
            assert_eq!(read.value.position(frame, 0), Some([x, 0.002, 0.003]), "{what}");
            assert_eq!(read.value.position(frame, 1), Some([0.004, 0.005, 0.006]), "{what}");
        }
        let others = ["trc/frame-count", "trc/marker-count", "trc/size"];
        let found: Vec<_> = codes(&read).into_iter().filter(|c| !others.contains(c)).collect();
        assert_eq!(found.concat(), code, "{what}: {:?}", read.warnings);
    }
    // The last marker is not seen: its cells are blank.
    let last = "\t1\t0\t1\t2\t3\t\t\t\n\t2\t0.01\t1\t2\t3\t\t\t\n\t3\t0.02\t1\t2\t3\t4\t5\t6\n";
    let read = with("mm", "A\t\t\tB", AXES, last).unwrap();
    assert_eq!(read.value.position(1, 0), Some([0.001, 0.002, 0.003]));
    assert_eq!((read.value.position(1, 1), read.value.rate), (None, 100.0));
}

#[test]
fn times_that_contradict_the_rate_are_an_error() {
    let rows = |step: f64, frames: usize| -> String {
        let row = |i: usize| format!("{}\t{}\t1\t2\t3\n", 1 + i * frames, step * i as f64);
        (0..5).map(row).collect()
    };
    let read = |rows: &str| with("mm", "A", "", rows);
    for (step, said) in [
        (
            1.0,
            "DataRate is 100 Hz, but the times give 1.000 Hz (they look like the numbers of frames",
        ),
        (10.0, "DataRate is 100 Hz, but the times give 0.100 Hz (they look like milliseconds"),
        (0.0, "all 5 rows have the time 0 s"),
    ] {
        let error = read(&rows(step, 1)).unwrap_err().to_string();
        assert!(error.contains(said), "{step}: {error}");
    }
    // Every hundredth frame, as the numbers of frames say.
    let some = read(&rows(1.0, 100)).unwrap();
    assert!((some.value.rate - 1.0).abs() < 1e-9 && !some.warned("trc/rate"));
    // Left out frames change no step but their own.
    let left_out = "1\t0\t1\t2\t3\n2\t0.01\t1\t2\t3\n9\t0.08\t1\t2\t3\n10\t0.09\t1\t2\t3\n";
    let read = read(left_out).unwrap();
    assert_eq!((read.value.rate, read.warned("trc/rate")), (100.0, false));
}

#[test]
fn words_for_missing_values_and_other_styles_of_numbers() {
    for word in
        ["NA", "N/A", "null", "None", "-", "--", "*", "1.#QNAN", "-1.#IND", "nan(ind)", "Inf"]
    {
        let read = with_rows(&format!("1\t0\t{word}\t{word}\t{word}\t4\t5\t6\n")).unwrap();
        assert_eq!(read.value.position(0, 0), None, "{word}");
        assert_eq!(read.value.position(0, 1), Some([0.004, 0.005, 0.006]), "{word}");
        assert_eq!(codes(&read), [""; 0], "{word}");
    }
    let place = Some([0.0015, 0.2, -0.003]);
    for (row, code) in [
        ("1\t0\t1.5D+00\t2.0d2\t-3\n", ""),
        ("\"1\"\t\"0\"\t\"1.5\"\t\"200\"\t\"-3\"\n", ""),
        ("1\t0,0\t1,5\t200,0\t-3,0\n", "trc/decimal-comma"),
        ("1\t0\t1.5\t200\t-3\n\u{1a}", ""),
        ("1\t0\t1.5\t200\t-3\u{1a}\0\0", ""),
    ] {
        let read = with_rows(&row.replace('\n', "\t\t\t\n")).unwrap();
        assert_eq!(read.value.position(0, 0), place, "{row}");
        let found = codes(&read);
        assert_eq!(
            found.iter().find(|c| **c != "trc/short-row").copied().unwrap_or(""),
            code,
            "{row}"
        );
    }
    for separator in [',', ';'] {
        let text = format!(
            "PathFileType\t4\nDataRate\tNumFrames\tUnits\n100\t1\tmm\nFrame#\tTime\tA\t\t\tB\t\t\n{AXES}{ROW}"
        );
        let read = trc::read(&text.replace('\t', &separator.to_string())).unwrap();
        assert_eq!(read.value.position(0, 1), Some([0.4, 0.5, 0.6]), "{separator}");
        assert_eq!(codes(&read), [""; 0], "{separator}");
    }
}

#[test]
fn times_that_stand_still_or_go_back() {
    let read = with_rows(&format!("{ROW}{ROW}")).unwrap();
    assert_eq!(codes(&read), ["trc/same-time", "trc/frame-count"]);
    let back = with_rows("1\t1.5\t1\t2\t3\n2\t0.5\t1\t2\t3\n").unwrap_err();
    assert_eq!(
        back.to_string(),
        "line 8, column 3: time goes back from 1.5 s to 0.5 s \
         (does the file hold two recordings? split it)"
    );
}

#[test]
fn faults_say_where_and_what_would_be_right() {
    for (rows, said) in [
        (
            "1\t0\t1\tabc\t3\n",
            "line 7, column 7: `abc` is not a number \
             (expected a coordinate of `A`; a missing value is a blank cell)",
        ),
        ("1\t0\t1,5,5\t2\t3\n", "line 7, column 5: `1,5,5` is not a number"),
        (
            "1\t0\t1\t2\t3\t4\t5\t6\t7\n",
            "line 7, column 17: the row has too many cells \
             (expected at most 8 for 2 markers, found 9)",
        ),
        ("1\t\t1\t2\t3\n", "line 7: the row has no time (write the seconds in the second cell)"),
        ("x\t0\t1\t2\t3\n", "line 7, column 1: `x` is not a number"),
        ("", "line 5: there are marker names, but no frames"),
    ] {
        let error = with_rows(rows).unwrap_err().to_string();
        assert!(error.starts_with(said), "{rows:?}: {error}");
    }
    for (text, code) in [
        ("", "trc/empty"),
        ("\n \n", "trc/empty"),
        ("time,a\n0,1\n", "trc/not-trc"),
        ("PathFileType\t4\t(X/Y/Z)\n", "trc/truncated"),
        ("PathFileType\t4\t(X/Y/Z)\nhello\n", "trc/keys"),
        ("PathFileType\t4\t(X/Y/Z)\nDataRate\tUnits\n", "trc/truncated"),
        ("PathFileType\t4\t(X/Y/Z)\nDataRate\tUnits\n100\tmm\n", "trc/truncated"),
        ("PathFileType\nDataRate\tUnits\n100\tmm\nFrame#\tTime\n1\t0\n", "trc/labels"),
        ("PathFileType\nDataRate\tUnits\n100\tmm\n1\t0\t1\t1\t1\n", "trc/labels"),
    ] {
        assert_eq!(trc::read(text).unwrap_err().code(), code, "{text:?}");
    }
}

#[test]
fn a_header_that_claims_a_billion_frames_costs_nothing() {
    let text = "PathFileType\nDataRate\tNumFrames\tNumMarkers\tUnits\n\
                100\t1000000000\t1000000000\tmm\nFrame#\tTime\tA\n1\t0\t1\t1\t1\n";
    let read = trc::read(text).unwrap();
    assert_eq!(read.value.positions.len(), 1);
    assert_eq!(codes(&read), ["trc/marker-count", "trc/frame-count"]);
}

#[test]
fn many_labels_and_short_rows_do_not_multiply() {
    let labels = (0..20_000).map(|i| format!("m{i}\t\t\t")).collect::<String>();
    let rows = (0..20_000).map(|i| format!("{i}\t{i}\n")).collect::<String>();
    let error = with("mm", &labels, "", &rows).unwrap_err();
    assert_eq!(error.code(), "trc/short-rows");
}

#[test]
fn bytes_that_are_not_utf_8_are_read_as_latin_1() {
    let text = with_text(b"Kn\xf6chel");
    let read = trc::from_bytes(&text).unwrap();
    assert_eq!(read.value.labels, ["Knöchel"]);
    assert_eq!(codes(&read), ["text/encoding"]);
    assert_eq!(trc::from_bytes(&with_text("Knöchel".as_bytes())).unwrap().value, read.value);
}

fn with_text(label: &[u8]) -> Vec<u8> {
    let mut text = b"PathFileType\nDataRate\tUnits\n100\tm\nFrame#\tTime\t".to_vec();
    text.extend_from_slice(label);
    text.extend_from_slice(b"\n1\t0\t1\t1\t1\n");
    text
}

#[test]
fn a_recording_that_does_not_fit_together_is_not_written() {
    let broken = Recording {
        labels: vec!["A".into()],
        times: vec![0.0, 0.1],
        positions: vec![condyle_formats::Observed::MISSING],
        ..Recording::default()
    };
    assert_eq!(trc::write(&broken, "x").unwrap_err().code(), "trc/shape");
    let nameless = Recording { labels: vec![" ".into()], ..Recording::default() };
    assert_eq!(trc::write(&nameless, "x").unwrap_err().code(), "trc/labels");
}

fn position() -> impl Strategy<Value = Option<[f64; 3]>> {
    prop_oneof![1 => Just(None), 4 => prop::array::uniform3(-5.0..5.0_f64).prop_map(Some)]
}

fn recording() -> impl Strategy<Value = Recording> {
    (1..5_usize, 1..6_usize, 1.0..1000.0_f64).prop_flat_map(|(markers, frames, rate)| {
        let labels =
            prop::collection::hash_set("[A-Za-z*.:][A-Za-z0-9_ .*:-]{0,8}[a-z0-9]", markers);
        let positions = prop::collection::vec(position(), markers * frames);
        (labels, positions).prop_map(move |(labels, positions)| Recording {
            labels: labels.into_iter().collect(),
            rate,
            times: (0..frames).map(|frame| frame as f64 / rate).collect(),
            positions: positions.into_iter().map(Into::into).collect(),
            units: LengthUnit::Metre,
            confidences: None,
        })
    })
}

proptest! {
    #[test]
    fn what_is_written_is_read(recording in recording()) {
        let text = trc::write(&recording, "a.trc").unwrap();
        let read = trc::read(&text).unwrap();
        prop_assert_eq!(read.value, recording);
    }

    /// A length in millimetres that came from metres may lose its last bit, and no more.
    #[test]
    fn other_units_keep_all_but_the_last_bit(recording in recording(), unit in 0..4_usize) {
        let units = [LengthUnit::Millimetre, LengthUnit::Centimetre, LengthUnit::Inch, LengthUnit::Foot];
        let recording = Recording { units: units[unit], ..recording };
        let read = trc::read(&trc::write(&recording, "a.trc").unwrap()).unwrap().value;
        prop_assert_eq!(&read.labels, &recording.labels);
        for (a, b) in read.positions.iter().zip(&recording.positions) {
            let (a, b) = (a.position(), b.position());
            prop_assert_eq!(a.is_some(), b.is_some());
            for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
                prop_assert!((a - b).abs() <= 2.0 * f64::EPSILON * b.abs(), "{} {}", a, b);
            }
        }
        // Once it came from a file, it keeps every bit.
        let again = trc::read(&trc::write(&read, "a.trc").unwrap()).unwrap().value;
        prop_assert_eq!(again, read);
    }

    #[test]
    fn no_text_panics(text in "(PathFileType|DataRate|Units|Frame#|Time|[0-9.\t\n -]|mm|\\PC){0,60}") {
        if let Ok(read) = trc::read(&text) {
            prop_assert_eq!(read.value.positions.len(), read.value.frames() * read.value.labels.len());
        }
    }
}
