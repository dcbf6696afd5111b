//! Second stage of loading: strands and body in head space, several files as one groom and one mesh.

use std::path::Path;

use glam::Vec3;
use strandline_base::math;

use super::{
    doubts, foreign,
    framing::center,
    guess::{self, Strands},
    join,
    loading::Loading,
    placing::{Placing, place_mesh},
    shown::Body,
    skull::Skull,
};
use crate::{
    Error, Scene,
    groom::{
        Groom, Widths,
        format::{Attribute, HAIR_WIDTH},
    },
};

/// Distance of hair from the origin \[m\] beyond which coordinates of single precision are 30 um apart.
const FAR: f32 = 256.0;

/// Guesses units, axes and front of grooms and meshes together, brings them into head space and joins them.
pub(super) fn place(loading: &mut Loading) -> Result<(), Error> {
    choose(loading)?;
    place_body(loading)?;
    place_hair(loading)
}

/// Chooses the placements, or refuses them where they are not sure and a setting decides.
fn choose(loading: &mut Loading) -> Result<(), Error> {
    loading.look_at_body();
    let Loading { sources, scene, groom, further_grooms: further, mesh, shown, .. } = loading;
    let grooms: Vec<&Groom> =
        groom.iter().chain(join::placed_as_first(scene, groom.as_ref(), further)).collect();
    let body = mesh.as_ref().zip(shown.as_ref()).map(|(mesh, shown)| Body { mesh, shown });
    let strands = Strands { grooms: &grooms, is_defined: sources.defines_groom(scene) };
    loading.placings = guess::placings(scene, strands, body);
    loading.is_foreign = loading.placings.is_foreign;
    let several = !(scene.groom.parts.is_empty() && scene.body.parts.is_empty());
    let files = several.then(|| files(scene, |file| file.display().to_string()));
    let notes = std::mem::take(&mut loading.placings.notes).into_iter();
    loading.notes.extend(notes.map(|note| match &files {
        Some(files) => format!("{files}: {note}"),
        None => note,
    }));
    loading.placings.refusal.take().map_or(Ok(()), |problem| Err(refused(scene, problem)))
}

/// The error of a placement that is not sure.
fn refused(scene: &Scene, problem: String) -> Error {
    Error::Placement { files: files(scene, |file| scene.path(file).display().to_string()), problem }
}

/// Names of the files that are placed: the groom on the body.
fn files(scene: &Scene, name: impl Fn(&Path) -> String) -> String {
    let files = [&scene.groom.file, &scene.body.file];
    files.into_iter().flatten().map(|file| name(file)).collect::<Vec<_>>().join(" on ")
}

/// Brings the meshes into head space.
fn place_body(loading: &mut Loading) -> Result<(), Error> {
    let Some(mesh) = &mut loading.mesh else { return Ok(()) };
    let (scene, placing) = (&loading.scene, loading.placings.body);
    place_mesh(mesh, placing, scene.body.rotation, scene.body.translation);
    let further = std::mem::take(&mut loading.further_meshes);
    loading.skull = if further.is_empty() { None } else { Skull::of_body(mesh) };
    (loading.solid_mesh, loading.covers, loading.part_starts) =
        join::add_meshes(scene, mesh, further, placing)?;
    Ok(())
}

/// Brings the strands into head space.
fn place_hair(loading: &mut Loading) -> Result<(), Error> {
    let Loading { scene, groom: Some(groom), mesh, notes, placings, .. } = loading else { return Ok(()) };
    if scene.body.scalp.is_some() {
        notes.push("body.scalp is for styles: strands of a file stay where they grow".to_owned());
    }
    place_groom(groom, placings.groom, scene, scene.groom.rotation, scene.groom.translation);
    if let Some(mesh) = mesh.as_ref().filter(|_| loading.is_foreign) {
        notes.extend(join::of_file(scene, scene.groom.file.as_deref(), foreign::fit(groom, mesh)));
    }
    let apart = mesh.as_ref().filter(|_| placings.is_away).map(|mesh| guess::apart(groom, mesh));
    let near = || "the roots do not lie on the skin".to_owned();
    let placing = &placings.groom;
    let refusal = |apart: Option<String>| doubts::refusal_away(scene, placing, &apart.unwrap_or_else(near));
    if let Some(problem) = apart.and_then(refusal) {
        return Err(refused(scene, problem));
    }
    notes.extend(join::mended(scene, scene.groom.file.as_deref(), groom));
    let further = std::mem::take(&mut loading.further_grooms);
    let place = |groom: &mut Groom, placing, turn, by| place_groom(groom, placing, scene, turn, by);
    notes.extend(join::add_grooms(scene, groom, further, placings.groom, mesh.as_ref(), place)?);
    notes.extend(far_note(groom, scene, mesh.is_some()));
    Ok(())
}

/// Describes hair that lies too far from the origin of its files for steps in single precision, with the settings that
/// bring it near.
fn far_note(groom: &Groom, scene: &Scene, has_body: bool) -> Option<String> {
    let middle = center(groom.bounds());
    if middle.abs().max_element() < FAR {
        return None;
    }
    let set = |key: &str, translation: Vec3| {
        let [x, y, z] = (translation - middle.round()).to_array();
        format!("--set {key}.translation=[{x},{y},{z}]")
    };
    let body = if has_body { format!(" {}", set("body", scene.body.translation)) } else { String::new() };
    Some(format!(
        "the hair lies {:.0} m from the origin of its files, too far for steps in single precision: `{}{body}` brings it near",
        middle.length(),
        set("groom", scene.groom.translation),
    ))
}

/// Places strands: scaled and turned as guessed, then turned (degrees) and moved \[m\] as the scene says.
fn place_groom(groom: &mut Groom, placing: Placing, scene: &Scene, turn: Vec3, translation: Vec3) {
    if !scene.groom.own_look {
        groom.colors = None;
    }
    let has_widths = scene.groom.own_look && Attribute::Widths.is_in(groom);
    groom.transform(placing.scale, placing.turn, Vec3::ZERO);
    groom.transform(1.0, math::pitch_yaw_roll(turn), translation);
    // The width of a hair is in metres already.
    if !has_widths {
        groom.widths = Widths::Constant(HAIR_WIDTH);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hair_far_from_the_origin_is_told_with_the_settings_that_bring_it_near() {
        let at = |x: f32| {
            let mut groom = Groom::empty(8e-5);
            groom.push([Vec3::new(x, 1.5, -0.2), Vec3::new(x, 1.25, -0.2)]);
            groom
        };
        let mut scene = Scene::default();
        assert_eq!(far_note(&at(200.0), &scene, true), None);
        let keys = "--set groom.translation=[-5000,-1,0] --set body.translation=[-5000,-1,0]";
        let note = far_note(&at(5000.0), &scene, true).unwrap();
        assert!(note.contains("5000 m") && note.contains(keys), "{note}");
        scene.groom.translation.x = 10.0;
        let note = far_note(&at(5000.0), &scene, false).unwrap();
        assert!(note.contains("groom.translation=[-4990,") && !note.contains("body."), "{note}");
    }
}
