//! The pictures of a glTF file's textures.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use ::gltf::Document;
use ::gltf::json::Value;
use strandline_base::read_plain;

use super::address::{file_below, from_base64};
use super::buffers::Buffers;
use crate::Texture;
use crate::textures::{FILE_LIMIT, Textures};

/// Reads pictures, each once.
pub(super) struct Pictures<'a> {
    pub document: &'a Document,
    pub buffers: &'a Buffers,
    /// The folder of the file, where pictures beside it are read.
    pub folder: Option<&'a Path>,
    /// The document's member `images`.
    pub images: &'a [Value],
    known: BTreeMap<usize, Option<usize>>,
    means: BTreeMap<usize, Option<[f32; 4]>>,
    textures: Textures,
}

impl<'a> Pictures<'a> {
    pub fn new(
        document: &'a Document,
        buffers: &'a Buffers,
        folder: Option<&'a Path>,
        images: &'a [Value],
    ) -> Self {
        Self {
            document,
            buffers,
            folder,
            images,
            known: BTreeMap::new(),
            means: BTreeMap::new(),
            textures: Textures::default(),
        }
    }

    /// The place of a picture among the textures; adds a note for one that is not read, or not whole.
    pub fn texture(&mut self, image: usize, notes: &mut Vec<String>) -> Option<usize> {
        if let Some(known) = self.known.get(&image) {
            return *known;
        }
        let read = self.read(image, notes);
        let read = read.map(|texture| self.textures.keep(self.name(image), texture, notes));
        self.known.insert(image, read);
        read
    }

    /// Means of the channels of a picture, 0 to 1; adds a note for one that is not read.
    pub fn means(&mut self, image: usize, notes: &mut Vec<String>) -> Option<[f32; 4]> {
        if let Some(known) = self.means.get(&image) {
            return *known;
        }
        let means = self.read(image, notes).map(|texture| texture.means());
        self.means.insert(image, means);
        means
    }

    /// All textures; adds notes for those that are halved.
    pub fn finish(self, notes: &mut Vec<String>) -> Vec<Arc<Texture>> {
        self.textures.finish(notes)
    }

    fn read(&mut self, image: usize, notes: &mut Vec<String>) -> Option<Texture> {
        let (name, bytes) = (self.name(image), self.bytes(image));
        self.textures.read(&name, bytes, notes)
    }

    fn name(&self, image: usize) -> String {
        let image_of = |key: &str| self.images.get(image)?.get(key)?.as_str();
        let is_address = |text: &&str| !text.is_empty() && !text.starts_with("data:");
        match image_of("name").or_else(|| image_of("uri")).filter(is_address) {
            Some(name) => format!("`{}`", name.chars().take(80).collect::<String>()),
            None => format!("{image}"),
        }
    }

    /// The bytes of the file of a picture.
    fn bytes(&self, image: usize) -> Result<Vec<u8>, String> {
        let image = self.images.get(image).ok_or("the file has no image of this number")?;
        if let Some(uri) = image.get("uri").and_then(Value::as_str) {
            if uri.starts_with("data:") {
                let bytes = uri.split_once(";base64,").and_then(|(_, text)| from_base64(text));
                return bytes.ok_or_else(|| "data that are not in base 64".to_owned());
            }
            let path = self.folder.and_then(|folder| file_below(folder, uri));
            let path = path.ok_or("no file beside the body, or in a folder there")?;
            return read_plain(&path, FILE_LIMIT).map_err(|error| error.to_string());
        }
        let view =
            image.get("bufferView").and_then(Value::as_u64).and_then(|view| usize::try_from(view).ok());
        let view = view.and_then(|view| self.document.views().nth(view));
        let bytes = view.and_then(|view| self.buffers.bytes_of(&view));
        bytes.map(<[u8]>::to_vec).ok_or_else(|| "no bytes in the file".to_owned())
    }
}
