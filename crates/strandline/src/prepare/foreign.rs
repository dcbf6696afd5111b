//! A groom that was made for another head: its scalp is fitted to the head of the body.

use glam::{Quat, Vec3};

use super::guess;
use super::head;
use super::placing::{Placing, Placings};
use super::sample::{self, HEIGHTS};
use super::skull::Skull;
use crate::{
    Scene,
    body::Mesh,
    groom::{
        Groom,
        format::{Scale, Up},
    },
};

/// Middle distance of roots from a body that is not theirs, as a share of the body's size.
const APART: f32 = 0.1;
/// Width of a scalp over that of the skull below or above which the two have other units.
const WIDTHS: std::ops::RangeInclusive<f32> = 0.1..=3.0;
/// Depth over the width of what may be a scalp.
const DEPTHS: std::ops::RangeInclusive<f32> = 0.7..=1.8;
/// Width, height and depth of the roots on a head over those of its skull.
const OF_SKULL: Vec3 = Vec3::new(1.0, 0.97, 0.94);

/// The places of a groom and a body that do not belong together, where a scene leaves both open; none where they do,
/// or the groom is not the hair of a head.
pub(super) fn placings(scene: &Scene, groom: &Groom, mesh: &Mesh, as_one: &Placings) -> Option<Placings> {
    if !is_open(scene) {
        return None;
    }
    let roots = placed(groom.roots(), &as_one.groom);
    let vertices = placed(mesh.positions.iter().copied(), &as_one.body);
    let (scalp, skull) = (Skull::of(&roots)?, Skull::of(&vertices)?);
    let apart = sample::roots_apart(groom, mesh, &as_one.groom, &as_one.body);
    if apart <= APART && WIDTHS.contains(&(scalp.size.x / skull.size.x)) {
        return None;
    }
    let alone = guess::placings(scene, &[groom], None).groom;
    let body = guess::placings(scene, &[], Some(mesh)).body;
    let (roots, vertices) = (placed(groom.roots(), &alone), placed(mesh.positions.iter().copied(), &body));
    let tips = (0..groom.strand_count()).map(|strand| groom.strand(strand)[groom.strand(strand).len() - 1]);
    let (turn_hair, turn_body) = (front_of_hair(&roots, &placed(tips, &alone))?, head::front(&vertices)?);
    let turned = |placing: Placing, turn: Quat| Placing { turn: turn * placing.turn, ..placing };
    let (groom, body) = (turned(alone, turn_hair), turned(body, turn_body));
    Some(Placings { groom, body, note: None })
}

/// True where a scene leaves the placement of groom and body open.
fn is_open(scene: &Scene) -> bool {
    let (groom, body) = (&scene.groom, &scene.body);
    let still = [groom.rotation, groom.translation, body.rotation, body.translation];
    groom.scale == Scale::Auto
        && body.scale == Scale::Auto
        && groom.up == Up::Auto
        && body.up == Up::Auto
        && still.iter().all(|part| *part == Vec3::ZERO)
}

fn placed(places: impl Iterator<Item = Vec3>, placing: &Placing) -> Vec<Vec3> {
    places.map(|place| placing.turn * (placing.scale * place)).collect()
}

/// Turns hair so that it is combed to the back, -z; none where roots do not lie as those on a head.
fn front_of_hair(roots: &[Vec3], tips: &[Vec3]) -> Option<Quat> {
    let scalp = Skull::of(roots)?;
    let lowest = roots.iter().map(|root| root.y).fold(f32::INFINITY, f32::min);
    let width = scalp.size.x.min(scalp.size.y);
    let deep = scalp.size.max_element() / width;
    if !(DEPTHS.contains(&deep) && HEIGHTS.contains(&((scalp.top - lowest) / width))) {
        return None;
    }
    let combed = tips.iter().zip(roots).map(|(tip, root)| *tip - *root).sum::<Vec3>();
    let combed = combed / (roots.len() as f32 * scalp.size.max_element());
    Some(head::turned_to_z(head::is_long(&scalp), -combed))
}

/// Fits hair that is placed by [`placings`] to the head of a mesh, head space: crown on crown and back on back.
/// Returns a note.
pub(super) fn fit(groom: &mut Groom, mesh: &Mesh) -> Option<String> {
    let roots: Vec<Vec3> = groom.roots().collect();
    let (from, to) = (Skull::of(&roots)?, Skull::of(&mesh.positions)?);
    // Roots lie around as much of a skull on all heads that were looked at: all of its width, and 0.93 to 0.97 of its
    // depth.
    let ratio = to.size / from.size;
    let scale = Vec3::new(ratio.x, 0.5 * (ratio.x + ratio.y), ratio.y) * OF_SKULL;
    let anchor = |skull: &Skull| Vec3::new(skull.middle.x, skull.top, skull.middle.y - 0.5 * skull.size.y);
    let (from, to) = (anchor(&from), anchor(&to));
    groom.points.iter_mut().for_each(|point| *point = to + scale * (*point - from));
    Some(format!(
        "the groom was made for another head: it is fitted to the highest part of this body, {:.0} % as wide and \
         {:.0} % as deep; `scale`, `up`, `rotation` and `translation` of [groom] and [body] place both otherwise",
        100.0 * scale.x,
        100.0 * scale.z
    ))
}

#[cfg(test)]
#[path = "foreign_tests.rs"]
mod tests;
