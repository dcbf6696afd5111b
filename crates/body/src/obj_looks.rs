//! Looks of an OBJ: the materials of the .mtl files that it names, and the colours of its vertices.
//!
//! All that is wrong with a look becomes a note: the shape is read all the same.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::{read_plain, whole_lines};

use crate::beside::file_below;
use crate::parsing::{Refusal, linear_light};
use crate::textures::{FILE_LIMIT, Textures};
use crate::{Material, Materials, Mesh, Wrap, obj};

/// Largest .mtl file that is read \[byte\], and the most that are read of one body.
const MTL_LIMIT: u64 = 4 << 20;
const MOST_LIBRARIES: usize = 64;
/// Alpha below which nothing is drawn: nothing is blended.
const HALF: f32 = 0.5;

/// Reads a mesh from the bytes of a file, in its units, with the materials that lie in its folder; vertices without a
/// normal get a zero one. Adds notes on looks that are not read.
pub(crate) fn parse(bytes: &[u8], folder: Option<&Path>, notes: &mut Vec<String>) -> Result<Mesh, Refusal> {
    let text = whole_lines(bytes);
    let mut mesh = obj::parse(&text)?;
    mesh.materials = looks(&text, folder, &mesh, notes).map(Arc::new);
    Ok(mesh)
}

/// The looks of the mesh of a file whose lines are whole; `None` where nothing has one. Adds notes.
fn looks(text: &[u8], folder: Option<&Path>, mesh: &Mesh, notes: &mut Vec<String>) -> Option<Materials> {
    let named = Library::read(text, folder, notes);
    let colors = colors(text, mesh);
    let materials = match (named, colors) {
        (None, None) => return None,
        (None, Some(colors)) => Materials::of_vertices(colors, mesh.triangles.len()),
        (Some(library), colors) => {
            let materials = library.on(text, notes);
            Materials { colors: colors.unwrap_or_default(), ..materials }
        }
    };
    let is_whole = materials.fit(mesh.positions.len(), mesh.triangles.len());
    if is_whole && materials.have_look() { materials.drawn(notes) } else { None }
}

/// The lines of a text, without those that are no text.
fn lines(text: &[u8]) -> impl Iterator<Item = &str> {
    text.split(|byte| *byte == b'\n').filter_map(|line| std::str::from_utf8(line).ok()).map(str::trim)
}

/// The words behind the kind of a line, if it has that kind.
fn rest<'a>(line: &'a str, kind: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(kind)?;
    rest.starts_with([' ', '\t']).then(|| rest.trim())
}

/// Linear colours of the vertices of a mesh from lines of six numbers, sRGB as scanners and sculpting programs write
/// them; `None` unless all vertices have one.
fn colors(text: &[u8], mesh: &Mesh) -> Option<Vec<Vec4>> {
    let color = |line: &str| {
        let numbers: Vec<f32> = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let [_, _, _, red, green, blue] = *numbers.as_slice() else { return None };
        Some(Vec3::new(red, green, blue))
    };
    let mut vertices = lines(text).filter_map(|line| rest(line, "v"));
    let of_file: Option<Vec<Vec3>> = vertices.try_fold(Vec::new(), |mut all, line| {
        all.push(color(line)?);
        Some(all)
    });
    let of_file = of_file?;
    let (order, count) = obj::order(text).ok()?;
    if order.len() != mesh.positions.len() || count != of_file.len() {
        return None;
    }
    Some(order.iter().map(|vertex| linear_light(of_file[*vertex as usize]).extend(1.0)).collect())
}

/// Materials by their names, and how each is painted.
struct Library {
    list: Vec<(Material, Paint)>,
    places: BTreeMap<String, usize>,
    textures: Textures,
    /// Place of each picture among the textures, by its name: several materials may share one.
    pictures: BTreeMap<String, Option<usize>>,
}

/// Scale and offset of the texture coordinates of a material.
#[derive(Clone, Copy)]
struct Paint {
    scale: Vec2,
    offset: Vec2,
}

