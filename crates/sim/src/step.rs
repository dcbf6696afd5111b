//! The step as a list of stages.
