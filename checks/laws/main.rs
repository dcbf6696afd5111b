//! Laws that any implementation has to keep.

mod angles;
mod attributes;
mod bound;
mod contact;
mod curl;
mod free_strand;
mod friction;
mod grab;
mod grid_contact;
mod hair;
mod layers;
mod length_scale;
mod lengths;
mod pendulum;
mod poisson;
mod recovery;
mod rod_mechanics;
mod rods;
mod shake;
mod sintel;
mod spans;
mod springs;
mod strands;
mod stretch;
mod transfer;
mod volume;
