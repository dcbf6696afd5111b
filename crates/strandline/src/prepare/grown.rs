//! Before `fit`: hair with its guides in a file, as a style grows it. Nothing is chosen that the file says.

use super::face::Face;
use super::fit::{DENSITY, is_open, mean_width, spacing};
use super::loading::Loading;
use crate::{
    Scene,
    groom::{Groom, Guides, format::Attribute},
    scene::{filling, segments_per_span},
};

/// Width of strands over that of hair as dense as on a head, or the inverse, below which they are as wide; brows, which
/// thin out, have 1.6.
const AS_WIDE: f32 = 1.8;

/// Takes settings that the scene leaves open from a groom as a style grows it.
pub(super) fn grown(loading: &mut Loading) {
    if let Loading { scene, groom: Some(groom), notes, .. } = loading
        && is_grown(scene, groom)
    {
        notes.extend(take(scene, groom));
        loading.is_grown = true;
    }
}

/// True for a groom in which some strands are marked as guides, and all have one number of points: as a style is written.
pub(super) fn has_form_of_style(groom: &Groom) -> bool {
    let (marked, count) = (groom.marked_guides().len(), groom.strand_count());
    marked > 0
        && marked < count
        && (1..count).all(|strand| groom.strand(strand).len() == groom.strand(0).len())
}

/// True for strands of that form, as wide and as dense as so many hairs on a head: those of a style.
fn is_grown(scene: &Scene, groom: &Groom) -> bool {
    let are_theirs = scene.groom.guides.is_none() && scene.groom.guide_every == 1;
    if !are_theirs || !has_form_of_style(groom) || !Attribute::Widths.is_in(groom) {
        return false;
    }
    // Strands of a lash are rooted within each other, which says nothing of its density.
    if Face::of(groom).is_some_and(|face| face.is_lashes()) {
        return true;
    }
    let hair_count = scene.look.hair_count.max(1) as f32;
    let of_hair = DENSITY * spacing(groom) * (groom.strand_count() as f32 / hair_count).sqrt();
    (of_hair / AS_WIDE..of_hair * AS_WIDE).contains(&mean_width(groom))
}

/// Takes settings that a scene leaves open from strands as a style grows them. Returns a note of what was taken.
fn take(scene: &mut Scene, groom: &Groom) -> Option<String> {
    let (given, default) = (scene.given, Scene::default());
    let mut taken = Vec::new();
    let count = groom.strand(0).len().clamp(Guides::MIN_POINTS, Guides::MAX_POINTS) as u32;
    if !given.points_per_strand && scene.groom.points_per_strand == default.groom.points_per_strand {
        scene.groom.points_per_strand = count;
        taken.push(format!("groom.points_per_strand = {count}"));
    }
    if !given.follow_strands && scene.look.follow_strands == default.look.follow_strands {
        scene.look.follow_strands = filling(groom.marked_guides().len(), Some(groom.strand_count() as u32));
        taken.push(format!("look.follow_strands = {}", scene.look.follow_strands));
    }
    let level = &mut scene.level_of_detail;
    if is_open(given.segments_per_span, level.segments_per_span, |level| level.segments_per_span) {
        level.segments_per_span = segments_per_span(scene.groom.points_per_strand);
        taken.push(format!("level_of_detail.segments_per_span = {}", level.segments_per_span));
    }
    (!taken.is_empty()).then(|| {
        format!("hair with its guides, as a style grows it, so taken from the file: {}", taken.join(", "))
    })
}
