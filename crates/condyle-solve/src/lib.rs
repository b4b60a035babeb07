//! Dense bounded least squares for the few dozen unknowns of a skeleton.
