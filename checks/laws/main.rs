//! Laws that any implementation has to keep.

mod contact;
mod curl;
mod free_strand;
mod grab;
mod lengths;
mod pendulum;
mod poisson;
mod recovery;
mod shake;
mod strands;
mod stretch;
mod transfer;
