//! Materials of a glTF file, and colours and texture coordinates of its vertices. All that is wrong with a look becomes a
//! note: the shape is read all the same.

use std::collections::BTreeMap;
use std::path::Path;

use ::gltf::Document;
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::json::Value;
use glam::{Vec2, Vec3, Vec4};

use super::buffers::Buffers;
use super::pictures::Pictures;
use crate::{Material, Materials, Mesh, Wrap};

/// Kinds of numbers of colours and texture coordinates, those of KHR_mesh_quantization among them.
const KINDS: [DataType; 5] = [DataType::F32, DataType::U8, DataType::U16, DataType::I8, DataType::I16];
/// Alpha at which blended materials are cut, and the default of masked ones. // glTF 2.0 §3.9.4
const HALF: f32 = 0.5;

/// The members of a document that say how it looks, as they were written: the parser of shapes would refuse some.
pub(super) struct Looks {
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    /// Attributes of vertices, shape `[mesh][part]`.
    attributes: Vec<Vec<Value>>,
}

impl Looks {
    /// Takes them from a document; names of materials stay.
    pub fn take(root: &mut Value) -> Self {
        let mut list = |name: &str| match root.get_mut(name).map(Value::take) {
            Some(Value::Array(list)) => list,
            _ => Vec::new(),
        };
        let [textures, images, samplers] = ["textures", "images", "samplers"].map(&mut list);
        let materials = root.get("materials").and_then(Value::as_array).cloned().unwrap_or_default();
        let parts = |mesh: &Value| {
            let parts = mesh.get("primitives").and_then(Value::as_array).into_iter().flatten();
            parts.map(|part| part.get("attributes").cloned().unwrap_or_default()).collect()
        };
        let meshes = root.get("meshes").and_then(Value::as_array).into_iter().flatten();
        let attributes = meshes.map(parts).collect();
        Self { materials, textures, images, samplers, attributes }
    }
}

/// A part of a mesh in the file, and its place in the whole mesh.
pub(super) struct Part {
    /// Number of the mesh, and of the part in it.
    pub of: [usize; 2],
    pub material: Option<usize>,
    /// Its first vertex and its first triangle in the whole mesh; it is the last one there.
    pub first: [usize; 2],
}

/// A texture in use: the set of coordinates, their transform, and the picture.
struct Painted {
    set: u64,
    transform: [Vec2; 3],
    image: Option<usize>,
    wraps: [Wrap; 2],
}

/// Collects the materials of the parts of a mesh.
pub(super) struct Painter<'a> {
    looks: &'a Looks,
    pictures: Pictures<'a>,
    kept: Materials,
    /// Places of materials in the kept list, by number and with colours of vertices or without, and their textures.
    known: BTreeMap<(Option<usize>, bool), (u32, Option<Painted>)>,
    /// Names of blended materials.
    blended: Vec<String>,
    notes: Vec<String>,
}

