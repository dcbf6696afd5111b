//! The box around hair and body, and the motion of the head in it.

use std::path::PathBuf;

use glam::Vec3;

use crate::{
    Error, HeadMotion, Scene,
    body::{Aabb, Mesh, RecordedMotion},
    groom::Guides,
    scene::{MotionName, TeleportSection, solid_motion::solid_motions},
};

/// Motion of the head: about the scene's pivot, the body's, or a low point in the box around hair and body; with notes.
pub fn head_motion(
    scene: &Scene,
    pivot: Option<Vec3>,
    bounds: Aabb,
) -> Result<(HeadMotion, Vec<String>), Error> {
    let pivot = scene.motion.pivot.or(pivot).unwrap_or_else(|| low_center(bounds));
    let section = &scene.motion;
    let mut notes = Vec::new();
    let load = |file: &PathBuf| {
        let (clip, scale) = (section.clip.as_deref(), f64::from(section.scale));
        let (motion, odd) = RecordedMotion::load_noted(&scene.path(file), &section.joint, clip, scale)?;
        notes.extend(odd);
        motion.with_teleports(&TeleportSection::times(&section.teleports))
    };
    let recorded = section.file.as_ref().map(load).transpose()?;
    let solids = solid_motions(&scene.colliders, section.interpolation)?;
    let head = HeadMotion::new(section, pivot)?.with_recorded(recorded).with_solids(solids);
    Ok((head, if section.name == MotionName::File { notes } else { Vec::new() }))
}

/// The box around strands and body \[m\].
pub fn bounds(guides: &Guides, mesh: Option<&Mesh>) -> Aabb {
    let (min, max) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let mut bounds = mesh.and_then(Mesh::bounds).unwrap_or(Aabb { min, max });
    for strand in 0..guides.strand_count() {
        for point in 0..guides.points_per_strand() {
            let point = guides.position(strand, point);
            bounds = Aabb { min: bounds.min.min(point), max: bounds.max.max(point) };
        }
    }
    bounds
}

/// The middle of a box \[m\].
pub fn center(bounds: Aabb) -> Vec3 {
    0.5 * (bounds.min + bounds.max)
}

/// Assumed neck of an unknown head: in the middle, a third of the way up.
fn low_center(bounds: Aabb) -> Vec3 {
    let mut center = center(bounds);
    center.y = bounds.min.y + (bounds.max.y - bounds.min.y) / 3.0;
    center
}
