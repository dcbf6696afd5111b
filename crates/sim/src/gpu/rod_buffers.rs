//! Buffers of rods beyond those of all strands.

use strandline_gpu::{Buffer, Gpu, GpuError, THREADS};

use super::air_buffers::ShelterBuffers;

/// Numbers of a node in the buffer of rods.
pub(super) const NUMBERS: usize = 10;
/// Numbers of the traits of a strand.
pub(super) const TRAITS: usize = 9;
/// Vectors of four numbers that a point takes while its strand is solved.
const SLOTS: usize = 19;

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
}

impl RodBuffers {
    /// Buffers for nodes, grips and traits of a number of strands, and for the strands that are solved at a time.
    pub fn new(gpu: &Gpu, lane_count: usize, points: usize) -> Result<Self, GpuError> {
        let groups = groups_at_once(lane_count, points);
        Ok(Self {
            nodes: Buffer::new(gpu, "rods", lane_count * (NUMBERS * points + 4 + TRAITS))?,
            work: Buffer::new(gpu, "work of rods", groups * THREADS * points * SLOTS)?,
            groups,
            shelter: None,
            no_air: Buffer::new(gpu, "no air at points", 1)?,
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
