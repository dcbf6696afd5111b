//! Rods: a strand bends and twists in one thread, in all parts of a step.

use strandline_gpu::{Buffer, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::{Buffers, Dispatches, THREADS};

kernel! {
    /// One thread is one strand after another.
    pub(super) struct SolveRods in "solve_rods" (super::linked::SOLVE_RODS), entry "solve_rods" {
        0 step: Read Step,
        1 solids: Read [u32; 4],
        2 rods: Read f32,
        3 rest: Read f32,
        4 positions: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
    }
}

/// Numbers of a node in the buffer of rods.
pub(super) const NUMBERS: usize = 10;
/// Vectors of four numbers that a point takes while its strand is solved.
const SLOTS: usize = 18;

pub(super) struct Stage(Kernel<SolveRods<'static>>);

/// What rods have on the device besides what all strands have.
pub(super) struct RodBuffers {
    /// See rods.wesl.
    pub nodes: Buffer<f32>,
    work: Buffer<[f32; 4]>,
    /// Workgroups that there is room for.
    groups: usize,
}

impl RodBuffers {
    /// Room for the nodes and the grips of so many strands, and for those that are solved at a time.
    pub fn new(gpu: &Gpu, lane_count: usize, points: usize) -> Result<Self, GpuError> {
        let groups = groups_at_once(lane_count, points);
        Ok(Self {
            nodes: Buffer::new(gpu, "rods", lane_count * (NUMBERS * points + 4))?,
            work: Buffer::new(gpu, "work of rods", groups * THREADS * points * SLOTS)?,
            groups,
        })
    }
}

/// Workgroups whose strands fit a buffer of WebGPU's size, of those that there is work for.
fn groups_at_once(lane_count: usize, points: usize) -> usize {
    const BUFFER: usize = 128 << 20;
    let bytes = THREADS * points * SLOTS * size_of::<[f32; 4]>();
    lane_count.div_ceil(THREADS).min(BUFFER / bytes)
}

impl Stage {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Kernel::new(gpu, &[]).map(Self)
    }

    /// Nothing without rods.
    pub fn bind(&self, gpu: &Gpu, buffers: &Buffers, side: usize) -> Result<Dispatches, GpuError> {
        let Some(rods) = &buffers.rods else { return Ok(Vec::new()) };
        let bound = self.0.bind(
            gpu,
            &SolveRods {
                step: &buffers.step,
                solids: &buffers.solids,
                rods: &rods.nodes,
                rest: &buffers.rest,
                positions: &buffers.places[side],
                predicted: &buffers.places[1 - side],
                velocities: &buffers.velocities,
                work: &rods.work,
            },
        )?;
        Ok(vec![(bound, [rods.groups as u32, 1, 1])])
    }
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
