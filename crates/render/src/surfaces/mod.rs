//! The materials of a body, as both backends read them.

mod paint;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::math;
use strandline_body::{Material, Materials, Mesh, NearestSurface, Srgb, Texture, Wrap};

pub(crate) use paint::Painted;

/// Words of a material, behind the table of stored colours.
pub(crate) const MATERIAL_WORDS: u32 = 12;
/// Linear light of stored numbers.
pub(crate) const TABLE_WORDS: u32 = 256;
/// Bits of a material: the wraps along u and v, and a colour of its own.
pub(crate) const MIRROR: u32 = 1;
pub(crate) const CLAMP: u32 = 2;
pub(crate) const WRAP_BITS: u32 = 2;
pub(crate) const OWN_COLOR: u32 = 16;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Corner {
    /// Texture coordinates.
    pub place: Vec2,
    /// Number of its triangle's material.
    pub material: u32,
    /// Texels of its triangle's texture along a metre of it, at rest \[1/m\].
    pub density: f32,
    /// Linear colour and alpha, a factor of the material's.
    pub color: Vec4,
}

/// Materials, textures with smaller copies for the distance, and corners of all triangles.
#[derive(Debug, Default)]
pub(crate) struct Surfaces {
    /// Linear light of stored numbers, materials, and texels of all textures with their smaller copies: see surfaces.wesl.
    pub words: Vec<u32>,
    /// Shape `[triangle][corner]`.
    pub corners: Vec<Corner>,
    /// Means of the colours of triangles that have one, and of the factors of those that have none, linear RGB, each times
    /// their share of the area.
    mean: [Vec3; 2],
    /// True where materials cut parts of triangles away.
    pub cuts: bool,
}

impl Surfaces {
    /// The materials of a mesh; `None` where it has none.
    pub fn new(mesh: &Mesh) -> Option<Self> {
        let counts = [mesh.positions.len(), mesh.triangles.len()];
        let materials = mesh.materials.as_deref().filter(|materials| materials.fit(counts[0], counts[1]))?;
        let srgb = Srgb::default();
        let mut words: Vec<u32> = srgb.linear.iter().map(|part| part.to_bits()).collect();
        let first = words.len() + materials.list.len() * MATERIAL_WORDS as usize;
        let mut texels = Vec::new();
        let mut places = Vec::with_capacity(materials.textures.len());
        for texture in &materials.textures {
            places.push([(first + texels.len()) as u32, add_copies(texture, &srgb, &mut texels)]);
        }
        for material in &materials.list {
            words.extend(material_words(material, materials, &places));
        }
        words.append(&mut texels);
        let corners = corners(mesh, materials);
        let cuts = materials.list.iter().any(|material| material.cutoff.is_some());
        let mut surfaces = Self { words, corners, mean: [Vec3::ZERO, Vec3::ONE], cuts };
        surfaces.mean = surfaces.mean(mesh);
        Some(surfaces)
    }

    /// Mean colour of the body, linear RGB, whose parts without a colour of their own have a given one.
    pub fn mean_color(&self, plain: Vec3) -> Vec3 {
        let [own, factor] = self.mean;
        own + plain * factor
    }

    /// Frees what a device holds.
    #[cfg(feature = "gpu")]
    pub fn forget(&mut self) {
        (self.words, self.corners) = Default::default();
    }

    fn mean(&self, mesh: &Mesh) -> [Vec3; 2] {
        let (mut own, mut factor, mut whole) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        for (index, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            let area = (b - a).cross(c - a).length();
            let painted = self.at(index as u32, Vec3::splat(1.0 / 3.0), 0.0);
            if !painted.is_cut() && area.is_finite() {
                whole += area;
                own += painted.own_color().unwrap_or(Vec3::ZERO) * area;
                factor += if painted.is_skin() { painted.color_on(Vec3::ONE) * area } else { Vec3::ZERO };
            }
        }
        if whole > 0.0 { [own, factor].map(|sum| sum / whole) } else { [Vec3::ZERO, Vec3::ONE] }
    }
}