impl Library {
    /// Reads the .mtl files that an OBJ names; `None` without any.
    fn read(text: &[u8], folder: Option<&Path>, notes: &mut Vec<String>) -> Option<Self> {
        let folder = folder?;
        // One name, which may hold spaces, or several.
        let is_one = |line: &str| !line.contains(char::is_whitespace) || found(folder, line).is_some();
        let of_line = |line| if is_one(line) { vec![line] } else { line.split_whitespace().collect() };
        let mut names: Vec<&str> =
            lines(text).filter_map(|line| rest(line, "mtllib")).flat_map(of_line).collect();
        names.sort_unstable();
        names.dedup();
        let mut library = Self {
            list: Vec::new(),
            places: BTreeMap::new(),
            textures: Textures::default(),
            pictures: BTreeMap::new(),
        };
        for name in names.into_iter().take(MOST_LIBRARIES) {
            let read = beside(folder, name, MTL_LIMIT).and_then(|bytes| {
                tobj::load_mtl_buf(&mut &*bytes).map_err(|error| format!("an invalid line ({error})"))
            });
            match read {
                Ok((materials, _)) => {
                    materials.iter().for_each(|material| library.add(material, folder, notes));
                }
                Err(problem) => notes.push(format!(
                    "the materials of `{}` are not read: {problem}; the body has the colour of `body_look.color`",
                    shortened(name)
                )),
            }
        }
        (!library.list.is_empty()).then_some(library)
    }

    fn add(&mut self, own: &tobj::Material, folder: &Path, notes: &mut Vec<String>) {
        if self.places.contains_key(&own.name) {
            return;
        }
        let sound = |share: f32| if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 };
        let number = |name: &str| own.unknown_param.get(name)?.parse::<f32>().ok().map(sound);
        let alpha = own.dissolve.map(sound).or_else(|| Some(1.0 - number("Tr")?)).unwrap_or(1.0);
        let mut material = Material { name: Some(own.name.clone()), ..Material::default() };
        let mut paint = Paint { scale: Vec2::ONE, offset: Vec2::ZERO };
        let picture = own.diffuse_texture.as_deref().map(Picture::new);
        if let Some(picture) = &picture {
            paint = picture.paint;
            material.wraps = [if picture.clamps { Wrap::Clamp } else { Wrap::Repeat }; 2];
            material.texture = self.texture(picture.file, folder, notes);
        }
        // A picture takes the place of the colour: programs write grey or black beside one.
        let color = own.diffuse.map(|color| Vec3::from(color.map(sound)));
        let color = if material.texture.is_some() { Some(Vec3::ONE) } else { color };
        material.color = color.map(|color| color.extend(alpha));
        let mask = own.dissolve_texture.as_deref().map(|mask| Picture::new(mask).file);
        let is_masked = mask.is_some() && mask == picture.as_ref().map(|picture| picture.file);
        if let Some(mask) = mask.filter(|_| !is_masked) {
            notes.push(format!("the mask `{}` of `{}` is not read", shortened(mask), shortened(&own.name)));
        }
        material.cutoff = (is_masked || alpha < 1.0).then_some(HALF);
        // Programs that write both make the exponent of roughness: Ns = 1000 (1 - roughness)^2.
        let exponent = own.shininess.filter(|exponent| exponent.is_finite());
        let of_exponent = exponent.map(|exponent| 1.0 - (exponent / 1000.0).clamp(0.0, 1.0).sqrt());
        material.roughness = number("Pr").or(of_exponent);
        material.metallic = number("Pm").unwrap_or(0.0);
        self.places.insert(own.name.clone(), self.list.len());
        self.list.push((material, paint));
    }

    fn texture(&mut self, name: &str, folder: &Path, notes: &mut Vec<String>) -> Option<usize> {
        if let Some(known) = self.pictures.get(name) {
            return *known;
        }
        let quoted = format!("`{}`", shortened(name));
        let texture = self.textures.read(&quoted, beside(folder, name, FILE_LIMIT), notes);
        let place = texture.map(|texture| self.textures.keep(quoted, texture, notes));
        self.pictures.insert(name.to_owned(), place);
        place
    }

    /// The materials on the triangles of a file, in the order of its faces.
    fn on(mut self, text: &[u8], notes: &mut Vec<String>) -> Materials {
        let plain = self.list.len() as u32;
        let mut own = plain;
        let mut places: Vec<Vec2> = Vec::new();
        let mut materials = Materials::default();
        for line in lines(text) {
            if let Some(name) = rest(line, "usemtl") {
                own = self.places.get(name).map_or(plain, |place| *place as u32);
            } else if let Some(pair) = rest(line, "vt") {
                let mut numbers = pair.split_whitespace().map(|word| word.parse().unwrap_or(0.0));
                places.push(Vec2::from([(); 2].map(|()| numbers.next().unwrap_or(0.0))));
            } else if let Some(face) = rest(line, "f") {
                let paint = self.list.get(own as usize).map(|(_, paint)| *paint);
                let corners: Vec<Vec2> =
                    face.split_whitespace().map(|word| corner(word, &places, paint)).collect();
                for pair in corners.get(1..).unwrap_or_default().windows(2) {
                    materials.coordinates.push([corners[0], pair[0], pair[1]]);
                    materials.of_triangles.push(own);
                }
            }
        }
        materials.list =
            self.list.drain(..).map(|(material, _)| material).chain([Material::default()]).collect();
        materials.textures = self.textures.finish(notes);
        materials
    }
}

