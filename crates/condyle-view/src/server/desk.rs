//! What is shown and edited at present.

use super::messages::{Add, Edit, path_json};
use crate::{Mode, Session, shown};
use condyle::authoring::{Authoring, AuthoringError, Fault, Written};
use condyle::formats::document::edit::Editable;
use condyle::open::{self, Cause, OpenError};
use condyle::{Motion, Read, shipped};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::mpsc::{Receiver, Sender, channel};

/// How many pages hear of changes at a time.
const MOST: usize = 32;
/// How many changes a page may be behind before it is no longer told.
const BEHIND: usize = 64;

/// An answer to a page: a status and what it says.
pub(super) type Answer = (u16, Value);

/// The table at which the model is looked at and edited, for several pages at a time.
#[derive(Debug)]
pub(super) struct Desk {
    state: Mutex<State>,
    listeners: Mutex<Vec<Sender<String>>>,
}

#[derive(Debug)]
struct State {
    /// The model as it was asked for.
    model: Option<PathBuf>,
    motions: Vec<PathBuf>,
    meshes: Vec<PathBuf>,
    session: Option<Session>,
    /// The model's document; `None` of a model in another format, which cannot be edited.
    authoring: Option<Authoring>,
    /// What is wrong with the file at present.
    fault: Option<Fault>,
    /// The session as a page reads it, once one did.
    written: Option<String>,
}

impl Desk {
    pub(super) fn open(
        model: Option<&Path>,
        motions: &[PathBuf],
        meshes: &[PathBuf],
        folder: &Path,
    ) -> Result<Read<Self>, OpenError> {
        let mut warnings = vec![];
        let (mut session, mut authoring) = (None, None);
        if let Some(path) = model {
            let read = Session::open(path, motions, meshes)?;
            warnings = read.warnings;
            let mut opened = read.value;
            if is_document(path) {
                let document = Authoring::open_in(path, folder)?;
                opened.source =
                    document.path().file_name().map(|n| n.to_string_lossy().into_owned());
                authoring = Some(document);
            }
            session = Some(opened);
        }
        let (model, motions) = (model.map(Path::to_owned), motions.to_vec());
        let meshes = meshes.to_vec();
        let state =
            State { model, motions, meshes, session, authoring, fault: None, written: None };
        let desk = Self { state: Mutex::new(state), listeners: Mutex::new(vec![]) };
        Ok(Read { value: desk, warnings })
    }

    /// A request that panicked leaves the state as it was: each change is made whole.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The session as a page reads it.
    pub(super) fn session(&self) -> String {
        let mut state = self.state();
        if let Some(written) = &state.written {
            return written.clone();
        }
        let written = match &state.session {
            Some(session) => session.to_json(Mode::Served),
            None => json!({
                "condyle": 1, "mode": "served", "title": "condyle", "model": null, "motions": [],
                "editable": false, "source": null,
            })
            .to_string(),
        };
        state.written = Some(written.clone());
        written
    }

    /// The numbers of the document, with what can be undone and what is wrong with the file.
    pub(super) fn editable(&self) -> Value {
        let state = self.state();
        let Some(authoring) = &state.authoring else {
            return json!({ "values": [], "undo": false, "redo": false, "fault": null });
        };
        let editing = authoring.editing();
        let name = |file: &str| shown_name(&authoring.file(file));
        let values: Vec<Value> =
            editing.values().iter().map(|value| value_json(value, &name(&value.file))).collect();
        let (undo, redo) = authoring.history();
        json!({
            "file": shown_name(authoring.path()),
            "there": authoring.is_file(),
            "values": values,
            "undo": undo,
            "redo": redo,
            "fault": state.fault.as_ref().map(fault_json),
        })
    }

    /// The numbers of meshes or of a skin, by exactly their name: no name leads to a file.
    pub(super) fn mesh(&self, name: &str) -> Option<Vec<u8>> {
        let state = self.state();
        let session = state.session.as_ref()?;
        let (_, answer) = session.geometry.iter().find(|(own, _)| *own == name)?;
        Some(answer.numbers.clone())
    }

    pub(super) fn edit(&self, edit: &Edit) -> Answer {
        let mut state = self.state();
        let Some(authoring) = &mut state.authoring else { return not_editable() };
        if !edit.confirm {
            let questions = edit.values.iter().filter(|(path, value)| {
                authoring.editing().find(path).is_none_or(|found| found.value != *value)
            });
            let sentences: Vec<String> =
                questions.filter_map(|(path, _)| authoring.question(path, edit.way)).collect();
            if let Some(first) = sentences.first() {
                return (409, json!({ "needs": "confirm", "sentence": first }));
            }
        }
        let written = authoring.set_all(&edit.values, edit.way);
        self.told(state, written)
    }

    pub(super) fn add(&self, add: &Add) -> Answer {
        let mut state = self.state();
        let Some(authoring) = &mut state.authoring else { return not_editable() };
        let written = authoring.put_all(&add.table, &add.keys);
        self.told(state, written)
    }

    pub(super) fn undo(&self, again: bool) -> Answer {
        let mut state = self.state();
        let Some(authoring) = &mut state.authoring else { return not_editable() };
        let written = if again { authoring.redo() } else { authoring.undo() };
        self.told(state, written)
    }

