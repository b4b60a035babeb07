//! Every rule of the STO and MOT reader, one small file each, and the round trips of tables.

use condyle_formats::{AngleUnit, Error, Read, Table, csv, sto};
use proptest::prelude::*;

fn with_header(header: &str) -> Result<Read<Table>, Error> {
    sto::read(&format!("{header}endheader\ntime\tq\n0\t1\n"))
}

fn with_body(body: &str) -> Result<Read<Table>, Error> {
    sto::read(&format!("motion\ninDegrees=no\nendheader\n{body}"))
}

fn codes(read: &Read<Table>) -> Vec<&'static str> {
    read.warnings.iter().map(|w| w.code).collect()
}

#[test]
fn the_unit_of_angles() {
    use AngleUnit::{Degrees, Radians, Unstated};
    let simm = "# SIMM Motion File Header:\t\t\nname first trial\t\t\ndatacolumns 2\ndatarows 1\n\
                otherdata 1\nrange 0.0 0.0\n";
    for (header, unit, warnings) in [
        ("inDegrees=yes\n", Degrees, &[][..]),
        ("indegrees = yES\n", Degrees, &[]),
        ("inDegrees=no\n", Radians, &[]),
        ("inDegrees=false\n", Radians, &[]),
        ("name\nversion=1\n", Unstated, &[]),
        ("inDegrees=perhaps\n", Unstated, &["sto/in-degrees"]),
        ("a title\nAngles are in degrees.\n", Degrees, &[]),
        ("Angles are in radians.\n", Radians, &[]),
        ("inDegrees=no\nAngles are in degrees.\n", Radians, &["sto/unit-contradiction"]),
        ("inDegrees=yes\nAngles are in degrees.\n", Degrees, &[]),
        (
            "inDegrees=no\nIf the header above contains a line with 'inDegrees', this indicates \
             whether rotational values are in degrees (yes) or radians (no).\n",
            Radians,
            &[],
        ),
        (simm, Degrees, &[]),
        (&format!("inDegrees=no\n{simm}"), Radians, &[]),
    ] {
        let read = with_header(header).unwrap();
        assert_eq!(read.value.angle_unit, unit, "{header}");
        assert_eq!(codes(&read), warnings, "{header}");
    }
}

#[test]
fn titles_and_keys() {
    let read =
        with_header("\nfirst trial\nversion=1\nnRows=1\nnColumns=2\nSubject = 7 a\n").unwrap();
    assert_eq!(read.value.name, "first trial");
    assert_eq!(read.value.header, [("Subject".to_owned(), "7 a".to_owned())]);
    assert_eq!(read.value.header_value("subject"), Some("7 a"));
    let simm = with_header("x\nname second trial\t\t\n").unwrap();
    assert_eq!(simm.value.name, "second trial");
}

#[test]
fn counts_in_the_header_do_not_rule() {
    let read = with_header("nRows=5\nnColumns=9\n").unwrap();
    assert_eq!(read.value.rows(), 1);
    assert_eq!(codes(&read), ["sto/column-count", "sto/row-count"]);
    let vast = with_header("nRows=1000000000\nnColumns=1000000000\n").unwrap();
    assert_eq!(vast.value.values, [1.0]);
}

#[test]
fn delimiters() {
    for body in [
        "time\ta\tb\n0\t1\t2\n",
        "time a b\n0 1 2\n",
        "  time   a  b \n   0  1   2  \n",
        "time,a,b\n0, 1 ,2\n",
        "\ttime a b\n0 1 2\n",
        "TIME\ta\tb\t\t\n 0 \t 1 \t 2 \t\t\n",
        "time\ta\tb\n0 1 2\n",
        "\t\t\n \ntime\ta\tb\r\n0\t1\t2\r\n",
    ] {
        let read = with_body(body).unwrap();
        assert_eq!(read.value.columns, ["a", "b"], "{body:?}");
        assert_eq!(read.value.row(0), [1.0, 2.0], "{body:?}");
        assert_eq!(codes(&read), [""; 0], "{body:?}");
    }
}

#[test]
fn blank_cells_are_nan() {
    let read = with_body("time\ta\tb\tc\n0\t\t2\t3\n1\t1\n").unwrap();
    let row = read.value.row(0);
    assert!(row[0].is_nan());
    assert_eq!(row[1..], [2.0, 3.0]);
    assert!(read.value.value(1, 1).unwrap().is_nan());
    assert_eq!(
        read.warnings[0].to_string(),
        "line 6: the row ends early (expected 4 cells, found 2; the rest is NaN)"
    );
}

