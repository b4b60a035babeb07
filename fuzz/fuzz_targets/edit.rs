//! Any text as a document that is edited: no panic; a number that is changed changes alone, or nothing does; the text that
//! comes of it reads with the number that was asked for.
#![no_main]

use condyle_formats::document::edit::{Editing, Refused};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first bytes choose a number and its value.
    let Some((&[which, size, way], text)) = data.split_first_chunk::<3>() else { return };
    let text = String::from_utf8_lossy(text);
    // The text includes itself under another name, once.
    let mut include = |name: &str| match name {
        "itself" => Ok(text.to_string()),
        _ => Err("nothing there".to_owned()),
    };
    let Ok(editing) = Editing::read("text", &text, &mut include, &|_| which % 2 == 0) else { return };
    assert_eq!(editing.text(), text);
    let Some(value) = editing.values().get(usize::from(which)) else { return };
    assert_eq!(editing.find(&value.path).map(|found| &found.path), Some(&value.path));
    let new = (f64::from(size) - 100.0) / 16.0;
    let kind = value.ways.get(usize::from(way)).map(|way| way.kind);
    match editing.set(&value.path, new, kind) {
        Ok(edited) => {
            let change = &edited.change;
            let before = &editing.source(&change.file).expect("it is one of its texts").text;
            let after = &edited.next.source(&change.file).expect("it still is").text;
            assert_eq!(before[..change.at], after[..change.at]);
            assert_eq!(before[change.at + change.old.len()..], after[change.at + change.new.len()..]);
            assert!(edited.next.find(&value.path).is_some());
        }
        Err(Refused::Fault { error, .. }) => assert!(!error.is_empty()),
        Err(why) => assert!(!why.to_string().is_empty()),
    }
    let path = ["segment", "new", "at"].map(str::to_owned);
    if let Ok(edited) = editing.put(&path, "[0, 1, 0]") {
        assert!(edited.next.text().contains("[0, 1, 0]"));
    }
});
