//! Guides that a strand follows, and how much.

use crate::{LANES, block_count};

/// Guides that a strand is bound to at most.
pub const MOST_INFLUENCES: usize = 3;
/// A guide that a bound strand follows.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Influence {
    /// The guide, by its place among the guides.
    pub guide: u32,
    /// Weight of the guide; those of a strand sum to 1.
    pub weight: f32,
    /// Points of the guide that a point of the strand is along: the strand's length over the guide's.
    pub pace: f32,
}

/// A guide that each strand of a block follows: see [`Influence`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed {
    pub(super) guides: [u32; LANES],
    pub(super) weights: [f32; LANES],
    pub(super) paces: [f32; LANES],
}

impl Followed {
    /// Of the strands of a block, one of the influences of each.
    pub(super) fn of(influences: [Influence; LANES]) -> Self {
        Self {
            guides: influences.map(|one| one.guide),
            weights: influences.map(|one| one.weight),
            paces: influences.map(|one| one.pace),
        }
    }
}

/// Influences as lanes; lanes beyond the last strand repeat it.
pub(super) fn blocks(influences: &[[Influence; MOST_INFLUENCES]]) -> Vec<[Followed; MOST_INFLUENCES]> {
    let followed = |block: usize, slot: usize| {
        let of = |lane: usize| influences[(block * LANES + lane).min(influences.len() - 1)][slot];
        Followed::of(std::array::from_fn(of))
    };
    let blocks = 0..block_count(influences.len());
    blocks.map(|block| std::array::from_fn(|slot| followed(block, slot))).collect()
}