#[test]
fn vectors_become_columns() {
    let read = sto::read(
        "DataType=Quaternion\nendheader\ntime\tpelvis\ttorso\n0\t1,0,0,0\t0.5,0.5,0.5,0.5\n1\t\t0,0,0,1\n",
    )
    .unwrap();
    let columns = &read.value.columns;
    assert_eq!(columns.len(), 8);
    assert_eq!((columns[0].as_str(), columns[7].as_str()), ("pelvis_1", "torso_4"));
    assert_eq!(read.value.row(0), [1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5]);
    assert!(read.value.row(1)[..4].iter().all(|x| x.is_nan()));
    assert_eq!(read.value.header_value("DataType"), Some("Quaternion"));
    assert_eq!(codes(&read), ["sto/vector-cells"]);

    let mixed = with_body("time\ta\n0\t1,2,3\n1\t1,2\n").unwrap_err();
    assert_eq!(
        mixed.to_string(),
        "line 6, column 3: a cell of `a` holds 2 numbers (its first row holds 3)"
    );
    let clash = with_body("time\ta\ta_1\n0\t1,2,3\t4\n").unwrap();
    assert_eq!(clash.value.columns, ["a_1", "a_2", "a_3", "a_1#2"]);
    assert_eq!(codes(&clash), ["sto/vector-cells", "sto/duplicate-column"]);
}

#[test]
fn equal_names_are_told_apart() {
    let read = with_body("time\tknee\thip\tknee\n0\t1\t2\t3\n").unwrap();
    assert_eq!(read.value.columns, ["knee", "hip", "knee#2"]);
    assert_eq!(
        read.warnings[0].to_string(),
        "line 4: two columns are called `knee` (the later one, column 4, is read as `knee#2`)"
    );
    let csv = csv::read("time,a,a\n0,1,2\n").unwrap();
    assert_eq!(
        (csv.value.columns.concat(), csv.warned("csv/duplicate-column")),
        ("aa#2".into(), true)
    );
}

#[test]
fn words_for_missing_values_and_other_styles_of_numbers() {
    for word in ["NA", "N/A", "null", "None", "-", "--", "*", "1.#QNAN", "-1.#IND", "nan"] {
        let read = with_body(&format!("time\ta\tb\n0\t{word}\t2\n")).unwrap();
        assert!(read.value.value(0, 0).unwrap().is_nan(), "{word}");
        let read = csv::read(&format!("time,a,b\n0,{word},2\n")).unwrap();
        assert!(read.value.value(0, 0).unwrap().is_nan(), "{word}");
        let error = with_body(&format!("time\ta\n{word}\t2\n")).unwrap_err();
        assert_eq!(error.code(), "sto/time", "{word}");
    }
    for (body, code) in [
        ("time\ta\tb\n0,5\t-1,25\t2\n", "sto/decimal-comma"),
        ("time;a;b\n0,5;-1,25;2\n", "sto/decimal-comma"),
        ("\"time\"\t\"a\"\t\"b\"\n\"0.5\"\t\"-1.25\"\t\"2\"\n", ""),
        ("time\ta\tb\n0.5\t-1.25D+00\t2\n\u{1a}", ""),
        ("\ta\tb\n0.5\t-1.25\t2\n", "sto/no-time"),
        ("a\tb\n0.5\t-1.25\t2\n", "sto/no-time"),
        ("time (s)\ta\tb\n0.5\t-1.25\t2\0\0", ""),
    ] {
        let read = with_body(body).unwrap_or_else(|e| panic!("{body:?}: {e}"));
        assert_eq!((read.value.times[0], read.value.row(0)), (0.5, &[-1.25, 2.0][..]), "{body:?}");
        assert_eq!(codes(&read).concat(), code, "{body:?}");
    }
    // In a table of vectors commas are between numbers.
    let read = sto::read("DataType=Vec2\nendheader\ntime\ta\n0\t1,2\n").unwrap();
    assert_eq!(read.value.row(0), [1.0, 2.0]);
}

#[test]
fn a_simm_file_without_time_is_spread_over_its_range() {
    let text = "x\ndatacolumns 1\ndatarows 3\nrange 0.5 1.5\nendheader\nknee\n1\n2\n3\n";
    let read = sto::read(text).unwrap();
    assert_eq!(read.value.times, [0.5, 1.0, 1.5]);
    assert_eq!(codes(&read), ["sto/even-times"]);
}

#[test]
fn a_table_may_have_no_rows() {
    let read = sto::read("endheader\ntime").unwrap();
    assert_eq!((read.value.rows(), read.value.columns.len()), (0, 0));
    assert_eq!(codes(&read), ["sto/no-rows"]);
}

#[test]
fn a_repeated_time_is_a_warning() {
    let read = with_body("time\ta\n0\t1\n0\t2\n").unwrap();
    assert_eq!(read.warnings[0].to_string(), "line 6, column 1: time 0 s is repeated");
}

