//! Reading a mesh from a file, by its ending.

use std::path::Path;

use glam::Vec3;

use crate::mesh::vertex_normals;
use crate::parsing::Refusal;
use crate::{BodyError, Mesh, gltf, obj};

impl Mesh {
    /// Loads an OBJ or glTF 2.0 file (by its ending: .obj, .gltf, .glb), scaled by `scale` \[m per unit\].
    ///
    /// All objects and scenes of the file become one mesh; polygons become triangles; skins, materials and
    /// animations are ignored. Vertices keep the file's normals; where it gives none they are computed.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load(path: &Path, scale: f32) -> Result<Self, BodyError> {
        if !scale.is_finite() || scale <= 0.0 {
            let expected = "a finite number above zero [m per unit]";
            return Err(BodyError::Value {
                what: "the scale of the mesh",
                found: scale.to_string(),
                expected,
            });
        }
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
        let mut mesh = match ending.as_str() {
            "obj" => obj::read(path)?,
            "gltf" | "glb" => gltf::read(path)?,
            _ => {
                return Err(BodyError::Mesh {
                    path: path.into(),
                    found: format!("the ending `{ending}`"),
                    expected: "obj, gltf or glb",
                    mend: "export the body as OBJ or glTF 2.0",
                });
            }
        };
        mesh.positions.iter_mut().for_each(|position| *position *= scale);
        mesh.complete(path)
    }

    /// Reads an OBJ file from its bytes, in the units of the file.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_obj(bytes: &[u8]) -> Result<Self, BodyError> {
        Self::from_parsed(obj::parse(bytes))
    }

    /// Reads a glTF 2.0 file, as text or binary, from its bytes, in the units of the file; it must hold its
    /// buffers itself.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_gltf(bytes: &[u8]) -> Result<Self, BodyError> {
        Self::from_parsed(gltf::parse(bytes, None))
    }

    fn from_parsed(parsed: Result<Self, Refusal>) -> Result<Self, BodyError> {
        parsed.map_err(|(found, expected)| BodyError::BadMesh { found, expected })?.complete(Path::new(""))
    }

    /// Checks what was read and gives a normal to every vertex that has none.
    fn complete(mut self, path: &Path) -> Result<Self, BodyError> {
        self.check_usable().map_err(|error| match error {
            BodyError::BadMesh { found, expected } => BodyError::Mesh {
                path: path.into(),
                found: format!("the mesh has {found}"),
                expected,
                mend: "export it again as triangles",
            },
            other => other,
        })?;
        let computed = vertex_normals(&self.positions, &self.triangles);
        self.normals.resize(self.positions.len(), Vec3::ZERO);
        for (normal, computed) in self.normals.iter_mut().zip(computed) {
            // In double precision: the square of a short one underflows.
            *normal = normal.as_dvec3().try_normalize().map_or(computed, |unit| unit.as_vec3());
        }
        Ok(self)
    }
}
