//! Writing: the simplest dialect, which every reader accepts.

use crate::text::{decimal, plain};
use condyle_diagnostics::Error;
use condyle_motion::Recording;

/// Writes a recording in its own unit, tab-separated; a marker not seen leaves three blank cells.
///
/// Numbers have the shortest decimals that read back as the same lengths.
///
/// # Errors
///
/// `trc/shape` if labels, times and positions do not fit together, `trc/labels` if there is no
/// marker or one without a name.
///
/// ```
/// use condyle_formats::{LengthUnit, Recording, trc};
/// let recording = Recording {
///     labels: vec!["LASI".into()],
///     rate: 100.0,
///     times: vec![0.0],
///     positions: vec![[0.125, 0.9, -0.12].into()],
///     units: LengthUnit::Millimetre,
///     ..Recording::default()
/// };
/// let text = trc::write(&recording, "static.trc")?;
/// assert_eq!(text.lines().last(), Some("1\t0\t125\t900\t-120"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn write(recording: &Recording, name: &str) -> Result<String, Error> {
    write_with_remarks(recording, name, &[])
}

/// As [`write()`], with remarks in cells of the first line after the name of the file, where readers do not look.
///
/// # Errors
/// As [`write()`].
pub fn write_with_remarks(
    recording: &Recording,
    name: &str,
    remarks: &[String],
) -> Result<String, Error> {
    if let Some(mismatch) = recording.mismatch() {
        return Err(Error::new("trc/shape", mismatch));
    }
    if recording.labels.is_empty() || recording.labels.iter().any(|l| plain(l).is_empty()) {
        return Err(Error::new("trc/labels", "a recording needs markers, all with names"));
    }
    let (frames, markers) = (recording.frames(), recording.labels.len());
    let rate = decimal(recording.rate);
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\t{}{}\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t\
         OrigNumFrames\n\
         {rate}\t{rate}\t{frames}\t{markers}\t{}\t{rate}\t1\t{frames}\n",
        plain(name),
        remarks.iter().map(|remark| format!("\t{}", plain(remark))).collect::<String>(),
        recording.units.name(),
    );
    text.push_str("Frame#\tTime");
    for label in &recording.labels {
        text.push('\t');
        text.push_str(&plain(label));
        text.push_str("\t\t");
    }
    text.push_str("\n\t");
    for marker in 1..=markers {
        text.push_str(&format!("\tX{marker}\tY{marker}\tZ{marker}"));
    }
    text.push_str("\n\n");
    for (frame, time) in recording.times.iter().enumerate() {
        text.push_str(&format!("{}\t{}", frame + 1, decimal(*time)));
        for position in recording.frame(frame) {
            match position.position() {
                Some(position) => {
                    for x in position {
                        text.push('\t');
                        text.push_str(&decimal(recording.units.from_metres(x)));
                    }
                }
                None => text.push_str("\t\t\t"),
            }
        }
        text.push('\n');
    }
    Ok(text)
}
