//! Several files of strands and several meshes, brought together as one groom and one body.

use std::path::Path;

use glam::Vec3;
use strandline_base::SettingError;

use crate::{
    Error, Scene,
    body::Mesh,
    groom::{
        Groom,
        format::{Attribute, MAX_POINTS, MAX_STRANDS, Scale, Up},
    },
    scene::{BodyPart, GroomPart},
};

use super::{
    cover::Cover,
    guess, looks,
    placing::{Placing, diagonal, place_mesh, upright},
};

/// Times that files of one groom are as large as each other at most: brows, and hair to the hips.
const ALIKE: f32 = 30.0;
/// Least guides of a file that marks none, where others mark some.
const LEAST_GUIDES: usize = 16;

/// The mesh that hair hits, where it is not the drawn one, the parts that may cover hair, and for each part the number of
/// its first vertex in the drawn body; none of one that is not drawn.
type Joined = (Option<Mesh>, Vec<Cover>, Vec<Option<usize>>);

/// Notes on a file of strands, which begin with its name where a scene has several.
pub(super) fn of_file(
    scene: &Scene,
    file: Option<&Path>,
    notes: impl IntoIterator<Item = String>,
) -> impl Iterator<Item = String> {
    let file = file.filter(|_| !scene.groom.parts.is_empty()).map(|file| file.display().to_string());
    notes.into_iter().map(move |note| file.as_ref().map_or(note.clone(), |file| format!("{file}: {note}")))
}

/// Mends strands of one file, which are in head space. Notes on that and on those unlike the others begin with its name where
/// a scene has several.
pub(super) fn mended(scene: &Scene, file: Option<&Path>, groom: &mut Groom) -> Vec<String> {
    let mut notes = groom.mend();
    notes.extend(groom.unlike_beside());
    of_file(scene, file, notes).collect()
}

/// Adds a scene's further meshes to the first, which is in head space.
pub(super) fn add_meshes(
    scene: &Scene,
    drawn: &mut Mesh,
    further: Vec<Mesh>,
    first: Placing,
) -> Result<Joined, Error> {
    let (mut covers, mut starts) = (Vec::new(), Vec::new());
    let mut solid = (!further.is_empty()).then(|| drawn.clone());
    for (part, mut mesh) in scene.body.parts.iter().zip(further) {
        place_mesh(&mut mesh, part_placing(part, first), part.rotation, part.translation);
        starts.push(part.visible.then_some(drawn.positions.len()));
        if part.visible {
            drawn.append(&mesh)?;
        }
        let is_solid = part.solid.unwrap_or_else(|| mesh.is_closed());
        if let Some(solid) = solid.as_mut().filter(|_| is_solid) {
            solid.append(&mesh)?;
        }
        covers.push(Cover { mesh, name: part.file.display().to_string(), covers: part.covers, is_solid });
    }
    Ok((solid, covers, starts))
}

/// Placement of a further mesh, given that of the first.
pub(super) fn part_placing(part: &BodyPart, first: Placing) -> Placing {
    let scale = match part.scale {
        Scale::Auto => first.scale,
        Scale::Factor(factor) => factor,
    };
    let turn = if part.up == Up::Auto { first.turn } else { upright(part.up) };
    Placing { scale, turn }
}

/// Further grooms that seem to have the units and axes of the first: the scene gives them no units or axes, and they have
/// its size and lie near it.
pub(super) fn placed_as_first<'a>(
    scene: &'a Scene,
    first: Option<&Groom>,
    further: &'a [Groom],
) -> impl Iterator<Item = &'a Groom> {
    let own = first.map(Groom::bounds);
    let is_open = |part: &GroomPart| {
        part.scale == Scale::Auto
            && part.up == Up::Auto
            && [part.rotation, part.translation].iter().all(|by| *by == Vec3::ZERO)
    };
    let is_beside = move |groom: &Groom| {
        own.is_some_and(|own| {
            let other = groom.bounds();
            let sizes = [own, other].map(diagonal);
            let gap = (own.min.max(other.min) - own.max.min(other.max)).max_element();
            sizes[0] < ALIKE * sizes[1] && sizes[1] < ALIKE * sizes[0] && gap < sizes[0].max(sizes[1])
        })
    };
    let parts = further.iter().zip(&scene.groom.parts);
    parts.filter(move |(groom, part)| is_open(part) && is_beside(groom)).map(|(groom, _)| groom)
}

