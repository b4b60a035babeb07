//! What a recipe says.

/// A recipe: which markers give the orientation of a segment, and of the one it is seen from.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// Means of several markers, by names of their own.
    pub points: Vec<Place>,
    /// Other names of markers, in the order in which they are tried after their own.
    pub also: Vec<Place>,
    /// The segment whose rotation is learned.
    pub child: FrameRecipe,
    /// The segment in which it is seen; without one it is the laboratory.
    pub reference: Option<FrameRecipe>,
    /// Frames are left out where directions that span axes are nearer to parallel than this, radians.
    pub least_angle: f64,
}

impl Default for Recipe {
    /// 15 degrees, at which 5 mm of noise on a plane of 0.3 m are 4 degrees of its normal.
    fn default() -> Self {
        Self {
            points: vec![],
            also: vec![],
            child: FrameRecipe::default(),
            reference: None,
            least_angle: 15f64.to_radians(),
        }
    }
}

/// The mean of markers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// What it is called in the recipe.
    pub name: String,
    /// Its markers.
    pub markers: Vec<String>,
}

/// An axis of a segment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Forward, in the convention of the International Society of Biomechanics.
    #[default]
    X,
    /// Upward.
    Y,
    /// To the right.
    Z,
}

/// A direction between places, each a point of the recipe or a marker.
#[derive(Clone, Debug, PartialEq)]
pub enum Direction {
    /// From one to another.
    Between {
        /// Where it starts.
        from: String,
        /// Where it points.
        to: String,
    },
    /// The normal (b - a) × (c - a) of a plane.
    Normal {
        /// a, b, c.
        points: [String; 3],
    },
}

impl Default for Direction {
    fn default() -> Self {
        Self::Between { from: String::new(), to: String::new() }
    }
}

impl Direction {
    fn places(&self) -> Vec<&String> {
        match self {
            Self::Between { from, to } => vec![from, to],
            Self::Normal { points } => points.iter().collect(),
        }
    }
}

/// How the axes of a segment lie between places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameRecipe {
    /// The segment.
    pub name: String,
    /// The axis that keeps its direction.
    pub kept: (Axis, Direction),
    /// Another axis, whose direction is made perpendicular to it.
    pub second: (Axis, Direction),
}

impl Recipe {
    /// All places that its directions name, each once.
    #[must_use]
    pub fn places(&self) -> Vec<String> {
        let frames = [Some(&self.child), self.reference.as_ref()];
        let mut places: Vec<String> = vec![];
        for frame in frames.into_iter().flatten() {
            for place in [&frame.kept.1, &frame.second.1].into_iter().flat_map(Direction::places) {
                if !places.contains(place) {
                    places.push(place.clone());
                }
            }
        }
        places
    }
}
