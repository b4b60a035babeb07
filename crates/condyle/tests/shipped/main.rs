//! The shipped models against the numbers that they were made of.

mod arms;
mod chest;
mod figure;
mod hands;
mod human;
mod knee;
mod lanes;
mod learned_knees;
mod legs;
mod limb;
mod limits;
mod measured;
mod names;
mod octopus;
mod rib_cage;
mod shoulder;
mod shoulder_shao2003;
mod spine;
