//! Looks of groups and values of maps, as colours and widths of strands.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use image::{DynamicImage, ImageFormat, ImageReader};
use strandline_base::{SettingError, math, memory, read_plain};

use crate::{
    Error, Scene,
    body::Random,
    groom::{Groom, Widths},
    render::{GroupLook, Look, fibre::chiang::WHITE},
};

/// Most pixels of all maps of a scene: four of the largest.
const MAX_PIXELS: u64 = 4 * (Scene::MAX_MAP_SIDE as u64).pow(2);
/// Greatest reflectance.
const MOST: f32 = 0.99;

/// Gives strands the colours and widths that the scene's maps and groups have for them.
///
/// # Errors
/// A group that the groom has not; a map that cannot be read, or a groom without places of roots for it.
pub(super) fn dress(scene: &Scene, groom: &mut Groom) -> Result<(), Error> {
    let look = &scene.look;
    let groups = groups(look, groom)?;
    let mut maps = Maps::default();
    let mut both = |color: &Option<PathBuf>, width: &Option<PathBuf>| {
        Ok::<_, Error>([maps.load(scene, color.as_deref())?, maps.load(scene, width.as_deref())?])
    };
    let of_all = both(&look.color_map, &look.width_map)?;
    let of_groups = look.group.iter().map(|group| both(&group.color_map, &group.width_map));
    let of_groups = of_groups.collect::<Result<Vec<_>, Error>>()?;
    let has = |which: usize| of_all[which].is_some() || of_groups.iter().any(|maps| maps[which].is_some());
    if (has(0) || has(1)) && groom.root_uvs.is_none() {
        let found = "a groom without root coordinates";
        let expected = "one whose strands say where on the scalp they grow (`strandline info` says)";
        return Err(SettingError::new("look.color_map or look.width_map", found, expected).into());
    }
    let pigments: Vec<Option<Look>> = look.group.iter().map(|group| group.own_pigment(look)).collect();
    let dressed = |strand: usize| {
        let group = groups[strand];
        let pigment = group.and_then(|group| pigments[group].as_ref());
        let (look, maps) = (group.map(|group| &look.group[group]), group.map(|group| &of_groups[group]));
        let uv = groom.root_uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[strand]);
        let at = |which: usize| maps.and_then(|maps| maps[which].as_ref()).or(of_all[which].as_ref());
        Dressed {
            look,
            pigment,
            color: at(0).map(|map| map.color(uv)),
            width: at(1).map(|map| map.share(uv)),
        }
    };
    if has(0)
        || look.group.iter().zip(&pigments).any(|(group, own)| group.root_color.is_some() || own.is_some())
    {
        groom.colors = Some(colors(look, groom, dressed));
    }
    if has(1) || look.group.iter().any(|group| group.width_scale != 1.0) {
        groom.widths = widths(groom, dressed);
    }
    Ok(())
}

/// Multiples of how far drawn strands lie about those of a groom; none where no group has its own.
pub(super) fn spreads(look: &Look, groom: &Groom) -> Result<Option<Vec<f32>>, Error> {
    if look.group.iter().all(|group| group.clump.is_none()) {
        return Ok(None);
    }
    let of = |group: Option<usize>| group.and_then(|group| look.group[group].clump).unwrap_or(1.0);
    Ok(Some(groups(look, groom)?.into_iter().map(of).collect()))
}

/// What one strand has of its own.
struct Dressed<'a> {
    look: Option<&'a GroupLook>,
    /// The look of all with its group's own pigment.
    pigment: Option<&'a Look>,
    color: Option<Vec3>,
    width: Option<f32>,
}

fn colors<'a>(look: &Look, groom: &Groom, dressed: impl Fn(usize) -> Dressed<'a>) -> Vec<[f32; 3]> {
    let mut colors = groom.colors.clone().unwrap_or_else(|| gradient(look, groom));
    for strand in 0..groom.strand_count() {
        let own = dressed(strand);
        let ends = match (own.color, own.look.and_then(|look| Some((look.root_color?, look.tip_color)))) {
            (Some(color), _) => [color; 2],
            (None, Some((root, tip))) => {
                varied(own.pigment.unwrap_or(look), strand, [root, tip.unwrap_or(root)])
            }
            (None, None) => match own.pigment {
                Some(look) => of_look(look, strand),
                None => continue,
            },
        };
        fill(&mut colors[groom.range(strand)], ends);
    }
    colors
}

