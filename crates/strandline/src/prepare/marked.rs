//! A grown style on the scalp that a body's file marks: what grows over the built-in scalp is spread over that one.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use strandline_base::{SettingError, counted, math};

use super::join::part_placing;
use super::loading::Loading;
use super::placing::place_mesh;
use super::skull::Skull;
use crate::{
    Error,
    body::{Mannequin, Mesh},
    groom::Groom,
};

/// Name of a part that may be one.
const LIKELY: &str = "scalp";
/// Names that an error lists.
const LISTED: usize = 12;
/// Directions around the vertical axis in which the rim of a scalp is looked for.
const DIRECTIONS: usize = 72;
/// Places along the edge of a triangle that are looked at.
const PLACES: usize = 6;
/// Roots of the built-in scalp that show where its rim is.
const ROOTS: usize = 4000;
/// Times that a root is looked for on it again, from as far as it was found.
const LOOKS: usize = 3;
/// Distance of a root from the marked scalp that is allowed, and from which it is led there, as shares of the skull's width.
const ASTRAY: f32 = 0.05;
const OFF: f32 = 0.4;

/// The scalp that a scene names among the meshes of its body, head space; none where it names none. Adds a note where
/// it names none, and a mesh has that name.
///
/// # Errors
/// A file that cannot be read; no mesh of the name.
pub(super) fn scalp(loading: &mut Loading) -> Result<Option<Mesh>, Error> {
    let (scene, sources, placing) = (&loading.scene, loading.sources, loading.placings.body);
    let body = &scene.body;
    let Some(file) = &body.file else { return Ok(None) };
    let first = (file, placing, [body.rotation, body.translation]);
    let further = body
        .parts
        .iter()
        .map(|part| (&part.file, part_placing(part, placing), [part.rotation, part.translation]));
    let files: Vec<_> = std::iter::once(first).chain(further).collect();
    let Some(name) = &body.scalp else {
        let parts = sources.part_names(scene, file)?;
        if let Some(part) = parts.iter().find(|part| part.eq_ignore_ascii_case(LIKELY)) {
            let of_file = if body.parts.is_empty() { String::new() } else { format!("{}: ", file.display()) };
            let note = format!(
                "{of_file}the body has a part `{part}`: body.scalp = \"{part}\" grows the style on it"
            );
            loading.notes.push(note);
        }
        return Ok(None);
    };
    for (file, placing, [turn, translation]) in &files {
        if let Some(mut found) = sources.mesh_part(scene, file, name)? {
            place_mesh(&mut found, *placing, *turn, *translation);
            return Ok(Some(found));
        }
    }
    let mut names = Vec::new();
    for (file, ..) in &files {
        names.extend(sources.part_names(scene, file)?);
    }
    Err(SettingError::new("body.scalp", format!("`{name}`"), known(names)).into())
}

/// Lists the names of parts, human-readable.
fn known(mut names: Vec<String>) -> String {
    let more = if names.len() > LISTED { " ..." } else { "" };
    names.truncate(LISTED);
    if names.is_empty() {
        "a body with named parts: this one has none".to_owned()
    } else {
        format!("a part of the body: `{}`{more}", names.join("`, `"))
    }
}

/// Extent of a scalp down from the crown in each direction \[rad\], seen from within the skull.
#[derive(Clone, Debug)]
struct Rim {
    polars: Vec<Option<f32>>,
}

impl Rim {
    fn new(middle: Vec3, places: impl Iterator<Item = Vec3>) -> Self {
        let mut polars = vec![None; DIRECTIONS];
        for place in places {
            let Bearing { polar, azimuth, .. } = Bearing::of(place - middle);
            let rim: &mut Option<f32> =
                &mut polars[(azimuth / TAU * DIRECTIONS as f32) as usize % DIRECTIONS];
            *rim = Some(rim.map_or(polar, |held| held.max(polar)));
        }
        Self { polars }
    }

