//! Strand solvers: how a strand bends, twists and keeps its length within a step.

pub mod constrain;
pub mod rods;