fn widths<'a>(groom: &Groom, dressed: impl Fn(usize) -> Dressed<'a>) -> Widths {
    let scale = |strand: usize| {
        let own = dressed(strand);
        own.look.map_or(1.0, |look| look.width_scale) * own.width.unwrap_or(1.0)
    };
    let strands = 0..groom.strand_count();
    match &groom.widths {
        Widths::PerPoint(widths) => {
            let mut widths = widths.clone();
            for strand in strands {
                let scale = scale(strand);
                widths[groom.range(strand)].iter_mut().for_each(|width| *width *= scale);
            }
            Widths::PerPoint(widths)
        }
        Widths::Constant(_) | Widths::PerStrand(_) => Widths::PerStrand(
            strands.zip(groom.root_widths()).map(|(strand, width)| width * scale(strand)).collect(),
        ),
    }
}

/// The colours of a look along every strand.
pub(super) fn gradient(look: &Look, groom: &Groom) -> Vec<[f32; 3]> {
    let mut colors = vec![[0.0; 3]; groom.points.len()];
    for strand in 0..groom.strand_count() {
        fill(&mut colors[groom.range(strand)], of_look(look, strand));
    }
    colors
}

/// Colours at root and tip of a strand that nothing gives a colour but the look: its pigment, its white hair.
fn of_look(look: &Look, strand: usize) -> [Vec3; 2] {
    let fibre = &look.fibre.chiang;
    if look.fibre.shows_colors() {
        return varied(look, strand, [look.root_color, look.tip_color]);
    }
    let mut random = Random::new(u64::from(look.seed), strand as u64);
    let darker = math::exp2(-look.variation * (random.unit() + random.unit() - 1.0));
    let pigment = if random.unit() < look.grey { WHITE } else { darker };
    fibre.reflectances(pigment).map(|color| color.min(Vec3::splat(MOST)))
}

/// Colours at root and tip of a strand that is brighter or darker than others, as the look has it.
fn varied(look: &Look, strand: usize, ends: [Vec3; 2]) -> [Vec3; 2] {
    let mut random = Random::new(u64::from(look.seed), strand as u64);
    let brightness = 1.0 + look.variation * (random.unit() + random.unit() - 1.0);
    ends.map(|color| (color * brightness).clamp(Vec3::ZERO, Vec3::splat(MOST)))
}

fn fill(colors: &mut [[f32; 3]], [root, tip]: [Vec3; 2]) {
    let last = (colors.len() - 1).max(1) as f32;
    for (point, color) in colors.iter_mut().enumerate() {
        *color = root.lerp(tip, point as f32 / last).to_array();
    }
}

/// The look that each strand's group has, by its place in the list.
fn groups(look: &Look, groom: &Groom) -> Result<Vec<Option<usize>>, Error> {
    let mut found = vec![None; groom.strand_count()];
    for (place, group) in look.group.iter().enumerate().rev() {
        let named =
            groom.group_names.iter().filter(|(_, name)| **name == group.name).map(|(number, _)| *number);
        let mut numbers: Vec<u32> = named.collect();
        if numbers.is_empty() {
            numbers.extend(group.name.parse::<u32>());
        }
        let strands = groom.groups.iter().flatten().enumerate();
        let mut is_there = false;
        for (strand, _) in strands.filter(|(_, number)| numbers.contains(number)) {
            (found[strand], is_there) = (Some(place), true);
        }
        if !is_there {
            let key = format!("look.group[{place}].name");
            return Err(SettingError::new(key, format!("`{}`", group.name), known(groom)).into());
        }
    }
    Ok(found)
}

/// The groups that a groom has, human-readable.
fn known(groom: &Groom) -> String {
    let mut numbers = groom.groups.clone().unwrap_or_default();
    numbers.sort_unstable();
    numbers.dedup();
    if numbers.is_empty() {
        return "a groom with groups: this one has none".to_owned();
    }
    let name = |number: &u32| {
        groom.group_names.get(number).map_or_else(|| number.to_string(), |name| format!("`{name}`"))
    };
    let names: Vec<String> = numbers.iter().take(20).map(name).collect();
    let more = if numbers.len() > 20 { " ..." } else { "" };
    format!("a group of the groom: {}{more}", names.join(", "))
}

