//! What a diagnostic is about.

use std::fmt;

/// A part of a model, a recording or a motion, by name.
///
/// Places in files are found by subject: two subjects are the same part exactly if they are equal.
///
/// ```
/// use condyle_diagnostics::Subject;
/// let turn = Subject::component("knee_r", "T");
/// assert_eq!(turn.name(), "T");
/// assert_eq!(turn.to_string(), "component `T` of joint set `knee_r`");
/// assert_ne!(turn, Subject::component("knee_r", "t"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Subject {
    /// A segment.
    Segment(String),
    /// A joint set.
    JointSet(String),
    /// A coordinate by its key: the bare name where it is unique, else `joint/coordinate`.
    Coordinate(String),
    /// A component of a joint set.
    Component {
        /// The joint set.
        joint_set: String,
        /// The component's name in it.
        name: String,
    },
    /// A marker of a model, or a label of a recording.
    Marker(String),
    /// What a bone looks like.
    Shape(String),
    /// A loop.
    Closure(String),
    /// A posture term.
    Posture(String),
    /// Segments that grow together.
    SizeGroup(String),
    /// A column of a table.
    Column(String),
}

impl Subject {
    /// A component of a joint set.
    #[must_use]
    pub fn component(joint_set: impl Into<String>, name: impl Into<String>) -> Self {
        Self::Component { joint_set: joint_set.into(), name: name.into() }
    }

    /// The name alone, as reports list it.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Segment(name)
            | Self::JointSet(name)
            | Self::Coordinate(name)
            | Self::Component { name, .. }
            | Self::Marker(name)
            | Self::Shape(name)
            | Self::Closure(name)
            | Self::Posture(name)
            | Self::SizeGroup(name)
            | Self::Column(name) => name,
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self {
            Self::Segment(_) => "segment",
            Self::JointSet(_) => "joint set",
            Self::Coordinate(_) => "coordinate",
            Self::Component { joint_set, name } => {
                return write!(f, "component `{name}` of joint set `{joint_set}`");
            }
            Self::Marker(_) => "marker",
            Self::Shape(_) => "shape",
            Self::Closure(_) => "closure",
            Self::Posture(_) => "posture",
            Self::SizeGroup(_) => "size group",
            Self::Column(_) => "column",
        };
        write!(f, "{what} `{}`", self.name())
    }
}
