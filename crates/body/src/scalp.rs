use glam::{Vec2, Vec3};

use crate::Mannequin;

/// Where a strand leaves the skin, in head space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Position on the skin \[m\].
    pub position: Vec3,
    /// Unit normal of the skin, pointing out.
    pub normal: Vec3,
    /// Position on the scalp, 0..1 in both.
    pub uv: Vec2,
}

/// The part of the skin on which hair grows.
#[derive(Clone, Debug)]
pub struct Scalp {
    mannequin: Mannequin,
}

impl Scalp {
    pub(crate) fn new(mannequin: Mannequin) -> Self {
        Self { mannequin }
    }
    /// `count` roots spread evenly (blue noise) over the scalp; the same seed gives the same roots.
    pub fn roots(&self, _count: usize, _seed: u64) -> Vec<Root> {
        unimplemented!("mannequin")
    }
}