    /// The answer to an edit, of which all pages are told.
    fn told(
        &self,
        mut state: MutexGuard<'_, State>,
        written: Result<Written, AuthoringError>,
    ) -> Answer {
        let written = match written {
            Ok(written) => written,
            Err(AuthoringError::Changed(file)) => {
                let file = shown_name(&file);
                let sentence =
                    format!("{file} was changed by another program: nothing was written");
                return (409, json!({ "needs": "reload", "sentence": sentence }));
            }
            Err(AuthoringError::Fault(fault)) => {
                return (422, json!({ "fault": fault_json(&fault) }));
            }
            Err(error @ AuthoringError::Io(..)) => {
                return (500, json!({ "error": error.to_string() }));
            }
            Err(error) => return (422, json!({ "error": error.to_string() })),
        };
        state.fault = None;
        state.renewed();
        drop(state);
        self.tell(&json!({ "kind": "model" }));
        let mirrored: Vec<Value> = written.mirrored.iter().map(|path| path_json(path)).collect();
        let file = shown_name(&written.file);
        // Of what is undone the whole file is old and new.
        let short = |text: &str| if text.len() > 4096 { Value::Null } else { Value::from(text) };
        let (old, new) = (short(&written.old), short(&written.new));
        (
            200,
            json!({ "file": file, "line": written.line, "old": old, "new": new, "mirrored": mirrored }),
        )
    }

    /// The files whose changes matter.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let state = self.state();
        match &state.authoring {
            Some(authoring) => authoring.files(),
            None => state.model.iter().filter(|path| path.is_file()).cloned().collect(),
        }
    }

    /// Reads changed files, and tells all pages what came of it.
    pub(super) fn reload(&self) {
        let mut locked = self.state();
        let state = &mut *locked;
        let before = state.fault.take();
        let was_wrong = before.is_some();
        let changed = match (&mut state.authoring, &state.model) {
            (Some(authoring), _) => authoring.reload(),
            (None, Some(model)) => match Session::open(model, &state.motions, &state.meshes) {
                Ok(read) => {
                    state.session = Some(read.value);
                    Ok(true)
                }
                Err(error) => Err(fault_of(model, &error)),
            },
            (None, None) => Ok(false),
        };
        let events: Vec<Value> = match changed {
            Ok(changed) => {
                if changed {
                    state.renewed();
                }
                let mended = was_wrong.then(|| json!({ "kind": "mended" }));
                let model = changed.then(|| json!({ "kind": "model" }));
                mended.into_iter().chain(model).collect()
            }
            Err(fault) => {
                let news = before.as_ref() != Some(&fault);
                let mut event = fault_json(&fault);
                event["kind"] = json!("fault");
                state.fault = Some(fault);
                if news { vec![event] } else { vec![] }
            }
        };
        drop(locked);
        for event in events {
            self.tell(&event);
        }
    }

    /// A page that wants to hear of changes; `None` if there are too many. It first hears what is wrong at present.
    pub(super) fn listen(&self) -> Option<Receiver<String>> {
        let wrong = self.state().fault.as_ref().map(fault_json);
        let mut listeners = self.listeners.lock().unwrap_or_else(PoisonError::into_inner);
        listeners.retain(|listener| !listener.is_closed());
        if listeners.len() >= MOST {
            return None;
        }
        let (sender, receiver) = channel(BEHIND);
        if let Some(mut event) = wrong {
            event["kind"] = json!("fault");
            // It was made for one message at least.
            let _ = sender.try_send(event.to_string());
        }
        listeners.push(sender);
        Some(receiver)
    }

    fn tell(&self, event: &Value) {
        let text = event.to_string();
        let mut listeners = self.listeners.lock().unwrap_or_else(PoisonError::into_inner);
        listeners.retain(|listener| listener.try_send(text.clone()).is_ok());
    }
}

impl State {
    /// The session shows the model as it is now. Motions stay where their coordinates do, others are opened anew.
    fn renewed(&mut self) {
        self.written = None;
        let (Some(session), Some(authoring)) = (&mut self.session, &self.authoring) else { return };
        let model = authoring.editing().document().model.clone();
        let same = session.model.coordinate_keys() == model.coordinate_keys()
            && session.model.stored_len() == model.stored_len();
        session.model = model;
        if !same {
            let opened = self.motions.iter().filter_map(|path| shown(path, &session.model).ok());
            session.motions = opened.map(|read| read.value).collect();
        }
        session.motions.retain(|shown| fits(&shown.motion, session.model.stored_len()));
    }
}

fn fits(motion: &Motion, width: usize) -> bool {
    motion.frames.iter().all(|frame| frame.len() == width)
}

/// Whether a model is a document, which can be edited in its text.
fn is_document(path: &Path) -> bool {
    match shipped::asked_for(path) {
        Some(name) => shipped::text(name).is_some(),
        None => open::ending(path) == "toml" && !open::is_binding(path),
    }
}

fn not_editable() -> Answer {
    (422, json!({ "error": "the model is no document that can be edited" }))
}

fn shown_name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn fault_json(fault: &Fault) -> Value {
    json!({
        "file": shown_name(&fault.file),
        "line": fault.line,
        "column": fault.column,
        "text": fault.text,
        "excerpt": fault.excerpt,
    })
}

fn fault_of(model: &Path, error: &OpenError) -> Fault {
    let place = match &error.cause {
        Cause::Content { error, .. } => error.iter().next().and_then(|first| first.place),
        _ => None,
    };
    Fault {
        file: model.to_owned(),
        line: place.map_or(0, |place| place.line),
        column: place.map_or(0, |place| place.column),
        text: error.to_string(),
        excerpt: String::new(),
    }
}

fn value_json(value: &Editable, file: &str) -> Value {
    let ways: Vec<Value> = value
        .ways
        .iter()
        .map(|way| json!({ "kind": way.kind.name(), "sentence": way.sentence }))
        .collect();
    json!({
        "path": path_json(&value.path),
        "value": value.value,
        "unit": value.unit,
        "written": value.written,
        "origin": { "kind": value.origin.name(), "file": file, "line": value.line, "column": value.column },
        "mirrored": value.mirrored.as_ref().map(|path| path_json(path)),
        "ways": ways,
    })
}
