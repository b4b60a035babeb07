//! What WebAssembly exports.
//!
//! **Why `unsafe` is allowed here.** What is used of it is `#[unsafe(no_mangle)]`, which is unsafe because a
//! name could stand twice in a program. These names stand in the module of this crate alone (the file is not
//! compiled for anything but WebAssembly), and none is a name of its run-time library. And one function of the page is
//! called, which takes two numbers.
//!
//! No pointer is followed in Rust. The page writes to and reads from buffers that Rust owns, at addresses that are handed
//! out here, in calls between which nothing else runs: a module without threads has one caller. `input` is
//! written after `prepare` has made it long enough; an actor's buffers never change their length. Any bytes are
//! valid for these buffers, whose elements are plain numbers.
#![allow(unsafe_code, reason = "exported names; the proof is above")]
#![allow(unreachable_pub, reason = "exported to the page, not to Rust")]

use crate::answer::{Answer, Fault, sentence};
use crate::reading::{Given, read};
use crate::stage::{Actor, Stage};
use std::cell::RefCell;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// How many frames of how many are tracked: the page draws a bar. It takes two numbers and gives none, so that no memory
    /// is at stake, and must not call back.
    safe fn progress(done: u32, of: u32);
}

/// Tells the page how many frames of how many are tracked.
pub(crate) fn told(done: usize, of: usize) {
    progress(done as u32, of as u32);
}

#[derive(Default)]
struct Desk {
    /// What the page writes before a call.
    input: Vec<u8>,
    /// What the last call answered.
    answer: Answer,
    stages: Vec<Option<Stage>>,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

impl Desk {
    fn stage(&mut self, handle: u32) -> Result<&mut Stage, Fault> {
        let stage = self.stages.get_mut(handle as usize).and_then(Option::as_mut);
        stage.ok_or_else(|| sentence("that model is closed"))
    }

    /// Keeps an answer; 1 of a good one, 0 of a fault.
    fn kept(&mut self, answer: Result<Answer, Fault>) -> u32 {
        let good = answer.is_ok();
        self.answer = answer.unwrap_or_else(|fault| Answer::of(&fault));
        u32::from(good)
    }
}

/// Where to write so many bytes for the next call.
#[unsafe(no_mangle)]
pub extern "C" fn prepare(length: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| {
        desk.input.resize(length, 0);
        desk.input.as_mut_ptr()
    })
}

/// Reads a file from the input: its name, of so many bytes, and then its content. `handle` is that of the model
/// that a motion is of. 0 a fault, 1 a motion, else 2 more than the handle of a new model.
#[unsafe(no_mangle)]
pub extern "C" fn take(handle: u32, name: usize) -> u32 {
    DESK.with_borrow_mut(|desk| {
        let input = std::mem::take(&mut desk.input);
        let (name, bytes) = input.split_at(name.min(input.len()));
        let name = String::from_utf8_lossy(name);
        let model = desk.stage(handle).ok().map(|stage| &stage.model);
        match read(model, &name, bytes) {
            Ok(Given::Motion(answer)) => desk.kept(Ok(answer)),
            Ok(Given::Model(model, answer)) => {
                desk.stages.push(Some(Stage::new(*model)));
                desk.kept(Ok(answer)) + desk.stages.len() as u32
            }
            Err(fault) => desk.kept(Err(fault)),
        }
    })
}

/// The names of all shipped models as the answer.
#[unsafe(no_mangle)]
pub extern "C" fn shipped() {
    let names: Vec<&str> = condyle::shipped::names().collect();
    DESK.with_borrow_mut(|desk| desk.answer = Answer::of(&serde_json::json!(names)));
}

/// Forgets a model.
#[unsafe(no_mangle)]
pub extern "C" fn shut(handle: u32) {
    DESK.with_borrow_mut(|desk| {
        if let Some(stage) = desk.stages.get_mut(handle as usize) {
            *stage = None;
        }
    });
}

/// Answers the question in the input about a model: 1, or 0 with what is wrong.
#[unsafe(no_mangle)]
pub extern "C" fn ask(handle: u32) -> u32 {
    DESK.with_borrow_mut(|desk| {
        let question = String::from_utf8_lossy(&std::mem::take(&mut desk.input)).into_owned();
        let answer = desk.stage(handle).and_then(|stage| stage.ask(&question));
        desk.kept(answer)
    })
}

/// Evaluates a pose of a model, within limits or as asked: 1, or 0 where it cannot be.
#[unsafe(no_mangle)]
pub extern "C" fn pose(handle: u32, actor: usize, within_limits: u32) -> u32 {
    DESK.with_borrow_mut(|desk| {
        let posed = desk.stage(handle).is_ok_and(|stage| stage.pose(actor, within_limits != 0));
        u32::from(posed)
    })
}

/// Where the text of the last answer is.
#[unsafe(no_mangle)]
pub extern "C" fn text_at() -> *const u8 {
    DESK.with_borrow(|desk| desk.answer.text.as_ptr())
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    DESK.with_borrow(|desk| desk.answer.text.len())
}

/// Where the numbers of the last answer are.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_at() -> *const u8 {
    DESK.with_borrow(|desk| desk.answer.numbers.as_ptr())
}

/// How many bytes they have.
#[unsafe(no_mangle)]
pub extern "C" fn numbers_length() -> usize {
    DESK.with_borrow(|desk| desk.answer.numbers.len())
}

/// An address in an actor; 0 where there is none.
fn of<T>(handle: u32, actor: usize, buffer: impl Fn(&mut Actor) -> *mut T) -> *mut T {
    DESK.with_borrow_mut(|desk| {
        let stage = desk.stage(handle).ok();
        let actor = stage.and_then(|stage| stage.actors.get_mut(actor));
        actor.map_or(std::ptr::null_mut(), buffer)
    })
}

/// Where the page writes the stored numbers of a pose.
#[unsafe(no_mangle)]
pub extern "C" fn asked_at(handle: u32, actor: usize) -> *mut f64 {
    of(handle, actor, |actor| actor.asked.as_mut_ptr())
}

/// Where what limits and couplings leave of them is.
#[unsafe(no_mangle)]
pub extern "C" fn effective_at(handle: u32, actor: usize) -> *mut f64 {
    of(handle, actor, |actor| actor.effective.as_mut_ptr())
}

/// Where the matrices are that move surfaces.
#[unsafe(no_mangle)]
pub extern "C" fn moves_at(handle: u32, actor: usize) -> *mut f32 {
    of(handle, actor, |actor| actor.moves.as_mut_ptr())
}

/// Where the places of segments are.
#[unsafe(no_mangle)]
pub extern "C" fn places_at(handle: u32, actor: usize) -> *mut f64 {
    of(handle, actor, |actor| actor.places.as_mut_ptr())
}