#[test]
fn faults_say_where_and_what_would_be_right() {
    for (body, said) in [
        ("", "line 3: the file ends after `endheader`"),
        ("a\tb\n", "line 4: the first column is not `time`"),
        ("1\t2\n3\t4\n", "line 4: the line after `endheader` holds numbers, not names"),
        ("time\ta\n0\tabc\n", "line 5, column 3: `abc` in column `a` is not a number"),
        (
            "time\ta\n0\t1\t2\n",
            "line 5, column 5: the row has too many cells (expected 2, found 3)",
        ),
        ("time\ta\n\t1\n", "line 5: the row has no time"),
        ("time\ta\nnan\t1\n", "line 5: the row has no time"),
        ("time\ta\n1\t1\n0\t1\n", "line 6, column 1: time goes back from 1 s to 0 s"),
    ] {
        let error = with_body(body).unwrap_err().to_string();
        assert!(error.starts_with(said), "{body:?}: {error}");
    }
    assert_eq!(sto::read("").unwrap_err().code(), "sto/empty");
    assert_eq!(sto::read("time\ta\n0\t1\n").unwrap_err().code(), "sto/no-endheader");
}

#[test]
fn many_columns_and_short_rows_do_not_multiply() {
    let names = (0..20_000).map(|i| format!("\tc{i}")).collect::<String>();
    let rows = (0..20_000).map(|i| format!("{i}\n")).collect::<String>();
    let error = with_body(&format!("time{names}\n{rows}")).unwrap_err();
    assert_eq!(error.code(), "sto/short-rows");
}

#[test]
fn names_that_would_be_taken_for_keys_are_disguised() {
    for (name, written) in [
        ("", "table"),
        ("endheader", "_endheader"),
        ("range 0 1", "_range 0 1"),
        ("a=b\nc", "a_b c"),
        ("Angles are in degrees", "_Angles are in degrees"),
    ] {
        let table = Table {
            name: name.into(),
            columns: vec!["a".into()],
            header: vec![("inDegrees".into(), "yes".into()), ("range".into(), "0 1".into())],
            ..Table::default()
        };
        let text = sto::write(&table).unwrap();
        assert_eq!(text.lines().next(), Some(written));
        let read = sto::read(&text).unwrap().value;
        assert_eq!(read.columns, ["a"]);
        assert!(read.header.is_empty());
    }
}

#[test]
fn a_table_that_does_not_fit_together_is_not_written() {
    let broken = Table { times: vec![0.0], columns: vec!["a".into()], ..Table::default() };
    assert_eq!(sto::write(&broken).unwrap_err().code(), "sto/shape");
    assert_eq!(csv::write(&broken).unwrap_err().code(), "csv/shape");
    let nameless = Table { columns: vec!["".into()], ..Table::default() };
    assert_eq!(sto::write(&nameless).unwrap_err().code(), "sto/no-names");
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -400.0..400.0_f64,
        1 => prop::num::f64::NORMAL | prop::num::f64::ZERO | prop::num::f64::SUBNORMAL,
    ]
}

fn table() -> impl Strategy<Value = Table> {
    (1..5_usize, 1..6_usize).prop_flat_map(|(columns, rows)| {
        let names = prop::collection::hash_set("[a-z/|][A-Za-z0-9_/|.#\"-]{0,10}[a-z0-9]", columns);
        let values = prop::collection::vec(finite(), columns * rows);
        let times = prop::collection::btree_set(-1_000_000..1_000_000_i32, rows);
        let unit = prop_oneof![
            Just(AngleUnit::Degrees),
            Just(AngleUnit::Radians),
            Just(AngleUnit::Unstated)
        ];
        (names, values, times, unit, "Trial [a-z ]{0,9}[a-z]").prop_map(
            |(names, values, times, angle_unit, name)| Table {
                name,
                columns: names.into_iter().collect(),
                times: times.into_iter().map(|t| f64::from(t) / 1000.0).collect(),
                values,
                angle_unit,
                header: vec![("Subject".into(), "s 7".into())],
            },
        )
    })
}

proptest! {
    #[test]
    fn a_motion_written_is_read(table in table()) {
        let read = sto::read(&sto::write(&table).unwrap()).unwrap();
        prop_assert_eq!(read.warnings.len(), 0);
        prop_assert_eq!(read.value, table);
    }

    /// CSV keeps the numbers and names; it has no place for the rest.
    #[test]
    fn a_csv_written_is_read(table in table()) {
        let read = csv::read(&csv::write(&table).unwrap()).unwrap();
        prop_assert_eq!(read.warnings.len(), 0);
        prop_assert_eq!(read.value.columns, table.columns);
        prop_assert_eq!(read.value.times, table.times);
        prop_assert_eq!(read.value.values, table.values);
    }

    #[test]
    fn no_text_panics(text in "(endheader\n|time|inDegrees=|range |[0-9.,\t\n -]|\\PC){0,60}") {
        if let Ok(read) = sto::read(&text) {
            prop_assert_eq!(read.value.values.len(), read.value.rows() * read.value.columns.len());
        }
        if let Ok(read) = csv::read(&text) {
            prop_assert_eq!(read.value.values.len(), read.value.rows() * read.value.columns.len());
        }
    }
}
