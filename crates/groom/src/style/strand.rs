//! Strands while they are shaped, and where they may be.

use glam::Vec3;
use strandline_body::{Mannequin, Root, SignedDistance};

use super::StyleSettings;

/// Distance \[m\] from the skin that all hair keeps once it has left the root.
pub const CLEARANCE: f32 = 0.0015;

/// Diameter of a hair \[m\].
pub const WIDTH: f32 = 8e-5;
/// Distance \[m\] from the parting within which roots are drawn toward it.
const PARTING_REACH: f32 = 0.014;

/// A strand with the inputs of its shaping.
pub struct Strand {
    /// Its root.
    pub root: Root,
    /// The side of the parting that it falls to, -1 or 1.
    pub side: f32,
    /// Its points \[m\], evenly spaced.
    pub points: Vec<Vec3>,
}

/// Moves a point out of the body until it is `clearance` \[m\] from the skin.
pub fn outside(mannequin: &Mannequin, mut point: Vec3, clearance: f32) -> Vec3 {
    for _ in 0..8 {
        let (distance, out) = mannequin.distance_and_gradient(point);
        if distance >= clearance {
            break;
        }
        point += out * (clearance - distance);
    }
    point
}

/// Draws roots near the parting toward it, so that it is a line and not a lane.
pub fn beside_parting(settings: &StyleSettings, mannequin: &Mannequin, root: Root) -> Root {
    let across = root.position.x - settings.parting;
    let share = across.abs() / PARTING_REACH;
    if !settings.style.is_parted() || share >= 1.0 || root.position.y < 0.0 {
        return root;
    }
    let mut drawn = root.position;
    drawn.x = settings.parting + across * share.sqrt();
    let (position, normal) = mannequin.nearest_skin(drawn);
    Root { position, normal, ..root }
}