/// Texture coordinates of the corner of a face, u right and v down; zero without.
fn corner(word: &str, places: &[Vec2], paint: Option<Paint>) -> Vec2 {
    let index = word.split('/').nth(1).and_then(|index| index.parse::<i64>().ok()).unwrap_or(0);
    let place = if index < 0 { places.len() as i64 + index } else { index - 1 };
    let own = usize::try_from(place).ok().and_then(|place| places.get(place)).copied().unwrap_or_default();
    let own = paint.map_or(own, |paint| paint.scale * own + paint.offset);
    let place = Vec2::new(own.x, 1.0 - own.y);
    // Those that are not finite, or far beyond the picture, are its corner.
    if place.abs().max_element() < 1e4 { place } else { Vec2::ZERO }
}

/// The picture of a line of an .mtl file: options, then the name of a file.
struct Picture<'a> {
    file: &'a str,
    paint: Paint,
    clamps: bool,
}

impl<'a> Picture<'a> {
    fn new(line: &'a str) -> Self {
        let mut own =
            Self { file: line, paint: Paint { scale: Vec2::ONE, offset: Vec2::ZERO }, clamps: false };
        let split = |text: &'a str| {
            text.split_once(char::is_whitespace).map(|(word, rest)| (word, rest.trim_start()))
        };
        while let Some((option, mut rest)) = split(own.file).filter(|(word, _)| word.starts_with('-')) {
            let mut numbers = Vec::new();
            let is_value = |word: &str| word.parse::<f32>().is_ok() || ["on", "off"].contains(&word);
            // One value at least belongs to an option, whatever it is; a file may be called by a number.
            while let Some((word, behind)) = split(rest).filter(|(word, _)| {
                numbers.len() < most_values(option) && (numbers.is_empty() || is_value(word))
            }) {
                own.clamps |= option == "-clamp" && word == "on";
                numbers.push(word.parse::<f32>().unwrap_or(0.0));
                rest = behind;
            }
            let pair =
                |default: f32| Vec2::from([0, 1].map(|at| numbers.get(at).copied().unwrap_or(default)));
            match option {
                "-s" => own.paint.scale = pair(1.0),
                "-o" => own.paint.offset = pair(0.0),
                _ => {}
            }
            own.file = rest;
        }
        own
    }
}

/// Values that an option of a picture has at most.
fn most_values(option: &str) -> usize {
    match option {
        "-s" | "-o" | "-t" => 3,
        "-mm" => 2,
        _ => 1,
    }
}

/// The file that another one names, below its folder; a path of another machine counts by its last name.
fn found(folder: &Path, name: &str) -> Option<PathBuf> {
    let name = name.trim_matches('"').replace('\\', "/");
    let last = name.rsplit('/').next().unwrap_or_default();
    let mut named = [name.as_str(), last].into_iter().filter_map(|name| file_below(folder, name));
    named.find(|path| path.is_file())
}

/// Reads a file that another one names: see [`found`].
fn beside(folder: &Path, name: &str, limit: u64) -> Result<Vec<u8>, String> {
    let path = found(folder, name).ok_or("no file beside the body, or in a folder there")?;
    read_plain(&path, limit).map_err(|error| error.to_string())
}

fn shortened(name: &str) -> String {
    name.chars().take(80).collect()
}
