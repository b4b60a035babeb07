//! Scaling of model files by setups: what is measured, and where markers go.
#![cfg(feature = "opensim")]

use condyle::formats::opensim::scale::{MarkerPlace, model_of, with_markers_at};
use condyle::formats::opensim::scale_setup;
use condyle::subject::{Asked, ScaleRules, Subject, scale};
use condyle::{LengthUnit, Mode, Pose, Program, Recording};

const MODEL: &str = r#"<OpenSimDocument Version="40000"><Model name="leg"><BodySet><objects>
<Body name="thigh"><mass>6</mass></Body><Body name="shank"><mass>4</mass></Body></objects></BodySet>
<JointSet><objects>
<FreeJoint name="hip"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/thigh</socket_child_frame>
<coordinates><Coordinate name="rx"/><Coordinate name="ry"/><Coordinate name="rz"/><Coordinate name="tx"/><Coordinate name="ty"/><Coordinate name="tz"/></coordinates></FreeJoint>
<PinJoint name="knee"><socket_parent_frame>above</socket_parent_frame><socket_child_frame>/bodyset/shank</socket_child_frame>
<coordinates><Coordinate name="bend"/></coordinates>
<frames><PhysicalOffsetFrame name="above"><socket_parent>/bodyset/thigh</socket_parent><translation>0 -0.4 0</translation></PhysicalOffsetFrame></frames></PinJoint>
</objects></JointSet><MarkerSet><objects>
<Marker name="A"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0.1 0 0.05</location></Marker>
<Marker name="B"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0 -0.4 0.05</location></Marker>
<Marker name="C"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>-0.1 -0.1 -0.08</location></Marker>
<Marker name="D"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0.02 -0.1 0.04</location></Marker>
<Marker name="E"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0.02 -0.4 0.04</location></Marker>
<Marker name="loose"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0 -0.2 0.05</location></Marker>
<Marker name="tight"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0 -0.3 0.05</location><fixed>true</fixed></Marker>
<Marker name="gone"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0 -0.3 0</location></Marker>
</objects></MarkerSet></Model></OpenSimDocument>"#;

const SETUP: &str = r#"<OpenSimDocument Version="40000"><ScaleTool name="s"><mass>20</mass>
<ModelScaler><scaling_order>manualScale measurements</scaling_order>
<ScaleSet><objects><Scale><scales>1.2 7 1.1</scales><segment>thigh</segment></Scale></objects></ScaleSet>
<MeasurementSet><objects>
<Measurement name="shank"><MarkerPairSet><objects><MarkerPair><markers>D E</markers></MarkerPair></objects></MarkerPairSet>
<BodyScaleSet><objects><BodyScale name="shank"><axes>X Y Z</axes></BodyScale><BodyScale name="thigh"><axes>Y</axes></BodyScale></objects></BodyScaleSet></Measurement>
<Measurement name="half"><MarkerPairSet><objects><MarkerPair><markers>D E</markers></MarkerPair><MarkerPair><markers>D gone</markers></MarkerPair></objects></MarkerPairSet>
<BodyScaleSet><objects><BodyScale name="shank"><axes>X</axes></BodyScale></objects></BodyScaleSet></Measurement>
</objects></MeasurementSet><time_range>1 2</time_range></ModelScaler>
<MarkerPlacer><IKTaskSet><objects>
<IKMarkerTask name="A"><weight>1</weight></IKMarkerTask><IKMarkerTask name="B"><weight>1</weight></IKMarkerTask>
<IKMarkerTask name="C"><weight>1</weight></IKMarkerTask><IKMarkerTask name="D"><weight>1</weight></IKMarkerTask>
<IKMarkerTask name="E"><weight>1</weight></IKMarkerTask></objects></IKTaskSet>
<time_range>1 2</time_range><max_marker_movement>0.05</max_marker_movement></MarkerPlacer></ScaleTool></OpenSimDocument>"#;

