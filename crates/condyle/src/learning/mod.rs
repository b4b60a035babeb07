//! Limits of joints, and laws that couple coordinates, from recordings: by path.
//!
//! | module | what |
//! | --- | --- |
//! | `take` | the rotations that one recording shows: by a recipe, by a model and a joint, or as they stand |
//! | [`arms`] | joints compared on trials that were left out |
//! | `coupling` | frames of trials by path, tracked where they hold markers |
//! | `limit` | a limit from takes: thinned, with a layer from takes that were left out |
//! | `given` | what a limit depends on, and limits that depend on another joint |
//! | `query` | what a limit says of rotations |
//! | `engine` | a learned limit in the numbers of game and robot engines |
//! | `mobility` | a learned limit in numbers, and two compared |
//! | [`study`] | the study of Pronost et al. 2010 with virtual people |

pub mod arms;
mod coupling;
mod engine;
mod given;
mod limit;
mod mobility;
mod query;
pub mod study;
mod take;

pub use condyle_learn::limits::engine::{Aim, ConeTwist, Law, Loss, Lost, ReachCone};
pub use coupling::{Coupled, Gathered, GroupTable, gather, group_table};
pub use engine::{Engines, Fitted, engines, reach_document};
pub use given::{
    Bin, DRIVER_COLUMNS, Driven, HowGiven, LearnedGiven, Wished, bins, drivers_of_table,
    learn_given,
};
pub use limit::{How, LearnedFrom, MOST_INDEPENDENT, learn, spheres};
pub use mobility::{About, Axis, Region, Report, Side, Versus, report, versus};
pub use query::{Answered, Limit};
pub use take::{Take, Wanted, take};
