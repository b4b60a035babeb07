use super::*;

fn tool(inside: &str) -> Result<Read<IkSetup>, Error> {
    read(&format!("<InverseKinematicsTool>\n{inside}</InverseKinematicsTool>"))
}

#[test]
fn everything_has_a_default() {
    let read = tool("").unwrap();
    assert!(read.warned("setup/no-tasks"));
    let setup = read.value;
    assert_eq!(setup.model_file, None);
    assert_eq!(setup.time_range, None);
    assert_eq!(setup.constraint_weight, f64::INFINITY);
    assert_eq!(setup.accuracy, 1e-5);
    assert_eq!(setup.tasks, IkTasks::Inline(IkTaskSet::default()));
}

#[test]
fn infinity_has_many_names() {
    for (text, weight) in [
        ("Inf", f64::INFINITY),
        (" infinity ", f64::INFINITY),
        ("Infinity", f64::INFINITY),
        ("", f64::INFINITY),
        ("Unassigned", f64::INFINITY),
        ("1.#INF", f64::INFINITY),
        ("20", 20.0),
        ("1e-005", 1e-5),
    ] {
        let text = format!("<constraint_weight>{text}</constraint_weight>");
        assert_eq!(tool(&text).unwrap().value.constraint_weight, weight, "{text}");
    }
}

#[test]
fn tasks_of_both_kinds() {
    let read = tool(
        "<IKTaskSet><objects>
          <IKMarkerTask name='a'><apply>FALSE</apply><weight>2</weight></IKMarkerTask>
          <IKMarkerTask name='a'><weight>3</weight></IKMarkerTask>
          <IKCoordinateTask name='k'><weight>1000</weight>
            <value_type>manual_value</value_type><value>0.25</value></IKCoordinateTask>
          <IKCoordinateTask name='f'><weight>1</weight>
            <value_type>from_file</value_type></IKCoordinateTask>
          <IKCoordinateTask name='d'/>
          <IKSensorTask/>
        </objects><groups/></IKTaskSet>",
    )
    .unwrap();
    let codes: Vec<_> = read.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["setup/duplicate-task", "setup/no-weight", "setup/unknown-task"]);
    let IkTasks::Inline(tasks) = read.value.tasks else { panic!("tasks are inline") };
    assert_eq!(tasks.markers, [MarkerTask { name: "a".into(), apply: false, weight: 2.0 }]);
    let targets: Vec<_> = tasks.coordinates.iter().map(|t| t.target).collect();
    assert_eq!(
        targets,
        [CoordinateTarget::Manual(0.25), CoordinateTarget::FromFile, CoordinateTarget::Default]
    );
    assert_eq!(tasks.coordinates[2].weight, 0.0);
}

#[test]
fn faults_are_placed() {
    for (text, said) in [
        ("<time_range>2 1</time_range>", "line 2, column 1: the time range `2 1` is reversed"),
        ("<time_range>2</time_range>", "line 2, column 1: <time_range> holds 1 numbers"),
        ("<accuracy>fine</accuracy>", "line 2, column 1: `fine` in <accuracy> is not a number"),
        (
            "<IKTaskSet><objects><IKMarkerTask name='a'><weight>-1</weight>\
             </IKMarkerTask></objects></IKTaskSet>",
            "line 2, column 44: the weight -1 of <IKMarkerTask name=\"a\">",
        ),
        (
            "<IKTaskSet><objects><IKMarkerTask><weight>1</weight></IKMarkerTask></objects>\
             </IKTaskSet>",
            "line 2, column 21: <IKMarkerTask> has no attribute `name`",
        ),
        (
            "<IKTaskSet><IKCoordinateTask name='a'><value_type>x</value_type>\
             </IKCoordinateTask></IKTaskSet>",
            "line 2, column 39: `x` is not a type of value",
        ),
    ] {
        let error = tool(text).unwrap_err().to_string();
        assert!(error.starts_with(said), "{error}");
    }
}

