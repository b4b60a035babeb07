//! What a page is given to show.

use crate::base64::base64;
use condyle::formats::{Content, exchange};
use condyle::open::{self, Cause, OpenError};
use condyle::tracking::{Request, track};
use condyle::{Animation, Figure, Model, Read, geometry};
use condyle_wasm::{Answer, Shown, skins, surfaces};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Where a page with a session is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It comes from the server of `condyle view`, which edits files and tells changes.
    Served,
    /// It is a file of its own.
    Exported,
}

/// A model with motions and recordings of it: all that a page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// What stands above the page.
    pub title: String,
    /// The model.
    pub model: Model,
    /// The motions, in the order in which they were named.
    pub motions: Vec<Shown>,
    /// What the model looks like beside its own shapes: `meshes` that its file names, and a `skin`, where there are any.
    pub geometry: Vec<(&'static str, Answer)>,
    /// The text file of the model where the page may edit it.
    pub source: Option<String>,
}

impl Session {
    /// A session of a model alone.
    #[must_use]
    pub fn of(model: Model) -> Self {
        let title = model.name().to_owned();
        Self { title, model, motions: vec![], geometry: vec![], source: None }
    }

    /// Opens a model, and motions or recordings of it; a recording is tracked. A motion that the model's own
    /// file holds comes first. Meshes that an `.osim` names are looked for in `meshes`, too, as [`geometry::open`] does.
    ///
    /// # Errors
    /// As [`open::content`]; a recording that cannot be tracked.
    pub fn open(
        model: &Path,
        motions: &[PathBuf],
        meshes: &[PathBuf],
    ) -> Result<Read<Self>, OpenError> {
        let Read { value: Animation { model: found, motion }, mut warnings } =
            open::animation(model)?;
        let mut session = Self::of(found);
        let stem = model.file_stem().unwrap_or_default().to_string_lossy();
        session.title = stem.into_owned();
        let read = geometry::open(model, &session.model, meshes)?;
        warnings.extend(read.warnings);
        let figure = Figure::new(&session.model).with(read.value);
        if !figure.meshes.is_empty() {
            session.geometry.push(("meshes", surfaces(&figure.meshes)));
        }
        if !figure.skins.is_empty() {
            session.geometry.push(("skin", skins(&figure.skins)));
        }
        if motion.frames.len() > 1 {
            session.motions.push(Shown::of(name(model), motion));
        }
        for path in motions {
            let read = shown(path, &session.model)?;
            warnings.extend(read.warnings);
            session.motions.push(read.value);
        }
        Ok(Read { value: session, warnings })
    }

    /// The session as the page reads it. Its motions are in single precision, its model is exact.
    #[must_use]
    pub fn to_json(&self, mode: Mode) -> String {
        let text = exchange::write(&self.model);
        // Numbers stand in a file of their own, or in a page that has no other files inside of it.
        let look = |(name, answer): &(&str, Answer)| {
            let at = match mode {
                Mode::Served => json!(format!("files/{name}")),
                Mode::Exported => Value::Null,
            };
            let numbers = match mode {
                Mode::Served => Value::Null,
                Mode::Exported => base64(&answer.numbers).into(),
            };
            let text: Value = serde_json::from_str(&answer.text).unwrap_or_default();
            ((*name).to_owned(), json!({ "at": at, "numbers": numbers, "text": text }))
        };
        let geometry: serde_json::Map<String, Value> = self.geometry.iter().map(look).collect();
        let mode = match mode {
            Mode::Served => "served",
            Mode::Exported => "exported",
        };
        json!({
            "condyle": 1,
            "mode": mode,
            "title": self.title,
            "model": {
                "name": self.model.name(),
                "format": "json",
                "text": text,
                "geometry": geometry,
            },
            "motions": self.motions.iter().map(|shown| shown.to_json(packed)).collect::<Vec<_>>(),
            "editable": self.source.is_some(),
            "source": self.source,
        })
        .to_string()
    }
}

