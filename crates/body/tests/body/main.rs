//! The body from outside: files, holes, distance grids.

mod closing;
mod distance_grid;
mod files;
mod mesh_files;
mod shapes;
