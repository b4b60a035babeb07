//! Which arms there are.

/// One of the joints that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Arm {
    /// One angle about a fixed axis: 1DOF of Pronost et al. 2010.
    Hinge,
    /// One angle; the centre follows it by splines in a plane (Yamaguchi & Zajac 1989): 3DOF there.
    Planar,
    /// Three angles about the mean centre: the law without slopes.
    Fixed,
    /// Three angles about the constant centre that leaves the least at the markers of the frames that laws are learned from.
    FixedBest,
    /// Three angles about the constant of the law.
    FixedC4,
    /// Three angles about the centre of the law: 3⁺DOF there.
    Learned,
    /// Three angles and three places.
    Free,
}

impl Arm {
    /// Those that a leg and a law are enough for, from the stiffest to the freest; [`Self::FixedBest`] needs recordings as well.
    pub const ALL: [Self; 6] =
        [Self::Hinge, Self::Planar, Self::Fixed, Self::FixedC4, Self::Learned, Self::Free];

    /// All of them.
    pub const COMPARED: [Self; 7] = [
        Self::Hinge,
        Self::Planar,
        Self::Fixed,
        Self::FixedC4,
        Self::FixedBest,
        Self::Learned,
        Self::Free,
    ];

    /// The word for it in tables and files.
    ///
    /// ```
    /// use condyle_learn::arms::Arm;
    /// assert_eq!(Arm::FixedC4.name(), "fixed-c4");
    /// assert_eq!(Arm::named("planar"), Some(Arm::Planar));
    /// ```
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hinge => "hinge",
            Self::Planar => "planar",
            Self::Fixed => "fixed",
            Self::FixedC4 => "fixed-c4",
            Self::FixedBest => "fixed-best",
            Self::Learned => "learned",
            Self::Free => "free",
        }
    }

    /// The arm of a word.
    #[must_use]
    pub fn named(word: &str) -> Option<Self> {
        Self::COMPARED.into_iter().find(|arm| arm.name() == word)
    }

    /// How many coordinates of the joint are free.
    #[must_use]
    pub fn coordinates(self) -> usize {
        match self {
            Self::Hinge | Self::Planar => 1,
            Self::Fixed | Self::FixedC4 | Self::FixedBest | Self::Learned => 3,
            Self::Free => 6,
        }
    }

    /// Whether it takes something from recordings.
    #[must_use]
    pub fn is_learned(self) -> bool {
        matches!(self, Self::Fixed | Self::FixedC4 | Self::FixedBest | Self::Learned)
    }
}
