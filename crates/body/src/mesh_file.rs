//! Reading a mesh from a file, by its ending.

use std::path::Path;

use glam::Vec3;
use strandline_base::whole_lines;

use crate::gltf::{self, Fault};
use crate::mesh::vertex_normals;
use crate::mesh_format::MeshFormat;
use crate::parsing::{Refusal, read_file, remedy};
use crate::part_names::Names;
use crate::{BodyError, Mesh, VertexMotion, obj};

/// Reads a file by its ending, or the part of it that has a name, in the units of the file; adds notes.
fn read(path: &Path, names: Option<&mut Names>, notes: &mut Vec<String>) -> Result<Mesh, BodyError> {
    let format = MeshFormat::of(path)?;
    format.parse(&read_file(path)?, path.parent(), names, notes).map_err(|(found, expected)| {
        BodyError::Mesh { path: path.into(), found, expected, mend: format.mend() }
    })
}

/// The format of a file, which has clips.
fn clips_of(path: &Path) -> Result<MeshFormat, BodyError> {
    match MeshFormat::of(path)? {
        MeshFormat::Gltf => Ok(MeshFormat::Gltf),
        _ => Err(BodyError::Mesh {
            path: path.into(),
            found: "a file without clips".into(),
            expected: "gltf, glb or vrm",
            mend: "export the body and its animation as glTF 2.0",
        }),
    }
}

