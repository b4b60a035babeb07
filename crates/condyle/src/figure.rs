//! A plain human figure built in Rust, and recordings of it.
