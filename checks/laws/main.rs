//! Laws that any implementation has to keep.

mod pendulum;
mod strands;