/// Colours that a body's materials have at its places nearest to points \[m\], linear RGB; `None` where it has none.
pub fn body_colors(mesh: &Mesh, points: &[Vec3]) -> Vec<Option<Vec3>> {
    let Some(surfaces) = Surfaces::new(mesh) else { return vec![None; points.len()] };
    let places = NearestSurface::new(mesh).nearest_triangles(points);
    places.into_iter().map(|(triangle, shares)| surfaces.at(triangle, shares, 0.0).own_color()).collect()
}

/// Adds a texture and its copies of half the size each; returns the number of copies.
fn add_copies(texture: &Texture, srgb: &Srgb, texels: &mut Vec<u32>) -> u32 {
    let mut copies = 0;
    let mut add = |texture: &Texture| texels.extend(texture.texels.iter().copied().map(u32::from_le_bytes));
    add(texture);
    let mut copy = texture.clone();
    while copy.width.max(copy.height) > 1 {
        copy = copy.halved(srgb);
        add(&copy);
        copies += 1;
    }
    copies
}

fn material_words(
    material: &Material,
    materials: &Materials,
    places: &[[u32; 2]],
) -> [u32; MATERIAL_WORDS as usize] {
    let color = material.color.unwrap_or(Vec4::ONE).to_array().map(f32::to_bits);
    // Below 0: the body's settings say it, and nothing is cut.
    let gloss = [material.roughness.unwrap_or(-1.0), material.metallic, material.cutoff.unwrap_or(-1.0)];
    let [roughness, metallic, cutoff] = gloss.map(f32::to_bits);
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => 0,
        Wrap::Mirror => MIRROR,
        Wrap::Clamp => CLAMP,
    };
    let [along_u, along_v] = material.wraps.map(wrap);
    let own = if material.color.is_some() { OWN_COLOR } else { 0 };
    let bits = along_u | along_v << WRAP_BITS | own;
    let [first, copies, width, height] = material.texture.map_or([0; 4], |texture| {
        let ([first, copies], texture) = (places[texture], &materials.textures[texture]);
        [first, copies, texture.width, texture.height]
    });
    let [red, green, blue, alpha] = color;
    [red, green, blue, alpha, roughness, metallic, cutoff, bits, first, copies, width, height]
}

fn corners(mesh: &Mesh, materials: &Materials) -> Vec<Corner> {
    let of_triangle = |(index, corners): (usize, &[u32; 3])| {
        let (material, places) = (materials.of_triangles[index], materials.coordinates[index]);
        let density = density(mesh, *corners, places, materials, material);
        [0, 1, 2].map(|corner| {
            let color = materials.colors.get(corners[corner] as usize).copied().unwrap_or(Vec4::ONE);
            Corner { place: places[corner], material, density, color }
        })
    };
    mesh.triangles.iter().enumerate().flat_map(of_triangle).collect()
}

/// Texels of a triangle's texture along a metre of it \[1/m\], by their areas.
fn density(mesh: &Mesh, corners: [u32; 3], places: [Vec2; 3], materials: &Materials, material: u32) -> f32 {
    let Some(texture) = materials.list[material as usize].texture else { return 0.0 };
    let texture = &materials.textures[texture];
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let [a, b, c] = places.map(|place| place * size);
    let texels = (b - a).perp_dot(c - a).abs();
    let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
    let area = (b - a).cross(c - a).length();
    let density = (texels / area).sqrt();
    if density.is_finite() { density } else { 0.0 }
}

/// The copy of a texture that fits a sample, from 0, the full one: `density` texels on a metre \[1/m\], a sample as wide as
/// so many metres \[m\] of a surface that faces the eye, and the cosine between its normal and the line of sight.
pub(crate) fn copy_of(density: f32, sample: f32, cosine: f32) -> f32 {
    math::log2((density * sample / cosine.max(LEAST_COSINE).sqrt()).max(1.0))
}

/// Cosine below which surfaces on a slant are not drawn from smaller copies still.
pub(crate) const LEAST_COSINE: f32 = 0.1;
