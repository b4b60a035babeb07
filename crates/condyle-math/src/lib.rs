//! Numbers in space: vectors, rotations, transforms and scalar functions over one scalar trait.
