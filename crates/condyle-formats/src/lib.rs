//! Bytes to values and back: marker recordings, motions, models, animated scenes.
