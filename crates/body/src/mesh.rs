use std::path::Path;

use glam::Vec3;

use crate::{Aabb, BodyError};

/// A triangle mesh in head space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex positions \[m\].
    pub positions: Vec<Vec3>,
    /// Unit vertex normals, one for each position.
    pub normals: Vec<Vec3>,
    /// Corner indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Loads an OBJ or glTF 2.0 file (by its ending: .obj, .gltf, .glb), scaled by `scale` \[m per unit\].
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load(_path: &Path, _scale: f32) -> Result<Self, BodyError> {
        unimplemented!("body mechanics")
    }

    /// The box around all vertices; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<Aabb> {
        unimplemented!("body mechanics")
    }
}
