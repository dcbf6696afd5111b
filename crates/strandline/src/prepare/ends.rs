//! Strands that are stored from tip to root: found by the end that lies on the skin, and turned.

use glam::Vec3;
use strandline_base::math;

use super::{
    guess::{self, Strands},
    join,
    loading::Loading,
    placing::{Placing, Placings, diagonal},
    sample::NEAR,
    shown::Body,
};
use crate::{
    Scene,
    body::NearestSurface,
    groom::{
        Groom,
        format::{RootEnd, from_tip_note},
    },
};

/// Strands that tell whether some are turned.
const LOOKED_AT: usize = 2000;
/// Distance from the skin, over the size of the body, of an end that lies on it; over the median of all nearer ends.
const ON_SKIN: f32 = 0.004;
const OF_MEDIAN: f32 = 2.0;
/// Distance of the other end over that of an end on the skin.
const OFF_SKIN: f32 = 3.0;
/// Distance of first points from the skin, over the size of the body, that needs no other look.
const SURELY: f32 = 0.01;
/// Share of strands with an end on the skin in a groom that belongs to a body.
const ROOTED: f32 = 0.8;
/// Distance of a new root from the other roots over that of the old one, where the new one alone lies on the skin, and
/// where both do.
const GATHERED: f32 = 0.8;
const AMONG: f32 = 0.25;
/// Confidence in hair of another head over that in the same hair turned with which it is stored from tip to root.
const LIKELIER: f32 = 2.0;
/// Least share of strands that surely are turned where some are: roots of a few may float.
const SURE: f32 = 0.003;
/// Share of strands that show their ends with which the others are like them.
const NEARLY_ALL: f32 = 0.9;

/// Turns strands of the scene's grooms that are stored from tip to root, where the scene leaves their ends open.
pub(super) fn turn(loading: &mut Loading) {
    if loading.scene.groom.root_end != RootEnd::Auto || loading.groom.is_none() {
        return;
    }
    loading.look_at_body();
    let Loading { sources, scene, groom, further_grooms, mesh, shown, notes, .. } = loading;
    let body = mesh.as_ref().zip(shown.as_ref()).map(|(mesh, shown)| Body { mesh, shown });
    let surface = body.map(|body| NearestSurface::new(body.mesh));
    let mut scene = scene.clone();
    let parts = scene.groom.parts.clone();
    let further = further_grooms.iter_mut().zip(parts.iter().map(Some));
    for (groom, part) in groom.iter_mut().map(|groom| (groom, None)).chain(further) {
        if let Some(part) = part {
            (scene.groom.scale, scene.groom.up) = (part.scale, part.up);
            (scene.groom.rotation, scene.groom.translation) = (part.rotation, part.translation);
            scene.groom.file = Some(part.file.clone());
        }
        let is_defined = sources.defines_groom(&scene);
        let turned = match body.zip(surface.as_ref()) {
            Some((body, surface)) => on_skin(&scene, groom, is_defined, body, surface),
            None => groom.from_tip(),
        };
        let Some(turned) = turned else { continue };
        groom.turn_strands(&turned);
        let note = from_tip_note(&turned);
        let note = format!("{note}: turned; `groom.root_end = \"first\"` leaves them as they are");
        notes.extend(join::of_file(&scene, scene.groom.file.as_deref(), [note]));
    }
}

/// Strands whose last point lies on the skin and whose first does not; shape `[strand]`. `None` where there are none, or
/// the groom does not belong to the body.
fn on_skin(
    scene: &Scene,
    groom: &Groom,
    is_defined: bool,
    body: Body,
    surface: &NearestSurface,
) -> Option<Vec<bool>> {
    let every = groom.strand_count().div_ceil(LOOKED_AT).max(1);
    let few: Vec<usize> = (0..groom.strand_count()).step_by(every).collect();
    let few = groom.select(&few);
    let stored = guess::placings(scene, Strands { grooms: &[&few], is_defined }, Some(body));
    let size = body.mesh.bounds().map_or(1.0, diagonal).max(f32::MIN_POSITIVE);
    let mut skin = Skin { scene, surface, size, placings: stored };
    let mut apart = skin.apart(&few);
    let first = median(apart.iter().map(|apart| apart[0]));
    if first > SURELY {
        // Tips that were taken for roots may have misled the placement.
        let mut turned = few.clone();
        turned.turn_strands(&vec![true; few.strand_count()]);
        let of_turned = guess::placings(scene, Strands { grooms: &[&turned], is_defined }, Some(body));
        if of_turned.is_foreign && of_turned.confidence > LIKELIER * skin.placings.confidence {
            return Some(vec![true; groom.strand_count()]);
        }
        let body = skin.placings.body;
        for placings in [of_turned, Placings { groom: body, body, ..Placings::new(1.0) }] {
            let other = Skin { placings, ..skin };
            let found = other.apart(&few);
            if nearer(&found) < nearer(&apart) {
                (skin, apart) = (other, found);
            }
        }
    }
    let roots = Roots::new(&few, &apart)?;
    let surely = |strand: usize| roots.shows(few.strand(strand), apart[strand]) == Some(Evidence::Sure);
    let sure = (0..few.strand_count()).filter(|strand| surely(*strand)).count();
    if sure == 0 || (sure as f32) < SURE * few.strand_count() as f32 {
        return None;
    }
    let apart = if every == 1 { apart } else { skin.apart(groom) };
    let is_turned = |strand: usize| roots.shows(groom.strand(strand), apart[strand]).is_some();
    let mut turned: Vec<bool> = (0..groom.strand_count()).map(is_turned).collect();
    // Strands that show no end are as nearly all others are.
    let kept = apart.iter().filter(|apart| roots.is_kept(**apart)).count();
    let found = turned.iter().filter(|turned| **turned).count();
    if found as f32 >= NEARLY_ALL * (found + kept) as f32 {
        turned.iter_mut().zip(&apart).for_each(|(turned, apart)| *turned |= !roots.is_kept(*apart));
    }
    Some(turned)
}

