//! Second stage of loading: strands and body in head space, several files as one groom and one mesh.

use glam::Vec3;
use strandline_base::math;

use super::{
    doubts, foreign,
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
    loading.notes.append(&mut loading.placings.notes);
    loading.placings.refusal.take().map_or(Ok(()), |problem| Err(refused(scene, problem)))
}

/// The error of a placement that is not sure.
fn refused(scene: &Scene, problem: String) -> Error {
    let files = [&scene.groom.file, &scene.body.file];
    let files = files.into_iter().flatten().map(|file| scene.path(file).display().to_string());
    Error::Placement { files: files.collect::<Vec<_>>().join(" on "), problem }
}

/// Brings the meshes into head space.
fn place_body(loading: &mut Loading) -> Result<(), Error> {
    let Some(mesh) = &mut loading.mesh else { return Ok(()) };
    let (scene, placing) = (&loading.scene, loading.placings.body);
    place_mesh(mesh, placing, scene.body.rotation, scene.body.translation);
    let further = std::mem::take(&mut loading.further_meshes);
    loading.skull = if further.is_empty() { None } else { Skull::of_body(mesh) };
    (loading.solid_mesh, loading.covers) = join::add_meshes(scene, mesh, further, placing)?;
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
        notes.extend(foreign::fit(groom, mesh));
    }
    let apart = mesh.as_ref().filter(|_| placings.is_away).map(|mesh| guess::apart(groom, mesh));
    let near = || "the roots do not lie on the skin".to_owned();
    let placing = &placings.groom;
    let refusal = |apart: Option<String>| doubts::refusal_away(scene, placing, &apart.unwrap_or_else(near));
    if let Some(problem) = apart.and_then(refusal) {
        return Err(refused(scene, problem));
    }
    let further = std::mem::take(&mut loading.further_grooms);
    let place = |groom: &mut Groom, placing, turn, by| place_groom(groom, placing, scene, turn, by);
    notes.extend(join::add_grooms(scene, groom, further, placings.groom, mesh.as_ref(), place)?);
    notes.extend(groom.mend());
    notes.extend(groom.unlike_beside());
    Ok(())
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
