//! Any text as goals of a pose: no panic, errors that can be shown, and numbers that mean something.
#![no_main]

use condyle_formats::document::goals::{self, NamedAim};
use condyle_formats::document::{Kind, kind, render};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let found = kind(data);
    let text = String::from_utf8_lossy(data);
    // The text includes itself under other names, at most three times.
    let mut left = 4_u32;
    let mut include = |name: &str| {
        left = left.saturating_sub(1);
        if left == 0 || name.len() > 20 {
            Err("nothing there".to_owned())
        } else {
            Ok(text.to_string())
        }
    };
    match goals::read(&text, &mut include) {
        Ok(read) => {
            assert!(found == Some(Kind::Goals) || data.len() >= 1 << 16);
            let positive = |number: f64| number > 0.0;
            assert!(read.value.stiffness.iter().all(|(_, stiffness)| positive(*stiffness)));
            for goal in &read.value.goals {
                assert!(goal.weight.is_none_or(positive));
                match &goal.aim {
                    NamedAim::Distance { distance, .. } => assert!(positive(*distance)),
                    NamedAim::Orientation { rotation: Some(q), .. } => {
                        assert!((q.dot(*q) - 1.0).abs() < 1e-9);
                    }
                    NamedAim::Axis { axis, along, .. } => {
                        assert!(
                            (axis.norm() - 1.0).abs() < 1e-9 && (along.norm() - 1.0).abs() < 1e-9
                        );
                    }
                    NamedAim::Look { axis, .. } => assert!((axis.norm() - 1.0).abs() < 1e-9),
                    NamedAim::Plane { normal, .. } => assert!((normal.norm() - 1.0).abs() < 1e-9),
                    _ => {}
                }
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            assert!(render("text", &text, &errors).lines().count() >= errors.len());
        }
    }
});
