//! Any bytes as a comma-separated table: no panic, a table that fits, and a second reading that agrees with
//! the first.
#![no_main]

use condyle_formats::csv;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = csv::from_bytes(data) else { return };
    let table = read.value;
    assert!(table.mismatch().is_none());
    assert!(table.times.iter().all(|time| time.is_finite()));
    if let Ok(text) = csv::write(&table) {
        let again = csv::read(&text).expect("what was written can be read").value;
        assert_eq!(again.columns.len(), table.columns.len());
        assert_eq!(again.rows(), table.rows());
    }
});
