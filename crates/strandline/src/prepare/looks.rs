//! Looks of groups and values of maps, as colours and widths of strands.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use strandline_base::{SettingError, math};

use super::{Sources, loading::Loading, map::Map};
use crate::{
    Error, Scene,
    body::{Mesh, Random},
    groom::{Groom, Widths},
    render::{GroupLook, Look, body_colors, fibre::chiang::WHITE},
};

/// Most pixels of all maps of a scene: four of the largest.
const MAX_PIXELS: u64 = 4 * (Scene::MAX_MAP_SIDE as u64).pow(2);
/// Greatest reflectance.
const MOST: f32 = 0.99;

/// Gives strands the colours and widths that the scene's maps and groups have for them.
pub(super) fn colors(loading: &mut Loading) -> Result<(), Error> {
    let Loading { scene, sources, groom: Some(groom), mesh, notes, .. } = loading else { return Ok(()) };
    if scene.look.body_colors && groom.colors.is_none() {
        groom.colors = of_body(&scene.look, groom, mesh.as_ref());
        if groom.colors.is_none() {
            notes.push("look.body_colors changes nothing: the body has no colours at the roots".to_owned());
        }
    }
    dress(scene, sources, groom)
}

/// Colours that the materials of a body have at the roots, along strands; `None` where no root has one. Strands without
/// one have that of the look.
fn of_body(look: &Look, groom: &Groom, mesh: Option<&Mesh>) -> Option<Vec<[f32; 3]>> {
    let root = |strand: usize| groom.points.get(groom.range(strand).start).copied().unwrap_or_default();
    let roots: Vec<Vec3> = (0..groom.strand_count()).map(root).collect();
    let found = body_colors(mesh?, &roots);
    if found.iter().all(Option::is_none) {
        return None;
    }
    let mut colors = vec![[0.0; 3]; groom.points.len()];
    for (strand, color) in found.into_iter().enumerate() {
        let ends = match color {
            Some(color) => varied(look, strand, [color; 2]),
            None => of_look(look, strand),
        };
        fill(&mut colors[groom.range(strand)], ends);
    }
    Some(colors)
}

/// Gives strands the colours and widths that the scene's maps and groups have for them.
///
/// # Errors
/// A group that the groom has not; a map that cannot be read, or a groom without places of roots for it.
fn dress(scene: &Scene, sources: &Sources, groom: &mut Groom) -> Result<(), Error> {
    let look = &scene.look;
    let groups = groups(look, groom)?;
    let mut maps = Maps::default();
    let mut both = |color: &Option<PathBuf>, width: &Option<PathBuf>| {
        let mut load = |file: &Option<PathBuf>| maps.load(scene, sources, file.as_deref());
        Ok::<_, Error>([load(color)?, load(width)?])
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
        groom.colors = Some(strand_colors(look, groom, dressed));
    }
    if has(1) || look.group.iter().any(|group| group.width_scale != 1.0) {
        groom.widths = widths(groom, dressed);
    }
    Ok(())
}

/// Factors of the spread of drawn strands about those of a groom, shape `[strand]`; `None` where no group has its own.
pub(super) fn spreads(look: &Look, groom: &Groom) -> Result<Option<Vec<f32>>, Error> {
    if look.group.iter().all(|group| group.clump.is_none()) {
        return Ok(None);
    }
    let of = |group: Option<usize>| group.and_then(|group| look.group[group].clump).unwrap_or(1.0);
    Ok(Some(groups(look, groom)?.into_iter().map(of).collect()))
}

/// Look of one strand.
struct Dressed<'a> {
    look: Option<&'a GroupLook>,
    /// The look of all with its group's own pigment.
    pigment: Option<&'a Look>,
    color: Option<Vec3>,
    width: Option<f32>,
}

fn strand_colors<'a>(look: &Look, groom: &Groom, dressed: impl Fn(usize) -> Dressed<'a>) -> Vec<[f32; 3]> {
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
    colors_along(look, &groom.starts)
}

/// The colours of a look, linear RGB, along strands whose first points are given, and the number of points.
pub(crate) fn colors_along(look: &Look, starts: &[u32]) -> Vec<[f32; 3]> {
    let mut colors = vec![[0.0; 3]; starts.last().map_or(0, |end| *end as usize)];
    for (strand, ends) in starts.windows(2).enumerate() {
        fill(&mut colors[ends[0] as usize..ends[1] as usize], of_look(look, strand));
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
    fn load(
        &mut self,
        scene: &Scene,
        sources: &Sources,
        file: Option<&Path>,
    ) -> Result<Option<Arc<Map>>, Error> {
        let Some(name) = file else { return Ok(None) };
        if let Some(map) = self.read.get(name) {
            return Ok(Some(map.clone()));
        }
        let map = sources.map(scene, name)?;
        self.pixels += map.pixel_count();
        if self.pixels > MAX_PIXELS {
            let message =
                format!("with it the maps have {} pixels, expected {MAX_PIXELS} in all", self.pixels);
            return Err(Error::map(&scene.path(name), message));
        }
        self.read.insert(name.to_owned(), map.clone());
        Ok(Some(map))
    }
}

#[cfg(test)]
#[path = "looks_tests.rs"]
mod tests;
