//! Laws that any implementation has to keep.

mod contact;
mod free_strand;
mod pendulum;
mod shake;
mod strands;
mod stretch;
