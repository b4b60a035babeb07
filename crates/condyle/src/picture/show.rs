//! What is shown.

use condyle_diagnostics::{Error, did_you_mean};

/// A kind of thing in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Show {
    /// Bones, or simple shapes in their place.
    Bones,
    /// The skin; bones where a model has none.
    Skin,
    /// The axes of every segment.
    Frames,
    /// The axes about and along which joints move now.
    Axes,
    /// The moving centre of every joint: its instantaneous axis, and the path of that over the range.
    Centres,
    /// What limits allow, and where the pose is in it.
    Limits,
    /// Surfaces that bones glide on, and gaps.
    Contacts,
    /// Markers.
    Markers,
    /// Names of segments, and of what else is shown.
    Names,
}

impl Show {
    /// All kinds, with their names.
    pub const ALL: [(&'static str, Self); 9] = [
        ("bones", Self::Bones),
        ("skin", Self::Skin),
        ("frames", Self::Frames),
        ("axes", Self::Axes),
        ("centres", Self::Centres),
        ("limits", Self::Limits),
        ("contacts", Self::Contacts),
        ("markers", Self::Markers),
        ("names", Self::Names),
    ];

    /// The kind with a name.
    ///
    /// # Errors
    /// `picture/unknown` with the nearest name.
    ///
    /// ```
    /// use condyle::picture::Show;
    /// assert_eq!(Show::named("limits")?, Show::Limits);
    /// let said = Show::named("limit").unwrap_err().to_string();
    /// assert_eq!(said, "nothing is called `limit` to show (did you mean `limits`?)");
    /// # Ok::<(), condyle::Error>(())
    /// ```
    pub fn named(name: &str) -> Result<Self, Error> {
        let names = Self::ALL.map(|(name, _)| name);
        let known = Self::ALL.iter().find(|(known, _)| *known == name);
        known.map(|(_, kind)| *kind).ok_or_else(|| {
            let message = format!("nothing is called `{name}` to show");
            let all = || format!("what can be shown: {}", names.join(", "));
            Error::new("picture/unknown", message).with_help(did_you_mean(name, names, all))
        })
    }
}