/// The true person: thigh by 1.2, 0.9, 1.1, shank by 0.9; two markers lie 2 cm lower than on the model.
fn person() -> Recording {
    let factors = [("thigh".to_owned(), [1.2, 0.9, 1.1]), ("shank".to_owned(), [0.9; 3])].into();
    let text = condyle::formats::opensim::scale::scale(
        MODEL,
        &factors,
        &ScaleRules::default(),
        &mut |m| m.defaults(),
    );
    let text = text.unwrap().value.text;
    let at = |name: &str, in_body: [f64; 3]| MarkerPlace { name: name.to_owned(), in_body };
    let moved = [at("loose", [0.0, -0.2, 0.045]), at("tight", [0.0, -0.29, 0.045])];
    let model = model_of(&with_markers_at(&text, &moved).unwrap()).unwrap().value;
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let stored = [0.1, -0.2, 0.3, 0.4, 1.0, -0.2, -0.5];
    program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
    let markers = || model.markers().iter().filter(|m| m.name != "gone");
    let still = |m: &condyle::model::model::Marker| (pose.frame(m.segment) * m.point).to_array();
    // Frames at 0.9 to 2.1 s, of which the first and the last are nonsense.
    let times: Vec<f64> = (0..13).map(|i| 0.9 + 0.1 * f64::from(i)).collect();
    let frame = |i: usize| {
        let nonsense = if (1..12).contains(&i) { 0.0 } else { 1.0 };
        // A sway whose mean over the frames that count is 0.
        let sway = 0.004 * (i as f64 - 6.0);
        markers().map(move |m| {
            let [x, y, z] = still(m);
            [x + sway, y, z + nonsense].into()
        })
    };
    Recording {
        labels: markers().map(|m| m.name.clone()).collect(),
        rate: 10.0,
        positions: (0..times.len()).flat_map(frame).collect(),
        times,
        units: LengthUnit::Metre,
        ..Recording::default()
    }
}

fn subject(setup: &str, as_opensim: bool) -> Result<Subject, condyle::Error> {
    let setup = scale_setup::read(setup.as_bytes(), &mut |_| Err("none".into())).unwrap().value;
    let rules = ScaleRules { as_opensim, ..ScaleRules::default() };
    let recording = person();
    let asked = Asked {
        setup: &setup,
        rules: &rules,
        measured: Some(&recording),
        stands: Some(&recording),
        coordinates: None,
    };
    scale(MODEL, &asked)
}

#[test]
fn a_person_is_measured_and_markers_go_where_they_were_seen() {
    let done = subject(SETUP, false).unwrap();
    // By hand first, then by measurement along y.
    let is = |body: &str, factors: [f64; 3]| {
        for (a, b) in done.factors[body].iter().zip(factors) {
            assert!((a - b).abs() < 1e-12, "{body} {:?}", done.factors);
        }
    };
    is("thigh", [1.2, 0.9, 1.1]);
    is("shank", [0.9; 3]);
    // A measurement with a marker that was not recorded is not used, as in OpenSim.
    assert_eq!(done.measurements[1].factor, None);
    assert!(done.warnings.iter().any(|w| w.code == "scale/measurement"));
    assert!((done.report.mass()[1] - 20.0).abs() < 1e-12);
    let placed = done.placed.unwrap();
    assert!(placed.status.is_solved() && placed.rms < 1e-7, "{}", placed.rms);
    assert_eq!(placed.unseen, ["gone"]);
    // The fixed one stays 2 cm off, the loose one is where it was seen.
    assert!((placed.rms_fixed().unwrap() - 0.02).abs() < 1e-6);
    let model = model_of(&done.text).unwrap().value;
    let at = |name: &str| model.markers().iter().find(|m| m.name == name).unwrap().point.to_array();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near(at("loose"), [0.0, -0.2, 0.045]), "{:?}", at("loose"));
    assert!(near(at("tight"), [0.0, -0.27, 0.045]), "{:?}", at("tight"));
    assert!(near(at("gone"), [0.0, -0.27, 0.0]));
}

#[test]
fn as_opensim_markers_that_were_not_recorded_are_deleted() {
    let done = subject(SETUP, true).unwrap();
    assert!(!done.text.contains("\"gone\"") && done.text.contains("\"tight\""));
}

#[test]
fn what_cannot_be_done_is_refused() {
    let code = |setup: &str| subject(setup, false).unwrap_err().code().to_owned();
    // The sway is 40 mm from the first to the last frame that counts.
    assert_eq!(code(&SETUP.replace("0.05</max", "0.03</max")), "scale/movement");
    assert_eq!(code(&SETUP.replace("<time_range>1 2", "<time_range>5 6")), "scale/no-frames");
}
