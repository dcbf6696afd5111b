//! Every cell near hair is fluid, solid or air.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use super::volume::GridState;
use crate::Model;

kernel! {
    /// One thread is one cell.
    pub(super) struct Mark in "mark" (super::linked::MARK), entry "mark" {
        0 step: Read Step,
        2 grid: Read GridState,
        3 start_index: Read u32,
        4 kinds: ReadWrite u32,
        5 unknowns: ReadWrite u32,
    }
}

kernel! {
    /// Faces of solids take the solid's velocity; one thread is one cell.
    pub(super) struct CarryWalls in "mark" (super::linked::MARK), entry "carry_walls" {
        0 step: Read Step,
        2 grid: Read GridState,
        4 kinds: ReadWrite u32,
        6 faces: ReadWrite [f32; 2],
    }
}

pub(super) struct Stage {
    mark: Kernel<Mark<'static>>,
    carry_walls: Kernel<CarryWalls<'static>>,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Mark::declaration(), CarryWalls::declaration()]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        let skins = [skins_constant(&model.colliders)];
        Ok(Self { mark: Kernel::new(gpu, &skins)?, carry_walls: Kernel::new(gpu, &skins)? })
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, .. } = *to;
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let step = &buffers.step;
        let (grid, start_index, kinds) = (&volume.grid, &volume.start_index, &volume.kinds);
        let (unknowns, faces) = (&volume.unknowns, &volume.faces);
        let mark = self.mark.bind(gpu, &Mark { step, grid, start_index, kinds, unknowns })?;
        let carry_walls = self.carry_walls.bind(gpu, &CarryWalls { step, grid, kinds, faces })?;
        Ok(vec![mark.over(volume.cell_count), carry_walls.over(volume.cell_count)])
    }
}
