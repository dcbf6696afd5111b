//! Buffers of strands that push each other.

use strandline_gpu::{Buffer, Gpu, Scan, mirror};
use strandline_groom::LANES;

use super::records::{EXTRAS, SLOTS, STATES};
use crate::wisps::pair::Pair;
use crate::{Model, Settings, SimError};

/// Most pairs of a segment, of more the nearest: of few segments, and of so many that the pairs of more would not fit a buffer
/// of WebGPU's size.
const MOST_PAIRS: usize = 32;
const LEAST_PAIRS: usize = 16;
/// Vectors of a pair in a part of a step, of its forces, and in its memory.
pub(super) const PAIR_ROWS: usize = 3;
pub(super) const FORCE_ROWS: usize = 3;
pub(super) const KEPT_ROWS: usize = 2;
/// Edges of cells from which a part of a step chooses.
const EDGES: usize = 10;
/// Cells that a box takes on the mean at most.
const CELLS_OF_BOX: usize = 8;

mirror! {
    /// Measures of the contacts. Mirrors `ContactState` in meet_pairs.wesl.
    pub(super) struct ContactState {
        pub pairs: u32,
        pub crossed: u32,
        /// Bits of the largest depth \[m\].
        pub deepest: u32,
        pub unused: u32,
    }
}

/// Numbers of kernels in a step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Rounds {
    pub parts: u32,
    pub newton_steps: u32,
    /// After each Newton step.
    pub rounds: u32,
}

impl Rounds {
    pub fn new(settings: &Settings) -> Self {
        let rods = &settings.strands.rods;
        let rounds = settings.contact.rounds.div_ceil(rods.newton_steps);
        Self { parts: rods.substeps, newton_steps: rods.newton_steps, rounds }
    }
}

/// Most pairs of each of a number of segments.
pub(super) fn pairs_of(segments: usize) -> usize {
    const BUFFER: usize = 128 << 20;
    let fits = MOST_PAIRS * PAIR_ROWS.max(FORCE_ROWS) * size_of::<[f32; 4]>() * segments <= BUFFER;
    if fits { MOST_PAIRS } else { LEAST_PAIRS }
}

/// The buffers of strands that push each other; see rod_pairs.wesl, rod_room.wesl and rod_ways.wesl. Segments have the
/// numbers of their lanes, `[block][point][lane]`; vectors of pairs lie `[pair][row][segment]`.
pub(super) struct CrowdBuffers {
    pub rounds: Rounds,
    pub pairs: Buffer<[f32; 4]>,
    pub forces: Buffer<[f32; 4]>,
    pub kept: Buffer<[f32; 4]>,
    pub partners: Buffer<u32>,
    pub ways: Buffer<[f32; 4]>,
    pub points_ahead: Buffer<[f32; 4]>,
    /// \[m\]
    pub radii: Buffer<f32>,
    pub cells_taken: Buffer<u32>,
    pub bucket_ends: Buffer<u32>,
    pub totals: Buffer<u32>,
    pub order: Buffer<u32>,
}

impl CrowdBuffers {
    /// Buffers for a model's strands, which no pair remembers.
    pub fn new(gpu: &Gpu, model: &Model) -> Result<Self, SimError> {
        let count = model.positions.len() * LANES;
        let most = pairs_of(count);
        let buckets = (CELLS_OF_BOX * count).next_power_of_two();
        Ok(Self {
            rounds: Rounds::new(&model.settings),
            pairs: Buffer::new(gpu, "pairs of strands", most * PAIR_ROWS * count)?,
            forces: Buffer::new(gpu, "forces of pairs of strands", most * FORCE_ROWS * count)?,
            kept: Buffer::new(gpu, "memory of pairs of strands", most * KEPT_ROWS * count)?,
            partners: Buffer::new(gpu, "partners of segments", most * count)?,
            ways: Buffer::new(gpu, "ways of points", count)?,
            points_ahead: Buffer::new(gpu, "points ahead", 2 * count)?,
            radii: Buffer::from_slice(gpu, "radii of segments", bytemuck::cast_slice(&model.radii))?,
            cells_taken: Buffer::new(gpu, "cells that boxes take", EDGES)?,
            bucket_ends: Buffer::new(gpu, "buckets of boxes", buckets)?,
            totals: Scan::totals(gpu, buckets)?,
            order: Buffer::new(gpu, "order of boxes", CELLS_OF_BOX * count)?,
        })
    }

    /// Vectors of scratch for strands of a number of points.
    pub fn work(lane_count: usize, points: usize) -> usize {
        lane_count * (points * (SLOTS + EXTRAS) + STATES)
    }

    /// Writes the memory of pairs.
    pub fn write(&self, pairs: &[Pair]) -> Result<(), SimError> {
        Ok(self.kept.write(&to_lists(pairs, self.ways.len()))?)
    }
}

/// The memory of pairs in the lists of both segments, of a number of segments: see `kept` in rod_ways.wesl. A pair that
/// finds no room in one is in none.
fn to_lists(pairs: &[Pair], count: usize) -> Vec<[f32; 4]> {
    let most = pairs_of(count);
    let mut lists = vec![[0.0; 4]; most * KEPT_ROWS * count];
    let mut lengths = vec![0; count];
    for pair in pairs {
        let [one, other] = pair.segments.map(|segment| segment as usize);
        if lengths[one] == most || lengths[other] == most {
            continue;
        }
        for (segment, partner) in [(one, other), (other, one)] {
            let code = (partner + 1) as f32 * if pair.slides > 0.0 { -1.0 } else { 1.0 };
            let ([x, y, z], [u, v, w]) = (pair.normal, pair.force);
            let at = lengths[segment] * KEPT_ROWS * count + segment;
            (lists[at], lists[at + count]) = ([x, y, z, code], [u, v, w, pair.gap]);
            lengths[segment] += 1;
        }
    }
    lists
}

/// The pairs of the lists of a number of segments, in rising order.
pub(super) fn to_pairs(lists: &[[f32; 4]], count: usize) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for segment in 0..count {
        for at in (0..pairs_of(count)).map(|pair| pair * KEPT_ROWS * count + segment) {
            let ([x, y, z, code], [u, v, w, gap]) = (lists[at], lists[at + count]);
            let partner = code.abs() as usize;
            if partner > segment + 1 {
                pairs.push(Pair {
                    segments: [segment as u32, partner as u32 - 1],
                    normal: [x, y, z],
                    force: [u, v, w],
                    gap,
                    slides: f32::from(u8::from(code < 0.0)),
                });
            }
        }
    }
    pairs.sort_unstable_by_key(|pair| pair.segments);
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_come_back_from_their_lists_and_a_full_list_takes_no_more() {
        let pair = |one: u32, other: u32| Pair {
            segments: [one, other],
            normal: [0.0, 1.0, 0.0],
            force: [one as f32, 2.0, other as f32],
            gap: 1e-3,
            slides: f32::from(u8::from(other % 2 == 1)),
        };
        let few = [pair(0, 3), pair(0, 17), pair(3, 9), pair(8, 9)];
        assert_eq!(to_pairs(&to_lists(&few, 48), 48), few);
        let many: Vec<Pair> = (1..40).map(|other| pair(0, other)).collect();
        assert_eq!(to_pairs(&to_lists(&many, 48), 48), many[..MOST_PAIRS]);
        // As many as a buffer has room for, and one more.
        let fitting = (128 << 20) / (32 * 3 * 16);
        assert_eq!([fitting, fitting + 1].map(pairs_of), [32, 16]);
    }
}
