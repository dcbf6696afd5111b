//! The strands of a scene: from a file, or grown; those that are simulated, and those that are bound to them.

use std::path::Path;

use glam::Vec3;
use strandline_base::math;

use crate::{
    Error, Scene,
    body::{Carrier, Collider, Pose, Shape, Solids},
    groom::{
        Groom, Guides, Outside, Widths,
        format::{self, Cleaning, HAIR_WIDTH, LoadOptions, Part, Scale, Up},
    },
};

use super::placing::Placing;

/// Depth \[m\] up to which no note is made: less than the error of a sampled body.
const WORTH_A_NOTE: f32 = 1e-4;
/// Strands of a file above which some stand for all, when nothing else is said, and how many then do.
const MANY: usize = 3000;
const GUIDES: usize = 2000;

/// The strands of a scene's file, in its units and axes.
pub(super) fn load(scene: &Scene, notes: &mut Vec<String>) -> Result<Option<Groom>, Error> {
    let Some(file) = &scene.groom.file else { return Ok(None) };
    read(scene, file, scene.groom.per_strand, notes).map(Some)
}

/// The strands of a file, in its units and axes.
pub(super) fn read(
    scene: &Scene,
    file: &Path,
    per_strand: Option<u32>,
    notes: &mut Vec<String>,
) -> Result<Groom, Error> {
    let options = LoadOptions {
        strict: false,
        scale: Scale::Factor(1.0),
        up: Up::Y,
        per_strand,
        cleaning: Cleaning::Strays,
    };
    let loaded = format::load(&scene.path(file), &options)?;
    notes.extend(loaded.report.problems.iter().map(|problem| format!("{}: {problem}", file.display())));
    Ok(loaded.groom)
}

/// Places strands and mends what no hair has, with notes: scaled and turned as guessed, then turned (degrees) and moved \[m\] as a scene says.
pub(super) fn place(
    groom: &mut Groom,
    placing: Placing,
    scene: &Scene,
    turn: Vec3,
    translation: Vec3,
) -> Vec<String> {
    if !scene.groom.own_look {
        groom.colors = None;
    }
    let has_widths = scene.groom.own_look && Part::Widths.is_in(groom);
    groom.transform(placing.scale, placing.turn, Vec3::ZERO);
    groom.transform(1.0, math::pitch_yaw_roll(turn), translation);
    // The width of a hair is in metres already.
    if !has_widths {
        groom.widths = Widths::Constant(HAIR_WIDTH);
    }
    groom.mend()
}

/// A grown style: its guides, or as many strands as are bound to guides among them.
pub(super) fn grown(scene: &Scene) -> Result<Groom, Error> {
    let mut style = scene.style.clone();
    style.strand_count = style.strand_count.max(scene.groom.bound as usize);
    Ok(style.grow()?)
}

/// The strands that are simulated, by their indices in rising order; all when none are bound.
pub(super) fn guides(scene: &Scene, groom: &Groom, notes: &mut Vec<String>) -> Option<Vec<usize>> {
    let count = groom.strand_count();
    let marked = groom.marked_guides();
    let every = scene.groom.guide_every as usize;
    let (guides, how) = match scene.groom.guides {
        Some(wanted) => (groom.representatives(wanted as usize), "chosen"),
        None if every > 1 => ((0..count).step_by(every).collect(), "every n-th"),
        None if scene.groom.file.is_none() => (groom.representatives(scene.style.strand_count), "chosen"),
        None if !marked.is_empty() => (marked, "marked in the file"),
        None if count > MANY => (groom.representatives(GUIDES), "chosen"),
        None => return None,
    };
    if guides.len() >= count || guides.is_empty() {
        return None;
    }
    let bound = count - guides.len();
    notes.push(format!("{} strands are simulated ({how}), {bound} are bound to them", guides.len()));
    Some(guides)
}

/// Puts what rests inside the solids that the head carries onto their surface; a note when there was such.
pub(super) fn move_outside(
    guides: &mut Guides,
    colliders: &[Collider],
    clearance: impl Fn(&Shape) -> f32,
) -> Option<String> {
    let on_head = colliders.iter().filter(|solid| solid.carrier == Carrier::Head);
    let solids = Solids::new(on_head.map(|solid| (solid.clone(), clearance(&solid.shape))));
    let at_rest = solids.placed(Pose::IDENTITY);
    let found = guides.move_outside(|point| at_rest.at(point));
    let Outside { point_count, strand_count, depth, depth_left } = found;
    let mut note = format!(
        "{point_count} points of {strand_count} strands rested inside solids, by up to {:.2} mm: moved to the \
         surface, lengths kept",
        1e3 * depth
    );
    if depth_left > 1e-4 {
        note +=
            &format!("; up to {:.2} mm of that is left where segments do not reach out", 1e3 * depth_left);
    }
    (depth > WORTH_A_NOTE).then_some(note)
}