impl<'a> Painter<'a> {
    pub fn new(
        looks: &'a Looks,
        document: &'a Document,
        buffers: &'a Buffers,
        folder: Option<&'a Path>,
    ) -> Self {
        Self {
            looks,
            pictures: Pictures::new(document, buffers, folder, &looks.images),
            kept: Materials::default(),
            known: BTreeMap::new(),
            blended: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Adds a part, which was appended to a mesh.
    pub fn add(&mut self, part: &Part, mesh: &Mesh) {
        let ([first, first_triangle], count) = (part.first, mesh.positions.len() - part.first[0]);
        let colors = self.colors(part, count);
        let key = (part.material, colors.is_some());
        if !self.known.contains_key(&key) {
            let (mut material, painted) = self.material(part.material);
            material.color = material.color.or(colors.is_some().then_some(Vec4::ONE));
            self.known.insert(key, (self.kept.list.len() as u32, painted));
            self.kept.list.push(material);
        }
        let (number, painted) = &self.known[&key];
        let triangles = &mesh.triangles[first_triangle..];
        self.kept.of_triangles.resize(first_triangle + triangles.len(), *number);
        let coordinates = painted.as_ref().and_then(|painted| {
            let found = self.attribute(part, &format!("TEXCOORD_{}", painted.set));
            let coordinates = found.and_then(|accessor| {
                let pairs = self.pictures.buffers.numbers::<2>(&accessor, &KINDS, count).ok()?;
                (pairs.len() == count).then(|| pairs.into_iter().map(|pair| painted.place(Vec2::from(pair))))
            });
            Some(coordinates?.collect::<Vec<_>>())
        });
        let at = |corner: u32| match &coordinates {
            Some(coordinates) => coordinates[corner as usize - first],
            None => Vec2::ZERO,
        };
        self.kept.coordinates.extend(triangles.iter().map(|corners| corners.map(at)));
        if let Some(colors) = colors {
            self.kept.colors.resize(first, Vec4::ONE);
            self.kept.colors.extend(colors);
        }
    }

    /// The materials of a mesh; `None` where none of its parts has a look. Adds notes.
    pub fn finish(mut self, mesh: &Mesh, notes: &mut Vec<String>) -> Option<Materials> {
        let mut kept = self.kept;
        kept.textures = self.pictures.finish(&mut self.notes);
        if !kept.colors.is_empty() {
            kept.colors.resize(mesh.positions.len(), Vec4::ONE);
        }
        if !kept.have_look() {
            return None;
        }
        notes.append(&mut self.notes);
        if !self.blended.is_empty() {
            let names = self.blended.join(", ");
            notes.push(format!("nothing is blended: cut where half transparent are the materials {names}"));
        }
        kept.drawn(notes)
    }

    /// An attribute of the vertices of a part.
    fn attribute(&self, part: &Part, name: &str) -> Option<Accessor<'a>> {
        let [mesh, own] = part.of;
        let index = number(self.looks.attributes.get(mesh)?.get(own)?.get(name))?;
        self.pictures.document.accessors().nth(index)
    }

    /// Colours of the vertices of a part.
    fn colors(&self, part: &Part, count: usize) -> Option<Vec<Vec4>> {
        let accessor = self.attribute(part, "COLOR_0")?;
        let buffers = self.pictures.buffers;
        let colors: Vec<Vec4> = match accessor.dimensions() {
            Dimensions::Vec3 => {
                let colors = buffers.numbers::<3>(&accessor, &KINDS[..3], count).ok()?;
                colors.into_iter().map(|color| Vec3::from(color).extend(1.0)).collect()
            }
            _ => {
                let colors = buffers.numbers::<4>(&accessor, &KINDS[..3], count).ok()?;
                colors.into_iter().map(Vec4::from).collect()
            }
        };
        let sound =
            |color: Vec4| if color.is_finite() { color.clamp(Vec4::ZERO, Vec4::ONE) } else { Vec4::ONE };
        (colors.len() == count).then(|| colors.into_iter().map(sound).collect())
    }

    /// Reads a material of the file, and how it is painted.
    fn material(&mut self, index: Option<usize>) -> (Material, Option<Painted>) {
        let Some(own) = index.and_then(|index| self.looks.materials.get(index)) else {
            return (Material::default(), None);
        };
        let name = own.get("name").and_then(Value::as_str).filter(|name| !name.is_empty());
        let mut material = Material { name: name.map(str::to_owned), ..Material::default() };
        let mut painted = None;
        let older = extension(own, "KHR_materials_pbrSpecularGlossiness");
        if let Some(pbr) = own.get("pbrMetallicRoughness").or(older) {
            let either = |one: &str, other: &str| pbr.get(one).or_else(|| pbr.get(other));
            let factor = either("baseColorFactor", "diffuseFactor");
            painted = either("baseColorTexture", "diffuseTexture").map(|texture| self.painted(texture));
            if factor.is_some() || painted.is_some() {
                material.color = Some(color(factor));
            }
            let share = |name: &str| pbr.get(name).and_then(Value::as_f64).map(|share| share as f32);
            // Bodies are not metal where their file says nothing: there glTF 2.0 has 1.
            let (mut roughness, mut metallic) = (share("roughnessFactor"), share("metallicFactor"));
            roughness = roughness.or_else(|| Some(1.0 - share("glossinessFactor")?));
            if let Some(texture) = pbr.get("metallicRoughnessTexture") {
                let image = self.painted(texture).image;
                let means = image.and_then(|image| self.pictures.means(image, &mut self.notes));
                let [_, green, blue, _] = means.unwrap_or([1.0; 4]);
                roughness = Some(roughness.unwrap_or(1.0) * green);
                metallic = means.map(|_| metallic.unwrap_or(1.0) * blue);
            }
            let sound = |share: f32| if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 };
            material.roughness =
                (material.color.is_some() || roughness.is_some()).then(|| roughness.map_or(1.0, sound));
            material.metallic = metallic.map_or(0.0, sound);
        }
        material.cutoff = match own.get("alphaMode").and_then(Value::as_str) {
            Some("MASK") => {
                Some(own.get("alphaCutoff").and_then(Value::as_f64).map_or(HALF, |cut| cut as f32))
            }
            Some("BLEND") => {
                let number = || format!("{}", index.unwrap_or_default());
                let name = name.map_or_else(number, |name| format!("`{name}`"));
                if !self.blended.contains(&name) {
                    self.blended.push(name);
                }
                Some(HALF)
            }
            _ => None,
        };
        if let Some(painted) = &painted {
            let texture = painted.image.and_then(|image| self.pictures.texture(image, &mut self.notes));
            (material.texture, material.wraps) = (texture, painted.wraps);
        }
        (material, painted)
    }

