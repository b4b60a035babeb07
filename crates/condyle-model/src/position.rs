//! Typed positions: what one part of a model knows of another.

macro_rules! position {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub(crate) u32);

        impl $name {
            /// The position, counted from 0 in the order of the model.
            #[inline(always)]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

position!(
    /// The position of a segment in its model.
    SegmentId
);
position!(
    /// The position of a coordinate in its model.
    CoordinateId
);
position!(
    /// The position of a joint set in its model.
    JointSetId
);
position!(
    /// The position of a component in its model.
    ComponentId
);
