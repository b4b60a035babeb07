//! Reading: a builder is fed part by part.

use crate::{Error, Read};
use condyle_model::Model;

/// Reads.
///
/// # Errors
/// None yet.
pub fn read(_: &[u8]) -> Result<Read<Model>, Error> {
    Err(Error::new("exchange/not-read", "resolved models are not read yet"))
}
