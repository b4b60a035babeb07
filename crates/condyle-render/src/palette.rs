//! The colours of all pictures, as `#rrggbb` of a page would have them.

/// Red, green and blue as a screen takes them (sRGB), 0 to 255.
pub type Colour = [u8; 3];

/// What is behind everything.
pub const BACKGROUND: Colour = [0xf4, 0xf5, 0xf7];
/// What is between pictures.
pub const PAGE: Colour = [0xff, 0xff, 0xff];
/// The ground.
pub const GROUND: Colour = [0xdc, 0xdf, 0xe4];
/// Lines of the ground's grid.
pub const GRID: Colour = [0xb6, 0xbc, 0xc6];
/// Bones.
pub const BONE: Colour = [0xe9, 0xdf, 0xc8];
/// Skin.
pub const SKIN: Colour = [0xd9, 0xae, 0x94];
/// Cartilage.
pub const CARTILAGE: Colour = [0xa9, 0xc9, 0xdc];
/// Joints, and ends of segments.
pub const JOINT: Colour = [0x75, 0x8a, 0xa3];
/// What is looked at.
pub const ACCENT: Colour = [0xe0, 0x6a, 0x2b];
/// What is beside that which is looked at.
pub const PALE: Colour = [0xdd, 0xdd, 0xdb];
/// Markers.
pub const MARKER: Colour = [0x2f, 0xa3, 0x5c];
/// The x axis of a frame.
pub const AXIS_X: Colour = [0xd0, 0x3a, 0x36];
/// The y axis of a frame.
pub const AXIS_Y: Colour = [0x3a, 0x9a, 0x46];
/// The z axis of a frame.
pub const AXIS_Z: Colour = [0x2f, 0x66, 0xc4];
/// Axes of joints, and the path of a moving centre.
pub const MOTION: Colour = [0x8a, 0x3f, 0xa8];
/// What limits allow.
pub const LIMIT: Colour = [0x2c, 0x9c, 0xa6];
/// The other end of what a limit's shade tells.
pub const LIMIT_LOW: Colour = [0xf0, 0xd0, 0x50];
/// A present value among what limits allow.
pub const VALUE: Colour = [0xc2, 0x24, 0x5c];
/// Surfaces that bones glide on.
pub const CONTACT: Colour = [0x5b, 0x8f, 0xd6];
/// A gap that is as it should be.
pub const GAP: Colour = [0x2f, 0xa3, 0x5c];
/// A gap that is not.
pub const GAP_BROKEN: Colour = [0xd8, 0x2c, 0x2c];
/// Text.
pub const TEXT: Colour = [0x26, 0x2b, 0x33];
/// Lines between a label and its place.
pub const LEADER: Colour = [0x8c, 0x93, 0x9e];

/// Every colour with its name, for a page that shows the same things.
pub const ALL: [(&str, Colour); 23] = [
    ("background", BACKGROUND),
    ("page", PAGE),
    ("ground", GROUND),
    ("grid", GRID),
    ("bone", BONE),
    ("skin", SKIN),
    ("cartilage", CARTILAGE),
    ("joint", JOINT),
    ("accent", ACCENT),
    ("pale", PALE),
    ("marker", MARKER),
    ("axis_x", AXIS_X),
    ("axis_y", AXIS_Y),
    ("axis_z", AXIS_Z),
    ("motion", MOTION),
    ("limit", LIMIT),
    ("limit_low", LIMIT_LOW),
    ("value", VALUE),
    ("contact", CONTACT),
    ("gap", GAP),
    ("gap_broken", GAP_BROKEN),
    ("text", TEXT),
    ("leader", LEADER),
];