/// The maps of a scene, each read once.
#[derive(Default)]
struct Maps {
    read: BTreeMap<PathBuf, Arc<Map>>,
    pixels: u64,
}

impl Maps {
    fn load(&mut self, scene: &Scene, file: Option<&Path>) -> Result<Option<Arc<Map>>, Error> {
        let Some(path) = file.map(|file| scene.path(file)) else { return Ok(None) };
        if let Some(map) = self.read.get(&path) {
            return Ok(Some(map.clone()));
        }
        let map = Arc::new(Map::load(&path)?);
        self.pixels += u64::from(map.picture.width()) * u64::from(map.picture.height());
        if self.pixels > MAX_PIXELS {
            let message =
                format!("with it the maps have {} pixels, expected {MAX_PIXELS} in all", self.pixels);
            return Err(Error::Map { path, message });
        }
        self.read.insert(path, map.clone());
        Ok(Some(map))
    }
}

/// The linear colour and the share of white that a map over the scalp, the bytes of its file, has at a place.
///
/// # Errors
/// The bytes are no map.
#[doc(hidden)]
pub fn read_map(bytes: &[u8], uv: Vec2) -> Result<(Vec3, f32), String> {
    let map = Map::parse(bytes.to_vec())?;
    Ok((map.color(uv), map.share(uv)))
}

/// A picture over the scalp.
struct Map {
    picture: DynamicImage,
}

impl Map {
    fn load(path: &Path) -> Result<Self, Error> {
        let refuse = |message: String| Error::Map { path: path.to_owned(), message };
        let bytes = read_plain(path, Scene::MAX_MAP_BYTES).map_err(|error| refuse(error.to_string()))?;
        Self::parse(bytes).map_err(refuse)
    }

    fn parse(bytes: Vec<u8>) -> Result<Self, String> {
        let most = memory::most_unpacked(bytes.len() as u64);
        let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        let (mut limits, side) = (image::Limits::default(), Scene::MAX_MAP_SIDE);
        (limits.max_image_width, limits.max_image_height) = (Some(side), Some(side));
        limits.max_alloc = Some(most);
        reader.limits(limits);
        let expected = format!(
            "expected a .png of at most {side} x {side} pixels that unpack to {} MiB at most",
            most >> 20
        );
        let picture = reader.decode().map_err(|error| format!("{error}, {expected}"))?;
        Ok(Self {
            picture: if picture.color().has_color() {
                picture.into_rgb8().into()
            } else {
                picture.into_luma16().into()
            },
        })
    }

    /// The colour at a place, linear RGB.
    fn color(&self, uv: Vec2) -> Vec3 {
        self.at(uv, linear)
    }

    /// The share of white at a place.
    fn share(&self, uv: Vec2) -> f32 {
        self.at(uv, |part| part).element_sum() / 3.0
    }

    /// What lies between the four pixels about a place; beyond the borders they repeat.
    fn at(&self, uv: Vec2, part: impl Fn(f32) -> f32) -> Vec3 {
        let size = Vec2::new(self.picture.width() as f32, self.picture.height() as f32);
        // The first row of a picture is its upper border.
        let at = (Vec2::new(uv.x, 1.0 - uv.y) * size - 0.5).clamp(Vec2::ZERO, size - 1.0);
        let low = at.floor();
        let share = at - low;
        let pixel = |x: f32, y: f32| {
            let [x, y] = [x.min(size.x - 1.0) as u32, y.min(size.y - 1.0) as u32];
            let parts = match &self.picture {
                DynamicImage::ImageRgb8(picture) => {
                    picture.get_pixel(x, y).0.map(|part| f32::from(part) / 255.0)
                }
                DynamicImage::ImageLuma16(picture) => [f32::from(picture.get_pixel(x, y).0[0]) / 65_535.0; 3],
                _ => [0.0; 3],
            };
            Vec3::from(parts.map(&part))
        };
        let row = |y: f32| pixel(low.x, y).lerp(pixel(low.x + 1.0, y), share.x);
        row(low.y).lerp(row(low.y + 1.0), share.y)
    }
}

/// A part of a colour of the screen \[IEC 61966-2-1\] as light.
fn linear(part: f32) -> f32 {
    if part <= 0.040_45 { part / 12.92 } else { math::powf((part + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
#[path = "looks_tests.rs"]
mod tests;
