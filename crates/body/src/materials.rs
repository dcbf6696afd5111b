//! Looks of the parts of a mesh: colours, textures, cut-outs and gloss.

use std::sync::Arc;

use glam::{Vec2, Vec4};

use crate::Texture;

/// Continuation of a texture beyond its borders, along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// It begins again.
    #[default]
    Repeat,
    /// It runs back, then forth.
    Mirror,
    /// Its border goes on.
    Clamp,
}

/// A material of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Its name in the file.
    pub name: Option<String>,
    /// Factor of its colour, linear RGB and alpha; `None` leaves the colour to the settings of the body.
    pub color: Option<Vec4>,
    /// Index of its texture.
    pub texture: Option<usize>,
    /// Continuation of the texture along u and v.
    pub wraps: [Wrap; 2],
    /// Alpha below which nothing is drawn; `None` draws all of it.
    pub cutoff: Option<f32>,
    /// Width of its highlight, 0 to 1; `None` leaves it to the settings of the body.
    pub roughness: Option<f32>,
    /// Share of metal, 0 to 1.
    pub metallic: f32,
}

/// Materials of a mesh, and their places on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    /// The materials.
    pub list: Vec<Material>,
    /// Their textures.
    pub textures: Vec<Arc<Texture>>,
    /// Index of the material of each triangle.
    pub of_triangles: Vec<u32>,
    /// Texture coordinates of the corners of each triangle: u right, v down.
    pub coordinates: Vec<[Vec2; 3]>,
    /// Colours of vertices, linear RGB and alpha, factors of their material's; none, or one for each.
    pub colors: Vec<Vec4>,
}

/// Most triangles of a body that is drawn with its own colours: their numbers fit the buffers of every GPU.
const MOST_TRIANGLES: usize = 1 << 20;

impl Materials {
    /// A single material without a look of its own, for a number of triangles.
    pub(crate) fn plain(triangles: usize) -> Self {
        Self {
            list: vec![Material::default()],
            of_triangles: vec![0; triangles],
            coordinates: vec![[Vec2::ZERO; 3]; triangles],
            ..Self::default()
        }
    }

    /// A single material of the colours of vertices, linear RGB and alpha, for a number of triangles.
    pub(crate) fn of_vertices(colors: Vec<Vec4>, triangles: usize) -> Self {
        let painted = Material { color: Some(Vec4::ONE), ..Material::default() };
        Self { list: vec![painted], colors, ..Self::plain(triangles) }
    }

    /// The materials, unless a body has too many triangles to be drawn with them, which adds a note.
    pub(crate) fn drawn(self, notes: &mut Vec<String>) -> Option<Self> {
        if self.of_triangles.len() <= MOST_TRIANGLES {
            return Some(self);
        }
        notes
            .push(format!("a body of more than {MOST_TRIANGLES} triangles is drawn without its own colours"));
        None
    }

    /// True where some part has a look of its own.
    pub(crate) fn have_look(&self) -> bool {
        self.list.iter().any(|material| {
            material.color.is_some() || material.roughness.is_some() || material.cutoff.is_some()
        })
    }

    /// True where the indices and counts are those of a mesh of so many vertices and triangles, and the textures are
    /// whole.
    pub fn fit(&self, vertices: usize, triangles: usize) -> bool {
        let [materials, textures] = [self.list.len(), self.textures.len()];
        let counts = [self.of_triangles.len(), self.coordinates.len()];
        counts == [triangles; 2]
            && (self.colors.is_empty() || self.colors.len() == vertices)
            && self.of_triangles.iter().all(|material| (*material as usize) < materials)
            && self.list.iter().all(|material| material.texture.is_none_or(|texture| texture < textures))
            && self.textures.iter().all(|texture| texture.is_whole())
    }

    /// Adds those of a mesh whose vertices and triangles come behind these.
    pub(crate) fn append(&mut self, vertices: [usize; 2], other: &Self) {
        let (materials, textures) = (self.list.len() as u32, self.textures.len());
        if !(self.colors.is_empty() && other.colors.is_empty()) {
            self.colors.resize(vertices[0], Vec4::ONE);
            self.colors.extend_from_slice(&other.colors);
            self.colors.resize(vertices[0] + vertices[1], Vec4::ONE);
        }
        self.list.extend(other.list.iter().map(|material| Material {
            texture: material.texture.map(|texture| textures + texture),
            ..material.clone()
        }));
        self.textures.extend_from_slice(&other.textures);
        self.of_triangles.extend(other.of_triangles.iter().map(|material| materials + material));
        self.coordinates.extend_from_slice(&other.coordinates);
    }
}
