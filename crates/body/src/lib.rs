//! Bodies that hair grows on and collides with: the built-in mannequin, loaded meshes, the scalp, signed
//! distance, colliders and the motion of the head. No GPU, no hair.
//!
//! Units are SI; y is up and the face looks along +z. *Head space* is the space in which a body
//! and a groom are at rest; a [`BodyFrame`] carries it into the world.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // compared values may be rounded

mod beside;
mod buried;
mod bvh;
mod caps;
mod carried_normals;
mod closing;
mod coarse_mesh;
mod collider;
mod curve;
mod distance;
mod distance_grid;
mod error;
mod far_nodes;
mod frame;
mod gltf;
mod inside;
mod inside_out;
mod kept_grid;
mod keyframes;
mod lattice;
mod layers;
mod local_shifts;
mod mannequin;
mod materials;
mod mesh;
mod mesh_content;
mod mesh_distance;
mod mesh_file;
mod mesh_format;
mod motion;
mod moved_skin;
mod near_surface;
mod nearest_corner;
mod nearest_place;
mod neck;
mod neck_solids;
mod obj;
mod obj_looks;
mod parsing;
mod part_names;
mod playback;
mod ply;
mod polar;
mod posed_skin;
mod recorded;
mod rigid_fit;
mod scalp;
mod scalp_place;
mod skin_line;
mod skin_motion;
mod skin_roots;
mod skin_side;
mod skin_solid;
mod skin_table;
mod solid_table;
mod solids;
mod stl;
mod teleports;
mod texture;
mod textures;
mod triangle;
mod triangle_tree;
mod turn_out;
mod vertex_file;
mod vertex_frames;
mod vertex_motion;
mod welding;

pub use caps::Caps;
pub use coarse_mesh::CoarseMesh;
pub use collider::{Carrier, Collider, Shape};
pub use curve::{Curve, Interpolation, Key};
pub use distance::{Aabb, SignedDistance};
pub use distance_grid::DistanceGrid;
pub use error::BodyError;
pub use frame::BodyFrame;
pub use keyframes::{Keyframe, Keyframes};
pub use mannequin::{Build, Eyes, Mannequin};
pub use materials::{Material, Materials, Wrap};
pub use mesh::Mesh;
pub use mesh_format::MeshFormat;
pub use motion::Motion;
pub use moved_skin::MovedSkin;
pub use nearest_place::NearestSurface;
pub use neck::Neck;
pub use playback::Playback;
pub use posed_skin::{PosedSkin, SkinPlace, TriangleMotion};
pub use recorded::RecordedMotion;
pub use scalp::{Root, Scalp};
pub use skin_line::{MOST_PLACES, Places, Sides};
pub use skin_motion::SkinMotion;
pub use skin_roots::SkinRoots;
pub use skin_solid::SkinSolid;
pub use skin_table::{SkinTable, Written};
pub use solid_table::{skins_constant, solid_rows};
pub use solids::{PlacedSolids, Solids};
pub use strandline_base::{Pose, Random};
pub use texture::{Srgb, Texture};
pub use turn_out::turned_out;
pub use vertex_motion::VertexMotion;
