//! Any text as a setup of tracking and as a table of names: no panic, errors that can be shown, and numbers
//! that mean something.
#![no_main]

use condyle_formats::document::{Kind, kind, names, render, setup};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let found = kind(data);
    let text = String::from_utf8_lossy(data);
    let include = |left: &mut u32, name: &str| {
        // The text includes itself under other names, at most three times.
        *left = left.saturating_sub(1);
        if *left == 0 || name.len() > 20 {
            Err("nothing there".to_owned())
        } else {
            Ok(text.to_string())
        }
    };
    let mut left = 4;
    match setup::read(&text, &mut |name| include(&mut left, name)) {
        Ok(read) => {
            assert!(found == Some(Kind::Setup) || data.len() >= 1 << 16);
            let read = read.value;
            assert!(read.time.is_none_or(|[first, last]| first <= last));
            assert!(read.max_rms.is_none_or(|rms| rms > 0.0));
            assert!(read.weights.iter().all(|(_, weight)| *weight >= 0.0));
            assert!(read.postures.iter().all(|p| p.stiffness >= 0.0 && !p.coordinates.is_empty()));
            assert!(read.coordinates.iter().all(|c| c.weight >= 0.0));
            assert!(read.loop_weight.is_none_or(|weight| weight >= 0.0));
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            assert!(render("text", &text, &errors).lines().count() >= errors.len());
        }
    }
    let mut left = 4;
    match names::read(&text, &mut |name| include(&mut left, name)) {
        Ok(read) => {
            assert!(found == Some(Kind::Names) || data.len() >= 1 << 16);
            let labels: Vec<&String> = read.value.iter().map(|(label, _)| label).collect();
            let others = |i: usize| &labels[i + 1..];
            assert!((0..labels.len()).all(|i| !others(i).contains(&labels[i])));
        }
        Err(errors) => assert!(!errors.is_empty()),
    }
});
