//! Lengths, bends and solids: all rounds of a strand in one thread.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, THREADS, groups, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// One thread is one strand.
    pub(super) struct Constrain in "constrain" (super::linked::CONSTRAIN), entry "constrain", threads (None) {
        0 step: Read Step,
        3 rest: Read f32,
        4 positions: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 planes: ReadWrite f32,
    }
}

pub(super) struct Stage {
    kernel: Kernel<Constrain<'static>>,
    strands_per_workgroup: usize,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Constrain::declaration()]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        let points = room(model.points_per_strand);
        let strands = strands_per_workgroup(points);
        // MOST_POINTS and STRANDS of strand.wesl.
        let constants = [("0", points as f64), ("1", strands as f64), skins_constant(&model.colliders)];
        Ok(Self { kernel: Kernel::new(gpu, &constants)?, strands_per_workgroup: strands })
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let bound = self.kernel.bind(
            gpu,
            &Constrain {
                step: &buffers.step,
                rest: &buffers.rest,
                positions: &buffers.places[side],
                predicted: &buffers.places[1 - side],
                velocities: &buffers.velocities,
                planes: &buffers.planes,
            },
        )?;
        Ok(vec![(bound, groups(buffers.lane_count, self.strands_per_workgroup))])
    }
}

/// Points that a kernel has room for, so that strands of other lengths seldom need another one: a compiler takes a second to
/// a minute for it.
fn room(points: usize) -> usize {
    points.next_power_of_two().max(16)
}

/// Strands whose points fit a workgroup's 16 KiB, a power of two and no more than a workgroup's
/// threads elsewhere.
fn strands_per_workgroup(points: usize) -> usize {
    const WORKGROUP_MEMORY: usize = 16 * 1024;
    let fitting = WORKGROUP_MEMORY / (points * size_of::<[f32; 3]>());
    (1 << fitting.ilog2()).min(THREADS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strands_of_any_length_fit_the_workgroup_memory() {
        for points in 4..=64 {
            let room = room(points);
            let strands = strands_per_workgroup(room);
            assert!(room >= points && strands >= 16 && strands * room * 12 <= 16_384, "{points}: {strands}");
        }
    }
}
