//! The formats of mesh files, by their endings.

use std::path::Path;

use crate::parsing::Refusal;
use crate::part_names::Names;
use crate::{BodyError, Mesh, gltf, obj, obj_looks, ply, stl};

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ.
    Obj,
    /// glTF 2.0, as text, binary or VRM.
    Gltf,
    /// Polygon File Format (Stanford), as text or binary.
    Ply,
    /// Stereolithography, as text or binary.
    Stl,
}

impl MeshFormat {
    /// Endings of files, in lower case, and the format of each.
    pub const ENDINGS: [(&'static str, Self); 6] = [
        ("obj", Self::Obj),
        ("gltf", Self::Gltf),
        ("glb", Self::Gltf),
        ("vrm", Self::Gltf),
        ("ply", Self::Ply),
        ("stl", Self::Stl),
    ];

    /// The format that the ending of a path names.
    ///
    /// # Errors
    /// [`BodyError::Mesh`] for an ending that names none, with the way in where there is one.
    pub fn of(path: &Path) -> Result<Self, BodyError> {
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let named = Self::ENDINGS.iter().find(|(known, _)| *known == ending);
        named.map(|(_, format)| *format).ok_or_else(|| BodyError::Mesh {
            path: path.into(),
            found: format!("the ending `{ending}`"),
            expected: "obj, gltf, glb, vrm, ply or stl",
            mend: match ending.as_str() {
                "blend" => "in Blender, choose File > Export > glTF 2.0",
                "usd" | "usda" | "usdc" | "usdz" => {
                    "the `strandline` of `pip install 'strandline[usd]'` reads it; or open it in Blender and choose File > \
                     Export > glTF 2.0"
                }
                "abc" => {
                    "the `strandline` of `pip install 'strandline[abc]'` reads it; or open it in Blender and choose File > \
                     Export > glTF 2.0"
                }
                "fbx" | "dae" | "3ds" | "max" | "ma" | "mb" => {
                    "open it in Blender and choose File > Export > glTF 2.0"
                }
                _ => "export the body as glTF 2.0 or OBJ",
            },
        })
    }

    /// Tells whether the format itself defines units and axes: glTF is in metres, y up, the front along +z.
    pub fn defines_space(self) -> bool {
        self == Self::Gltf
    }

    /// Reads a mesh, or the part of it that has a name, from the bytes of a file; buffers beside it from its folder.
    /// Adds notes on what is odd but can be read.
    pub(crate) fn parse(
        self,
        bytes: &[u8],
        folder: Option<&Path>,
        names: Option<&mut Names>,
        notes: &mut Vec<String>,
    ) -> Result<Mesh, Refusal> {
        match self {
            Self::Obj => match names {
                Some(names) => obj::parse_part(bytes, names),
                None => obj_looks::parse(bytes, folder, notes),
            },
            Self::Gltf => gltf::parse(bytes, folder, names, notes),
            // These formats name no parts: no name is any of theirs.
            Self::Ply | Self::Stl if names.is_some() => Ok(Mesh::default()),
            Self::Ply => ply::parse(bytes, notes),
            Self::Stl => stl::parse(bytes),
        }
    }

    /// Advice for a file that is refused.
    pub(crate) fn mend(self) -> &'static str {
        match self {
            Self::Gltf => "export the body again as plain glTF 2.0 (no compression), or as OBJ",
            Self::Obj | Self::Ply | Self::Stl => "export the body again",
        }
    }
}