impl Mesh {
    /// Loads a file of a [`MeshFormat`], by its ending, scaled by `scale` \[m per unit\].
    ///
    /// All objects of the file become one mesh, those of glTF's default scene alone; polygons become triangles; clips
    /// are ignored. Materials are those of glTF and of .mtl files, and colours of vertices: what is wrong with them becomes a note.
    /// Skinned and morphed glTF meshes stand in their default pose. Vertices keep the file's normals; where it gives none
    /// they are computed.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load(path: &Path, scale: f32) -> Result<Self, BodyError> {
        Ok(Self::load_noted(path, scale)?.0)
    }

    /// As [`Mesh::load`], with notes on what is odd but could be read, human-readable.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load_noted(path: &Path, scale: f32) -> Result<(Self, Vec<String>), BodyError> {
        if !scale.is_finite() || scale <= 0.0 {
            let expected = "a finite number above zero [m per unit]";
            return Err(BodyError::Value {
                what: "the scale of the mesh",
                found: scale.to_string(),
                expected,
            });
        }
        let mut notes = Vec::new();
        let mut mesh = read(path, None, &mut notes)?;
        mesh.positions.iter_mut().for_each(|position| *position *= scale);
        Ok((mesh.complete(path)?, notes))
    }

    /// Loads the vertices and triangles of a file, in its units; an .obj without its materials and their pictures.
    pub(crate) fn load_shape(path: &Path) -> Result<Self, BodyError> {
        let format = MeshFormat::of(path)?;
        if format != MeshFormat::Obj {
            return Self::load(path, 1.0);
        }
        let parsed = obj::parse(&whole_lines(&read_file(path)?));
        let mesh = parsed.map_err(|(found, expected)| BodyError::Mesh {
            path: path.into(),
            found,
            expected,
            mend: format.mend(),
        })?;
        mesh.usable(path)
    }

    /// Loads a glTF file and its motion in a clip of a name, in the units of the file, with notes.
    ///
    /// # Errors
    /// See [`BodyError`]: another format, no clip of that name, more memory than may be taken.
    pub fn load_moving(path: &Path, clip: &str) -> Result<(Self, VertexMotion, Vec<String>), BodyError> {
        let format = clips_of(path)?;
        let mut notes = Vec::new();
        let read = gltf::parse_moving(&read_file(path)?, path.parent(), clip, &mut notes);
        let (mesh, rig) = read.map_err(|fault| match fault {
            Fault::Memory(error) => BodyError::Memory(error),
            Fault::Refused((found, expected)) => {
                let mend = remedy(expected, format.mend());
                BodyError::Mesh { path: path.into(), found, expected, mend }
            }
        })?;
        Ok((mesh.complete(path)?, VertexMotion::of_clip(rig), notes))
    }

    /// As [`Mesh::load_moving`], from the bytes of a file, which must hold its buffers itself.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn moving_from(bytes: &[u8], clip: &str) -> Result<(Self, VertexMotion, Vec<String>), BodyError> {
        let mut notes = Vec::new();
        let (mesh, rig) = gltf::parse_moving(bytes, None, clip, &mut notes).map_err(|fault| match fault {
            Fault::Memory(error) => BodyError::Memory(error),
            Fault::Refused((found, expected)) => BodyError::BadMesh { found, expected },
        })?;
        Ok((mesh.complete(Path::new(""))?, VertexMotion::of_clip(rig), notes))
    }

    /// As [`Mesh::clip_names`], from the bytes of a file.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn clips_in(bytes: &[u8]) -> Result<Vec<String>, BodyError> {
        gltf::clip_names(bytes).map_err(|(found, expected)| BodyError::BadMesh { found, expected })
    }

    /// Names of the clips of a glTF file, in their order; a clip without a name has that of its number.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn clip_names(path: &Path) -> Result<Vec<String>, BodyError> {
        let format = clips_of(path)?;
        gltf::clip_names(&read_file(path)?).map_err(|(found, expected)| BodyError::Mesh {
            path: path.into(),
            found,
            expected,
            mend: format.mend(),
        })
    }

    /// Loads the part of a file that has a name, in the units of the file; `None` where nothing has it.
    ///
    /// Names are those of objects, groups and materials of an OBJ, of nodes, meshes and materials of a glTF; other
    /// formats have none. Upper and lower case are the same.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load_part(path: &Path, name: &str) -> Result<Option<Self>, BodyError> {
        let mut names = Names::new(name);
        let mesh = read(path, Some(&mut names), &mut Vec::new())?;
        if mesh.triangles.is_empty() { Ok(None) } else { mesh.complete(path).map(Some) }
    }

    /// The names that parts of a file have, as [`Mesh::load_part`] knows them.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn part_names(path: &Path) -> Result<Vec<String>, BodyError> {
        let mut names = Names::new("");
        read(path, Some(&mut names), &mut Vec::new())?;
        Ok(names.all())
    }

    /// Reads a mesh of any format from its bytes, in the units of the file; a glTF must hold its buffers itself.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_bytes(bytes: &[u8], format: MeshFormat) -> Result<Self, BodyError> {
        Self::from_parsed(format.parse(bytes, None, None, &mut Vec::new()))
    }

    /// As [`Mesh::load_part`], from the bytes of a file; a glTF must hold its buffers itself.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn part_from(bytes: &[u8], format: MeshFormat, name: &str) -> Result<Option<Self>, BodyError> {
        let mut names = Names::new(name);
        match format.parse(bytes, None, Some(&mut names), &mut Vec::new()) {
            Ok(mesh) if mesh.triangles.is_empty() => Ok(None),
            parsed => Self::from_parsed(parsed).map(Some),
        }
    }

    fn from_parsed(parsed: Result<Self, Refusal>) -> Result<Self, BodyError> {
        parsed.map_err(|(found, expected)| BodyError::BadMesh { found, expected })?.complete(Path::new(""))
    }

    /// Checks the mesh of a file.
    fn usable(self, path: &Path) -> Result<Self, BodyError> {
        self.check_usable().map_err(|error| match error {
            BodyError::BadMesh { found, expected } => BodyError::Mesh {
                path: path.into(),
                found: format!("the mesh has {found}"),
                expected,
                mend: "export it again as triangles",
            },
            other => other,
        })?;
        Ok(self)
    }

    /// Checks the mesh and gives a normal to every vertex without.
    fn complete(self, path: &Path) -> Result<Self, BodyError> {
        let mut mesh = self.usable(path)?;
        let computed = vertex_normals(&mesh.positions, &mesh.triangles);
        mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
        for (normal, computed) in mesh.normals.iter_mut().zip(computed) {
            // In double precision: the square of a short normal underflows.
            *normal = normal.as_dvec3().try_normalize().map_or(computed, |unit| unit.as_vec3());
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles: one of the object `Head A` and material `Skin`, one of the groups `cap` and `back`.
    const TWO: &str = "o Head A\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\nusemtl Skin\nf 1 2 3\no \nusemtl Hair\ng cap back\n\
                       f 1 3 4\n";

    #[test]
    fn parts_are_found_by_any_of_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.obj");
        std::fs::write(&path, TWO).unwrap();
        let highest = |name: &str| {
            let part = Mesh::load_part(&path, name).unwrap()?;
            assert_eq!(part.triangles.len(), 1, "{name}");
            part.bounds().map(|bounds| bounds.max.z)
        };
        for name in ["Head A", "skin"] {
            assert_eq!(highest(name), Some(0.0), "{name}");
        }
        for name in ["cap", "BACK", "cap back", "Hair"] {
            assert_eq!(highest(name), Some(5.0), "{name}");
        }
        assert_eq!(highest("Head"), None);
        assert_eq!(Mesh::part_names(&path).unwrap(), ["Hair", "Head A", "Skin", "back", "cap", "cap back"]);
    }
}
