//! What hair grows on and hits: the built-in mannequin, loaded meshes, the scalp, signed
//! distance, colliders and the motion of the head. No GPU, no hair.
//!
//! Units are SI; y is up and the face looks along +z. *Head space* is the space in which a body
//! and a groom are at rest; [`Pose`] carries it into the world.

mod collider;
mod distance;
mod error;
mod mannequin;
mod mesh;
mod motion;
mod pose;
mod scalp;

pub use collider::{Carrier, Collider, Shape};
pub use distance::{Aabb, DistanceGrid, SignedDistance};
pub use error::BodyError;
pub use mannequin::Mannequin;
pub use mesh::Mesh;
pub use motion::{Keyframe, Motion};
pub use pose::Pose;
pub use scalp::{Root, Scalp};
