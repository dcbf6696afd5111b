//! Files that a person drops onto the page: read where they are, sent nowhere.

use std::path::Path;

use strandline::{
    Error, Groom, Mesh, Scene, Sources,
    format::{Chosen, FORMATS, Reader, endings},
    mesh::MeshFormat,
};

/// Largest file \[byte\]: its content takes some times as much of the 4 GiB that a module can have.
pub const MAX_BYTES: usize = 64 << 20;

/// A groom or a head in memory, under the name of its file.
#[derive(Clone)]
pub enum Dropped {
    Groom(String, Box<Groom>),
    Head(String, Mesh),
}

impl Dropped {
    /// Reads a file. An ending that grooms and meshes share is taken for a groom, and for a mesh where it holds no strands.
    ///
    /// # Errors
    /// A file that no reader takes: the error tells what was found, what was expected, and the name.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() > MAX_BYTES {
            let found = bytes.len() >> 20;
            return Err(format!("{found} MiB, expected {} at most: {name}", MAX_BYTES >> 20));
        }
        let path = Path::new(name);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let groom = FORMATS.iter().find(|format| Some(format.ending) == ending.as_deref());
        let groom = groom.and_then(|format| match format.read {
            Reader::Bytes(read) => Some(read(bytes, Chosen::default())),
            Reader::Project => None,
        });
        let mesh = MeshFormat::of(path).ok().map(|format| Mesh::from_bytes(bytes, format));
        match (groom, mesh) {
            (Some(Ok(parsed)), _) => Ok(Self::Groom(name.to_owned(), Box::new(parsed.groom))),
            (_, Some(Ok(mesh))) => Ok(Self::Head(name.to_owned(), mesh)),
            (Some(Err(error)), _) => Err(format!("{error}: {name}")),
            (None, Some(Err(error))) => Err(format!("{error}: {name}")),
            (None, None) => {
                let grooms = endings(|format| matches!(format.read, Reader::Bytes(_)));
                Err(format!("neither a groom ({grooms}) nor a head (.obj, .glb, .vrm, .ply or .stl): {name}"))
            }
        }
    }

    /// Names it in a scene.
    pub fn name_in(&self, scene: &mut Scene) {
        match self {
            Self::Groom(name, _) => {
                scene.groom.file = Some(name.into());
                scene.begin_at_rest();
            }
            Self::Head(name, _) => scene.body.file = Some(name.into()),
        }
    }

    /// Adds it to the sources of a scene.
    pub fn add_to(&self, sources: Sources) -> Sources {
        match self {
            Self::Groom(name, groom) => sources.with_groom(name, Groom::clone(groom)),
            Self::Head(name, mesh) => sources.with_mesh(name, mesh.clone()),
        }
    }

    /// True where both are of one kind, so that the later one takes the place of the other.
    pub fn replaces(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Groom(..), Self::Groom(..)) | (Self::Head(..), Self::Head(..)))
    }
}

/// Text of an error, for a visitor: a page has no environment to allow more memory with.
pub fn text(error: Error) -> String {
    let text = error.to_string();
    match text.split_once(", or allow more with the environment") {
        Some((before, _)) => before.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_much_memory_is_refused_by_its_key_without_a_mend_that_a_page_has_not() {
        let mut scene = Scene::demo();
        (scene.groom.bound, scene.groom.points_per_strand) = (Some(8_000_000), 64);
        let error = text(strandline::Prepared::new(&scene).err().unwrap());
        assert!(error.contains("MiB that may be taken") && error.ends_with("ask for less"), "{error}");
    }
}
