//! Any bytes as a motion and as a CSV table: no panic, a table that fits, and a second reading
//! that agrees with the first.
#![no_main]

use condyle_formats::{Table, csv, sto};
use libfuzzer_sys::fuzz_target;

fn bits(table: &Table) -> Vec<u64> {
    // All NaNs are written alike.
    let canonical = |x: &f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
    table.times.iter().chain(&table.values).map(canonical).collect()
}

fuzz_target!(|data: &[u8]| {
    if let Ok(read) = sto::from_bytes(data) {
        let table = read.value;
        assert_eq!(table.values.len(), table.rows() * table.columns.len());
        let text = sto::write(&table).expect("what was read can be written");
        let again = sto::read(&text).expect("what was written can be read").value;
        assert_eq!(again.columns, table.columns);
        assert_eq!(bits(&again), bits(&table));
    }
    if let Ok(read) = csv::from_bytes(data) {
        let table = read.value;
        assert_eq!(table.values.len(), table.rows() * table.columns.len());
        let text = csv::write(&table).expect("what was read can be written");
        let again = csv::read(&text).expect("what was written can be read").value;
        assert_eq!(again.columns, table.columns);
        assert_eq!(bits(&again), bits(&table));
    }
});
