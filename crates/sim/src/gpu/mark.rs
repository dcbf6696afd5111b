//! Every cell near hair is fluid, solid or air.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::stage::{StageKernels, Target};
use super::volume::{GridState, SortedPoint};
use crate::Model;

kernel! {
    /// One thread is one cell.
    pub(super) struct Mark in "mark" (super::linked::MARK), entry "mark" {
        0 step: Read Step,
        2 grid: Read GridState,
        3 start_index: Read u32,
        4 kinds: ReadWrite u32,
        5 unknowns: ReadWrite u32,
        6 faces: ReadWrite [f32; 2],
        7 sorted_points: Read SortedPoint,
        8 densities: Read f32,
    }
}

kernel! {
    /// Takes the masses from the faces; one thread is one cell.
    pub(super) struct ForgetMasses in "mark" (super::linked::MARK), entry "forget_masses" {
        2 grid: Read GridState,
        6 faces: ReadWrite [f32; 2],
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
    forget_masses: Kernel<ForgetMasses<'static>>,
    carry_walls: Kernel<CarryWalls<'static>>,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Mark::declaration(), ForgetMasses::declaration(), CarryWalls::declaration()]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        let skins = [skins_constant(&model.colliders)];
        Ok(Self {
            mark: Kernel::new(gpu, &skins)?,
            forget_masses: Kernel::new(gpu, &[])?,
            carry_walls: Kernel::new(gpu, &skins)?,
        })
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, .. } = *to;
        let Some(volume) = &buffers.volume else { return Ok(Vec::new()) };
        let step = &buffers.step;
        let (grid, start_index, kinds) = (&volume.grid, &volume.start_index, &volume.kinds);
        let (unknowns, faces) = (&volume.unknowns, &volume.faces);
        let (sorted_points, densities) = (&volume.sorted_points, &volume.densities);
        let mark = Mark { step, grid, start_index, kinds, unknowns, faces, sorted_points, densities };
        let mut dispatches = vec![self.mark.bind(gpu, &mark)?.over(volume.cell_count)];
        if volume.is_one_sided {
            let forget = self.forget_masses.bind(gpu, &ForgetMasses { grid, faces })?;
            dispatches.push(forget.over(volume.cell_count));
        }
        let carry_walls = self.carry_walls.bind(gpu, &CarryWalls { step, grid, kinds, faces })?;
        dispatches.push(carry_walls.over(volume.cell_count));
        Ok(dispatches)
    }
}