/// Adds the strands of a scene's further files, each a group, to those of the first, which are in head space; `place`
/// brings them there. Returns notes.
pub(super) fn add_grooms(
    scene: &Scene,
    groom: &mut Groom,
    further: Vec<Groom>,
    first: Placing,
    mesh: Option<&Mesh>,
    place: impl Fn(&mut Groom, Placing, Vec3, Vec3),
) -> Result<Vec<String>, Error> {
    let mut notes = Vec::new();
    if scene.groom.parts.is_empty() {
        return Ok(notes);
    }
    name_groups(groom, 0, stem(scene.groom.file.as_deref()));
    for (part, mut further) in scene.groom.parts.iter().zip(further) {
        let placing = guess::of_part(&further, part, first, mesh);
        if placing != first {
            notes.push(format!("{}: a unit is {} m", part.file.display(), placing.scale));
        }
        place(&mut further, placing, part.rotation, part.translation);
        let apart = mesh.and_then(|mesh| guess::apart(&further, mesh));
        notes.extend(of_file(scene, Some(&part.file), apart));
        notes.extend(mended(scene, Some(&part.file), &mut further));
        let next = groom.groups.iter().flatten().max().map_or(0, |group| group.saturating_add(1));
        if part.name.is_some() {
            leave_numbers(&mut further);
        }
        name_groups(&mut further, next, part.name.clone().unwrap_or_else(|| stem(Some(&part.file))));
        let strands = (groom.strand_count() + further.strand_count()) as u64;
        let points = (groom.points.len() + further.points.len()) as u64;
        if strands > MAX_STRANDS || points > MAX_POINTS {
            let found = format!("{strands} strands of {points} points in all");
            let expected = format!("{MAX_STRANDS} strands of {MAX_POINTS} points at most");
            return Err(SettingError::new("groom.parts", found, expected).into());
        }
        alike(scene, groom, &mut further);
        for lost in Attribute::ALL {
            let is_own = matches!(lost, Attribute::Widths | Attribute::WidthsAlong | Attribute::GroupNames);
            if !is_own && lost.is_in(groom) != lost.is_in(&further) {
                let has = if lost.is_in(groom) {
                    "not this file but one before it has"
                } else {
                    "not all files before it have"
                };
                notes.push(format!("{}: {has} {}: left out", part.file.display(), lost.name()));
            } else if lost == Attribute::Influences && lost.is_in(groom) {
                // Each counts its own guides from 0.
                notes.push(format!("{} of files that are brought together are left out", lost.name()));
            }
        }
        // Notes give the number that a strand has in its file.
        groom.number_strands();
        further.number_strands();
        groom.append(further);
    }
    Ok(notes)
}

fn stem(file: Option<&Path>) -> String {
    let stem = file.and_then(Path::file_stem);
    stem.map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Leaves out groups that have numbers alone, as the locks of a style have.
fn leave_numbers(groom: &mut Groom) {
    if groom.group_names.is_empty() {
        groom.groups = None;
    }
}

/// Makes a groom without groups one of a name and number; numbers of other groups count from there.
fn name_groups(groom: &mut Groom, first: u32, name: String) {
    match &mut groom.groups {
        None => {
            groom.groups = Some(vec![first; groom.strand_count()]);
            groom.group_names = [(first, name)].into();
        }
        Some(groups) => {
            groups.iter_mut().for_each(|group| *group = group.saturating_add(first));
            let names = std::mem::take(&mut groom.group_names);
            groom.group_names =
                names.into_iter().map(|(group, name)| (group.saturating_add(first), name)).collect();
        }
    }
}

/// Gives each of two grooms the attributes that only the other has, with values that mean the same.
fn alike(scene: &Scene, one: &mut Groom, two: &mut Groom) {
    if one.colors.is_some() != two.colors.is_some() {
        for groom in [&mut *one, &mut *two] {
            if groom.colors.is_none() {
                groom.colors = Some(looks::gradient(&scene.look, groom));
            }
        }
    }
    let share = |groom: &Groom| {
        groom.guide_flags.as_ref().map(|flags| {
            flags.iter().filter(|flag| **flag).count() as f32 / groom.strand_count().max(1) as f32
        })
    };
    let mark = |groom: &mut Groom, share: f32| {
        let wanted = (share * groom.strand_count() as f32).ceil() as usize;
        let mut flags = vec![false; groom.strand_count()];
        groom.representatives(wanted.max(LEAST_GUIDES)).into_iter().for_each(|strand| flags[strand] = true);
        groom.guide_flags = Some(flags);
    };
    match (share(one), share(two)) {
        (Some(share), None) => mark(two, share),
        (None, Some(share)) => mark(one, share),
        (Some(_), Some(_)) | (None, None) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groom(count: usize) -> Groom {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..count {
            let root = Vec3::X * strand as f32;
            groom.push([root, root + Vec3::Y, root + Vec3::Y * 2.0]);
        }
        groom
    }

    #[test]
    fn groups_of_several_files_do_not_meet() {
        let mut hair = groom(2);
        hair.groups = Some(vec![0, 4]);
        hair.group_names = [(4, "tail".to_owned())].into();
        name_groups(&mut hair, 3, "hair".to_owned());
        assert_eq!(hair.groups.as_deref(), Some(&[3, 7][..]));
        assert_eq!(hair.group_names[&7], "tail");
        let mut brows = groom(2);
        name_groups(&mut brows, 8, "brows".to_owned());
        assert_eq!((brows.groups.as_deref(), &*brows.group_names[&8]), (Some(&[8, 8][..]), "brows"));
        // Locks of a style take the name that a scene gives the file; groups with names keep theirs.
        let mut locks = groom(2);
        locks.groups = Some(vec![0, 1]);
        [&mut locks, &mut hair].into_iter().for_each(leave_numbers);
        name_groups(&mut locks, 8, "fringe".to_owned());
        assert_eq!((locks.groups.as_deref(), &*locks.group_names[&8]), (Some(&[8, 8][..]), "fringe"));
        assert_eq!(hair.groups.as_deref(), Some(&[3, 7][..]));
    }

    #[test]
    fn what_one_file_has_the_other_gets() {
        let (mut hair, mut brows) = (groom(100), groom(50));
        hair.colors = Some(vec![[0.5; 3]; hair.points.len()]);
        brows.guide_flags = Some((0..50).map(|strand| strand % 2 == 0).collect());
        alike(&Scene::default(), &mut hair, &mut brows);
        assert_eq!(brows.colors.as_ref().map(Vec::len), Some(150));
        assert!(brows.colors.unwrap()[0] != [0.5; 3], "the look's");
        let marked = hair.guide_flags.unwrap().iter().filter(|flag| **flag).count();
        assert!((40..=50).contains(&marked), "{marked}");
    }
}
