//! What the second module exports: readers of all formats, and no poses.
//!
//! `unsafe` is allowed here for the reasons that are given in `border.rs`: names are exported, no pointer is followed, and the
//! page writes to and reads from buffers that Rust owns, in calls between which nothing else runs.
#![allow(unsafe_code, reason = "exported names; the proof is in border.rs")]
#![allow(unreachable_pub, reason = "exported to the page, not to Rust")]

use crate::answer::Answer;
use crate::converted::converted;
use std::cell::RefCell;

#[derive(Default)]
struct Desk {
    input: Vec<u8>,
    answer: Answer,
    /// The last skeleton of Acclaim's, to which takes belong.
    skeleton: Option<Vec<u8>>,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

/// Where to write so many bytes for the next call.
#[unsafe(no_mangle)]
pub extern "C" fn prepare(length: usize) -> *mut u8 {
    DESK.with_borrow_mut(|desk| {
        desk.input.resize(length, 0);
        desk.input.as_mut_ptr()
    })
}

/// Brings a file from the input, its name, of so many bytes, and then its content, to what the evaluator reads: 1, or
/// 0 with what is wrong.
#[unsafe(no_mangle)]
pub extern "C" fn convert(name: usize) -> u32 {
    DESK.with_borrow_mut(|desk| {
        let input = std::mem::take(&mut desk.input);
        let (name, bytes) = input.split_at(name.min(input.len()));
        let name = String::from_utf8_lossy(name);
        let answer = converted(&name, bytes, desk.skeleton.as_deref());
        if name.to_lowercase().ends_with(".asf") && answer.is_ok() {
            desk.skeleton = Some(bytes.to_vec());
        }
        let good = answer.is_ok();
        desk.answer = answer.unwrap_or_else(|fault| Answer::of(&fault));
        u32::from(good)
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