    /// Follows a reference to a texture.
    fn painted(&mut self, info: &Value) -> Painted {
        let transform = extension(info, "KHR_texture_transform");
        let set = transform.and_then(|transform| transform.get("texCoord")).or_else(|| info.get("texCoord"));
        let texture = number(info.get("index")).and_then(|index| self.looks.textures.get(index));
        let image = texture.and_then(|texture| number(texture.get("source")));
        if let Some(texture) = texture.filter(|_| image.is_none()) {
            let kinds = texture.get("extensions").and_then(Value::as_object);
            let kinds = kinds.map(|kinds| kinds.keys().cloned().collect::<Vec<_>>().join(", "));
            let kinds = kinds.filter(|kinds| !kinds.is_empty()).unwrap_or_else(|| "no picture".to_owned());
            self.notes.push(format!("a texture of {kinds} is not read: its parts are drawn without it"));
        }
        let sampler = texture.and_then(|texture| number(texture.get("sampler")));
        let sampler = sampler.and_then(|sampler| self.looks.samplers.get(sampler));
        let wrap = |name: &str| match sampler.and_then(|sampler| sampler.get(name)).and_then(Value::as_u64) {
            Some(33071) => Wrap::Clamp,
            Some(33648) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        Painted {
            set: set.and_then(Value::as_u64).unwrap_or(0),
            transform: transform.map_or([Vec2::ZERO, Vec2::X, Vec2::Y], columns),
            image,
            wraps: [wrap("wrapS"), wrap("wrapT")],
        }
    }
}

impl Painted {
    /// Coordinates in the picture; those that are not finite, or far beyond the picture, are its corner.
    fn place(&self, own: Vec2) -> Vec2 {
        let [offset, right, down] = self.transform;
        let place = offset + own.x * right + own.y * down;
        if place.abs().max_element() < 1e4 { place } else { Vec2::ZERO }
    }
}

/// The offset and the axes of KHR_texture_transform: scaled, then turned, then moved.
fn columns(transform: &Value) -> [Vec2; 3] {
    let pair = |name: &str, default: f32| {
        let part = |at: usize| transform.get(name)?.get(at)?.as_f64().map(|part| part as f32);
        Vec2::new(part(0).unwrap_or(default), part(1).unwrap_or(default))
    };
    let angle = transform.get("rotation").and_then(Value::as_f64).unwrap_or(0.0) as f32;
    let (sine, cosine) = strandline_base::math::sin_cos(angle);
    let scale = pair("scale", 1.0);
    [pair("offset", 0.0), scale.x * Vec2::new(cosine, -sine), scale.y * Vec2::new(sine, cosine)]
}

/// The factor of a colour: white without one.
fn color(factor: Option<&Value>) -> Vec4 {
    let part = |at: usize| factor.and_then(|factor| factor.get(at)).and_then(Value::as_f64).unwrap_or(1.0);
    Vec4::from([0, 1, 2, 3].map(|at| (part(at) as f32).clamp(0.0, 1.0)))
}

fn extension<'a>(value: &'a Value, name: &str) -> Option<&'a Value> {
    value.get("extensions")?.get(name)
}

fn number(value: Option<&Value>) -> Option<usize> {
    value.and_then(Value::as_u64).and_then(|number| usize::try_from(number).ok())
}
