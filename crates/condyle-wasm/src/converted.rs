//! Files of all formats, brought to what the evaluator of the page reads.
//!
//! The page has readers of few formats, so that it stays small. A second module, built from this crate with the feature
//! `readers`, has the others; it is fetched when a file needs it, and knows nothing of poses.

use crate::answer::{Answer, Fault, fault, said, sentence};
use crate::shown::Shown;
use condyle::formats::skeleton::Assumed;
use condyle::formats::{Content, Format, Id, asf, exchange, trc};
use condyle::{Error, Read, Zeros, shipped};
use serde_json::{Value, json};

/// Brings a file to a form that [`read`](crate::read) takes: `{"model": text of a resolved model or null, "motion": … or null,
/// "recording": whether the numbers are the bytes of a marker recording (TRC), "warnings": […]}`. The motion is that which
/// the model's own file holds.
///
/// A take of Acclaim's (`.amc`) needs its skeleton, the file that was given before: `skeleton`.
///
/// # Errors
/// Everything that is wrong, as JSON.
///
/// ```
/// let urdf = br#"<robot name="arm"><link name="a"/><link name="b"/><joint name="j" type="revolute">
///     <parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0" upper="2"/></joint></robot>"#;
/// let answer = condyle_wasm::converted("arm.urdf", urdf, None).unwrap();
/// let text: serde_json::Value = serde_json::from_str(&answer.text).unwrap();
/// let model = text["model"].as_str().unwrap();
/// assert!(condyle_wasm::read(None, "arm.json", model.as_bytes()).is_ok());
/// ```
pub fn converted(name: &str, bytes: &[u8], skeleton: Option<&[u8]>) -> Result<Answer, Fault> {
    let wrong = |error: Error| fault(&error);
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let format = Format::of_ending(ending).or_else(|| Format::of_bytes(bytes));
    let format = format.ok_or_else(|| sentence(format!("{name}: this is of no known format")))?;
    let read = match (format.id, skeleton) {
        (Id::Amc, Some(skeleton)) => {
            let read = asf::with_skeleton(bytes, skeleton, &Assumed::default()).map_err(wrong)?;
            read.map(|animation| Content::Animation(Box::new(animation)))
        }
        (Id::Amc, None) => {
            return Err(sentence("a take needs its skeleton: give the .asf file first, or both"));
        }
        _ => {
            let mut include = |name: &str| {
                let own = shipped::included(name).map(str::to_owned);
                own.map_err(|_| format!("`{name}` is another file, which a page cannot open"))
            };
            format.read(bytes, &mut include).map_err(wrong)?
        }
    };
    let Read { value, mut warnings } = read;
    let mut answer = Answer::default();
    let (mut model, mut motion, mut recording) = (None, None, None);
    match value {
        Content::Model(found) => model = Some(found),
        Content::Document(document) => model = Some(document.model),
        Content::Animation(animation) => {
            model = Some(animation.model);
            motion = Some(animation.motion).filter(|motion| motion.frames.len() > 1);
        }
        Content::Recording(found) => recording = Some(found),
        Content::Trial(trial) => recording = Some(trial.recording),
        other => {
            let what = other.kind().name();
            return Err(sentence(format!("{name} holds {what}, which the page does not show")));
        }
    }
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    if let Some(model) = &mut model
        && model.name().is_empty()
    {
        model.set_name(stem);
    }
    let motion = motion
        .map(|motion| Shown::of(name.to_owned(), motion).to_json(|numbers| answer.floats(numbers)));
    if let Some(recording) = &mut recording {
        warnings.extend(recording.settle_zeros(Zeros::Told));
        answer.numbers = trc::write(recording, name).map_err(wrong)?.into_bytes();
    }
    let warnings: Vec<Value> = warnings.iter().map(said).collect();
    let text = json!({
        "model": model.as_ref().map(exchange::write),
        "motion": motion,
        "recording": recording.is_some(),
        "warnings": warnings,
    });
    answer.text = text.to_string();
    Ok(answer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle::{Motion, encode};

    fn written(ending: &str) -> (Vec<u8>, condyle::Model) {
        let knee = shipped::read("knee").expect("it is shipped").value.model;
        let format = Format::of_ending(ending).expect("a format");
        (encode::model(format, &knee).expect("it is written").value, knee)
    }

    fn model(answer: &Answer) -> condyle::Model {
        let text: Value = serde_json::from_str(&answer.text).expect("JSON");
        let model = text["model"].as_str().expect("a model");
        exchange::read(model.as_bytes()).expect("it is read").value
    }

    #[test]
    fn a_model_of_opensim_comes_as_the_page_reads_it() {
        let (bytes, knee) = written("osim");
        let answer = converted("knee.osim", &bytes, None).expect("it is read");
        let own = model(&answer);
        assert!(own.find_coordinate("knee_angle_r").is_ok());
        // What is written has a segment for each of ours, and may have more between them.
        assert!(own.segments().len() >= knee.segments().len());
    }

    #[test]
    fn a_scene_comes_with_its_motion() {
        let knee = shipped::read("knee").expect("it is shipped").value.model;
        let mut frames = vec![knee.defaults(); 3];
        frames[1][0] = -0.5;
        let motion = Motion { times: vec![0.0, 0.5, 1.0], frames };
        let bytes = encode::scene(&knee, &motion, condyle::Mode::Open, None).expect("a scene");
        let answer = converted("knee.glb", &bytes.value, None).expect("it is read");
        let text: Value = serde_json::from_str(&answer.text).expect("JSON");
        assert!(text["motion"]["times"].as_array().is_some_and(|times| times.len() >= 2));
        assert!(!model(&answer).segments().is_empty());
    }

    #[test]
    fn what_is_of_no_format_is_refused() {
        for (name, bytes) in
            [("a.xyz", &b"Dear Sir"[..]), ("a.osim", b"<x"), ("a.amc", b"1"), ("", b"")]
        {
            assert!(converted(name, bytes, None).is_err(), "{name}");
        }
    }
}