#[test]
fn a_misspelt_tool_is_read_and_another_is_not() {
    let read = read("<OpenSimDocument><InverseKinemtaticsTool/></OpenSimDocument>").unwrap();
    assert!(read.warned("setup/misspelt"));
    let error =
        super::read("<OpenSimDocument><InverseDynamicsTool/></OpenSimDocument>").unwrap_err();
    assert_eq!(error.code(), "setup/not-ik");
}

#[test]
fn the_tool_of_old_versions_and_times_without_a_value_are_read() {
    let read = read("<OpenSimDocument><IKTool name='x'/></OpenSimDocument>").unwrap();
    assert!(!read.warned("setup/misspelt"));
    assert_eq!(read.value.name, "x");
    for text in ["Unassigned", "", "-Inf Inf", "Unassigned Unassigned", "-1 -1", "-1.#INF 1.#INF"] {
        let text = format!("<time_range>{text}</time_range>");
        assert_eq!(tool(&text).unwrap().value.time_range, None, "{text}");
    }
    assert_eq!(tool("<time_range>1 2</time_range>").unwrap().value.time_range, Some([1.0, 2.0]));
}

#[test]
fn the_first_trial_of_an_old_tool_is_read() {
    let trial = |name: &str, to: f64| {
        format!(
            "<IKTrial name='{name}'><marker_file>{name}.trc</marker_file><coordinate_file/>\
             <time_range>0.5 {to}</time_range></IKTrial>"
        )
    };
    let text = format!(
        "<IKTool name='x'><model_file>a.osim</model_file><optimizer_algorithm>cfsqp\
         </optimizer_algorithm><IKTaskSet><IKMarkerTask name='a'><weight>2</weight>\
         </IKMarkerTask></IKTaskSet><IKTrialSet><objects>{}{}</objects></IKTrialSet></IKTool>",
        trial("walk", 1.0),
        trial("run", 2.0)
    );
    let read = super::read(&text).unwrap();
    assert!(read.warned("setup/trials"));
    assert_eq!(read.value.marker_file.as_deref(), Some("walk.trc"));
    assert_eq!(read.value.time_range, Some([0.5, 1.0]));
    let IkTasks::Inline(tasks) = &read.value.tasks else { panic!("tasks are inline") };
    assert_eq!(tasks.markers[0].weight, 2.0);
    // The tasks of an old tool are found also where they alone are asked for.
    assert_eq!(&read_tasks(&text).unwrap().value, tasks);
}

#[test]
fn no_tasks_are_told_once() {
    for tasks in [
        "",
        "<IKTaskSet/>",
        "<IKTaskSet><objects/></IKTaskSet>",
        "<IKTaskSet><IKCoordinateTask name='k'><weight>1</weight></IKCoordinateTask></IKTaskSet>",
    ] {
        let codes: Vec<_> = tool(tasks).unwrap().warnings.iter().map(|w| w.code).collect();
        assert_eq!(codes, ["setup/no-tasks"], "{tasks}");
    }
}

#[test]
fn a_mistyped_property_is_told() {
    let read = tool("<marker_fil>a.trc</marker_fil><IKTaskSet/>").unwrap();
    assert_eq!(
        read.warnings[0].to_string(),
        "line 2, column 1: <marker_fil> is not known \
         (it was skipped; did you mean <marker_file>?)"
    );
}

#[test]
fn a_task_set_must_be_one() {
    assert_eq!(read_tasks("<Model/>").unwrap_err().code(), "setup/no-tasks");
    assert_eq!(read_tasks("<IKTaskSet file='x'/>").unwrap_err().code(), "setup/no-tasks");
    let wrapped = "<OpenSimDocument><IKTaskSet><objects/></IKTaskSet></OpenSimDocument>";
    assert_eq!(read_tasks(wrapped).unwrap().value, IkTaskSet::default());
}