    /// In a direction, between those of which something is known.
    fn at(&self, azimuth: f32) -> f32 {
        let place = azimuth / TAU * DIRECTIONS as f32 - 0.5;
        let low = place.floor();
        let known = |from: f32, step: isize| {
            let from = (from as isize).rem_euclid(DIRECTIONS as isize);
            (0..DIRECTIONS as isize).find_map(|by| {
                let rim = self.polars[(from + step * by).rem_euclid(DIRECTIONS as isize) as usize]?;
                Some((rim, by as f32))
            })
        };
        match (known(low, -1), known(low + 1.0, 1)) {
            (Some((before, back)), Some((after, on))) => {
                let share = (place - low + back) / (1.0 + back + on);
                before + (after - before) * share
            }
            _ => 0.0,
        }
    }
}

/// Direction and distance of a place from the middle of the skull.
struct Bearing {
    polar: f32,
    azimuth: f32,
    distance: f32,
}

impl Bearing {
    fn of(beside: Vec3) -> Self {
        let distance = beside.length();
        let polar = math::acos((beside.y / distance.max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0));
        Self { polar, azimuth: math::atan2(beside.x, beside.z).rem_euclid(TAU), distance }
    }

    fn place(&self) -> Vec3 {
        let ((across, up), (left, ahead)) = (math::sin_cos(self.polar), math::sin_cos(self.azimuth));
        Vec3::new(across * left, up, across * ahead) * self.distance
    }
}

/// Spreads a style, whose strands lie about the skull of the body already, over its marked scalp: along each meridian
/// the rim of the built-in scalp comes to that of the marked one, what hangs below it follows less and less, and
/// roots are led onto the mesh. `place` leads from the built-in head to this one. Returns a note for a person.
///
/// # Errors
/// Nothing grows on what is marked.
pub(super) fn onto(
    groom: &mut Groom,
    marked: &Mesh,
    skull: &Skull,
    place: impl Fn(Vec3) -> Vec3,
) -> Result<String, Error> {
    let middle = Vec3::new(skull.middle.x, skull.top - 0.5 * skull.size.x, skull.middle.y);
    let built_in = Mannequin::new().scalp().roots(ROOTS, 0);
    let from = Rim::new(middle, built_in.iter().map(|root| place(root.position)));
    let to = Rim::new(middle, places(marked));
    for point in &mut groom.points {
        let seen = Bearing::of(*point - middle);
        let (from, to) = (from.at(seen.azimuth), to.at(seen.azimuth));
        let polar = if seen.polar < from {
            seen.polar * to / from
        } else {
            to + (seen.polar - from) * (PI - to) / (PI - from).max(f32::MIN_POSITIVE)
        };
        *point = middle + Bearing { polar, ..seen }.place();
    }
    let roots: Vec<Vec3> = groom.roots().collect();
    let (sought, found) = seen_on(marked, middle, &roots);
    let width = skull.size.x;
    let is_near = |strand: &usize| {
        let (root, sought, found) = (roots[*strand], sought[*strand], found[*strand]);
        sought.distance(found) < ASTRAY * width && root.distance(found) < OFF * width
    };
    let kept: Vec<usize> = (0..roots.len()).filter(is_near).collect();
    if kept.is_empty() {
        let expected = "a part at the top of the head, where hair grows";
        return Err(SettingError::new("body.scalp", "a part far from the skull", expected).into());
    }
    for strand in 0..roots.len() {
        let (range, way) = (groom.range(strand), found[strand] - roots[strand]);
        groom.points[range].iter_mut().for_each(|point| *point += way);
    }
    let bare = roots.len() - kept.len();
    if bare > 0 {
        *groom = groom.select(&kept);
    }
    let left = if bare > 0 {
        format!("; {} no place on it", counted(bare, "strand has", "strands have"))
    } else {
        String::new()
    };
    Ok(format!("the style grows on the scalp that the body marks{left}"))
}

