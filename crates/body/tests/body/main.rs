//! The body from outside: files, holes, distance grids.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

mod clips;
mod closing;
mod damaged;
mod distance_grid;
mod files;
mod gltf_files;
mod inside_out;
mod mesh_files;
mod neck;
mod obj_looks;
mod painted;
mod painted_file;
mod posed_skin;
mod recorded;
mod sample;
mod scans;
mod shapes;
mod skin_roots;
mod thin_triangles;
mod vertices;