/// Opens a motion of a model, or a recording, which is tracked.
///
/// # Errors
/// As [`open::content`]; a recording that cannot be tracked.
pub fn shown(path: &Path, model: &Model) -> Result<Read<Shown>, OpenError> {
    let (recording, mut warnings) = match open::content(path, None)? {
        Read { value: Content::Recording(recording), warnings } => (recording, warnings),
        Read { value: Content::Trial(trial), warnings } => (trial.recording, warnings),
        Read { value: Content::Poses(_), .. } => {
            let poses = open::poses(path, model)?;
            return Ok(poses.map(|poses| Shown::of(name(path), poses.motion)));
        }
        _ => return Ok(open::motion(path, model)?.map(|motion| Shown::of(name(path), motion))),
    };
    let tracking = track(model, &recording, &Request::default(), &mut |_, _| {});
    let tracking = tracking.map_err(|error| OpenError {
        path: path.to_owned(),
        cause: Cause::Content { error, text: None },
    })?;
    warnings.extend(tracking.warnings.iter().cloned());
    Ok(Read { value: Shown::tracked(name(path), model, &recording, &tracking), warnings })
}

/// Single precision, the least byte first.
fn packed(numbers: &mut dyn Iterator<Item = f64>) -> Value {
    let bytes = numbers.flat_map(|x| (x as f32).to_le_bytes());
    base64(&bytes.collect::<Vec<u8>>()).into()
}

/// The last part of a path.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle::Motion;

    #[test]
    fn a_session_says_what_it_holds() -> Result<(), OpenError> {
        let mut session = Session::open("knee".as_ref(), &[], &[])?.value;
        let motion = Motion { times: vec![0.0, 0.5], frames: vec![vec![0.25], vec![-1.0]] };
        session.motions.push(Shown::of("bend.mot".to_owned(), motion));
        let json: Value = serde_json::from_str(&session.to_json(Mode::Served)).expect("it is JSON");
        assert_eq!((&json["mode"], &json["title"]), (&json!("served"), &json!("knee")));
        // 0.25 and -1 in single precision are 0x3e800000 and 0xbf800000.
        assert_eq!(json["motions"][0]["values"], json!("AACAPgAAgL8="));
        let text = json["model"]["text"].as_str().expect("a text");
        let read = exchange::read(text.as_bytes()).expect("a model");
        assert!(read.value.find_coordinate("knee_angle_r").is_ok());
        assert_eq!(json["editable"], json!(false));
        Ok(())
    }

    #[test]
    fn meshes_that_a_model_names_come_along() -> Result<(), Box<dyn std::error::Error>> {
        let folder = std::env::temp_dir().join(format!("condyle-meshes-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("Geometry"))?;
        let mesh = |name| format!("<Mesh name='{name}'><mesh_file>{name}.obj</mesh_file></Mesh>");
        let text = format!(
            "<OpenSimDocument Version='40000'><Model name='arm'><BodySet><objects><Body name='ulna'>\
             <attached_geometry>{}{}</attached_geometry></Body></objects></BodySet></Model></OpenSimDocument>",
            mesh("ulna"),
            mesh("radius")
        );
        std::fs::write(folder.join("arm.osim"), text)?;
        std::fs::write(folder.join("Geometry/ulna.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n")?;
        let read = Session::open(&folder.join("arm.osim"), &[], &[])?;
        let missing = read.warnings.iter().filter(|said| said.code == "geometry/missing");
        let missing: Vec<String> = missing.map(|said| said.message.clone()).collect();
        assert_eq!(missing, ["1 of 2 mesh files are not there: `radius.obj`"]);
        let json: Value = serde_json::from_str(&read.value.to_json(Mode::Served))?;
        let meshes = &json["model"]["geometry"]["meshes"];
        assert_eq!((&meshes["at"], &meshes["numbers"]), (&json!("files/meshes"), &Value::Null));
        assert_eq!(meshes["text"]["positions"], json!([0, 9]));
        // The last number of the third corner is a half.
        assert_eq!(read.value.geometry[0].1.numbers[32..36], 0.5f32.to_le_bytes());
        let json: Value = serde_json::from_str(&read.value.to_json(Mode::Exported))?;
        assert!(json["model"]["geometry"]["meshes"]["numbers"].is_string());
        // Others in a folder that is given, for this session and no other.
        let other = folder.join("other");
        std::fs::create_dir_all(&other)?;
        std::fs::write(other.join("radius.obj"), "v 0 0 0\nv 0 1 0\nv 0 0 2\nf 1 2 3\n")?;
        for (folders, count) in [(vec![], 9), (vec![other], 18), (vec![], 9)] {
            let read = Session::open(&folder.join("arm.osim"), &[], &folders)?;
            let json: Value = serde_json::from_str(&read.value.to_json(Mode::Served))?;
            let positions = &json["model"]["geometry"]["meshes"]["text"]["positions"];
            assert_eq!(positions, &json!([0, count]), "{folders:?}");
        }
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }
}