fn median(values: impl Iterator<Item = f32>) -> f32 {
    let mut values: Vec<f32> = values.collect();
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f32::INFINITY)
}

/// Median distance of the nearer end of all strands.
fn nearer(apart: &[[f32; 2]]) -> f32 {
    median(apart.iter().map(|[first, last]| first.min(*last)))
}

/// A body and the placement of a groom by it.
struct Skin<'a> {
    scene: &'a Scene,
    surface: &'a NearestSurface,
    /// Length of the diagonal of the box around it.
    size: f32,
    placings: Placings,
}

impl Skin<'_> {
    /// Distances of both ends of all strands from the skin, over the size of the body.
    fn apart(&self, groom: &Groom) -> Vec<[f32; 2]> {
        let (of_groom, of_body) = (&self.scene.groom, &self.scene.body);
        let Placings { groom: own, body, .. } = self.placings;
        let [turn, body_turn] = [of_groom.rotation, of_body.rotation].map(math::pitch_yaw_roll);
        let body_turn = body_turn * body.turn;
        let to_body = |place: &Vec3| {
            let Placing { scale, turn: own } = own;
            let head = turn * (own * (scale * *place)) + of_groom.translation;
            (body_turn.inverse() * (head - of_body.translation)) / body.scale
        };
        let strands = (0..groom.strand_count()).map(|strand| groom.strand(strand));
        let ends: Vec<Vec3> =
            strands.flat_map(|strand| [&strand[0], &strand[strand.len() - 1]]).map(to_body).collect();
        let places = self.surface.nearest_places(&ends);
        let apart: Vec<f32> =
            ends.iter().zip(places).map(|(end, place)| end.distance(place) / self.size).collect();
        apart.as_chunks().0.to_vec()
    }
}

/// The roots of strands that have an end on the skin.
struct Roots {
    places: Vec<Vec3>,
    /// Distance of an end on the skin over the size of the body.
    on_skin: f32,
}

impl Roots {
    /// `None` where the ends of strands do not lie on the body.
    fn new(groom: &Groom, apart: &[[f32; 2]]) -> Option<Self> {
        let median = nearer(apart);
        let on_skin = (OF_MEDIAN * median).clamp(ON_SKIN, NEAR);
        let strands = 0..groom.strand_count();
        let rooted = strands.clone().filter(|strand| apart[*strand][0].min(apart[*strand][1]) <= on_skin);
        let first: Vec<usize> = strands.filter(|strand| apart[*strand][0] <= on_skin).collect();
        let is_own = median <= NEAR && rooted.clone().count() as f32 >= ROOTED * groom.strand_count() as f32;
        // First points are roots where most lie on the skin; else the nearer ends are.
        let places = if 2 * first.len() >= groom.strand_count() {
            first.into_iter().map(|strand| groom.strand(strand)[0]).collect()
        } else {
            let nearer = |strand: usize| {
                let (points, [first, last]) = (groom.strand(strand), apart[strand]);
                points[if first <= last { 0 } else { points.len() - 1 }]
            };
            rooted.map(nearer).collect()
        };
        is_own.then_some(Self { places, on_skin })
    }

    /// True for a strand with its first point alone on the skin.
    fn is_kept(&self, [first, last]: [f32; 2]) -> bool {
        first <= self.on_skin && last > OFF_SKIN * self.on_skin
    }

    /// Evidence for a strand to be stored from tip to root: its last point is nearer to the other roots than its first,
    /// and lies on the skin.
    fn shows(&self, strand: &[Vec3], [first, last]: [f32; 2]) -> Option<Evidence> {
        if last > self.on_skin {
            return None;
        }
        let is_alone = first > OFF_SKIN * self.on_skin;
        let ends = [strand[0], strand[strand.len() - 1]];
        let nearest = |end: Vec3| {
            let others = self.places.iter().filter(|root| !ends.contains(root));
            others.map(|root| root.distance(end)).fold(f32::INFINITY, f32::min)
        };
        let [old, new] = ends.map(nearest);
        match is_alone {
            true => (new.is_infinite() || new < GATHERED * old).then_some(Evidence::Sure),
            false => (new < AMONG * old).then_some(Evidence::Likely),
        }
    }
}

/// Evidence for a strand to be stored from tip to root.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Evidence {
    /// The last point alone lies on the skin.
    Sure,
    /// Both lie there: it counts in a groom where others are sure.
    Likely,
}

#[cfg(test)]
#[path = "ends_tests.rs"]
mod tests;
