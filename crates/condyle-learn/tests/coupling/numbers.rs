//! Numbers of other programs.
