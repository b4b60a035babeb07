//! Real recordings, motions, models and setups, where they are at hand.
//!
//! The counts are those of the data's own table, made by counting rows and by other programs.

use std::path::{Path, PathBuf};

use condyle_formats::opensim::setup::{self, CoordinateTarget, IkTasks};
use condyle_formats::{AngleUnit, LengthUnit, XmlDocument, sto, trc};

/// The folder of shared data beside the repository; `None` where it is absent.
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: shared data absent");
    None
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Every file with this extension, as paths from the folder.
fn all(folder: &Path, extension: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                let name = path.strip_prefix(folder).unwrap();
                found.push(name.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

/// File, frames, rate, labels, unit and the warnings it deserves.
type Trial = (&'static str, usize, f64, usize, LengthUnit, &'static [&'static str]);

const TRC: [Trial; 22] = {
    use LengthUnit::{Metre as M, Millimetre as MM};
    [
        ("ik/arm26/arm26_elbow_flex.trc", 121, 120.0, 3, MM, &[]),
        ("ik/core_subject01/subject01_synthetic_marker_data.trc", 73, 60.0, 31, M, &[]),
        ("ik/gait10dof/subject01_static.trc", 300, 60.0, 49, MM, &[]),
        ("ik/gait10dof/subject01_walk.trc", 151, 60.0, 41, MM, &[]),
        ("ik/lai_subject6/walking1.trc", 143, 100.0, 51, MM, &[]),
        ("knee/SprintCalib.trc", 337, 250.0, 65, MM, &["trc/nameless"]),
        ("knee/SprintMotion.trc", 788, 250.0, 59, MM, &[]),
        ("knee/gait_walk.trc", 184, 150.0, 55, MM, &["trc/marker-count", "trc/duplicate-name"]),
        ("knee/gait_walk2.trc", 251, 150.0, 55, MM, &["trc/marker-count", "trc/duplicate-name"]),
        ("knee/lenhart/overground_17.trc", 515, 200.0, 40, MM, &[]),
        ("knee/opencap4/squats1.trc", 1346, 100.0, 51, M, &[]),
        ("knee/opencap4/static1.trc", 517, 100.0, 55, M, &[]),
        ("knee/opencap4/walking1.trc", 131, 100.0, 51, M, &[]),
        ("shoulder/bonepin/abdbonepin.trc", 1991, 100.0, 11, MM, &["trc/frame-count"]),
        ("trc/btk_Res16bits.trc", 100, 100.0, 44, MM, &[]),
        ("trc/btk_T.trc", 89, 30.0, 41, MM, &[]),
        ("trc/btk_ballet_reduced.trc", 100, 30.0, 41, MM, &[]),
        ("trc/dataWithBlanksForMissingMarkers.trc", 464, 250.0, 40, MM, &[]),
        ("trc/dataWithEformat.trc", 5, 119.88012, 14, M, &[]),
        ("trc/exampleFormat.trc", 5, 100.0, 3, M, &[]),
        ("trc/gait10dof18musc_walk_CRLF_line_ending.trc", 10, 60.0, 41, MM, &[]),
        ("trc/std_walking2_markers.trc", 126, 125.0 / 4.992, 44, MM, &["trc/rate"]),
    ]
};

#[test]
fn every_recording_has_the_frames_and_labels_of_the_table() {
    let Some(folder) = data() else { return };
    for (name, frames, rate, labels, unit, warnings) in TRC {
        let read = trc::from_bytes(&bytes(&folder, name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let codes: Vec<_> = read.warnings.iter().map(|w| w.code).collect();
        assert_eq!(codes, warnings, "{name}: {:?}", read.warnings);
        let recording = read.value;
        assert_eq!(recording.frames(), frames, "{name}");
        assert_eq!(recording.labels.len(), labels, "{name}");
        assert_eq!(recording.rate, rate, "{name}");
        assert_eq!(recording.units, unit, "{name}");
        assert_eq!(recording.positions.len(), frames * labels, "{name}");
        // People and their arms: 10 cm to 4 m.
        let extent = recording.extent().unwrap();
        assert!((0.1..4.0).contains(&extent), "{name}: {extent}");
        // What was read is written and read again, bit for bit.
        let again = trc::read(&trc::write(&recording, name).unwrap()).unwrap();
        assert_eq!(again.value, recording, "{name}");
    }
}

#[test]
fn no_recording_is_left_out() {
    let Some(folder) = data() else { return };
    let broken = ["trc/btk_Empty.trc", "trc/btk_Truncated.trc", "trc/opynsim_minimal.trc"];
    let mut known: Vec<&str> = TRC.iter().map(|row| row.0).chain(broken).collect();
    known.sort_unstable();
    assert_eq!(all(&folder, "trc"), known);
}

#[test]
fn broken_recordings_say_so() {
    let Some(folder) = data() else { return };
    let error = |name| trc::from_bytes(&bytes(&folder, name)).unwrap_err().to_string();
    assert_eq!(
        error("trc/btk_Empty.trc"),
        "line 1: the file is empty (a TRC file starts with `PathFileType`)"
    );
    assert_eq!(
        error("trc/btk_Truncated.trc"),
        "line 2: the header ends after its keys \
         (a line of values must follow: rate, frames, markers, unit)"
    );
}

#[test]
fn single_numbers_of_recordings() {
    let Some(folder) = data() else { return };
    let read = |name| trc::from_bytes(&bytes(&folder, name)).unwrap().value;
    // One marker, one frame, 1 2 3 mm.
    let minimal = read("trc/opynsim_minimal.trc");
    assert_eq!(minimal.position(0, 0), Some([0.001, 0.002, 0.003]));
    // Blank cells in the first frame, NaN in the third.
    let example = read("trc/exampleFormat.trc");
    let gaps: Vec<_> = example.gaps().iter().map(|g| (g.marker, g.first, g.frames)).collect();
    assert_eq!(gaps, [(0, 0, 1), (1, 2, 1)]);
    assert_eq!(example.position(1, 0), Some([-0.273, 0.0745, -1.57]));
    // An extra tab before the first label: names by order.
    let synthetic = read("ik/core_subject01/subject01_synthetic_marker_data.trc");
    assert_eq!(synthetic.labels[0], "Sternum");
    assert_eq!(synthetic.labels[3], "Top.Head");
    let (sternum, head) = (synthetic.position(0, 0).unwrap(), synthetic.position(0, 3).unwrap());
    assert!(head[1] > sternum[1] + 0.2, "the head is above the sternum: {head:?} {sternum:?}");
    // The very same walk with two kinds of line ends.
    let lf = read("ik/gait10dof/subject01_walk.trc");
    let crlf = read("trc/gait10dof18musc_walk_CRLF_line_ending.trc");
    assert_eq!(crlf.labels, lf.labels);
    assert_eq!(crlf.positions, lf.positions[..crlf.positions.len()]);
}

/// File, rows, columns besides time, unit of angles and the warnings it deserves.
type Motion = (&'static str, usize, usize, AngleUnit, &'static [&'static str]);

const TABLES: [Motion; 30] = {
    use AngleUnit::{Degrees as D, Radians as R, Unstated as U};
    [
        ("hip/imu_RHJC_swinger.sto", 1401, 32, U, &["sto/vector-cells"]),
        ("ik/arm26/arm26_InverseKinematics.mot", 121, 2, D, &[]),
        ("ik/core_abdbonepin/std_subject1_abdbonepin_IK.mot", 1901, 17, D, &[]),
        ("ik/core_subject01/std_subject01_walk1_ik.mot", 73, 23, D, &[]),
        ("ik/gait10dof/subject01_walk_IK.mot", 151, 10, D, &[]),
        ("ik/lai_subject6/walking1.mot", 143, 35, D, &[]),
        ("ik/lai_subject6/walking1_ik_marker_errors.sto", 143, 3, R, &[]),
        ("knee/lenhart/overground_17_ik.mot", 473, 52, D, &[]),
        ("knee/lenhart/secondary_constraint_sweep_states.sto", 301, 104, U, &[]),
        ("knee/opencap4/squats1_ik.mot", 1346, 35, D, &[]),
        ("knee/opencap4/walking1_ik.mot", 131, 35, D, &[]),
        ("shoulder/thoracoscapular/ABD02.mot", 846, 17, D, &[]),
        ("shoulder/thoracoscapular/ABD21.mot", 772, 17, D, &[]),
        ("shoulder/thoracoscapular/FLX01.mot", 794, 17, D, &[]),
        ("shoulder/thoracoscapular/FLX21.mot", 709, 17, D, &[]),
        ("shoulder/thoracoscapular/SHRUG01.mot", 462, 17, D, &[]),
        ("sto/gait10dof18musc_ik_CRLF_line_ending.mot", 15, 10, D, &[]),
        ("sto/opynsim_duplicate_time_row.sto", 4, 2, U, &["sto/same-time"]),
        ("sto/opynsim_has_header.sto", 0, 0, U, &["sto/no-rows"]),
        ("sto/opynsim_in_degrees.sto", 3, 4, D, &[]),
        ("sto/opynsim_in_degrees_case_insensitive_yes.sto", 3, 4, D, &[]),
        ("sto/opynsim_in_radians.sto", 3, 4, R, &[]),
        ("sto/opynsim_legacy_delimiters.sto", 3, 1, U, &[]),
        ("sto/opynsim_minimal.mot", 0, 0, U, &["sto/no-rows"]),
        ("sto/opynsim_minimal.sto", 0, 0, U, &["sto/no-rows"]),
        ("sto/opynsim_missing_data_cells.sto", 4, 3, U, &["sto/short-row", "sto/short-row"]),
        ("sto/orientation_quats.sto", 6, 28, U, &["sto/vector-cells"]),
        ("sto/sampleOutputs.sto", 471, 2, U, &[]),
        ("sto/sampleOutputsVec3.sto", 471, 6, U, &["sto/vector-cells"]),
        ("sto/test.sto", 2, 2, U, &[]),
    ]
};

#[test]
fn every_motion_has_the_rows_and_columns_of_the_table() {
    let Some(folder) = data() else { return };
    let mut known = Vec::new();
    for (name, rows, columns, unit, warnings) in TABLES {
        known.push(name.to_owned());
        let read = sto::from_bytes(&bytes(&folder, name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let codes: Vec<_> = read.warnings.iter().map(|w| w.code).collect();
        assert_eq!(codes, warnings, "{name}: {:?}", read.warnings);
        let table = read.value;
        assert_eq!((table.rows(), table.columns.len()), (rows, columns), "{name}");
        assert_eq!(table.angle_unit, unit, "{name}");
        assert_eq!(table.values.len(), rows * columns, "{name}");
        let again = sto::read(&sto::write(&table).unwrap()).unwrap().value;
        assert_eq!(again.columns, table.columns, "{name}");
        assert_eq!(again.times, table.times, "{name}");
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again.values), bits(&table.values), "{name}");
    }
    let mut found = all(&folder, "mot");
    found.extend(all(&folder, "sto"));
    found.sort();
    assert_eq!(found, known);
}

#[test]
fn single_numbers_of_motions() {
    let Some(folder) = data() else { return };
    let read = |name| sto::from_bytes(&bytes(&folder, name)).unwrap().value;
    let walk = read("ik/core_subject01/std_subject01_walk1_ik.mot");
    assert_eq!(walk.name, "first trial");
    assert_eq!(walk.times[0], 0.4);
    assert_eq!(walk.column("pelvis_tilt"), Some(0));
    assert_eq!(walk.value(0, 0), Some(5.21211788));
    // Times that do not start at 0, an empty first line, quaternions w x y z of length 1.
    let swing = read("hip/imu_RHJC_swinger.sto");
    assert_eq!((swing.times[0], swing.name.as_str()), (417.0, ""));
    assert_eq!(swing.columns[0], "torso_imu_1");
    for row in [0, 700, 1400] {
        let length = swing.row(row)[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() < 1e-6, "{length}");
    }
    // Columns that are paths are found by coordinate.
    let sweep = read("knee/lenhart/secondary_constraint_sweep_states.sto");
    assert_eq!(sweep.column("pelvis_tilt"), Some(0));
    assert_eq!(sweep.columns[0], "/jointset/gnd_pelvis/pelvis_tilt/value");
}

#[test]
fn every_model_is_parsed() {
    let Some(folder) = data() else { return };
    let models = all(&folder, "osim");
    assert!(models.len() >= 15, "{models:?}");
    for name in models {
        let read = XmlDocument::from_bytes(&bytes(&folder, &name))
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(read.value.root().name(), "OpenSimDocument", "{name}");
        let model = read.value.root().require("Model").unwrap();
        let bodies = model.descendants().filter(|e| e.is("Body")).count();
        let joints = model.descendants().filter(|e| e.name().ends_with("Joint")).count();
        // One is the smallest file that crashed another program: it has neither.
        let some = !name.ends_with("opensim-creator_517_repro.osim");
        assert_eq!((bodies > 0, joints > 0), (some, some), "{name}: {bodies}, {joints}");
        let masses = model.descendants().filter(|e| e.is("Body"));
        for body in masses {
            if let Some(mass) = body.child_f64("mass").unwrap_or_else(|e| panic!("{name}: {e}")) {
                assert!(mass >= 0.0, "{name}: {}", body.describe());
            }
        }
    }
}

#[test]
fn setups_say_what_they_say() {
    let Some(folder) = data() else { return };
    let read = |name| setup::from_bytes(&bytes(&folder, name)).unwrap();
    let inline = |tasks: &IkTasks| match tasks {
        IkTasks::Inline(set) => set.clone(),
        IkTasks::File(file) => panic!("tasks are in {file}"),
    };

    let arm = read("ik/arm26/arm26_Setup_InverseKinematics.xml");
    assert!(arm.warnings.is_empty(), "{:?}", arm.warnings);
    let arm = arm.value;
    assert_eq!(arm.name, "arm26");
    assert_eq!(arm.model_file.as_deref(), Some("arm26.osim"));
    assert_eq!(arm.marker_file.as_deref(), Some("arm26_elbow_flex.trc"));
    assert_eq!(arm.coordinate_file, None);
    assert_eq!(arm.constraint_weight, f64::INFINITY);
    assert_eq!(arm.accuracy, 1e-5);
    let tasks = inline(&arm.tasks);
    assert_eq!(tasks.markers.len(), 3);
    assert_eq!(tasks.markers[1].name, "r_humerus_epicondyle");

    let walk = read("ik/gait10dof/walk_Setup_IK.xml").value;
    assert_eq!(walk.constraint_weight, f64::INFINITY);
    let tasks = inline(&walk.tasks);
    let head = tasks.markers.iter().find(|m| m.name == "Top.Head").unwrap();
    assert_eq!((head.apply, head.weight), (true, 3.0));

    let pins = read("ik/core_abdbonepin/setup_ik_abdbonepin.xml").value;
    assert_eq!(pins.accuracy, 1e-6);
    assert_eq!(inline(&pins.tasks).markers.len(), 11);

    let shoulder = read("shoulder/thoracoscapular/IKSetup_2019.xml").value;
    assert_eq!(shoulder.time_range, Some([0.0, 100.0]));
    assert_eq!((shoulder.model_file, shoulder.output_motion_file), (None, None));

    // The tool's name is misspelt, the tasks are in a file of their own.
    let subject = read("ik/core_subject01/subject01_Setup_InverseKinematics.xml");
    let codes: Vec<_> = subject.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["setup/misspelt"]);
    let subject = subject.value;
    assert_eq!(subject.constraint_weight, 10.0);
    assert_eq!(subject.time_range, Some([0.4, 1.6]));
    let IkTasks::File(file) = subject.tasks else { panic!("tasks are in a file") };
    assert_eq!(file, "gait2354_IK_Tasks_uniform.xml");
    let tasks = setup::tasks_from_bytes(&bytes(&folder, &format!("ik/core_subject01/{file}")));
    let tasks = tasks.unwrap().value;
    assert!(tasks.markers.iter().all(|m| m.weight == 1.0));

    let weighted =
        setup::tasks_from_bytes(&bytes(&folder, "ik/core_subject01/gait2354_IK_Tasks.xml"));
    // It closes a document that it never opened.
    let weighted = weighted.unwrap();
    assert!(weighted.warned("xml/stray-end"));
    let weighted = weighted.value;
    assert_eq!(weighted.markers.len(), tasks.markers.len());
    assert_eq!(weighted.coordinates[0].name, "subtalar_angle_r");
    assert_eq!(weighted.coordinates[0].weight, 1000.0);
    assert_eq!(weighted.coordinates[0].target, CoordinateTarget::Default);
}
