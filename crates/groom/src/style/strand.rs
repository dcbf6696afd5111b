//! Strands while they are shaped, and where they may be.

use glam::Vec3;
use strandline_body::{Mannequin, Root, SignedDistance};

/// Distance \[m\] from the skin that all hair keeps once it has left the root.
pub const CLEARANCE: f32 = 0.0015;

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
