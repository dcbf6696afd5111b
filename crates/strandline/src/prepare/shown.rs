//! The pose that a body shows by itself, found once for all grooms that are placed on it.

use glam::Vec3;

use super::{
    head::{self, Pose},
    placing::{Defined, Placing, diagonal, place_mesh, upright},
    relation::Head,
    skull::Skull,
    units::{SCALPS, first_of, given_unit, unit_of_width},
};
use crate::{
    Scene,
    body::Mesh,
    groom::format::{Scale, Up},
};

/// Diagonal of the box around a body \[m\]: a doll to a bear.
const BODIES: std::ops::RangeInclusive<f32> = 0.15..=4.0;
/// Width of a head \[m\] that a format which defines metres is believed: a figurine's to a giant's.
const HEADS: std::ops::Range<f32> = 0.02..2.0;
/// Confidence in a body that shows neither face nor feet, and in a person whose face does not show.
pub(super) const SHAPELESS: f32 = 0.75;
const FACELESS: f32 = 0.9;

/// A body in units and axes of its file, and the pose that it shows.
#[derive(Clone, Copy)]
pub(super) struct Body<'a> {
    pub mesh: &'a Mesh,
    pub shown: &'a Shown,
}

/// The pose that a body shows.
pub(super) struct Shown {
    /// Definitions that the format of its file makes.
    pub defined: Defined,
    pub pose: Pose,
    pub placing: Placing,
    /// Width \[units\] of a head that no usual unit makes that of a person.
    pub strange: Option<f32>,
    /// Width of a person's head that is none in metres, in units of a file whose scale a scene leaves out.
    pub odd_width: Option<f32>,
    /// Confidence in the placement, 0 to 1.
    pub confidence: f32,
    /// The body at its place.
    pub head: Head,
}

impl Shown {
    /// The pose of a scene's body.
    pub fn new(scene: &Scene, mesh: &Mesh, defined: Defined) -> Self {
        let (placing, pose, strange) = of_body(scene, mesh, defined);
        let confidence = confidence_of(scene, defined, &pose);
        let head = Head::new(scene, mesh, placing, pose);
        let is_open = scene.body.scale == Scale::Auto && pose.is_person;
        let width = head.skull.as_ref().filter(|_| is_open).map(|skull| skull.size.x / placing.scale);
        let odd_width = width.filter(|width| !HEADS.contains(width));
        Self { defined, pose, placing, strange, odd_width, confidence, head }
    }
}

/// The place of a body, the pose that it shows, and the width \[m\] of a head that no usual unit makes that of a person.
fn of_body(scene: &Scene, mesh: &Mesh, defined: Defined) -> (Placing, Pose, Option<f32>) {
    let given = &scene.body;
    let ups = match (given.up, defined) {
        (Up::Auto, Defined::Nothing) => head::UPS.to_vec(),
        (Up::Auto, Defined::Up | Defined::All) => vec![Up::Y],
        (up, _) => vec![up],
    };
    let mut pose = head::pose(mesh, &ups);
    // An axis that is given names the front too, and a turn that is given is that of the file's own axes.
    if given.up != Up::Auto || defined == Defined::All {
        (pose.turn, pose.shows_front) = (upright(ups[0]), true);
        (pose.is_sure, pose.has_base) = (true, false);
    } else if given.rotation != Vec3::ZERO {
        (pose.turn, pose.shows_front) = (pose.up.rotation(), true);
    }
    let (turn, diagonal) = (pose.turn, mesh.bounds().map_or(0.0, diagonal));
    let given = given_unit(given.scale).or((defined != Defined::Nothing).then_some(1.0));
    let scale = given.unwrap_or_else(|| first_of(diagonal, &BODIES));
    let mut upright = mesh.clone();
    place_mesh(&mut upright, Placing { scale, turn }, Vec3::ZERO, Vec3::ZERO);
    let width = Skull::of_body(&upright).map(|skull| skull.size.x / scale);
    let width = width.filter(|width| given.is_none() && !SCALPS.contains(&(scale * width)));
    match width.filter(|_| pose.is_person) {
        Some(width) => {
            let (scale, strange) = unit_of_width(width);
            (Placing { scale, turn }, pose, strange)
        }
        None => (Placing { scale, turn }, pose, None),
    }
}

/// Confidence in the place of a body.
fn confidence_of(scene: &Scene, defined: Defined, pose: &Pose) -> f32 {
    match (scene.body.up, defined) {
        (Up::Auto, Defined::Nothing | Defined::Up) if !pose.is_sure => SHAPELESS,
        (Up::Auto, Defined::Nothing | Defined::Up) if !pose.shows_front => FACELESS,
        _ => 1.0,
    }
}
