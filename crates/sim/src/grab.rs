//! Hair in a hand: one point of every held strand follows the hand.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use crate::Model;

/// Point index of a strand that is not held.
pub(crate) const NO_POINT: u32 = u32::MAX;

/// Rounds that bring a hand between two rooted points into the reach of both.
const CLAMPS: usize = 8;

/// A hand and the strands in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grab {
    /// Position of the hand \[m\], world space.
    pub hand: Vec3,
    /// Grips, shape `[block]`; empty without a held strand.
    pub grips: Vec<Grip>,
}

/// The points of a block of strands that are held.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip {
    /// The point of each strand, or [`NO_POINT`].
    pub points: [u32; LANES],
    /// From the hand to the point \[m\], world space.
    pub offsets: Vec3Lanes,
}

/// A held point and its goal \[m\], world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pinned {
    pub lane: usize,
    pub point: usize,
    pub goal: Vec3,
}

impl Grip {
    const NOTHING: Self = Self {
        points: [NO_POINT; LANES],
        offsets: Vec3Lanes { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] },
    };

    pub fn count(&self) -> usize {
        self.points.iter().filter(|point| **point != NO_POINT).count()
    }
}

/// Distance \[m\] of the origin from a segment.
fn to_segment(start: Vec3, end: Vec3) -> f32 {
    let across = end - start;
    let share = (-start.dot(across) / across.length_squared().max(1e-30)).clamp(0.0, 1.0);
    (start + across * share).length()
}

impl Grab {
    /// Holds every strand within `radius` \[m\] of the hand, by the nearer free end of its nearest segment.
    pub fn new(model: &Model, positions: &[Vec3Lanes], hand: Vec3, radius: f32) -> Self {
        let points = model.points_per_strand;
        let grips: Vec<Grip> = positions
            .par_chunks(points)
            .enumerate()
            .with_min_len(64)
            .map(|(block, positions)| {
                let mut grip = Grip::NOTHING;
                let live = model.live_lanes(block);
                for lane in 0..live {
                    let free = |point: &usize| model.inverse_mass[block * points + point].0[lane] > 0.0;
                    let offset = |point: usize| positions[point].get(lane) - hand;
                    let segments = (1..points).filter(|end| free(end) || free(&(end - 1)));
                    let nearest = segments.map(|end| (to_segment(offset(end - 1), offset(end)), end));
                    let nearest = nearest.min_by(|a, b| a.0.total_cmp(&b.0));
                    if let Some((_, end)) = nearest.filter(|(distance, _)| *distance <= radius) {
                        let ends = [end - 1, end].into_iter().filter(free);
                        let nearer =
                            |a: &usize, b: &usize| offset(*a).length().total_cmp(&offset(*b).length());
                        let Some(point) = ends.min_by(nearer) else { continue };
                        grip.points[lane] = point as u32;
                        grip.offsets.set(lane, offset(point));
                    }
                }
                grip
            })
            .collect();
        let holds = grips.iter().any(|grip| grip.count() > 0);
        Self { hand, grips: if holds { grips } else { Vec::new() } }
    }

    /// Strands in the hand.
    pub fn count(&self) -> usize {
        self.grips.iter().map(Grip::count).sum()
    }

    /// Goals of the held points of a block of strands with points at `positions` \[m\]. A hand does not stretch a strand:
    /// a goal is no farther from the rooted points on either side than the segments, of `lengths` \[m\], reach.
    pub fn pinned(
        &self,
        block: usize,
        positions: &[Vec3Lanes],
        lengths: &[Lanes],
        inverse_mass: &[Lanes],
    ) -> impl Iterator<Item = Pinned> {
        let grip = self.grips.get(block).copied().unwrap_or(Grip::NOTHING);
        let lanes = (0..LANES).filter(move |lane| grip.points[*lane] != NO_POINT);
        lanes.map(move |lane| {
            let point = grip.points[lane] as usize;
            let rooted = |at: &usize| inverse_mass[*at].0[lane] == 0.0;
            let reach = |from: usize, to: usize| (from..to).map(|at| lengths[at].0[lane]).sum::<f32>();
            let before = (0..point).rev().find(rooted).map(|root| (root, reach(root, point)));
            let behind = (point + 1..positions.len()).find(rooted).map(|root| (root, reach(point, root)));
            let mut goal = self.hand + grip.offsets.get(lane);
            for _ in 0..if behind.is_some() { CLAMPS } else { 1 } {
                for (root, reach) in behind.into_iter().chain(before) {
                    let root = positions[root].get(lane);
                    goal = root + (goal - root).clamp_length_max(reach);
                }
            }
            Pinned { lane, point, goal }
        })
    }
}
