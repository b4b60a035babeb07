//! What a character is and how it is posed: segments, joint sets, components, programs.
