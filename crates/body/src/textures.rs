//! The textures of a body, as they are read: decoded, counted, and halved until they fit.

use std::sync::Arc;

use crate::{Srgb, Texture};

/// Largest file of a picture that is read \[byte\].
pub(crate) const FILE_LIMIT: u64 = 64 << 20;
/// Longest side of a texture that is kept \[texel\]; larger ones are halved until they fit.
const MOST_KEPT_SIDE: u32 = 2048;
/// Most texels of all textures of a body: with smaller copies for the distance they fit the buffers of every GPU.
const MOST_KEPT: u64 = 20 << 20;
/// Most texels of all pictures that are read of one file.
const MOST_READ: u64 = 1 << 28;

/// Textures with the names that notes call them by.
pub(crate) struct Textures {
    kept: Vec<(String, Texture)>,
    srgb: Srgb,
    left: u64,
}

impl Default for Textures {
    fn default() -> Self {
        Self { kept: Vec::new(), srgb: Srgb::default(), left: MOST_READ }
    }
}

impl Textures {
    /// Reads a picture from the bytes of its file; adds a note where it cannot be read.
    pub fn read(
        &mut self,
        name: &str,
        bytes: Result<Vec<u8>, String>,
        notes: &mut Vec<String>,
    ) -> Option<Texture> {
        match bytes.and_then(|bytes| Texture::decode(&bytes, self.left)) {
            Ok(texture) => {
                self.left -= texture.texels.len() as u64;
                Some(texture)
            }
            Err(problem) => {
                notes.push(format!(
                    "the picture {name} is not read: {problem}; its parts are drawn without it"
                ));
                None
            }
        }
    }

    /// Keeps a texture, halved until it is small enough, which adds a note. Returns its place among all.
    pub fn keep(&mut self, name: String, mut texture: Texture, notes: &mut Vec<String>) -> usize {
        let full = [texture.width, texture.height];
        while texture.width.max(texture.height) > MOST_KEPT_SIDE {
            texture = texture.halved(&self.srgb);
        }
        if [texture.width, texture.height] != full {
            notes.push(scaled_down(&name, full, &texture));
        }
        self.kept.push((name, texture));
        self.kept.len() - 1
    }

    /// All textures, of which the largest are halved until they are few enough texels; adds a note for each that is.
    pub fn finish(mut self, notes: &mut Vec<String>) -> Vec<Arc<Texture>> {
        let size = |texture: &Texture| texture.texels.len() as u64;
        while self.kept.iter().map(|(_, texture)| size(texture)).sum::<u64>() > MOST_KEPT {
            let Some((name, largest)) = self.kept.iter_mut().max_by_key(|(_, texture)| size(texture)) else {
                break;
            };
            let full = [largest.width, largest.height];
            *largest = largest.halved(&self.srgb);
            notes.push(scaled_down(name, full, largest));
        }
        self.kept.into_iter().map(|(_, texture)| Arc::new(texture)).collect()
    }
}

fn scaled_down(name: &str, [width, height]: [u32; 2], texture: &Texture) -> String {
    let to = [texture.width, texture.height];
    format!("the picture {name} of {width} x {height} texels is scaled down to {} x {}", to[0], to[1])
}
