//! A leg in a plane, whose every point has a formula, and recordings of it.
//!
//! The thigh turns by h about a hip at (0, 1, 0), the shank by k about a knee 0.4 m below it that
//! slides along the thigh's x by 0.02·k. Ankle and toe both have a coordinate `flexion`; that of
//! the ankle is locked at 0.1.

/// What the hip does at a time.
pub(crate) fn hip(t: f64) -> f64 {
    0.5 * (3.0 * t).sin()
}

/// What the knee does at a time.
pub(crate) fn knee(t: f64) -> f64 {
    -0.6 + 0.4 * (5.0 * t).cos()
}

/// Name, segment and place in it.
pub(crate) const MARKERS: [(&str, &str, [f64; 2]); 6] = [
    ("HIP", "thigh", [0.05, 0.0]),
    ("MID", "thigh", [0.06, -0.2]),
    ("KNEE", "thigh", [0.04, -0.4]),
    ("TIBIA", "shank", [0.05, -0.1]),
    ("SHIN", "shank", [-0.04, -0.25]),
    ("ANKLE", "shank", [0.02, -0.4]),
];

fn turned(angle: f64, p: [f64; 2]) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

/// A point of the thigh in the world.
pub(crate) fn thigh(h: f64, p: [f64; 2]) -> [f64; 2] {
    let [x, y] = turned(h, p);
    [x, 1.0 + y]
}

/// A point of the shank in the world.
pub(crate) fn shank(h: f64, k: f64, p: [f64; 2]) -> [f64; 2] {
    let [x, y] = turned(k, p);
    thigh(h, [x + 0.02 * k, y - 0.4])
}

/// The place of a marker of [`MARKERS`].
pub(crate) fn marker(index: usize, h: f64, k: f64) -> [f64; 2] {
    let (_, segment, point) = MARKERS[index];
    if segment == "thigh" { thigh(h, point) } else { shank(h, k, point) }
}

fn joint(kind: &str, name: &str, parent: &str, at: [f64; 2], child: &str, inside: &str) -> String {
    format!(
        "<{kind} name=\"{name}\"><socket_parent_frame>{name}_place</socket_parent_frame>\
         <socket_child_frame>/bodyset/{child}</socket_child_frame>{inside}\
         <frames><PhysicalOffsetFrame name=\"{name}_place\">\
         <socket_parent>{parent}</socket_parent>\
         <translation>{} {} 0</translation></PhysicalOffsetFrame></frames></{kind}>\n",
        at[0], at[1]
    )
}

fn coordinate(name: &str, inside: &str) -> String {
    format!("<Coordinate name=\"{name}\">{inside}</Coordinate>")
}

/// The model as a file of OpenSim.
pub(crate) fn osim() -> String {
    let hip = coordinate("hip_flexion", "<range>-1.5 2</range><clamped>true</clamped>");
    let knee = coordinate("knee_angle", "<range>-2.5 0.2</range>") + &coordinate("knee_slide", "");
    let ankle = coordinate("flexion", "<default_value>0.1</default_value><locked>true</locked>");
    let toe = coordinate("flexion", "");
    let list = |inside: &str| format!("<coordinates>{inside}</coordinates>");
    let axis = |name: &str, of: &str, along: &str| {
        format!(
            "<TransformAxis name=\"{name}\"><coordinates>{of}</coordinates><axis>{along}</axis>\
             <LinearFunction><coefficients>1 0</coefficients></LinearFunction></TransformAxis>"
        )
    };
    let motion = format!(
        "{}<SpatialTransform>{}{}</SpatialTransform>",
        list(&knee),
        axis("rotation1", "knee_angle", "0 0 1"),
        axis("translation1", "knee_slide", "1 0 0")
            .replace("<axis>", "<is_rotation>false</is_rotation><axis>"),
    );
    let markers: String = MARKERS
        .iter()
        .map(|(name, segment, [x, y])| {
            format!(
                "<Marker name=\"{name}\"><socket_parent_frame>/bodyset/{segment}\
                 </socket_parent_frame><location>{x} {y} 0</location></Marker>\n"
            )
        })
        .collect();
    let bodies: String = ["thigh", "shank", "foot", "toes"]
        .iter()
        .map(|name| format!("<Body name=\"{name}\"/>"))
        .collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenSimDocument Version=\"40000\">\n\
         <Model name=\"leg\"><Ground name=\"ground\"/>\n\
         <BodySet><objects>{bodies}</objects></BodySet>\n<JointSet><objects>\n{}{}{}{}</objects>\
         </JointSet>\n<ConstraintSet><objects><CoordinateCouplerConstraint name=\"slides\">\
         <coupled_coordinates_function><LinearFunction><coefficients>0.02 0</coefficients>\
         </LinearFunction></coupled_coordinates_function>\
         <independent_coordinate_names>knee_angle</independent_coordinate_names>\
         <dependent_coordinate_name>knee_slide</dependent_coordinate_name>\
         </CoordinateCouplerConstraint></objects></ConstraintSet>\n\
         <MarkerSet><objects>\n{markers}</objects></MarkerSet></Model></OpenSimDocument>\n",
        joint("PinJoint", "hip", "/ground", [0.0, 1.0], "thigh", &list(&hip)),
        joint("CustomJoint", "knee", "/bodyset/thigh", [0.0, -0.4], "shank", &motion),
        joint("PinJoint", "ankle", "/bodyset/shank", [0.0, -0.4], "foot", &list(&ankle)),
        joint("PinJoint", "toe", "/bodyset/foot", [0.15, -0.05], "toes", &list(&toe)),
    )
}

/// A recording of the leg in millimetres at 100 Hz; `seen` says which marker is seen in a frame.
pub(crate) fn trc(frames: usize, seen: impl Fn(usize, usize) -> bool) -> String {
    let names: Vec<&str> = MARKERS.iter().map(|m| m.0).collect();
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\tleg.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n\
         100\t100\t{frames}\t{}\tmm\nFrame#\tTime\t{}\n\n\n",
        names.len(),
        names.join("\t\t\t"),
    );
    for frame in 0..frames {
        let t = frame as f64 / 100.0;
        text.push_str(&format!("{}\t{t}", frame + 1));
        for index in 0..MARKERS.len() {
            if seen(frame, index) {
                let [x, y] = marker(index, hip(t), knee(t));
                text.push_str(&format!("\t{}\t{}\t0", 1e3 * x, 1e3 * y));
            } else {
                text.push_str("\t\t\t");
            }
        }
        text.push('\n');
    }
    text
}

/// The motion of hip and knee alone, in degrees.
pub(crate) fn mot(frames: usize) -> String {
    let mut text =
        "leg\nversion=1\ninDegrees=yes\nendheader\ntime\thip_flexion\tknee_angle\n".to_owned();
    for frame in 0..frames {
        let t = frame as f64 / 100.0;
        text.push_str(&format!("{t}\t{}\t{}\n", hip(t).to_degrees(), knee(t).to_degrees()));
    }
    text
}
