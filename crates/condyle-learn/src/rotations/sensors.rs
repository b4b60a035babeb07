//! Orientations of inertial sensors.

use crate::frames::Orientated;
use condyle_diagnostics::{Diagnostic, Error, did_you_mean, listed};
use condyle_motion::Orientations;

/// The rotations of one sensor in another, or without one in the sensors' world.
///
/// How the sensors sit on their segments is not known: the rotations are those of the sensors, which differ from the
/// segments' by a fixed rotation on either side. A sensor `femur_r_imu` is found as `femur_r` as well.
///
/// # Errors
/// `rotations/sensor` for a name that no sensor has.
///
/// ```
/// use condyle_learn::rotations::of_sensors;
/// use condyle_math::{Quat, Vec3};
/// use condyle_motion::Orientations;
/// let turn = |angle| Some(Quat::from_axis_angle(Vec3::Z, angle));
/// let recording = Orientations {
///     labels: vec!["pelvis_imu".into(), "femur_r_imu".into()],
///     times: vec![0.0, 0.1],
///     rotations: vec![turn(0.5), turn(0.9), turn(1.0), None],
///     ..Orientations::default()
/// };
/// let found = of_sensors(&recording, "femur_r", Some("pelvis_imu"))?;
/// assert_eq!((found.frames.as_slice(), found.missing), (&[0][..], 1));
/// assert!((found.rotations[0].log().z - 0.4).abs() < 1e-12);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
pub fn of_sensors(
    recording: &Orientations,
    child: &str,
    reference: Option<&str>,
) -> Result<Orientated, Error> {
    let child = sensor(recording, child)?;
    let reference = reference.map(|name| sensor(recording, name)).transpose()?;
    let mut said = Orientated::default();
    for frame in 0..recording.frames() {
        let seen = |sensor| recording.rotation(frame, sensor);
        let rotation = match reference {
            None => seen(child),
            Some(reference) => seen(reference).zip(seen(child)).map(|(r, c)| r.conjugate() * c),
        };
        match rotation {
            Some(rotation) => said.push(frame, rotation),
            None => said.missing += 1,
        }
    }
    Ok(said)
}

fn sensor(recording: &Orientations, name: &str) -> Result<usize, Error> {
    let bare = |label: &str| label.strip_suffix("_imu").unwrap_or(label).to_owned();
    let labels = &recording.labels;
    let exact = labels.iter().position(|label| label == name);
    if let Some(found) = exact.or_else(|| labels.iter().position(|label| bare(label) == name)) {
        return Ok(found);
    }
    let message = format!("the recording has no sensor `{name}`");
    let otherwise = || format!("its sensors are {}", listed(labels));
    let help = did_you_mean(name, labels.iter().map(String::as_str), otherwise);
    Err(Diagnostic::error("rotations/sensor", message).with_help(help).into())
}
