//! The façade's integration tests, one program for all that need neither a counted heap nor a quiet machine.

mod backends;
mod bound;
mod cache;
mod corpora;
mod crossed;
mod export_time;
mod far;
mod frame_loop;
mod host_device;
mod keyed_solids;
mod live;
mod moving;
mod neck;
mod outside;
mod pose;
mod readme;
mod scene_reference;
mod skin;
mod time;
mod workers;
mod written;