/// Roots moved to the mesh's distance from the middle of the skull, and the points of the mesh nearest to them.
fn seen_on(mesh: &Mesh, middle: Vec3, roots: &[Vec3]) -> (Vec<Vec3>, Vec<Vec3>) {
    let mut sought = roots.to_vec();
    let mut found = mesh.nearest_places(&sought);
    for _ in 0..LOOKS {
        for (place, found) in sought.iter_mut().zip(&found) {
            *place = middle + (*place - middle).normalize_or(Vec3::Y) * found.distance(middle);
        }
        found = mesh.nearest_places(&sought);
    }
    (sought, found)
}

/// Places all over the triangles of a mesh.
fn places(mesh: &Mesh) -> impl Iterator<Item = Vec3> {
    mesh.triangles.iter().flat_map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        let shares = (0..=PLACES).flat_map(|u| (0..=PLACES - u).map(move |v| (u, v)));
        let share = |step: usize| step as f32 / PLACES as f32;
        shares.map(move |(u, v)| a + (b - a) * share(u) + (c - a) * share(v))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::groom::{Style, StyleSettings};

    /// The part of the built-in bust above a height that rises to the front.
    fn cap(low: f32, rise: f32) -> Mesh {
        let mesh = Mannequin::new().mesh();
        let is_in = |corner: &u32| {
            let place = mesh.positions[*corner as usize];
            place.y > low + rise * place.z
        };
        let triangles = mesh.triangles.iter().filter(|corners| corners.iter().all(is_in)).copied();
        Mesh::new(mesh.positions.clone(), triangles.collect()).unwrap()
    }

    #[test]
    fn a_style_covers_what_is_marked_and_nothing_else() {
        let mesh = Mannequin::new().mesh();
        let skull = Skull::of(&mesh.positions).unwrap();
        for (low, rise) in [(skull.top - 0.05, 0.0), (skull.top - 0.12, 0.6)] {
            let marked = cap(low, rise);
            let style = StyleSettings { strand_count: 1500, ..StyleSettings::new(Style::Bob) };
            let mut groom = style.grow().unwrap();
            let lengths = groom.lengths();
            let note = onto(&mut groom, &marked, &skull, |point| point).unwrap();
            assert!(note.contains("marks"), "{note}");
            assert!(groom.strand_count() > 1350, "{} of 1,500 have a place", groom.strand_count());
            let roots: Vec<Vec3> = groom.roots().collect();
            for (root, place) in roots.iter().zip(marked.nearest_places(&roots)) {
                assert!(root.distance(place) < 1e-5, "{root}");
            }
            // No bald place: each triangle of some size has a root nearby.
            for corners in &marked.triangles {
                let middle =
                    corners.iter().map(|corner| marked.positions[*corner as usize]).sum::<Vec3>() / 3.0;
                let nearest = roots.iter().map(|root| root.distance(middle)).fold(f32::INFINITY, f32::min);
                assert!(nearest < 0.02, "{middle} is {nearest} m from a root");
            }
            // Hair is about as long as it was.
            let mean = |lengths: &[f32]| lengths.iter().sum::<f32>() / lengths.len() as f32;
            let ratio = mean(&groom.lengths()) / mean(&lengths);
            assert!((0.8..1.25).contains(&ratio), "{ratio}");
        }
    }

    #[test]
    fn what_lies_elsewhere_is_no_scalp() {
        let mesh = Mannequin::new().mesh();
        let skull = Skull::of(&mesh.positions).unwrap();
        let mut far = cap(skull.top - 0.05, 0.0);
        far.positions.iter_mut().for_each(|place| *place += Vec3::Y);
        let mut groom = StyleSettings { strand_count: 50, ..StyleSettings::new(Style::Bob) }.grow().unwrap();
        let error = onto(&mut groom, &far, &skull, |point| point).unwrap_err().to_string();
        assert!(error.contains("body.scalp") && error.contains("top of the head"), "{error}");
    }
}
