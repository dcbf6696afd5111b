//! A groom that was made for another head: its scalp is fitted to the head of the body.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::evidence::Hair;
use super::head::{UPS, turns, turns_of};
use super::placing::{Placing, upright};
use super::relation::{FoundPlacing, MOST, PIECE, Search, fits};
use super::sample::HEIGHTS;
use super::skull::Skull;
use super::units::unit_of_width;
use crate::{
    body::Mesh,
    groom::{
        Groom,
        format::{Scale, Up},
    },
};

/// Depth over the width of what may be a scalp.
const DEPTHS: std::ops::RangeInclusive<f32> = 0.7..=1.8;
/// Width, height and depth of the roots on a head over those of its skull.
const OF_SKULL: Vec3 = Vec3::new(1.0, 0.97, 0.94);
/// Evidence against axes that no standard has, and against -z up and hair that looks another way than its standard says.
const STRANGE: f32 = 1.5;
const ROUND: f32 = 0.7;
/// Difference of a scale from 1 that is none.
const SAME_SIZE: f32 = 0.03;

/// The place of hair of another head, before it is fitted, given the unit of its file where its width shows none: the axes with which it lies most
/// like hair once it is fitted. None where a scene places the groom, or it is not the hair of a head.
pub(super) fn found(search: &Search, unit: f32) -> Option<FoundPlacing> {
    let (given, skull) = (&search.scene.groom, search.head.skull.as_ref()?);
    let is_open = given.scale == Scale::Auto && given.translation == Vec3::ZERO;
    if !is_open || !search.hair.is_surely_full() {
        return None;
    }
    let tried: Vec<Quat> = match given.up {
        Up::Auto if given.rotation == Vec3::ZERO => turns().collect(),
        Up::Auto => [Up::Y, Up::Z, Up::MinusY].map(upright).to_vec(),
        up => vec![upright(up)],
    };
    let fitted = |turn: &Quat| {
        let (hair, ratio) = fitted(search, &Placing { scale: unit, turn: *turn })?;
        let usual = unit_of_width(skull.size.x / ratio / unit);
        let placing = Placing { scale: if usual.1.is_none() { usual.0 } else { unit }, turn: *turn };
        Some((placing, hair))
    };
    let (places, hair): (Vec<Placing>, Vec<Hair>) = tried.iter().filter_map(fitted).unzip();
    let fits = fits(&search.head.surface, &hair);
    let mut found: Vec<(f32, Placing, f32)> = (0..places.len())
        .map(|index| {
            let lies = hair[index].on(skull, search.head.pose.shows_front);
            let evidence = lies - (fits[index] / PIECE).min(MOST) - against(places[index].turn);
            (evidence, places[index], fits[index])
        })
        .collect();
    found.sort_by(|one, two| two.0.total_cmp(&one.0));
    let (evidence, placing, fit) = *found.first()?;
    let margin = found.get(1).map_or(MOST, |other| evidence - other.0);
    Some(FoundPlacing { placing, fit, margin, next: found.get(1).map(|other| other.1), is_foreign: true })
}

/// Strands of another head fitted to that of the body, from a place in the axes and the unit of their file, and the size
/// that they are then given: the width of the skull over that of their own.
pub(super) fn fitted(search: &Search, from: &Placing) -> Option<(Hair, f32)> {
    let own = math::pitch_yaw_roll(search.scene.groom.rotation);
    let hair = search.hair.placed(|point| own * from.turn * (from.scale * point));
    let fitting = Fitting::new(hair.many_roots(), search.head.skull.as_ref()?)?;
    Some((hair.placed(|point| fitting.place(point)), fitting.scale.x / OF_SKULL.x))
}

/// Evidence against axes of a groom of another head.
fn against(turn: Quat) -> f32 {
    let place = UPS.iter().flat_map(|up| turns_of(*up)).position(|one| one.angle_between(turn) < 0.01);
    match place.map(|place| (place / 4, place % 4)) {
        Some((0..3, 0)) => 0.0,
        Some((0..3, 1) | (3, 0)) => ROUND,
        _ => STRANGE,
    }
}

/// A map of the scalp of one head to another: crown on crown and back on back.
struct Fitting {
    from: Vec3,
    to: Vec3,
    scale: Vec3,
}

impl Fitting {
    /// Brings roots to a skull; none where they do not lie as those of a head of hair.
    fn new(roots: &[Vec3], to: &Skull) -> Option<Self> {
        let from = Skull::of(roots)?;
        let lowest = roots.iter().map(|root| root.y).fold(f32::INFINITY, f32::min);
        let width = from.size.min_element();
        let deep = from.size.max_element() / width;
        if !(DEPTHS.contains(&deep) && HEIGHTS.contains(&((from.top - lowest) / width))) {
            return None;
        }
        // Roots lie around as much of a skull on all heads that were looked at: all of its width, and 0.93 to 0.97 of its
        // depth.
        let ratio = to.size / from.size;
        let scale = Vec3::new(ratio.x, 0.5 * (ratio.x + ratio.y), ratio.y) * OF_SKULL;
        let anchor =
            |skull: &Skull| Vec3::new(skull.middle.x, skull.top, skull.middle.y - 0.5 * skull.size.y);
        Some(Self { from: anchor(&from), to: anchor(to), scale })
    }

    fn place(&self, point: Vec3) -> Vec3 {
        self.to + self.scale * (point - self.from)
    }
}

/// Fits hair that is placed as [`found`] to the head of a mesh, head space. Returns a note.
pub(super) fn fit(groom: &mut Groom, mesh: &Mesh) -> Option<String> {
    let fitting = Fitting::new(&groom.roots().collect::<Vec<_>>(), &Skull::of_body(mesh)?)?;
    groom.points.iter_mut().for_each(|point| *point = fitting.place(*point));
    let scale = fitting.scale / OF_SKULL;
    let is_same = (scale - Vec3::ONE).abs().max_element() < SAME_SIZE;
    let kind = if is_same { "lies elsewhere" } else { "was made for another head" };
    Some(format!(
        "the groom {kind}: it is fitted to the highest part of this body, {:.0} % as wide and \
         {:.0} % as deep; `scale`, `up`, `rotation` and `translation` of [groom] and [body] place both otherwise",
        100.0 * fitting.scale.x,
        100.0 * fitting.scale.z
    ))
}

#[cfg(test)]
#[path = "foreign_tests.rs"]
mod tests;
