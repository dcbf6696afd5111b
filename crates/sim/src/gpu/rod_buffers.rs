//! Buffers of rods beyond those of all strands.

use strandline_gpu::{Buffer, Gpu, THREADS};

use super::air_buffers::ShelterBuffers;
use super::records::SLOTS;
use super::rod_crowd_buffers::CrowdBuffers;
use crate::{Model, SimError};

/// Numbers of a node in the buffer of rods.
pub(super) const NUMBERS: usize = 10;
/// Numbers of the traits of a strand.
pub(super) const TRAITS: usize = 9;

/// The buffers of rods.
pub(super) struct RodBuffers {
    /// See rods.wesl.
    pub nodes: Buffer<f32>,
    pub work: Buffer<[f32; 4]>,
    /// Workgroups that there is room for.
    pub groups: usize,
    /// Air at the points; `None` where all of it is the wind.
    pub shelter: Option<ShelterBuffers>,
    /// Stands for it there.
    pub no_air: Buffer<f32>,
    /// Of strands that push each other, which keep what they work in.
    pub crowd: Option<CrowdBuffers>,
}

impl RodBuffers {
    /// Buffers for nodes, grips and traits of a number of strands, and for the strands that are solved at a time.
    pub fn new(gpu: &Gpu, model: &Model) -> Result<Self, SimError> {
        let (lane_count, points) = (model.lane_count(), model.points_per_strand);
        let groups = groups_at_once(lane_count, points);
        let crowd = if model.settings.has_contact() { Some(CrowdBuffers::new(gpu, model)?) } else { None };
        let work = match crowd {
            Some(_) => CrowdBuffers::work(lane_count, points),
            None => groups * THREADS * points * SLOTS,
        };
        Ok(Self {
            nodes: Buffer::new(gpu, "rods", lane_count * (NUMBERS * points + 4 + TRAITS))?,
            work: Buffer::new(gpu, "work of rods", work)?,
            groups,
            shelter: None,
            no_air: Buffer::new(gpu, "no air at points", 1)?,
            crowd,
        })
    }
}

/// Workgroups whose strands fit a buffer of WebGPU's size, of those that there is work for.
fn groups_at_once(lane_count: usize, points: usize) -> usize {
    const BUFFER: usize = 128 << 20;
    let bytes = THREADS * points * SLOTS * size_of::<[f32; 4]>();
    lane_count.div_ceil(THREADS).min(BUFFER / bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_threads_work_in_fits_a_buffer_and_no_thread_is_idle() {
        assert_eq!(groups_at_once(100, 16), 2);
        for points in [4, 16, 32, 64, 128] {
            let groups = groups_at_once(1 << 20, points);
            assert!(groups * THREADS * points * SLOTS * 16 <= 128 << 20);
            assert!((groups + 1) * THREADS * points * SLOTS * 16 > 128 << 20);
        }
    }
}
